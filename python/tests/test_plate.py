import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from test_criterion import YamadaSun

import femlam


@pytest.fixture
def plate(scene: femlam.Scene) -> femlam.Plate:
    return scene.plate()


def bits(result: femlam.Result) -> dict:
    assert isinstance(result, femlam.ImpactResult)
    tables = {**result.history, **result.events}
    return {name: column.tolist() for name, column in tables.items()}


def test_an_impact_has_the_bits_of_a_run(scene: femlam.Scene, plate: femlam.Plate) -> None:
    impacts = [
        ({"mass": 3, "velocity": 2.5}, {"impactor.mass": "3 kg", "impactor.velocity": "2.5 m/s"}),
        ({"velocity": "0.9 m/s"}, {"impactor.velocity": "0.9 m/s"}),
        ({"energy": 3, "keys": {"contact.beta": 0.5}}, {"impactor.energy": "3 J", "contact.beta": 0.5}),
        ({}, {}),
    ]
    with ThreadPoolExecutor(2) as pool:
        struck = list(pool.map(lambda impact: plate.impact(**impact[0]), impacts))
    for (_, keys), found in zip(impacts, struck):
        assert bits(found) == bits(scene.replace(keys).run())
    assert repr(plate).startswith("<Plate of <Scene")


def test_two_plates_are_struck_at_once(scene: femlam.Scene, plate: femlam.Plate) -> None:
    other = scene.replace({"laminate.plies": "[0/90]2s"}).plate()
    with ThreadPoolExecutor(2) as pool:
        both = list(pool.map(lambda plate: [plate.impact(velocity=v).force for v in (1, 2)], (plate, other)))
    for found, struck in zip(both, (plate, other)):
        for force, velocity in zip(found, (1, 2)):
            np.testing.assert_array_equal(force, struck.impact(velocity=velocity).force)
    assert both[0][0].max() != both[1][0].max()


def test_what_belongs_to_the_plate_is_refused(scene: femlam.Scene, plate: femlam.Plate) -> None:
    with pytest.raises(femlam.FemError, match=r"`mesh\.refine` belongs to the plate") as caught:
        plate.impact({"mesh.refine": 1})
    assert "contact law" in caught.value.help
    with pytest.raises(femlam.SceneError, match="velocity"):
        plate.impact(velocity="2 mm")
    with pytest.raises(femlam.FemError, match="no plate can be kept"):
        scene.replace({"reduction": {"method": "none"}}).plate()
    with pytest.raises(ValueError, match=r"failure\.criteria"):
        scene.plate(criteria=[YamadaSun()])


def test_a_plate_is_struck_with_criteria_of_ones_own(scene: femlam.Scene) -> None:
    class Raises(YamadaSun):
        def indices(self, stress, material):
            return stress[:, 0] / material.Xq

    scene = scene.replace({"failure.criteria": ["yamada-sun"]})
    own = scene.plate(criteria=[YamadaSun()])
    assert bits(own.impact(velocity=3)) == bits(scene.replace({"impactor.velocity": "3 m/s"}).run(criteria=[YamadaSun()]))
    with pytest.raises(AttributeError, match="no constant `Xq`"):
        scene.plate(criteria=[Raises()]).impact()


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="the system does not tell the memory of a process")
def test_impacts_leave_no_memory_behind(scene: femlam.Scene) -> None:
    def resident() -> int:
        return int(re.search(r"VmRSS:\s+(\d+) kB", Path("/proc/self/status").read_text())[1])

    plate = scene.replace({"march.end": "20 us"}).plate()

    def strike(times: int) -> None:
        for k in range(times):
            plate.impact(velocity=1 + k % 7)

    strike(40)
    before = resident()
    strike(160)
    # A history of an impact is 10 kB.
    assert resident() - before < 2000
