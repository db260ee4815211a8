#!/usr/bin/python3
"""duct.py [--sizes S...] [--reference N...] [--keep FOLDER] - flow through a duct with a bend by simpleFoam: the shear at the
wall on a mesh with layers, on one without, and on snappyHexMesh's with the same layers, against a fine structured mesh.

A square duct of width 1 goes 2 straight, turns by 90 degrees with a mean radius of 1.5, and goes 3 straight; laminar, Reynolds
number 200, uniform inflow, so that layers of slow flow grow from the walls. Meshes have four layers at a growth of 1.2, the
first a fifth of the size. Per mesh: cells, non-hexes in percent of the number, iterations until all residuals are below 1e-6,
processor seconds of simpleFoam, the error of the shear at the wall (root of the mean square over the wall's area from 0.5
behind the inlet to 0.2 before the outlet, in percent of that of the shear), that of the force on this wall, and that of the
pressure at the inlet, both in percent; what checkMesh says, the faces over 70 degrees, and the greatest angle. Goal: with
layers the shear's error is below that without on as many cells, and below snappyHexMesh's.

The reference has N cells across the width (half of them, as it is symmetric), and finer ones at walls; of several the last is
the reference, the others show how far it has converged. Needs OpenFOAM: it is skipped without."""
import argparse
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import openfoam
from openfoam import HEAD, run, write
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))
BEFORE, BEHIND, MEAN_RADIUS, VISCOSITY = 2.0, 3.0, 1.5, 1 / 200
BEND = MEAN_RADIUS * math.pi / 2
LENGTH = BEFORE + BEND + BEHIND
LAYERS, GROWTH = 4, 1.2


def place(s, r, z):
    """The point at the length s along the middle and the distance r from the axis of the bend (1 inside, 2 outside)."""
    if s < BEFORE:
        return s - BEFORE, 2 - r, z
    angle = min((s - BEFORE) / MEAN_RADIUS, math.pi / 2)
    return r * math.sin(angle), 2 - r * math.cos(angle) + max(0, s - BEFORE - BEND), z


def length_and_radius(points):
    """place() the other way round, for arrays."""
    x, y = points[:, 0], points[:, 1]
    angle = np.clip(np.arctan2(x, 2 - y), 0, math.pi / 2)
    s = np.where(x < 0, BEFORE + x, np.where(y > 2, BEFORE + BEND + y - 2, BEFORE + MEAN_RADIUS * angle))
    r = np.where(x < 0, 2 - y, np.where(y > 2, x, np.hypot(x, 2 - y)))
    return s, r


def write_surface(path):
    """The duct as STL with the solids inlet, outlet and wall."""
    stations = [0, BEFORE, *(BEFORE + BEND * i / 90 for i in range(1, 90)), BEFORE + BEND, LENGTH]
    corners = [(1, 0), (2, 0), (2, 1), (1, 1)]
    rings = [[place(s, r, z) for r, z in corners] for s in stations]
    wall = []
    for a, b in zip(rings, rings[1:]):
        for i in range(4):
            j = (i + 1) % 4
            wall += [(a[i], b[j], a[j]), (a[i], b[i], b[j])]
    first, last = rings[0], rings[-1]
    solids = {"wall": wall, "inlet": [(first[0], first[1], first[2]), (first[0], first[2], first[3])],
              "outlet": [(last[0], last[2], last[1]), (last[0], last[3], last[2])]}
    openfoam.write_solids(path, solids)


