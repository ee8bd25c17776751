"""Low-velocity impact on laminated composites: force, stresses, first damage.

A scene is read, run and looked at:

>>> scene = femlam.Scene.load("coupon/scene.toml")
>>> result = scene.replace({"impactor.velocity": "2 m/s"}).run()
>>> result["contact_force_N"].max()

Numbers are in SI units; the names of columns end with theirs. Stresses have the order 11 22 33 12 23 31.
"""

from femlam._asked import Advice, Laminate, Matrices
from femlam._contact import ContactLaw, check_contact_law
from femlam._criterion import Criterion, Material, check_criterion, indices, material
from femlam._envelope import envelope
from femlam._errors import FemError, Mistake, SceneError
from femlam._native import __version__
from femlam._plate import Plate
from femlam._ply_law import LawPoint, PlyAnswer, PlyLaw, check_ply_law
from femlam._results import BucklingResult, ImpactResult, ModesResult, Result, StaticResult
from femlam._scene import Scene
from femlam._study import StudyResult
from femlam._sweep import SweepResult
from femlam._table import Table

__all__ = [
    "Advice",
    "BucklingResult",
    "ContactLaw",
    "Criterion",
    "FemError",
    "ImpactResult",
    "Laminate",
    "LawPoint",
    "Material",
    "Matrices",
    "Mistake",
    "ModesResult",
    "Plate",
    "PlyAnswer",
    "PlyLaw",
    "Result",
    "Scene",
    "SceneError",
    "StaticResult",
    "StudyResult",
    "SweepResult",
    "Table",
    "__version__",
    "check_contact_law",
    "check_criterion",
    "check_ply_law",
    "envelope",
    "indices",
    "material",
]
