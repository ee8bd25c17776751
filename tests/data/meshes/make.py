"""Writes the mesh files of this folder with gmsh 4.15.2 (`pip install gmsh==4.15.2`): plates drawn in OpenCASCADE, with default
options but for the largest size of cells; of `mixed` one half is recombined. Groups: `plate`, and `rim` all around."""

import os
from pathlib import Path

import gmsh

os.chdir(Path(__file__).parent)


def rectangle(occ):
    occ.addRectangle(0, 0, 0, 60, 40)


def disc(occ):
    occ.addDisk(0, 0, 0, 30, 30)


def hole(occ):
    occ.cut([(2, occ.addRectangle(0, 0, 0, 60, 40))], [(2, occ.addDisk(42, 20, 0, 8, 8))])


def l_shape(occ):
    occ.fuse([(2, occ.addRectangle(0, 0, 0, 60, 20))], [(2, occ.addRectangle(0, 0, 0, 20, 60))])


def mixed(occ):
    occ.fragment([(2, occ.addRectangle(0, 0, 0, 30, 40))], [(2, occ.addRectangle(30, 0, 0, 30, 40))])


for build, size in [(rectangle, 8), (disc, 7), (hole, 7), (l_shape, 7), (mixed, 6)]:
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    build(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    rim = gmsh.model.getBoundary([(2, face) for face in faces], oriented=False)
    gmsh.model.addPhysicalGroup(2, faces, name="plate")
    gmsh.model.addPhysicalGroup(1, [tag for _, tag in rim], name="rim")
    if build is mixed:
        gmsh.model.mesh.setRecombine(2, faces[0])
    gmsh.model.mesh.generate(2)
    gmsh.write(build.__name__.replace("_", "-") + ".msh")
    gmsh.finalize()
