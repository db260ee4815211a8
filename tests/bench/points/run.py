#!/usr/bin/python3
"""run.py [--level coarse|middle|fine] [--kind KIND...] [--tries N] [--stretch X] [--seconds S] [--time-limit S] [--scans FOLDER] [MODEL...] - how much of a model its points
let become hexes.

Runs the pipeline on models of ../shared/models (or on the files named) once for every kind of points, and prints, worst first
within each kind, the share of the volume in hexes after a greedy choice and after lns, how many rows of points end on faces, the length of
dislocations inside in sizes, candidates per vertex, the least scaled
Jacobian, and the time of tetmesh per 100,000 tets and against TetGen's own in the same run. The rows of Gmsh stand beside.
The kinds are surface+points: keep+lattice is the reference that every other has to beat. With +improve behind them tetmesh searches
for better points for --seconds, on all threads; without, it has one thread. --scans: in place of the models, four scans of
CMU-CBML/HybridOctree_Hex (FOLDER is its "input boundaries") at sizes that make 14,000 to 24,000 hexes, of which the goal is 97 % of
the volume and 65 % of the number; it ends with 1 where one of them has less. Tools are taken from build/bin, or from HEXPIPE_BIN;
results are checked by tests/checkers/meshstats.py.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
sys.path.insert(0, os.path.join(ROOT, "tests", "bench"))
from model_sizes import LEVELS, MODELS, name_of, size_of  # noqa: E402
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))

# Gmsh 4.13.1 from the CAD originals, its frame-field points: percent of the volume in hexes.
GMSH = {"mambo-s1": (77.8, 89.9, 92.7), "mambo-s27": (71.8, 84.8, 86.5), "mambo-m1": (74.7, 79.9, 85.5), "mambo-m6": (None, None, 94.5)}
FILES = ("simp.stl", "plate-holes.stl", "blub.off", "spot.obj", "bridge.stl", "notch.stl", "mambo-s1.stl", "mambo-s22.stl",
         "mambo-s27.stl", "mambo-m1.stl", "mambo-m6.stl")
# Sizes at which scans make 14,000 to 24,000 hexes, and the least of their shares, in percent of the volume and of the number.
SCANS = {"bone": 0.012, "bird": 0.0132, "bunny": 0.0372, "airplane1": 0.0145}
SCANS_GOAL = {"lns": 97, "number": 65}
KINDS = ("keep+lattice", "remesh+lattice", "remesh+frame", "remesh+best", "remesh+best+improve")


def tool(name, folder, *arguments):
    """Runs a tool that has to succeed and returns its statistics."""
    stats = os.path.join(folder, "stats.json")
    subprocess.run([os.path.join(BIN, name), "-q", "--stats", stats, *arguments], check=True)
    return json.load(open(stats))


def share(folder, solution):
    """Percent of the volume in hexes, percent of the number of cells, and the least scaled Jacobian of them; the mesh has to be whole and conforming."""
    mesh = os.path.join(folder, "mesh.vtu")
    stats = tool("assemble", folder, solution, "-o", mesh)
    check = subprocess.run([os.path.join(ROOT, "tests", "checkers", "meshstats.py"), "--json", mesh], check=True,
                           capture_output=True, text=True)
    check = json.loads(check.stdout)
    if check["inverted_cells"] or check["open_quads"]:
        sys.exit(f"{solution}: {check['inverted_cells']} inverted cells, {check['open_quads']} quads against triangles")
    hexes = stats["cells"]["hex"]
    number = 100 * hexes["count"] / sum(cells["count"] for cells in stats["cells"].values())
    return 100 * hexes["share_of_volume"], number, hexes["scaled_jacobian"]["least"]


def write_off(raw, target):
    """From the numbers of points and triangles, the points, and the triangles."""
    with open(raw) as file:
        words = file.read().split()
    points, triangles = int(words[0]), int(words[1])
    rows = [words[i:i + 3] for i in range(2, 2 + 3 * (points + triangles), 3)]
    with open(target, "w") as file:
        file.write(f"OFF\n{points} {triangles} 0\n")
        file.writelines(" ".join(row) + "\n" for row in rows[:points])
        file.writelines("3 " + " ".join(row) + "\n" for row in rows[points:])


def measure(path, size, level, kind, options):
    surface, points, *improve = kind.split("+")
    name = name_of(path)
    improving = ["--improve", "1000000", "--time-limit", str(options.seconds)] if improve else ["--threads", "1"]
    with tempfile.TemporaryDirectory() as folder:
        files = {stage: os.path.join(folder, stage + ".tar") for stage in ("mesh", "candidates", "graph", "greedy", "start", "best")}
        mesh = tool("tetmesh", folder, path, "--surface", surface, "--points", points, "--size", repr(size),
                    "--tries", str(options.tries), *improving,
                    *(["--stretch", repr(options.stretch)] if options.stretch else []), "-o", files["mesh"])
        candidates = tool("findhex", folder, files["mesh"], "-o", files["candidates"])
        tool("buildgraph", folder, files["candidates"], "-o", files["graph"])
        tool("initsol", folder, files["graph"], "--iterations", "0", "-o", files["greedy"])
        tool("initsol", folder, files["graph"], "--time-limit", "1", "-o", files["start"])
        tool("lns", folder, files["start"], "--time-limit", str(options.time_limit), "-o", files["best"])
        greedy, _, _ = share(folder, files["greedy"])
        best, number, least = share(folder, files["best"])
    seconds = mesh["seconds_by_step"]
    return {"model": name, "kind": kind, "size": mesh["size"], "points": mesh["points"], "tets": mesh["tets"], "greedy": greedy,
            "lns": best, "number": number, "gmsh": GMSH.get(name, (None,) * 3)[level] if level is not None else None, "candidates": candidates["candidates"] / mesh["points"],
            "least": least, "per_tets": 1e5 * sum(seconds.values()) / mesh["tets"],
            "ratio": sum(seconds.values()) / mesh["tetgen_seconds"], "away": mesh["distance_to_input"] / mesh["size"],
            "extra": mesh["extra_points"], "row_ends": mesh.get("row_ends"), "dislocations": mesh.get("dislocations", {}).get("length"), "remeshed": mesh["surface_remeshed"] or surface == "keep"}


def counted(value):
    return "-" if value is None else f"{value:.0f}"


def row(r, first):
    against = f"{r['lns'] - first[r['model']]:+.1f}" if r["model"] in first else "-"
    return (f"| {r['model']} | {r['size']:.4g} | {r['kind']}{'' if r['remeshed'] else ' (kept: remeshing failed)'} | {r['points']} | "
            f"{r['tets']} | {r['greedy']:.1f} | {r['lns']:.1f} | {r['number']:.1f} | {counted(r['row_ends'])} | {counted(r['dislocations'])} | {against} | {r['gmsh'] or '-'} | {r['candidates']:.1f} | "
            f"{r['least']:.2f} | {r['extra']} | {r['away']:.3f} | {r['per_tets']:.2f} | {r['ratio']:.1f} |")


def print_head():
    print("| model | size | surface+points | points | tets | hex volume %, greedy | after lns | hex number % | row ends | dislocations, sizes | against keep+lattice | Gmsh | candidates / "
          "vertex | least scaled Jacobian | extra points | distance / size | tetmesh s / 100k tets | tetmesh / TetGen |")
    print("|---" * 18 + "|")


def measure_scans(options):
    """Returns 1 where a scan misses the goal."""
    missed = 0
    print_head()
    with tempfile.TemporaryDirectory() as folder:
        for name, size in SCANS.items():
            raw, path = os.path.join(options.scans, name + "_tri.raw"), os.path.join(folder, name + ".off")
            if not os.path.exists(raw):
                print(f"skipped: {raw} is not there")
                return 0
            write_off(raw, path)
            for kind in options.kind or ("remesh+best",):
                r = measure(path, size, None, kind, options)
                print(row(r, {}), flush=True)
                missed += any(r[key] < goal for key, goal in SCANS_GOAL.items())
    return 1 if missed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*")
    parser.add_argument("--scans", metavar="FOLDER")
    parser.add_argument("--level", choices=LEVELS, action="append")
    parser.add_argument("--kind", action="append", help="surface+points, as the options of tetmesh name them, or surface+points+improve")
    parser.add_argument("--tries", type=int, default=1, help="sizes that tetmesh tries")
    parser.add_argument("--stretch", type=float, default=0, help="of rows, as tetmesh takes it")
    parser.add_argument("--seconds", type=float, default=60, help="in which tetmesh searches for better points, for kinds with +improve")
    parser.add_argument("--time-limit", type=float, default=5, help="seconds of lns")
    options = parser.parse_args()
    if options.scans:
        sys.exit(measure_scans(options))
    models = options.models or [os.path.join(MODELS, name) for name in FILES]
    missing = [path for path in models if not os.path.exists(path)]
    if missing:
        print(f"skipped: {missing[0]} is not there")
        return
    print_head()
    for level in options.level or ("middle", "fine"):
        first = {}
        for kind in options.kind or KINDS:
            rows = [measure(path, size_of(path, LEVELS.index(level)), LEVELS.index(level), kind, options) for path in models]
            rows.sort(key=lambda r: r["lns"])
            for r in rows:
                print(row(r, first), flush=True)
            if kind == "keep+lattice":
                first = {r["model"]: r["lns"] for r in rows}


if __name__ == "__main__":
    main()
