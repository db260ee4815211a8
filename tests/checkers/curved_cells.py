#!/usr/bin/python3
"""curved_cells.py FILE - what other programs read of a mesh of second order, as `key value` lines.

Reads .vtu and .exo by VTK, .msh, .med and .inp by meshio. For each kind of cell: its number, and its volume, integrated with
the quadratic geometry; also the least Jacobian at the points of integration, the number of facets and their area, and the
names of groups. Elements are described by the monomials that span them, fitted at the places of their nodes in VTK's order,
which all these readers use.
"""
import sys

import numpy as np

CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
WEDGE = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)]
PYRAMID = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1)]
TET = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
CUBE_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
CUBE_SIDES = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 1, 2, 3), (4, 5, 6, 7)]
WEDGE_EDGES = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
PYRAMID_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]
TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]

# The kind, its corners, and the corners between which its nodes lie.
ELEMENTS = {
    "hexahedron20": ("hex", CUBE, CUBE_EDGES),
    "hexahedron27": ("hex", CUBE, CUBE_EDGES + CUBE_SIDES + [tuple(range(8))]),
    "wedge15": ("prism", WEDGE, WEDGE_EDGES),
    "wedge18": ("prism", WEDGE, WEDGE_EDGES + [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]),
    "pyramid13": ("pyramid", PYRAMID, PYRAMID_EDGES),
    "pyramid14": ("pyramid", PYRAMID, PYRAMID_EDGES + [(0, 1, 2, 3)]),
    "tetra10": ("tet", TET, TET_EDGES),
}
FACETS = {"triangle6": 6, "quad8": 8, "quad9": 9}
# The order of Gmsh's manual, where meshio leaves it: our node i is Gmsh's node order[i].
GMSH_ORDERS = {
    "wedge18": [0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16],
    "pyramid14": [0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12, 13],
}
VTK_NAMES = {25: "hexahedron20", 29: "hexahedron27", 26: "wedge15", 32: "wedge18", 27: "pyramid13", 24: "tetra10",
             22: "triangle6", 23: "quad8", 28: "quad9"}


def monomials(name, at):
    """Values and gradients of what spans the element, at places; numbers of the third axis are those of `at`."""
    x, y, z = (np.asarray(at, float)[:, i] for i in range(3))
    kind, full = ELEMENTS[name][0], name in ("hexahedron27", "wedge18", "pyramid14")
    powers = []
    for i in range(3):
        for j in range(3):
            for k in range(3):
                if kind == "hex":
                    belongs = full or (i == 2) + (j == 2) + (k == 2) <= 1
                elif kind == "prism":
                    belongs = i + j <= 2 and (full or not (i + j == 2 and k == 2))
                else:
                    belongs = i + j + k <= 2
                if belongs:
                    powers.append((i, j, k, 0))
    if kind == "pyramid":
        powers += [(1, 1, 0, 1), (2, 1, 0, 1), (1, 2, 0, 1)] + ([(2, 2, 0, 2)] if full else [])
    value, gradient = [], []
    for i, j, k, n in powers:
        a, b = x ** i, y ** j
        c = z ** k if n == 0 else np.where(z < 1, 1 - z, 1.0) ** -n * (z < 1)
        da = i * x ** max(i - 1, 0)
        db = j * y ** max(j - 1, 0)
        dc = k * z ** max(k - 1, 0) if n == 0 else n * np.where(z < 1, 1 - z, 1.0) ** (-n - 1) * (z < 1)
        value.append(a * b * c)
        gradient.append((da * b * c, a * db * c, a * b * dc))
    return np.array(value).T, np.array(gradient).transpose(2, 1, 0)


def integration(kind):
    """Places and weights, exact for the Jacobians of these elements."""
    x, w = np.polynomial.legendre.leggauss(6)
    x, w = (x + 1) / 2, w / 2
    places, weights = [], []
    for i in range(6):
        for j in range(6):
            for k in range(6):
                u, v, t, weight = x[i], x[j], x[k], w[i] * w[j] * w[k]
                if kind == "prism":
                    u, weight = u * (1 - v), weight * (1 - v)
                elif kind == "tet":
                    u, v, weight = u * (1 - v) * (1 - t), v * (1 - t), weight * (1 - v) * (1 - t) ** 2
                elif kind == "pyramid":
                    u, v, weight = (2 * u - 1) * (1 - t), (2 * v - 1) * (1 - t), 4 * weight * (1 - t) ** 2
                places.append((u, v, t))
                weights.append(weight)
    return np.array(places), np.array(weights)


def jacobians(name, at):
    """At the points of integration of each element, with their weights. at: elements x nodes x 3."""
    kind, corners, between = ELEMENTS[name]
    corners = np.array(corners, float)
    nodes = np.vstack([corners] + [corners[list(some)].mean(0) for some in between])
    values, _ = monomials(name, nodes)
    places, weights = integration(kind)
    _, gradients = monomials(name, places)
    shape = np.einsum("qdm,mn->qdn", gradients, np.linalg.inv(values))
    tangents = np.einsum("qdn,enx->eqdx", shape, at)
    return np.linalg.det(tangents), weights


