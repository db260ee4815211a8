#!/usr/bin/python3
"""findhex.py [--peer PROGRAM] [--size N] [--repeat N] - candidates a second and core, against the published method's program.

Meshes of about 6 N^3 tets: a lattice, and Delaunay tets of its points moved by 2 % and by 30 % of its spacing. The same
rules on both sides: folded quads and flat corners kept, at most five boundary tets, least quality 0.3. Printed are the
processor seconds of the best of several runs with one thread and with two, without reading and writing; the ratio; how much
faster two threads are; and how the sets compare.

PROGRAM MESH QUALITY THREADS FILE is the search of HXT Combine (Gmsh's repository, contrib/hxt/Combine) on a .mesh: it prints
JSON with tables_cpu, search_cpu, tables_wall, search_wall (seconds), and writes a line for each hex: its eight vertices, its
numbers of interior and boundary tets, then these, all counted from 1. Without it the comparison is skipped.

The peer's flood begins at a tet that joins four of the corners. A hex that only findhex finds is explained when such a
tet is not inside, where the flood may begin and fail, or when there is none: all tets inside meet at a vertex inside
(docs/definitions.md, rule 5 and what follows rule 9). Ends with 1 when the peer finds a hex that findhex does not, or
the tets differ, or a difference is not explained.
"""
import argparse
import io
import json
import os
import subprocess
import sys
import tarfile
import tempfile

import numpy as np

import bench_meshes as meshes

RULES = ["--folded-quads", "keep", "--flat-corners", "keep", "--max-boundary-tets", "5", "--quality", "corner"]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]


def ours(mesh, threads, repeat):
    """Statistics of a run, with the least processor seconds and the least seconds by the clock of several."""
    best = None
    for _ in range(repeat):
        meshes.run([meshes.tool("findhex"), "-q", mesh, *RULES, "--threads", threads, "--stats", "stats.json", "-o",
                    "ours.tar"])
        with open("stats.json") as file:
            stats = json.load(file)
        for clock in ("cpu_seconds", "wall_seconds"):
            if best is not None:
                stats[clock]["find"] = min(stats[clock]["find"], best[clock]["find"])
        best = stats
    return best


def peers(program, mesh, threads, repeat):
    best = None
    for _ in range(repeat):
        text = subprocess.run([program, mesh, "0.3", str(threads), "theirs.txt"], check=True, capture_output=True,
                              text=True).stdout
        found = json.loads(text.splitlines()[-1])
        found["cpu"] = found["tables_cpu"] + found["search_cpu"]
        if best is None or found["cpu"] < best["cpu"]:
            best = found
    return best


