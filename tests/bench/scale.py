#!/usr/bin/python3
"""scale.py [--most N] [--only lattice|boxes] - time and memory of findhex and buildgraph against the number of tets: 10^5, 10^6, up to N (10^7).

Lattices of five tets a cube, and boxes of Delaunay tets of points moved by 30 % set one beside the other. Printed are processor
seconds and peak memory of both stages for each size, by tet, candidate and stored edge, and how far time and memory a tet
are from those of the smallest size. The graph goes through a pipe and is counted at its end. Ends with 1 when a stage takes
24 GiB or more, or a tet takes more than 1.5 times the time or 1.25 times the memory that it takes in the smallest mesh.
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


def lattice(tets):
    return meshes.five(round((tets / 5) ** (1 / 3)))


def boxes(tets):
    tile = meshes.jittered(TILE, 0.3)
    return meshes.tiled(tile, TILE, max(1, round(tets / len(tile[1]))))


def measure(mesh):
    meshes.write_bundle("mesh.tar", mesh)
    find = meshes.run([meshes.tool("findhex"), "-q", "mesh.tar", "-o", "candidates.tar"])
    os.remove("mesh.tar")
    with tarfile.open("candidates.tar") as tar:
        candidates = tar.getmember("candidates/kind.npy").size - 128
    command = f"{meshes.tool('buildgraph')} -q candidates.tar --stats build.json | wc -c >streamed"
    build = meshes.run(["bash", "-o", "pipefail", "-c", command])
    with open("build.json") as stats, open("streamed") as count:
        edges, streamed = 2 * json.load(stats)["edges"], int(count.read())
    os.remove("candidates.tar")
    return find, build, candidates, edges, streamed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--most", type=float, default=1e7)
    parser.add_argument("--only", choices=("lattice", "boxes"))
    options = parser.parse_args()
    missed = False
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, make in (("lattice", lattice), ("boxes", boxes)):
            if options.only not in (None, name):
                continue
            base = None
            for step in (s for s in STEPS if s <= options.most):
                mesh = make(step)
                tets = len(mesh[1])
                find, build, candidates, edges, streamed = measure(mesh)
                del mesh
                a_tet = [find[0] / tets, build[0] / tets, find[1] / tets, build[1] / tets]
                base = base or a_tet
                ratios = [now / then for now, then in zip(a_tet, base)]
                missed |= max(ratios[:2]) > 1.5 or max(ratios[2:]) > 1.25 or max(find[1], build[1]) >= MOST_MEMORY
                print(f"{name}: {tets} tets, {candidates} candidates, {edges} stored edges; findhex {find[0]:.2f} s, "
                      f"{find[1] / 2**20:.0f} MiB ({find[1] / tets:.0f} B a tet); buildgraph {build[0]:.2f} s, "
                      f"{build[1] / 2**20:.0f} MiB ({build[1] / max(candidates, 1):.0f} B a candidate, "
                      f"{build[1] / max(edges, 1):.1f} B a stored edge); {streamed / 2**20:.0f} MiB through the pipe; "
                      f"a tet against the smallest: time {ratios[0]:.2f} and {ratios[1]:.2f}, memory {ratios[2]:.2f} and "
                      f"{ratios[3]:.2f}", flush=True)
    sys.exit(1 if missed else 0)


main()
