import shutil
from pathlib import Path

import pytest

import femlam

EXAMPLE = Path(__file__).parents[2] / "examples" / "as4-3502-8ply-25mm"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the shipped scene."""
    for file in ("scene.toml", "plate.msh"):
        shutil.copy(EXAMPLE / file, tmp_path)
    return tmp_path


@pytest.fixture
def scene(folder: Path) -> femlam.Scene:
    """A short march on few cells."""
    return femlam.Scene.load(folder / "scene.toml").replace({"march.end": "0.1 ms", "output.plots": False})


@pytest.fixture
def square() -> dict:
    """A clamped square of aluminium."""
    fix = ["U10", "U20", "U30", "U13", "U23"]
    return {
        "title": "clamped square",
        "analysis": "modes",
        "mesh": {"rectangle": ["100 mm", "100 mm"], "cells": [12, 12]},
        "laminate": {"plies": "[0]", "material": "sheet", "ply_thickness": "1 mm", "layers": [1]},
        "element": {"kind": "mitc4"},
        "materials": {"sheet": {"e": "70 GPa", "nu": 0.3, "density": "2700 kg/m^3"}},
        "support": [{"group": edge, "at": "all", "fix": fix} for edge in ("x-min", "x-max", "y-min", "y-max")],
    }
