#!/usr/bin/python3
"""box.py N - the surface of a cube of N x N x N unit cubes as OFF on standard output, two triangles a square."""
import itertools
import sys

n = int(sys.argv[1])
print("OFF")
points, faces = {}, []
number = lambda p: points.setdefault(p, len(points))
for axis, side in itertools.product(range(3), (0, n)):
    for i, j in itertools.product(range(n), repeat=2):
        corner = lambda a, b: number(tuple([side, i + a, j + b][(k - axis) % 3] for k in range(3)))
        quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]
        if side == 0:
            quad.reverse()
        faces += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
print(len(points), len(faces), 0)
for p in points:
    print(*p)
for f in faces:
    print(3, *f)
