#!/usr/bin/python3
"""whole_surface.py IN.msh OUT.msh [TAG] - the cells of a mesh with all of their outer faces as one surface."""
import sys

import meshio

FACES = {
    "hexahedron": [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
    "wedge": [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]],
    "pyramid": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 3, 2, 1]],
    "tetra": [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]],
}
GMSH = {"hexahedron": 5, "wedge": 6, "pyramid": 7, "tetra": 4}

mesh = meshio.read(sys.argv[1])
tag = int(sys.argv[3]) if len(sys.argv) > 3 else 1
outer, lines = {}, []
for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
    for cell, region in zip(block.data, tags):
        if block.type not in FACES:
            continue
        lines.append((GMSH[block.type], region, cell))
        for face in FACES[block.type]:
            corners = [cell[i] for i in face]
            if outer.pop(frozenset(corners), None) is None:
                outer[frozenset(corners)] = corners
lines += [(2 if len(face) == 3 else 3, tag, face) for face in outer.values()]
with open(sys.argv[2], "w") as out:
    print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d" % len(mesh.points), file=out)
    for number, (x, y, z) in enumerate(mesh.points, 1):
        print(number, repr(float(x)), repr(float(y)), repr(float(z)), file=out)
    print("$EndNodes\n$Elements\n%d" % len(lines), file=out)
    for number, (kind, group, corners) in enumerate(lines, 1):
        print(number, kind, 2, group, group, *(v + 1 for v in corners), file=out)
    print("$EndElements", file=out)
