#!/usr/bin/python3
"""lame_getfem.py FILE.vtu - a quarter of a ring under pressure inside, solved by GetFEM on a mesh of second order.

As lame_calculix.py, with pyramids as they are: serendipity elements whose geometry is of second order, too. The mesh is one of
tests/data/ring.py. Prints one line of JSON: unknowns, elements, displacement.
"""
import json
import sys

import getfem as gf
import numpy as np
import scipy.sparse
import scipy.sparse.linalg
import scipy.spatial

import curved_cells
from lame_calculix import POISSON, PRESSURE, YOUNG, exact_displacements
from poisson_getfem import SYMMETRIC_ORDER

KINDS = {
    "hexahedron20": ("GT_Q2_INCOMPLETE(3)", "FEM_Q2_INCOMPLETE(3)"),
    "wedge15": ("GT_PRISM_INCOMPLETE_P2", "FEM_PRISM_INCOMPLETE_P2"),
    "pyramid13": ("GT_PYRAMID_Q2_INCOMPLETE", "FEM_PYRAMID_Q2_INCOMPLETE"),
    "tetra10": ("GT_PK(3,2)", "FEM_PK(3,2)"),
}
# GetFEM puts the apex of a bent pyramid up to 1e-6 of its size beside its place.
NEAR = 1e-5
# VTK's wedge, seen from the other side.
TURNED_WEDGE = [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]


def getfem_order(name):
    """The geometric transformation, and for each of its nodes ours."""
    transform = gf.GeoTrans(KINDS[name][0])
    _, corners, between = curved_cells.ELEMENTS[name]
    corners = np.array(corners, float)
    own = np.vstack([corners] + [corners[list(some)].mean(0) for some in between])
    order = [int(np.argmin(((own - at) ** 2).sum(1))) for at in transform.pts().T]
    assert sorted(order) == list(range(len(own)))
    return transform, order


def facet_loads(name, at):
    """The forces of a unit pressure on the nodes of facets: against the normal of a facet that is seen from outside."""
    normals, values, weight = curved_cells.facet_normals(name, at)
    return -np.einsum("eqx,qn,q->enx", normals, values, weight)


def main():
    cells, _ = curved_cells.read_by_vtk(sys.argv[1])
    mesh, numbers = gf.Mesh("empty", 3), {}
    for name, at in cells:
        if name not in KINDS:
            continue
        if name == "wedge15":
            at = at[:, TURNED_WEDGE]
        transform, order = getfem_order(name)
        numbers[name] = np.array([mesh.add_convex(transform, cell[order].T) for cell in at]).ravel()
    fem, data, integration = gf.MeshFem(mesh, 3), gf.MeshFem(mesh, 1), gf.MeshIm(mesh, 6)
    for name, convexes in numbers.items():
        fem.set_fem(gf.Fem(KINDS[name][1]), convexes)
        data.set_fem(gf.Fem(KINDS[name][1]), convexes)
    ones = np.ones(data.nbdof())
    # The generic assembly of GetFEM 5.4.2 loses entries of some hexes.
    stiffness = gf.asm_linear_elasticity(integration, fem, data, ones * YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)),
                                         ones * YOUNG / (2 * (1 + POISSON)))
    starts, rows = stiffness.csc_ind()
    matrix = scipy.sparse.csc_matrix((stiffness.csc_val(), rows, starts))

    places = fem.basic_dof_nodes().T
    component = np.arange(len(places)) % 3
    # GetFEM integrates nothing over some sides of pyramids, so the load is integrated here.
    tree = scipy.spatial.cKDTree(places[::3])
    load = np.zeros(len(places))
    for name, at in cells:
        if name not in curved_cells.FACETS:
            continue
        inside = at[(abs(np.hypot(at[:, :, 0], at[:, :, 1]) - 1) < 1e-3).all(axis=1)]
        distance, node = tree.query(inside)
        assert distance.size == 0 or distance.max() < NEAR
        np.add.at(load, 3 * node[:, :, np.newaxis] + np.arange(3), PRESSURE * facet_loads(name, inside))

    x, y, z = places.T
    fixed = ((component == 0) & (abs(x) < NEAR)) | ((component == 1) & (abs(y) < NEAR)) | \
        ((component == 2) & ((abs(z) < NEAR) | (abs(z - z.max()) < NEAR)))
    free = np.flatnonzero(~fixed)
    found = np.zeros(len(places))
    found[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), load[free], permc_spec=SYMMETRIC_ORDER)
    exact = exact_displacements(places[::3]).ravel()
    print(json.dumps(dict(unknowns=len(places), elements=int(sum(len(n) for n in numbers.values())),
                          displacement=float(np.sqrt(((found - exact) ** 2).sum() / (exact ** 2).sum())))))


if __name__ == "__main__":
    main()
