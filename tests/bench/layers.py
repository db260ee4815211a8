#!/usr/bin/python3
"""layers.py [--models NAME...] [--layers N] [--share S] [--growth G] - layers at the walls of real models, beside
snappyHexMesh's on the same surfaces and heights.

Five layers on all of the boundary, together half as high as a cell (--share). Goals: all layers on 98 % of the area of the
walls; checkMesh finds the mesh well, its aspect ratio apart; layers take at most half of the time of assemble without them.
checkMesh and snappyHexMesh come with OpenFOAM; without it their columns are empty. `pipe-t` needs gmsh."""
import argparse
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile

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
}
PIPE_T = """SetFactory("OpenCASCADE");
Cylinder(1) = {-3, 0, 0, 6, 0, 0, 1}; Cylinder(2) = {0, 0, 0, 0, 0, 3, 0.7};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.MeshSizeMax = 0.15; Mesh.MeshSizeFromCurvature = 40; Mesh.Binary = 1;
"""
HEAD = "FoamFile { version 2.0; format ascii; class dictionary; object dictionary; }\n"


def run(command, **options):
    """What a command says, and the seconds of processor time that it takes: others may use the machine, too."""
    seconds = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    start = seconds()
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    return done, seconds() - start


def tool(name):
    return os.path.join(BIN, name)


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(text)


def make_case(case):
    write(f"{case}/system/controlDict", HEAD + "application snappyHexMesh; startFrom startTime; startTime 0; stopAt endTime; "
          "endTime 1; deltaT 1; writeControl timeStep; writeInterval 1; writePrecision 12;")
    write(f"{case}/system/fvSchemes", HEAD + "ddtSchemes { default steadyState; } gradSchemes { default Gauss linear; } "
          "divSchemes { default none; } laplacianSchemes { default Gauss linear corrected; } "
          "interpolationSchemes { default linear; } snGradSchemes { default corrected; }")
    write(f"{case}/system/fvSolution", HEAD)
    os.makedirs(f"{case}/constant", exist_ok=True)


def check_mesh(case):
    """What checkMesh says: a word, the faces that are severely non-orthogonal, and the greatest angle."""
    if shutil.which("checkMesh") is None:
        return "", "", ""
    text = run(["checkMesh", "-case", case])[0].stdout
    failed = [line for line in text.splitlines() if line.startswith(" ***") and "aspect" not in line.lower()]
    severe = re.search(r"severely non-orthogonal \(> 70 degrees\) faces: (\d+)", text)
    angle = re.search(r"Mesh non-orthogonality Max: ([\d.]+)", text)
    return ("ok" if not failed else f"{len(failed)} failed", severe[1] if severe else "0", angle[1][:4] if angle else "")


def surface_of(model, folder):
    if model != "pipe-t":
        return os.path.join(MODELS, model)
    if shutil.which("gmsh") is None:
        return None
    write(f"{folder}/pipe.geo", PIPE_T)
    run(["gmsh", "-2", f"{folder}/pipe.geo", "-o", f"{folder}/pipe.stl", "-format", "stl"], check=True)
    return f"{folder}/pipe.stl"


