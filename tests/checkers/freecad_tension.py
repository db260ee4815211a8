#!/usr/bin/python3
"""freecad_tension.py FILE.inp - pulls a cube of 4 x 4 x 4 with FreeCAD's FEM workbench and CalculiX; FILE.inp is its mesh.

The face at x = 0 of a box of FreeCAD is fixed, the one at x = 4 moves by 0.004; Poisson's ratio is 0. So all points move by
0.001 x. Writes the number of nodes, and the greatest error of a displacement. Needs freecad-python3, calculix-ccx."""
import os
import subprocess
import sys

os.environ["QT_QPA_PLATFORM"] = "offscreen"
sys.path.insert(0, "/usr/lib/freecad-python3/lib")
sys.path += [f"/usr/share/freecad/{folder}" for folder in ("Mod/Fem", "Mod/Material", "Mod/Part", "Ext")]
import FreeCAD  # noqa: E402
import Fem  # noqa: E402
import ObjectsFem  # noqa: E402
import Part  # noqa: E402, F401
from femtools import ccxtools  # noqa: E402


def end_face(box, x):
    for number, face in enumerate(box.Shape.Faces, 1):
        if face.BoundBox.XMin == face.BoundBox.XMax == x:
            return [(box, f"Face{number}")]


def write_case(path):
    document = FreeCAD.newDocument("Tension")
    box = document.addObject("Part::Box", "Box")
    box.Length = box.Width = box.Height = 4
    document.recompute()
    analysis = ObjectsFem.makeAnalysis(document, "Analysis")
    solver = ObjectsFem.makeSolverCalculixCcxTools(document)
    solver.GeometricalNonlinearity = "linear"
    material = ObjectsFem.makeMaterialSolid(document)
    material.Material = {"Name": "M", "YoungsModulus": "210000 MPa", "PoissonRatio": "0.0", "Density": "1 kg/m^3"}
    held = ObjectsFem.makeConstraintFixed(document)
    held.References = end_face(box, 0)
    pulled = ObjectsFem.makeConstraintDisplacement(document)
    pulled.References = end_face(box, 4)
    pulled.xFree, pulled.xDisplacement = False, 0.004
    mesh = document.addObject("Fem::FemMeshObject", "Mesh")
    mesh.FemMesh = Fem.read(os.path.abspath(path))
    for item in (solver, material, held, pulled, mesh):
        analysis.addObject(item)
    document.recompute()
    tools = ccxtools.FemToolsCcx(analysis, solver, test_mode=True)
    tools.update_objects()
    tools.setup_working_dir(os.getcwd())
    if problem := tools.check_prerequisites():
        sys.exit(problem)
    tools.write_inp_file()
    return tools.inp_file_name, mesh.FemMesh.Nodes


def displacements(path):
    found, reading = {}, False
    for line in open(path):
        if line.startswith(" -4"):
            reading = line.split()[1] == "DISP"
        elif line.startswith(" -1") and reading:
            found[int(line[3:13])] = [float(line[13 + 12 * i:25 + 12 * i]) for i in range(3)]
    return found


case, nodes = write_case(sys.argv[1])
subprocess.run(["ccx", "-i", case.removesuffix(".inp")], check=True, stdout=subprocess.DEVNULL, timeout=60)
found = displacements(case.replace(".inp", ".frd"))
errors = [max(abs(u - 0.001 * nodes[v].x), abs(w), abs(t)) for v, (u, w, t) in found.items()]
print("nodes", len(found))
print("error", max(errors))
