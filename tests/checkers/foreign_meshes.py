#!/usr/bin/python3
"""foreign_meshes.py meshio|vtk FILE DIRECTORY: writes the mesh of FILE (a .msh that meshio reads) with another program in
every format and mode that it has and hexpipe reads. Prints the names of the files. Shares no code with hexpipe."""
import contextlib
import os
import sys

import numpy


def write_with_meshio(mesh, folder):
    import meshio

    def path(name):
        print(name)
        return os.path.join(folder, name)

    tags = mesh.cell_data["gmsh:physical"]
    plain = meshio.Mesh(mesh.points, mesh.cells, cell_data={"tag": tags})
    medit = meshio.Mesh(mesh.points, mesh.cells, cell_data={"medit:ref": tags})
    # Its .msh 4.1 wants to know the entity of each node.
    entities = numpy.array([[3, 1]] * len(mesh.points))
    gmsh = meshio.Mesh(
        mesh.points,
        mesh.cells,
        point_data={"gmsh:dim_tags": entities},
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
    )
    for binary, mode in ((True, "binary"), (False, "text")):
        for version in ("4.2", "5.1"):
            meshio.vtk.write(path(f"meshio-{version}-{mode}.vtk"), plain, fmt_version=version, binary=binary)
        for version in ("2.2", "4.1"):
            meshio.gmsh.write(path(f"meshio-{version}-{mode}.msh"), gmsh, fmt_version=version, binary=binary)
    meshio.medit.write(path("meshio.mesh"), medit)
    meshio.vtu.write(path("meshio-text.vtu"), plain, binary=False)
    for compression in ("zlib", None):
        meshio.vtu.write(path(f"meshio-{compression}.vtu"), plain, compression=compression)


def vtk_grid(mesh):
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    kinds = {"hexahedron": 12, "wedge": 13, "pyramid": 14, "tetra": 10, "triangle": 5, "quad": 9}
    grid, points, tags = vtk.vtkUnstructuredGrid(), vtk.vtkPoints(), []
    points.SetDataTypeToDouble()
    for p in mesh.points:
        points.InsertNextPoint(p)
    grid.SetPoints(points)
    for block, values in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        for cell, tag in zip(block.data, values):
            if block.type == "wedge":
                cell = cell[[0, 2, 1, 3, 5, 4]]
            grid.InsertNextCell(kinds[block.type], len(cell), list(cell))
            tags.append(tag)
    # A name that has to be encoded, and data that are not ours.
    for name, values, data in (
        ("tag", numpy.array(tags, numpy.int64), grid.GetCellData()),
        ("a name", numpy.arange(3.0 * len(tags)).reshape(-1, 3), grid.GetCellData()),
        ("quality", numpy.ones(len(mesh.points)), grid.GetPointData()),
    ):
        array = numpy_to_vtk(values, deep=1)
        array.SetName(name)
        data.AddArray(array)
    grid.GetCellData().SetActiveVectors("a name")
    return grid


def write_with_vtk(mesh, folder):
    import vtk

    vtk.vtkObject.GlobalWarningDisplayOff()
    grid = vtk_grid(mesh)

    def write(writer, name):
        print(name)
        writer.SetInputData(grid)
        writer.SetFileName(os.path.join(folder, name))
        if writer.Write() != 1:
            sys.exit(f"VTK cannot write {name}")

    for version in (42, 51):
        for mode in ("ASCII", "Binary"):
            writer = vtk.vtkUnstructuredGridWriter()
            writer.SetFileVersion(version)
            getattr(writer, f"SetFileTypeTo{mode}")()
            write(writer, f"vtk-{version}-{mode}.vtk")
    for mode in ("Ascii", "Binary", "Appended"):
        for compressor in ("None", "ZLib"):
            for raw in (0, 1):
                for bits in (32, 64):
                    for order in ("Big", "Little"):
                        writer = vtk.vtkXMLUnstructuredGridWriter()
                        getattr(writer, f"SetDataModeTo{mode}")()
                        getattr(writer, f"SetCompressorTypeTo{compressor}")()
                        getattr(writer, f"SetHeaderTypeToUInt{bits}")()
                        getattr(writer, f"SetByteOrderTo{order}Endian")()
                        writer.SetEncodeAppendedData(1 - raw)
                        writer.SetBlockSize(64)
                        write(writer, f"vtk-{mode}-{compressor}-{raw}-{bits}-{order}.vtu")


def main():
    import meshio

    program, file, folder = sys.argv[1:]
    with contextlib.redirect_stdout(sys.stderr):
        mesh = meshio.read(file)
    {"meshio": write_with_meshio, "vtk": write_with_vtk}[program](mesh, folder)


if __name__ == "__main__":
    main()
