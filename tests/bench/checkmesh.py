#!/usr/bin/python3
"""checkmesh.py [--size middle|fine] [--models NAME...] [--alone] - does OpenFOAM's checkMesh say "Mesh OK" to polyMeshes of
real models, as assemble writes them and with --polyhedra none, and to snappyHexMesh's in cells of the same size.

Goal: `checkMesh -allGeometry -allTopology` has nothing to say against any of the eleven, and hexes lose at most 0.1 points of
the volume. Columns: the checks that fail, with their cells and faces; faces over 70 degrees; hexes in percent of the number,
by checkMesh, and of the volume; seconds of assemble. For ours also cells that were halved, cut, merged, polyhedra, cells that were left out, with their
volume in percent, and vertices that were moved. Ends
with 1 unless all models reach the goal."""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile

import layers
import openfoam
from model_sizes import LEVELS, MODELS, ROUNDED
from openfoam import make_case, run

FAILURES = {"small determinant": "det", "Concave cells": "concave", "face tets": "tets", "interpolation weight": "weight",
            "volume ratio": "ratio", "non-orthogonality errors": "angle", "skew": "skew", "face pyramids": "pyramids"}


def checked(case):
    """Whether checkMesh says "Mesh OK", what fails, faces over 70 degrees, and the share of the number that are hexes."""
    text = run(["checkMesh", "-case", case, "-allGeometry", "-allTopology"])[0].stdout
    failed = []
    for line in text.splitlines():
        if line.startswith(" ***"):
            numbers = re.findall(r"\b\d+\b", re.sub(r"\([^)]*\)", "", line))
            failed.append(next((short for words, short in FAILURES.items() if words in line), line[4:24]) + (":" + numbers[-1] if numbers else ""))
    severe = re.search(r"severely non-orthogonal \(> 70 degrees\) faces: (\d+)", text)
    number = lambda word: int(re.search(rf"^ *{word}: +(\d+)", text, re.M)[1])
    return "Mesh OK" in text, ",".join(failed) or "ok", severe[1] if severe else "0", f"{100 * number('hexahedra') / number('cells'):.2f}"


def ours(folder, how):
    """The seconds of assemble, what it says, and checkMesh's findings."""
    case = f"{folder}/{how}"
    make_case(case)
    done, seconds = run([layers.tool("assemble"), "--threads", "1", f"{folder}/part.tar", "--polyhedra", how, "-o", f"{case}/constant/polyMesh"])
    if done.returncode != 0:
        sys.exit(done.stdout)
    return seconds, done.stdout, checked(case)


def snappy(folder, surface, size):
    case = f"{folder}/snappy"
    make_case(case)
    box = openfoam.put_surface(case, surface, size)
    subprocess.run([layers.tool("assemble"), "-q", f"{folder}/part.tar", "-o", f"{folder}/plain.vtu"], check=True)
    added = openfoam.snappy(case, box, size, layers.inner_point(folder, size), "none", 0, size / 10, 1.2)[0]
    return ["failed"] * 3 if added is None else checked(case)[1:]


def bench(model, args):
    size = ROUNDED[model][LEVELS[1:].index(args.size)]
    surface = os.path.join(MODELS, model)
    with tempfile.TemporaryDirectory() as folder:
        pipe = " | ".join([f"{layers.tool('tetmesh')} -q {surface} --size {size}", *(f"{layers.tool(name)} -q" for name in ("findhex", "buildgraph", "initsol")),
                           f"{layers.tool('lns')} -q -o {folder}/part.tar"])
        subprocess.run(["bash", "-o", "pipefail", "-c", pipe], check=True)
        plain, _, before = ours(folder, "none")
        seconds, said, after = ours(folder, "mend")
        changes = re.search(r"(\d+) cells are halved, (\d+) cut, (\d+) merged into (\d+) polyhedra, (\d+) left out \(([\d.]+) % of the volume\), and (\d+) vertices moved; hexes are ([\d.]+) % of the volume, ([\d.]+) before", said)
        changes = changes.groups() if changes else ("0",) * 7 + ("100", "100")
        lost = float(changes[8]) - float(changes[7])
        cells = [f"{plain:.1f}", *before[1:], f"{seconds:.1f}", *after[1:], *changes[:7], f"{lost:.2f}"]
        if shutil.which("snappyHexMesh") and not args.alone:
            cells += snappy(folder, surface, size)
        print(f"{model:16} " + " ".join(f"{cell:>8}" for cell in cells), flush=True)
        return after[0] and lost <= 0.1


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--size", choices=LEVELS[1:], default="middle")
    parser.add_argument("--models", nargs="*", choices=list(ROUNDED), default=list(ROUNDED))
    parser.add_argument("--alone", action="store_true", help="without snappyHexMesh")
    args = parser.parse_args()
    if shutil.which("checkMesh") is None:
        print("checkmesh.py: skipped, OpenFOAM's checkMesh is not there")
        return
    absent = [model for model in args.models if not os.path.exists(os.path.join(MODELS, model))]
    if absent:
        print(f"checkmesh.py: skipped, {', '.join(absent)} not in {MODELS}")
        return
    titles = "seconds none severe hexes seconds mended severe hexes halved cut merged into out volume moved lost snappy severe hexes".split()
    print(f"{'model':16} " + " ".join(f"{title:>8}" for title in (titles[:-3] if args.alone else titles)))
    good = [bench(model, args) for model in args.models]
    print(f"{sum(good)} of {len(good)} reach the goal")
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main()
