#!/usr/bin/python3
"""scale.py [--most N] [--only lattice|boxes] [--stream N] - time and memory of findhex and buildgraph against the number of
tets: 10^5, 10^6, up to N (10^7).

Lattices of five tets a cube, and boxes of Delaunay tets of points moved by 30 % set one beside the other. Printed are
processor seconds and peak memory of both stages for each size, by tet, candidate and stored edge, and how far time and
memory a tet are from those of the smallest size. The graph goes through a pipe and is counted at its end. The system's time
stands apart: it goes into pages of memory, which cost several times as much on a machine whose host has not handed them out
before. Ends with 1 when a stage takes 24 GiB or more or more than formats/README.md says, or a tet takes more than 1.5 times
the user time or 1.25 times the memory that it takes in the smallest mesh. --stream sends the graph of a lattice of N tets to
initsol, which makes a greedy choice, and prints time and memory of both sides: 4.2e6 tets have a billion stored edges.
"""
import argparse
import json
import os
import sys
import tarfile
import tempfile

import bench_meshes as meshes

MOST_MEMORY = 24 * 2**30
STEPS = (10**5, 10**6, 10**7)
TILE = 25
# The figures of formats/README.md, in bytes, beyond those of a program that does nothing.
PROGRAM = 16 * 2**20
FINDHEX_A_TET = 340
BUILDGRAPH_OVER_GRAPH, BUILDGRAPH_A_CANDIDATE = 1.15, 600


def graph_bytes(candidates, edges):
    return 16 * candidates + 4 * edges


def as_documented(tets, candidates, edges, find_peak, build_peak):
    build_limit = max(BUILDGRAPH_OVER_GRAPH * graph_bytes(candidates, edges), BUILDGRAPH_A_CANDIDATE * candidates)
    return find_peak <= PROGRAM + FINDHEX_A_TET * tets and build_peak <= PROGRAM + build_limit


def lattice(tets):
    return meshes.five(round((tets / 5) ** (1 / 3)))


def boxes(tets):
    tile = meshes.jittered(TILE, 0.3)
    return meshes.tiled(tile, TILE, max(1, round(tets / len(tile[1]))))


def find_candidates(mesh):
    meshes.write_bundle("mesh.tar", mesh)
    find = meshes.run_apart([meshes.tool("findhex"), "-q", "mesh.tar", "-o", "candidates.tar"])
    os.remove("mesh.tar")
    return find


def measure(mesh):
    find = find_candidates(mesh)
    with tarfile.open("candidates.tar") as tar:
        candidates = tar.getmember("candidates/kind.npy").size - 128
    command = f"{meshes.tool('buildgraph')} -q candidates.tar --stats build.json | wc -c >streamed"
    build = meshes.run_apart(["bash", "-o", "pipefail", "-c", command])
    with open("build.json") as stats, open("streamed") as count:
        edges, streamed = 2 * json.load(stats)["edges"], int(count.read())
    os.remove("candidates.tar")
    return find, build, candidates, edges, streamed


def measure_stream(tets):
    mesh = lattice(tets)
    tets = len(mesh[1])
    find_candidates(mesh)
    del mesh
    build, choose = meshes.run_pipe([meshes.tool("buildgraph"), "-q", "candidates.tar", "--stats", "build.json"],
                                    [meshes.tool("initsol"), "-q", "--iterations", 0, "-o", "solution.sol"])
    with open("build.json") as stats:
        edges = 2 * json.load(stats)["edges"]
    os.remove("candidates.tar")
    print(f"stream of {tets} tets' graph, {edges} stored edges: buildgraph {build[0]:.2f} s, {build[1] / 2**20:.0f} MiB; "
          f"initsol {choose[0]:.2f} s, {choose[1] / 2**20:.0f} MiB", flush=True)
    return build[1] + choose[1] >= MOST_MEMORY


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--most", type=float, default=1e7)
    parser.add_argument("--only", choices=("lattice", "boxes"))
    parser.add_argument("--stream", type=float)
    options = parser.parse_args()
    missed = False
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if options.stream:
            sys.exit(1 if measure_stream(options.stream) else 0)
        for name, make in (("lattice", lattice), ("boxes", boxes)):
            if options.only not in (None, name):
                continue
            base = None
            for step in (s for s in STEPS if s <= options.most):
                mesh = make(step)
                tets = len(mesh[1])
                find, build, candidates, edges, streamed = measure(mesh)
                del mesh
                a_tet = [find.user / tets, build.user / tets, find.peak / tets, build.peak / tets]
                base = base or a_tet
                ratios = [now / then for now, then in zip(a_tet, base)]
                missed |= not as_documented(tets, candidates, edges, find.peak, build.peak)
                missed |= max(ratios[:2]) > 1.5 or max(ratios[2:]) > 1.25 or max(find.peak, build.peak) >= MOST_MEMORY
                print(f"{name}: {tets} tets, {candidates} candidates, {edges} stored edges ({edges / tets:.0f} a tet); "
                      f"findhex {find.user:.2f} + {find.system:.2f} s, {find.peak / 2**20:.0f} MiB "
                      f"({find.peak / tets:.0f} B a tet); buildgraph {build.user:.2f} + {build.system:.2f} s, "
                      f"{build.peak / 2**20:.0f} MiB ({build.peak / max(candidates, 1):.0f} B a candidate, "
                      f"{build.peak / max(edges, 1):.1f} B a stored edge, "
                      f"{build.peak / graph_bytes(candidates, edges):.2f} times the graph); {streamed / 2**20:.0f} MiB through the pipe; "
                      f"a tet against the smallest: user time {ratios[0]:.2f} and {ratios[1]:.2f}, memory {ratios[2]:.2f} and "
                      f"{ratios[3]:.2f}", flush=True)
    sys.exit(1 if missed else 0)


main()
