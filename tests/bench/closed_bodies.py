#!/usr/bin/python3
"""closed_bodies.py FOLDER... [--most N] [--hexes | --checks] - how many surfaces as they come are meshed at once.

Runs tetmesh on each STL, OBJ and 3MF file below the folders, with every option at its default, and where it refuses, with --repair, or with
--unite where the message says so. Of each file it tells what was wrong, what was done about it, and the distance both ways between the file's
surface and the mesh's, in sizes. Equal files are taken once. Files with holes that --repair does not close either are no closed bodies: they
are refused rightly, and counted apart. --hexes goes on to the hexes, by findhex, buildgraph, initsol and assemble, and checks the mesh by
tests/checkers. --checks only looks whether tetmesh accepts the surface, in a tenth of the time, and makes no mesh. Ends with 1 if fewer than
95 % of the closed bodies are meshed at once. The tools are taken from build/bin, or from HEXPIPE_BIN.
"""
import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))
CHECK = os.path.join(ROOT, "tests", "checkers", "meshstats.py")
GOAL = 0.95
OPEN = "edges? of a single triangle|a space with a hole|found only sheets|found no triangles"


def surfaces(folders, most):
    """Paths of distinct files, in order."""
    seen, result = set(), []
    for folder in folders:
        found = sorted(os.path.join(below, name) for below, _, names in os.walk(folder) for name in names
                       if name.lower().endswith((".stl", ".obj", ".3mf")))
        for path in found[:: max(1, -(-len(found) // most))] if most else found:
            with open(path, "rb") as file:
                content = hashlib.sha256(file.read()).digest()
            if content not in seen:
                seen.add(content)
                result.append(path)
    return result


# Ends after the checks: TetGen gets no time.
ONLY_CHECKS = ("--surface", "keep", "--points", "none", "--tetgen-timeout", "0.001")


def run(tool, *arguments, limit):
    """The last line of what it says against the input, or None, and its warnings."""
    try:
        done = subprocess.run([os.path.join(BIN, tool), *arguments], capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return f"no end within {limit:g} s", []
    lines = done.stderr.strip().splitlines()
    warnings = [line.split("warning: ", 1)[1] for line in lines if "warning: " in line]
    accepted = done.returncode == 0 or "longer than --tetgen-timeout" in done.stderr
    return (None if accepted else (lines or [f"status {done.returncode}"])[-1]), warnings


def short(text, path):
    text = text.replace("tetmesh: ", "").replace(path, "").lstrip(": ")
    return re.sub(r"; the first.*?(?= \(see|$)", "", text)


def mesh(path, folder, args):
    """(at once, outcome, what was done, deviation, share of hexes)"""
    file = lambda name: os.path.join(folder, name)
    common = [path, "--stats", file("tetmesh.json"), "-o", file("mesh.tar"), *(ONLY_CHECKS if args.checks else ())]
    refused, warnings = run("tetmesh", *common, limit=args.limit)
    first = refused
    mended = ""
    for remedy in (["--repair"], ["--unite"], ["--repair", "--unite"]):
        if not refused or ("--unite" in remedy and "--unite" not in first):
            continue
        refused, warnings = run("tetmesh", *common, *remedy, limit=args.limit)
        mended = " ".join(remedy)
    done = (mended + ": " if mended else "") + "; ".join(short(warning, path) for warning in warnings)
    if refused:
        return False, short(first, path), f"refused with {mended}, too: " + short(refused, path), "", ""
    if args.checks:
        return not first, short(first, path) if first else "", done, "–", ""
    with open(file("tetmesh.json")) as stats:
        tets = json.load(stats)
    off = max(tets.get("distance_to_input") or 0, tets.get("distance_from_input") or 0) / tets["size"]
    share = ""
    result = file("mesh.mesh")
    if args.hexes:
        for tool, before, after in (("findhex", "mesh.tar", "c.tar"), ("buildgraph", "c.tar", "g.tar"), ("initsol", "g.tar", "s.tar")):
            failed, _ = run(tool, file(before), "-o", file(after), limit=args.limit)
            if failed:
                return False, f"{tool}: {failed}", done, f"{off:.2f}", ""
        result = file("result.msh")
        failed, _ = run("assemble", file("s.tar"), "--stats", file("assemble.json"), "-o", result, limit=args.limit)
        if failed:
            return False, f"assemble: {failed}", done, f"{off:.2f}", ""
        with open(file("assemble.json")) as stats:
            share = f"{100 * json.load(stats)['cells']['hex']['share_of_volume']:.1f}"
        checked = json.loads(subprocess.run([sys.executable, CHECK, "--exact", "--json", result], capture_output=True, text=True, check=True).stdout)
        if not checked["is_conforming"] or checked["inverted_cells"] or checked["invalid_hexes"]:
            sys.exit(f"{path}: NOT VALID by tests/checkers/meshstats.py: {checked}")
    return not first, short(first, path) if first else "", done, f"{off:.2f}", share


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="FOLDER")
    parser.add_argument("--most", type=int, help="about so many files of each folder, evenly")
    parser.add_argument("--hexes", action="store_true", help="go on to the hexes, and check the mesh")
    parser.add_argument("--checks", action="store_true", help="only look whether surfaces are accepted")
    parser.add_argument("--limit", type=float, default=600, help="seconds after which a tool is given up")
    args = parser.parse_args()
    at_once = repaired = opened = refused = 0
    print("| file | found | done | off by (sizes) | hex volume % |\n|---|---|---|---|---|", flush=True)
    for path in surfaces(args.folders, args.most):
        with tempfile.TemporaryDirectory() as folder:
            now, fault, done, off, share = mesh(path, folder, args)
        is_open = bool(fault and not off and re.search(OPEN, done))
        at_once += now
        repaired += bool(fault and off)
        opened += bool(is_open)
        refused += bool(fault and not off and not is_open)
        print(f"| {os.path.relpath(path, os.path.dirname(args.folders[0].rstrip('/')))} | {fault} | {done} | {off} | {share} |", flush=True)
    closed = at_once + repaired + refused
    print(f"\n{at_once} of {closed} closed bodies are {'accepted' if args.checks else 'meshed'} at once ({100 * at_once / max(1, closed):.1f} %, goal {100 * GOAL:.0f} %), {repaired} more "
          f"with --repair or --unite; {opened} files are open")
    sys.exit(at_once < GOAL * closed)


if __name__ == "__main__":
    main()
