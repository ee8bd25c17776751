"""Columns by their names."""

from __future__ import annotations

import csv
import html
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd
    import polars as pl

_UNITS = {
    "m_s": "m/s",
    "N_s": "N s",
    "rad_s": "rad/s",
    "m2": "m²",
    "deg": "°",
    "Hz": "Hz",
    "MPa": "MPa",
    "MB": "MB",
    "Pa": "Pa",
    "kg": "kg",
    "J": "J",
    "N": "N",
    "m": "m",
    "s": "s",
}


def _unit(column: str) -> str:
    return next((unit for ending, unit in _UNITS.items() if column.endswith("_" + ending)), "")


class Table(Mapping[str, NDArray[Any]]):
    """Columns by their names, arrays of one length; numbers are in the units with which the names end."""

    def __init__(self, columns: Mapping[str, NDArray[Any]]) -> None:
        """Of columns that are shown, not copied."""
        self._columns = dict(columns)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Show a column, shape (rows,)."""
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        """Walk over the names of the columns."""
        return iter(self._columns)

    def __len__(self) -> int:
        """Count the columns."""
        return len(self._columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self._columns.values()), ()))

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column; empty where it has none."""
        return {name: _unit(name) for name in self}

    def frame(self) -> pd.DataFrame:
        """Return a frame of pandas, which must be installed; its units are in ``frame.attrs["units"]``."""
        import pandas as pd

        frame = pd.DataFrame(self._columns)
        frame.attrs["units"] = self.units
        return frame

    def polars(self) -> pl.DataFrame:
        """Return a frame of polars, which must be installed; units are in the names of columns and in :attr:`units`."""
        import polars as pl

        return pl.DataFrame({name: column.tolist() if column.dtype == object else column for name, column in self.items()})

    def __repr__(self) -> str:
        """Name columns and rows."""
        return f"<Table of {self.rows} rows: {', '.join(self)}>"

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{html.escape(name)}</th>" for name in self)
        shown = min(self.rows, 10)
        cells = ["".join(f"<td>{html.escape(str(self[name][i]))}</td>" for name in self) for i in range(shown)]
        body = "".join(f"<tr>{row}</tr>" for row in cells)
        rest = f"<p>{shown} of {self.rows} rows</p>" if shown < self.rows else ""
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{rest}"


def read_table(path: Path) -> Table:
    """Read a table: numbers where all words of a column are, what is empty NaN among them."""
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    return Table({name: _column([row[k] for row in rows]) for k, name in enumerate(header)})


def _column(words: list[str]) -> NDArray[Any]:
    try:
        numbers = [float(word) if word else np.nan for word in words]
    except ValueError:
        return np.array(words, dtype=object)
    whole = all(word.isdigit() for word in words) and bool(words)
    if not any(words):
        return np.array(words, dtype=object)
    return np.array(numbers, dtype=np.int64 if whole else np.float64)
