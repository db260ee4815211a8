#!/usr/bin/python3
"""bodies.py [--only WORD] [--cad FOLDER] [--rims] [--search SECONDS] [--threads N] - bodies that touch, against each of them alone.

Makes models of several bodies by gmsh's OpenCASCADE (its boolean fragments, so that bodies share their faces), runs them through
tessellate | tetmesh | findhex | buildgraph | initsol | lns | assemble, and each of their bodies by itself with the same options.
Prints a table: the hexes' share of each body's volume in the joined mesh and in its own, in percent. Meshes are checked by
tests/checkers/meshstats.py --exact. The goal: no body loses more than a point by being joined, and so says the last line.

--cad: also joins each STEP file of a folder (parts of HexMe, as tests/data/simp.step) with a plate under it, and with a block in
which its lower fifth sits.

--rims: also meshes each body with the curves that the others print on it: its triangles, tags and curves as they are in the joined
surface. What it loses against the body alone is the price of these curves, and not of meshing bodies together.
"""
import argparse
import json
import os
import subprocess
import sys
import tarfile
import tempfile
from io import BytesIO

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))
CHECK = os.path.join(ROOT, "tests", "checkers", "meshstats.py")
GOAL = 1.0

# Each: the size, and gmsh's commands. Bodies are numbered from 1 in the fragments' order.
MODELS = {
    "box split in two": (0.1, "Box(1) = {0,0,0, 1,1,1}; Box(2) = {1,0,0, 0.73,1,1};"),
    "box split askew": (0.1, "Box(1) = {0,0,0, 2,1,1}; Box(2) = {-1,-1,-1, 2,3,3}; Rotate{{0,1,0},{0,0,0.5},0.3}{Volume{2};}"
                             " BooleanIntersection{Volume{1};}{Volume{2};Delete;} "),
    "small box on a large one": (0.1, "Box(1) = {0,0,0, 2,2,1}; Box(2) = {0.57,0.61,1, 0.83,0.79,0.7};"),
    "stepped cylinder": (0.12, "Cylinder(1) = {0,0,0, 0,0,1, 1}; Cylinder(2) = {0,0,1, 0,0,0.8, 0.62};"),
    "spheres in a block": (0.1, "Box(1) = {0,0,0, 2,1,1}; Sphere(2) = {0.55,0.5,0.5, 0.32}; Sphere(3) = {1.45,0.5,0.5, 0.32};"),
    "half a sphere on a block": (0.1, "Box(1) = {0,0,0, 1.4,1.4,0.8}; Sphere(2) = {0.7,0.7,0.8, 0.5};"),
    "two plates and a bolt": (0.15, "Box(1) = {0,0,0, 3,2,0.6}; Box(2) = {0,0,0.6, 3,2,0.6}; Cylinder(3) = {1.5,1,-0.3, 0,0,1.8, 0.4};"
                                    " Cylinder(4) = {1.5,1,1.2, 0,0,0.4, 0.7}; Cylinder(5) = {1.5,1,-0.4, 0,0,0.4, 0.7};"
                                    " BooleanUnion(6) = { Volume{3}; Delete; }{ Volume{4,5}; Delete; };"
                                    " BooleanDifference{ Volume{1,2}; Delete; }{ Volume{6}; }"),
    "pipe in its lining": (0.12, "Cylinder(1) = {0,0,0, 0,0,2, 1}; Cylinder(2) = {0,0,0, 0,0,2, 0.7}; Cylinder(3) = {0,0,0, 0,0,2, 0.45};"
                                 " BooleanDifference(4) = {Volume{2};}{Volume{3};}; BooleanDifference(5) = {Volume{1};Delete;}{Volume{2};Delete;};"
                                 " Recursive Delete{Volume{3};}"),
}
# A STEP file on a plate, and with its lower fifth in a block.
CAD = 'v() = ShapeFromFile("%s"); b() = BoundingBox Volume{v()}; dx = b(3)-b(0); dy = b(4)-b(1); dz = b(5)-b(2); low = Round(1e4*b(2))/1e4;'
ON_A_PLATE = CAD + " Box(1000) = {b(0)-dx/10, b(1)-dy/10, low-dz/5, 1.2*dx, 1.2*dy, dz/5};"
IN_A_BLOCK = CAD + " Box(1000) = {b(0)-dx/10, b(1)-dy/10, low-dz/5, 1.2*dx, 1.2*dy, 0.4*dz}; BooleanDifference{ Volume{1000}; Delete; }{ Volume{v()}; }"


class Failed(Exception):
    pass


