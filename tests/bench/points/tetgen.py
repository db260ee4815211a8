#!/usr/bin/python3
"""tetgen.py [MODEL...] [--level coarse|middle|fine] [--threads N...] [--runs N] - how long tetmesh takes against TetGen.

Two ratios for each model of ../shared/models (or of the files named), from runs one after the other, the least time of each:
  own runs   all of tetmesh's steps against the time TetGen takes in them, which meshes tetmesh's points twice, on one thread;
  alone      the whole of tetmesh, files and all, against the program tetgen as it is run without tetmesh: -pqa on the part's own
             triangles, with tets of at most twice the mean volume of tetmesh's. It makes more of them, many more where the part's
             triangles are smaller than that.
The second is left out where there is no program tetgen (Debian's package of that name). The rows over the goal come first.
Tools are taken from build/bin, or from HEXPIPE_BIN.
"""
import argparse
import json
import os
import shutil
import subprocess
import tempfile
import time

from run import BIN, FILES, LEVELS, MODELS, size_of

GOAL = 4


def least(times, key, seconds):
    times[key] = min(seconds, times.get(key, seconds))


def write_off(path, to):
    """The surface with equal points as one, which TetGen's reader of binary STL does not make of it."""
    import numpy
    import surfcheck
    corners, triangles = surfcheck.read(path)
    points, number = numpy.unique(corners, axis=0, return_inverse=True)
    number = number.reshape(-1)
    with open(to, "w") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        file.writelines(f"{x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
        file.writelines(f"3 {number[a]} {number[b]} {number[c]}\n" for a, b, c in triangles.tolist())


def run_tetmesh(path, size, threads, folder, times):
    stats = os.path.join(folder, "stats.json")
    begin = time.perf_counter()
    subprocess.run([os.path.join(BIN, "tetmesh"), "-q", path, "--size", repr(size), "--threads", str(threads), "--stats", stats,
                    "-o", os.path.join(folder, "mesh.tar")], check=True)
    least(times, ("process", threads), time.perf_counter() - begin)
    result = json.load(open(stats))
    least(times, ("steps", threads), sum(result["seconds_by_step"].values()))
    least(times, "tetgen", result["tetgen_seconds"])
    return result


def run_tetgen(surface, volume, times):
    """Points and tets of the mesh."""
    begin = time.perf_counter()
    subprocess.run(["tetgen", f"-pqa{volume!r}", "-Q", surface], check=True, stdout=subprocess.DEVNULL)
    least(times, "alone", time.perf_counter() - begin)
    return [int(open(surface[:-4] + ending).readline().split()[0]) for ending in (".1.node", ".1.ele")]


def measure(path, options, alone):
    size, times, counts = size_of(path, LEVELS.index(options.level)), {}, None
    with tempfile.TemporaryDirectory() as folder:
        surface = os.path.join(folder, "surface.off")
        write_off(path, surface)
        for _ in range(options.runs):
            for threads in options.threads:
                mesh = run_tetmesh(path, size, threads, folder, times)
            if alone:
                counts = run_tetgen(surface, 2 * mesh["volume"] / mesh["tets"], times)
    name = os.path.basename(path).rsplit(".", 1)[0]
    cells = [name, f"{size:.4g}", str(mesh["points"]), str(mesh["tets"]), f"{1e3 * times['tetgen']:.0f}"]
    own = [times["steps", threads] / times["tetgen"] for threads in options.threads]
    cells += [f"{ratio:.2f}" for ratio in own]
    if alone:
        cells += [str(count) for count in counts] + [f"{1e3 * times['alone']:.0f}"]
        cells += [f"{times['process', threads] / times['alone']:.2f}" for threads in options.threads]
    return max(own), cells


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*")
    parser.add_argument("--level", choices=LEVELS, default="fine")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    if options.runs < 1 or min(options.threads) < 1:
        parser.error("expected at least one run and one thread")
    models = options.models or [os.path.join(MODELS, name) for name in FILES]
    missing = [path for path in models if not os.path.exists(path)]
    if missing:
        print(f"skipped: {missing[0]} is not there")
        return
    alone = shutil.which("tetgen") is not None
    heads = ["model", "size", "points", "tets", "TetGen's own runs, ms"]
    heads += [f"tetmesh / own runs, {n} thread{'s' * (n > 1)}" for n in options.threads]
    if alone:
        heads += ["tetgen alone: points", "tets", "ms"]
        heads += [f"tetmesh / alone, {n} thread{'s' * (n > 1)}" for n in options.threads]
    else:
        print("skipped: tetgen alone, for there is no such program")
    print(f"goal: at most {GOAL}")
    print("| " + " | ".join(heads) + " |\n" + "|---" * len(heads) + "|")
    for _, cells in sorted((measure(path, options, alone) for path in models), reverse=True):
        print("| " + " | ".join(cells) + " |", flush=True)


main()
