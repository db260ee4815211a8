#!/usr/bin/python3
"""layers.py [--models NAME...] [--layers N] [--share S] [--growth G] [--half] [--scans FOLDER] - layers at the walls of real
models, beside snappyHexMesh's on the same surfaces and heights.

Five layers on all of the boundary, together half as high as a cell (--share). Goals: all layers on 98 % of the area of the
walls; checkMesh finds the mesh well, its aspect ratio apart; layers take at most half of the time of assemble without them.
checkMesh and snappyHexMesh come with OpenFOAM; without it their columns are empty. `pipe-t` needs gmsh. `bunny` is a surface of
the public repository CMU-CBML/HybridOctree_Hex: --scans names the folder that has bunny_tri.raw. --half puts layers on one
half of the surface's triangles alone, by the coordinate x of their middles: most of its rim is smooth and jagged."""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile

import openfoam
from openfoam import check_mesh, make_case, run

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))
MODELS = os.path.join(os.path.dirname(ROOT), "shared", "models")
SIZES = {
    "mambo-s1.stl": 2.3,
    "mambo-s27.stl": 1.42,
    "mambo-m1.stl": 2.2,
    "spot.obj": 0.04295,
    "blub.off": 0.05,
    "pipe-t": 0.16,
    "bunny": 0.0392,
}
PIPE_T = """SetFactory("OpenCASCADE");
Cylinder(1) = {-3, 0, 0, 6, 0, 0, 1}; Cylinder(2) = {0, 0, 0, 0, 0, 3, 0.7};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.MeshSizeMax = 0.15; Mesh.MeshSizeFromCurvature = 40; Mesh.Binary = 1;
"""


def tool(name):
    return os.path.join(BIN, name)


def surface_of(model, folder, scans):
    if model == "bunny":
        return off_of_raw(f"{scans}/bunny_tri.raw", f"{folder}/bunny.off") if scans else None
    if model != "pipe-t":
        return os.path.join(MODELS, model)
    if shutil.which("gmsh") is None:
        return None
    openfoam.write(f"{folder}/pipe.geo", PIPE_T)
    run(["gmsh", "-2", f"{folder}/pipe.geo", "-o", f"{folder}/pipe.stl", "-format", "stl"], check=True)
    return f"{folder}/pipe.stl"


def off_of_raw(raw, off):
    """Points and triangles behind their numbers, as OFF."""
    words = open(raw).read().split()
    points, triangles = int(words[0]), int(words[1])
    places, corners = words[2:2 + 3 * points], words[2 + 3 * points:]
    with open(off, "w") as file:
        file.write(f"OFF\n{points} {triangles} 0\n")
        for i in range(points):
            file.write(" ".join(places[3 * i:3 * i + 3]) + "\n")
        for i in range(triangles):
            file.write("3 " + " ".join(corners[3 * i:3 * i + 3]) + "\n")
    return off


def write_half(surface, stl):
    """The surface as two solids, half and rest, divided at the middle triangle in the direction x."""
    import meshio
    import numpy as np
    mesh = meshio.read(surface)
    triangles = mesh.points[mesh.cells_dict["triangle"]]
    along = triangles.mean(1)[:, 0]
    is_half = along > np.median(along)
    openfoam.write_solids(stl, {"half": triangles[is_half], "rest": triangles[~is_half]})


def snappy(folder, surface, size, args, first):
    """The share of the layers' cells that snappyHexMesh adds, its share of the height, and checkMesh's findings."""
    case = f"{folder}/snappy"
    make_case(case)
    box = openfoam.put_surface(case, surface, size)
    cells, height, seconds = openfoam.snappy(case, box, size, inner_point(folder, size), "part", args.layers, first, args.growth)
    if cells is None:
        return ["failed", "", f"{seconds:.0f}", *[""] * 4]
    return [f"{cells:.1f}", f"{height:.1f}", f"{seconds:.0f}", *check_mesh(case)]


