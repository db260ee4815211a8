#!/usr/bin/python3
"""solve_with_cbc.py GRAPH SOLUTION - a maximum weight independent set of a METIS graph by coinor-cbc.

A program with one row for each clique of a greedy edge clique cover; the solution has 1-based vertex numbers, one a line.
Exits 1 unless cbc proves the optimum.
"""
import os
import re
import subprocess
import sys
import tempfile


def read_graph(path):
    lines = [line for line in open(path) if not line.startswith("%")]
    count, _, form = lines[0].split()[:3]
    assert form == "10", "a graph with vertex weights"
    weights, neighbours = [], []
    for line in lines[1:int(count) + 1]:
        first, *rest = map(int, line.split())
        weights.append(first)
        neighbours.append({v - 1 for v in rest})
    return weights, neighbours


def clique_cover(neighbours):
    covered = [set() for _ in neighbours]
    for v, around in enumerate(neighbours):
        for w in sorted(around):
            if w < v or w in covered[v]:
                continue
            clique, common = [v, w], neighbours[v] & neighbours[w]
            while common:
                # The one that covers most edges that no clique covers yet.
                u = max(sorted(common), key=lambda x: sum(y not in covered[x] for y in clique))
                clique.append(u)
                common &= neighbours[u]
            for x in clique:
                covered[x].update(y for y in clique if y != x)
            yield clique


def write_program(path, weights, cliques):
    with open(path, "w") as out:
        out.write("Maximize\n obj:")
        for v, weight in enumerate(weights):
            out.write(f" + {weight} x{v}" + ("\n" if v % 8 == 7 else ""))
        out.write("\nSubject To\n")
        for row, clique in enumerate(cliques):
            out.write(f" c{row}:" + "".join(f" + x{v}" + ("\n" if i % 8 == 7 else "") for i, v in enumerate(clique)) + " <= 1\n")
        out.write("Binary\n" + "\n".join(f" x{v}" for v in range(len(weights))) + "\nEnd\n")


def main():
    weights, neighbours = read_graph(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        program, result = os.path.join(folder, "p.lp"), os.path.join(folder, "p.sol")
        write_program(program, weights, list(clique_cover(neighbours)))
        subprocess.run(["cbc", program, "ratio", "0", "allow", "0.5", "sec", "300", "solve", "solution", result],
                       check=True, stdout=subprocess.DEVNULL)
        lines = open(result).read().splitlines()
    if not lines[0].startswith("Optimal"):
        sys.exit(f"cbc: {lines[0]}")
    chosen = sorted(int(m.group(1)) for m in (re.match(r"\s*\d+\s+x(\d+)\s+(0\.9|1)", line) for line in lines[1:]) if m)
    with open(sys.argv[2], "w") as out:
        out.writelines(f"{v + 1}\n" for v in chosen)


main()
