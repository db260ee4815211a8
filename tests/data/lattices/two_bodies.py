#!/usr/bin/env python3
"""Turn a lattice into two bodies with surfaces: MEDIT .mesh on standard output.

usage: two_bodies.py LATTICE N

LATTICE: what lattice.py wrote for N, an even number. Cells below x = N/2 are of region 1, those above of region 2. Surfaces: 1 at
x = 0, 2 at x = N, 3 the other sides, 4 between the bodies.
"""
import itertools
import sys


def read(path):
    words = iter(open(path).read().split())
    sections = {}
    for word in words:
        if word in ("Vertices", "Tetrahedra"):
            width = 4 if word == "Vertices" else 5
            sections[word] = [[int(next(words)) for _ in range(width)] for _ in range(int(next(words)))]
    return sections["Vertices"], sections["Tetrahedra"]


def main():
    n = int(sys.argv[2])
    points, tets = read(sys.argv[1])
    regions_of = {}
    for tet in tets:
        tet[4] = 1 if sum(points[v - 1][0] for v in tet[:4]) < 2 * n else 2
        for face in itertools.combinations(tet[:4], 3):
            regions_of.setdefault(tuple(sorted(face)), []).append(tet[4])
    triangles = []
    for face, regions in regions_of.items():
        at = {points[v - 1][0] for v in face}
        if len(regions) == 1:
            triangles.append((*face, 1 if at == {0} else 2 if at == {n} else 3))
        elif regions[0] != regions[1]:
            triangles.append((*face, 4))
    print("MeshVersionFormatted 2\nDimension 3")
    for name, items in (("Vertices", points), ("Tetrahedra", tets), ("Triangles", triangles)):
        print(name, len(items), sep="\n")
        for item in items:
            print(*item)
    print("End")


main()
