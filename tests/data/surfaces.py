#!/usr/bin/python3
"""surfaces.py SHAPE [ARGUMENTS...] - small surfaces for tests.

    samples             into this folder: a cube in every format, with every fault, in several shells, and with tags
    box X Y Z           a box from 0 to these, its sides as quads                                       OBJ, to stdout
    beside GAP Y Z      the unit cube, and one of 0.5 that is GAP away from its side, at Y and Z        OBJ, to stdout
    turned STL SEED     a binary STL file in axes drawn by the seed                                     OBJ, to stdout
    wedge               two tets with a facet in common, thinner than a quarter of their diagonal       OFF, to stdout
    sized               into this folder: a cube of 10 as cube.obj, and sizes of it: 0.6 at a corner in place.txt and
                        place.npy; from 0.8 below to 1.6 above by vertex in vertices.txt, and on a mesh in background.msh
    narrow              into this folder: knife.off, which ends in an edge of 8 degrees, and star.off, at whose tip ten
                        facets meet, between which edges go in and out
    documented PAGE     into this folder: the surfaces that formats/README.md shows
    points              into this folder: 50 points in the unit cube in every format, and files that are none
"""
import math
import re
import struct
import sys

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
SIDES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
# In the order x, then y, then z, as files of sizes by vertex have them.
GRID_CORNERS = [(i & 1, i >> 1 & 1, i >> 2) for i in range(8)]
GRID_SIDES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]


def cube(origin=(0, 0, 0), size=1, n=1, inward=False):
    """Triangles of a cube, its sides cut into n x n squares."""
    triangles = []
    for side in SIDES:
        a, b, c, d = (CORNERS[i] for i in side)

        def at(i, j):
            return tuple(origin[k] + size * (a[k] + (b[k] - a[k]) * i / n + (d[k] - a[k]) * j / n) for k in range(3))

        for i in range(n):
            for j in range(n):
                p, q, r, s = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
                triangles += [(p, q, r), (p, r, s)]
    return [(t[0], t[2], t[1]) for t in triangles] if inward else triangles


# ---- writers: lists of triangles, each of three points

def stl(name, triangles, header=b"", attributes=None):
    with open(name, "wb") as file:
        file.write(header.ljust(80, b"\0") + struct.pack("<I", len(triangles)))
        for i, t in enumerate(triangles):
            file.write(struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], attributes[i] if attributes else 0))


