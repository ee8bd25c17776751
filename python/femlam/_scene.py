"""Scenes: read, changed, run."""

from __future__ import annotations

import difflib
import json
import os
import re
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Union, cast

import numpy as np
from numpy.typing import NDArray

from femlam import _native
from femlam._asked import Advice, Laminate, Matrices
from femlam._contact import ContactLaw
from femlam._criterion import Criterion
from femlam._envelope import envelope
from femlam._plate import Plate
from femlam._ply_law import PlyLaw
from femlam._results import ModesResult, Result, _result
from femlam._study import StudyResult
from femlam._sweep import SweepResult
from femlam._table import Table

if TYPE_CHECKING:
    import scipy.sparse

PathLike = Union[str, "os.PathLike[str]"]
Law = Union[ContactLaw, PlyLaw]
PlugIn = Union[Criterion, ContactLaw, PlyLaw]


class Scene:
    """What is struck, by what, and how it is computed. A scene does not change: :meth:`replace` makes another one."""

    def __init__(self, native: _native.Scene) -> None:
        """Not for users: see :meth:`load`, :meth:`from_text` and :meth:`from_dict`."""
        self._native = native
        self._keys = native.keys

    @classmethod
    def load(cls, path: PathLike) -> Scene:
        """Read a scene file (TOML); its mesh is looked for beside it.

        Raises :class:`femlam.SceneError` with all mistakes that can be told by themselves.
        """
        return cls(_native.Scene.read(path))

    @classmethod
    def from_text(cls, text: str, folder: PathLike = ".", name: str = "<text>") -> Scene:
        """Read a scene from its text; mesh files are looked for in ``folder``, errors call it ``name``."""
        return cls(_native.Scene.parse(text, Path(folder) / name))

    @classmethod
    def from_dict(cls, keys: Mapping[str, Any], folder: PathLike = ".") -> Scene:
        """Read a scene from its keys, nested as in the file.

        Quantities are texts with their units (``"2 m/s"``) or quantities of pint. Lines in errors are those of :attr:`text`
        as TOML writes it.
        """
        return cls.from_text(_native.as_toml(json.dumps(_plain(keys))), folder, "<dict>")

    @property
    def text(self) -> str:
        """Its text, TOML."""
        return self._native.text

    @property
    def name(self) -> str:
        """Its file, as it was named."""
        return self._native.name

    def keys(self) -> list[str]:
        """List the paths of all keys, those of its preset among them: ``impactor.mass``, ``failure.watch[0].ply``."""
        return list(self._keys)

    def __contains__(self, key: object) -> bool:
        """Whether the scene or its preset has the key."""
        return isinstance(key, str) and bool(self._below(key))

    def __getitem__(self, key: str) -> Any:
        """Return a value as the scene writes it: a text with its unit, a number, a flag, or a list or dictionary of them."""
        below = self._below(key)
        if not below:
            near = difflib.get_close_matches(key, self._keys, 3)
            hint = f"did you mean {', '.join(near)}?" if near else "keys() lists all"
            raise KeyError(f"the scene has no key `{key}`; {hint}")
        return _nested(below)

    def _below(self, key: str) -> dict[str, str]:
        """Values by what their paths add to the key."""
        if key in self._keys:
            return {"": self._keys[key]}
        return {path[len(key) :]: value for path, value in self._keys.items() if path.startswith((key + ".", key + "["))}

    def quantity(self, key: str) -> float:
        """Return a value that has a unit in SI units: ``scene.quantity("impactor.velocity")``."""
        return _native.quantity(str(self[key]))

    def replace(self, keys: Mapping[str, Any]) -> Scene:
        """Return the scene with other values, by the paths of their keys, checked as if they stood in the file.

        >>> scene.replace({"impactor.velocity": "3 m/s", "mesh.refine": 1})
        """
        values = [(key, _native.as_value(json.dumps(_plain(value)))) for key, value in keys.items()]
        return Scene(self._native.replaced(values))

    def save(self, path: PathLike) -> None:
        """Write the scene; names of mesh files are made absolute, so that it can lie anywhere."""
        folder = Path(self.name).parent.absolute()
        files = {key: folder / self[key] for key in self._keys if _FILE.fullmatch(key)}
        Path(path).write_text((self.replace(files) if files else self).text, encoding="utf-8")

    def check(self, criteria: Iterable[Criterion] = (), laws: Iterable[Law] = ()) -> list[str]:
        """Check the scene with its mesh and its plug-ins; return warnings."""
        return self._native.check([*criteria, *laws])

    def run(
        self,
        *,
        folder: PathLike | None = None,
        resume: bool = False,
        threads: int = 1,
        progress: Callable[[float], object] | None = None,
        criteria: Iterable[Criterion] = (),
        laws: Iterable[Law] = (),
        accuracy: float | None = None,
    ) -> Result:
        """Compute what the scene asks for: an impact, loads at rest, modes or buckling, each a result of its own.

        * ``folder``: where the files of ``fem run`` go; without it all stays in memory.
        * ``resume``: go on from the checkpoint in that folder.
        * ``threads``: for the integration of element matrices; results do not depend on it.
        * ``progress``: called with the share of the march that is done, at most twenty times a second.
        * ``criteria``: criteria of one's own, which the scene names in ``failure.criteria``.
        * ``laws``: contact laws of one's own, which it names in ``contact.law``, and ply laws, which its materials name.
        * ``accuracy``: largest relative error of the main results, for which mesh, layers, reduction and step are raised
          before the run; by default what the scene says.

        Other threads of Python run meanwhile. Ctrl-C, and whatever ``progress`` raises, stops a march at its next step; in a
        folder it leaves a checkpoint, from which ``resume`` goes on.
        """
        own = self._asked_for(criteria, laws)
        return self._compute(None, folder, resume, threads, progress, own, accuracy)

    def plate(self, *, criteria: Iterable[Criterion] = (), laws: Iterable[Law] = (), threads: int = 1) -> Plate:
        """Reduce the plate of the scene and keep it for many impacts: :meth:`Plate.impact` marches them alone.

        ``threads``, ``criteria`` and ``laws`` are those of :meth:`run`.
        """
        own = self._asked_for(criteria, laws)
        return Plate(self, self._native.plate(own, _threads(threads)), own)

    def sweep(
        self,
        set: Mapping[str, Any],
        *,
        design: str | None = None,
        samples: int | None = None,
        seed: int | None = None,
        correlate: Mapping[tuple[str, str], float] | None = None,
        quantities: Mapping[str, str] | None = None,
        pareto: str | None = None,
        threads: int = 1,
        folder: PathLike | None = None,
        resume: bool = False,
        progress: Callable[[float], object] | None = None,
        criteria: Iterable[Criterion] = (),
        laws: Iterable[Law] = (),
    ) -> SweepResult:
        """Run many cases of the scene, those of one plate on the same one: ``fem sweep``.

        * ``set``: what keys become: a list of values, or the words of the command line, ``"1..5:9"`` for nine values,
          ``"normal(50 MPa, 8 %)"`` for numbers that scatter; it goes over the table ``[sweep]`` of the scene;
        * ``design``: ``"grid"``, ``"random"``, ``"latin-hypercube"``, ``"sobol"`` or ``"saltelli"``, with its
          ``samples`` and ``seed``;
        * ``correlate``: correlations of pairs of keys that scatter, ``{("materials.m.Yt", "materials.m.S12"): 0.6}``;
        * ``quantities``: further columns by formulas of the others, ``{"lost": "absorbed_energy / energy"}``, and
          ``pareto``, two of them of which no case beats another, ``"least peak_force, most absorbed_energy"``;
        * ``threads``: cases that are marched at a time; the table does not depend on it;
        * ``folder``: where the files of ``fem sweep`` go, from which ``resume`` goes on; without it they are not kept;
        * ``progress``, ``criteria`` and ``laws``: as in :meth:`run`.

        >>> scene.sweep({"impactor.velocity": "1..5:9", "laminate.plies": ["[0/90]2s", "[45/-45]2s"]}).table
        """
        if resume and folder is None:
            raise ValueError("to resume, name the folder of the sweep that was stopped")
        with tempfile.TemporaryDirectory() as temporary:
            where = Path(temporary) / "sweep" if folder is None else Path(folder)
            asked: _native.AskedOfSweep = {
                "set": [(key, _words(values)) for key, values in set.items()],
                "design": design,
                "samples": samples,
                "seed": seed,
                "correlate": [f"{a},{b}={value}" for (a, b), value in (correlate or {}).items()],
                "quantities": [f"{name} = {formula}" for name, formula in (quantities or {}).items()],
                "pareto": pareto,
                "threads": _threads(threads),
                "folder": os.fspath(where),
                "resume": resume,
                "progress": progress,
                "own": self._asked_for(criteria, laws),
            }
            summary = json.loads(self._native.sweep(asked))
            return SweepResult(where, summary, keep=folder is not None)

    def study(
        self,
        axes: Iterable[str] = (),
        *,
        budget: float | None = None,
        tolerance: float | None = None,
        folder: PathLike | None = None,
        resume: bool = False,
        progress: Callable[[float], object] | None = None,
        criteria: Iterable[Criterion] = (),
        laws: Iterable[Law] = (),
    ) -> StudyResult:
        """Find what accuracy costs, the scene run under many settings: ``fem study``.

        * ``axes``: what is varied, ``"mesh"``, ``"step"`` and so on; what the scene says or all that fit it by default;
        * ``budget``: processor time that it may take, s; without it as much as it takes on a common machine in four minutes;
        * ``tolerance``: relative error, for which the result's ``kept_by`` is the cheapest scene;
        * ``folder``: where the files of ``fem study`` go, from which ``resume`` goes on; without it they are not kept;
        * ``progress``, ``criteria`` and ``laws``: as in :meth:`run`; Ctrl-C leaves the runs so far in the folder.
        """
        if resume and folder is None:
            raise ValueError("to resume, name the folder of the study that was stopped")
        with tempfile.TemporaryDirectory() as temporary:
            where = Path(temporary) / "study" if folder is None else Path(folder)
            asked: _native.AskedOfStudy = {
                "axes": list(axes),
                "budget": budget,
                "tolerance": tolerance,
                "folder": os.fspath(where),
                "resume": resume,
                "progress": progress,
                "own": self._asked_for(criteria, laws),
            }
            document, text, kept = self._native.study(asked)
            kept_by = None if kept is None else Scene(_native.Scene.parse(kept, self.name))
            return StudyResult(where, (json.loads(document), text, kept_by), keep=folder is not None)

    def envelope(
        self, plane: str = "s2-s12", *, material: str | None = None, criteria: Iterable[str | Criterion] = ()
    ) -> Table:
        """Return the failure envelope of a material of the scene by its criteria: :func:`femlam.envelope`.

        * ``material``: the first of the scene by default;
        * ``criteria``: as the scene calls them, or others; those of the scene by default.
        """
        return envelope(material, criteria, plane, scene=self)

    def modes(self, count: int | None = None, *, folder: PathLike | None = None, threads: int = 1) -> ModesResult:
        """Find the lowest natural modes of the plate, whatever the scene asks for; as many as it says, or ten."""
        if count is not None and count < 1:
            raise ValueError("count must be 1 or more")
        return cast(ModesResult, self._compute(count or 0, folder, False, threads, None, [], None))

    def advise(self, *, threads: int = 1) -> list[Advice]:
        """Say, of each impactor, which effects its impact calls for."""
        return [Advice(**each) for each in json.loads(self._native.advise(_threads(threads)))]

    def laminate(self) -> Laminate:
        """Return A, B, D and moduli of the laminate."""
        return Laminate(**self._native.laminate())

    def matrices(self, *, threads: int = 1) -> Matrices:
        """Assemble stiffness and mass; needs SciPy."""
        import scipy.sparse

        found = self._native.matrices(_threads(threads))

        def whole(parts: tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]) -> scipy.sparse.csc_array:
            lower = scipy.sparse.csc_array(parts, shape=(len(parts[2]) - 1,) * 2)
            return scipy.sparse.csc_array(lower + scipy.sparse.tril(lower, -1).T)

        unknowns = Table({name: np.asarray(column) for name, column in found["unknowns"].items()})
        return Matrices(whole(found["stiffness"]), whole(found["mass"]), unknowns)

    def __eq__(self, other: object) -> bool:
        """Whether it is the same text, read under the same name."""
        return isinstance(other, Scene) and (self.text, self.name) == (other.text, other.name)

    def __hash__(self) -> int:
        """Let it be a key."""
        return hash((self.text, self.name))

    def __reduce__(self) -> tuple[Any, ...]:
        """Let other processes have it."""
        return _parse, (self.text, self.name)

    def __repr__(self) -> str:
        """Name the scene."""
        return f"<Scene {self['title']!r} of {self.name}>"

    def _repr_html_(self) -> str:
        import html

        return f"<pre>{html.escape(self.text)}</pre>"

    def _compute(
        self,
        modes: int | None,
        folder: PathLike | None,
        resume: bool,
        threads: int,
        progress: Callable[[float], object] | None,
        own: list[PlugIn],
        accuracy: float | None,
    ) -> Result:
        if resume and folder is None:
            raise ValueError("to resume, name the folder of the run that was stopped")
        if accuracy is not None and not 0 < accuracy < 1:
            raise ValueError("accuracy must be a relative error between 0 and 1, such as 0.01")
        asked: _native.Asked = {
            "modes": modes,
            "threads": _threads(threads),
            "folder": None if folder is None else os.fspath(folder),
            "resume": resume,
            "progress": progress,
            "own": own,
            "accuracy": accuracy,
        }
        return _result(self._native.run(asked))

    def _asked_for(self, criteria: Iterable[Criterion], laws: Iterable[Law]) -> list[PlugIn]:
        """Return plug-ins of one's own that the scene names."""
        own: list[PlugIn] = [*criteria, *laws]
        for each in own:
            what, key = _WHERE[next(kind for kind in _WHERE if isinstance(each, kind))]
            if not self._native.asks_for(each.name):
                raise ValueError(f"the scene does not ask for the {what} `{each.name}`: name it in `{key}`")
        return own


