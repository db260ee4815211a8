#!/usr/bin/python3
"""stages.py [--with BEFORE] [--tets N...] [--model FILE] [--threads N] - what each stage takes by default, for meshes of N tets.

The pipeline of README.md runs on a model of ../shared/models (mambo-m6, or the file named), at sizes that give about N tets
(3,000, 10^4, 10^5, 10^6; 10^7 takes nine minutes), with every option at its default, so that searches end by themselves, one
stage after another through files, then all at once through a pipe with `lns --slim`. Printed as Markdown are processor seconds (user and
system), peak memory and the size of the bundle of each stage, then the sums, the wall clock of the pipe, the share of the
volume in hexes, and how the time a tet grows with the tets. With BEFORE, a folder of other executables (or of the same tools of an
earlier version), both run in turn, and the ratio of their sums is printed. Ends with 1 when the pipeline takes more than
MOST_SECONDS of the processor or MOST_BY_THE_CLOCK for its number of tets, or MOST_GROWTH times as long a tet as for 10^6.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import time

import bench_meshes as meshes

MODELS = os.path.join(meshes.ROOT, "..", "shared", "models")
STAGES = ("tetmesh", "findhex", "buildgraph", "initsol", "lns", "assemble")
# Goals, for as many tets as named.
MOST_SECONDS = {3000: 0.5, 10**5: 5, 10**6: 60}
MOST_BY_THE_CLOCK = {10**6: 40}
MOST_GROWTH = 1.15
TRIAL_SIZE = "5%"


def stats_of(path):
    with open(path) as file:
        return json.load(file)


def size_for(model, tets):
    """Tets are nearly in proportion to the volume over the cube of the size, but for coarse meshes: from a mesh of a tenth on,
    until the number is off by a tenth at most, or the nearest of six."""
    size, sizes = TRIAL_SIZE, {}
    for wanted in [tets / 10] + 6 * [tets]:
        subprocess.run([meshes.tool("tetmesh"), "-q", model, "--size", str(size), "--stats", "trial.json", "-o", "trial.tar"], check=True)
        trial = stats_of("trial.json")
        if wanted == tets:
            sizes[abs(math.log(trial["tets"] / tets))] = trial["size"]
            if min(sizes) < 0.1:
                break
        size = trial["size"] * (trial["tets"] / wanted) ** (1 / 3)
    return sizes[min(sizes)]


def measure(folder, name, model, size, threads):
    source, rows = model, {}
    for stage in STAGES:
        product = f"{name}-{stage}.tar"
        words = [os.path.join(folder, stage), "-q", source, "--threads", threads, "--stats", f"{stage}.json", "-o", product]
        usage = meshes.run_apart(words + (["--size", repr(size)] if stage == "tetmesh" else []))
        rows[stage] = usage.seconds, usage.peak, os.path.getsize(product)
        if source != model:
            os.remove(source)
        source = product
    os.remove(source)
    return {"rows": rows, "seconds": sum(row[0] for row in rows.values()), "piped": clock_of_pipe(folder, model, size, threads), "tets": stats_of("tetmesh.json")["tets"],
            "weight": stats_of("lns.json")["weight"], "volume": 100 * stats_of("assemble.json")["cells"]["hex"]["share_of_volume"]}


def clock_of_pipe(folder, model, size, threads):
    """Seconds by the clock for all stages at once."""
    words = [[os.path.join(folder, stage), "-q", "--threads", threads] for stage in STAGES]
    words[0] += [model, "--size", repr(size)]
    if "--slim" in subprocess.run([words[4][0], "--help"], capture_output=True, text=True).stdout:
        words[4].append("--slim")
    words[-1] += ["-o", "piped.tar"]
    begin, previous, processes = time.monotonic(), None, []
    for command in words:
        last = command is words[-1]
        process = subprocess.Popen(command, stdin=previous, stdout=None if last else subprocess.PIPE)
        if previous:
            previous.close()
        previous = process.stdout
        processes.append(process)
    if any(process.wait() for process in processes):
        sys.exit("a stage of the pipe failed")
    return time.monotonic() - begin


def show(title, run):
    print(f"\n{title}: {run['tets']} tets, {run['seconds']:.2f} s of the processor, {run['piped']:.2f} by the clock through a pipe, weight {run['weight']}, "
          f"{run['volume']:.2f} % of the volume in hexes\n")
    print("| stage | processor s | us a tet | peak MiB | bytes a tet | bundle MiB |\n|---|---|---|---|---|---|")
    for stage, (seconds, peak, size) in run["rows"].items():
        print(f"| {stage} | {seconds:.2f} | {1e6 * seconds / run['tets']:.1f} | {peak / 2**20:.0f} | {peak / run['tets']:.0f} | "
              f"{size / 2**20:.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--with", dest="before", metavar="BEFORE")
    parser.add_argument("--tets", nargs="+", type=float, default=[3e3, 1e4, 1e5, 1e6])
    parser.add_argument("--model", default=os.path.join(MODELS, "mambo-m6.stl"))
    parser.add_argument("--threads", default="2")
    options = parser.parse_args()
    if not os.path.exists(options.model):
        print(f"skipped: {options.model} is not there")
        return
    model, before = os.path.abspath(options.model), options.before and os.path.abspath(options.before)
    too_slow, a_tet = False, {}
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
                      f"{now['piped'] / other['piped']:.3f} times the clock's")
            a_tet[round(tets)] = now["seconds"] / now["tets"]
            goals = [(MOST_SECONDS.get(round(tets)), now["seconds"], "s of the processor"),
                     (MOST_BY_THE_CLOCK.get(round(tets)), now["piped"], "s by the clock through a pipe")]
            if tets > 1e6 and 10**6 in a_tet:
                goals.append((MOST_GROWTH, a_tet[round(tets)] / a_tet[10**6], "times the time a tet that a million takes"))
            for most, measured, unit in goals:
                if most:
                    print(f"\n{measured:.2f} {unit}, goal {most}: {'reached' if measured <= most else 'missed'}", flush=True)
                    too_slow = too_slow or measured > most
    sys.exit(1 if too_slow else 0)


if __name__ == "__main__":
    main()
