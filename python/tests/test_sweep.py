import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import femlam

SET = {"laminate.plies": ["[0/45/-45/90]s", "[45/-45/0/90]s"], "impactor.velocity": "1..3:3"}


def test_rows_are_runs(scene: femlam.Scene, tmp_path: Path) -> None:
    shares: list = []
    sweep = scene.sweep(SET, threads=2, progress=shares.append)
    assert sweep.table.rows == sweep.summary["cases"] == 6
    assert sweep["impactor.velocity [m/s]"].tolist() == [1, 2, 3] * 2
    own = scene.replace({"laminate.plies": SET["laminate.plies"][1], "impactor.velocity": "2 m/s"}).run()
    assert sweep["peak_force_N"][4] == own.summary["impact"]["peak_force_N"]
    assert shares[-1] == 1
    assert sweep.folder is None
    assert "6 cases" in repr(sweep)
    kept = scene.sweep(SET, folder=tmp_path / "sweep")
    np.testing.assert_array_equal(kept["peak_force_N"], sweep["peak_force_N"])
    assert (tmp_path / "sweep" / "sweep.csv").exists()
    assert scene.sweep(SET, folder=tmp_path / "sweep", resume=True).table.rows == 6


def test_formulas_are_columns_and_are_weighed_against_each_other(scene: femlam.Scene) -> None:
    sweep = scene.sweep(SET, quantities={"share": "absorbed_energy / energy"}, pareto="least peak_force, most energy")
    energies = [sweep[name] for name in ("absorbed_energy_J", "energy_J")]
    np.testing.assert_allclose(sweep["share"], energies[0] / energies[1], rtol=1e-14)
    assert 1 <= len(sweep.summary["pareto_front"]) < 6
    with pytest.raises(femlam.FemError, match="peak_force"):
        scene.sweep(SET, quantities={"share": "peak_force + energy"})


@pytest.mark.skipif("FEM" not in os.environ, reason="FEM does not name the command")
def test_its_table_is_that_of_the_command_line(scene: femlam.Scene, tmp_path: Path) -> None:
    scene.save(tmp_path / "scene.toml")
    words = ["--set", "materials.as4-3502.Yt=normal(50 MPa, 8 %)", "--samples", "4", "--seed", "3", "--out", "command"]
    subprocess.run([os.path.abspath(os.environ["FEM"]), "sweep", "scene.toml", *words], cwd=tmp_path, check=True)
    scatters = {"materials.as4-3502.Yt": "normal(50 MPa, 8 %)"}
    sweep = scene.sweep(scatters, samples=4, seed=3, folder=tmp_path / "python")
    assert (tmp_path / "python" / "sweep.csv").read_bytes() == (tmp_path / "command" / "sweep.csv").read_bytes()
    assert sweep.summary["scatter"]


def test_a_sweep_that_is_stopped_goes_on(scene: femlam.Scene, tmp_path: Path) -> None:
    def stop(share: float) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        scene.sweep(SET, folder=tmp_path / "sweep", progress=stop)
    went_on = scene.sweep(SET, folder=tmp_path / "sweep", resume=True)
    np.testing.assert_array_equal(went_on["peak_force_N"], scene.sweep(SET)["peak_force_N"])


def test_what_makes_no_sense_is_refused(scene: femlam.Scene) -> None:
    with pytest.raises(femlam.FemError, match=r"impactor\.velocity"):
        scene.sweep({"impactor.velocity": "1 mm,2 mm"})
    with pytest.raises(ValueError, match="folder"):
        scene.sweep(SET, resume=True)
