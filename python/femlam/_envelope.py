"""Failure envelopes."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from femlam import _native
from femlam._criterion import Criterion
from femlam._table import Table

if TYPE_CHECKING:
    from femlam._scene import Scene


def envelope(
    material: str | None, criteria: Iterable[str | Criterion] = (), plane: str = "s2-s12", *, scene: Scene | None = None
) -> Table:
    """Return the stresses of a plane that bring a material to failure: the table of ``fem envelope``.

    * ``material``: its name in the scene, if there is one, or in the library; ``None`` for the first of the scene;
    * ``criteria``: names, parameters after colons (``"tsai-wu:f12=-0.3"``), and objects of one's own; those of the scene
      by default;
    * ``plane``: two of s1, s2, s3, s12, s23, s13; the other stresses are zero.

    Its columns are ``criterion``, ``mode``, ``angle_deg`` and the two stresses in MPa.

    >>> femlam.envelope("AS4/3502", ["puck", "tsai-wu"]).frame().groupby("criterion").plot("s2_MPa", "s12_MPa")
    """
    asked = list(criteria)
    if scene is None and not (asked and material):
        raise ValueError("without a scene, name a material and at least one criterion")
    own = [each for each in asked if isinstance(each, Criterion)]
    names = [each.name if isinstance(each, Criterion) else each for each in asked]
    rows = json.loads(_native.envelope(material, names, plane, None if scene is None else scene._native, own))
    columns = list(rows[0]) if rows else []
    kinds = {name: object if name in ("criterion", "mode") else np.float64 for name in columns}
    return Table({name: np.array([row[name] for row in rows], dtype=kind) for name, kind in kinds.items()})
