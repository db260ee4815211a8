#!/usr/bin/python3
"""ring_graph.py VERTICES CELLS SEED - a conflict graph on standard output, as METIS .graph.

Vertices are sets of two to four cells near each other on a ring, in conflict where they share one: cliques that overlap
locally, as in conflict graphs of meshes. Weights are from 1 to 1000.
"""
import random
import sys

vertices, cells, seed = map(int, sys.argv[1:])
rng = random.Random(seed)
at_cell = [[] for _ in range(cells)]
parts = []
for v in range(vertices):
    place = rng.randrange(cells)
    parts.append({(place + rng.randrange(6)) % cells for _ in range(rng.randint(2, 4))})
    for cell in parts[-1]:
        at_cell[cell].append(v)
neighbours = [sorted({u for cell in part for u in at_cell[cell]} - {v}) for v, part in enumerate(parts)]
print(vertices, sum(map(len, neighbours)) // 2, 10)
for row in neighbours:
    print(rng.randint(1, 1000), *(u + 1 for u in row))
