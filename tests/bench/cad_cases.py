#!/usr/bin/python3
"""cad_cases.py FOLDER [--only WORD] - assemblies of CAD files as cases of CalculiX and OpenFOAM.

Puts each two neighbours of the STEP files of a folder (parts of HexMe, as tests/data/simp.step) into a common block, by
gmsh's OpenCASCADE, and writes the three bodies as one STEP file with names: the bodies first, second and block, and the block's lower
face base. The assembly goes through tessellate --join | tetmesh | findhex | buildgraph | initsol | assemble | fitcad.

CalculiX: base is held, and the two parts have weights of their own. The sum of the forces at the base has to be the weight of the
volumes that the mesh has, to 1e-4 of it. OpenFOAM: base has another temperature than all other faces. All temperatures have to be between the two
(to 2 % of the difference). Prints a row for each pair, and ends with 1 if one has failed. Without OpenFOAM its column is empty.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))
NAMES = os.path.join(ROOT, "tests", "data", "name_faces.py")
# CalculiX leaves the weight on nodes that are held out of its sum: the block has none.
DENSITIES = {"first": 1.0, "second": 3.0, "block": 1e-9}

# The second part is made as large as the first one, and stands beside it. The lower parts of both are in a block, as deep as
# Gmsh's boxes, which are too large where faces are curved, let hope that both reach into it.
PAIR = """SetFactory("OpenCASCADE");
a() = ShapeFromFile("%s"); p() = BoundingBox Volume{a()};
Dilate { {0, 0, 0}, 10 / Sqrt((p(3)-p(0))^2 + (p(4)-p(1))^2 + (p(5)-p(2))^2) } { Volume{a()}; }
p() = BoundingBox Volume{a()};
Translate { -p(0), -p(1), -p(2) } { Volume{a()}; }
b() = ShapeFromFile("%s"); q() = BoundingBox Volume{b()};
Dilate { {0, 0, 0}, 10 / Sqrt((q(3)-q(0))^2 + (q(4)-q(1))^2 + (q(5)-q(2))^2) } { Volume{b()}; }
q() = BoundingBox Volume{b()};
Translate { p(3) - p(0) + 1 - q(0), -q(1), -q(2) } { Volume{b()}; }
w = p(3) - p(0) + q(3) - q(0) + 3; h = p(4) - p(1); If (q(4) - q(1) > h) h = q(4) - q(1); EndIf
d = p(5) - p(2); If (q(5) - q(2) < d) d = q(5) - q(2); EndIf
Box(1000) = {-1, -1, -1, w, h + 2, 1 + 0.4 * d};
BooleanDifference{ Volume{1000}; Delete; }{ Volume{a(), b()}; }
"""
FOAM = "FoamFile { version 2.0; format ascii; class dictionary; object dictionary; }\n"
FOAM_FILES = {
    "system/controlDict": FOAM + "application laplacianFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep; writeInterval 1;",
    "system/fvSchemes": FOAM + "ddtSchemes { default steadyState; } gradSchemes { default Gauss linear; } divSchemes { default none; } laplacianSchemes { default Gauss linear limited 0.5; }"
                               " interpolationSchemes { default linear; } snGradSchemes { default limited 0.5; }",
    "system/fvSolution": FOAM + "solvers { T { solver PCG; preconditioner DIC; tolerance 1e-10; relTol 0; } } SIMPLE { nNonOrthogonalCorrectors 5; }",
    "constant/transportProperties": FOAM + "DT DT [0 2 -1 0 0 0 0] 1;",
    "0/T": FOAM.replace("dictionary;", "volScalarField;", 1) + "dimensions [0 0 0 1 0 0 0]; internalField uniform 1;"
           ' boundaryField { base { type fixedValue; value uniform 0; } ".*" { type fixedValue; value uniform 1; } }',
}


class Failed(Exception):
    pass


def run(command, folder, limit=900, text=None):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=limit, input=text)
    if done.returncode != 0:
        raise Failed(f"{os.path.basename(command[0])}: " + ((done.stderr or done.stdout).strip().splitlines() or ["no message"])[-1])
    return done.stdout


def write(folder, name, text):
    path = os.path.join(folder, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(text)


def mesh(first, second, folder):
    write(folder, "pair.geo", PAIR % (first, second))
    run(["gmsh", "-0", "pair.geo", "-o", "pair.step"], folder)
    with open(os.path.join(folder, "pair.step")) as file:
        named = run([sys.executable, NAMES, "base=z:-1", "body", "first=1", "body", "second=2", "body", "block=3"], folder, text=file.read())
    write(folder, "named.step", named)
    tool = lambda name: os.path.join(BIN, name)
    run([tool("tessellate"), "named.step", "--join", "-o", "surface.tar"], folder)
    run([tool("tetmesh"), "surface.tar", "-o", "mesh.tar"], folder)
    for name, before, after in (("findhex", "mesh", "candidates"), ("buildgraph", "candidates", "graph"), ("initsol", "graph", "solution"), ("assemble", "solution", "result"), ("fitcad", "result", "fitted")):
        run([tool(name), f"{before}.tar", *(["--time-limit", "2"] if name == "initsol" else []), "-o", f"{after}.tar"], folder)


def calculix(folder):
    """How far the forces at the base are from the weight, as a part of it."""
    run([os.path.join(BIN, "fitcad"), "fitted.tar", "--solver", "calculix", "-o", "part.inp"], folder)
    deck = "*INCLUDE, INPUT=part.inp\n"
    for name, density in DENSITIES.items():
        deck += f"*MATERIAL, NAME=OF_{name}\n*ELASTIC\n1000, 0.3\n*DENSITY\n{density}\n*SOLID SECTION, ELSET={name}, MATERIAL=OF_{name}\n"
    deck += "*STEP\n*STATIC\n*BOUNDARY\nbase, 1, 3, 0\n*DLOAD\nEALL, GRAV, 1., 0, 0, -1\n*NODE PRINT, NSET=base, TOTALS=ONLY\nRF\n"
    for name in DENSITIES:
        deck += f"*EL PRINT, ELSET={name}, TOTALS=ONLY\nEVOL\n"
    write(folder, "case.inp", deck + "*END STEP\n")
    run(["ccx", "case"], folder)
    with open(os.path.join(folder, "case.dat")) as file:
        text = file.read()
    forces = [float(x) for x in re.search(r"total force.*?\n\s*\n(.*)", text).group(1).split()]
    weight = 0
    for name, density in DENSITIES.items():
        weight += density * float(re.search(rf"total volume.*{name}\b.*\n\s*\n\s*(\S+)", text, re.I).group(1))
    return abs(forces[2] / weight - 1)


def openfoam(folder):
    """The temperatures' range."""
    for name, text in FOAM_FILES.items():
        write(folder, os.path.join("case", name), text)
    run([os.path.join(BIN, "fitcad"), "fitted.tar", "--solver", "openfoam", "-o", "case/constant/polyMesh"], folder)
    os.environ.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")
    run(["laplacianFoam", "-case", "case"], folder)
    with open(os.path.join(folder, "case", "1", "T")) as file:
        values = re.search(r"internalField\s+nonuniform List<scalar>\s*\d+\s*\((.*?)\)", file.read(), re.S).group(1).split()
    numbers = [float(value) for value in values]
    return min(numbers), max(numbers)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--only", default="", help="pairs with this in their names")
    args = parser.parse_args()
    files = sorted(os.path.abspath(os.path.join(args.folder, name)) for name in os.listdir(args.folder) if name.endswith(".step"))
    has_openfoam = shutil.which("laplacianFoam") is not None
    print("| first | second | CalculiX: forces off by | OpenFOAM: temperatures | |\n|---|---|---|---|---|", flush=True)
    failed = 0
    for first, second in zip(files, files[1:]):
        title = " | ".join(os.path.basename(path)[:-5] for path in (first, second))
        if args.only not in title:
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                mesh(first, second, folder)
                off = calculix(folder)
                low, high = openfoam(folder) if has_openfoam else (0, 1)
                good = off < 1e-4 and low > -0.02 and high < 1.02
                print(f"| {title} | {off:.1e} | {f'{low:.3f} to {high:.3f}' if has_openfoam else ''} | {'' if good else 'FAILED'} |", flush=True)
            except (Failed, subprocess.TimeoutExpired) as failure:
                good = False
                print(f"| {title} | | | FAILED: {failure} |", flush=True)
        failed += not good
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
