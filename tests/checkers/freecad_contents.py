#!/usr/bin/python3
"""freecad_contents.py FILE [OUTPUT.inp]: what FreeCAD finds in a mesh file. Needs freecad-python3.

    hex 14                  for each kind of cells, their number
    volume copper 32        for each group of cells
    area left 16            for each group of facets

With OUTPUT.inp, FreeCAD writes the mesh there for CalculiX. Volumes by FreeCAD's order of corners; shares no code with
hexpipe."""
import os
import sys

os.environ["QT_QPA_PLATFORM"] = "offscreen"
sys.path.insert(0, "/usr/lib/freecad-python3/lib")
# Its readers of some formats are in Python.
sys.path.append("/usr/share/freecad/Mod/Fem")
import FreeCAD  # noqa: F401, E402
import Fem  # noqa: E402

# Faces of its cells, as seen from inside, by the number of corners.
FACES = {
    4: [(0, 1, 2), (0, 3, 1), (1, 3, 2), (0, 2, 3)],
    5: [(0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)],
    6: [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    8: [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)],
}


def normal(p):
    """Twice the area, as a vector; exact for a bilinear quad."""
    return (p[1] - p[0]).cross(p[2] - p[0]) if len(p) == 3 else (p[2] - p[0]).cross(p[3] - p[1])


def volume(points):
    """By the divergence theorem; a warped quad counts as the mean of its two ways to be cut."""
    total = 0
    for face in FACES[len(points)]:
        p = [points[i] for i in face]
        cuts = [p] if len(p) == 3 else [[p[0], p[1], p[2]], [p[0], p[2], p[3]], [p[0], p[1], p[3]], [p[1], p[2], p[3]]]
        total += sum(cut[0].dot(normal(cut)) for cut in cuts) / (1 if len(p) == 3 else 2)
    return total / 6


mesh = Fem.read(os.path.abspath(sys.argv[1]))
for kind, count in (("hex", mesh.HexaCount), ("prism", mesh.PrismCount), ("pyramid", mesh.PyramidCount), ("tet", mesh.TetraCount)):
    print(kind, count)
places = mesh.Nodes
at = lambda element: [places[node] for node in mesh.getElementNodes(element)]
for group in mesh.Groups:
    elements = [at(element) for element in mesh.getGroupElements(group)]
    if mesh.getGroupElementType(group) == "Volume":
        print("volume", mesh.getGroupName(group), f"{sum(map(volume, elements)):.9g}")
    else:
        print("area", mesh.getGroupName(group), f"{sum(normal(p).Length for p in elements) / 2:.9g}")
if len(sys.argv) > 2:
    mesh.writeABAQUS(os.path.abspath(sys.argv[2]), 1, False)
