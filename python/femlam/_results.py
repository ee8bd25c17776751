"""What a run found."""

from __future__ import annotations

import html
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, TypeVar, overload
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from femlam._table import Table

if TYPE_CHECKING:
    import pyvista
    from matplotlib.axes import Axes

Grid = TypeVar("Grid")


def _fitting(largest: float) -> tuple[float, str]:
    """Return the factor and the prefix with which a number is easy to read."""
    prefixes = ((1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"))
    # What rounding has left just below a power of ten is that power.
    return next(((1 / size, prefix) for size, prefix in prefixes if largest >= 0.999 * size), (1.0, ""))


def _axes(ax: Axes | None) -> Axes:
    """Return the axes to draw on: those given, or new ones."""
    if ax is not None:
        return ax
    from matplotlib.figure import Figure

    try:
        import matplotlib.pyplot as plt

        return plt.subplots(layout="constrained")[1]
    except ImportError:
        return Figure(layout="constrained").subplots()


class Result:
    """What any analysis found."""

    def __init__(self, found: dict[str, Any]) -> None:
        """Of what the native module returns."""
        self._text: str = found["text"]
        self.summary: dict[str, Any] = json.loads(found["summary"])
        """The document of ``summary.json``; units are in the names of its keys."""
        self.cost: dict[str, Any] = json.loads(found["cost"])
        """The document of ``cost.json``."""
        self.folder: str | None = None if found["folder"] is None else str(found["folder"])
        """Where its files are, if it was run into a folder."""

    @property
    def warnings(self) -> list[str]:
        """What may be wrong with the model."""
        return list(self.summary.get("warnings", []))

    @overload
    def fields(self, part: str = "plate") -> dict[float, pyvista.UnstructuredGrid]: ...

    @overload
    def fields(self, part: str = "plate", *, read: Callable[[str], Grid]) -> dict[float, Grid]: ...

    def fields(self, part: str = "plate", *, read: Callable[[str], Any] | None = None) -> dict[float, Any]:
        """Read the fields that the run has left in its folder, by their times, s.

        * ``part``: ``"plate"``, ``"plies"`` or ``"interfaces"``;
        * ``read``: what makes a grid of a file of VTK: ``meshio.read``, or by default ``pyvista.UnstructuredGrid``.

        A run into a folder writes those that ``output.fields`` of its scene asks for.
        """
        if read is None:
            import pyvista

            read = pyvista.UnstructuredGrid
        if self.folder is None:
            raise ValueError('fields are files: run into a folder, `scene.run(folder="results")`')
        series = Path(self.folder) / "fields" / f"{part}.pvd"
        parts = sorted({path.stem for path in series.parent.glob("*.pvd")} - {"all"})
        if part not in parts:
            there = ", ".join(parts) or "none"
            raise ValueError(f"there are no fields of `{part}`, but of: {there}; `output.fields` of the scene asks for them")
        found = ElementTree.parse(series).iter("DataSet")
        return {float(each.attrib["timestep"]): read(str(series.with_name(each.attrib["file"]))) for each in found}

    def __str__(self) -> str:
        """Return the summary as the command line prints it."""
        return self._text

    def __repr__(self) -> str:
        """Name the scene."""
        return f"<{type(self).__name__} of {self.summary['title']!r}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self._text)}</pre>"


class ImpactResult(Result):
    """The response to an impact: force, motion and energies over time, and what failed."""

    def __init__(self, found: dict[str, Any]) -> None:
        """Of what the native module returns."""
        super().__init__(found)
        table: NDArray[np.float64] = found["history"]
        table.flags.writeable = False
        self.history = Table(dict(zip(found["columns"], table)))
        """The table of ``history.csv``: every column shows a row of one array, without a copy, and cannot be written to."""
        events = json.loads(found["events"])
        columns = ["time_s", "criterion", "mode", "cell", "ply", "angle_deg", "x_m", "y_m", "z_m", "index"]

        def column(name: str) -> NDArray[Any]:
            values = [event[name] for event in events]
            if name in ("criterion", "mode", "ply"):
                return np.array(values, dtype=object)
            return np.array(values, dtype=np.int64 if name == "cell" else np.float64)

        self.events = Table({name: column(name) for name in columns})
        """The table of ``events.csv``: first damage by criterion, mode and place, by time."""

    @property
    def completed(self) -> bool:
        """Whether the march came to its end; ``summary["stopped"]`` says why not."""
        return bool(self.summary["completed"])

    def __getitem__(self, column: str) -> NDArray[np.float64]:
        """Show a column of the history, shape (rows,)."""
        return self.history[column]

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the rows of the history, s, shape (rows,)."""
        return self.history["time_s"]

    @property
    def force(self) -> NDArray[np.float64]:
        """Contact force of all impactors together, N, shape (rows,); of one impactor without a copy."""
        if "contact_force_N" in self.history:
            return self.history["contact_force_N"]
        of_each = [self.history[name] for name in self.history if name.endswith(".contact_force_N")]
        return np.asarray(np.sum(of_each, axis=0))

    def plot_force(self, ax: Axes | None = None) -> Axes:
        """Draw the contact force over time, with the first damage by each criterion and mode; needs matplotlib.

        ``ax``: the axes to draw on; new ones by default. Returns them.
        """
        ax = _axes(ax)
        (to_time, of_time), (to_force, of_force) = _fitting(self.time[-1]), _fitting(self.force.max())
        ax.plot(self.time * to_time, self.force * to_force, label="contact force")
        for damage in self.summary["first_damage"]:
            name = f"{damage['criterion']}: {damage['mode']}"
            ax.plot(damage["time_s"] * to_time, damage["contact_force_N"] * to_force, "o", label=name)
        labels = {"xlabel": f"Time ({of_time}s)", "ylabel": f"Contact force ({of_force}N)"}
        ax.set(**labels, title=self.summary["title"])
        ax.legend(fontsize="small")
        return ax

    def plot(self, *columns: str, ax: Axes | None = None) -> Axes:
        """Draw columns of the history over time, such as ``"impactor_velocity_m_s"``; needs matplotlib.

        * ``columns``: names of :attr:`history`, whose ends are the units;
        * ``ax``: the axes to draw on; new ones by default. Returns them.
        """
        drawn = {name: self.history[name] for name in columns}
        ax = _axes(ax)
        to_time, of_time = _fitting(self.time[-1])
        for name, values in drawn.items():
            ax.plot(self.time * to_time, values, label=name)
        ax.set(xlabel=f"Time ({of_time}s)", title=self.summary["title"])
        ax.legend(fontsize="small")
        return ax


class StaticResult(Result):
    """Displacements and stresses under loads at rest."""

    def __init__(self, found: dict[str, Any]) -> None:
        """Of what the native module returns."""
        super().__init__(found)
        self.nodes: NDArray[np.uint64] = found["nodes"]
        """Numbers in the mesh file of the nodes at the outer faces and the mid-plane, shape (n,)."""
        self.places: NDArray[np.float64] = found["places"]
        """Where they are, m, shape (n, 3)."""
        self.displacements: NDArray[np.float64] = found["displacements"]
        """How they move, m, shape (n, 3)."""
        profiles: dict[str, dict[str, list[Any]]] = found["profiles"]
        self.profiles = {
            name: Table({column: np.array(values) for column, values in columns.items()})
            for name, columns in profiles.items()
        }
        """Of each ``[[profile]]`` of the scene the table of ``profile-<name>.csv``: stresses through the thickness."""


class ModesResult(Result):
    """The lowest natural modes."""

    def __init__(self, found: dict[str, Any]) -> None:
        """Of what the native module returns."""
        super().__init__(found)
        self.omega: NDArray[np.float64] = found["omega"]
        """Circular frequencies, rad/s, shape (modes,)."""
        self.shapes: NDArray[np.float64] = found["shapes"]
        """Shapes of unit modal mass over the unknowns of :meth:`femlam.Scene.matrices`, shape (modes, unknowns)."""
        self.effective_masses: NDArray[np.float64] = found["effective_masses"]
        """Mass that moves with each along x, y and z, kg, shape (modes, 3)."""
        self.unknowns = Table({name: np.asarray(column) for name, column in found["unknowns"].items()})
        """What each unknown stands for: name, node, place."""

    @property
    def frequencies(self) -> NDArray[np.float64]:
        """Natural frequencies, Hz, shape (modes,)."""
        return self.omega / (2 * np.pi)


class BucklingResult(Result):
    """Factors on the preload that buckle the plate."""

    def __init__(self, found: dict[str, Any]) -> None:
        """Of what the native module returns."""
        super().__init__(found)
        self.load_factors: NDArray[np.float64] = found["load_factors"]
        """Those nearest to zero, by size, shape (factors,); negative where the opposite load buckles the plate."""
        self.shapes: NDArray[np.float64] = found["shapes"]
        """Shapes whose largest displacement is 1 m, over the unknowns of ``Scene.matrices``, shape (factors, unknowns)."""
        self.unknowns = Table({name: np.asarray(column) for name, column in found["unknowns"].items()})
        """What each unknown stands for: name, node, place."""


def _result(found: dict[str, Any]) -> Result:
    kinds = {"history": ImpactResult, "omega": ModesResult, "load_factors": BucklingResult}
    return next((kind for key, kind in kinds.items() if key in found), StaticResult)(found)
