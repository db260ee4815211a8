#!/usr/bin/python3
"""graph_check.py FILE... - is this a conflict graph as METIS files and bundles should have it?

Reads METIS .graph files with vertex weights, and the graph of bundles, with the standard library and numpy alone. Checks
ranges, ascending neighbours, no loops, no repeats, both directions of every edge, counts. Prints `FILE: N vertices, M
edges, weight W` a file, or what is wrong; exits 1 when anything is.
"""
import io
import sys
import tarfile

import numpy as np


def require(condition, message):
    if not condition:
        raise ValueError(message)


def read_metis(path):
    with open(path) as file:
        lines = [line.rstrip("\n") for line in file if not line.startswith("%")]
    header = lines[0].split()
    require(len(header) == 3 and header[2] == "10", f"expected a header 'n m 10', found {lines[0]!r}")
    count, edges = int(header[0]), int(header[1])
    require(len(lines) == count + 1, f"expected {count} vertex lines, found {len(lines) - 1}")
    rows = [list(map(int, line.split())) for line in lines[1:]]
    require(all(rows), "a vertex without a weight")
    weights = [row[0] for row in rows]
    heads = np.array([head for row in rows for head in row[1:]], dtype=np.int64) - 1
    ends = np.cumsum([0] + [len(row) - 1 for row in rows])
    lists = [heads[a:b] for a, b in zip(ends[:-1], ends[1:])]
    require(sum(map(len, lists)) == 2 * edges, f"expected {2 * edges} neighbours by the header")
    return weights, lists


def read_bundle(path):
    members = {}
    with tarfile.open(path) as archive:
        for member in archive:
            if member.name.startswith("graph/"):
                members[member.name[6:-4]] = np.load(io.BytesIO(archive.extractfile(member).read()))
    require({"offsets", "neighbours", "weights"} <= members.keys(), "expected a graph in the bundle, found none")
    offsets = members["offsets"]
    require(len(offsets) == len(members["weights"]) + 1 and offsets[0] == 0, "offsets do not fit the weights")
    require((np.diff(offsets) >= 0).all() and offsets[-1] == len(members["neighbours"]), "offsets do not fit")
    lists = [members["neighbours"][a:b].astype(np.int64) for a, b in zip(offsets[:-1], offsets[1:])]
    return [int(w) for w in members["weights"]], lists


def read_graph(path):
    """Weights and neighbour lists, counted from 0."""
    return read_bundle(path) if tarfile.is_tarfile(path) else read_metis(path)


def edge_ends(lists):
    """Tails and heads of all edges, in both directions."""
    tails = np.repeat(np.arange(len(lists)), [len(n) for n in lists])
    return tails, np.concatenate(lists) if lists else np.zeros(0, np.int64)


def check(weights, lists):
    count = len(weights)
    require(all(w >= 0 for w in weights) and sum(weights) < 2**63, "weights negative or too large in sum")
    tails, heads = edge_ends(lists)

    def require_none(wrong, message):
        if wrong.any():
            raise ValueError(f"vertex {tails[np.argmax(wrong)]} {message}")

    require_none((heads < 0) | (heads >= count), "has neighbours out of range")
    require_none(heads == tails, "is beside itself")
    require_none((np.diff(tails) == 0) & (np.diff(heads) <= 0), "has neighbours that do not ascend")
    there = np.sort(tails * count + heads)
    back = np.sort(heads * count + tails)
    require((there == back).all(), "an edge stands at one of its ends only")
    return len(heads) // 2


def main(paths):
    for path in paths:
        try:
            weights, lists = read_graph(path)
            edges = check(weights, lists)
        except (ValueError, IndexError, OSError, tarfile.TarError) as error:
            print(f"{path}: {error}")
            return 1
        print(f"{path}: {len(weights)} vertices, {edges} edges, weight {sum(weights)}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
