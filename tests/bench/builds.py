#!/usr/bin/python3
"""builds.py --with BEFORE [--size SIZE] [--stages TOOL...] [MODEL...] - what a change of the sources costs that changes no result.

Each stage of the pipeline runs by the executables of the folder BEFORE and by those of HEXPIPE_BIN, on one thread and on the same
input. Instructions are counted by valgrind's cachegrind, in all processes of a stage, so that other work on the machine does not
matter; the peak of the resident memory is the least of three runs outside of it. Models are bracket, notch and plate-holes of
tests/data, if none is given. Printed are both ratios, now to before, and whether the products are the same bytes. Ends with 1 when
a product differs, or when a stage takes more than 2 % more of either, over all models.
"""
import argparse
import glob
import os
import re
import subprocess
import sys
import tempfile

import bench_meshes as meshes

DATA = os.path.join(meshes.ROOT, "tests", "data")
LIMIT = 1.02
STAGES = {
    "tetmesh": ["--size", None],
    "findhex": ["--cells", "hex,prism,pyramid"],
    "buildgraph": ["--cover"],
    "initsol": ["--iterations", "2000"],
    "lns": ["--iterations", "100"],
    "assemble": [],
}


def command(folder, tool, size, source, product):
    words = [size if word is None else word for word in STAGES[tool]]
    return [os.path.join(folder, tool), "-q", *words, "--threads", "1", source, "-o", product]


def peak_of(words):
    return min(meshes.run(words)[1] for _ in range(3))


def instructions_of(words):
    for old in glob.glob("count.*"):
        os.remove(old)
    subprocess.run(["valgrind", "-q", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=count.%p", *words], check=True, capture_output=True)
    counts = [re.search(r"^summary: ([\d,]+)", open(path).read(), re.M).group(1) for path in glob.glob("count.*")]
    return sum(int(count.replace(",", "")) for count in counts)


def bytes_of(path):
    with open(path, "rb") as file:
        return file.read()


def compare(model, options, before, now, sums):
    source, same = model, True
    for tool in STAGES:
        product = f"{tool}.tar"
        if tool not in options.stages:
            subprocess.run(command(before, tool, options.size, source, product), check=True)
            source = product
            continue
        figures = {}
        for name, folder in (("now", now), ("before", before)):
            words = command(folder, tool, options.size, source, f"{name}-{product}")
            figures[name] = peak_of(words), instructions_of(words)
            for i, figure in enumerate(figures[name]):
                sums[tool][name][i] += figure
        equal = bytes_of(f"now-{product}") == bytes_of(f"before-{product}")
        same = same and equal
        (peak, count), (old_peak, old_count) = figures["now"], figures["before"]
        print(f"| {tool} | {os.path.basename(model)} | {old_count / 1e6:.0f} M | {count / old_count:.4f} | {old_peak / 2**20:.1f} MiB | {peak / old_peak:.3f} | {'same' if equal else 'differ'} |", flush=True)
        source = os.path.abspath(f"before-{product}")
    return same


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--with", dest="before", required=True, metavar="BEFORE")
    parser.add_argument("--size", default="8%")
    parser.add_argument("--stages", nargs="+", choices=STAGES, default=list(STAGES), metavar="TOOL")
    parser.add_argument("models", nargs="*", metavar="MODEL")
    options = parser.parse_args()
    models = [os.path.abspath(m) for m in options.models] or [os.path.join(DATA, f"{m}.stl") for m in ("bracket", "notch", "plate-holes")]
    before, now = os.path.abspath(options.before), os.path.abspath(meshes.BIN)
    sums = {tool: {"now": [0, 0], "before": [0, 0]} for tool in options.stages}
    print("| stage | model | instructions before | now | peak before | now | bytes |\n| --- | --- | --- | --- | --- | --- | --- |")
    good = True
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        for model in models:
            good = compare(model, options, before, now, sums) and good
    for tool, sum_of in sums.items():
        peak, count = (now / old for now, old in zip(sum_of["now"], sum_of["before"]))
        good = good and max(peak, count) <= LIMIT
        print(f"{tool}: {count:.4f} times the instructions, {peak:.3f} times the memory")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
