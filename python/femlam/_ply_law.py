"""Ply laws of one's own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from femlam import _native
from femlam._criterion import Material, _of
from femlam._errors import FemError, Mistake


@dataclass(frozen=True)
class LawPoint:
    """What a ply law may know of the point that it is asked about."""

    material: Material
    stiffness: NDArray[np.float64]
    """Pa in the axes of the ply, order 11 22 33 12 23 31, shape (6, 6); cannot be written to."""
    length: float
    """Width of the cell, m, over which a crack is smeared."""
    thickness: float
    """Thickness of the ply and of those about it that are alike, m: cracks through it stand about as far apart. Of an
    interface 0."""


@dataclass
class PlyAnswer:
    """What a ply law answers."""

    stress: ArrayLike
    """Pa, order 11 22 33 12 23 31, shape (6,)."""
    tangent: ArrayLike
    """∂stress/∂strain of this very answer, the old state held, Pa, shape (6, 6)."""
    stored: float
    """Energy per volume that is stored since the beginning, J/m³."""
    dissipated: float = 0.0
    """Energy per volume that is lost since the beginning, J/m³; it never falls."""
    state: ArrayLike = ()
    """What is remembered, in the order of :attr:`PlyLaw.state`."""


class PlyLaw:
    """A law of a ply of one's own: derive from it, and pass an object to :meth:`femlam.Scene.run` among its ``laws``.

    >>> class LinearElastic(femlam.PlyLaw):
    ...     name = "linear-elastic"
    ...     def respond(self, point, strain, old):
    ...         stress = point.stiffness @ strain
    ...         return femlam.PlyAnswer(stress, point.stiffness, stress @ strain / 2)

    A material of the scene names it in its ``law``. The law is asked at every Gauss point of every ply that follows it, one
    after the other, in every iteration of every step: some 4 µs and what its own lines take, where a law in Rust takes
    0.1 µs. It is for trying a theory on small plates; write what has proven itself in Rust. :func:`check_ply_law` finds
    what is wrong with one.
    """

    name: ClassVar[str]
    """Name in scenes, in lower case with hyphens."""
    state: ClassVar[Sequence[str]] = ()
    """Names of what it remembers; all are 0 before anything has happened."""
    strengths: ClassVar[Sequence[str]] = ()
    """Strengths that a material must have: Xt, Xc, Yt, Yc, S12, S23, Zt, Zc, S13."""
    toughnesses: ClassVar[Sequence[str]] = ()
    """Toughnesses that it must have: GIc, GIIc, Gft, Gfc, Gmt, Gmc, Gms."""
    dimensions: ClassVar[Mapping[str, tuple[float, float, float]]] = {}
    """Of its own constants with a unit, by name, the exponents of metre, kilogram, second: ``{"limit": (-1, 1, -2)}``."""

    def respond(self, point: LawPoint, strain: NDArray[np.float64], old: NDArray[np.float64]) -> PlyAnswer:
        """Return the answer to a strain, a pure function of its arguments: within a step many strains are tried.

        * ``strain``: in the axes of the ply, engineering shears, order 11 22 33 12 23 31, shape (6,);
        * ``old``: what the last accepted step has left, shape (state,).

        A virgin ply, all of whose state is 0, is linear elasticity for small strains.
        """
        raise NotImplementedError

    @property
    def summary(self) -> str:
        """One line for people: the first of the documentation of the class."""
        return (type(self).__doc__ or self.name).strip().splitlines()[0]

    def _respond(
        self, point: LawPoint, strain: NDArray[np.float64], old: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], float, float, NDArray[np.float64]]:
        found = self.respond(point, strain, old)
        stress = self._shaped("stress", found.stress, (6,))
        state = self._shaped("state", found.state, (len(self.state),))
        tangent = self._shaped("tangent", found.tangent, (6, 6))
        return stress, state, float(found.stored), float(found.dissipated), tangent.ravel()

    def _shaped(self, what: str, values: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float64]:
        array = np.ascontiguousarray(values, dtype=np.float64)
        if array.shape != shape:
            message = f"the ply law `{self.name}` returns a {what} of shape {array.shape}"
            raise FemError([Mistake(message, f"return one of shape {shape}")])
        return array


def check_ply_law(law: PlyLaw, material: str, *, length: float = 1e-3, largest: ArrayLike = 0.01) -> None:
    """Hold a ply law against the contract that those of the program fulfil, on a material of the library.

    * ``length``: width of the cell, m;
    * ``largest``: the strains that the paths reach, one for all components or shape (6,).

    Raises :class:`femlam.FemError` with the first violation: a tangent that is not the derivative, energies that are not
    the work, dissipation that falls, a memory beside the state, a mirror image or other units that change the answer.
    """
    strains = np.broadcast_to(np.asarray(largest, dtype=np.float64), (6,))
    _native.check_ply_law(law, material, length, strains.tolist())


def _point(constants: str, stiffness: NDArray[np.float64], length: float, thickness: float) -> LawPoint:
    stiffness = stiffness.reshape(6, 6)
    stiffness.flags.writeable = False
    return LawPoint(_of(constants), stiffness, length, thickness)
