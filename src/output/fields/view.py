"""Draws the fields beside this file: the plate as it deflects, and its plies and interfaces pulled apart with what has failed in them.

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


class Plate:
    """The plate, its deflection enlarged."""

    def __init__(self, series):
        self.series, self.times = series, series.time_values
        self.down = [float(-frame(series, time)["displacement"][:, 2].min()) for time in self.times]

    def begin(self, time):
        self.factor = 0.15 * max(np.ptp(frame(self.series, time).points, axis=0)) / max(*self.down, 1e-30)

    def draw(self, plotter, time):
        grid = frame(self.series, time)
        grid["deflection, mm"] = -1e3 * grid["displacement"][:, 2]
        moved = grid.warp_by_vector("displacement", factor=self.factor)
        surface = moved.extract_surface(nonlinear_subdivision=2, algorithm=None)
        shown = {"clim": [0, 1e3 * max(self.down)], "cmap": "viridis", "name": "plate", "scalar_bar_args": BAR}
        plotter.add_mesh(surface, scalars="deflection, mm", **shown)
        return f"{1e3 * time:.4g} ms, displacements {self.factor:.3g} times as large"


class Judged:
    """Plies or interfaces pulled apart: where they have failed, in the colour of the time when they first did; where nothing has
    failed to the end, those that have reached half of the largest index of all, in the colour of their own."""

    def __init__(self, series, criterion):
        self.series, self.criterion, self.times = series, criterion, series.time_values
        last = frame(series, self.times[-1])
        known = self.known(last)
        points = last.extract_cells(np.flatnonzero(known)).points
        self.low, self.high = points.min(axis=0), points.max(axis=0)
        size = self.high - self.low
        self.stretch = 0.6 * max(size) / size[2] if size[2] > 0 else 1.0
        onsets = self.onset(last)
        onsets = 1e3 * onsets[np.isfinite(onsets)]
        self.fails = onsets.size > 0
        indices = last[f"{criterion['name']} index so far"][known]
        self.limits = [onsets.min(), onsets.max()] if self.fails else [0.5 * indices.max(), indices.max()]

    def known(self, grid):
        """Whether the criterion looked at each cell."""
        return np.isfinite(grid[f"{self.criterion['name']} index so far"])

    def onset(self, grid):
        """When the first mode reached 1 in each cell, s; infinite where none has."""
        names = [f"{self.criterion['name']} {mode} onset" for mode in self.criterion["modes"]]
        return np.min([np.nan_to_num(grid[name], nan=np.inf) for name in names], axis=0)

    def begin(self, time):
        pass

    def draw(self, plotter, time):
        grid, name = frame(self.series, time), self.criterion["name"]
        for height in np.unique(grid.points[:, 2]):
            (x, y, _), (to_x, to_y, _), z = self.low, self.high, self.stretch * height
            edge = pyvista.Box([x, to_x, y, to_y, z, z])
            plotter.add_mesh(edge, style="wireframe", color="lightgrey", name=f"face {height}")
        onset, index = self.onset(grid), np.nan_to_num(grid[f"{name} index so far"])
        chosen = np.isfinite(onset) if self.fails else index >= max(self.limits[0], 1e-30)
        shown = grid.extract_cells(np.flatnonzero(chosen))
        if shown.n_cells == 0:
            plotter.remove_actor("judged")
        else:
            shown.points[:, 2] *= self.stretch
            scalars = "first onset, ms" if self.fails else "largest index so far"
            shown[scalars] = 1e3 * onset[chosen] if self.fails else index[chosen]
            looks = {"cmap": "plasma", "clim": self.limits, "name": "judged", "scalar_bar_args": BAR}
            plotter.add_mesh(shown.shrink(0.85), scalars=scalars, **looks)
        none = "" if self.fails else ": nothing fails"
        return f"{self.criterion['series']}: {name}{none}; thickness {self.stretch:.3g} times as large"


def judged(names, wanted, options):
    """What is drawn of plies and of interfaces: the first criterion of each that the run has onsets of, or the one that is wanted."""
    there = {}
    for criterion in names["criteria"]:
        series = reader(criterion["series"])
        if series and f"{criterion['name']} index so far" in frame(series, series.time_values[-1]).cell_data:
            there[criterion["name"]] = series, criterion
    if wanted and wanted not in there:
        options.error(f"there is no damage by {wanted!r} in these fields, but by: {', '.join(there) or 'none'}")
    first = {}
    for name, (series, criterion) in there.items():
        if name == wanted or not wanted:
            first.setdefault(criterion["series"], Judged(series, criterion))
    return list(first.values())


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--time", type=float, metavar="S", help="the frame nearest to it; without it that of the largest deflection")
    options.add_argument("--criterion", metavar="NAME", help="whose damage alone; without it that of the first for plies and for interfaces")
    options.add_argument("--save", metavar="FILE", help="writes a picture instead of opening a window")
    given = options.parse_args()

    names = json.loads((HERE / "names.json").read_text(encoding="utf-8"))
    plate = reader("plate")
    parts = ([Plate(plate)] if plate else []) + judged(names, given.criterion, options)
    if not parts:
        options.error("there is nothing to draw: the scene asks for neither `plate` nor damage of an impact")
    times = parts[0].times
    down = parts[0].down if plate else [0.0]
    start = times[int(np.argmax(down))] if given.time is None else min(times, key=lambda time: abs(time - given.time))
    plotter = pyvista.Plotter(off_screen=bool(given.save), shape=(1, len(parts)), window_size=(650 * len(parts), 650))

    def show(wanted):
        time = min(times, key=lambda time: abs(time - wanted))
        for column, part in enumerate(parts):
            plotter.subplot(0, column)
            plotter.add_text(part.draw(plotter, time), font_size=10, name="title")

    for part in parts:
        part.begin(start)
    show(start)
    for column in range(len(parts)):
        plotter.subplot(0, column)
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
