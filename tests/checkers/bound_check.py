#!/usr/bin/python3
"""bound_check.py GRAPH CERTIFICATE - does this certificate prove its bound on every independent set of the graph?

The certificate is `bound B` and a line `price v1 v2 ...` for each clique, vertices counted from 1. Checks in integers that
every line is a clique with a price that is not negative, and that the prices and what vertices weigh beyond the prices of
their cliques add up to B. Prints `bound B by N cliques`, or what is wrong; exits 1 when anything is.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from graph_check import check, read_graph, require  # noqa: E402


def main(graph_path, certificate_path):
    try:
        weights, lists = read_graph(graph_path)
        check(weights, lists)
        neighbours = [set(row.tolist()) for row in lists]
        with open(certificate_path) as file:
            word, claimed = file.readline().split()
            require(word == "bound", "expected a line 'bound B' first")
            left, total, cliques = list(weights), 0, 0
            for line in file:
                price, *members = (int(number) for number in line.split())
                members = [v - 1 for v in members]
                require(price >= 0, f"a price below 0: {line.strip()}")
                require(all(0 <= v < len(weights) for v in members), f"no such vertex: {line.strip()}")
                for i, v in enumerate(members):
                    require(all(u in neighbours[v] for u in members[:i]), f"no clique: {line.strip()}")
                    left[v] -= price
                total += price
                cliques += 1
        bound = total + sum(max(0, rest) for rest in left)
        require(bound == int(claimed), f"the prices prove {bound}, not {claimed}")
    except (ValueError, IndexError, OSError) as error:
        print(f"{certificate_path}: {error}")
        return 1
    print(f"bound {bound} by {cliques} cliques")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