def inner_point(folder, size):
    """The middle of a hex far from the boundary."""
    import meshio
    import numpy as np
    mesh = meshio.read(f"{folder}/plain.vtu")
    middles = mesh.points[mesh.cells_dict["hexahedron"]].mean(1)
    outer = mesh.points[np.unique(np.concatenate([mesh.cells_dict[k].ravel() for k in ("triangle", "quad") if k in mesh.cells_dict]))] \
        if "quad" in mesh.cells_dict else mesh.points
    sample = middles[:: max(1, len(middles) // 300)]
    distance = [np.min(np.linalg.norm(outer - m, axis=1)) for m in sample]
    return sample[int(np.argmax(distance))] + 0.0137 * size


def bench(model, args):
    size = SIZES[model]
    growth, n = args.growth, args.layers
    first = args.share * size / sum(growth**i for i in range(n))
    with tempfile.TemporaryDirectory() as folder:
        surface = surface_of(model, folder, args.scans)
        if surface is None or not os.path.exists(surface):
            print(f"{model:14} skipped", flush=True)
            return True
        if args.half:
            write_half(surface, f"{folder}/half.stl")
            surface = f"{folder}/half.stl"
        search = ["initsol", "--iterations", "200000"]
        pipe = " | ".join([f"{tool('tetmesh')} -q {surface} --size {size}", f"{tool('findhex')} -q", f"{tool('buildgraph')} -q",
                           f"{tool(search[0])} -q {' '.join(search[1:])} -o {folder}/part.tar"])
        subprocess.run(["bash", "-o", "pipefail", "-c", pipe], check=True)
        common = [tool("assemble"), "-q", "--threads", "1", f"{folder}/part.tar", "--stats", f"{folder}/stats.json"]
        plain = run(common + ["-o", f"{folder}/plain.vtu"])[1]
        case = f"{folder}/case"
        make_case(case)
        asked = ["--boundary-layers", f"half={n}" if args.half else f"all={n}", "--first-height", str(first), "--growth", str(growth)]
        done, layered = run(common + asked + ["-o", f"{case}/constant/polyMesh"])
        if done.returncode != 0:
            print(f"{model:14} {done.stdout}", flush=True)
            return False
        stats = json.load(open(f"{folder}/stats.json"))
        layers = stats["layers"]
        extra = max(0, layered - plain) / plain
        checked = check_mesh(case)
        cells = [f"{100 * layers['share_of_area_with_layers']:.2f}", f"{100 * layers['share_of_area_with_all_height']:.1f}",
                 f"{100 * layers['share_of_area_with_some_layers']:.2f}", f"{layers['least_share_of_height'] or 0:.2f}",
                 f"{layers['scaled_jacobian']['least'] or 0:.3f}", f"{layers['scaled_jacobian']['mean'] or 0:.3f}", f"{plain:.1f}",
                 f"{extra:.2f}", *checked]
        if shutil.which("snappyHexMesh") and not args.alone and not args.half:
            cells += snappy(folder, surface, size, args, first)
        print(f"{model:14} " + " ".join(f"{cell:>8}" for cell in cells), flush=True)
        return layers["share_of_area_with_layers"] >= 0.98 and checked[0] in ("", "ok") and extra <= 0.5


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--models", nargs="*", choices=list(SIZES), default=list(SIZES))
    parser.add_argument("--layers", type=int, default=5)
    parser.add_argument("--share", type=float, default=0.5, help="of the size, by all layers together")
    parser.add_argument("--growth", type=float, default=1.2)
    parser.add_argument("--scans", help="folder of bunny_tri.raw")
    parser.add_argument("--half", action="store_true", help="layers on half of the surface; without snappyHexMesh")
    parser.add_argument("--alone", action="store_true", help="without snappyHexMesh")
    args = parser.parse_args()
    titles = "all-n all-h some least-h leastSJ meanSJ seconds extra check severe angle".split()
    if shutil.which("snappyHexMesh") and not args.alone and not args.half:
        titles += "sn:cells sn:hgt sn:sec sn:check severe angle".split()
    print(f"{'model':14} " + " ".join(f"{title:>8}" for title in titles), flush=True)
    good = [bench(model, args) for model in args.models]
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main()
