import numpy as np
import pytest

import femlam

NAME = "yamada-sun"


class YamadaSun(femlam.Criterion):
    """Failure of the last ply: its fibres under stress and shear."""

    name = NAME
    modes = ("fibre failure",)
    strengths = ("Xt", "Xc", "S12")
    invariant_about_fibre = True

    def indices(self, stress, material):
        s11, s12, s31 = stress[:, 0], stress[:, 3], stress[:, 5]
        along = np.where(s11 < 0, material.Xc, material.Xt)
        return (s11 / along) ** 2 + (s12 * s12 + s31 * s31) / material.S12**2


def test_a_criterion_is_that_of_the_same_formula(scene: femlam.Scene) -> None:
    formula = "(s1 >= 0) * (s1/Xt)^2 + (s1 < 0) * (s1/Xc)^2 + (s12^2 + s13^2)/S12^2"
    same = {"name": "expression", "site": "ply", "expression": [f"fibre failure: {formula}"]}
    scene = scene.replace({"failure.criteria": [NAME, same], "march.end": "1 ms", "failure.every": "20 us"})
    events = scene.run(criteria=[YamadaSun()]).events
    assert events.rows > 0
    assert events.rows % 2 == 0
    own, other = (events["criterion"] == name for name in (NAME, "expression"))
    order = [np.lexsort([events[column][which] for column in ("cell", "ply")]) for which in (own, other)]
    for column in ("time_s", "cell", "index"):
        a, b = (events[column][which][by] for which, by in zip((own, other), order))
        np.testing.assert_allclose(a.astype(float), b.astype(float), rtol=1e-9)


def test_what_a_criterion_raises_ends_the_run(scene: femlam.Scene) -> None:
    class Raises(YamadaSun):
        def indices(self, stress, material):
            return stress[:, 0] / material.Xq

    class WrongShape(YamadaSun):
        def indices(self, stress, material):
            return np.zeros((len(stress), 2))

    scene = scene.replace({"failure.criteria": [NAME]})
    with pytest.raises(AttributeError, match="no constant `Xq`"):
        scene.run(criteria=[Raises()])
    with pytest.raises(femlam.FemError, match=r"shape \(\d+, 2\) for \d+ states and 1 modes"):
        scene.run(criteria=[WrongShape()])
    with pytest.raises(femlam.SceneError, match="there is no criterion `yamada-sun`"):
        scene.run()
    with pytest.raises(ValueError, match=r"failure\.criteria"):
        scene.replace({"failure.criteria": ["hashin-1980"]}).run(criteria=[YamadaSun()])


def test_the_contract_finds_what_is_wrong() -> None:
    class LosesNan(YamadaSun):
        def indices(self, stress, material):
            return np.nan_to_num(super().indices(stress, material))

    class FailsAtRest(YamadaSun):
        def indices(self, stress, material):
            return 1 + super().indices(stress, material)

    class LooksAtOthers(YamadaSun):
        def indices(self, stress, material):
            return super().indices(stress, material) * (1 + len(stress) * 1e-9)

    class IsNotInvariant(YamadaSun):
        def indices(self, stress, material):
            return (stress[:, 3] / material.S12) ** 2

    class UnknownStrength(YamadaSun):
        strengths = ("Xtt",)

    class WithoutModes(YamadaSun):
        modes = ()

    femlam.check_criterion(YamadaSun(), "AS4/3502")
    with pytest.raises(ValueError, match="`modes` is empty"):
        femlam.check_criterion(WithoutModes(), "AS4/3502")
    faults = {
        LosesNan: "NaN and passes",
        FailsAtRest: "without stress",
        LooksAtOthers: "indices_many",
        IsNotInvariant: "rotation",
    }
    for fault, words in faults.items():
        with pytest.raises(femlam.FemError, match=words):
            femlam.check_criterion(fault(), "AS4/3502")
    with pytest.raises(ValueError, match="strength `Xtt`"):
        femlam.check_criterion(UnknownStrength(), "AS4/3502")
    with pytest.raises(NotImplementedError):
        femlam.check_criterion(type("Bare", (YamadaSun,), {"indices": femlam.Criterion.indices})(), "AS4/3502")


def test_criteria_of_the_program_judge_arrays() -> None:
    material = femlam.material("AS4/3502")
    stress = np.zeros((4, 6))
    stress[:, 0] = np.array([1, 0.5, -1, 0]) * material.Xt
    found = femlam.indices("hashin-1980", stress, "AS4/3502")
    np.testing.assert_allclose(found["fibre tension"], [1, 0.25, 0, 0])
    with pytest.raises(femlam.FemError, match="no criterion `hashin`") as caught:
        femlam.indices("hashin", stress, "AS4/3502")
    assert "hashin-1980" in caught.value.help
    with pytest.raises(femlam.FemError, match="not finite"):
        femlam.indices("hashin-1980", stress + np.nan, "AS4/3502")
    with pytest.raises(ValueError, match="shape"):
        femlam.indices("hashin-1980", stress[0], "AS4/3502")
