#!/usr/bin/python3
"""mesh_contents.py meshio|vtk|gmsh FILE: what another program finds in a mesh file, one element a line.

    hex 1 0,0,0 1,0,0 1,1,0 ...        kind, tag, coordinates of the corners; sorted
    quality hex 1                      with --quality: the cell data of this name
    volume hex 1                       with --volumes (vtk only): as VTK computes it

Corners are in hexpipe's order: readers that keep VTK's wedge as it is have it turned here. Two files with the same
mesh give the same lines, whatever the order of their nodes and elements. Shares no code with hexpipe.
"""
import argparse
import contextlib
import os
import subprocess
import sys
import tempfile

KINDS = {
    "hexahedron": "hex",
    "wedge": "prism",
    "pyramid": "pyramid",
    "tetra": "tet",
    "triangle": "triangle",
    "quad": "quad",
}
VTK_KINDS = {12: "hex", 13: "prism", 14: "pyramid", 10: "tet", 5: "triangle", 9: "quad"}
FACETS = ("triangle", "quad")


def number(x):
    return f"{x:.10g}"


def corner(point):
    return ",".join(number(0.0 if x == 0 else x) for x in point)


def tag_of(data, kind):
    for name in ("surface" if kind in FACETS else "region", "gmsh:physical", "medit:ref", "tag"):
        if name in data:
            return int(data[name])
    return 0


def read_meshio(path):
    import meshio

    with contextlib.redirect_stdout(sys.stderr):
        mesh = meshio.read(path)
    for b, block in enumerate(mesh.cells):
        if block.type not in KINDS:
            continue
        kind = KINDS[block.type]
        data = {name: values[b] for name, values in mesh.cell_data.items()}
        for i, cell in enumerate(block.data):
            yield kind, [mesh.points[v] for v in cell], {name: values[i] for name, values in data.items()}


def read_vtk(path):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLUnstructuredGridReader() if path.endswith(".vtu") else vtk.vtkUnstructuredGridReader()
    reader.SetFileName(path)
    if isinstance(reader, vtk.vtkUnstructuredGridReader):
        reader.ReadAllFieldsOn()
        reader.ReadAllScalarsOn()
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputConnection(reader.GetOutputPort())
    sizes.Update()
    if reader.GetErrorCode() != 0:
        sys.exit(f"{path}: VTK reports error {reader.GetErrorCode()}")
    grid = sizes.GetOutput()
    arrays = grid.GetCellData()
    data = {arrays.GetArrayName(a): vtk_to_numpy(arrays.GetArray(a)) for a in range(arrays.GetNumberOfArrays())}
    for i in range(grid.GetNumberOfCells()):
        kind = VTK_KINDS.get(grid.GetCellType(i))
        if kind is None:
            continue
        ids = grid.GetCell(i).GetPointIds()
        points = [grid.GetPoint(ids.GetId(k)) for k in range(ids.GetNumberOfIds())]
        if kind == "prism":
            points = [points[k] for k in (0, 2, 1, 3, 5, 4)]
        yield kind, points, {name: values[i] for name, values in data.items()}


def read_gmsh(path):
    """Gmsh has no Python here: it converts to .msh 2.2, of which the few lines are parsed."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out.msh")
        command = ["gmsh", path, "-save", "-format", "msh22", "-o", out]
        ran = subprocess.run(command, capture_output=True, text=True)
        complaints = [line for line in (ran.stdout + ran.stderr).splitlines() if line.startswith(("Error", "Warning"))]
        if ran.returncode != 0 or complaints:
            sys.exit(f"{path}: gmsh: {complaints}")
        with open(out) as file:
            lines = file.read().split("\n")
    at = lines.index("$Nodes")
    nodes = {}
    for line in lines[at + 2:at + 2 + int(lines[at + 1])]:
        name, *xyz = line.split()
        nodes[name] = [float(x) for x in xyz]
    at = lines.index("$Elements")
    kinds = {"5": "hex", "6": "prism", "7": "pyramid", "4": "tet", "2": "triangle", "3": "quad"}
    for line in lines[at + 2:at + 2 + int(lines[at + 1])]:
        words = line.split()
        if words[1] not in kinds:
            continue
        tags = int(words[2])
        physical, elementary = words[3:5]
        yield kinds[words[1]], [nodes[v] for v in words[3 + tags:]], {"tag": physical if physical != "0" else elementary}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("reader", choices=("meshio", "vtk", "gmsh"))
    parser.add_argument("file")
    parser.add_argument("--quality", action="store_true")
    parser.add_argument("--volumes", action="store_true")
    parser.add_argument("--no-tags", action="store_true", help="where a program drops them")
    options = parser.parse_args()
    lines = []
    for kind, points, data in {"meshio": read_meshio, "vtk": read_vtk, "gmsh": read_gmsh}[options.reader](options.file):
        tag = "-" if options.no_tags else tag_of(data, kind)
        lines.append(" ".join([kind, str(tag)] + [corner(p) for p in points]))
        if options.quality:
            lines.append(f"quality {kind} {number(data['quality'])}")
        if options.volumes and kind not in FACETS:
            lines.append(f"volume {kind} {number(data['Volume'])}")
    print("\n".join(sorted(lines)))


if __name__ == "__main__":
    main()