def make_case(case, half):
    """A case without a mesh: laminar flow, and the shear at walls at its end."""
    write(f"{case}/system/controlDict", HEAD + """application simpleFoam; startFrom startTime; startTime 0; stopAt endTime;
endTime 3000; deltaT 1; writeControl timeStep; writeInterval 3000; writePrecision 10; writeFormat ascii;
functions { shear { type wallShearStress; libs (fieldFunctionObjects); patches (wall); writeControl writeTime; }
inflow { type surfaceFieldValue; libs (fieldFunctionObjects); fields (p); operation areaAverage; regionType patch; name inlet;
writeFields no; log yes; writeControl writeTime; } }
""")
    write(f"{case}/system/fvSchemes", HEAD + """ddtSchemes { default steadyState; } gradSchemes { default Gauss linear;
grad(U) cellLimited Gauss linear 1; } divSchemes { default none; div(phi,U) bounded Gauss linearUpwind grad(U);
div((nuEff*dev2(T(grad(U))))) Gauss linear; } laplacianSchemes { default Gauss linear limited 0.5; }
interpolationSchemes { default linear; } snGradSchemes { default limited 0.5; }
""")
    write(f"{case}/system/fvSolution", HEAD + """solvers { p { solver GAMG; smoother GaussSeidel; tolerance 1e-9; relTol 0.05; }
U { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-10; relTol 0.1; } }
SIMPLE { consistent yes; nNonOrthogonalCorrectors 1; residualControl { p 1e-6; U 1e-6; } }
relaxationFactors { equations { U 0.9; } }
""")
    write(f"{case}/constant/transportProperties", HEAD + f"transportModel Newtonian; nu {VISCOSITY};")
    write(f"{case}/constant/turbulenceProperties", HEAD + "simulationType laminar;")
    symmetry = "middle { type symmetryPlane; } " if half else ""
    write(f"{case}/0/U", HEAD.replace("dictionary; object dictionary", "volVectorField; object U") + f"""
dimensions [0 1 -1 0 0 0 0]; internalField uniform (0 0 0); boundaryField {{ inlet {{ type fixedValue; value uniform (1 0 0); }}
outlet {{ type zeroGradient; }} wall {{ type noSlip; }} {symmetry} }}
""")
    write(f"{case}/0/p", HEAD.replace("dictionary; object dictionary", "volScalarField; object p") + f"""
dimensions [0 2 -2 0 0 0 0]; internalField uniform 0; boundaryField {{ inlet {{ type zeroGradient; }}
outlet {{ type fixedValue; value uniform 0; }} wall {{ type zeroGradient; }} {symmetry} }}
""")


def write_structured(case, across):
    """The dictionary of blockMesh: half of the duct, below its middle."""
    columns = [[place(s, r, z) for r in (1, 2) for z in (0, 0.5)] for s in (0, BEFORE, BEFORE + BEND, LENGTH)]
    points = [point for column in columns for point in column]
    along = [round(1.3 * across * length) for length in (BEFORE, BEND, BEHIND)]
    graded = "((0.5 0.5 5) (0.5 0.5 0.2))"
    blocks, arcs, walls = [], [], []
    for i, n in enumerate(along):
        a, b = 4 * i, 4 * i + 4
        # Along, then from outside inwards, then up.
        blocks.append(f"hex ({a + 2} {b + 2} {b} {a} {a + 3} {b + 3} {b + 1} {a + 1}) ({n} {across} {across // 2}) "
                      f"simpleGrading (1 {graded} 5)")
        walls += [f"({a + 2} {b + 2} {b + 3} {a + 3})", f"({a} {b} {b + 1} {a + 1})", f"({a + 2} {b + 2} {b} {a})"]
    for k, (r, z) in enumerate([(1, 0), (1, 0.5), (2, 0), (2, 0.5)]):
        x, y, _ = place(BEFORE + BEND / 2, r, z)
        arcs.append(f"arc {4 + k} {8 + k} ({x} {y} {z})")
    middles = " ".join(f"({4 * i + 3} {4 * i + 7} {4 * i + 5} {4 * i + 1})" for i in range(3))
    write(f"{case}/system/blockMeshDict", HEAD + f"""
vertices ({" ".join("(%.12g %.12g %.12g)" % point for point in points)}); blocks ({" ".join(blocks)}); edges ({" ".join(arcs)});
boundary ( inlet {{ type patch; faces ((0 1 3 2)); }} outlet {{ type patch; faces ((12 13 15 14)); }}
  wall {{ type wall; faces ({" ".join(walls)}); }} middle {{ type symmetryPlane; faces ({middles}); }} );
""")


def patches_of(case):
    """By name: the number of its faces and the first of them."""
    text = open(f"{case}/constant/polyMesh/boundary").read()
    found = re.findall(r"(\w+)\s*\{[^}]*?nFaces\s+(\d+);\s*startFace\s+(\d+);", text)
    return {name: (int(faces), int(first)) for name, faces, first in found}


def body(path):
    """What stands between the outer brackets of a list of OpenFOAM."""
    text = open(path).read()
    text = text[text.index("}", text.index("FoamFile")) + 1:]
    text = re.sub(r"//.*", "", text)
    return text[text.index("(") + 1:text.rindex(")")]


