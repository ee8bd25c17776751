"""Many impacts on one plate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Callable

import numpy as np

from femlam import _native
from femlam._results import ImpactResult

if TYPE_CHECKING:
    from femlam._scene import PlugIn, Scene


class Plate:
    """The reduced plate of a scene, kept for many impacts: what :meth:`femlam.Scene.plate` makes.

    It does not change, and threads may strike it at the same time.
    """

    def __init__(self, scene: Scene, native: _native.Plate, own: Sequence[PlugIn]) -> None:
        """Not for users: see :meth:`femlam.Scene.plate`."""
        self.scene = scene
        """The scene that it is of."""
        self._native = native
        self._own = own

    def impact(
        self,
        keys: Mapping[str, Any] | None = None,
        *,
        mass: Any = None,
        velocity: Any = None,
        energy: Any = None,
        progress: Callable[[float], object] | None = None,
    ) -> ImpactResult:
        """Strike the plate as the scene says, but for what is given here.

        * ``mass``, ``velocity``, ``energy``: of the impactor, numbers in kg, m/s and J, texts with their units or quantities
          of pint;
        * ``keys``: values by the paths of their keys, as in :meth:`femlam.Scene.replace`: of the impactor (but for the place
          and the patch of its contact), of the contact law, and strengths of materials. All else is another plate;
        * ``progress``: as in :meth:`femlam.Scene.run`.

        It finds what a run of the scene with these values finds, to the bit, but for estimates of errors, which need the
        plate before its reduction.
        """
        given = {"mass": (mass, "kg"), "velocity": (velocity, "m/s"), "energy": (energy, "J")}
        values = {f"impactor.{key}": _with(unit, value) for key, (value, unit) in given.items() if value is not None}
        scene = self.scene.replace({**(keys or {}), **values})
        return ImpactResult(self._native.impact(scene._native, list(self._own), progress))

    def __repr__(self) -> str:
        """Name the scene."""
        return f"<Plate of {self.scene!r}>"


def _with(unit: str, value: Any) -> Any:
    """Give a number its unit."""
    return f"{float(value)!r} {unit}" if isinstance(value, (int, float, np.integer, np.floating)) else value
