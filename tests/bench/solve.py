#!/usr/bin/python3
"""solve.py [MODEL SIZE...] - do finite elements converge on assemble's meshes as they should?
solve.py --ring [SIZE...] - how exact are displacements of a ring under pressure, by order and kind of elements?

Meshes a part at three sizes (default: tests/data/bracket.stl at 6, 4.2 and 3) by the whole pipeline and solves Poisson's
equation on it with GetFEM (tests/checkers/poisson_getfem.py), with conditions on the tagged boundary. Prints for each size
the cells by kind, the error of a linear solution (rounding on a conforming mesh), the errors of a smooth one, and the order
of convergence between sizes: elements of degree 1 have 2 in the L2 norm and 1 in the H1 seminorm.
The tools are taken from build/bin, or from HEXPIPE_BIN. Ends with 1 when the linear error is above 1e-10 or the order over
all sizes is below 1.7 or 0.85. Says `skipped` without python3-getfem.

--ring solves G. Lamé's problem on a quarter of a ring (tests/data/ring.py) with CalculiX (tests/checkers/lame_calculix.py), on
meshes of several sizes: hex-dominant and of tets alone, of first and of second order; and with GetFEM, which has pyramids of
second order (tests/checkers/lame_getfem.py). Prints the error of displacements
against unknowns, and at 12,000 unknowns, interpolated. Ends with 1 when second order is not at least 20 times as exact there
as first order, or not more exact than tets of second order. Says `skipped` without calculix-ccx.
"""
import importlib.util
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))
CHECKER = os.path.join(ROOT, "tests", "checkers", "poisson_getfem.py")
RING_CHECKERS = {"inp": os.path.join(ROOT, "tests", "checkers", "lame_calculix.py"),
                 "vtu": os.path.join(ROOT, "tests", "checkers", "lame_getfem.py")}
MOST_LINEAR_ERROR, LEAST_ORDER = 1e-10, {"l2": 1.7, "h1": 0.85}


def make_mesh(model, size):
    stages = [["tetmesh", model, "--size", size, "-q"], ["findhex"], ["buildgraph"], ["initsol", "--iterations", "20000"],
              ["assemble", "--stats", "stats.json", "--format", "msh22", "-o", "part.msh"]]
    command = " | ".join(" ".join([os.path.join(BIN, stage[0]), *stage[1:]]) for stage in stages)
    subprocess.run(["bash", "-c", "set -o pipefail; " + command], check=True)
    with open("stats.json") as file:
        cells = json.load(file)["cells"]
    answer = subprocess.run(["/usr/bin/python3", CHECKER, "part.msh"], check=True, capture_output=True, text=True).stdout
    run = json.loads([line for line in answer.split("\n") if line.startswith("{")][0])
    return cells, run


def order(coarse, fine, norm):
    return math.log(coarse[norm] / fine[norm]) / math.log(coarse["size"] / fine["size"])


# Meshes of the ring: name, whether of hexes, the file, options of assemble.
SECOND = ["--order", "2", "--surface", "ring.stl"]
SERIES = (
    ("hexes, order 1", True, "ring.inp", []),
    ("hexes, order 2", True, "ring.inp", SECOND),
    ("hexes, order 2, pyramids collapsed", True, "ring.inp", SECOND + ["--pyramids", "collapsed"]),
    ("hexes, order 2, C3D20R", True, "ring.inp", SECOND + ["--hex-element", "C3D8R"]),
    ("hexes, order 2, GetFEM", True, "ring.vtu", SECOND),
    ("tets, order 1", False, "ring.inp", ["--merge", "none"]),
    ("tets, order 2", False, "ring.inp", ["--merge", "none"] + SECOND),
)
RING_SIZES = ("0.3", "0.2", "0.15", "0.12", "0.1", "0.08", "0.065")
UNKNOWNS, LEAST_GAIN = 12000, 20


def run(*stages):
    command = " | ".join(" ".join([os.path.join(BIN, stage[0]), *stage[1:]]) for stage in stages)
    subprocess.run(["bash", "-c", "set -o pipefail; " + command], check=True)


def choose(size, hexes):
    # Hexes of this quality there are none, so that all stay tets.
    quality = [] if hexes else ["--min-quality", "0.999999"]
    run(["tetmesh", "ring.stl", "--size", size, "-q"], ["findhex", *quality], ["buildgraph"],
        ["initsol", "--iterations", "20000", "-q", "-o", "hexes.tar" if hexes else "tets.tar"])


