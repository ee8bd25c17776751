"""Many cases of one scene."""

from __future__ import annotations

import csv
import html
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from femlam._results import Table

if TYPE_CHECKING:
    import pandas as pd


class SweepResult:
    """What the cases of a sweep found: what :meth:`femlam.Scene.sweep` returns."""

    def __init__(self, folder: Path, summary: dict[str, Any], keep: bool) -> None:
        """Of a folder of results."""
        self.summary = summary
        """The document of ``sweep.json``: keys, numbers of cases, what they say together where numbers scatter."""
        self.table = _read(folder / "sweep.csv")
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


def _read(path: Path) -> Table:
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    return Table({name: _column([row[k] for row in rows]) for k, name in enumerate(header)})


def _column(words: list[str]) -> NDArray[Any]:
    """Make numbers of a column where all its words are; what is empty is NaN among numbers."""
    try:
        numbers = [float(word) if word else np.nan for word in words]
    except ValueError:
        return np.array(words, dtype=object)
    whole = all(word.isdigit() for word in words) and bool(words)
    if not any(words):
        return np.array(words, dtype=object)
    return np.array(numbers, dtype=np.int64 if whole else np.float64)
