#!/usr/bin/python3
"""quads_check.py PLAIN BUNDLE - do the vertices of quads in BUNDLE mean what docs/definitions.md says?

PLAIN is the bundle of `buildgraph` without --quad-reward, BUNDLE that with it, and may hold a solution, too. Checks from the
corners of the candidates alone which quads two candidates without a conflict share, that each of these has a vertex in
conflict with just the candidates at it, that candidates weigh the prices of their quads more, and that the weight of the
solution, less that of all quads, is the weight of its candidates less the prices of open quads. Where the bundle has a
mesh, candidates weigh less by the price of each quad inside that no two can share; for this all prices have to be the same. Prints
`N quads, M open, value V`, or what is wrong; exits 1 when anything is.
"""
import collections
import io
import itertools
import pathlib
import sys
import tarfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from graph_check import check, read_graph, require  # noqa: E402

QUADS = {12: [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
         13: [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)], 14: [(0, 1, 2, 3)]}


def members(path):
    with tarfile.open(path) as archive:
        return {m.name: np.load(io.BytesIO(archive.extractfile(m).read())) for m in archive if m.name.endswith(".npy")}


def boundary_of(tets):
    count = collections.Counter(t for tet in tets.tolist() for t in itertools.combinations(sorted(tet), 3))
    return {t for t, times in count.items() if times == 1}


def main(plain_path, path):
    try:
        weights, lists = read_graph(plain_path)
        all_weights, all_lists = read_graph(path)
        check(all_weights, all_lists)
        data = members(path)
        count = len(data["candidates/kind.npy"])
        require(len(weights) == count, "the first graph is no plain one")
        neighbours = [set(row.tolist()) for row in lists]
        at = {}
        for i, (kind, corners) in enumerate(zip(data["candidates/kind.npy"], data["candidates/vertices.npy"])):
            for quad in QUADS[int(kind)]:
                at.setdefault(tuple(sorted(int(corners[k]) for k in quad)), set()).add(i)
        shared = sorted(q for q, cells in at.items() if any(cells - neighbours[i] - {i} for i in cells))
        require(data["graph/quads.npy"].tolist() == [list(q) for q in shared], "other quads can be shared")
        require(len(all_weights) == count + len(shared), "not a vertex for each candidate and quad")
        prices = [weight // 2 for weight in all_weights[count:]]
        require([2 * price for price in prices] == all_weights[count:], "a quad does not weigh twice its price")
        expected, gain, cost = [set(row) for row in neighbours], [0] * count, [0] * count
        for q, quad in enumerate(shared):
            require(set(all_lists[count + q].tolist()) == at[quad], f"quad {q} is not in conflict with the candidates at it")
            for i in at[quad]:
                expected[i].add(count + q)
                gain[i] += prices[q]
        if "mesh/tets.npy" in data and shared:
            require(len(set(prices)) == 1, "prices differ")
            boundary = boundary_of(data["mesh/tets.npy"])
            for quad in at.keys() - set(shared):
                if sum(t in boundary for t in itertools.combinations(quad, 3)) < 2:
                    for i in at[quad]:
                        cost[i] += prices[0]
        for i in range(count):
            require(set(all_lists[i].tolist()) == expected[i], f"candidate {i} has other conflicts")
            require(all_weights[i] == max(0, weights[i] + gain[i] - cost[i]), f"candidate {i} has another weight")
        line = f"{len(shared)} quads"
        if "solution/chosen.npy" in data:
            chosen = set(data["solution/chosen.npy"].tolist())
            is_open = [len(at[quad] & chosen) == 1 for quad in shared]
            value = sum(max(weights[i] - cost[i], -gain[i]) for i in chosen if i < count)
            value -= sum(price for price, yes in zip(prices, is_open) if yes)
            of_graph = sum(all_weights[v] for v in chosen) - sum(all_weights[count:])
            require(value == of_graph, f"the choice is worth {value}, not {of_graph}")
            line += f", {sum(is_open)} open, value {value}"
    except (ValueError, KeyError, OSError, tarfile.TarError) as error:
        print(f"{path}: {error}")
        return 1
    print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
