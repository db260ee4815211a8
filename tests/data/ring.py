#!/usr/bin/env python3
"""ring.py [N [HEIGHT]] - a quarter of a ring between the radii 1 and 2 as STL on standard output.

Each circle has N chords a quarter (default: 200). The quarter lies between the planes x = 0 and y = 0, from z = 0 to HEIGHT
(default: 0.5). Its six sides are solids named inner, outer, bottom, top, x0 and y0.
"""
import math
import sys


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    height = float(sys.argv[2]) if len(sys.argv) > 2 else 0.5

    def at(radius, step, z):
        # The ends are in their planes exactly.
        x = 0.0 if step == count else math.cos(math.pi / 2 * step / count)
        y = 0.0 if step == 0 else 1.0 if step == count else math.sin(math.pi / 2 * step / count)
        return radius * x, radius * y, z

    sides = {name: [] for name in ("inner", "outer", "bottom", "top", "x0", "y0")}
    for i in range(count):
        sides["outer"].append((at(2, i, 0), at(2, i + 1, 0), at(2, i + 1, height), at(2, i, height)))
        sides["inner"].append((at(1, i + 1, 0), at(1, i, 0), at(1, i, height), at(1, i + 1, height)))
        sides["bottom"].append((at(1, i, 0), at(1, i + 1, 0), at(2, i + 1, 0), at(2, i, 0)))
        sides["top"].append((at(1, i, height), at(2, i, height), at(2, i + 1, height), at(1, i + 1, height)))
    sides["y0"].append((at(1, 0, 0), at(2, 0, 0), at(2, 0, height), at(1, 0, height)))
    sides["x0"].append((at(2, count, 0), at(1, count, 0), at(1, count, height), at(2, count, height)))
    for name, quads in sides.items():
        print("solid", name)
        for a, b, c, d in quads:
            for triangle in ((a, b, c), (a, c, d)):
                corners = "".join("vertex %.17g %.17g %.17g\n" % p for p in triangle)
                print("facet normal 0 0 0\nouter loop\n%sendloop\nendfacet" % corners)
        print("endsolid", name)


if __name__ == "__main__":
    main()
