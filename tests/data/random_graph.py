#!/usr/bin/python3
"""random_graph.py VERTICES - a METIS graph without structure to standard output, on which a search does not end by itself."""
import random
import sys

rng = random.Random(1)
n = int(sys.argv[1])
rows = [[] for _ in range(n)]
for a in range(n):
    for b in range(a + 1, n):
        if rng.random() < 0.02:
            rows[a].append(b + 1), rows[b].append(a + 1)
print(n, sum(map(len, rows)) // 2, 10)
for row in rows:
    print(rng.randint(1, 1000), *row)
