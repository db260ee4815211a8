#!/usr/bin/python3
"""assemble.py [--models DIR] [--size coarse|middle|fine] [--seeds N [--first SEED]] [--million] [--merging [--solve]] [MODEL...] - are assemble's meshes valid, how good are they, and how fast.

Three sections, each checked by tests/checkers/meshstats.py --exact:
  models    the surfaces of ../shared/models (or --models DIR, or the files named): share of the volume in hexes before and
            after conformity, cells given back by reason, least scaled Jacobians, seconds. Skipped where they are not.
  random    N meshes of uniform points, seeds from SEED on: nothing may ever break an invariant.
  million   a lattice of a million tets with 6 of 7 cubes chosen: seconds without smoothing; the goal is 10.
With --merging instead of these: the models' same choices without and with --merge, cells by kind. With --solve, too, Poisson's
equation on both (tests/checkers/poisson_getfem.py): the condition number of the stiffness matrix, and the errors of a smooth
solution in the L2 norm and the H1 seminorm. These need python3-getfem, and minutes for a model of 30,000 vertices.
The tools are taken from build/bin, or from HEXPIPE_BIN. Ends with 1 when an invariant is broken or a goal is missed.
"""
import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile

import numpy as np
from scipy.spatial import Delaunay

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))
sys.path.insert(0, os.path.join(ROOT, "tests", "checkers"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
POISSON = os.path.join(ROOT, "tests", "checkers", "poisson_getfem.py")
import meshstats  # noqa: E402
from model_sizes import LEVELS, MODELS, size_of_assemble  # noqa: E402

NEVER = ("facets_of_three_cells", "twisted_quads", "quads_against_triangles", "open_quads", "inverted_cells",
         "invalid_hexes", "odd_boundary_edges", "duplicate_cells", "unused_points", "negative_volumes")
# Scaled Jacobians after smoothing, and points of volume lost to conformity.
LEAST_HEX, LEAST_OTHER, MOST_LOST = 0.1, 0.02, 0.5
# Merging may leave cells as poor as this where none was poorer before.
LEAST_MERGED = 0.12
# Most models should have no tet or pyramid below this.
LEAST_WANTED = 0.1


def tool(name, *arguments, **options):
    return subprocess.run([os.path.join(BIN, name), *map(str, arguments)], check=True, **options)


def assemble(source, *arguments):
    """Statistics, the checker's findings, and user seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    tool("assemble", *source, "--threads", 1, "--stats", "stats.json", "--format", "msh22", "-o",
         "result.msh", *arguments)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    with open("stats.json") as file:
        return json.load(file), meshstats.stats("result.msh", exact=True), seconds


def broken(found):
    faults = [key for key in NEVER if found[key]]
    return faults + (["volume_gap"] if abs(found["volume_gap"]) > 1e-9 else [])


def make_solution(path, level):
    """solution.tar in the working folder; returns the edge length."""
    size = size_of_assemble(path, level)
    tool("tetmesh", path, "--size", size, "-q", "-o", "mesh.tar")
    tool("findhex", "mesh.tar", "-o", "candidates.tar", "--format", "tar")
    tool("buildgraph", "candidates.tar", "-o", "graph.tar", "--format", "tar")
    tool("initsol", "graph.tar", "--iterations", 20000, "-o", "solution.tar", "--format", "tar")
    return size


def bench_model(path, level):
    name, size = os.path.basename(path), make_solution(path, level)
    plain, _, _ = assemble(["solution.tar"], "--conformity", "none", "--smooth", 0)
    stats, found, seconds = assemble(["solution.tar"])
    share = [100 * s["cells"]["hex"]["share_of_volume"] for s in (plain, stats)]
    least = {kind: cell["scaled_jacobian"]["least"] * (2 ** 0.5 if kind == "tet" else 1)
             for kind, cell in stats["cells"].items() if cell["count"]}
    lost = 100 * stats["conformity"]["hex_volume_given_back"] / stats["volume"]["input"]
    missed = broken(found)
    missed += [f"hex {least['hex']:.3f}"] if least.get("hex", 1) < LEAST_HEX else []
    missed += [f"{kind} {value:.4f}" for kind, value in least.items() if kind != "hex" and value < LEAST_OTHER]
    missed += [f"lost {lost:.2f}"] if lost > MOST_LOST else []
    reasons = {k: v for k, v in stats["conformity"]["cells_given_back"].items() if v}
    print(f"{name:16} {size:7.3g} {found['hexes']:7} {share[0]:6.2f} {share[1]:6.2f} {lost:5.2f} "
          f"{least.get('hex', 0):6.3f} {least.get('pyramid', 0):6.3f} {least.get('tet', 0):7.4f} {seconds:6.1f}  "
          f"{reasons or ''} {'MISSED: ' + ', '.join(missed) if missed else ''}", flush=True)
    return missed


def by_kind(stats):
    """Number, least and mean scaled Jacobian of the cells that are no hexes; of tets times the square root of 2."""
    found = []
    for kind in ("prism", "pyramid", "tet"):
        cells = stats["cells"][kind]
        scale = 2 ** 0.5 if kind == "tet" else 1
        least, mean = (scale * cells["scaled_jacobian"][what] for what in ("least", "mean"))
        found.append((kind, cells["count"], least, mean))
    return found


def solve_merged():
    """Condition numbers and errors without and with --merge, of the choice in solution.tar."""
    runs = []
    for merge in ("none", "vertices"):
        tool("assemble", "solution.tar", "--merge", merge, "--format", "msh22", "-o", "solved.msh")
        answer = subprocess.run(["/usr/bin/python3", POISSON, "solved.msh"], check=True, capture_output=True, text=True).stdout
        runs.append(json.loads([line for line in answer.split("\n") if line.startswith("{")][0]))
    none, merged = runs
    print(f"{'':16} condition {none['condition']:.0f} {merged['condition']:.0f}  "
          f"L2 {none['l2']:.3e} {merged['l2']:.3e}  H1 {none['h1']:.3e} {merged['h1']:.3e}", flush=True)


def bench_merging(path, level, solves):
    """The same choice without and with --merge: fewer cells, none of a kind worse, and hexes no smaller."""
    make_solution(path, level)
    (none, _, before), (merged, found, after) = (assemble(["solution.tar"], "--merge", m) for m in ("none", "vertices"))
    missed = broken(found)
    shares = []
    for what in ("share_of_number", "share_of_volume"):
        shares.append([100 * s["cells"]["hex"][what] for s in (none, merged)])
    missed += ["volume"] if shares[1][1] < shares[1][0] - 0.01 else []
    kinds, least_of_all = [], 1
    for (kind, count, least, mean), (_, fewer, worst, average) in zip(by_kind(none), by_kind(merged)):
        kinds.append(f"{kind} {count:5} {fewer:5}  {least:.3f} {worst:.3f}  {mean:.3f} {average:.3f}")
        least_of_all = min(least_of_all, worst if kind != "prism" else 1)
        missed += [f"{kind} least {worst:.4f}"] if kind != "prism" and worst < min(least, LEAST_MERGED) - 1e-4 else []
        missed += [f"{kind} mean {average:.3f}"] if kind != "prism" and average < mean else []
    print(f"{os.path.basename(path):16} {shares[0][0]:6.2f} {shares[0][1]:6.2f}  {shares[1][0]:6.2f} {shares[1][1]:6.2f}  "
          f"{'  '.join(kinds)}  {before:5.1f} {after:5.1f} {'MISSED: ' + ', '.join(missed) if missed else ''}", flush=True)
    if solves:
        solve_merged()
    return missed, shares[0], least_of_all >= LEAST_WANTED


def bench_random(seed):
    random = np.random.default_rng(seed)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    points = np.concatenate([corners, random.uniform(0.02, 0.98, (20 + seed % 150, 3))])
    tets = Delaunay(points).simplices
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    volume = np.linalg.det(edges)
    tets = np.where((volume < 0)[:, None], tets[:, [0, 2, 1, 3]], tets)
    with open("random.mesh", "w") as file:
        print("MeshVersionFormatted 2\nDimension 3\nVertices\n%d" % len(points), file=file)
        np.savetxt(file, np.c_[points, np.zeros(len(points))], fmt="%.17g %.17g %.17g %d")
        print("Tetrahedra\n%d" % len(tets), file=file)
        np.savetxt(file, np.c_[tets + 1, np.ones(len(tets), int)], fmt="%d")
        print("End", file=file)
    kinds = ("hex,prism,pyramid", "hex")[seed % 2]
    tool("findhex", "--mesh", "random.mesh", "--cells", kinds, "--min-quality", 0.1, "-o", "c.tar", "--format", "tar")
    tool("buildgraph", "c.tar", "-o", "g.tar", "--format", "tar")
    tool("initsol", "g.tar", "--iterations", 0, "-o", "s.tar", "--format", "tar")
    _, found, _ = assemble(["s.tar"], "--smooth", seed % 4)
    if broken(found):
        print(f"random seed {seed}: {', '.join(broken(found))}", flush=True)
    return broken(found)


def bench_million():
    with open("lattice.mesh", "w") as file:
        subprocess.run([sys.executable, os.path.join(ROOT, "tests", "data", "lattices", "lattice.py"), "kuhn", "55"],
                       check=True, stdout=file)
    tool("findhex", "--mesh", "lattice.mesh", "--min-quality", 0.9, "-o", "lattice.cand")
    count = 55 ** 3
    with open("lattice.sol", "w") as file:
        file.writelines(f"{i + 1}\n" for i in range(count) if i * 7919 % 7)
    source = ["--mesh", "lattice.mesh", "--candidates", "lattice.cand", "--solution", "lattice.sol"]
    stats, found, seconds = assemble(source, "--smooth", 0)
    missed = broken(found) + (["10 s"] if seconds > 10 else [])
    print(f"million tets: {seconds:.1f} user seconds with reading and writing, {stats['conformity']['quads_against_tets']} "
          f"quads made conforming {'MISSED: ' + ', '.join(missed) if missed else ''}", flush=True)
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", default=MODELS)
    parser.add_argument("--size", choices=LEVELS, default="coarse")
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--million", action="store_true")
    parser.add_argument("--merging", action="store_true", help="--merge none beside the default, nothing else")
    parser.add_argument("--solve", action="store_true", help="with --merging: condition numbers and errors, too")
    parser.add_argument("files", nargs="*", metavar="MODEL")
    arguments = parser.parse_args()
    files = [os.path.abspath(f) for f in arguments.files]
    if not files and os.path.isdir(arguments.models):
        folder = os.path.abspath(arguments.models)
        files = sorted(os.path.join(folder, f) for f in os.listdir(folder) if f.endswith((".stl", ".obj", ".off")))
    if not files:
        print(f"models: skipped, {arguments.models} is not there")
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if arguments.merging:
            print("without and with --merge: hexes % of number, % of volume; by kind number, least, mean; seconds")
            results = [bench_merging(file, LEVELS.index(arguments.size), arguments.solve) for file in files]
            if results:
                means = [sum(shares[i] for _, shares, _ in results) / len(results) for i in (0, 1)]
                print(f"mean % of the number: {means[0]:.2f} {means[1]:.2f}")
                good = sum(is_good for _, _, is_good in results)
                print(f"no tet or pyramid below {LEAST_WANTED} on {good} of {len(results)} models")
            os.chdir("/")
            return 1 if any(bad for bad, _, _ in results) else 0
        if files:
            print("model               size   hexes  hex %  after  lost hex SJ pyr SJ  tet SJ seconds")
        missed += sum(bool(bench_model(file, LEVELS.index(arguments.size))) for file in files)
        bad = sum(bool(bench_random(arguments.first + i)) for i in range(arguments.seeds))
        print(f"random: {arguments.seeds} meshes, {bad} with a broken invariant")
        missed += bad + (bool(bench_million()) if arguments.million else 0)
        os.chdir("/")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