def ascii_stl(name, *solids):
    with open(name, "w") as file:
        for number, triangles in enumerate(solids):
            file.write(f"solid s{number}\n")
            for t in triangles:
                corners = "".join("vertex %r %r %r\n" % p for p in t)
                file.write(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
            file.write(f"endsolid s{number}\n")


def indexed(triangles):
    points = sorted({p for t in triangles for p in t})
    return points, [[points.index(p) for p in t] for t in triangles]


def obj(name, triangles):
    points, corners = indexed(triangles)
    with open(name, "w") as file:
        write_obj(file, points, corners)


def off(name, triangles):
    points, corners = indexed(triangles)
    with open(name, "w") as file:
        file.write(f"OFF\n{len(points)} {len(corners)} 0\n")
        file.write("".join("%r %r %r\n" % p for p in points) + "".join("3 %d %d %d\n" % tuple(t) for t in corners))


def ply(name, triangles, form):
    points, corners = indexed(triangles)
    order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[form]
    with open(name, "wb") as file:
        file.write((f"ply\nformat {form} 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\n"
                    f"property double z\nelement face {len(corners)}\nproperty list uchar int vertex_indices\n"
                    "end_header\n").encode())
        for p in points:
            file.write(struct.pack(order + "3d", *p) if order else b"%r %r %r\n" % p)
        for t in corners:
            file.write(struct.pack(order + "B3i", 3, *t) if order else b"3 %d %d %d\n" % tuple(t))


def write_obj(file, points, faces):
    file.write("".join("v %r %r %r\n" % tuple(p) for p in points))
    file.write("".join("f " + " ".join(str(corner + 1) for corner in face) + "\n" for face in faces))


# ---- shapes

def samples():
    one = cube()
    stl("cube.stl", one)
    stl("solid.stl", one, b"solid but binary")
    ascii_stl("cube.ascii.stl", one)
    obj("cube.obj", one)
    off("cube.off", one)
    for form in ("ascii", "binary_little_endian", "binary_big_endian"):
        ply(f"cube.{form}.ply", one, form)
    stl("fine.stl", cube(n=5))
    faults(one)
    shells(one)
    ascii_stl("solids.stl", one[:2], one[2:])
    stl("attributes.stl", one, attributes=[5 if i < 4 else 9 for i in range(12)])
    groups()


def faults(one):
    stl("hole.stl", one[:2] + one[3:])
    stl("flipped.stl", one[:6] + [(one[6][0], one[6][2], one[6][1])] + one[7:])
    stl("duplicated.stl", one + [one[4]])
    stl("intersecting.stl", one + cube((.5, .5, .5)))
    obj("intersecting.obj", one + cube((.5, .5, .5)))
    stl("flat.stl", [((i, 0, 0), (i + 1, 0, 0), (i, i + 1, 0)) for i in range(20)])
    stl("degenerate.stl", one + [((0, 0, 0), (1, 1, 1), (2, 2, 2))])
    stl("nan.stl", one[:3] + [((float("nan"), 0, 0), *one[3][1:])] + one[4:])
    stl("inward.stl", cube(inward=True))
    stl("edge.stl", one + cube((1, 1, 0)))
    stl("corner.stl", one + cube((1, 1, 1)))
    with open("zero.obj", "w") as file:
        file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n")


def shells(one):
    stl("apart.stl", one + cube((3, 0, 0), 2))
    stl("hollow.stl", cube(size=3) + cube((1, 1, 1), inward=True))
    stl("nested.stl", cube(size=3) + cube((1, 1, 1)))


def groups():
    """A cube whose sides are named, as quads, some with indices that count back or carry more numbers."""
    sides = {"bottom": "1 4 3 2", "top": "5 6 7 8", "side": "1 2 6 5"}
    with open("groups.obj", "w") as file:
        file.write("".join("v %d %d %d\n" % p for p in CORNERS))
        file.write("".join(f"g {name}\nf {corners}\n" for name, corners in sides.items()))
        file.write("f -7 -6 -2 -3\nf 3 4 8 7\nf 4/1/1 1/1/1 5//1 8\n")


def box(x, y, z):
    sides = [float(word) for word in (x, y, z)]
    write_obj(sys.stdout, [tuple(c * side for c, side in zip(corner, sides)) for corner in GRID_CORNERS], GRID_SIDES)


def beside(gap, y, z):
    near = [(1 + float(gap) + 0.5 * c[0], float(y) + 0.5 * c[1], float(z) + 0.5 * c[2]) for c in GRID_CORNERS]
    faces = [[corner + first for corner in side] for first in (0, 8) for side in GRID_SIDES]
    write_obj(sys.stdout, GRID_CORNERS + near, faces)


def turned(path, seed):
    import numpy as np
    with open(path, "rb") as file:
        data = file.read()
    facets = np.frombuffer(data[84:], dtype=[("normal", "<3f4"), ("corners", "<9f4"), ("attribute", "<u2")])
    axes, _ = np.linalg.qr(np.random.RandomState(int(seed)).normal(size=(3, 3)))
    if np.linalg.det(axes) < 0:
        axes = -axes
    points, index = np.unique(facets["corners"].reshape(-1, 3), axis=0, return_inverse=True)
    np.savetxt(sys.stdout, points.astype(float) @ axes, "v %.17g %.17g %.17g")
    np.savetxt(sys.stdout, index.reshape(-1, 3) + 1, "f %d %d %d")


def wedge():
    print("OFF\n5 6 0\n17 15 1.4\n8 6 3.4\n5 37 2.7\n2 1 0.5\n38 1 3.5")
    print("3 0 4 3\n3 0 3 2\n3 0 2 4\n3 1 3 4\n3 1 2 3\n3 1 4 2")


def sized():
    import numpy as np
    corners = [tuple(10 * x for x in corner) for corner in GRID_CORNERS]
    with open("cube.obj", "w") as file:
        write_obj(file, corners, GRID_SIDES)
    with open("place.txt", "w") as file:
        file.write("# x y z size\n0 0 0 0.6\n")
    np.save("place.npy", [(0., 0., 0., 0.6)])
    sizes = [0.8 if i < 4 else 1.6 for i in range(8)]
    with open("vertices.txt", "w") as file:
        file.write("".join(f"{size}\n" for size in sizes))
    tets = [(1, *t, 8) for t in ((2, 4), (4, 3), (3, 7), (7, 5), (5, 6), (6, 2))]
    numbered = lambda rows: "".join(f"{i + 1} {row}\n" for i, row in enumerate(rows))
    words = lambda numbers: " ".join(str(number) for number in numbers)
    with open("background.msh", "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
        file.write("$Nodes\n8\n" + numbered(map(words, corners)) + "$EndNodes\n")
        file.write("$Elements\n6\n" + numbered("4 2 1 1 " + words(tet) for tet in tets) + "$EndElements\n")
        file.write('$NodeData\n1\n"size"\n1\n0\n3\n0\n1\n8\n' + numbered(sizes) + "$EndNodeData\n")


def points():
    import numpy as np
    inside = np.random.RandomState(1).uniform(0.1, 0.9, (50, 3))
    np.save("points.npy", inside)
    np.savetxt("points.xyz", inside, "%.17g", header="x y z")
    np.savetxt("points.node", np.column_stack([np.arange(1, 51), inside]), "%d %.17g %.17g %.17g", header="50 3 0 0",
               comments="")
    head = "ply\nformat ascii 1.0\nelement vertex 50\nproperty double x\nproperty double y\nproperty double z\nend_header"
    np.savetxt("points.ply", inside, "%.17g", header=head, comments="")
    np.savetxt("outside.xyz", [(.5, .5, .5), (2, 0, 0), (.5, .5, .5), (.5, .5, 0)], "%g")
    np.save("flat.npy", inside[:, :2])
    for name, text in (("bad.xyz", "0.5 0.5 0.5\n0.5 0.5 x\n"), ("cut.xyz", "0.5 0.5 0.5\n0.25 0.5 0.7"),
                       ("short.node", "3 3 0 0\n1 .5 .5 .5\n2 .4 .4 .4\n")):
        with open(name, "w") as file:
            file.write(text)


def narrow():
    back = 4 * math.tan(math.radians(8))
    a, b, c = (0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 0.0, back)
    d, e, f = ((x, 3.0, z) for x, _, z in (a, b, c))
    off("knife.off", [(a, b, c), (d, f, e), (a, e, b), (a, d, e), (b, f, c), (b, e, f), (a, f, d), (a, c, f)])
    radii = 3, 2
    rim = [(radii[i % 2] * math.cos(math.pi * i / 5), radii[i % 2] * math.sin(math.pi * i / 5), 0.0) for i in range(10)]
    tip, middle = (0.0, 0.0, 3.0), (0.0, 0.0, 0.0)
    off("star.off", [(rim[i - 1], rim[i], tip) for i in range(10)] + [(rim[i], rim[i - 1], middle) for i in range(10)])


def documented(page):
    with open(page) as file:
        shown = re.findall(r"<!-- surface (\S+) -->\n```\n(.*?)```", file.read(), re.S)
    for name, text in shown:
        with open(name, "w") as file:
            file.write(text)


SHAPES = {shape.__name__: shape for shape in (samples, box, beside, turned, wedge, sized, narrow, documented, points)}

if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] not in SHAPES:
        sys.exit(__doc__)
    SHAPES[sys.argv[1]](*sys.argv[2:])
