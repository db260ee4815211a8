#!/usr/bin/python3
"""pipeline.py [--size coarse|middle|fine] [--time-limit S] [--threads N] [MODEL...] - what every stage does on real models.

Runs the whole pipeline on models of ../shared/models (or on the files named), one stage after another through bundles, and
prints two tables: the sizes and the result, and wall seconds and peak memory of every stage. The tools are taken from
build/bin, or from HEXPIPE_BIN. Results are checked by tests/checkers/meshstats.py.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time

from model_sizes import LEVELS, MODELS, ROOT, size_of

BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))
STAGES = ("tetmesh", "findhex", "buildgraph", "initsol", "lns", "assemble")

DEFAULT_MODELS = ("notch.stl", "simp.stl", "mambo-s1.stl", "mambo-s27.stl", "mambo-m1.stl")


def run(command):
    """Wall seconds and peak memory in MiB of a command that has to succeed."""
    start = time.monotonic()
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(command)}: status {status}")
    return time.monotonic() - start, usage.ru_maxrss / 1024


def measure(path, level, options, folder):
    size = size_of(path, level)
    row = {"model": os.path.basename(path), "size": f"{size:.4g}"}
    source = path
    for stage in STAGES:
        target = os.path.join(folder, f"{stage}.tar" if stage != "assemble" else "assemble.vtu")
        stats = os.path.join(folder, f"{stage}.json")
        command = [os.path.join(BIN, stage), source, "-o", target, "--stats", stats, "-q"]
        command += ["--threads", str(options.threads)]
        command += {"tetmesh": ["--size", repr(size)], "initsol": ["--time-limit", str(options.start_time)],
                    "lns": ["--time-limit", str(options.time_limit)]}.get(stage, [])
        row[stage] = run(command)
        row[stage + " stats"] = json.load(open(stats))
        source = target
    check = subprocess.run([os.path.join(ROOT, "tests", "checkers", "meshstats.py"), "--json", "--exact", source],
                           check=True, capture_output=True, text=True)
    row["mesh"] = json.loads(check.stdout)
    return row


def print_tables(rows):
    print("| model | size | points | tets | candidates | conflicts | hexes | hex volume % | hexes % of cells | "
          "scaled Jacobian least / mean | invalid | quads left |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for r in rows:
        mesh, tetmesh = r["mesh"], r["tetmesh stats"]
        print(f"| {r['model']} | {r['size']} | {tetmesh['points']} | {tetmesh['tets']} | {r['findhex stats']['candidates']} | "
              f"{r['buildgraph stats']['edges']} | {mesh['hexes']} | {mesh['hex_volume_percent']} | {mesh['hex_number_percent']} | {mesh['least_hex_jacobian']} / "
              f"{mesh['mean_hex_jacobian']} | {mesh['invalid_hexes'] + mesh['inverted_cells']} | {mesh['open_quads']} |")
    print()
    print("| model | " + " | ".join(f"{stage} s / MiB" for stage in STAGES) + " |")
    print("|---" * (len(STAGES) + 1) + "|")
    for r in rows:
        print(f"| {r['model']} | " + " | ".join(f"{r[s][0]:.2f} / {r[s][1]:.0f}" for s in STAGES) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*")
    parser.add_argument("--size", choices=LEVELS, default="middle")
    parser.add_argument("--time-limit", type=float, default=20, help="seconds of lns")
    parser.add_argument("--start-time", type=float, default=10, help="seconds of initsol")
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    models = options.models or [os.path.join(MODELS, name) for name in DEFAULT_MODELS]
    missing = [path for path in models if not os.path.exists(path)]
    if missing:
        print(f"skipped: {missing[0]} is not there")
        return
    level = LEVELS.index(options.size)
    with tempfile.TemporaryDirectory() as folder:
        print_tables([measure(path, level, options, folder) for path in models])


if __name__ == "__main__":
    main()
