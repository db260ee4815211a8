#!/usr/bin/python3
"""graph_from_candidates.py FILE.cand FILE.graph [--weight quality|volume|count|quality*volume|quality^0.3*volume] [--weight-scale S]

Is this the conflict graph of these candidates? Compares all pairs by the table of ALGORITHMS.md 2, written as what two
cells may share: nothing, a vertex, an edge, a triangle or a quad, each of both. Seconds for a thousand candidates.
"""
import argparse
import itertools
import sys

EDGES = {"hex": "01 12 23 30 45 56 67 74 04 15 26 37", "prism": "01 12 20 34 45 53 03 14 25",
         "pyramid": "01 12 23 30 04 14 24 34"}
TRIANGLES = {"hex": "", "prism": "012 345", "pyramid": "014 124 234 304"}
QUADS = {"hex": "0123 4567 0154 1265 2376 3047", "prism": "0143 1254 2035", "pyramid": "0123"}
SIZE = {"hex": 8, "prism": 6, "pyramid": 5}


class Cell:
    def __init__(self, line):
        self.kind, self.quality, self.volume, interior, _, *numbers = line.split()
        n, interior = SIZE[self.kind], int(interior)
        self.corners = numbers[:n]
        self.tets = set(numbers[n:n + interior])
        pick = lambda table: [[self.corners[int(c)] for c in word] for word in table[self.kind].split()]
        # The facets and edges that may be shared; a quad also says who lies opposite whom.
        self.parts = {frozenset()} | {frozenset([v]) for v in self.corners}
        self.parts |= {frozenset(e) for e in pick(EDGES)} | {frozenset(t) for t in pick(TRIANGLES)}
        self.quads = {frozenset([frozenset((a, c)), frozenset((b, d))]) for a, b, c, d in pick(QUADS)}
        self.vertices = set(self.corners)

    def may_stand_beside(self, other):
        if self.tets & other.tets:
            return False
        shared = frozenset(self.vertices & other.vertices)
        if len(shared) < 4:
            return shared in self.parts and shared in other.parts
        return any(frozenset().union(*quad) == shared for quad in self.quads & other.quads)

    def weight(self, kind, scale):
        quality, volume = float(self.quality), float(self.volume)
        worth = {"quality": quality, "volume": volume, "count": 1, "quality*volume": quality * volume,
                 "quality^0.3*volume": quality ** 0.3 * volume}[kind]
        return scale * worth


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cand")
    parser.add_argument("graph")
    parser.add_argument("--weight", default="quality")
    parser.add_argument("--weight-scale", type=float, default=1e6)
    options = parser.parse_args()
    cells = [Cell(line) for line in open(options.cand).read().splitlines()[1:]]
    header, *lines = open(options.graph).read().splitlines()
    rows = [[int(x) for x in line.split()] for line in lines]
    count, edges, form = header.split()
    assert form == "10" and int(count) == len(cells) == len(rows), header
    assert sum(len(row) - 1 for row in rows) == 2 * int(edges), header
    neighbours = [set(row[1:]) for row in rows]
    wrong = 0
    for i, j in itertools.combinations(range(len(cells)), 2):
        conflict = not cells[i].may_stand_beside(cells[j])
        if (j + 1 in neighbours[i]) != conflict or (i + 1 in neighbours[j]) != conflict:
            wrong += 1
            print(f"candidates {i + 1} and {j + 1}: expected {'a' if conflict else 'no'} conflict")
    for i, (cell, row) in enumerate(zip(cells, rows)):
        if abs(row[0] - cell.weight(options.weight, options.weight_scale)) > 0.5 + 1e-9 * row[0]:
            wrong += 1
            print(f"candidate {i + 1}: expected weight {cell.weight(options.weight, options.weight_scale)}, found {row[0]}")
    print(f"{count} vertices, {edges} edges, {wrong} wrong")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
