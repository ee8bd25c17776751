"""What accuracy costs."""

from __future__ import annotations

import html
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from femlam._table import Table, read_table

if TYPE_CHECKING:
    import pandas as pd

    from femlam._scene import Scene


class StudyResult:
    """What a study found: what :meth:`femlam.Scene.study` returns."""

    def __init__(self, folder: Path, found: tuple[dict[str, Any], str, Scene | None], keep: bool) -> None:
        """Of a folder of results."""
        self.summary, self._text, self.kept_by = found
        self.table = read_table(folder / "study.csv")
        self.folder = str(folder) if keep else None

    summary: dict[str, Any]
    """The document of ``fem study --json``: what was asked, runs, what each ladder leaves, notes."""
    table: Table
    """The table of ``study.csv``, a row a run: its keys, sizes, work, values, errors and times."""
    kept_by: Scene | None
    """The scene with the cheapest setting whose error is within ``tolerance``; ``None`` where no run is sure to be."""
    folder: str | None
    """Where its files are, if it was run into a folder."""

    def frame(self) -> pd.DataFrame:
        """Return the table as a frame of pandas, which must be installed."""
        return self.table.frame()

    def __getitem__(self, column: str) -> NDArray[Any]:
        """Show a column of the table, shape (runs,)."""
        return self.table[column]

    def __str__(self) -> str:
        """Return the study as the command line prints it."""
        return self._text

    def __repr__(self) -> str:
        """Name the scene and count the runs."""
        return f"<StudyResult of {self.summary['title']!r}: {self.table.rows} runs>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self._text)}</pre>"
