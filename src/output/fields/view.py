"""Draws the fields beside this file: the plate as it deflects, and the plies pulled apart with what has failed in them.

    pip install pyvista
    python view.py                     in a window, with a slider for the time
    python view.py --save fields.png   as a picture
"""

import argparse
import json
from pathlib import Path

import numpy as np
import pyvista

HERE = Path(__file__).resolve().parent
BAR = {"vertical": False, "position_x": 0.15, "position_y": 0.05, "width": 0.7, "height": 0.08, "n_labels": 4, "fmt": "%.3g"}


def reader(name):
    """Of a series; None where the run has not written it."""
    path = HERE / f"{name}.pvd"
    return pyvista.get_reader(str(path)) if path.exists() else None


def frame(series, time):
    series.set_active_time_value(time)
    return series.read()[0]


def deflections(plate, times):
    return [float(-frame(plate, time)["displacement"][:, 2].min()) for time in times]


def draw_plate(plotter, grid, factor, limit):
    """The plate, its deflection drawn `factor` times as large."""
    grid["deflection, mm"] = -1e3 * grid["displacement"][:, 2]
    moved = grid.warp_by_vector("displacement", factor=factor)
    surface = moved.extract_surface(nonlinear_subdivision=2, algorithm=None)
    plotter.add_mesh(surface, scalars="deflection, mm", clim=[0, limit], cmap="viridis", name="plate", scalar_bar_args=BAR)


def first_onset(grid, criterion):
    """When the first mode reached 1 in each cell, s; infinite where none has."""
    onsets = [np.nan_to_num(grid[f"{criterion['name']} {mode} onset"], nan=np.inf) for mode in criterion["modes"]]
    return np.min(onsets, axis=0)


def judged(grid, criterion):
    """Corners of the part of the plate that the criterion looked at."""
    known = np.flatnonzero(np.isfinite(grid[f"{criterion['name']} index so far"]))
    points = grid.extract_cells(known).points
    return points.min(axis=0), points.max(axis=0)


def draw_plies(plotter, grid, criterion, stretch, limits):
    """Plies pulled apart; where they have failed in the colour of the time when they first did."""
    low, high = judged(grid, criterion)
    onset = first_onset(grid, criterion)
    for height in np.unique(grid.points[:, 2]):
        edge = pyvista.Box([low[0], high[0], low[1], high[1], stretch * height, stretch * height])
        plotter.add_mesh(edge, style="wireframe", color="lightgrey", name=f"face {height}")
    failed = grid.extract_cells(np.flatnonzero(np.isfinite(onset)))
    if failed.n_cells == 0:
        plotter.remove_actor("failed")
        return
    failed.points[:, 2] *= stretch
    failed["first onset, ms"] = 1e3 * onset[np.isfinite(onset)]
    shown = {"cmap": "plasma", "clim": limits, "name": "failed", "scalar_bar_args": BAR}
    plotter.add_mesh(failed.shrink(0.85), scalars="first onset, ms", **shown)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--time", type=float, metavar="S", help="the frame nearest to it; without it that of the largest deflection")
    options.add_argument("--criterion", metavar="NAME", help="whose damage of plies; without it that of the first")
    options.add_argument("--save", metavar="FILE", help="writes a picture instead of opening a window")
    given = options.parse_args()

    names = json.loads((HERE / "names.json").read_text(encoding="utf-8"))
    plate, plies = reader("plate"), reader("plies")
    criteria = {each["name"]: each for each in names["criteria"] if each["series"] == "plies"}
    if given.criterion and given.criterion not in criteria:
        options.error(f"no criterion {given.criterion!r} looks at plies, but {', '.join(criteria) or 'none'}")
    criterion = criteria.get(given.criterion) or next(iter(criteria.values()), None)
    last = frame(plies, plies.time_values[-1]) if plies and criterion else None
    if last is not None and f"{criterion['name']} index so far" not in last.cell_data:
        last = None  # only an impact has onsets
    if not plate and last is None:
        options.error("there is nothing to draw: the scene asks for neither `plate` nor `plies` of an impact")

    times = (plate or plies).time_values
    down = deflections(plate, times) if plate else [0.0] * len(times)
    start = times[int(np.argmax(down))] if given.time is None else min(times, key=lambda time: abs(time - given.time))

    plotter = pyvista.Plotter(off_screen=bool(given.save), shape=(1, bool(plate) + (last is not None)), window_size=(1300, 650))
    if plate:
        factor = 0.15 * max(np.ptp(frame(plate, start).points, axis=0)) / max(*down, 1e-30)
    if last is not None:
        size = np.subtract(*reversed(judged(last, criterion)))
        stretch = 0.6 * max(size) / size[2]
        onsets = first_onset(last, criterion)
        onsets = 1e3 * onsets[np.isfinite(onsets)]
        limits = [onsets.min(), onsets.max()] if onsets.size else [0, 1]

    def show(wanted):
        time = min(times, key=lambda time: abs(time - wanted))
        if plate:
            plotter.subplot(0, 0)
            draw_plate(plotter, frame(plate, time), factor, 1e3 * max(down))
            plotter.add_text(f"{1e3 * time:.4g} ms, displacements {factor:.3g} times as large", font_size=11, name="of plate")
        if last is not None:
            plotter.subplot(0, int(bool(plate)))
            draw_plies(plotter, frame(plies, time), criterion, stretch, limits)
            none = "" if onsets.size else ": nothing has failed"
            text = f"{criterion['name']}{none}; where it looks, thickness {stretch:.3g} times as large"
            plotter.add_text(text, font_size=11, name="of plies")

    show(start)
    for part in range(plotter.shape[1]):
        plotter.subplot(0, part)
        plotter.camera_position = "iso"
        plotter.camera.elevation = -10
        plotter.reset_camera()
        plotter.camera.zoom(0.9)
    if given.save:
        plotter.screenshot(given.save)
        return
    plotter.subplot(0, 0)
    plotter.add_slider_widget(show, [times[0], times[-1]], value=start, title="time, s", fmt="%.4g")
    plotter.show(title=names["title"])


main()
