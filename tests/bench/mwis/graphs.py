#!/usr/bin/python3
"""graphs.py copies GRAPH N | graphs.py cliques VERTICES SIZE [SEED] - large conflict graphs on standard output, as METIS.

`copies` puts N copies of a METIS graph (plain or .zst) beside each other: the optimum is N times that of the graph, so
that a heuristic can be judged at a million vertices.

`cliques` makes a union of cliques as vehicle routing does: every vertex is in three cliques of about SIZE vertices (a
driver and two loads), which lie near each other; weights are from 1 to 1000. 650000 vertices and a size of 250 make 199
million edges, a file of 2.7 GB, in 26 CPU seconds and 1.9 GB of memory; 280 make some 220 million.
"""
import subprocess
import sys

import numpy as np


# Looked up, because making the text of a number anew takes several times as long.
def line(weight, neighbours, names):
    return f"{weight} {' '.join([names[number] for number in neighbours])}\n"


def copies(path, count):
    text = subprocess.run(["zstd", "-dqcf", path], stdout=subprocess.PIPE, check=True, text=True).stdout
    header, *rows = text.splitlines()
    vertices, edges, form = header.split()
    if form != "10":
        sys.exit(f"{path}: expected vertex weights, format 10, found {form}")
    rows = [[int(number) for number in row.split()] for row in rows]
    print(count * int(vertices), count * int(edges), form)
    for copy in range(count):
        names = [str(copy * int(vertices) + number) for number in range(int(vertices) + 1)]
        sys.stdout.writelines(line(weight, neighbours, names) for weight, *neighbours in rows)


def cliques(vertices, size, seed=1):
    rng = np.random.default_rng(seed)
    count = max(3 * vertices // size, 1)
    near = 16
    places = np.arange(vertices) * count // vertices
    memberships = (places[:, None] + rng.integers(0, near, (vertices, 3))) % count
    order = np.argsort(memberships.ravel(), kind="stable")
    bounds = np.searchsorted(memberships.ravel()[order], np.arange(count + 1))
    members = [np.unique(order[begin:end] // 3).astype(np.int32) for begin, end in zip(bounds, bounds[1:])]
    rows = []
    for v in range(vertices):
        row = np.unique(np.concatenate([members[clique] for clique in memberships[v]]))
        rows.append(row[row != v] + np.int32(1))
    print(vertices, sum(map(len, rows)) // 2, 10)
    names = [str(number) for number in range(vertices + 1)]
    weights = rng.integers(1, 1001, vertices).tolist()
    sys.stdout.writelines(line(weight, row.tolist(), names) for weight, row in zip(weights, rows))


def main(arguments):
    if len(arguments) >= 3 and arguments[0] == "copies":
        copies(arguments[1], int(arguments[2]))
    elif len(arguments) >= 3 and arguments[0] == "cliques":
        cliques(*map(int, arguments[1:]))
    else:
        sys.exit(__doc__.strip())


if __name__ == "__main__":
    main(sys.argv[1:])
