"""Failure criteria: one's own, and those of the program."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from femlam import _native
from femlam._errors import FemError, Mistake


class Material:
    """Constants of a material by the names that scenes have for them, SI: ``material.Xt``, ``material.E1``."""

    def __init__(self, constants: dict[str, Any]) -> None:
        """Of constants by name."""
        self._constants = constants

    def __getattr__(self, name: str) -> float:
        """Return a constant."""
        try:
            return float(self.__dict__["_constants"][name])
        except KeyError:
            raise AttributeError(f"the material {self!r} has no constant `{name}`") from None

    def __dir__(self) -> list[str]:
        """List its constants."""
        return list(self._constants)

    def __repr__(self) -> str:
        """Name it."""
        return str(self._constants.get("name"))


def material(name: str) -> Material:
    """Return a material of the library: ``femlam.material("AS4/3502").Xt``."""
    return _of(_native.material(name))


@lru_cache(maxsize=64)
def _of(constants: str) -> Material:
    return Material(json.loads(constants))


class Criterion:
    """A failure criterion of one's own: derive from it, and pass an object to :meth:`femlam.Scene.run`.

    >>> class FibreStress(femlam.Criterion):
    ...     name = "fibre-stress"
    ...     modes = ("fibre tension",)
    ...     strengths = ("Xt",)
    ...     def indices(self, stress, material):
    ...         return stress[:, 0] / material.Xt

    The program asks for many states in one call, which takes some 20 µs, and about as long a state as a criterion in Rust.
    Reserve factors are found by search, hundreds of calls each. :func:`check_criterion` finds what is wrong with one.
    """

    name: ClassVar[str]
    """Name in scenes, in lower case with hyphens."""
    modes: ClassVar[Sequence[str]]
    """Names of its failure modes."""
    strengths: ClassVar[Sequence[str]] = ()
    """Strengths that a material must have: Xt, Xc, Yt, Yc, S12, S23, Zt, Zc, S13."""
    at_interfaces: ClassVar[bool] = False
    """Whether it judges the resin between plies instead of the plies."""
    invariant_about_fibre: ClassVar[bool] = False
    """Whether a rotation of the stress about the fibre leaves the indices unchanged."""

    def indices(self, stress: NDArray[np.float64], material: Material) -> NDArray[np.float64]:
        """Return an index of each state and mode: 1 at failure, 0 where the mode does not apply.

        * ``stress``: Pa in the axes of the ply, order 11 22 33 12 23 31, shape (n, 6);
        * returns shape (n, modes), or (n,) of a single mode; NaN for a stress that the criterion refuses.

        A state must give the same bits alone and among others: sums, products, quotients and square roots do.
        """
        raise NotImplementedError

    @property
    def summary(self) -> str:
        """One line for people: the first of the documentation of the class."""
        return (type(self).__doc__ or self.name).strip().splitlines()[0]

    def _judge(self, stress: NDArray[np.float64], constants: str) -> NDArray[np.float64]:
        found = np.asarray(self.indices(stress, _of(constants)), dtype=np.float64)
        shape = (len(stress), len(self.modes))
        if found.shape == shape[:1] and shape[1] == 1:
            found = found[:, None]
        if found.shape != shape:
            got, wanted = tuple(found.shape), f"{shape[0]} states and {shape[1]} modes"
            message = f"the criterion `{self.name}` returns an array of shape {got} for {wanted}"
            raise FemError([Mistake(message, f"return one of shape {shape}")])
        return np.ascontiguousarray(found)


def check_criterion(criterion: Criterion, material: str) -> None:
    """Hold a criterion against the contract that those of the program fulfil, on a material of the library.

    Raises :class:`femlam.FemError` with the first violation: a NaN that passes, a mode that fails without stress, a state
    that is judged otherwise among others, an invariance that is claimed and not there.
    """
    _native.check_criterion(criterion, material)


def indices(criterion: str, stress: ArrayLike, material: str) -> dict[str, NDArray[np.float64]]:
    """Return the indices of a criterion of the program by mode, each of shape (n,).

    * ``criterion``: its name in scenes, ``"hashin-1980"``;
    * ``stress``: Pa in the axes of the ply, order 11 22 33 12 23 31, shape (n, 6);
    * ``material``: its name in the library.
    """
    states = np.ascontiguousarray(stress, dtype=np.float64)
    if states.ndim != 2 or states.shape[1] != 6:
        raise ValueError(f"stress must have the shape (n, 6), not {states.shape}")
    modes, found = _native.indices(criterion, states, material)
    return {mode: found[:, k] for k, mode in enumerate(modes)}
