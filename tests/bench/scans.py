#!/usr/bin/python3
"""scans.py [--model FILE] [--pieces N...] [--hexes N] [--lns] - what large scans cost, through the whole pipe.

Cuts each triangle of a closed model (spot) into N² (4, 8 and 16: 94,000, 375,000 and 1.5 million triangles), moves each vertex by a little
noise, as a scanner does, and makes a mesh of about 20,000 hexes of it by

    tetmesh | findhex | buildgraph | initsol | assemble

with every option at its default but the size. Prints the processor seconds of each tool and the ratio of linearity: seconds a triangle
against those of the smallest scan, the time of the model's own triangles taken off both. Ends with 1 if the largest scan takes more than
40 s. --lns puts lns before assemble; it goes on as long as it gains enough, however many triangles there were. The tools are taken from
build/bin, or from HEXPIPE_BIN.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

from surface import BIN, ROOT, write_stl

TOOLS = ("tetmesh", "findhex", "buildgraph", "initsol", "lns", "assemble")
GOAL = 40.0
# Of cubes as long as the size, this many fill the volume for each hex that comes: rows stretch, and other cells have a twentieth.
CUBES_PER_HEX = 1.2
NOISE = 2e-5  # of the diagonal: an eighth of an edge of the largest scan


def read_obj(name):
    points, triangles = [], []
    for line in open(name):
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            triangles += [[corners[0], corners[i], corners[i + 1]] for i in range(1, len(corners) - 1)]
    return np.array(points), np.array(triangles)


def cut(points, triangles, parts):
    """Each triangle in parts² triangles; vertices on shared edges are shared."""
    rows = [(i, j) for i in range(parts + 1) for j in range(parts + 1 - i)]
    number = {place: k for k, place in enumerate(rows)}
    small = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in rows if i + j < parts]
    small += [(number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i, j in rows if i + j < parts - 1]
    i, j = np.array(rows).T
    shares = np.stack([parts - i - j, i, j], axis=1)
    # A point is told by the corners of its triangle that have a share in it, and these shares.
    key = np.sort(np.where(shares > 0, triangles[:, None, :] * (parts + 1) + shares, -1), axis=2).reshape(-1, 3)
    _, first, same = np.unique(key, axis=0, return_index=True, return_inverse=True)
    where = np.einsum("rc,tcx->trx", shares / parts, points[triangles]).reshape(-1, 3)[first]
    return where, same.reshape(len(triangles), len(rows))[:, np.array(small)].reshape(-1, 3)


def volume_of(points, triangles):
    a, b, c = points[triangles].transpose(1, 0, 2)
    return abs(np.einsum("ij,ij->i", a, np.cross(b, c)).sum()) / 6


def measure(tools, scan, size, folder):
    """Processor seconds of each tool, and the statistics of the last."""
    stats = os.path.join(folder, "stats.json")
    arguments = {tool: ["-q"] for tool in tools}
    arguments["tetmesh"] += [scan, "--size", repr(size)]
    arguments["assemble"] += ["-o", os.path.join(folder, "mesh.vtu"), "--stats", stats]
    stages, before = [], subprocess.DEVNULL
    for tool in tools:
        stages.append(subprocess.Popen([os.path.join(BIN, tool), *arguments[tool]], stdin=before, stdout=subprocess.PIPE,
                                       stderr=subprocess.DEVNULL if tool != "assemble" else None))
        if before is not subprocess.DEVNULL:
            before.close()
        before = stages[-1].stdout
    seconds = {}
    for tool, stage in zip(tools, stages):
        _, status, usage = os.wait4(stage.pid, 0)
        if status != 0:
            sys.exit(f"{tool} ended with status {status}")
        seconds[tool] = usage.ru_utime + usage.ru_stime
    with open(stats) as file:
        return seconds, json.load(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", default=os.path.join(ROOT, "..", "shared", "models", "spot.obj"), help="a closed OBJ")
    parser.add_argument("--pieces", type=int, nargs="+", default=[4, 8, 16])
    parser.add_argument("--hexes", type=float, default=20000)
    parser.add_argument("--lns", action="store_true", help="with lns, too")
    args = parser.parse_args()
    tools = [tool for tool in TOOLS if tool != "lns" or args.lns]
    points, triangles = read_obj(args.model)
    size = (volume_of(points, triangles) / args.hexes / CUBES_PER_HEX) ** (1 / 3)
    diagonal = np.linalg.norm(points.max(axis=0) - points.min(axis=0))
    random = np.random.default_rng(1)
    rows = []
    print(f"| triangles | {' | '.join(tools)} | all | linearity | hexes | hex volume % |\n|" + "---|" * (len(tools) + 5), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for parts in [1, *args.pieces]:
            where, pieces = cut(points, triangles, parts)
            if parts > 1:
                where = where + random.normal(scale=NOISE * diagonal, size=where.shape)
            scan = os.path.join(folder, "scan.stl")
            write_stl(scan, where.astype("<f4")[pieces].reshape(-1, 9))
            seconds, stats = measure(tools, scan, size, folder)
            rows.append((len(pieces), sum(seconds.values())))
            first = (rows[1][1] - rows[0][1]) / rows[1][0] if parts > 1 else 0
            ratio = f"{(rows[-1][1] - rows[0][1]) / rows[-1][0] / first:.2f}" if first > 0 else "–"
            each = " | ".join(f"{seconds[tool]:.1f}" for tool in tools)
            print(f"| {len(pieces)} | {each} | {rows[-1][1]:.1f} | {ratio} | {stats['cells']['hex']['count']} | {100 * stats['cells']['hex']['share_of_volume']:.1f} |", flush=True)
    sys.exit(1 if rows[-1][1] > GOAL else 0)


if __name__ == "__main__":
    main()