def wall_faces(case):
    """Middles and areas of the faces of the patch `wall`."""
    points = np.array(re.findall(r"\(([^()]*)\)", body(f"{case}/constant/polyMesh/points")))
    points = np.array([[float(v) for v in point.split()] for point in points])
    count, first = patches_of(case)["wall"]
    faces = re.findall(r"\d+\s*\(([^()]*)\)", body(f"{case}/constant/polyMesh/faces"))[first:first + count]
    middles, areas = [], []
    for face in faces:
        p = points[[int(v) for v in face.split()]]
        centre = p.mean(0)
        cuts = np.cross(p - centre, np.roll(p, -1, 0) - centre) / 2
        weights = np.linalg.norm(cuts, axis=1)
        thirds = (p + np.roll(p, -1, 0) + centre) / 3
        middles.append((thirds * weights[:, None]).sum(0) / weights.sum())
        areas.append(np.linalg.norm(cuts.sum(0)))
    return np.array(middles), np.array(areas)


def patch_vectors(path, patch):
    """The vectors of a field on a patch."""
    text = open(path).read()
    start = text.index(f"    {patch}\n", text.index("boundaryField"))
    vectors = re.findall(r"\(([^()]+)\)", text[start:text.index("\n    }", start)])
    return np.array([[float(v) for v in vector.split()] for vector in vectors])


class Flow:
    """What simpleFoam finds on a case's mesh."""

    def __init__(self, case):
        done, self.seconds = run(["simpleFoam", "-case", case], timeout=7200)
        if done.returncode != 0 or "Time = " not in done.stdout:
            raise RuntimeError(f"simpleFoam failed in {case}: {done.stdout[-400:]}")
        self.iterations = int(re.findall(r"^Time = (\d+)", done.stdout, re.M)[-1])
        self.converged = "solution converged" in done.stdout
        latest = f"{case}/{self.iterations}"
        self.middles, self.areas = wall_faces(case)
        shear = patch_vectors(f"{latest}/wallShearStress", "wall")
        self.shear = np.linalg.norm(shear, axis=1)
        self.cells = int(re.search(r"nCells:\s*(\d+)", open(f"{case}/constant/polyMesh/owner").read())[1])
        self.pressure = float(re.findall(r"areaAverage\(inlet\) of p = (\S+)", done.stdout)[-1])

    def sides(self):
        """For each of the walls inside, outside and below: its faces, and their two coordinates. The wall above is below's
        mirror image."""
        s, r = length_and_radius(self.middles)
        z = np.minimum(self.middles[:, 2], 1 - self.middles[:, 2])
        distances = np.stack([np.abs(r - 1), np.abs(r - 2), z])
        nearest = distances.argmin(0)
        used = (s > 0.5) & (s < LENGTH - 0.2)
        return [(used & (nearest == side), np.column_stack([s, z if side < 2 else r])) for side in range(3)]


def shear_errors(flow, reference):
    """Of the shear and of the force, in percent."""
    square = square_of_shear = force = force_of_reference = 0
    for (own, at), (other, places) in zip(flow.sides(), reference.sides()):
        inside = LinearNDInterpolator(places[other], reference.shear[other])(at[own])
        beside = NearestNDInterpolator(places[other], reference.shear[other])(at[own])
        expected = np.where(np.isnan(inside), beside, inside)
        areas = flow.areas[own]
        square += (areas * (flow.shear[own] - expected) ** 2).sum()
        square_of_shear += (areas * expected**2).sum()
        force += (areas * flow.shear[own]).sum()
        force_of_reference += (areas * expected).sum()
    return 100 * math.sqrt(square / square_of_shear), 100 * (force / force_of_reference - 1)


def tool(name):
    return os.path.join(BIN, name)


def hexpipe(folder, case, size, options):
    """A mesh of ours in the case; the share of its number that is no hex."""
    write_surface(f"{folder}/duct.stl")
    pipe = " | ".join([f"{tool('tetmesh')} -q {folder}/duct.stl --size {size}", f"{tool('findhex')} -q", f"{tool('buildgraph')} -q",
                       f"{tool('initsol')} -q",
                       f"{tool('assemble')} -q --solver openfoam {options} --stats {case}/stats.json -o {case}/constant/polyMesh"])
    subprocess.run(["bash", "-o", "pipefail", "-c", pipe], check=True)