def facet_normals(name, at):
    """Normals (as long as the area is stretched) at points of integration, values of shape functions there, weights."""
    x, w = np.polynomial.legendre.leggauss(6)
    x, w = (x + 1) / 2, w / 2
    u, v = (grid.ravel() for grid in np.meshgrid(x, x))
    weight = np.outer(w, w).ravel()
    if name == "triangle6":
        u, weight = u * (1 - v), weight * (1 - v)
        nodes = [(0, 0), (1, 0), (0, 1), (.5, 0), (.5, .5), (0, .5)]
        powers = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
    else:
        nodes = [(0, 0), (1, 0), (1, 1), (0, 1), (.5, 0), (1, .5), (.5, 1), (0, .5), (.5, .5)][:FACETS[name]]
        powers = [(i, j) for i in range(3) for j in range(3) if name == "quad9" or i + j < 4]
    factors = np.linalg.inv(np.array([[p ** i * q ** j for i, j in powers] for p, q in nodes]))
    values = np.array([u ** i * v ** j for i, j in powers]).T @ factors
    du = np.array([i * u ** max(i - 1, 0) * v ** j for i, j in powers]).T @ factors
    dv = np.array([j * u ** i * v ** max(j - 1, 0) for i, j in powers]).T @ factors
    return np.cross(np.einsum("qn,enx->eqx", du, at), np.einsum("qn,enx->eqx", dv, at)), values, weight


def area(name, at):
    normals, _, weight = facet_normals(name, at)
    return float((np.linalg.norm(normals, axis=2) * weight).sum())


def read_by_vtk(path):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    names = []
    if path.endswith(".vtu"):
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(path)
        reader.Update()
        grids = [reader.GetOutput()]
    else:
        reader = vtk.vtkExodusIIReader()
        reader.SetFileName(path)
        reader.UpdateInformation()
        for number in range(reader.GetNumberOfSideSetArrays()):
            names.append(reader.GetSideSetArrayName(number))
        reader.Update()
        blocks, grids = reader.GetOutput().GetBlock(0), []
        for i in range(blocks.GetNumberOfBlocks()):
            names.append(blocks.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME()))
            if blocks.GetBlock(i) is not None:
                grids.append(blocks.GetBlock(i))
    cells = full_pyramids_of_exodus(path) if not path.endswith(".vtu") else []
    for grid in grids:
        points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
        by_kind = {}
        for i in range(grid.GetNumberOfCells()):
            cell = grid.GetCell(i)
            by_kind.setdefault(VTK_NAMES.get(grid.GetCellType(i), str(grid.GetCellType(i))), []).append(
                [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())])
        cells += [(name, points[np.array(nodes)]) for name, nodes in by_kind.items()]
    if any(name == "pyramid14" for name, _ in cells):
        cells = [(name, at) for name, at in cells if name != "14"]
    return cells, names


def full_pyramids_of_exodus(path):
    """VTK reads the corners of Exodus' PYRAMID14 alone."""
    import netCDF4
    cells = []
    with netCDF4.Dataset(path) as file:
        points = np.array([file["coord" + axis][:] for axis in "xyz"]).T
        for name, variable in file.variables.items():
            if name.startswith("connect") and variable.elem_type == "PYRAMID14":
                cells.append(("pyramid14", points[np.array(variable[:]) - 1]))
    return cells


def read_by_meshio(path):
    import meshio
    # Debian's meshio 5.0 has these kinds in its readers, but not in this table.
    for name in ELEMENTS:
        meshio._mesh.topological_dimension.setdefault(name, 3)
    mesh = meshio.read(path)
    cells = []
    for block in mesh.cells:
        nodes = np.asarray(block.data)
        if path.endswith(".msh") and block.type in GMSH_ORDERS:
            nodes = nodes[:, GMSH_ORDERS[block.type]]
        cells.append((block.type, mesh.points[nodes]))
    return cells, sorted(mesh.field_data) + sorted(mesh.cell_sets) + sorted(mesh.point_sets)


def main():
    path = sys.argv[1]
    cells, names = read_by_vtk(path) if path.endswith((".vtu", ".exo", ".e")) else read_by_meshio(path)
    counts, volumes, least = {}, {}, np.inf
    facets, facet_area = 0, 0.0
    for name, at in cells:
        if name in FACETS:
            facets += len(at)
            facet_area += area(name, at)
        elif name in ELEMENTS:
            kind = ELEMENTS[name][0]
            determinants, weights = jacobians(name, at)
            # Some formats list the corners of their cells the other way round.
            sign = np.sign(determinants.sum())
            counts[kind] = counts.get(kind, 0) + len(at)
            volumes[kind] = volumes.get(kind, 0.0) + float((sign * determinants * weights).sum())
            least = min(least, float((sign * determinants).min()))
        elif name not in ("vertex", "line", "line3"):
            print("other_" + name, len(at))
    for kind in ("hex", "prism", "pyramid", "tet"):
        print(kind, counts.get(kind, 0), "%.12g" % volumes.get(kind, 0.0))
    print("volume %.10g" % sum(volumes.values()))
    print("is_positive", int(least > 0))
    print("facets", facets, "%.10g" % facet_area)
    print("names", *sorted(set(str(n) for n in names)))


if __name__ == "__main__":
    main()
