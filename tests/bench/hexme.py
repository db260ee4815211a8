#!/usr/bin/python3
"""hexme.py FOLDER [--only WORD] [--size S] [--search SECONDS] [--threads N] [--join] [--overlaps RULE] [--short-features X] - CAD models through the whole pipeline.

Runs each .step, .stp, .brep, .iges, .igs and .FCStd below FOLDER, and each .geo where gmsh is installed (OpenCASCADE models only), through
tessellate | tetmesh | findhex | buildgraph | initsol | lns | assemble at tetmesh's own size, and prints a table: the share of
hexes by volume and by number, the least scaled Jacobian of hexes and of the other cells, the distance of the boundary from the
triangles of the CAD as a part of the diagonal, and processor seconds. A model that is refused has the message in its row.
Meshes are checked by tests/checkers/meshstats.py. The last line has the means, beside the goal of 94 % of the volume.

HexMe (cgg-bern/hex-me-if-you-can, folder original/) has 62 such models; frame-field methods mesh up to 58 % of them.
"""
import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))
CHECK = os.path.join(ROOT, "tests", "checkers", "meshstats.py")
ENDINGS = (".step", ".stp", ".brep", ".iges", ".igs", ".fcstd", ".geo")
GOAL = 94.0


class Refused(Exception):
    pass


def run(command, limit=None):
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        raise Refused(f"{os.path.basename(command[0])}: no end within {limit} seconds")
    if done.returncode != 0:
        raise Refused((done.stderr.strip().splitlines() or [f"{command[0]}: status {done.returncode}"])[-1])
    return done.stdout, [line for line in done.stderr.splitlines() if "warning" in line]


def cad_of(path, folder):
    """The model as tessellate takes it."""
    if not path.lower().endswith(".geo"):
        return path
    target = os.path.join(folder, "model.brep")
    if os.path.exists(target):
        os.remove(target)
    run(["gmsh", "-0", path, "-o", target], 300)
    if not os.path.exists(target):
        raise Refused("gmsh writes no BREP of it: it is no model of OpenCASCADE")
    return target


def mesh(path, folder, args):
    """One row of the table."""
    file = lambda name: os.path.join(folder, name)
    tool = lambda name: os.path.join(BIN, name)
    threads = ["--threads", str(args.threads)] if args.threads else []
    size = ["--size", args.size] if args.size else []
    join = (["--join"] if args.join else []) + (["--overlaps", args.overlaps] if args.overlaps else [])
    short = ["--short-features", args.short_features] if args.short_features else []
    warnings = run([tool("tessellate"), cad_of(path, folder), *join, "-o", file("surface.tar")], args.limit)[1]
    warnings += run([tool("tetmesh"), file("surface.tar"), *size, *short, *threads, "--stats", file("tetmesh.json"), "-o", file("mesh.tar")], args.limit)[1]
    run([tool("findhex"), file("mesh.tar"), *threads, "-o", file("candidates.tar")], args.limit)
    run([tool("buildgraph"), file("candidates.tar"), *threads, "-o", file("graph.tar")], args.limit)
    run([tool("initsol"), file("graph.tar"), *threads, "--time-limit", str(args.search), "-o", file("first.tar")], args.limit)
    run([tool("lns"), file("first.tar"), *threads, "--time-limit", str(args.search), "-o", file("chosen.tar")], args.limit)
    run([tool("assemble"), file("chosen.tar"), *threads, "--stats", file("assemble.json"), "-o", file("result.msh")], args.limit)
    checked = json.loads(run([sys.executable, CHECK, "--exact", "--json", file("result.msh")], args.limit)[0])
    if not checked["is_conforming"] or checked["inverted_cells"] or checked["invalid_hexes"]:
        raise Refused(f"NOT VALID by tests/checkers/meshstats.py: {checked}")
    with open(file("assemble.json")) as data:
        made = json.load(data)
    with open(file("tetmesh.json")) as data:
        tets = json.load(data)
    cells = made["cells"]
    least = lambda kinds: min((cells[k]["scaled_jacobian"]["least"] for k in kinds if cells.get(k, {}).get("count")), default=float("nan"))
    return {"volume": 100 * cells["hex"]["share_of_volume"], "number": 100 * cells["hex"]["share_of_number"], "hexes": cells["hex"]["count"],
            "least_hex": least(("hex",)), "least_other": least(("prism", "pyramid", "tet")), "size": tets["size"],
            "deviation": made["boundary"]["greatest_deviation"] / tets["size"], "regions": tets["regions"],
            "warnings": warnings}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--only", default="", help="models with this in their name")
    parser.add_argument("--size", help="tetmesh's --size [its own]")
    parser.add_argument("--search", type=float, default=10, help="seconds of initsol, and of lns")
    parser.add_argument("--threads", type=int, help="of each tool")
    parser.add_argument("--join", action="store_true", help="bodies that touch share their faces")
    parser.add_argument("--overlaps", help="tessellate's --overlaps, which also joins bodies that touch")
    parser.add_argument("--short-features", help="tetmesh's --short-features [0]")
    parser.add_argument("--limit", type=float, default=1800, help="seconds after which a stage is given up")
    args = parser.parse_args()
    found = sorted(os.path.join(folder, name) for folder, _, names in os.walk(args.folder) for name in names
                   if name.lower().endswith(ENDINGS) and args.only in name)
    if not found:
        sys.exit(f"{args.folder}: no {', '.join(ENDINGS)}")
    if not shutil.which("gmsh"):
        found = [path for path in found if not path.lower().endswith(".geo")]
    print("| model | hexes | volume % | number % | least hex | least other | off by (sizes) | regions | cpu s | |")
    print("|---|---|---|---|---|---|---|---|---|---|", flush=True)
    rows = []
    for path in found:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        name = os.path.splitext(os.path.basename(path))[0]
        with tempfile.TemporaryDirectory() as folder:
            try:
                row = mesh(path, folder, args)
            except Refused as refusal:
                print(f"| {name} | | | | | | | | | {refusal} |", flush=True)
                continue
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        rows.append(row)
        note = "; ".join(w.split("warning: ", 1)[-1].split(": ", 1)[-1] for w in row["warnings"])
        print(f"| {name} | {row['hexes']} | {row['volume']:.1f} | {row['number']:.1f} | {row['least_hex']:.2f} | {row['least_other']:.3f} "
              f"| {row['deviation']:.2f} | {row['regions']} | {seconds:.0f} | {note} |", flush=True)
    mean = lambda key: sum(row[key] for row in rows) / max(1, len(rows))
    print(f"\n{len(rows)} of {len(found)} meshed; hexes have {mean('volume'):.1f} % of the volume in the mean (goal {GOAL}), {mean('number'):.1f} % by number")


if __name__ == "__main__":
    main()
