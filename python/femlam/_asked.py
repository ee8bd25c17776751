"""What a scene is asked without a run."""

from __future__ import annotations

import html
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from femlam._table import Table

if TYPE_CHECKING:
    import scipy.sparse


@dataclass(frozen=True)
class Matrices:
    """Stiffness and mass of a plate after its supports are eliminated, both whole and symmetric, shape (n, n)."""

    stiffness: scipy.sparse.csc_array
    """K, N/m for translations."""
    mass: scipy.sparse.csc_array
    """M, kg for translations."""
    unknowns: Table
    """What each row and column stands for, in order: ``unknown`` (``U30``: along z), ``node``, ``x_m``, ``y_m``, ``z_m``."""


@dataclass(frozen=True)
class Laminate:
    """Classical laminate theory of the plies of a scene; rows and columns 11, 22, 12, each matrix of shape (3, 3)."""

    A: NDArray[np.float64]
    """Forces per length by strains, N/m."""
    B: NDArray[np.float64]
    """Coupling, N."""
    D: NDArray[np.float64]
    """Moments per length by curvatures, N m."""
    in_plane: dict[str, float]
    """Ex, Ey, Gxy in Pa, and nuxy."""
    flexural: dict[str, float]
    """The same in bending."""
    thickness: float
    """m"""
    angles: list[float]
    """Angles of the plies from the bottom up, degrees."""


@dataclass(frozen=True)
class Advice:
    """What the advisor says of one impactor before the run."""

    impactor: str | None
    """Its name, where there are several."""
    mass_kg: float
    velocity_m_s: float
    peak_force_N: float
    """What formulas expect."""
    answers: list[dict[str, Any]]
    """Question, numbers, choice, effect, error, cost."""
    text: str

    def __str__(self) -> str:
        """Return the advice as the command line prints it."""
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"
