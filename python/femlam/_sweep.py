"""Many cases of one scene."""

from __future__ import annotations

import html
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from femlam._table import read_table

if TYPE_CHECKING:
    import pandas as pd


class SweepResult:
    """What the cases of a sweep found: what :meth:`femlam.Scene.sweep` returns."""

    def __init__(self, folder: Path, summary: dict[str, Any], keep: bool) -> None:
        """Of a folder of results."""
        self.summary = summary
        """The document of ``sweep.json``: keys, numbers of cases, what they say together where numbers scatter."""
        self.table = read_table(folder / "sweep.csv")
        """The table of ``sweep.csv``, a row a case: what it sets, what it finds, or in ``failed`` why it found nothing."""
        self.folder = str(folder) if keep else None
        """Where its files are, if it was run into a folder."""

    def frame(self) -> pd.DataFrame:
        """Return the table as a frame of pandas, which must be installed."""
        return self.table.frame()

    def __getitem__(self, column: str) -> NDArray[Any]:
        """Show a column of the table, shape (cases,)."""
        return self.table[column]

    def __repr__(self) -> str:
        """Name the scene and count the cases."""
        return f"<SweepResult of {self.summary['title']!r}: {self.table.rows} cases over {', '.join(self.summary['keys'])}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self.table._repr_html_()}"
