"""Cases of OpenFOAM for benches: what checkMesh says, and meshes of snappyHexMesh."""
import os
import re
import resource
import shutil
import subprocess

# Debian's; its programs find their own files by it.
os.environ.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")

HEAD = "FoamFile { version 2.0; format ascii; class dictionary; object dictionary; }\n"


def run(command, **options):
    """What a command says, and the seconds of processor time that it takes: others may use the machine, too."""
    seconds = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    start = seconds()
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    return done, seconds() - start


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


def write_solids(path, solids):
    """An ASCII STL file of named solids: by name, triangles of three points each."""
    with open(path, "w") as file:
        for name, triangles in solids.items():
            file.write(f"solid {name}\n")
            for triangle in triangles:
                file.write("facet normal 0 0 0\nouter loop\n")
                for point in triangle:
                    file.write("vertex %.12g %.12g %.12g\n" % tuple(point))
                file.write("endloop\nendfacet\n")
            file.write(f"endsolid {name}\n")


def check_mesh(case):
    """What checkMesh says: a word, the faces that are severely non-orthogonal, and the greatest angle."""
    return findings(report_on_mesh(case))


def report_on_mesh(case):
    """All that checkMesh says; nothing without it."""
    return run(["checkMesh", "-case", case])[0].stdout if shutil.which("checkMesh") else ""


def findings(text):
    """check_mesh() of what checkMesh has said."""
    if not text:
        return "", "", ""
    failed = [line for line in text.splitlines() if line.startswith(" ***") and "aspect" not in line.lower()]
    severe = re.search(r"severely non-orthogonal \(> 70 degrees\) faces: (\d+)", text)
    angle = re.search(r"Mesh non-orthogonality Max: ([\d.]+)", text)
    return ("ok" if not failed else f"{len(failed)} failed", severe[1] if severe else "0", angle[1][:4] if angle else "")


def put_surface(case, surface, size):
    """The surface as snappy() looks for it. Returns the corners of a box around it, a size and a half away."""
    import meshio
    mesh = meshio.read(surface)
    os.makedirs(f"{case}/constant/triSurface", exist_ok=True)
    meshio.write_points_cells(f"{case}/constant/triSurface/part.stl", mesh.points, {"triangle": mesh.cells_dict["triangle"]})
    return mesh.points.min(0) - 1.5 * size, mesh.points.max(0) + 1.5 * size


def snappy(case, box, size, inside, patch, layers, first, growth):
    """Runs snappyHexMesh on constant/triSurface/part.stl in cubes of `size` in the box (two corners), with layers on the
    patches that match `patch`. The share of the layers' cells that it adds, that of their height, both in percent, and
    the seconds; None for the first two if it fails."""
    low, high = box
    counts = [-int(-(b - a) // size) for a, b in zip(low, high)]
    high = [a + n * size for a, n in zip(low, counts)]
    corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    vertices = " ".join(f"({x} {y} {z})" for z in (low[2], high[2]) for x, y in corners)
    write(f"{case}/system/blockMeshDict", HEAD + f"vertices ({vertices}); blocks (hex (0 1 2 3 4 5 6 7) "
          f"({counts[0]} {counts[1]} {counts[2]}) simpleGrading (1 1 1)); edges (); boundary (); mergePatchPairs ();")
    write(f"{case}/system/surfaceFeatureExtractDict", HEAD + "part.stl { extractionMethod extractFromSurface; "
          "extractFromSurfaceCoeffs { includedAngle 140; } writeObj no; }")
    write(f"{case}/system/snappyHexMeshDict", HEAD + f"""
castellatedMesh true; snap true; addLayers true;
geometry {{ part.stl {{ type triSurfaceMesh; name part; }} }}
castellatedMeshControls {{ maxLocalCells 10000000; maxGlobalCells 20000000; minRefinementCells 0; nCellsBetweenLevels 2;
  features ({{ file "part.eMesh"; level 0; }}); refinementSurfaces {{ part {{ level (0 0); }} }} resolveFeatureAngle 40;
  refinementRegions {{ }} locationInMesh ({inside[0]} {inside[1]} {inside[2]}); allowFreeStandingZoneFaces true; }}
snapControls {{ nSmoothPatch 3; tolerance 2.0; nSolveIter 50; nRelaxIter 5; nFeatureSnapIter 10; implicitFeatureSnap false;
  explicitFeatureSnap true; multiRegionFeatureSnap false; }}
addLayersControls {{ relativeSizes false; layers {{ "{patch}" {{ nSurfaceLayers {layers}; }} }} expansionRatio {growth};
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
            return None, None, seconds
    added = re.findall(r"Added \d+ out of \d+ cells \(([\d.]+)%\)", done.stdout)
    height = re.findall(r"^part\w* +\d+ +[\d.]+ +[-\d.e+]+ +([\d.]+)", done.stdout, re.M)
    return float(added[-1]) if added else 0, float(height[-1]) if height else 0, seconds
