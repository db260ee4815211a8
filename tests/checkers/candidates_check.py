#!/usr/bin/python3
"""candidates_check.py - all candidates of a small mesh by the definitions (docs/definitions.md 1), compared with a .cand file.

usage: candidates_check.py MESH.mesh FILE.cand [--cells hex,prism,pyramid] [--min-quality Q] [--quality corner|element]
           [--inner-vertices allow|forbid] [--folded-quads drop|keep] [--flat-corners reject|keep] [--max-boundary-tets N]
           [--feature-angle DEGREES]

Finds cells another way than findhex does: hexes from a quad and the side quads at two opposite sides of it, prisms from a
triangle and its side quads, pyramids from a quad and a vertex; the interior tets from the surface made of one diagonal a
quad. Coordinates are whole numbers, so that every decision is exact. Minutes for thousands of tets.
"""
import argparse
import functools
import itertools
import math
import sys
from fractions import Fraction

import numpy as np

EDGES = {8: [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
         6: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
         5: [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]}
QUADS = {8: [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
         6: [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
         5: [(0, 3, 2, 1)]}
TRIANGLES = {8: [], 6: [(0, 2, 1), (3, 4, 5)], 5: [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]}
CORNERS = {8: [(0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7), (4, 7, 5, 0), (5, 4, 6, 1), (6, 5, 7, 2),
               (7, 6, 4, 3)],
           6: [(0, 1, 2, 3), (1, 2, 0, 4), (2, 0, 1, 5), (3, 5, 4, 0), (4, 3, 5, 1), (5, 4, 3, 2)],
           5: [(0, 1, 3, 4), (1, 2, 0, 4), (2, 3, 1, 4), (3, 0, 2, 4)]}
NAMES = {8: "hex", 6: "prism", 5: "pyramid"}
LEAST_INTERIOR = {8: 5, 6: 3, 5: 2}
MOST = {8: 15, 6: 6, 5: 3}


def det(u, v, w):
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
            u[2] * (v[0] * w[1] - v[1] * w[0]))


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u, v):
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


class Mesh:
    def __init__(self, path):
        words = open(path).read().split()
        sections = {"Vertices": 4, "Edges": 3, "Ridges": 1, "Triangles": 4, "Tetrahedra": 5}
        found = {name: [] for name in sections}
        at = 0
        while at < len(words):
            if words[at] in sections:
                width, count = sections[words[at]], int(words[at + 1])
                rows = words[at + 2:at + 2 + width * count]
                found[words[at]] = [rows[i:i + width] for i in range(0, len(rows), width)]
                at += 2 + width * count
            else:
                at += 1
        self.floats = [tuple(float(x) for x in row[:3]) for row in found["Vertices"]]
        # Whole numbers: all coordinates times one power of two.
        exact = [[Fraction(x) for x in row] for row in self.floats]
        scale = max((x.denominator for row in exact for x in row), default=1)
        self.points = [tuple(int(x * scale) for x in row) for row in exact]
        self.tets = [tuple(int(v) - 1 for v in row[:4]) for row in found["Tetrahedra"]]
        self.regions = [int(row[4]) for row in found["Tetrahedra"]]
        self.tags = {frozenset(int(v) - 1 for v in row[:3]): int(row[3]) for row in found["Triangles"]}
        edges = [frozenset(int(v) - 1 for v in row[:2]) for row in found["Edges"]]
        self.ridges = {edges[int(row[0]) - 1] for row in found["Ridges"]}
        self.flat = {t for t, tet in enumerate(self.tets) if self.volume(tet) == 0}
        self.tets_of = {}  # facet -> tets
        for t, tet in enumerate(self.tets):
            for facet in itertools.combinations(tet, 3):
                self.tets_of.setdefault(frozenset(facet), []).append(t)
        for facet, tets in self.tets_of.items():  # derived surface triangles
            if len(tets) == 1 or self.regions[tets[0]] != self.regions[tets[1]]:
                self.tags.setdefault(facet, 0)
        self.facets = {f for f, tets in self.tets_of.items() if any(t not in self.flat for t in tets)}
        self.find_quads()

    def volume(self, tet):
        a, b, c, d = (self.points[v] for v in tet)
        return det(minus(b, a), minus(c, a), minus(d, a))

    def find_quads(self):
        rings = {}
        for facet in self.facets:
            for edge in itertools.combinations(sorted(facet), 2):
                rings.setdefault(edge, set()).update(facet - set(edge))
        self.at_edge = {}  # (x, y) -> all (z, w) such that x y z w is a triangulated quad
        for (p, r), ring in rings.items():
            for b, d in itertools.combinations(ring, 2):
                quad = (p, b, r, d)
                for i in range(4):
                    x, y, z, w = (quad[(i + k) % 4] for k in range(4))
                    self.at_edge.setdefault((x, y), set()).add((z, w))
                    self.at_edge.setdefault((y, x), set()).add((w, z))

    def is_quad(self, a, b, c, d):
        return (c, d) in self.at_edge.get((a, b), ())

    def inside(self, a, b, c):
        """The tet behind the triangle whose corners go counter-clockwise seen from outside."""
        for t in self.tets_of.get(frozenset((a, b, c)), []):
            d, = set(self.tets[t]) - {a, b, c}
            if t not in self.flat and self.volume((a, c, b, d)) > 0:
                return t
        return None

    def beyond(self, t, facet):
        return next((s for s in self.tets_of[facet] if s != t), None)

    def label(self, facet):
        """Rule 7: what two triangles of a quad have to agree in."""
        return (len(self.tets_of[facet]) == 1, self.tags.get(facet))


def hexes(mesh, good):
    for (a, b), ends in mesh.at_edge.items():
        for c, d in ends:
            if a != min(a, b, c, d):
                continue
            tops = [top for top in mesh.at_edge[(c, d)] if good(c, d, b, top[1]) and good(d, a, c, top[0])]
            for b2, a2 in mesh.at_edge[(a, b)] if tops else ():
                if {a2, b2} & {c, d} or not (good(a, b, d, a2) and good(b, c, a, b2)):
                    continue
                for d2, c2 in tops:
                    if len({a, b, c, d, a2, b2, c2, d2}) < 8:
                        continue
                    if (mesh.is_quad(b, c, c2, b2) and mesh.is_quad(d, a, a2, d2) and mesh.is_quad(a2, b2, c2, d2)):
                        yield (a, b, c, d, a2, b2, c2, d2)


def prisms(mesh, good):
    for facet in mesh.facets:
        for a, b, c in itertools.permutations(facet):
            for b2, a2 in mesh.at_edge.get((a, b), ()):
                if not (good(a, b, c, a2) and good(b, c, a, b2)):
                    continue
                for c2, b3 in mesh.at_edge.get((b, c), ()):
                    if b3 == b2 and len({a, b, c, a2, b2, c2}) == 6 and mesh.is_quad(c, a, a2, c2):
                        if frozenset((a2, b2, c2)) in mesh.facets:
                            yield (a, b, c, a2, b2, c2)


def pyramids(mesh, _):
    for (a, b), ends in mesh.at_edge.items():
        for c, d in ends:
            apexes = None
            for x, y in ((a, b), (b, c), (c, d), (d, a)):
                third = {v for f in mesh.facets_at[frozenset((x, y))] for v in f - {x, y}}
                apexes = third if apexes is None else apexes & third
            for e in apexes - {a, b, c, d}:
                yield (a, b, c, d, e)


def corner_test(mesh, least):
    """Rule 3 for one corner, strictly: det > q |u| |v| |w|, by squares."""
    over, under = (least * least).numerator, (least * least).denominator

    @functools.cache
    def good(o, *ends):
        u, v, w = (minus(mesh.points[e], mesh.points[o]) for e in ends)
        d = det(u, v, w)
        return d > 0 and under * d * d > over * dot(u, u) * dot(v, v) * dot(w, w)

    return good


def tangents(points, i, j, k, one=1):
    """Of the cell's map at parameters from 0 to `one`. With 2 for it the middles are whole numbers, too, which takes less than
    half the time of fractions; it makes the tangents of hexes and prisms longer, by the same everywhere."""
    def mix(*terms):
        return tuple(sum(weight * p[axis] for weight, p in terms) for axis in range(3))

    if len(points) == 8:
        place = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
        part = lambda t, bit: t if bit else one - t
        sign = lambda bit: 1 if bit else -1
        return (mix(*((sign(a) * part(j, b) * part(k, c), p) for (a, b, c), p in zip(place, points))),
                mix(*((part(i, a) * sign(b) * part(k, c), p) for (a, b, c), p in zip(place, points))),
                mix(*((part(i, a) * part(j, b) * sign(c), p) for (a, b, c), p in zip(place, points))))
    if len(points) == 6:
        p = points
        return (mix((one - k, p[1]), (k - one, p[0]), (k, p[4]), (-k, p[3])),
                mix((one - k, p[2]), (k - one, p[0]), (k, p[5]), (-k, p[3])),
                mix((one - i - j, p[3]), (i + j - one, p[0]), (i, p[4]), (-i, p[1]), (j, p[5]), (-j, p[2])))
    p = points
    return (mix((1 - j, p[1]), (j - 1, p[0]), (j, p[2]), (-j, p[3])),
            mix((1 - i, p[3]), (i - 1, p[0]), (i, p[2]), (-i, p[1])),
            mix((1, p[4]), ((i - 1) * (1 - j), p[0]), (-i * (1 - j), p[1]), (-i * j, p[2]), ((i - 1) * j, p[3])))


def to_bezier(values):
    """Values of a quadratic at 0, 1/2, 1 -> its Bezier coefficients, along each axis of a cube of values."""
    for axis in range(3):
        a, b, c = (np.take(values, n, axis) for n in range(3))
        values = np.stack([a, 2 * b - (a + c) / 2, c], axis)
    return values


def halves(coefficients, axis):
    a, b, c = (np.take(coefficients, n, axis) for n in range(3))
    ab, bc = (a + b) / 2, (b + c) / 2
    middle = (ab + bc) / 2
    return np.stack([a, ab, middle], axis), np.stack([middle, bc, c], axis)


def is_positive(coefficients, cuts):
    if coefficients[::2, ::2, ::2].min() <= 0:
        return False
    if coefficients.min() > 0:
        return True
    if cuts == 0:
        return False
    parts = [coefficients]
    for axis in range(3):
        parts = [half for part in parts for half in halves(part, axis)]
    return all(is_positive(part, cuts - 1) for part in parts)


def hex_grid(points):
    """Determinants, of whole numbers exact ones of any size."""
    return np.array([[[det(*tangents(points, i, j, k, one=2)) for k in range(3)] for j in range(3)] for i in range(3)],
                    dtype=object)


def is_valid(mesh, cell):
    """Rule 4. Prisms: the quadratics along the three edges; pyramids: the corners of the base."""
    points = [mesh.points[v] for v in cell]
    if len(cell) == 8:
        rounded = to_bezier(hex_grid([mesh.floats[v] for v in cell]))
        if rounded.min() > 1e-9 * rounded.max():  # far beyond rounding
            return True
        return is_positive(to_bezier(hex_grid(points) + Fraction(0)), 4)
    if len(cell) == 6:
        for i, j in ((0, 0), (2, 0), (0, 2)):
            a, b, c = (det(*tangents(points, i, j, k, one=2)) for k in range(3))
            if a <= 0 or c <= 0:
                return False
            second = 2 * a - 4 * b + 2 * c  # of a + s t + second t^2
            slope = 4 * b - 3 * a - c
            if second > 0 and 0 < -slope < 2 * second and a - Fraction(slope * slope) / (4 * second) <= 0:
                return False
        return True
    return all(det(*tangents(points, i, j, 0)) > 0 for i in (0, 1) for j in (0, 1))


def region_within(mesh, walls, start):
    """The tets that hang together with `start` across other facets than the walls; None when they are too many."""
    region, todo = {start}, [start]
    while todo:
        t = todo.pop()
        for facet in map(frozenset, itertools.combinations(mesh.tets[t], 3)):
            if facet in walls:
                continue
            s = mesh.beyond(t, facet)
            if s is None or s in mesh.flat or facet in mesh.tags or mesh.regions[s] != mesh.regions[t]:
                return None
            if s not in region:
                region.add(s)
                todo.append(s)
                if len(region) > 40:
                    return None
    return region


def diagonals(mesh, cell):
    """For each quad, the pairs of triangles that the mesh has there."""
    choices = []
    for q in QUADS[len(cell)]:
        a, b, c, d = (cell[i] for i in q)
        options = (((a, b, c), (a, c, d)), ((a, b, d), (b, c, d)))
        choices.append([pair for pair in options if all(frozenset(t) in mesh.facets for t in pair)])
    return choices


def is_folded(mesh, pairs):
    """Rule 8: for no diagonal do the normals of both triangles agree."""
    def normal(a, b, c):
        return cross(minus(mesh.points[b], mesh.points[a]), minus(mesh.points[c], mesh.points[a]))

    return not any(dot(normal(*one), normal(*other)) > 0 for one, other in pairs)


def interior_tets(mesh, cell):
    """Rule 5: the tets enclosed by the cell's triangles and one diagonal of each quad; with those diagonals."""
    quads = [tuple(cell[c] for c in q) for q in QUADS[len(cell)]]
    triangles = [tuple(cell[c] for c in t) for t in TRIANGLES[len(cell)]]
    every_wall = {frozenset(t) for t in triangles}
    for q in quads:
        every_wall |= {frozenset(t) for t in itertools.combinations(q, 3)}
    corners_of_quads = {frozenset(q) for q in quads}
    for pairs in itertools.product(*diagonals(mesh, cell)):
        surface = triangles + [t for pair in pairs for t in pair]
        behind = [mesh.inside(*t) for t in surface]
        if None in behind:
            continue
        region = region_within(mesh, {frozenset(t) for t in surface}, behind[0])
        if region is None or any(t not in region for t in behind):
            continue
        count = {}
        for t in region:
            for facet in map(frozenset, itertools.combinations(mesh.tets[t], 3)):
                count[facet] = count.get(facet, 0) + 1
        if {f for f, n in count.items() if n == 1} != {frozenset(t) for t in surface}:
            continue
        # A tet on a quad is on its surface: the other diagonal there gives the interior without it.
        if any(frozenset(mesh.tets[t]) in corners_of_quads for t in region):
            continue
        # The flood crosses none of the possible triangles, and has to get everywhere.
        if region_within(mesh, every_wall, behind[0]) == region:
            return region, pairs
    return None


def is_over_sharp_edge(mesh, outer, angle):
    """Rule 10, of a quad with these outermost triangles."""
    if outer[0] not in mesh.tags:
        return False
    edge = outer[0] & outer[1]
    a, c = edge
    (b,), (d,) = outer[0] - edge, outer[1] - edge
    points = mesh.floats
    along = minus(points[c], points[a])
    n, m = cross(minus(points[b], points[a]), along), cross(along, minus(points[d], points[a]))
    return edge in mesh.ridges or dot(n, m) < math.cos(math.radians(angle)) * math.sqrt(dot(n, n) * dot(m, m))


def leaves_flat_corner(mesh, outer, within):
    """Rule 9, of a quad with these outermost triangles on tets `within`."""
    if outer[0] in mesh.tags:
        return False
    beyond = [next((t for t in mesh.tets_of[f] if t not in within), None) for f in outer]
    if None in beyond or any(t in mesh.flat for t in beyond):
        return False
    apexes = set().union(*(set(mesh.tets[t]) - f for t, f in zip(beyond, outer)))
    if len(apexes) > 1:
        return False
    apex, = apexes
    diagonal = outer[0] & outer[1]
    side, other_side = outer[0] ^ outer[1]
    for corner in diagonal:
        if frozenset((corner, side, apex)) in mesh.tags and frozenset((corner, other_side, apex)) in mesh.tags:
            u, v, w = (minus(mesh.points[x], mesh.points[corner]) for x in (side, other_side, apex))
            # Positive where the apex lies on the same side as seen from the diagonal's other end: the tets are positive.
            opposite = minus(mesh.points[next(iter(diagonal - {corner}))], mesh.points[corner])
            d = det(u, v, w) * (1 if det(u, opposite, w) > 0 else -1)
            if d <= 0 or 10**12 * d * d <= dot(u, u) * dot(v, v) * dot(w, w):
                return True
    return False


def tets_of(mesh, cell, options):
    """Rules 5 to 10: (interior tets, boundary tets), or None."""
    found = interior_tets(mesh, cell)
    if found is None or options.folded_quads == "drop" and any(is_folded(mesh, pairs) for pairs in diagonals(mesh, cell)):
        return None
    region, pairs = found
    boundary = set()
    for pair in pairs:
        outer = [frozenset(t) for t in pair]
        corners = outer[0] | outer[1]
        on_quad = {mesh.beyond(next(t for t in mesh.tets_of[f] if t in region), f) for f in outer} - {None}
        on_quad = {t for t in on_quad if frozenset(mesh.tets[t]) == corners and t not in mesh.flat}
        if on_quad:
            t, = on_quad
            if any(f in mesh.tags for f in outer) or mesh.regions[t] != mesh.regions[next(iter(region))]:
                return None
            boundary.add(t)
            outer = [f for f in map(frozenset, itertools.combinations(corners, 3)) if f not in outer]
        if mesh.label(outer[0]) != mesh.label(outer[1]):
            return None
        if options.folded_quads == "drop" and is_over_sharp_edge(mesh, outer, options.feature_angle):
            return None
        if options.flat_corners == "reject" and leaves_flat_corner(mesh, outer, region | on_quad):
            return None
    n = len(cell)
    if len(region) < LEAST_INTERIOR[n] or len(region) + len(boundary) > MOST[n]:
        return None
    if len(boundary) > options.max_boundary_tets:
        return None
    if options.inner_vertices == "forbid" and any(set(mesh.tets[t]) - set(cell) for t in region):
        return None
    return region, boundary


def key_of(cell):
    return len(cell), frozenset(frozenset((cell[a], cell[b])) for a, b in EDGES[len(cell)])


def all_candidates(mesh, options):
    mesh.facets_at = {}
    for facet in mesh.facets:
        for edge in itertools.combinations(facet, 2):
            mesh.facets_at.setdefault(frozenset(edge), []).append(facet)
    search = {"hex": hexes, "prism": prisms, "pyramid": pyramids}
    good = corner_test(mesh, Fraction(options.min_quality))
    seen, result = set(), {}
    for kind in options.cells.split(","):
        for cell in search[kind](mesh, good):
            if not all(good(*(cell[c] for c in corner)) for corner in CORNERS[len(cell)]):
                continue
            key = key_of(cell)
            if key in seen:
                continue
            seen.add(key)
            if is_valid(mesh, cell):
                tets = tets_of(mesh, cell, options)
                if tets:
                    result[key] = tets
    return result


def read_cand(path):
    lines = open(path).read().splitlines()
    word, version, count, tets, boundary_tets = lines[0].split()
    assert (word, version) == ("hexpipe-candidates", "1"), lines[0]
    assert int(count) == len(lines) - 1
    cells = []
    for line in lines[1:]:
        kind, quality, volume, interior, boundary, *numbers = line.split()
        n = {name: n for n, name in NAMES.items()}[kind]
        interior, boundary = int(interior), int(boundary)
        numbers = [int(x) - 1 for x in numbers]
        assert len(numbers) == n + interior + boundary, line
        cells.append((tuple(numbers[:n]), numbers[n:n + interior], numbers[n + interior:], float(quality), float(volume)))
    assert sum(len(c[1]) for c in cells) == int(tets) and sum(len(c[2]) for c in cells) == int(boundary_tets)
    return cells


def scaled(u, v, w):
    """Of tangents, or of arrays of them."""
    return det(u, v, w) / np.sqrt(dot(u, u) * dot(v, v) * dot(w, w))


# Parameters (3 x n) where the quality of cells is looked at.
PLACES = np.array(list(itertools.product([n / 4 for n in range(5)], repeat=3))).T
PLACES_OF_PRISMS = PLACES[:, PLACES[0] + PLACES[1] <= 1]


def check_numbers(mesh, cell, quality, volume, options):
    points = [mesh.floats[v] for v in cell]
    corner = min(scaled(*(minus(points[e], points[o]) for e in ends)) for o, *ends in CORNERS[len(cell)])
    if options.quality == "corner":
        assert abs(quality - corner) < 1e-12, (cell, quality, corner)
    else:
        assert quality <= corner + 1e-12, (cell, quality, corner)
        places = PLACES_OF_PRISMS if len(cell) == 6 else PLACES
        qualities = scaled(*tangents(points, *places))
        worst = np.argmin(qualities)
        assert qualities[worst] >= quality - 1e-3 - 1e-12, (cell, quality, places[:, worst])
    gauss = (0.5 - 0.5 / 3 ** 0.5, 0.5 + 0.5 / 3 ** 0.5)
    if len(cell) == 8:
        measured = sum(det(*tangents(points, i, j, k)) for i in gauss for j in gauss for k in gauss) / 8
    elif len(cell) == 6:
        measured = sum(det(*tangents(points, 1 / 3, 1 / 3, k)) for k in gauss) / 4
    else:
        measured = det(*tangents(points, 0.5, 0.5, 0)) / 3
    assert abs(measured - volume) < 1e-9 * max(1, abs(volume)), (cell, volume, measured)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("cand")
    parser.add_argument("--cells", default="hex")
    parser.add_argument("--min-quality", type=float, default=0.3)
    parser.add_argument("--quality", default="element")
    parser.add_argument("--inner-vertices", default="allow")
    parser.add_argument("--folded-quads", default="drop")
    parser.add_argument("--flat-corners", default="reject")
    parser.add_argument("--feature-angle", type=float, default=40)
    parser.add_argument("--max-boundary-tets", type=int, default=6)
    options = parser.parse_args()
    mesh = Mesh(options.mesh)
    expected = all_candidates(mesh, options)
    found = {}
    for cell, interior, boundary, quality, volume in read_cand(options.cand):
        assert cell[0] == min(cell[:4] if len(cell) == 5 else cell), cell
        assert interior == sorted(interior) and boundary == sorted(boundary), cell
        key = key_of(cell)
        assert key not in found, ("twice", cell)
        found[key] = (set(interior), set(boundary))
        check_numbers(mesh, cell, quality, volume, options)
    missing, extra = set(expected) - set(found), set(found) - set(expected)
    different = [key for key in set(found) & set(expected) if found[key] != expected[key]]
    for what, keys in (("missing", missing), ("extra", extra), ("other tets", different)):
        for key in list(keys)[:3]:
            print(what, NAMES[key[0]], sorted(set().union(*key[1])), expected.get(key), found.get(key))
    print(f"{len(found)} candidates, {len(missing)} missing, {len(extra)} extra, {len(different)} with other tets")
    sys.exit(bool(missing or extra or different))


if __name__ == "__main__":
    main()
