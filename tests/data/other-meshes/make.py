"""Writes the mesh files of this folder but for those written by hand (hand-*): `pip install gmsh==4.15.2 meshio==5.3.5`.

One plate of 20 x 10 in 4 x 2 cells, of triangles and quadrilaterals; groups `plate`, `clamped` (left side) and `tip`. Coordinates
are whole numbers or halves, so that every format holds them exactly."""

import os
from pathlib import Path

import gmsh
import meshio

os.chdir(Path(__file__).parent)
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)


def plate(recombine):
    gmsh.clear()
    geo = gmsh.model.geo
    points = [geo.addPoint(x, y, 0) for x, y in [(0, 0), (20, 0), (20, 10), (0, 10)]]
    lines = [geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
    for line, count in zip(lines, [5, 3, 5, 3]):
        geo.mesh.setTransfiniteCurve(line, count)
    surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    geo.mesh.setTransfiniteSurface(surface)
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, [surface], 1, "plate")
    gmsh.model.addPhysicalGroup(1, [lines[3]], 2, "clamped")
    gmsh.model.addPhysicalGroup(0, [points[2]], 3, "tip")
    gmsh.option.setNumber("Mesh.RecombineAll", int(recombine))
    gmsh.option.setNumber("Mesh.SaveAll", 0)
    gmsh.model.mesh.generate(2)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    for tag, x in zip(tags, coordinates.reshape(-1, 3)):
        gmsh.model.mesh.setNode(tag, [round(2 * c) / 2 for c in x], [])


for shape, recombine in [("quads", True), ("triangles", False)]:
    plate(recombine)
    for version, binary in [(2.2, 0), (2.2, 1), (4.0, 0), (4.1, 0), (4.1, 1)]:
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.write(f"gmsh-{shape}-{round(10 * version)}{'-binary' if binary else ''}.msh")
    gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", 1)
    gmsh.write(f"gmsh-{shape}.inp")
    gmsh.option.setNumber("Mesh.SaveElementTagType", 2)
    for form, name in enumerate(["free", "small", "large"]):
        gmsh.option.setNumber("Mesh.BdfFieldFormat", form)
        gmsh.write(f"gmsh-{shape}-{name}.bdf")
    gmsh.option.setNumber("Mesh.SaveElementTagType", 1)
    gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", 0)

    mesh = meshio.read(f"gmsh-{shape}-41.msh")
    cells = [block for block in mesh.cells if block.type in ("triangle", "quad")]
    side = [n for n, x in enumerate(mesh.points) if x[0] == 0]
    mesh = meshio.Mesh(mesh.points, cells, point_sets={"clamped": side}, cell_sets={"plate": [range(len(cells[0].data))]})
    mesh.write(f"meshio-{shape}.inp")
    for name in ["fixed-small", "fixed-large"]:
        cell_format = "fixed-small" if name == "fixed-large" else name
        meshio.nastran.write(f"meshio-{shape}-{name}.bdf", mesh, point_format=name, cell_format=cell_format)
