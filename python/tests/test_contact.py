import numpy as np
import pytest

import femlam

K, RELEASE = 3.4e9, 0.2137


class Hertz(femlam.ContactLaw):
    """Hertz' law."""

    name = "own-hertz"

    def force(self, history, indentation):
        root = max(indentation, 0) ** 0.5
        return K * root**3, 1.5 * K * root

    def energy(self, history, indentation):
        return 0.4 * K * max(indentation, 0) ** 2.5, 0


class Spring(femlam.ContactLaw):
    """A spring that gives back less than it takes: below the largest force so far it follows a steeper line."""

    name = "lossy-spring"

    def force(self, history, indentation):
        if indentation >= history[0]:
            return K * max(indentation, 0), K * (indentation > 0)
        steep, dent = K / (1 - RELEASE), RELEASE * history[0]
        return steep * max(indentation - dent, 0), steep * (indentation > dent)

    def energy(self, history, indentation):
        largest = max(history[0], indentation, 0)
        stored = self.force([largest], indentation)[0] * max(indentation - RELEASE * largest, 0) / 2
        return stored, RELEASE * K * largest**2 / 2

    def commit(self, history, indentation):
        return [max(history[0], indentation)]

    def branches(self, history):
        return RELEASE * history[0], history[0]


def struck(scene: femlam.Scene, **contact: object) -> femlam.Scene:
    return scene.replace({"contact": contact})


def test_a_law_is_that_of_the_program(scene: femlam.Scene) -> None:
    own = struck(scene, law="own-hertz").run(laws=[Hertz()])
    other = struck(scene, law="hertz", k="3.4e9 N/m^1.5").run()
    assert own.force.max() > 0
    np.testing.assert_allclose(own.force, other.force, rtol=1e-9, atol=1e-9 * other.force.max())
    plate = struck(scene, law="own-hertz").plate(laws=[Hertz()])
    np.testing.assert_array_equal(plate.impact().force, own.force)


def test_the_contract_finds_what_is_wrong() -> None:
    class Pulls(Hertz):
        def force(self, history, indentation):
            force, tangent = super().force(history, indentation)
            return force if indentation > 0 else K * indentation, tangent

    class Stiff(Hertz):
        def force(self, history, indentation):
            force, tangent = super().force(history, indentation)
            return force, 2 * tangent

    class Spends(Hertz):
        def energy(self, history, indentation):
            return 0.5 * K * max(indentation, 0) ** 2.5, 0

    class Remembers(Spring):
        def commit(self, history, indentation):
            return [0.0] * 9

    class Words(Hertz):
        def force(self, history, indentation):
            return "much"

    for law in (Hertz(), Spring()):
        femlam.check_contact_law(law, 1e-4)
    for fault, words in {Pulls: "negative", Stiff: "tangent", Spends: "work"}.items():
        with pytest.raises(femlam.FemError, match=words):
            femlam.check_contact_law(fault(), 1e-4)
    with pytest.raises(femlam.FemError, match="remembers 9 numbers"):
        femlam.check_contact_law(Remembers(), 1e-4)
    with pytest.raises(ValueError, match="`force` of the contact law `own-hertz`"):
        femlam.check_contact_law(Words(), 1e-4)


def test_what_a_law_raises_ends_the_run(scene: femlam.Scene) -> None:
    class Raises(Hertz):
        def force(self, history, indentation):
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        struck(scene, law="own-hertz").run(laws=[Raises()])
    with pytest.raises(femlam.SceneError, match="own-hertz"):
        struck(scene, law="own-hertz").run()
    with pytest.raises(ValueError, match=r"contact\.law"):
        scene.run(laws=[Hertz()])
