from pathlib import Path

import numpy as np
import pytest

import femlam


@pytest.fixture
def small(square: dict) -> femlam.Scene:
    square["mesh"]["cells"] = [4, 4]
    return femlam.Scene.from_dict({**square, "modes": {"count": 1}})


def test_a_study_names_the_scene_that_keeps_an_error(small: femlam.Scene, tmp_path: Path) -> None:
    shares: list = []
    study = small.study(["mesh"], budget=60, tolerance=0.1, folder=tmp_path / "study", progress=shares.append)
    assert shares[-1] == 1
    assert study.table.rows == len(study.summary["runs"]) > 2
    assert study.summary["ladders"][0]["axis"] == "mesh"
    assert "mesh" in str(study)
    assert (tmp_path / "study" / "study.md").exists()
    # 35.985 sqrt(D/(rho h))/a^2
    theory = 35.985 * np.sqrt(70e9 * 1e-9 / 12 / 0.91 / 2.7) / 0.01
    assert study.kept_by is not None
    assert study.kept_by.run().omega[0] == pytest.approx(theory, rel=0.1)
    again = small.study(["mesh"], budget=60, folder=tmp_path / "study", resume=True)
    np.testing.assert_array_equal(again["unknowns"][:2], study["unknowns"][:2])
    with pytest.raises(ValueError, match="folder"):
        small.study(resume=True)


def test_a_study_can_be_stopped(small: femlam.Scene) -> None:
    def stop(share: float) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        small.study(["mesh"], progress=stop)
