#!/usr/bin/python3
"""square_duct.py LENGTH - a straight duct of width 1 along x as STL, with the solids inlet, outlet and wall."""
import sys

length = float(sys.argv[1])
corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
near = [(0, y, z) for y, z in corners]
far = [(length, y, z) for y, z in corners]
wall = []
for i in range(4):
    j = (i + 1) % 4
    wall += [(near[i], far[j], near[j]), (near[i], far[i], far[j])]
solids = {"inlet": [(near[0], near[2], near[1]), (near[0], near[3], near[2])],
          "outlet": [(far[0], far[1], far[2]), (far[0], far[2], far[3])],
          "wall": [(a, c, b) for a, b, c in wall]}
for name, triangles in solids.items():
    print("solid", name)
    for triangle in triangles:
        print("facet normal 0 0 0\nouter loop")
        for point in triangle:
            print("vertex %g %g %g" % point)
        print("endloop\nendfacet")
    print("endsolid", name)