def solve_ring(hexes, file, options):
    choice = "hexes.tar" if hexes else "tets.tar"
    solver = ["--solver", "calculix"] if file.endswith(".inp") else []
    run(["assemble", choice, *options, *solver, "-q", "--stats", "stats.json", "-o", file])
    checker = RING_CHECKERS[file.rsplit(".", 1)[1]]
    answer = subprocess.run(["/usr/bin/python3", checker, file], check=True, capture_output=True, text=True)
    with open("stats.json") as stats:
        cells = json.load(stats)["cells"]
    return dict(json.loads(answer.stdout), pyramids=cells["pyramid"]["count"])


def error_at(unknowns, runs):
    """Between the two runs around, or by the two nearest, on a line of logarithms."""
    points = sorted((math.log(r["unknowns"]), math.log(r["displacement"])) for r in runs)
    above = next((i for i, (x, _) in enumerate(points) if x >= math.log(unknowns)), len(points) - 1)
    (x0, y0), (x1, y1) = points[max(above, 1) - 1], points[max(above, 1)]
    return math.exp(y0 + (math.log(unknowns) - x0) * (y1 - y0) / (x1 - x0))


def ring(sizes):
    if shutil.which("ccx") is None:
        print("solve.py: skipped, calculix-ccx is not there")
        return 0
    series = [one for one in SERIES if one[2] == "ring.inp" or importlib.util.find_spec("getfem") is not None]
    results = {one[0]: [] for one in series}
    print("   size  elements  pyramids  unknowns  displacement    stress  mesh")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("ring.stl", "w") as file:
            subprocess.run([os.path.join(ROOT, "tests", "data", "ring.py"), "200", "0.45"], check=True, stdout=file)
        for size in sizes:
            choose(size, True)
            choose(size, False)
            for name, hexes, file, options in series:
                # Enough to interpolate.
                if results[name] and results[name][-1]["unknowns"] > UNKNOWNS:
                    continue
                result = solve_ring(hexes, file, options)
                results[name].append(result)
                stress = "{:.1e}".format(result["stress"]) if "stress" in result else "-"
                print("{:>7} {:>9} {:>9} {:>9} {:>13.2e} {:>9}  {}".format(
                    size, result["elements"], result["pyramids"], result["unknowns"], result["displacement"], stress, name),
                    flush=True)
        os.chdir("/")
    if len(sizes) < 2:
        return 0
    errors = {name: error_at(UNKNOWNS, runs) for name, runs in results.items()}
    for name, error in errors.items():
        print("at {} unknowns: {:.2e}  {}".format(UNKNOWNS, error, name))
    gain = errors["hexes, order 1"] / errors["hexes, order 2"]
    against_tets = errors["tets, order 2"] / errors["hexes, order 2"]
    print("order 2 is {:.0f} times as exact as order 1, and {:.1f} times as exact as tets of order 2".format(
        gain, against_tets))
    missed = (["gain of order 2"] if gain < LEAST_GAIN else []) + (["tets of order 2"] if against_tets < 1 else [])
    if missed:
        print("MISSED:", ", ".join(missed))
    return 1 if missed else 0


def main():
    if sys.argv[1:2] == ["--ring"]:
        return ring(sys.argv[2:] or RING_SIZES)
    if importlib.util.find_spec("getfem") is None:
        print("solve.py: skipped, python3-getfem is not there")
        return 0
    model = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else os.path.join(ROOT, "tests", "data", "bracket.stl")
    sizes = sys.argv[2:] or ["6", "4.2", "3"]
    runs, missed = [], []
    print("   size   hexes  prisms  pyramids    tets  linear error     L2 error     H1 error  orders")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for size in sizes:
            cells, run = make_mesh(model, size)
            counts = [cells[kind]["count"] for kind in ("hex", "prism", "pyramid", "tet")]
            orders = [f"{order(runs[-1], run, norm):.2f}" for norm in ("l2", "h1")] if runs else []
            print("{:>7} {:>7} {:>7} {:>9} {:>7} {:>13.1e} {:>12.4e} {:>12.4e}  {}".format(
                size, *counts, run["patch"], run["l2"], run["h1"], " ".join(orders)), flush=True)
            missed += ["linear error"] if run["patch"] > MOST_LINEAR_ERROR else []
            missed += ["boundary"] if run["boundary_faces"] != run["tagged_faces"] else []
            runs.append(run)
        os.chdir("/")
    for norm, least in LEAST_ORDER.items():
        reached = order(runs[0], runs[-1], norm) if len(runs) > 1 else math.inf
        missed += [f"order in {norm}: {reached:.2f}"] if reached < least else []
    if missed:
        print("MISSED:", ", ".join(missed))
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
