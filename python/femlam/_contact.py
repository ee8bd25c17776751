"""Contact laws of one's own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from femlam import _native
from femlam._errors import FemError, Mistake

_REMEMBERS = 8


class ContactLaw:
    """A contact law of one's own: derive from it, and pass an object to :meth:`femlam.Scene.run`.

    >>> class Linear(femlam.ContactLaw):
    ...     name = "linear"
    ...     def force(self, history, indentation):
    ...         return 5e6 * max(indentation, 0), 5e6 * (indentation > 0)
    ...     def energy(self, history, indentation):
    ...         return 2.5e6 * max(indentation, 0) ** 2, 0

    Indentations are in m, positive where the bodies overlap. ``history`` is what the law remembers of the steps before, a
    list of eight numbers, all zero before the first contact; only :meth:`commit` changes it. Every step asks the law about
    three times, each some 4 µs, where a law in Rust takes some nanoseconds. :func:`check_contact_law` finds what
    is wrong with one.
    """

    name: ClassVar[str]
    """Name in scenes, in lower case with hyphens."""

    def force(self, history: Sequence[float], indentation: float) -> tuple[float, float]:
        """Return the force, N, and its derivative by the indentation, N/m.

        The force is continuous, never negative, and never falls as the indentation grows.
        """
        raise NotImplementedError

    def energy(self, history: Sequence[float], indentation: float) -> tuple[float, float]:
        """Return what of the work of the force up to the indentation is stored, and what is dissipated, J."""
        raise NotImplementedError

    def commit(self, history: Sequence[float], indentation: float) -> Sequence[float]:
        """Return what is remembered after a step that ends at the indentation: at most eight numbers.

        A law that follows one curve remembers nothing.
        """
        return history

    def branches(self, history: Sequence[float]) -> tuple[float, float | None]:
        """Return where the force begins, and the largest indentation so far of a law that follows another curve below it."""
        return 0.0, None

    @property
    def summary(self) -> str:
        """One line for people: the first of the documentation of the class."""
        return (type(self).__doc__ or self.name).strip().splitlines()[0]

    def _commit(self, history: Sequence[float], indentation: float) -> list[float]:
        kept = [float(number) for number in self.commit(history, indentation)]
        if len(kept) > _REMEMBERS:
            message = f"the contact law `{self.name}` remembers {len(kept)} numbers"
            raise FemError([Mistake(message, f"return at most {_REMEMBERS} from `commit`")])
        return kept + [0.0] * (_REMEMBERS - len(kept))


def check_contact_law(law: ContactLaw, largest: float) -> None:
    """Hold a contact law against the contract that those of the program fulfil, up to the indentation ``largest``, m.

    Raises :class:`femlam.FemError` with the first violation: a force that jumps, pulls or falls, a derivative that is not
    its own, energies that are not its work, a memory outside of the history.
    """
    _native.check_contact_law(law, largest)
