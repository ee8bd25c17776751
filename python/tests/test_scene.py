import pickle
from pathlib import Path

import numpy as np
import pytest

import femlam


class Quantity:
    """What pint's quantities look like."""

    class Units:
        def __format__(self, spec: str) -> str:
            assert spec == "~C"
            return "kg/m**3"

    magnitude, units = 2700.0, Units()


def test_a_scene_is_read_by_its_keys(scene: femlam.Scene) -> None:
    assert scene["impactor.velocity"] == "1.56 m/s"
    assert scene["laminate.layers"] == [4, 4]
    assert scene["reduction"] == {"method": "ritz", "vectors": 60}, "the preset's"
    assert scene["support"][0] == {"group": "support", "at": "mid-plane", "fix": ["U30"]}
    assert scene["output.plots"] is False
    assert scene.quantity("march.end") == 1e-4
    assert "march.end" in scene
    assert "march" in scene
    assert "march.ende" not in scene
    with pytest.raises(KeyError, match=r"did you mean march\.end"):
        scene["march.ende"]
    assert "8 plies" in repr(scene)
    assert "<pre>" in scene._repr_html_()


def test_other_values_are_checked_and_the_first_scene_stays(scene: femlam.Scene) -> None:
    faster = scene.replace({"impactor.velocity": "3 m/s", "mesh.refine": np.int64(1)})
    assert (faster["impactor.velocity"], faster["mesh.refine"]) == ("3 m/s", 1)
    assert scene["impactor.velocity"] == "1.56 m/s"
    assert "# Case 3" in faster.text, "comments stay"
    with pytest.raises(femlam.SceneError) as caught:
        scene.replace({"impactor.velocity": "3 mm", "impactor.mass": 3})
    first, second = caught.value.mistakes
    assert first.message == "`impactor.mass`: `3` is a bare number"
    assert "mass = 3" in first.text
    assert second.text[second.column - 1 :] == '"3 mm"'
    with pytest.raises(femlam.FemError, match=r"`title\.short`"):
        scene.replace({"title.short": 1})


def test_all_mistakes_of_a_file_are_told_with_their_places(folder: Path) -> None:
    path = folder / "scene.toml"
    text = path.read_text().replace('"1.56 m/s"', '"1.56 mm"').replace('"2.49 kg"', '"2.49"')
    path.write_text(text)
    with pytest.raises(femlam.SceneError) as caught:
        femlam.Scene.load(path)
    error = pickle.loads(pickle.dumps(caught.value))
    assert [Path(mistake.file).name for mistake in error.mistakes] == ["scene.toml"] * 2
    lines = [1 + text[: text.index(place)].count("\n") for place in ('"2.49"', '"1.56 mm"')]
    assert [mistake.line for mistake in error.mistakes] == lines
    assert "accepted: m/s" in error.mistakes[1].help
    assert (error.line, error.column) == (lines[0], 8)
    assert f"scene.toml:{lines[0]}:8: `impactor.mass`: `2.49` is a bare number" in str(error)
    assert isinstance(error, ValueError)
    with pytest.raises(femlam.FemError, match="cannot read the scene"):
        femlam.Scene.load(folder / "nothing.toml")


def test_quantities_of_pint_have_their_units(scene: femlam.Scene) -> None:
    pint = pytest.importorskip("pint")
    units = pint.UnitRegistry()
    other = scene.replace({"impactor.velocity": 2.5 * units.m / units.s, "impactor.mass": 800 * units.gram})
    assert other.quantity("impactor.velocity") == 2.5
    assert other.quantity("impactor.mass") == 0.8
    with pytest.raises(femlam.SceneError, match="is a length, not a velocity"):
        scene.replace({"impactor.velocity": 2 * units.mm})


def test_what_the_mesh_lacks_is_told_with_the_line_of_the_scene(folder: Path) -> None:
    scene = femlam.Scene.load(folder / "scene.toml").replace({"impactor.at": {"group": "impakt"}})
    with pytest.raises(femlam.SceneError, match="impakt") as caught:
        scene.check()
    assert 'at = { group = "impakt" }' in caught.value.mistakes[0].text


def test_a_dictionary_makes_a_scene(square: dict, tmp_path: Path) -> None:
    square["materials"]["sheet"]["density"] = Quantity()
    square["mesh"]["cells"] = np.array([12, 12])
    scene = femlam.Scene.from_dict(square)
    assert scene["materials.sheet.density"] == "2700.0 kg/m^3"
    assert scene.check() == []
    scene.save(tmp_path / "scene.toml")
    assert femlam.Scene.load(tmp_path / "scene.toml").keys() == scene.keys()
    with pytest.raises(femlam.SceneError, match="<dict>:"):
        femlam.Scene.from_dict({**square, "titel": "x"})
    with pytest.raises(TypeError):
        femlam.Scene.from_dict({**square, "title": None})
    with pytest.raises(TypeError):
        femlam.Scene.from_dict({**square, "title": object()})


def test_a_scene_goes_to_other_processes(scene: femlam.Scene) -> None:
    other = pickle.loads(pickle.dumps(scene))
    assert (other.text, other.name, other.check()) == (scene.text, scene.name, [])
    assert {scene: 1}[other] == 1
    assert other != scene.replace({"impactor.velocity": "3 m/s"})


def test_a_saved_scene_can_lie_anywhere(scene: femlam.Scene, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    scene.save(tmp_path / "elsewhere" / "scene.toml")
    assert femlam.Scene.load(tmp_path / "elsewhere" / "scene.toml").check() == []


def test_laminate_and_material(scene: femlam.Scene) -> None:
    laminate = scene.laminate()
    material = femlam.material("AS4/3502")
    assert laminate.angles == [0, 45, -45, 90, 90, -45, 45, 0]
    assert laminate.thickness == pytest.approx(8 * 0.13208e-3)
    # Invariants of quasi-isotropic laminates: A11 = (3 Q11 + 3 Q22 + 2 Q12 + 4 Q66) h/8.
    share = 1 - material.nu12**2 * material.E2 / material.E1
    q11, q22, q12 = material.E1 / share, material.E2 / share, material.nu12 * material.E2 / share
    expected = (3 * q11 + 3 * q22 + 2 * q12 + 4 * material.G12) / 8 * laminate.thickness
    np.testing.assert_allclose(laminate.A[0, 0], expected, rtol=1e-12)
    assert abs(laminate.B).max() < 1e-9 * laminate.A[0, 0] * laminate.thickness
    with pytest.raises(KeyError, match="AS4/3502"):
        femlam.material("AS4/3520")
    with pytest.raises(AttributeError, match="no constant `X`"):
        material.X  # noqa: B018


def test_advice(scene: femlam.Scene, square: dict) -> None:
    (advice,) = scene.advise()
    assert advice.mass_kg == 2.49
    assert {"regime", "membrane"} <= {answer["question"] for answer in advice.answers}
    assert "regime" in str(advice)
    with pytest.raises(femlam.FemError, match="no impact") as caught:
        femlam.Scene.from_dict(square).advise()
    assert 'analysis = "impact"' in caught.value.help
