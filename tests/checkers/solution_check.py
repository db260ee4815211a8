#!/usr/bin/python3
"""solution_check.py GRAPH SOLUTION | solution_check.py BUNDLE - is this a maximal independent set, and what does it weigh?

GRAPH is a METIS .graph or a bundle, SOLUTION lists vertices from 1, one a line; a bundle alone holds both. Prints
`N chosen, weight W`, or what is wrong; exits 1 when the set is not independent, not maximal, or names a vertex that is
not there. With --optimum it also computes the best weight by trying everything (up to some 30 vertices) and adds
`, optimum W`.
"""
import io
import pathlib
import sys
import tarfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from graph_check import check, edge_ends, read_graph, require  # noqa: E402


def read_solution(path):
    if tarfile.is_tarfile(path):
        with tarfile.open(path) as archive:
            return np.load(io.BytesIO(archive.extractfile("solution/chosen.npy").read())).tolist()
    with open(path) as file:
        return [int(line) - 1 for line in file]


def best_weight(weights, masks, free):
    if free == 0:
        return 0
    v = free.bit_length() - 1
    free &= ~(1 << v)
    without = best_weight(weights, masks, free)
    return max(without, weights[v] + best_weight(weights, masks, free & ~masks[v]))


def main(arguments):
    optimum = "--optimum" in arguments
    paths = [argument for argument in arguments if argument != "--optimum"]
    try:
        weights, lists = read_graph(paths[0])
        check(weights, lists)
        chosen = read_solution(paths[-1])
        require(all(0 <= v < len(weights) for v in chosen), "a vertex that the graph does not have")
        require(all(a < b for a, b in zip(chosen, chosen[1:])), "vertices do not ascend")
        inside = np.zeros(len(weights), bool)
        inside[chosen] = True
        tails, heads = edge_ends(lists)
        touched = np.zeros(len(weights), bool)
        touched[tails[inside[heads]]] = True
        for v in np.flatnonzero(inside == touched):
            require(not inside[v], f"vertex {v} and a neighbour are both chosen")
            require(inside[v], f"vertex {v} could be chosen too")
    except (ValueError, IndexError, KeyError, OSError, tarfile.TarError) as error:
        print(f"{paths[-1]}: {error}")
        return 1
    line = f"{len(chosen)} chosen, weight {sum(weights[v] for v in chosen)}"
    if optimum:
        masks = [sum(1 << int(u) for u in neighbours) for neighbours in lists]
        line += f", optimum {best_weight(weights, masks, (1 << len(weights)) - 1)}"
    print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
