#!/usr/bin/python3
"""netgen_contents.py FILE.msh: what Netgen finds in a mesh of Gmsh 2.2. Needs python3-netgen.

    hex 14                  for each kind of cells, their number
    volume copper 32        for each material
    area left 16            for each boundary condition

Volumes by Netgen's order of corners, without their signs, which differ between the kinds in Netgen's reader. Shares no code
with hexpipe."""
import collections
import sys

from netgen.read_gmsh import ReadGmsh

# Faces of Netgen's elements, all seen from the same side, by the number of corners.
KINDS = {
    4: ("tet", [(0, 1, 2), (0, 3, 1), (1, 3, 2), (0, 2, 3)]),
    5: ("pyramid", [(0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)]),
    6: ("prism", [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)]),
    8: ("hex", [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]),
}


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def normal(points):
    """Twice the area, as a vector; exact for a bilinear quad."""
    if len(points) == 3:
        return cross(minus(points[1], points[0]), minus(points[2], points[0]))
    return cross(minus(points[2], points[0]), minus(points[3], points[1]))


def volume(points, faces):
    """By the divergence theorem; a warped quad counts as the mean of its two ways to be cut."""
    total = 0
    for face in faces:
        p = [points[i] for i in face]
        cuts = [p] if len(p) == 3 else [[p[0], p[1], p[2]], [p[0], p[2], p[3]], [p[0], p[1], p[3]], [p[1], p[2], p[3]]]
        total += sum(dot(cut[0], normal(cut)) for cut in cuts) / (1 if len(p) == 3 else 2)
    return total / 6


mesh = ReadGmsh(sys.argv[1])
places = [vertex.p for vertex in mesh.Points()]
at = lambda element: [places[v.nr - 1] for v in element.vertices]
counts, volumes, areas = collections.Counter(), collections.Counter(), collections.Counter()
for element in mesh.Elements3D():
    kind, faces = KINDS[len(element.vertices)]
    counts[kind] += 1
    volumes[mesh.GetMaterial(element.index)] += abs(volume(at(element), faces))
for element in mesh.Elements2D():
    areas[mesh.GetBCName(element.index - 1)] += dot(normal(at(element)), normal(at(element))) ** 0.5 / 2
for kind, count in counts.items():
    print(kind, count)
for name, size in volumes.items():
    print("volume", name, f"{size:.9g}")
for name, size in areas.items():
    print("area", name, f"{size:.9g}")
