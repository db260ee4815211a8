#!/usr/bin/python3
"""Writes a room of 6 x 4 x 4 with sheets inside, in OBJ: walls and sheets are groups of triangles on unit squares.

    baffles.py KIND > FILE

KIND is one of those at the end of this file.
"""
import sys


class Room:
    def __init__(self):
        self.points, self.groups = {}, {}
        for i in range(6):
            for j in range(4):
                self.square("floor", (i, j, 0), (0, 1, 0), (1, 0, 0))
                self.square("roof", (i, j, 4), (1, 0, 0), (0, 1, 0))
                self.square("south", (i, 0, j), (1, 0, 0), (0, 0, 1))
                self.square("north", (i, 4, j), (0, 0, 1), (1, 0, 0))
        for j in range(4):
            for k in range(4):
                self.square("inlet", (0, j, k), (0, 0, 1), (0, 1, 0))
                self.square("outlet", (6, j, k), (0, 1, 0), (0, 0, 1))

    def vertex(self, p):
        return self.points.setdefault(tuple(p), len(self.points) + 1)

    def triangle(self, group, *corners):
        self.groups.setdefault(group, []).append([self.vertex(p) for p in corners])

    def square(self, group, at, u, v, turned=False):
        a = at
        b = [at[i] + u[i] for i in range(3)]
        c = [at[i] + u[i] + v[i] for i in range(3)]
        d = [at[i] + v[i] for i in range(3)]
        for t in ((a, b, c), (a, c, d)):
            self.triangle(group, *(t[::-1] if turned else t))

    def vane(self, ys, zs):
        """At x = 3. Its triangles point in both directions."""
        for y in ys:
            for z in zs:
                self.square("vane", (3, y, z), (0, 1, 0), (0, 0, 1), turned=(y + z) % 2)
        return self

    def fence(self, xs, zs):
        """At y = 2."""
        for x in xs:
            for z in zs:
                self.square("fence", (x, 2, z), (1, 0, 0), (0, 0, 1))
        return self

    def shelf(self):
        """A sheet that crosses the vane's triangles and shares no point with them."""
        self.triangle("shelf", (2, 2, 1.5), (4, 2.5, 1.5), (4, 1.5, 1.5))
        return self

    def leaf(self):
        """A sheet whose corner lies inside a triangle of the roof."""
        self.triangle("leaf", (3.25, 1.5, 4), (3, 1, 2), (3, 2, 2))
        return self

    def strip(self, twists):
        """A band around the middle that turns half round so many times: two are as good as none, one is Möbius' strip."""
        from math import cos, pi, sin
        steps = 24

        def edge(i):
            turn, lean = 2 * pi * i / steps, twists * pi * i / steps
            ends = []
            for side in (-0.4, 0.4):
                r = 1.2 + side * cos(lean)
                ends.append((round(3 + r * cos(turn), 6), round(2 + r * sin(turn), 6), round(2 + side * sin(lean), 6)))
            return ends

        for i in range(steps):
            (a, b), (c, d) = edge(i), edge(i + 1)
            self.triangle("strip", a, c, d)
            self.triangle("strip", a, d, b)
        return self

    def dome(self):
        """A cup with its opening downwards, wider than its rim."""
        rim = [(4, 2, 1), (3, 3, 1), (2, 2, 1), (3, 1, 1)]
        wide = [(4.4, 2, 2), (3, 3.4, 2), (1.6, 2, 2), (3, 0.6, 2)]
        for i in range(4):
            a, b, c, d = rim[i], rim[(i + 1) % 4], wide[(i + 1) % 4], wide[i]
            self.triangle("dome", a, b, c)
            self.triangle("dome", a, c, d)
            self.triangle("dome", d, c, (3, 2, 3))
        return self

    def text(self):
        lines = ["v %g %g %g" % p for p in self.points]
        for group, triangles in self.groups.items():
            lines.append(f"g {group}")
            lines += ["f %d %d %d" % tuple(t) for t in triangles]
        return "\n".join(lines) + "\n"


KINDS = {
    "standing": lambda: Room().vane(range(4), range(2)),
    "floating": lambda: Room().vane((1, 2), (1, 2)),
    "cross": lambda: Room().vane(range(4), range(2)).fence(range(1, 5), range(2)),
    "tee": lambda: Room().vane(range(4), range(2)).fence((3, 4), range(2)),
    "dome": lambda: Room().dome(),
    "ring": lambda: Room().strip(0),
    "moebius": lambda: Room().strip(1),
    "through-roof": lambda: Room().vane((1, 2), range(2, 6)),
    "outside": lambda: Room().vane((1, 2), (4, 5)),
    "none": lambda: Room(),
    "crossing": lambda: Room().vane((1, 2), (1, 2)).shelf(),
    "touching": lambda: Room().leaf(),
}


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in KINDS:
        sys.exit(__doc__ + "\n" + " ".join(KINDS))
    sys.stdout.write(KINDS[sys.argv[1]]().text())
