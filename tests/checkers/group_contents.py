#!/usr/bin/python3
"""group_contents.py exodus|meshio-exodus|med|cgns FILE: what another program finds in a mesh file, by the names
of groups, one element a line.

    hex steel 0,0,0 1,0,0 1,1,0 ...    kind, name, coordinates of the corners; sorted
    nodes inlet 0,0,0 ...              sets of nodes, with their coordinates sorted
    volume hex 1                       exodus and cgns: as VTK computes it

exodus: vtkExodusIIReader. med: meshio. cgns: vtkCGNSReader. Corners are in hexpipe's order where readers turn none;
facets begin at their least corner. Shares no code with hexpipe.
"""
import contextlib
import sys

KINDS = {"hexahedron": "hex", "wedge": "prism", "pyramid": "pyramid", "tetra": "tet", "tetra4": "tet", "triangle": "triangle",
         "quad": "quad"}
VTK_KINDS = {12: "hex", 13: "prism", 14: "pyramid", 10: "tet", 5: "triangle", 9: "quad"}


def text(point):
    return ",".join(f"{0.0 if x == 0 else x:.10g}" for x in point)


def element(kind, name, points):
    corners = [text(p) for p in points]
    if kind in ("triangle", "quad"):
        least = corners.index(min(corners))
        corners = corners[least:] + corners[:least]
    return " ".join([kind, name] + corners)


def cells_of(grid, name):
    for i in range(grid.GetNumberOfCells()):
        kind = VTK_KINDS[grid.GetCellType(i)]
        ids = grid.GetCell(i).GetPointIds()
        points = [grid.GetPoint(ids.GetId(k)) for k in range(ids.GetNumberOfIds())]
        yield element(kind, name, points)


def with_volumes(grid, name):
    import vtk

    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volumes = sizes.GetOutput().GetCellData().GetArray("Volume")
    yield from cells_of(grid, name)
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


def read_med(path):
    """By meshio, which leaves cells as MED has them: seen from the other side."""
    import meshio

    orders = {"hexahedron": (0, 3, 2, 1, 4, 7, 6, 5), "wedge": (0, 2, 1, 3, 5, 4), "pyramid": (0, 3, 2, 1, 4), "tetra": (0, 2, 1, 3)}
    mesh = meshio.read(path)
    for block, families in zip(mesh.cells, mesh.cell_data["cell_tags"]):
        for cell, family in zip(block.data, families):
            corners = [cell[i] for i in orders.get(block.type, range(len(cell)))]
            names = mesh.cell_tags.get(family, ["-"])
            yield element(KINDS[block.type], "+".join(names), [mesh.points[v] for v in corners])


def read_cgns(path):
    """VTK puts the sections of a zone together, so that cells have no names; boundary conditions are patches."""
    import vtk

    reader = vtk.vtkCGNSReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.EnableAllBases()
    reader.EnableAllFamilies()
    reader.LoadBndPatchOn()
    reader.Update()
    zone = reader.GetOutput().GetBlock(0).GetBlock(0)
    parts = dict(leaves(zone))
    yield from with_volumes(parts["Internal"], "-")
    for name, grid in leaves(parts["Patches"]):
        yield from cells_of(grid, name)


def main():
    reader, path = sys.argv[1:]
    readers = {"exodus": read_exodus, "meshio-exodus": read_meshio_exodus, "med": read_med, "cgns": read_cgns}
    with contextlib.redirect_stdout(sys.stderr):
        lines = sorted(readers[reader](path))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