def run(command, limit=900):
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        raise Failed(f"{os.path.basename(command[0])}: no end within {limit} seconds")
    if done.returncode != 0:
        raise Failed((done.stderr.strip().splitlines() or [f"{command[0]}: status {done.returncode}"])[-1])
    return done.stdout, [line.split("warning: ", 1)[1] for line in done.stderr.splitlines() if "warning: " in line]


def write_model(commands, body, folder):
    """A BREP of the fragments, or of one of them; None where there are fewer."""
    script, target = os.path.join(folder, "model.geo"), os.path.join(folder, "model.brep")
    text = f'SetFactory("OpenCASCADE");\n{commands}\nBooleanFragments{{ Volume{{:}}; Delete; }}{{}}\nall() = Volume{{:}};\nPrintf("bodies %g", #all());\n'
    if body is not None:
        text += f"others() = all(); others() -= {{all({body})}};\nIf (#others() > 0)\n  Recursive Delete{{ Volume{{others()}}; }}\nEndIf\n"
    with open(script, "w") as file:
        file.write(text)
    if os.path.exists(target):
        os.remove(target)
    output, _ = run(["gmsh", "-0", script, "-o", target], 120)
    if not os.path.exists(target):
        raise Failed("gmsh writes no BREP: " + output.strip().splitlines()[-1])
    return target, int(output.split("bodies ", 1)[1].split()[0])


def tet_volumes(points, tets):
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    return np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)) / 6


# Each kind of cell cut into tets; shares of the volume need no more.
CUTS = {
    "tets": [(0, 1, 2, 3)],
    "pyramids": [(0, 1, 2, 4), (0, 2, 3, 4)],
    "prisms": [(0, 1, 2, 3), (1, 2, 3, 4), (2, 3, 4, 5)],
    "hexes": [(0, 1, 3, 4), (1, 2, 3, 6), (1, 3, 4, 6), (1, 4, 5, 6), (3, 4, 6, 7)],
}


def shares(bundle):
    """Of each region, its volume and the hexes' part of it."""
    arrays = {}
    with tarfile.open(bundle) as tar:
        for member in tar.getmembers():
            if member.name.startswith("result/") and member.name.endswith(".npy"):
                arrays[member.name[len("result/"):-len(".npy")]] = np.load(BytesIO(tar.extractfile(member).read()))
    volume, of_hexes = {}, {}
    for kind, cuts in CUTS.items():
        cells = arrays.get(kind)
        if cells is None or len(cells) == 0:
            continue
        sizes = sum(tet_volumes(arrays["points"], cells[:, list(cut)]) for cut in cuts)
        for region in np.unique(arrays[f"{kind}_tags"]):
            here = sizes[arrays[f"{kind}_tags"] == region].sum()
            volume[int(region)] = volume.get(int(region), 0) + here
            if kind == "hexes":
                of_hexes[int(region)] = here
    return {region: (v, 100 * of_hexes.get(region, 0) / v) for region, v in volume.items()}


def mesh(model, size, folder, args, surface=None):
    """Of a model, or of a surface bundle."""
    file = lambda name: os.path.join(folder, name)
    tool = lambda name: os.path.join(BIN, name)
    threads = ["--threads", str(args.threads)] if args.threads else []
    if surface is None:
        surface = file("surface.tar")
        run([tool("tessellate"), model, "--join", "-o", surface])
    warnings = run([tool("tetmesh"), surface, "--size", str(size), *threads, "--stats", file("tetmesh.json"), "-o", file("mesh.tar")])[1]
    run([tool("findhex"), file("mesh.tar"), *threads, "-o", file("candidates.tar")])
    run([tool("buildgraph"), file("candidates.tar"), *threads, "-o", file("graph.tar")])
    run([tool("initsol"), file("graph.tar"), *threads, "--time-limit", str(args.search), "-o", file("first.tar")])
    run([tool("lns"), file("first.tar"), *threads, "--time-limit", str(args.search), "-o", file("chosen.tar")])
    run([tool("assemble"), file("chosen.tar"), *threads, "-o", file("result.tar")])
    run([tool("assemble"), file("chosen.tar"), *threads, "-o", file("result.msh")])
    checked = json.loads(run([sys.executable, CHECK, "--exact", "--json", file("result.msh")])[0])
    if not checked["is_conforming"] or checked["inverted_cells"] or checked["invalid_hexes"]:
        raise Failed(f"NOT VALID by tests/checkers/meshstats.py: {checked}")
    with open(file("tetmesh.json")) as stats:
        return shares(file("result.tar")), json.load(stats)["size"], warnings


