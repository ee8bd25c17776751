import csv
import os
import signal
import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import femlam


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Ctrl-C stops this process, also where it was started in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def columns(path: Path) -> dict:
    with path.open() as file:
        header, *rows = csv.reader(file)
    return dict(zip(header, np.array(rows, dtype=float).T))


def files(folder: Path) -> dict:
    names = [path.name for path in folder.iterdir() if path.is_file() and path.name != "cost.json"]
    return {name: (folder / name).read_bytes() for name in names}


def test_an_impact_in_memory_is_that_of_the_files(scene: femlam.Scene, tmp_path: Path) -> None:
    result, into = scene.run(), scene.run(folder=tmp_path / "out", threads=2)
    assert result.completed
    assert (result.folder, into.folder) == (None, str(tmp_path / "out"))
    written = columns(tmp_path / "out" / "history.csv")
    assert list(written) == list(result.history)
    for name, column in result.history.items():
        assert column.tobytes() == written[name].tobytes() == into[name].tobytes()
    assert result.summary["impact"]["peak_force_N"] >= result.force.max()
    assert "peak" in str(result)


@pytest.mark.skipif("FEM" not in os.environ, reason="FEM does not name the command")
def test_its_bits_are_those_of_the_command_line(scene: femlam.Scene, tmp_path: Path) -> None:
    scene.save(tmp_path / "saved.toml")
    command = [os.path.abspath(os.environ["FEM"]), "run", "saved.toml", "--out", "command"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    femlam.Scene.load(tmp_path / "saved.toml").run(folder=tmp_path / "python")
    assert files(tmp_path / "python") == files(tmp_path / "command")


def test_columns_show_one_array_without_copies(scene: femlam.Scene) -> None:
    history = scene.run().history
    table = history["time_s"].base
    for k, column in enumerate(history.values()):
        assert column.__array_interface__["data"][0] == table.__array_interface__["data"][0] + k * column.nbytes
        assert column.flags.c_contiguous
    with pytest.raises(ValueError, match="read-only"):
        history["time_s"][0] = 1.0


def test_modes_belong_to_the_matrices(square: dict) -> None:
    scene = femlam.Scene.from_dict(square)
    modes, matrices = scene.modes(4), scene.matrices()
    # 35.985 sqrt(D/(rho h))/a^2, and the second mode twice.
    theory = 35.985 * np.sqrt(70e9 * 1e-9 / 12 / 0.91 / 2.7) / 0.01
    assert modes.omega[0] == pytest.approx(theory, rel=0.03)
    assert modes.frequencies[1] == pytest.approx(modes.frequencies[2], rel=1e-6)
    assert modes.shapes.shape == (4, matrices.stiffness.shape[0])
    assert matrices.stiffness.format == "csc"
    assert abs(matrices.stiffness - matrices.stiffness.T).max() == 0
    np.testing.assert_allclose(modes.shapes @ (matrices.mass @ modes.shapes.T), np.eye(4), atol=1e-9)
    bending = modes.shapes @ (matrices.stiffness @ modes.shapes.T)
    np.testing.assert_allclose(bending, np.diag(modes.omega**2), atol=1e-6 * modes.omega[3] ** 2)
    assert matrices.unknowns.rows == modes.unknowns.rows == matrices.stiffness.shape[0]
    assert set(matrices.unknowns["unknown"]) <= {f"U{n}{m}" for n in "123" for m in "0123"}
    assert len(scene.run().omega) == 10
    with pytest.raises(ValueError, match="count"):
        scene.modes(0)


def test_loads_at_rest(square: dict) -> None:
    load = {"pressure": "1 kPa", "face": "top"}
    result = femlam.Scene.from_dict({**square, "analysis": "static", "load": [load]}).run()
    assert isinstance(result, femlam.StaticResult)
    middle = np.argmin(np.hypot(*(result.places[:, :2] - result.places[:, :2].mean(axis=0)).T))
    # 0.00126 p a^4/D
    assert abs(result.displacements[middle, 2]) == pytest.approx(0.00126 * 1e3 * 1e-4 / (70e9 * 1e-9 / 12 / 0.91), rel=0.03)
    assert len(result.nodes) == len(result.places)


def test_stresses_through_the_thickness_are_those_of_pagano() -> None:
    scene = femlam.Scene.load(Path(__file__).parents[2] / "examples" / "pagano-0-90-0" / "scene.toml")
    centre = scene.run().profiles["centre"]
    # Exact: 59.06 MPa at the top of the centre.
    top = np.argmax(centre["z_m"])
    assert abs(centre["sxx_Pa"][top]) == pytest.approx(59.06e6, rel=1e-3)
    assert centre["ply"][top] == 3
    assert centre.units["sxx_Pa"] == "Pa"


def test_a_run_that_is_interrupted_goes_on_from_its_folder(scene: femlam.Scene, tmp_path: Path, interruptible: None) -> None:
    shares = []

    def interrupt(share: float) -> None:
        shares.append(share)
        signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        scene.run(folder=tmp_path / "out", progress=interrupt)
    assert len(shares) == 1
    assert (tmp_path / "out" / "checkpoint.bin").exists()
    scene.run(folder=tmp_path / "out", resume=True)
    scene.run(folder=tmp_path / "straight")
    assert files(tmp_path / "out") == files(tmp_path / "straight")
    with pytest.raises(ValueError, match="folder"):
        scene.run(resume=True)


def test_what_progress_raises_stops_the_run(scene: femlam.Scene) -> None:
    def stop(share: float) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        scene.run(progress=stop)
    shares: list = []
    scene.run(progress=shares.append)
    assert shares[0] == 0
    assert shares[-1] == 1
    assert shares == sorted(shares)


def test_threads_of_python_run_side_by_side(scene: femlam.Scene) -> None:
    with ThreadPoolExecutor(2) as pool:
        slow, fast = pool.map(lambda v: scene.replace({"impactor.velocity": v}).run(), ["1 m/s", "2 m/s"])
    assert slow.force.max() < fast.force.max()
    assert fast.force.tobytes() == scene.replace({"impactor.velocity": "2 m/s"}).run().force.tobytes()


def test_an_accuracy_is_reached_before_the_run(square: dict) -> None:
    scene = femlam.Scene.from_dict({**square, "modes": {"count": 1}})
    exact = scene.run(accuracy=0.05)
    assert exact.cost["accuracy_asked"]["asked"] == 0.05
    asked = scene.replace({"accuracy": "5 %"}).run()
    np.testing.assert_array_equal(asked.omega, exact.omega)
    for wrong in (0, 1, -1):
        with pytest.raises(ValueError, match="accuracy"):
            scene.run(accuracy=wrong)
    with pytest.raises(ValueError, match="threads"):
        scene.run(threads=0)