def snappy(folder, surface, size, args, first):
    """The share of the layers' cells that snappyHexMesh adds, its share of the height, and checkMesh's findings."""
    case = f"{folder}/snappy"
    make_case(case)
    os.makedirs(f"{case}/constant/triSurface", exist_ok=True)
    import meshio
    import numpy as np
    mesh = meshio.read(surface)
    meshio.write_points_cells(f"{case}/constant/triSurface/part.stl", mesh.points, {"triangle": mesh.cells_dict["triangle"]})
    low, high = mesh.points.min(0) - 1.5 * size, mesh.points.max(0) + 1.5 * size
    counts = np.ceil((high - low) / size).astype(int)
    high = low + counts * size
    corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    vertices = " ".join(f"({x} {y} {z})" for z in (low[2], high[2]) for x, y in corners)
    write(f"{case}/system/blockMeshDict", HEAD + f"vertices ({vertices}); blocks (hex (0 1 2 3 4 5 6 7) "
          f"({counts[0]} {counts[1]} {counts[2]}) simpleGrading (1 1 1)); edges (); boundary (); mergePatchPairs ();")
    write(f"{case}/system/surfaceFeatureExtractDict", HEAD + "part.stl { extractionMethod extractFromSurface; "
          "extractFromSurfaceCoeffs { includedAngle 140; } writeObj no; }")
    inside = inner_point(folder, size)
    write(f"{case}/system/snappyHexMeshDict", HEAD + f"""
castellatedMesh true; snap true; addLayers true;
geometry {{ part.stl {{ type triSurfaceMesh; name part; }} }}
castellatedMeshControls {{ maxLocalCells 10000000; maxGlobalCells 20000000; minRefinementCells 0; nCellsBetweenLevels 2;
  features ({{ file "part.eMesh"; level 0; }}); refinementSurfaces {{ part {{ level (0 0); }} }} resolveFeatureAngle 40;
  refinementRegions {{ }} locationInMesh ({inside[0]} {inside[1]} {inside[2]}); allowFreeStandingZoneFaces true; }}
snapControls {{ nSmoothPatch 3; tolerance 2.0; nSolveIter 50; nRelaxIter 5; nFeatureSnapIter 10; implicitFeatureSnap false;
  explicitFeatureSnap true; multiRegionFeatureSnap false; }}
addLayersControls {{ relativeSizes false; layers {{ part {{ nSurfaceLayers {args.layers}; }} }} expansionRatio {args.growth};
  firstLayerThickness {first}; minThickness {first / 10}; nGrow 0; featureAngle 170; slipFeatureAngle 30; nRelaxIter 5;
  nSmoothSurfaceNormals 1; nSmoothNormals 3; nSmoothThickness 10; maxFaceThicknessRatio 0.5; maxThicknessToMedialRatio 0.3;
  minMedianAxisAngle 90; minMedialAxisAngle 90; nBufferCellsNoExtrude 0; nLayerIter 50; nRelaxedIter 20; }}
meshQualityControls {{ maxNonOrtho 65; maxBoundarySkewness 20; maxInternalSkewness 4; maxConcave 80; minVol 1e-30;
  minTetQuality 1e-30; minArea -1; minTwist 0.02; minDeterminant 0.001; minFaceWeight 0.05; minVolRatio 0.01;
  minTriangleTwist -1; nSmoothScale 4; errorReduction 0.75; relaxed {{ maxNonOrtho 75; }} }}
writeFlags (); mergeTolerance 1e-6;
""")
    seconds = 0
    for command in ("surfaceFeatureExtract", "blockMesh", "snappyHexMesh -overwrite"):
        done, took = run(command.split() + ["-case", case], timeout=1800)
        seconds += took
        if done.returncode != 0:
            return ["failed", "", f"{seconds:.0f}", *[""] * 4]
    added = re.findall(r"Added \d+ out of \d+ cells \(([\d.]+)%\)", done.stdout)
    height = re.findall(r"^part +\d+ +[\d.]+ +[-\d.e+]+ +([\d.]+)", done.stdout, re.M)
    return [f"{float(added[-1]) if added else 0:.1f}", f"{float(height[-1]) if height else 0:.1f}", f"{seconds:.0f}", *check_mesh(case)]


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
        surface = surface_of(model, folder)
        if surface is None or not os.path.exists(surface):
            print(f"{model:14} skipped", flush=True)
            return True
        search = ["initsol", "--iterations", "200000"]
        pipe = " | ".join([f"{tool('tetmesh')} -q {surface} --size {size}", f"{tool('findhex')} -q", f"{tool('buildgraph')} -q",
                           f"{tool(search[0])} -q {' '.join(search[1:])} -o {folder}/part.tar"])
        subprocess.run(["bash", "-o", "pipefail", "-c", pipe], check=True)
        common = [tool("assemble"), "-q", "--threads", "1", f"{folder}/part.tar", "--stats", f"{folder}/stats.json"]
        plain = run(common + ["-o", f"{folder}/plain.vtu"])[1]
        case = f"{folder}/case"
        make_case(case)
        asked = ["--boundary-layers", f"all={n}", "--first-height", str(first), "--growth", str(growth)]
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
        if shutil.which("snappyHexMesh") and not args.alone:
            cells += snappy(folder, surface, size, args, first)
        print(f"{model:14} " + " ".join(f"{cell:>8}" for cell in cells), flush=True)
        return layers["share_of_area_with_layers"] >= 0.98 and checked[0] in ("", "ok") and extra <= 0.5


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--models", nargs="*", default=list(SIZES))
    parser.add_argument("--layers", type=int, default=5)
    parser.add_argument("--share", type=float, default=0.5, help="of the size, by all layers together")
    parser.add_argument("--growth", type=float, default=1.2)
    parser.add_argument("--alone", action="store_true", help="without snappyHexMesh")
    args = parser.parse_args()
    titles = "all-n all-h some least-h leastSJ meanSJ seconds extra check severe angle".split()
    if shutil.which("snappyHexMesh") and not args.alone:
        titles += "sn:cells sn:hgt sn:sec sn:check severe angle".split()
    print(f"{'model':14} " + " ".join(f"{title:>8}" for title in titles), flush=True)
    good = [bench(model, args) for model in args.models]
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main()
