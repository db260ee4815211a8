#!/usr/bin/python3
"""tet_contents.py - what is in a bundle of tets, and how a surface changed. Shares no code with hexpipe.

    array BUNDLE MEMBER EXPRESSION   the Python EXPRESSION of the array `a`
    regions BUNDLE                   the tags of its regions with their volumes; all tets have to be positive
    edges BUNDLE SIZE                mean length of the edges along the axes (which are no diagonals), divided by the size
                                     at their middles, an expression of x, y and z
    mesh BUNDLE                      a sum of all bytes of its mesh
    same_surface A.mesh B.mesh       the same triangles on the same points
    same_shape A.mesh B.mesh         other triangles, but the same area and volume
"""
import hashlib
import io
import itertools
import sys
import tarfile

import numpy as np


def member(bundle, name):
    return np.load(io.BytesIO(tarfile.open(bundle).extractfile(name).read()))


def array(bundle, name, expression):
    print(eval(expression, {"np": np, "a": member(bundle, name)}))


def regions(bundle):
    points, tets, tags = (member(bundle, f"mesh/{name}.npy") for name in ("points", "tets", "tet_tags"))
    volumes = np.linalg.det(points[tets[:, 1:]] - points[tets[:, :1]]) / 6
    assert volumes.min() > 0, "tets are inverted or flat"
    print(" ".join(f"{tag}:{volumes[tags == tag].sum():.9g}" for tag in np.unique(tags)))


def edges(bundle, size):
    points, tets = (member(bundle, f"mesh/{name}.npy") for name in ("points", "tets"))
    pairs = np.vstack([tets[:, pair] for pair in itertools.combinations(range(4), 2)])
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    start, end = points[pairs[:, 0]], points[pairs[:, 1]]
    lengths = np.linalg.norm(end - start, axis=1)
    x, y, z = ((start + end) / 2).T
    along_axes = np.abs(end - start).max(axis=1) > 0.95 * lengths
    assert along_axes.sum() > 300, f"only {along_axes.sum()} edges along the axes"
    print("%.2f" % (lengths / eval(size, {"np": np, "x": x, "y": y, "z": z}))[along_axes].mean())


def mesh(bundle):
    sums = hashlib.sha256()
    with tarfile.open(bundle) as members:
        for found in members:
            if found.name.startswith("mesh/"):
                sums.update(found.name.encode() + members.extractfile(found).read())
    print(sums.hexdigest())


def triangles_of(path):
    import meshio
    found = meshio.read(path)
    return found.points, found.cells_dict["triangle"]


def same_surface(before, after):
    (points, triangles), (other_points, other_triangles) = triangles_of(before), triangles_of(after)
    assert np.array_equal(triangles, other_triangles), "the triangles differ"
    on_surface = triangles.max() + 1
    assert np.array_equal(points[:on_surface], other_points[:on_surface]), "the points of the surface differ"


def areas_and_volume(path):
    points, triangles = triangles_of(path)
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    return np.linalg.norm(normals, axis=1), np.einsum("ij,ij", normals, corners[:, 0]) / 3


def same_shape(before, after):
    (areas, volume), (other_areas, other_volume) = areas_and_volume(before), areas_and_volume(after)
    assert not np.array_equal(areas, other_areas), "the triangles are the same"
    assert abs(areas.sum() - other_areas.sum()) < 1e-9 * areas.sum(), (areas.sum(), other_areas.sum())
    assert abs(volume - other_volume) < 1e-9 * volume, (volume, other_volume)


ACTIONS = {action.__name__: action for action in (array, regions, edges, mesh, same_surface, same_shape)}

if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] not in ACTIONS:
        sys.exit(__doc__)
    ACTIONS[sys.argv[1]](*sys.argv[2:])
