"""Errors: what is wrong, where, and what to do."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Mistake:
    """One thing that is wrong.

    Lines and columns count from 1, columns in bytes; they are ``None`` for what has no place in a file.
    """

    message: str
    """What is wrong."""
    help: str | None = None
    """What to do about it."""
    file: str | None = None
    """File, preset or library in which it stands."""
    line: int | None = None
    column: int | None = None
    text: str | None = None
    """The whole line."""
    causes: tuple[str, ...] = ()
    """What caused it, the nearest first."""

    def __str__(self) -> str:
        """As compilers write it, with the text and the remedy below."""
        place = f"{self.file}:{self.line}:{self.column}: " if self.line else ""
        lines = [place + ": ".join([self.message, *self.causes])]
        lines += [f"    {self.text.strip()}"] if self.text and self.text.strip() else []
        lines += [f"  help: {self.help}"] if self.help else []
        return "\n".join(lines)


class FemError(Exception):
    """What the program refuses, or cannot compute."""

    def __init__(self, mistakes: list[Mistake]) -> None:
        """Of at least one mistake."""
        super().__init__("\n".join(map(str, mistakes)))
        self.mistakes = mistakes

    def __reduce__(self) -> tuple[Any, ...]:
        """Let other processes raise it."""
        return type(self), (self.mistakes,)

    @property
    def message(self) -> str:
        """What is wrong first."""
        return self.mistakes[0].message

    @property
    def help(self) -> str | None:
        """What to do about it."""
        return self.mistakes[0].help

    @property
    def file(self) -> str | None:
        """Where it stands."""
        return self.mistakes[0].file

    @property
    def line(self) -> int | None:
        """Its line, from 1."""
        return self.mistakes[0].line

    @property
    def column(self) -> int | None:
        """Its column, from 1."""
        return self.mistakes[0].column


class SceneError(FemError, ValueError):
    """A scene that is refused, with all its mistakes that can be told by themselves, by their lines."""


def _of(text: str) -> FemError:
    """Make the exception for mistakes as the native module writes them."""

    def mistake(found: dict[str, Any]) -> Mistake:
        place = found.pop("place", None) or {}
        return Mistake(**{**found, "causes": tuple(found["causes"])}, **place)

    mistakes = [mistake(found) for found in json.loads(text)]
    return (SceneError if mistakes[0].line else FemError)(mistakes)