def as_wall(case):
    """The shear is found on patches of the type `wall` alone."""
    path = f"{case}/constant/polyMesh/boundary"
    text = open(path).read()
    text = re.sub(r"(wall\s*\{[^}]*type\s+)patch;", r"\1wall;", text)
    write(path, text)


def name_patches(case):
    """snappyHexMesh puts the surface's name before those of its solids."""
    path = f"{case}/constant/polyMesh/boundary"
    write(path, open(path).read().replace("part_", ""))


def non_hexes(text):
    """In percent of the number, by what checkMesh says."""
    count = {name: int(n) for name, n in re.findall(r"^ +(hexahedra|prisms|wedges|pyramids|tet wedges|tetrahedra|polyhedra): +(\d+)",
                                                    text, re.M)}
    return 100 * (1 - count["hexahedra"] / sum(count.values()))


def report(name, case, reference):
    flow = Flow(case)
    shear, force = shear_errors(flow, reference) if reference else (0, 0)
    pressure = 100 * (flow.pressure / reference.pressure - 1) if reference else 0
    checked = openfoam.report_on_mesh(case)
    cells = [f"{flow.cells}", f"{non_hexes(checked):.1f}", f"{flow.iterations}{'' if flow.converged else '+'}", f"{flow.seconds:.0f}",
             f"{shear:.2f}", f"{force:+.2f}", f"{pressure:+.2f}", *openfoam.findings(checked)]
    print(f"{name:24} " + " ".join(f"{cell:>9}" for cell in cells), flush=True)
    return flow, shear


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--sizes", type=float, nargs="+", default=[0.125, 0.0833333])
    parser.add_argument("--reference", type=int, nargs="+", default=[24, 48])
    parser.add_argument("--keep", help="folder for the cases")
    args = parser.parse_args()
    if shutil.which("simpleFoam") is None:
        print("skipped: needs OpenFOAM")
        return
    folder = args.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    try:
        titles = "cells non-hex% iter seconds shear% force% pressure% check severe angle".split()
        print(f"{'mesh':24} " + " ".join(f"{title:>9}" for title in titles), flush=True)
        references = []
        for across in args.reference:
            case = f"{folder}/structured-{across}"
            make_case(case, half=True)
            write_structured(case, across)
            run(["blockMesh", "-case", case], check=True)
            references.append((across, case, Flow(case)))
        reference = references[-1][2]
        for across, case, flow in references:
            shear, force = shear_errors(flow, reference)
            print(f"{f'structured, {across} across':24} {2 * flow.cells:9} {'0.0':>9} {flow.iterations:9} {flow.seconds:9.0f} {shear:9.2f} "
                  f"{force:+9.2f} {100 * (flow.pressure / reference.pressure - 1):+9.2f}", flush=True)
        good = True
        for size in args.sizes:
            first = size / 5
            layers = f"--boundary-layers wall={LAYERS} --first-height {first} --growth {GROWTH}"
            errors, cells = {}, {}
            for name, options in (("without", ""), ("with layers", layers), ("as many without", "")):
                case = f"{folder}/{name.replace(' ', '-')}-{size}"
                make_case(case, half=False)
                own_size = size if name != "as many without" else size * (cells["without"] / cells["with layers"]) ** (1 / 3)
                hexpipe(folder, case, own_size, options)
                as_wall(case)
                flow, errors[name] = report(f"{name}, {own_size:.4g}", case, reference)
                cells[name] = flow.cells
            case = f"{folder}/snappy-{size}"
            openfoam.make_case(case)
            os.makedirs(f"{case}/constant/triSurface", exist_ok=True)
            write_surface(f"{case}/constant/triSurface/part.stl")
            # So that the duct's straight walls lie half way between the planes of the background.
            box = [-BEFORE - 1.5 * size, -1.5 * size, -1.5 * size], [2 + 1.5 * size, 2 + BEHIND + 1.5 * size, 1 + 1.5 * size]
            cells, height, _ = openfoam.snappy(case, box, size, (-1.013, 0.517, 0.513), "part_wall", LAYERS, first, GROWTH)
            name_patches(case)
            as_wall(case)
            make_case(case, half=False)
            errors["snappy"] = report(f"snappy ({cells:.0f}, {height:.0f}), {size:.4g}", case, reference)[1]
            good = good and errors["with layers"] < min(errors["as many without"], errors["snappy"])
        sys.exit(0 if good else 1)
    finally:
        if not args.keep:
            shutil.rmtree(folder)


if __name__ == "__main__":
    main()