def write_with_rims(joined, region, target):
    """A surface bundle of one body, cut out of that of all."""
    arrays = {}
    with tarfile.open(joined) as tar:
        for member in tar.getmembers():
            if member.name.startswith("surface/") and member.name.endswith(".npy"):
                arrays[member.name] = np.load(BytesIO(tar.extractfile(member).read()))
    sides = arrays["surface/sides.npy"]
    behind, before = sides[:, 0] == region, sides[:, 1] == region
    triangles = arrays["surface/triangles.npy"].copy()
    triangles[before] = triangles[before][:, ::-1]
    kept = behind | before
    triangles = triangles[kept]
    used, numbers = np.unique(triangles, return_inverse=True)
    number = np.full(len(arrays["surface/points.npy"]), -1, "<i4")
    number[used] = np.arange(len(used))
    edges = {frozenset(e) for t in triangles.tolist() for e in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
    on_it = np.array([frozenset(c) in edges for c in arrays["surface/curves.npy"].tolist()], bool)
    out = {
        "points": arrays["surface/points.npy"][used],
        "triangles": numbers.reshape(-1, 3).astype("<i4"),
        "triangle_tags": arrays["surface/triangle_tags.npy"][kept],
        "sides": np.tile(np.array([[1, 0]], "<i4"), (len(triangles), 1)),
        "curves": number[arrays["surface/curves.npy"][on_it]],
        "curve_tags": arrays["surface/curve_tags.npy"][on_it],
    }
    with tarfile.open(target, "w") as tar:
        for key, array in out.items():
            data = BytesIO()
            np.save(data, array)
            info = tarfile.TarInfo(f"surface/{key}.npy")
            info.size = data.tell()
            data.seek(0)
            tar.addfile(info, data)


def compare(name, size, commands, folder, args):
    """Prints a row for each body; returns the points that each gains by being joined."""
    model, count = write_model(commands, None, folder)
    joined, size, warnings = mesh(model, size, folder, args)
    os.rename(os.path.join(folder, "surface.tar"), os.path.join(folder, "joined.tar"))
    left = dict(joined)
    gains = []
    for body in range(count):
        alone, _, _ = mesh(write_model(commands, body, folder)[0], size, folder, args)
        ((volume, share),) = alone.values()
        # Both are known by their volume: no two bodies of a model that differ have the same one.
        region = min(left, key=lambda r: abs(left[r][0] - volume))
        gains.append(left[region][1] - share)
        rims = ""
        if args.rims:
            write_with_rims(os.path.join(folder, "joined.tar"), region, os.path.join(folder, "rims.tar"))
            ((_, with_rims),) = mesh(None, size, folder, args, os.path.join(folder, "rims.tar"))[0].values()
            rims = f" {with_rims:.1f} |"
        print(f"| {name} | {body + 1} | {share:.1f} |{rims} {left[region][1]:.1f} | {gains[-1]:+.1f} | {'; '.join(w.split(': ', 1)[-1] for w in warnings)} |", flush=True)
        del left[region]
    return gains


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="models with this in their name")
    parser.add_argument("--cad", help="folder of STEP files")
    parser.add_argument("--rims", action="store_true", help="also each body with the curves of the others")
    parser.add_argument("--search", type=float, default=2, help="seconds of initsol, and of lns")
    parser.add_argument("--threads", type=int, default=1, help="of each tool")
    args = parser.parse_args()
    models = dict(MODELS)
    if args.cad:
        for file in sorted(os.listdir(args.cad)):
            if file.endswith(".step"):
                path = os.path.abspath(os.path.join(args.cad, file))
                models[f"{file[:-5]} on a plate"] = (None, ON_A_PLATE % path)
                models[f"{file[:-5]} in a block"] = (None, IN_A_BLOCK % path)
    column, rule = (" with rims % |", "---|") if args.rims else ("", "")
    print(f"| model | body | alone % |{column} joined % | gain | |\n|---|---|---|{rule}---|---|---|", flush=True)
    gains = []
    for name, (size, commands) in models.items():
        if args.only not in name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                gains += compare(name, size or "2.5%", commands, folder, args)
            except Failed as failure:
                print(f"| {name} | | | | | {failure} |", flush=True)
                gains.append(-100.0)
    if not gains:
        sys.exit("no such model")
    verdict = "met" if min(gains) >= -GOAL else "missed"
    print(f"\n{len(gains)} bodies: {sum(g >= -GOAL for g in gains)} lose at most {GOAL:g} point by being joined, the worst gains {min(gains):+.1f}, "
          f"the mean {sum(gains) / len(gains):+.1f}: goal {verdict}")


if __name__ == "__main__":
    main()
