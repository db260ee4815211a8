#!/usr/bin/python3
"""pieces.py [--parts K...] [--model FILE --size SIZE] - what it costs to assemble in parts.

The tets that tetmesh fills a model with are solved as a whole, by 30,000 iterations of initsol, and the solution is assembled as a
whole, and in K parts in rounds until all pieces are settled. Printed are tets a part, rounds, the share of the volume in hexes,
the least and the mean scaled Jacobian of hexes, the poor cells (hexes below 0.1, others below 0.02), processor seconds of a round
of all parts, the peak memory of the largest process of assemble and of merge-parts that writes the .pvtu. The first line is
the whole. Ends with 1 when tests/checkers/meshstats.py does not find the merged mesh conforming and valid.
"""
import argparse
import glob
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile

import bench_meshes as meshes

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def solve():
    meshes.run([meshes.tool("findhex"), "-q", "mesh.tar", "-o", "candidates.tar"])
    meshes.run([meshes.tool("buildgraph"), "-q", "candidates.tar", "-o", "graph.tar"])
    meshes.run([meshes.tool("initsol"), "-q", "graph.tar", "--iterations", "30000", "-o", "solved.tar"])


def split(count):
    meshes.run([meshes.tool("mesh-part"), "-q", "mesh.tar", "--parts", count, "-o", "parts"])
    for path in sorted(glob.glob("parts/*")):
        meshes.run([meshes.tool("findhex"), "-q", path, "-o", path.replace("parts/part", "candidates")])
    for path in sorted(glob.glob("candidates-*")):
        meshes.run([meshes.tool("buildgraph"), "-q", path, "--neighbours", *sorted(glob.glob("candidates-*")), "-o", path.replace("candidates", "graph")])
    subprocess.run(["/usr/bin/python3", f"{TESTS}/data/split_solution.py", "solved.tar", "solved", *sorted(glob.glob("graph-*"))], check=True)


def is_settled(path):
    with tarfile.open(path) as tar:
        return json.load(tar.extractfile("result/piece.json"))["settled"]


def assemble_round(number):
    """Processor seconds, the peak of the largest process, poor cells."""
    os.mkdir(f"round-{number}")
    before = ["--before", *sorted(glob.glob(f"round-{number - 1}/*"))] if number > 1 else []
    seconds, peak, poor = 0, 0, 0
    for path in sorted(glob.glob("solved/*")):
        run = meshes.run([meshes.tool("assemble"), "-q", path, "--neighbours", *sorted(glob.glob("solved/*")), *before, "--stats", "stats.json",
                          "-o", path.replace("solved", f"round-{number}")])
        seconds, peak = seconds + run[0], max(peak, run[1])
        with open("stats.json") as file:
            poor += len(json.load(file)["poor_cells"])
    return seconds, peak, poor


def check(path):
    checked = subprocess.run(["/usr/bin/python3", f"{TESTS}/checkers/meshstats.py", "--exact", path], check=True, capture_output=True, text=True).stdout
    values = dict(re.findall(r"(\S+?)=(\S+)", checked))
    good = values["is_conforming"] == "True" and values["inverted_cells"] == values["invalid_hexes"] == values["negative_volumes"] == "0"
    return values, good


def print_row(count, tets, rounds, values, poor, seconds, peak, merge):
    print(f"| {count} | {tets} | {rounds} | {values['hex_volume_percent']} | {values['hexes']} | {values['least_hex_jacobian']} / {values['mean_hex_jacobian']} | {poor} | {seconds:.1f} | {peak / 2**20:.0f} | {merge} |", flush=True)


def whole():
    seconds, peak = meshes.run([meshes.tool("assemble"), "-q", "solved.tar", "--stats", "stats.json", "-o", "whole.vtu"])
    with open("stats.json") as file:
        stats = json.load(file)
    values, good = check("whole.vtu")
    with open("tets.json") as file:
        tets = json.load(file)["tets"]
    print_row("whole", tets, 1, values, len(stats["poor_cells"]), seconds, peak, "")
    return tets, good


def in_parts(count, tets):
    split(count)
    rounds = 0
    while True:
        rounds += 1
        seconds, peak, poor = assemble_round(rounds)
        if all(is_settled(path) for path in glob.glob(f"round-{rounds}/*")):
            break
    pieces = sorted(glob.glob(f"round-{rounds}/*"))
    merge = meshes.run([meshes.tool("merge-parts"), *pieces, "-o", "mesh.pvtu"])
    meshes.run([meshes.tool("merge-parts"), *pieces, "-o", "merged.vtu"])
    values, good = check("merged.vtu")
    print_row(count, tets // count, rounds, values, poor, seconds, peak, f"{merge[1] / 2**20:.0f}")
    subprocess.run("rm -rf parts candidates-* graph-* solved round-* mesh mesh.pvtu", shell=True, check=True)
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", type=int, nargs="+", default=[2, 4, 8])
    parser.add_argument("--model", default=f"{TESTS}/data/bracket.stl")
    parser.add_argument("--size", default="3")
    options = parser.parse_args()
    options.model = os.path.abspath(options.model)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        meshes.run([meshes.tool("tetmesh"), "-q", options.model, "--size", options.size, "--stats", "tets.json", "-o", "mesh.tar"])
        solve()
        print("| parts | tets each | rounds | hex volume % | hexes | scaled Jacobian least / mean | poor cells | s a round | MiB | merge MiB |")
        print("|" + "---|" * 10)
        tets, good = whole()
        for count in options.parts:
            good = in_parts(count, tets) and good
        os.chdir("/")
    sys.exit(0 if good else 1)


main()
