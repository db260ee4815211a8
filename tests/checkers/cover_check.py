#!/usr/bin/python3
"""cover_check.py BUNDLE... - is this an edge clique cover of the bundle's graph?

Reads with tarfile and numpy alone. Every clique ascends and any two of its members are an edge; every edge is in a clique
and every vertex too. Prints `FILE: N cliques of M vertices, E edges`, or what is wrong; exits 1 when anything is.
"""
import io
import pathlib
import sys
import tarfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from graph_check import check, read_bundle, require  # noqa: E402


def read_cover(path):
    found = {}
    with tarfile.open(path) as archive:
        for member in archive:
            if member.name.startswith("graph/clique_"):
                found[member.name] = np.load(io.BytesIO(archive.extractfile(member).read()))
    require(set(found) == {"graph/clique_offsets.npy", "graph/clique_members.npy"}, "expected a cover, found none")
    offsets, members = found["graph/clique_offsets.npy"], found["graph/clique_members.npy"]
    require(offsets.dtype.str == "<i8" and members.dtype.str == "<i4", "a cover has i8 offsets and i4 members")
    require(offsets[0] == 0 and offsets[-1] == len(members) and (np.diff(offsets) > 0).all(), "offsets do not fit")
    return [members[a:b].tolist() for a, b in zip(offsets[:-1], offsets[1:])]


def main(paths):
    for path in paths:
        try:
            weights, lists = read_bundle(path)
            edges = check(weights, lists)
            neighbours = [set(row.tolist()) for row in lists]
            left, alone = [set(row) for row in neighbours], set(range(len(weights)))
            cliques = read_cover(path)
            for clique in cliques:
                require(all(a < b for a, b in zip(clique, clique[1:])), f"{clique} does not ascend")
                require(0 <= clique[0] and clique[-1] < len(weights), f"{clique} leaves the graph")
                for v in clique:
                    others = set(clique) - {v}
                    require(others <= neighbours[v], f"{clique} is no clique: {v} is not beside all others")
                    left[v] -= others
                alone -= set(clique)
            missed = sum(map(len, left)) // 2
            require(missed == 0, f"{missed} of {edges} edges are in no clique")
            require(not alone, f"{len(alone)} vertices are in no clique")
        except (ValueError, IndexError, OSError, tarfile.TarError) as error:
            print(f"{path}: {error}")
            return 1
        print(f"{path}: {len(cliques)} cliques of {sum(map(len, cliques))} vertices, {edges} edges")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
