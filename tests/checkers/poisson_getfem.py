#!/usr/bin/python3
"""poisson_getfem.py FILE... - solves the Poisson equation on meshes of hexes, prisms, pyramids and tets with GetFEM.

Needs python3-getfem, python3-meshio. Elements of degree 1; Dirichlet conditions on the faces that the file's tagged
triangles and quads name. For each file one line of JSON:
  patch   greatest error at a vertex when the exact solution is linear (rounding, if the mesh is conforming and valid)
  l2, h1  errors in the L2 norm and the H1 seminorm for sin x cos y + z² x, scaled to three times the bounding box
  size    edge length of a cube of the mean volume of a vertex's share
  condition  condition number of the stiffness matrix of the vertices without a condition: its greatest eigenvalue by its least
  volume, boundary_faces, tagged_faces
  merged  cells of which GetFEM took two corners for one (it does when an edge is 1000 times shorter than others)
Boundary faces that no tagged facet names count in boundary_faces only, and get no condition.

GetFEM 5.4's own import of Gmsh files is not used: it takes the corners of pyramids in the wrong order (a pyramid of
volume 1/3 measures 0.143).
"""
import json
import sys

import getfem as gf
import meshio
import numpy as np
import scipy.sparse.linalg

# GetFEM numbers the corners of cubes lexicographically.
KINDS = {
    "hexahedron": ("GT_QK(3,1)", [0, 1, 3, 2, 4, 5, 7, 6]),
    "wedge": ("GT_PRISM(3,1)", [0, 1, 2, 3, 4, 5]),
    "pyramid": ("GT_PYRAMID(1)", [0, 1, 3, 2, 4]),
    "tetra": ("GT_PK(3,1)", [0, 1, 2, 3]),
}
WHOLE_BOUNDARY = 1
# SuperLU's usual order is for other matrices, and takes several times as long for these.
SYMMETRIC_ORDER = "MMD_AT_PLUS_A"


def load(path):
    """The GetFEM mesh, with the faces named by tagged facets as a region; and how many boundary faces there are."""
    source = meshio.read(path)
    mesh = gf.Mesh("empty", 3)
    ids = mesh.add_point(source.points.T)
    assert len(set(ids)) == len(source.points), "two vertices at one place"
    vertex_of = np.full(max(ids) + 1, -1)
    vertex_of[ids] = np.arange(len(ids))
    tagged = set()
    for block in source.cells:
        if block.type in KINDS:
            name, order = KINDS[block.type]
            transform = gf.GeoTrans(name)
            for cell in block.data:
                mesh.add_convex(transform, source.points[cell[order]].T)
        elif block.type in ("triangle", "quad"):
            tagged |= {frozenset(facet) for facet in block.data.tolist()}
    outer = mesh.outer_faces()
    faces = [face for face in outer.T
             if frozenset(vertex_of[mesh.pid_in_faces(face.reshape(2, 1))].tolist()) in tagged]
    mesh.set_region(WHOLE_BOUNDARY, np.array(faces).T)
    return mesh, outer.shape[1], len(faces)


def count_merged(fem):
    numbers, starts = fem.basic_dof_from_cvid()
    return sum(len(set(numbers[a:b])) < b - a for a, b in zip(starts, starts[1:]))


def stiffness_of(fem, integration):
    """The matrix, and the vertices with and without a condition."""
    # The Laplacian's own assembly: the generic one of GetFEM 5.4.2 loses entries of some hexes (an asymmetric matrix).
    stiffness = gf.asm_laplacian(integration, fem, fem, np.ones(fem.nbdof()))
    starts, rows = stiffness.csc_ind()
    fixed = np.unique(fem.basic_dof_on_region(WHOLE_BOUNDARY))
    free = np.setdiff1d(np.arange(fem.nbdof()), fixed)
    return scipy.sparse.csc_matrix((stiffness.csc_val(), rows, starts)), fixed, free


def condition_of(matrix, free):
    inner = matrix[free][:, free]
    inverse = scipy.sparse.linalg.LinearOperator(
        inner.shape, scipy.sparse.linalg.splu(inner, permc_spec=SYMMETRIC_ORDER).solve)
    # A start of its own, so that the last digits are the same each time.
    start = np.random.default_rng(1).uniform(size=len(free))
    greatest, of_inverse = (scipy.sparse.linalg.eigsh(operator, k=1, v0=start, tol=1e-6, return_eigenvectors=False)[0]
                            for operator in (inner, inverse))
    return greatest * of_inverse


def solve(fem, integration, stiffness, exact, source):
    load_vector = np.zeros(fem.nbdof())
    if source is not None:
        load_vector = gf.asm_volumic_source(integration, fem, fem, source[np.newaxis, :]).ravel()
    matrix, fixed, free = stiffness
    values = exact.copy()
    values[free] = scipy.sparse.linalg.spsolve(
        matrix[free][:, free], (load_vector - matrix[:, fixed] @ exact[fixed])[free], permc_spec=SYMMETRIC_ORDER)
    return values


def examine(path):
    mesh, boundary_faces, tagged_faces = load(path)
    fem = gf.MeshFem(mesh, 1)
    fem.set_classical_fem(1)
    integration = gf.MeshIm(mesh, 6)
    # Not basic_dof_nodes(): it places the tips of pyramids by base functions that are singular there, 1e-6 off.
    points = np.empty((3, fem.nbdof()))
    points[:, fem.basic_dof_from_cvid()[0]] = mesh.pts()[:, mesh.pid_from_cvid()[0]]
    x, y, z = points
    low, high = mesh.pts().min(axis=1).tolist(), mesh.pts().max(axis=1).tolist()
    k = 3 / max(b - a for a, b in zip(low, high))

    stiffness = stiffness_of(fem, integration)
    linear = 1 + 2 * k * x - 3 * k * y + 5 * k * z
    patch = np.abs(solve(fem, integration, stiffness, linear, None) - linear).max()

    X, Y, Z = (f"({k!r}*(X({i + 1})-({low[i]!r})))" for i in range(3))
    u = f"(sin({X})*cos({Y})+{Z}*{Z}*{X})"
    gradient = f"({k!r}*[cos({X})*cos({Y})+{Z}*{Z},-sin({X})*sin({Y}),2*{Z}*{X}])"
    sx, sy, sz = k * (x - low[0]), k * (y - low[1]), k * (z - low[2])
    values = solve(fem, integration, stiffness, np.sin(sx) * np.cos(sy) + sz * sz * sx,
                   k * k * (2 * np.sin(sx) * np.cos(sy) - 2 * sx))
    volume = gf.asm_generic(integration, 0, "1", -1)
    l2 = gf.asm_generic(integration, 0, f"sqr(u-{u})", -1, "u", 0, fem, values)
    h1 = gf.asm_generic(integration, 0, f"Norm_sqr(Grad_u-{gradient})", -1, "u", 0, fem, values)
    matrix, _, free = stiffness
    return dict(file=path, patch=float(patch), l2=float(l2 / volume) ** 0.5, h1=float(h1 / volume) ** 0.5 / k,
                condition=float(condition_of(matrix, free)),
                size=float(volume / mesh.nbpts()) ** (1 / 3), volume=float(volume), boundary_faces=int(boundary_faces),
                tagged_faces=tagged_faces, merged=int(count_merged(fem)))


if __name__ == "__main__":
    gf.util("trace level", 0)
    gf.util("warning level", 0)
    for name in sys.argv[1:]:
        print(json.dumps(examine(name)))
