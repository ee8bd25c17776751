"""Writes the mesh files of this folder with gmsh 4.15.2 (`pip install gmsh==4.15.2`)."""

import os
from pathlib import Path

import gmsh

os.chdir(Path(__file__).parent)


def strip(clockwise=False, physical=True):
    """30 mm x 10 mm at z = 2, 4 x 2 cells; groups plate, clamped (left side) and tip (upper right corner)."""
    gmsh.clear()
    geo = gmsh.model.geo
    corners = [geo.addPoint(x, y, 2) for x, y in ((0, 0), (30, 0), (30, 10), (0, 10))]
    sides = [geo.addLine(corners[i], corners[(i + 1) % 4]) for i in range(4)]
    geo.addCurveLoop([-s for s in reversed(sides)] if clockwise else sides, 1)
    geo.addPlaneSurface([1], 1)
    for side, cells in zip(sides, (4, 2, 4, 2)):
        geo.mesh.setTransfiniteCurve(side, cells + 1)
    geo.mesh.setTransfiniteSurface(1)
    geo.synchronize()
    if physical:
        gmsh.model.addPhysicalGroup(2, [1], 1, "plate")
        gmsh.model.addPhysicalGroup(1, [sides[3]], 2, "clamped")
        gmsh.model.addPhysicalGroup(0, [corners[2]], 3, "tip")


def disk():
    """A disk of radius 10 mm, 12 cells; groups plate and rim."""
    gmsh.clear()
    geo = gmsh.model.geo
    centre = geo.addPoint(0, 0, 0)
    at = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    inner = [geo.addPoint(4 * x, 4 * y, 0) for x, y in at]
    outer = [geo.addPoint(10 * x / 2**0.5, 10 * y / 2**0.5, 0) for x, y in at]
    core = [geo.addLine(inner[i], inner[(i + 1) % 4]) for i in range(4)]
    spokes = [geo.addLine(inner[i], outer[i]) for i in range(4)]
    rim = [geo.addCircleArc(outer[i], centre, outer[(i + 1) % 4]) for i in range(4)]
    geo.addCurveLoop(core, 1)
    for i in range(4):
        geo.addCurveLoop([spokes[i], rim[i], -spokes[(i + 1) % 4], -core[i]], 2 + i)
    for loop in range(1, 6):
        geo.addPlaneSurface([loop], loop)
    for curve in core + rim:
        geo.mesh.setTransfiniteCurve(curve, 3)
    for curve in spokes:
        geo.mesh.setTransfiniteCurve(curve, 2)
    for surface in range(1, 6):
        geo.mesh.setTransfiniteSurface(surface)
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, range(1, 6), 1, "plate")
    gmsh.model.addPhysicalGroup(1, rim, 2, "rim")


def write(name, version=4.1, recombine=True, mesh=True, edit=None, **options):
    """Meshes the model and writes it; `options` are options of gmsh with _ for the dot."""
    gmsh.option.setNumber("Mesh.RecombineAll", recombine)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    before = {}
    for option, value in options.items():
        option = option.replace("_", ".")
        before[option] = gmsh.option.getNumber(option)
        gmsh.option.setNumber(option, value)
    if mesh:
        gmsh.model.mesh.generate(2)
    if edit:
        edit()
    gmsh.write(name)
    for option, value in before.items():
        gmsh.option.setNumber(option, value)


def renumber(new):
    """Gives the node with the i-th lowest number the i-th of the new numbers."""
    gmsh.model.mesh.renumberNodes(sorted(gmsh.model.mesh.getNodes()[0]), list(new))


def reverse_cuthill_mckee():
    gmsh.model.mesh.renumberNodes(*gmsh.model.mesh.computeRenumbering("RCMK"))


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("Mesh.SecondOrderLinear", 0)

strip()
write("ascii.msh")
write("binary.msh", Mesh_Binary=1)
write("parametric.msh", Mesh_SaveParametric=1)
write("msh40.msh", version=4.0)
write("msh22.msh", version=2.2)
write("partitioned.msh", edit=lambda: gmsh.model.mesh.partition(2))
strip()
write("rcm.msh", edit=reverse_cuthill_mckee)
strip()
write("sparse.msh", edit=lambda: renumber(range(1007, 1007 + 15 * 10, 10)))
strip()
write("triangles.msh", recombine=False)
strip(clockwise=True)
write("clockwise.msh")
strip()
gmsh.model.removePhysicalName("plate")
gmsh.model.removePhysicalName("clamped")
gmsh.model.removePhysicalName("tip")
write("unnamed.msh")
strip(physical=False)
write("no-groups.msh")

disk()
write("disk.msh")
write("second-order.msh", Mesh_ElementOrder=2)
disk()
write("serendipity.msh", Mesh_ElementOrder=2, Mesh_SecondOrderIncomplete=1)
disk()
write("third-order.msh", Mesh_ElementOrder=3)

gmsh.clear()
occ = gmsh.model.occ
occ.addRectangle(0, 0, 0, 10, 10)
occ.addRectangle(10, 0, 0, 10, 10)
occ.synchronize()
gmsh.model.addPhysicalGroup(2, [1, 2], 1, "plate")
for curve in gmsh.model.getEntities(1):
    gmsh.model.mesh.setTransfiniteCurve(curve[1], 3)
for surface in (1, 2):
    gmsh.model.mesh.setTransfiniteSurface(surface)
write("not-joined.msh")

gmsh.clear()
occ.addBox(0, 0, 0, 10, 10, 2)
occ.synchronize()
for curve in gmsh.model.getEntities(1):
    gmsh.model.mesh.setTransfiniteCurve(curve[1], 2)
for surface in gmsh.model.getEntities(2):
    gmsh.model.mesh.setTransfiniteSurface(surface[1])
gmsh.model.mesh.setTransfiniteVolume(1)
gmsh.model.addPhysicalGroup(3, [1], 1, "block")
gmsh.option.setNumber("Mesh.RecombineAll", 1)
gmsh.model.mesh.generate(3)
write("hexahedra.msh", mesh=False)

gmsh.clear()
gmsh.parser.setNumber("h", [1.27])
gmsh.merge("../../../examples/as4-3502-16ply-50mm/plate.geo")
write("circle-fine.msh")
gmsh.finalize()

Path("crlf.msh").write_bytes(Path("ascii.msh").read_bytes().replace(b"\n", b"\r\n"))
