import pickle
from pathlib import Path

import numpy as np
import pytest

import femlam


@pytest.fixture
def result(scene: femlam.Scene) -> femlam.ImpactResult:
    return scene.replace({"march.end": "0.3 ms"}).run()


def test_tables_are_frames(result: femlam.ImpactResult) -> None:
    pytest.importorskip("pandas")
    frame, events = result.history.frame(), result.events.frame()
    assert frame.attrs["units"]["impactor_velocity_m_s"] == "m/s"
    assert frame["contact_force_N"].max() == result.force.max()
    assert next(iter(events["mode"])) == result.summary["first_damage"][0]["mode"]
    assert events["time_s"].is_monotonic_increasing
    assert (events["index"] >= 1).all()
    assert events.attrs["units"]["angle_deg"] == "°"


def test_tables_are_frames_of_polars(result: femlam.ImpactResult) -> None:
    pytest.importorskip("polars")
    frame, events = result.history.polars(), result.events.polars()
    np.testing.assert_array_equal(frame["contact_force_N"].to_numpy(), result.force)
    assert (events.height, events["mode"][0]) == (result.events.rows, result.events["mode"][0])


def test_the_force_is_drawn(result: femlam.ImpactResult) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    axes = pyplot.figure().subplots()
    assert result.plot_force(axes) is axes
    line = axes.get_lines()[0]
    np.testing.assert_allclose(line.get_ydata(), result.force)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("Time (µs)", "Contact force (N)")
    assert len(axes.get_lines()) == 1 + len(result.summary["first_damage"])
    pyplot.close("all")


def test_columns_are_drawn(result: femlam.ImpactResult) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    axes = result.plot("impactor_velocity_m_s", "plate_displacement_m")
    assert [line.get_label() for line in axes.get_lines()] == ["impactor_velocity_m_s", "plate_displacement_m"]
    np.testing.assert_array_equal(axes.get_lines()[0].get_ydata(), result["impactor_velocity_m_s"])
    with pytest.raises(KeyError, match="velocity"):
        result.plot("velocity", ax=axes)
    assert len(axes.get_lines()) == 2
    pyplot.close("all")


def test_results_go_to_other_processes(result: femlam.ImpactResult) -> None:
    other = pickle.loads(pickle.dumps(result))
    assert other.force.tobytes() == result.force.tobytes()
    assert other.summary == result.summary


def test_notebooks_show_results(result: femlam.ImpactResult) -> None:
    assert "peak" in result._repr_html_()
    assert result.history._repr_html_().count("<tr>") == 11
    assert "rows" in repr(result.history)
    assert result.warnings == result.summary["warnings"]


def test_fields_are_read_by_their_times(scene: femlam.Scene, square: dict, tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    asked = scene.replace({"output.fields.every": "50 us"})
    result = asked.run(folder=tmp_path / "out")
    plate = result.fields()
    assert list(plate) == pytest.approx([0, 5e-5, 1e-4])
    deflections = [abs(grid.point_data["displacement"][:, 2]).max() for grid in plate.values()]
    assert deflections[0] < deflections[1] < deflections[2]
    # The history has the mean over the patch of the contact.
    assert deflections[2] == pytest.approx(abs(result["plate_displacement_m"][-1]), rel=0.2)
    assert set(result.fields("plies")) == set(plate)
    meshio = pytest.importorskip("meshio")
    plies = list(result.fields("plies", read=meshio.read).values())
    assert plies[-1].cell_data["stress"][0].shape[1] == 6
    with pytest.raises(ValueError, match="of: interfaces, plate, plies"):
        result.fields("layers")
    with pytest.raises(ValueError, match="folder"):
        scene.run().fields()
    load = {"pressure": "1 kPa", "face": "top"}
    rest = femlam.Scene.from_dict({**square, "analysis": "static", "load": [load], "output": {"fields": True}})
    assert len(rest.run(folder=tmp_path / "rest").fields()) == 1
