#!/usr/bin/python3
"""stages.py [--with BEFORE] [--tets N...] [--model FILE] [--threads N] - what each stage takes by default, for meshes of N tets.

The pipeline of README.md runs on a model of ../shared/models (mambo-m6, or the file named), at sizes that give about N tets
(10^4, 10^5, 10^6), with every option at its default, so that searches end by themselves, one stage after another through files.
Printed are processor seconds (user and system), peak memory and the size of the bundle of each stage, then the sums, the wall
clock and the share of the volume in hexes. With BEFORE, a folder of other executables (or of the same tools of an earlier
version), both run in turn, and the ratio of their sums is printed. Ends with 1 when the pipeline takes more than MOST_SECONDS
of the processor for its number of tets.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time

import bench_meshes as meshes

MODELS = os.path.join(meshes.ROOT, "..", "shared", "models")
STAGES = ("tetmesh", "findhex", "buildgraph", "initsol", "lns", "assemble")
# Goals, for as many tets as named.
MOST_SECONDS = {10**5: 5, 10**6: 60}
TRIAL_SIZE = "5%"


def stats_of(path):
    with open(path) as file:
        return json.load(file)


def size_for(model, tets):
    """Tets are nearly in proportion to the volume over the cube of the size: from a coarse mesh to one of a tenth, and on."""
    size = TRIAL_SIZE
    for wanted in (tets / 10, tets):
        subprocess.run([meshes.tool("tetmesh"), "-q", model, "--size", str(size), "--stats", "trial.json", "-o", "trial.tar"], check=True)
        trial = stats_of("trial.json")
        size = trial["size"] * (trial["tets"] / wanted) ** (1 / 3)
    return size


def measure(folder, name, model, size, threads):
    source, rows, begin = model, {}, time.monotonic()
    for stage in STAGES:
        product = f"{name}-{stage}.tar"
        words = [os.path.join(folder, stage), "-q", source, "--threads", threads, "--stats", f"{stage}.json", "-o", product]
        usage = meshes.run_apart(words + (["--size", repr(size)] if stage == "tetmesh" else []))
        rows[stage] = usage.seconds, usage.peak, os.path.getsize(product)
        if source != model:
            os.remove(source)
        source = product
    os.remove(source)
    wall = time.monotonic() - begin
    return {"rows": rows, "seconds": sum(row[0] for row in rows.values()), "wall": wall, "tets": stats_of("tetmesh.json")["tets"],
            "weight": stats_of("lns.json")["weight"], "volume": 100 * stats_of("assemble.json")["cells"]["hex"]["share_of_volume"]}


def show(title, run):
    print(f"\n{title}: {run['tets']} tets, {run['seconds']:.1f} s of the processor, {run['wall']:.1f} by the clock, weight {run['weight']}, "
          f"{run['volume']:.2f} % of the volume in hexes\n")
    print("| stage | processor s | us a tet | peak MiB | bytes a tet | bundle MiB |\n|---|---|---|---|---|---|")
    for stage, (seconds, peak, size) in run["rows"].items():
        print(f"| {stage} | {seconds:.2f} | {1e6 * seconds / run['tets']:.1f} | {peak / 2**20:.0f} | {peak / run['tets']:.0f} | "
              f"{size / 2**20:.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--with", dest="before", metavar="BEFORE")
    parser.add_argument("--tets", nargs="+", type=float, default=[1e4, 1e5, 1e6])
    parser.add_argument("--model", default=os.path.join(MODELS, "mambo-m6.stl"))
    parser.add_argument("--threads", default="2")
    options = parser.parse_args()
    if not os.path.exists(options.model):
        print(f"skipped: {options.model} is not there")
        return
    model, before = os.path.abspath(options.model), options.before and os.path.abspath(options.before)
    too_slow = False
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for tets in options.tets:
            size = size_for(model, tets)
            now = measure(meshes.BIN, "now", model, size, options.threads)
            show("now", now)
            if before:
                other = measure(before, "before", model, size, options.threads)
                show("before", other)
                print(f"\nnow to before: {now['seconds'] / other['seconds']:.3f} times the processor's time, "
                      f"{now['wall'] / other['wall']:.3f} times the clock's")
            most = MOST_SECONDS.get(round(tets))
            if most:
                print(f"\ngoal: {most} s of the processor, {'reached' if now['seconds'] <= most else 'missed'}")
                too_slow = too_slow or now["seconds"] > most
    sys.exit(1 if too_slow else 0)


if __name__ == "__main__":
    main()
