#!/usr/bin/python3
"""graph_fragment.py GRAPH VERTICES SEED - a fragment of a METIS graph with weights, grown breadth first from a random vertex.

Written to standard output as a METIS graph. Where a component ends, it goes on from another random vertex.
"""
import random
import sys


def grow(neighbours, count, rng):
    """The first `count` vertices that are reached."""
    reached, seen = [], set()
    while len(reached) < count:
        queue = [rng.randrange(len(neighbours))]
        for v in queue:
            if v in seen or len(reached) == count:
                continue
            seen.add(v)
            reached.append(v)
            queue.extend(neighbours[v])
    return sorted(reached)


def main():
    path, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    with open(path) as file:
        rows = [[int(word) for word in line.split()] for line in file][1:]
    neighbours = [[v - 1 for v in row[1:]] for row in rows]
    fragment = grow(neighbours, min(count, len(rows)), random.Random(seed))
    places = {v: place for place, v in enumerate(fragment, 1)}
    lists = [sorted(places[u] for u in neighbours[v] if u in places) for v in fragment]
    print(len(fragment), sum(map(len, lists)) // 2, 10)
    for v, around in zip(fragment, lists):
        print(rows[v][0], *around)


main()
