"""Writes the mesh files of this folder with gmsh 4.15.2 (`pip install gmsh==4.15.2`): each option that changes a file."""

import os
from pathlib import Path

import gmsh

os.chdir(Path(__file__).parent)
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
DEFAULTS = {}


def plate(z=0.0, tilt=0.0, name="plate", groups=True, clockwise=False, surfaces=1):
    """20 x 10 in 4 x 2 cells; groups: the name, `clamped` (left side) and `tip` (upper right corner)."""
    gmsh.clear()
    for option, value in DEFAULTS.items():
        gmsh.option.setNumber(option, value)
    DEFAULTS.clear()
    geo = gmsh.model.geo
    width = 20 / surfaces
    low = [geo.addPoint(width * i, 0, z + tilt * width * i) for i in range(surfaces + 1)]
    high = [geo.addPoint(width * i, 10, z + tilt * width * i) for i in range(surfaces + 1)]
    across = [geo.addLine(a, b) for a, b in zip(low, high)]
    for curve in across:
        geo.mesh.setTransfiniteCurve(curve, 3)
    faces = []
    for i in range(surfaces):
        bottom, top = geo.addLine(low[i], low[i + 1]), geo.addLine(high[i], high[i + 1])
        for curve in (bottom, top):
            geo.mesh.setTransfiniteCurve(curve, 4 // surfaces + 1)
        loop = [bottom, across[i + 1], -top, -across[i]]
        loop = geo.addCurveLoop([-c for c in reversed(loop)] if clockwise else loop)
        faces.append(geo.addPlaneSurface([loop]))
        geo.mesh.setTransfiniteSurface(faces[-1])
    geo.synchronize()
    if groups:
        gmsh.model.addPhysicalGroup(2, faces, 1, name)
        gmsh.model.addPhysicalGroup(1, [across[0]], 2, "clamped")
        gmsh.model.addPhysicalGroup(0, [high[-1]], 3, "tip")
    return faces, across, low, high


def write(name, mesh=True, **options):
    """Meshes and writes; `options` are options of gmsh with _ for the dot."""
    options = {"Mesh_MshFileVersion": 4.1, "Mesh_RecombineAll": 1, **options}
    for option, value in options.items():
        option = option.replace("_", ".", 1)
        DEFAULTS.setdefault(option, gmsh.option.getNumber(option))
        gmsh.option.setNumber(option, value)
    if mesh:
        gmsh.model.mesh.generate(2)
    gmsh.write(name)


def option(name, **options):
    plate()
    write(name, **options)


# Options of the file.
option("plain.msh")
option("binary.msh", Mesh_Binary=1)
option("version-22.msh", Mesh_MshFileVersion=2.2)
option("version-22-binary.msh", Mesh_MshFileVersion=2.2, Mesh_Binary=1)
option("version-40.msh", Mesh_MshFileVersion=4.0)
option("version-1.msh", Mesh_MshFileVersion=1.0)
option("save-all.msh", Mesh_SaveAll=1)
plate(groups=False)
write("save-all-no-groups.msh", Mesh_SaveAll=1)
option("save-parametric.msh", Mesh_SaveParametric=1)
option("save-parametric-binary.msh", Mesh_SaveParametric=1, Mesh_Binary=1)
option("save-groups-of-nodes.msh", Mesh_SaveGroupsOfNodes=1)
option("save-groups-of-elements.msh", Mesh_SaveGroupsOfElements=0)
option("save-topology.msh", Mesh_SaveTopology=1)
option("scaled.msh", Mesh_ScalingFactor=1000)
option("reclassified.msh", Mesh_SaveElementTagType=2)
option("serendipity.msh", Mesh_ElementOrder=2, Mesh_SecondOrderIncomplete=1)
option("second-order.msh", Mesh_ElementOrder=2)
option("third-order.msh", Mesh_ElementOrder=3)
option("triangles.msh", Mesh_RecombineAll=0)
gmsh.option.setNumber("Mesh.RecombineAll", 1)

# Partitions.
for name, options in {
    "partitioned.msh": {},
    "partitioned-binary.msh": {"Mesh_Binary": 1},
    "partitioned-ghosts.msh": {"Mesh_PartitionCreateGhostCells": 1},
    "partitioned-physicals.msh": {"Mesh_PartitionCreatePhysicals": 1},
    "partitioned-old-style.msh": {"Mesh_PartitionOldStyleMsh2": 1},
    "partitioned-split.msh": {"Mesh_PartitionSplitMeshFiles": 1},
}.items():
    plate()
    gmsh.option.setNumber("Mesh.RecombineAll", 1)
    gmsh.model.mesh.generate(2)
    for key, value in options.items():
        key = key.replace("_", ".", 1)
        DEFAULTS.setdefault(key, gmsh.option.getNumber(key))
        gmsh.option.setNumber(key, value)
    gmsh.model.mesh.partition(2)
    write(name, mesh=False)

# Periodic, renumbered, embedded.
_, across, _, _ = plate()
gmsh.model.mesh.setPeriodic(1, [across[1]], [across[0]], [1, 0, 0, 20, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
write("periodic.msh")
plate()
gmsh.model.mesh.setPeriodic(1, [across[1]], [across[0]], [1, 0, 0, 20, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
write("periodic-binary.msh", Mesh_Binary=1)
plate()
gmsh.model.mesh.generate(2)
gmsh.model.mesh.renumberNodes(*gmsh.model.mesh.computeRenumbering("RCMK"))
write("renumbered.msh", mesh=False)
plate()
gmsh.model.mesh.generate(2)
tags = sorted(gmsh.model.mesh.getNodes()[0])
gmsh.model.mesh.renumberNodes(tags, [10**12 + 7 * int(t) for t in tags])
write("huge-tags.msh", mesh=False)
for name, embed in (("embedded-point.msh", 0), ("embedded-line.msh", 1)):
    gmsh.clear()
    occ = gmsh.model.occ
    occ.addRectangle(0, 0, 0, 20, 10)
    a, b = occ.addPoint(7, 4, 0), occ.addPoint(13, 6, 0)
    line = occ.addLine(a, b)
    occ.synchronize()
    gmsh.model.mesh.embed(embed, [line if embed else a], 2, 1)
    gmsh.model.addPhysicalGroup(2, [1], 1, "plate")
    gmsh.model.addPhysicalGroup(embed, [line if embed else a], 2, "inside")
    write(name, Mesh_MeshSizeMax=4, Mesh_Algorithm=8, Mesh_RecombinationAlgorithm=3, Mesh_SubdivisionAlgorithm=1)
    gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 0)

# Geometry.
plate(z=3)
write("offset.msh")
plate(tilt=0.1)
write("tilted.msh")
plate(clockwise=True)
write("clockwise.msh")
plate(surfaces=2)
write("two-surfaces.msh")
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
write("doubled-nodes.msh")
gmsh.model.mesh.removeDuplicateNodes()
write("joined-nodes.msh", mesh=False)
faces, *_ = plate(surfaces=2)
gmsh.model.mesh.setRecombine(2, faces[0])
write("mixed.msh", Mesh_RecombineAll=0)
gmsh.option.setNumber("Mesh.RecombineAll", 1)
plate()
gmsh.model.geo.rotate([(2, 1)], 0, 0, 0, 1, 0, 0, 1.5707963)
gmsh.model.geo.synchronize()
write("upright.msh")
for name, group in (("extruded.msh", 3), ("extruded-bottom.msh", 2)):
    gmsh.clear()
    geo = gmsh.model.geo
    points = [geo.addPoint(x, y, 0) for x, y in ((0, 0), (20, 0), (20, 10), (0, 10))]
    sides = [geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
    geo.addCurveLoop(sides, 1)
    geo.addPlaneSurface([1], 1)
    for side, cells in zip(sides, (4, 2, 4, 2)):
        geo.mesh.setTransfiniteCurve(side, cells + 1)
    geo.mesh.setTransfiniteSurface(1)
    volume = [e[1] for e in geo.extrude([(2, 1)], 0, 0, 2, [2], recombine=True) if e[0] == 3]
    geo.synchronize()
    gmsh.model.addPhysicalGroup(group, volume if group == 3 else [1], 1, "plate")
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.model.mesh.generate(3)
    if group == 2:
        DEFAULTS["Mesh.SaveAll"] = 0
        gmsh.option.setNumber("Mesh.SaveAll", 1)
    gmsh.write(name)

# Groups.
faces, *_ = plate(surfaces=2)
gmsh.model.addPhysicalGroup(2, faces[:1], 9, "left half")
write("overlapping-groups.msh")
plate(name='a "quoted" Pläte, 板 ')
write("names.msh")
faces, across, *_ = plate()
gmsh.model.addPhysicalGroup(1, [across[1]], 9, "plate")
write("one-name-two-dimensions.msh")
faces, across, *_ = plate()
gmsh.model.addPhysicalGroup(1, [across[1]], 9, "clamped")
write("one-name-twice.msh")
plate(groups=False)
write("no-groups.msh")
plate()
view = gmsh.view.add("temperature")
gmsh.model.mesh.generate(2)
nodes = gmsh.model.mesh.getNodes()[0]
write("appended.msh", mesh=False)
gmsh.view.addModelData(view, 0, gmsh.model.getCurrent(), "NodeData", nodes, [[float(n)] for n in nodes])
gmsh.view.write(view, "appended.msh", append=True)

# Other formats under the name of this one.
plate()
gmsh.model.mesh.generate(2)
for kind in ("stl", "vtk", "unv", "inp", "bdf", "geo_unrolled"):
    gmsh.write(f"other.{kind}")
    Path(f"other.{kind}").rename(f"other-{kind.replace('_', '-')}.msh")
gmsh.finalize()

# What no program writes.
plain = Path("plain.msh").read_bytes()
binary = Path("binary.msh").read_bytes()
Path("crlf.msh").write_bytes(plain.replace(b"\n", b"\r\n"))
Path("comments.msh").write_bytes(plain.replace(b"$Nodes", b"$Comments\nby hand\n$Nodes\nare below\n$EndComments\n$Nodes", 1))
Path("trailing.msh").write_bytes(plain + b"\n// the end\n$Comments\nlater\n$EndComments\n")
data = b'$NodeData\n1\n"temperature"\n1\n0.0\n3\n0\n1\n2\n1 20.0\n2 21.5\n$EndNodeData\n'
Path("node-data.msh").write_bytes(plain + data)
Path("empty.msh").write_bytes(b"")
Path("size-4.msh").write_bytes(binary.replace(b"4.1 1 8", b"4.1 1 4", 1))
Path("big-endian.msh").write_bytes(binary.replace(b"4.1 1 8\n\1\0\0\0", b"4.1 1 8\n\0\0\0\1", 1))
Path("huge-count.msh").write_bytes(plain.replace(b"$Nodes\n9 15 ", b"$Nodes\n9 999999999999999999 ", 1))
Path("huge-block.msh").write_bytes(plain.replace(b"\n2 1 3 8\n", b"\n2 1 3 18446744073709551615\n", 1))
