"""Reads the fields of a run with PyVista and meshio and compares them with its tables.

usage: read_back.py RESULTS lagrange|subdivided QUADS LAYERS PLIES VOLUME_MM3 X_MM Y_MM
"""

import csv
import json
import math
import sys
from pathlib import Path

import meshio
import numpy as np
import pyvista

results, cells = Path(sys.argv[1]), sys.argv[2]
quads, layers, plies = map(int, sys.argv[3:6])
volume, x, y = float(sys.argv[6]) * 1e-9, float(sys.argv[7]) * 1e-3, float(sys.argv[8]) * 1e-3


def table(name):
    with open(results / name, newline="") as file:
        return list(csv.DictReader(file))


def frames(name):
    reader = pyvista.get_reader(str(results / "fields" / f"{name}.pvd"))
    for number, time in enumerate(reader.time_values, 1):
        reader.set_active_time_value(time)
        yield number, time, reader.read()[0]


def check(condition, what):
    if not condition:
        sys.exit(f"{what} is not as expected")


history = {float(row["time_s"]): row for row in table("history.csv")}
# Of all windows of a cell, some of which lie in several cells; four digits.
damage = json.loads((results / "damage.json").read_text())
judged = [damage["cells"][quad] for quad in damage["judged"]]
maxima = {(cell, place["ply"]): index for place in damage["places"] for cell, index in zip(judged, place["index"])}

# The plate: its size, and under the impactor the displacement of the history.
count = quads * layers * (1 if cells == "lagrange" else 27)
seen = 0
for number, time, grid in frames("plate"):
    check(grid.n_cells == count, f"{grid.n_cells} cells")
    check(set(grid.celltypes) == {72 if cells == "lagrange" else 12}, "the type of the cells")
    measured = grid.compute_cell_sizes(length=False, area=False)["Volume"].sum()
    check(abs(measured / volume - 1) < 1e-9, f"a volume of {measured}")
    row = min(history.values(), key=lambda row: abs(float(row["time_s"]) - time))
    check(abs(float(row["time_s"]) - time) < 1e-12, f"the time {time}")
    top = grid.points[:, 2].max()
    at = np.argmin(np.linalg.norm(grid.points - [x, y, top], axis=1))
    w, want = -grid["displacement"][at, 2], float(row["plate_displacement_m"])
    check(abs(w - want) <= 1e-6 * abs(want), f"a displacement of {w} at {time}, not {want}")
    check(-grid["displacement"][:, 2].min() >= 0.999999 * want, "the largest deflection")
    # Between the points it is interpolated: just below the node that is struck there is about as much.
    probe = pyvista.PolyData(np.array([[x + 1e-5, y + 1e-5, top - 1e-5]])).sample(grid)
    check(probe["vtkValidPointMask"].all(), "the place below the impactor")
    check(abs(probe["displacement"][0, 2] + w) <= 0.01 * abs(w) + 1e-15, "the displacement beside the node")
    seen += 1
check(seen == 5, f"{seen} frames")

# Plies and interfaces: what they are, and their largest indices over all samples.
for name, criterion, sheets in [("plies", "hashin-report", plies), ("interfaces", "octahedral", plies - 1)]:
    largest = np.zeros(quads * sheets)
    for number, time, grid in frames(name):
        check(grid.n_cells == quads * sheets, f"{grid.n_cells} cells of {name}")
        largest = np.maximum(largest, grid[f"{criterion} index"])
        other = meshio.read(results / "fields" / f"{name}-{number:04}.vtu")
        check(np.array_equal(other.points, grid.points), f"meshio: the points of {name}")
        check(sum(len(block.data) for block in other.cells) == grid.n_cells, f"meshio: the cells of {name}")
        for array in grid.cell_data:
            check(np.array_equal(other.cell_data[array][0], grid[array], equal_nan=True), f"meshio: {array} of {name}")
        check(np.array_equal(other.point_data["displacement"], grid["displacement"]), "meshio: displacement")
    if name == "plies":
        measured = grid.compute_cell_sizes(length=False, area=False)["Volume"].sum()
        check(abs(measured / volume - 1) < 1e-9, f"a volume of {measured}")
        angles = [0, 45, -45, 90] * 2
        check(np.array_equal(grid["angle_deg"], (angles + angles[::-1]) * quads), "the angles")
        check(np.array_equal(grid["ply"], list(range(1, plies + 1)) * quads), "the plies")
        heights = grid.cell_centers().points[:, 2].reshape(quads, plies)
        check((np.diff(heights, axis=1) > 0).all(), "the order of the plies")
        places = [str(ply) for ply in grid["ply"]]
        check(grid["stress"].shape == (grid.n_cells, 6), "the stress")
    else:
        places = [f"{ply}|{ply + 1}" for ply in grid["ply_below"]]
    for cell, place, index in zip(grid["cell"], places, largest):
        want = maxima[(cell, place)]
        check(math.isclose(index, want, rel_tol=6e-4), f"an index of {index} in {place} of {cell}, not {want}")

if cells == "subdivided":
    other = meshio.read(results / "fields" / "plate-0005.vtu")
    check(sum(len(block.data) for block in other.cells) == count, "meshio: the cells of the plate")

print("all as expected")
