#!/usr/bin/python3
"""bar.py [--length N] [--kuhn] [--regions] [--apart] [--folded] - a long bar of tets as MEDIT on standard output.

Points of a grid of N + 1 x 4 x 4, moved at random, and their Delaunay tets; with --kuhn unmoved, six tets a cube.
--regions: two regions, their interface and the ends of the bar tagged. --apart: two bars that do not touch. --folded: some
points moved so far that tets turn inside out.
"""
import argparse
import itertools

import numpy as np

WIDTH = 3


def kuhn_tets(shape):
    strides = np.array([shape[1] * shape[2], shape[2], 1])
    cubes = np.array(list(itertools.product(*(range(n - 1) for n in shape))))
    # From a corner to the opposite one, along the axes in every order.
    paths = np.array([np.cumsum([0, *strides[list(order)]]) for order in itertools.permutations(range(3))])
    return (cubes @ strides)[:, None, None] + paths


def bar(options):
    random = np.random.RandomState(1)
    shape = (options.length + 1, WIDTH + 1, WIDTH + 1)
    points = np.array(list(itertools.product(*(range(n) for n in shape))), dtype=float)
    if options.kuhn:
        tets = kuhn_tets(shape).reshape(-1, 4)
    else:
        from scipy.spatial import Delaunay
        inside = (points > 0) & (points < np.array(shape) - 1)
        points += inside * random.uniform(-0.25, 0.25, points.shape)
        tets = Delaunay(points).simplices
    volume = np.einsum("ij,ij->i", np.cross(*(points[tets[:, i]] - points[tets[:, 0]] for i in (1, 2))), points[tets[:, 3]] - points[tets[:, 0]])
    tets[volume < 0] = tets[volume < 0][:, [0, 1, 3, 2]]
    tets = tets[abs(volume) > 1e-9]
    if options.folded:
        points[7::41] += random.uniform(-1.5, 1.5, points[7::41].shape)
    return points, tets


def triangles_of(points, tets, regions):
    facets = {}
    for t, tet in enumerate(tets):
        for facet in itertools.combinations(tet, 3):
            facets.setdefault(tuple(sorted(facet)), []).append(t)
    for facet, of in sorted(facets.items()):
        x = points[list(facet), 0]
        if len(of) == 2 and regions[of[0]] != regions[of[1]]:
            yield facet, 3
        elif len(of) == 1 and (x.max() == 0 or x.min() == points[:, 0].max()):
            yield facet, 1


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--length", type=int, default=24)
    for name in ("kuhn", "regions", "apart", "folded"):
        parser.add_argument("--" + name, action="store_true")
    options = parser.parse_args()
    points, tets = bar(options)
    if options.apart:
        tets = np.concatenate([tets, tets + len(points)])
        points = np.concatenate([points, points + [0, WIDTH + 5, 0]])
    middle = points[tets][:, :, 0].mean(1) > options.length / 2
    regions = middle.astype(int) + 1 if options.regions else np.zeros(len(tets), int)
    triangles = list(triangles_of(points, tets, regions)) if options.regions else []
    print("MeshVersionFormatted 2\nDimension 3\nVertices", len(points), sep="\n")
    for x, y, z in points.round(6).tolist():
        print(x, y, z, 0)
    print("Tetrahedra", len(tets), sep="\n")
    for (a, b, c, d), region in zip((tets + 1).tolist(), regions.tolist()):
        print(a, b, c, d, region)
    if triangles:
        print("Triangles", len(triangles), sep="\n")
    for facet, tag in triangles:
        print(*(v + 1 for v in facet), tag)
    print("End")


main()
