#!/usr/bin/python3
"""group_contents.py exodus|meshio-exodus|gmsh|meshio-med|cgns FILE: what another program finds in a mesh file, by the names
of groups, one element a line.

    hex steel 0,0,0 1,0,0 1,1,0 ...    kind, name, coordinates of the corners; sorted
    nodes inlet 0,0,0 ...              sets of nodes, with their coordinates sorted
    volume hex 1                       exodus and cgns: as VTK computes it

exodus: vtkExodusIIReader. gmsh: what Gmsh makes of the file. Corners are in hexpipe's order where readers turn none;
facets begin at their least corner. Shares no code with hexpipe.
"""
import contextlib
import os
import subprocess
import sys
import tempfile

KINDS = {"hexahedron": "hex", "wedge": "prism", "pyramid": "pyramid", "tetra": "tet", "tetra4": "tet", "triangle": "triangle",
         "quad": "quad"}
VTK_KINDS = {12: "hex", 13: "prism", 14: "pyramid", 10: "tet", 5: "triangle", 9: "quad"}
GMSH_KINDS = {"5": "hex", "6": "prism", "7": "pyramid", "4": "tet", "2": "triangle", "3": "quad"}


def text(point):
    return ",".join(f"{0.0 if x == 0 else x:.10g}" for x in point)


def element(kind, name, points):
    corners = [text(p) for p in points]
    if kind in ("triangle", "quad"):
        least = corners.index(min(corners))
        corners = corners[least:] + corners[:least]
    return " ".join([kind, name] + corners)


def cells_of(grid, name, turns_wedges=False):
    for i in range(grid.GetNumberOfCells()):
        kind = VTK_KINDS[grid.GetCellType(i)]
        ids = grid.GetCell(i).GetPointIds()
        points = [grid.GetPoint(ids.GetId(k)) for k in range(ids.GetNumberOfIds())]
        if kind == "prism" and turns_wedges:
            points = [points[k] for k in (0, 2, 1, 3, 5, 4)]
        yield element(kind, name, points)


def with_volumes(grid, name, turns_wedges=False):
    import vtk

    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volumes = sizes.GetOutput().GetCellData().GetArray("Volume")
    yield from cells_of(grid, name, turns_wedges)
    for i in range(grid.GetNumberOfCells()):
        yield f"volume {VTK_KINDS[grid.GetCellType(i)]} {volumes.GetValue(i):.10g}"


def leaves(tree):
    import vtk

    for b in range(tree.GetNumberOfBlocks()):
        if tree.GetBlock(b) is not None:
            yield tree.GetMetaData(b).Get(vtk.vtkCompositeDataSet.NAME()), tree.GetBlock(b)


def read_exodus(path):
    import vtk

    reader = vtk.vtkExodusIIReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    for kind in (reader.SIDE_SET, reader.NODE_SET):
        for i in range(reader.GetNumberOfObjects(kind)):
            reader.SetObjectStatus(kind, i, 1)
    reader.Update()
    parts = dict(leaves(reader.GetOutput()))
    for name, grid in leaves(parts["Element Blocks"]):
        yield from with_volumes(grid, name)
    for name, grid in leaves(parts["Side Sets"]):
        yield from cells_of(grid, name)
    for name, grid in leaves(parts["Node Sets"]):
        yield " ".join(["nodes", name] + sorted(text(grid.GetPoint(i)) for i in range(grid.GetNumberOfPoints())))


def read_meshio_exodus(path):
    """meshio knows neither names of blocks nor sets of sides."""
    import meshio

    mesh = meshio.read(path)
    for block in mesh.cells:
        for cell in block.data:
            yield element(KINDS[block.type], "-", [mesh.points[v] for v in cell])
    for name, nodes in mesh.point_sets.items():
        yield " ".join(["nodes", name] + sorted(text(mesh.points[v]) for v in nodes))


def read_gmsh(path):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out.msh")
        ran = subprocess.run(["gmsh", path, "-save", "-format", "msh22", "-o", out], capture_output=True, text=True)
        complaints = [line for line in (ran.stdout + ran.stderr).splitlines() if line.startswith(("Error", "Warning"))]
        if ran.returncode != 0 or complaints:
            sys.exit(f"{path}: gmsh: {complaints}")
        with open(out) as file:
            lines = file.read().split("\n")
    names = {}
    if "$PhysicalNames" in lines:
        at = lines.index("$PhysicalNames")
        for line in lines[at + 2:at + 2 + int(lines[at + 1])]:
            dimension, number, name = line.split(maxsplit=2)
            names[dimension, number] = name.strip('"')
    at = lines.index("$Nodes")
    nodes = {line.split()[0]: [float(x) for x in line.split()[1:]] for line in lines[at + 2:at + 2 + int(lines[at + 1])]}
    at = lines.index("$Elements")
    for line in lines[at + 2:at + 2 + int(lines[at + 1])]:
        words = line.split()
        if words[1] not in GMSH_KINDS:
            continue
        kind = GMSH_KINDS[words[1]]
        dimension = "2" if kind in ("triangle", "quad") else "3"
        yield element(kind, names.get((dimension, words[3]), "-"), [nodes[v] for v in words[3 + int(words[2]):]])


def main():
    reader, path = sys.argv[1:]
    readers = {"exodus": read_exodus, "meshio-exodus": read_meshio_exodus, "gmsh": read_gmsh}
    with contextlib.redirect_stdout(sys.stderr):
        lines = sorted(readers[reader](path))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
