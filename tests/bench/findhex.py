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
import json
import os
import subprocess
import sys
import tempfile

import bench_meshes as meshes

RULES = ["--folded-quads", "keep", "--flat-corners", "keep", "--max-boundary-tets", "5", "--quality", "corner"]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]


def ours(mesh, threads, repeat):
    """Statistics of a run, with the least processor seconds and the least seconds by the clock of several."""
    best = None
    for _ in range(repeat):
        meshes.run([meshes.tool("findhex"), "-q", mesh, *RULES, "--threads", threads, "--stats", "stats.json", "-o",
                    "ours.cand"])
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


def cells(lines, tets_at):
    """{edges of a hex: its tets}, of lines of numbers; `tets_at` tells the numbers of tets, and then where these are."""
    result = {}
    for line in lines:
        vertices, interior, boundary = tets_at(line)
        result[frozenset(frozenset((vertices[a], vertices[b])) for a, b in EDGES)] = (interior, boundary)
    return result


def our_line(line):
    words = line.split()
    n = [int(x) for x in words[3:]]
    return n[2:10], tuple(n[10:10 + n[0]]), tuple(n[10 + n[0]:])


def their_line(line):
    n = [int(x) for x in line.split()]
    return n[:8], tuple(n[10:10 + n[8]]), tuple(n[10 + n[8]:])


def compare(tets):
    with open("ours.cand") as file:
        mine = cells(file.readlines()[1:], our_line)
    with open("theirs.txt") as file:
        theirs = cells(file, their_line)
    lost = len(theirs.keys() - mine.keys())
    other_tets = sum(mine[key] != theirs[key] for key in theirs.keys() & mine.keys())
    at_vertex = {}
    for t, tet in enumerate(tets):
        for v in tet:
            at_vertex.setdefault(int(v) + 1, []).append(t)
    outside = without = unexplained = 0
    for key in mine.keys() - theirs.keys():
        corners = frozenset().union(*key)
        starts = {t for v in corners for t in at_vertex[v] if corners.issuperset(int(x) + 1 for x in tets[t])}
        if not starts:
            without += 1
        elif starts - {t - 1 for t in mine[key][0]}:
            outside += 1
        else:
            unexplained += 1
    print(f"    sets: {len(mine)} and {len(theirs)}; {outside + without + unexplained} only here, of which the peer may start "
          f"outside {outside}, has no start {without}, {unexplained} unexplained; {lost} only there; {other_tets} with "
          "other tets")
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
