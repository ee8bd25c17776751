from pathlib import Path

import numpy as np
import pytest

import femlam

EXAMPLE = Path(__file__).parents[2] / "examples" / "plugin-ply-law" / "scene.toml"
CURVE = {"name": "hahn-tsai", "alpha": "2.4e-8 1/MPa^3", "unloading": "elastic"}


class HahnTsai(femlam.PlyLaw):
    """Hahn and Tsai's shear, elastic."""

    name = "own-hahn-tsai"
    dimensions = {"alpha": (3, -3, 6)}
    alpha = 2.4e-26

    def respond(self, point, strain, old):
        g, gamma = point.stiffness[3, 3], strain[3]
        k = 2 / np.sqrt(3 * self.alpha * g)
        tau = k * np.sinh(np.arcsinh(3 * g * gamma / k) / 3)
        stress, tangent = point.stiffness @ strain, point.stiffness.copy()
        stored = (stress @ strain - g * gamma**2 + tau**2 / g) / 2 + 0.75 * self.alpha * tau**4
        stress[3] = tau
        tangent[3, 3] = g / (1 + 3 * self.alpha * g * tau**2)
        return femlam.PlyAnswer(stress, tangent, stored)


class Cracks(femlam.PlyLaw):
    """Shear stiffness that the largest shear so far takes a share of."""

    name = "own-cracks"
    state = ("largest shear",)
    onset, share = 2e-3, 20.0

    def respond(self, point, strain, old):
        g, gamma = point.stiffness[3, 3], abs(strain[3])
        largest, grows = max(old[0], gamma - self.onset, 0), gamma - self.onset > old[0]
        rest = 1 / (1 + self.share * largest)
        stress, tangent = point.stiffness @ strain, point.stiffness.copy()
        stress[3] *= rest
        tangent[3, 3] *= rest - self.share * rest**2 * gamma * grows
        # ∫ ½ G γ² |d rest| over the largest shear, γ = onset + largest
        s, c = self.share, self.onset - 1 / self.share
        x = 1 + s * largest
        lost = g / (2 * s**2) * (x - 1 + 2 * s * c * np.log(x) + s**2 * c**2 * (1 - 1 / x))
        return femlam.PlyAnswer(stress, tangent, stress @ strain / 2, lost, [largest])


def sheared(**keys: object) -> femlam.Scene:
    laws = EXAMPLE.read_text(encoding="utf-8").replace("shear-cracks", "own-hahn-tsai")
    laws = laws.replace(", onset = 0.005, spread = 0.02, most = 0.4", "")
    return femlam.Scene.from_text(laws).replace(keys)


def test_a_law_is_that_of_the_program() -> None:
    own = sheared().run(laws=[HahnTsai()])
    other = sheared(**{"materials.tape.law": CURVE}).run()
    assert abs(own.displacements).max() > 1e-5
    np.testing.assert_allclose(own.displacements, other.displacements, rtol=1e-7, atol=1e-12)
    with pytest.raises(femlam.SceneError, match="own-hahn-tsai"):
        sheared().run()
    with pytest.raises(ValueError, match=r"materials\.NAME\.law"):
        sheared(**{"materials.tape.law": CURVE}).run(laws=[HahnTsai()])


def test_a_point_knows_how_thick_the_plies_of_one_angle_are() -> None:
    seen = set()

    class Sees(HahnTsai):
        def respond(self, point, strain, old):
            seen.add(round(1e6 * point.thickness))
            return super().respond(point, strain, old)

    sheared(**{"laminate.plies": "[0/0/90]", "laminate.layers": [2, 1]}).run(laws=[Sees()])
    assert seen == {2000, 1000}


def test_the_contract_finds_what_is_wrong() -> None:
    class Stiff(HahnTsai):
        def respond(self, point, strain, old):
            found = super().respond(point, strain, old)
            found.tangent[3, 3] *= 1.01
            return found

    class Spends(HahnTsai):
        def respond(self, point, strain, old):
            found = super().respond(point, strain, old)
            found.stored *= 1.1
            return found

    class WithoutUnits(HahnTsai):
        dimensions = {}

    class Remembers(HahnTsai):
        largest = 0.0

        def respond(self, point, strain, old):
            found = super().respond(point, strain, old)
            self.largest = max(self.largest, abs(strain[3]))
            found.stress[3] *= 1 - self.largest
            return found

    class Short(HahnTsai):
        def respond(self, point, strain, old):
            return femlam.PlyAnswer(np.zeros(3), point.stiffness, 0)

    class Unknown(HahnTsai):
        toughnesses = ("GIIIc",)

    femlam.check_ply_law(Cracks(), "AS4/3502")
    for fault in (Stiff, Spends, WithoutUnits, Remembers):
        with pytest.raises(femlam.FemError, match="own-hahn-tsai"):
            femlam.check_ply_law(fault(), "AS4/3502")
    with pytest.raises(femlam.FemError, match=r"stress of shape \(3,\)"):
        femlam.check_ply_law(Short(), "AS4/3502")
    with pytest.raises(ValueError, match="toughness `GIIIc`"):
        femlam.check_ply_law(Unknown(), "AS4/3502")


def test_what_a_law_raises_ends_the_run() -> None:
    class Raises(HahnTsai):
        def respond(self, point, strain, old):
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        sheared().run(laws=[Raises()])
