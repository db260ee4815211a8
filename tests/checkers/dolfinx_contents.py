#!/usr/bin/python3
"""dolfinx_contents.py FILE.msh: the kind of cells that dolfinx finds, how many, and how many cells and facets have each tag.
Needs python3-dolfinx-real, python3-gmsh."""
import collections
import sys

import gmsh
from dolfinx.io import gmshio
from mpi4py import MPI

gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 1)
gmsh.open(sys.argv[1])
# Not read_from_msh(): in dolfinx 0.5 it ends with an error of its own.
mesh, cells, facets = gmshio.model_to_mesh(gmsh.model, MPI.COMM_WORLD, 0, 3)
print(mesh.topology.cell_type.name, mesh.topology.index_map(3).size_local)
for name, tags in (("cells", cells), ("facets", facets)):
    for tag, count in sorted(collections.Counter(tags.values.tolist()).items()):
        print(name, tag, count)