def _parse(text: str, name: str) -> Scene:
    return Scene(_native.Scene.parse(text, name))


_WHERE: dict[type, tuple[str, str]] = {
    Criterion: ("criterion", "failure.criteria"),
    ContactLaw: ("contact law", "contact.law"),
    PlyLaw: ("ply law", "law` of a material, `materials.NAME.law"),
}
_FILE = re.compile(r"mesh\.file|materials\.[^.]+\.file")
_STEP = re.compile(r"\.([^.\[]+)|\[(\d+)\]")


def _nested(leaves: Mapping[str, str]) -> Any:
    """Put the values at the ends of paths, ``.mass`` or ``[0].ply``, into lists and dictionaries."""
    if "" in leaves:
        text = leaves[""]
        return text[1:-1] if text.startswith('"') else json.loads(text)
    parts: dict[str, dict[str, str]] = {}
    places: dict[int, dict[str, str]] = {}
    for path, value in leaves.items():
        step = _STEP.match(path)
        assert step is not None, path
        name, place = step.groups()
        part = parts.setdefault(name, {}) if place is None else places.setdefault(int(place), {})
        part[path[step.end() :]] = value
    if places:
        return [_nested(places[i]) for i in sorted(places)]
    return {name: _nested(part) for name, part in parts.items()}


def _threads(threads: int) -> int:
    if threads < 1:
        raise ValueError("threads must be 1 or more")
    return threads


def _words(values: Any) -> str:
    """Return what a key becomes in words, as on the command line."""
    values = _plain(values)
    return ",".join(str(value) for value in values) if isinstance(values, list) else str(values)


def _plain(value: Any) -> Any:
    """Return what JSON can hold: quantities of pint as texts, paths as names, numbers of NumPy as numbers."""
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return f"{value.magnitude!r} {value.units:~C}".replace("**", "^")
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    return value