class Hexes:
    """Hexes as arrays: `edges` (n, 12), which tell one from another; `tets`, a hash of the interior and of the boundary
    ones of each; `interior_of(i)`."""

    def __init__(self, vertices, tets, begins, middles, ends):
        pairs = np.sort(vertices[:, EDGES].astype(np.int64), axis=2)
        rows = np.sort(pairs[:, :, 0] << 32 | pairs[:, :, 1], axis=1)
        self.edges = np.ascontiguousarray(rows).view(np.dtype((np.void, 8 * len(EDGES)))).ravel()
        self.vertices, self._tets, self._begins, self._middles = vertices, tets, begins, middles
        # In any order, as a sum of well mixed numbers.
        mixed = (tets.astype(np.uint64) + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
        mixed = (mixed ^ mixed >> np.uint64(31)) * np.uint64(0xBF58476D1CE4E5B9)
        sums = np.concatenate([np.zeros(1, np.uint64), np.cumsum(mixed ^ mixed >> np.uint64(29), dtype=np.uint64)])
        self.tets = np.stack([sums[middles] - sums[begins], sums[ends] - sums[middles]], axis=1)

    def interior_of(self, i):
        return self._tets[self._begins[i]:self._middles[i]]


def our_hexes(bundle):
    with tarfile.open(bundle) as tar:
        def member(name):
            return np.load(io.BytesIO(tar.extractfile(f"candidates/{name}.npy").read()))
        interior, boundary = member("tets"), member("boundary_tets")
        interior_ends, boundary_ends = member("tet_offsets"), member("boundary_tet_offsets")
        vertices = member("vertices")
    # One list for each hex: its interior tets, then the others.
    begins = interior_ends[:-1] + boundary_ends[:-1]
    middles = interior_ends[1:] + boundary_ends[:-1]
    tets = np.empty(len(interior) + len(boundary), interior.dtype)
    counts = np.diff(interior_ends), np.diff(boundary_ends)
    tets[np.arange(len(interior)) + np.repeat(boundary_ends[:-1], counts[0])] = interior
    tets[np.arange(len(boundary)) + np.repeat(interior_ends[1:], counts[1])] = boundary
    return Hexes(vertices, tets, begins, middles, middles + counts[1])


def their_hexes(path):
    with open(path) as file:
        numbers = np.fromfile(file, np.int32, sep=" ")
    starts, at = [], 0
    while at < len(numbers):
        starts.append(at)
        at += 10 + int(numbers[at + 8]) + int(numbers[at + 9])
    starts = np.array(starts, np.int64)
    vertices = numbers[starts[:, None] + np.arange(8)] - 1
    middles = starts + 10 + numbers[starts + 8]
    return Hexes(vertices, numbers - 1, starts + 10, middles, middles + numbers[starts + 9])


def compare(tets):
    mine, theirs = our_hexes("ours.tar"), their_hexes("theirs.txt")
    for hexes, whose in ((mine, "findhex"), (theirs, "the peer")):
        if len(np.unique(hexes.edges)) != len(hexes.edges):
            print(f"    {whose} has a hex twice")
            return 1
    _, here, there = np.intersect1d(mine.edges, theirs.edges, assume_unique=True, return_indices=True)
    lost = len(theirs.edges) - len(there)
    other_tets = int((mine.tets[here] != theirs.tets[there]).any(axis=1).sum())
    at_vertex = {}
    for t, tet in enumerate(tets):
        for v in tet:
            at_vertex.setdefault(int(v), []).append(t)
    outside = without = unexplained = 0
    for i in np.setdiff1d(np.arange(len(mine.edges)), here):
        corners = set(map(int, mine.vertices[i]))
        starts = {t for v in corners for t in at_vertex[v] if corners.issuperset(map(int, tets[t]))}
        if not starts:
            without += 1
        elif starts - set(map(int, mine.interior_of(i))):
            outside += 1
        else:
            unexplained += 1
    print(f"    sets: {len(mine.edges)} and {len(theirs.edges)}; {outside + without + unexplained} only here, of which the peer "
          f"may start outside {outside}, has no start {without}, {unexplained} unexplained; {lost} only there; {other_tets} "
          "with other tets", flush=True)
    return lost + other_tets + unexplained


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peer")
    parser.add_argument("--size", type=int, default=24)
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    program = options.peer and os.path.abspath(options.peer)
    if not program or not os.path.exists(program):
        print(f"comparison skipped: {'no --peer' if not program else program + ' is not there'}")
        program = None
    faults = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, make in (("lattice", lambda: meshes.kuhn(options.size)),
                           ("moved by 2 %", lambda: meshes.jittered(options.size, 0.02)),
                           ("moved by 30 %", lambda: meshes.jittered(options.size, 0.3))):
            mesh = make()
            meshes.write_medit("mesh.mesh", mesh)
            one, two = ours("mesh.mesh", 1, options.repeat), ours("mesh.mesh", 2, options.repeat)
            seconds = one["cpu_seconds"]["find"]
            wall = [s["wall_seconds"]["find"] for s in (one, two)]
            line = (f"{name}: {len(mesh[1])} tets, {one['candidates']} hexes; {seconds:.3f} s, "
                    f"{one['candidates'] / seconds / 1e6:.2f} million hexes/s, {seconds / len(mesh[1]) * 1e6:.2f} us a tet; "
                    f"two threads {wall[0] / wall[1]:.2f} times as fast")
            if program:
                peer = peers(program, "mesh.mesh", 1, options.repeat)
                line += f"; peer {peer['cpu']:.3f} s, {peer['cpu'] / seconds:.2f} times as long"
            print(line, flush=True)
            faults += compare(mesh[1]) if program else 0
    sys.exit(1 if faults else 0)


main()
