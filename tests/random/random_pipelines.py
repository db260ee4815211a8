#!/usr/bin/python3
"""random_pipelines.py [--cases N] [--seed S] [--keep DIRECTORY] [KIND...]

Random tet meshes, graphs and surfaces through whole pipelines, judged by the independent checkers. Case i has the seed
S + i; --seed new takes one from the clock. A case that fails is printed with its seed and kind, and lies in the directory
of --keep; a mesh or a graph is made smaller first, as long as it fails. Ends with 1 then.
"""
import argparse
import contextlib
import io
import itertools
import json
import os
import pathlib
import random
import runpy
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.spatial import ConvexHull, Delaunay

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BIN = pathlib.Path(os.environ.get("HEXPIPE_BIN", ROOT / "build/bin"))
CHECKERS = ROOT / "tests/checkers"


class Failure(Exception):
    pass


class BadCase(Failure):
    """The input itself is at fault."""


def run(directory, *command, timeout=120):
    try:
        done = subprocess.run([str(c) for c in command], cwd=directory, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=timeout)
    except subprocess.TimeoutExpired:
        raise Failure(f"{command} takes over {timeout} s") from None
    if done.returncode != 0:
        said = (done.stdout + done.stderr).decode(errors="replace")[-500:]
        raise Failure(f"{' '.join(map(str, command))}: exit code {done.returncode}: {said}")
    return done.stdout.decode()


def tool(directory, name, *options):
    return run(directory, BIN / name, "-q", *options)


def check(directory, name, *arguments):
    """A checker as it runs by hand, but in this process: to load numpy takes longer than to check."""
    said, before = io.StringIO(), (os.getcwd(), sys.argv)
    os.chdir(directory)
    sys.argv = [name, *map(str, arguments)]
    code = 0
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            runpy.run_path(str(CHECKERS / name), run_name="__main__")
    except SystemExit as end:
        code = end.code or 0
    finally:
        os.chdir(before[0])
        sys.argv = before[1]
    if code != 0:
        raise Failure(f"{name} {' '.join(map(str, arguments))}: exit code {code}: {said.getvalue()[-500:]}")
    return said.getvalue()


def require(condition, message):
    if not condition:
        raise Failure(message)


# ---- what became of a part, from the files alone

MESHSTATS = runpy.run_path(str(CHECKERS / "meshstats.py"))
# The promises of the tools: smoothing moves the boundary by no more than 0.03 of the wall thickness, or of an edge where the wall
# is thicker, and remeshing by no more than 0.15 of it, or of the size. Moved this far on both sides, a model loses twice
# these shares of its volume.
SMOOTHING, REMESHING = 0.03, 0.15


def skin(cells):
    """Triangles and quads that one cell has, outward, and no more."""
    found = {}
    for kind, corners in cells.items():
        for side in itertools.chain(*MESHSTATS["FACES"].get(kind, ())):
            for facet in corners[:, side].tolist():
                found.setdefault(tuple(sorted(facet)), []).append(facet)
    once = [facets[0] for facets in found.values() if len(facets) == 1]
    return [f for f in once if len(f) == 3], [f for f in once if len(f) == 4]


def bulge(points, quads):
    """How much the volume may change where each quad takes the place of two triangles, either way."""
    return sum(abs(np.linalg.det(points[q[1:]] - points[q[0]])) for q in quads) / 12


def distances(places, corners):
    """Of each place from the nearest of these triangles, which are three points each."""
    a, b, c = (corners[None, :, i] for i in range(3))
    p = places[:, None]
    least = np.full(p.shape[:1] + a.shape[1:2], np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        along = end - start
        share = ((p - start) * along).sum(-1) / (along * along).sum(-1)
        least = np.minimum(least, np.linalg.norm(start + share.clip(0, 1)[..., None] * along - p, axis=-1))
    normal = np.cross(b - a, c - a)
    inside = np.all([(np.cross(end - start, p - start) * normal).sum(-1) >= 0
                     for start, end in ((a, b), (b, c), (c, a))], axis=0)
    height = np.abs(((p - a) * normal).sum(-1)) / np.linalg.norm(normal, axis=-1)
    return np.where(inside, np.minimum(least, height), least).min(axis=1)


def farthest(places, corners):
    return max(distances(some, corners).max() for some in np.array_split(places, 1 + len(places) * len(corners) // 200000))


def judge_assembled(directory, before, after, smoothed):
    """The result's volume and boundary against those of the tets that it was put together from."""
    (points, tets), (moved, cells) = (MESHSTATS["read"](str(directory / name)) for name in (before, after))
    volume = MESHSTATS["tetvol"](points, tets["tet"]).sum()
    triangles, quads = skin(cells)
    made = MESHSTATS["stats"](str(directory / after), conf=False)["volume"]
    room = bulge(moved, quads) + (2 * SMOOTHING if smoothed else 1e-9) * volume
    require(abs(made - volume) <= room, f"volume {made} out of {volume}, expected {room} more or less at most")
    corners = points[np.array(skin(tets_only(tets))[0])]
    used = sorted({v for facet in triangles + quads for v in facet})
    off = farthest(moved[used], corners)
    require(off <= 1e-6 * np.ptp(points, axis=0).max(), f"a vertex of the boundary is {off} off the input's")
    if triangles:
        off = farthest(moved[np.array(triangles)].mean(axis=1), corners)
        longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1).max()
        require(off <= SMOOTHING * longest, f"a facet of the boundary is {off} off the input's")


def tets_only(cells):
    return {"tet": cells["tet"]}


# ---- meshes: whole coordinates, so that the checker of the candidates decides exactly


def determinant(points, tet):
    a, b, c, d = (points[v] for v in tet)
    return round(np.linalg.det(np.array([b - a, c - a, d - a], dtype=float)))


def delaunay(points, random_numbers):
    """Tets of positive volume and their regions."""
    points = np.unique(points, axis=0)
    tets = []
    for tet in Delaunay(points).simplices.tolist():
        volume = determinant(points, tet)
        if volume < 0:
            tet[2], tet[3] = tet[3], tet[2]
        if volume != 0:
            tets.append(tet)
    random_numbers.shuffle(tets)
    return points, tets, [1] * len(tets)


def points_in_general(rng, n, size=60):
    return np.array([[rng.randrange(size) for _ in range(3)] for _ in range(n)])


def general(rng):
    return delaunay(points_in_general(rng, rng.randrange(5, 28)), rng)


def flat(rng):
    points = points_in_general(rng, rng.randrange(8, 24))
    points[:, 2] = points[:, 2] % 3
    return delaunay(points, rng)


def coplanar(rng):
    points = points_in_general(rng, rng.randrange(10, 26))
    points[:, rng.randrange(3)] //= 20
    return delaunay(points, rng)


def lattice(rng):
    """Cubes cut in six or five tets each, moved a little or not, but never so far that a tet turns over."""
    size = [rng.randrange(1, 4) for _ in range(3)]
    kind = rng.choice(["kuhn", "five"])
    number = lambda p: (p[0] * (size[1] + 1) + p[1]) * (size[2] + 1) + p[2]
    shake = rng.choice([0, 0, 1, 3])
    points = np.array([[10 * c + rng.randint(-shake, shake) for c in (i, j, k)] for i in range(size[0] + 1)
                       for j in range(size[1] + 1) for k in range(size[2] + 1)])
    tets = []
    for i in range(size[0]):
        for j in range(size[1]):
            for k in range(size[2]):
                for local in cube_tets(kind, (i + j + k) % 2):
                    tets.append([number((i + a, j + b, k + c)) for a, b, c in local])
    straight = np.array([[10 * c for c in p] for p in itertools.product(*(range(n + 1) for n in size))])
    for tet in tets:
        if determinant(straight, tet) < 0:
            tet[2], tet[3] = tet[3], tet[2]
    turned = any(determinant(points, tet) <= 0 for tet in tets)
    return straight if turned else points, tets, [1] * len(tets)


def cube_tets(kind, odd):
    if kind == "kuhn":
        for order in itertools.permutations(range(3)):
            at, tet = [0, 0, 0], [(0, 0, 0)]
            for axis in order:
                at[axis] = 1
                tet.append(tuple(at))
            yield tet
        return
    even = [(0, 0, 0), (1, 1, 0), (1, 0, 1), (0, 1, 1)]
    uneven = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]
    cut_off, centre = (uneven, even) if odd else (even, uneven)
    yield centre
    for corner in cut_off:
        yield [corner] + [tuple(x ^ (axis == i) for i, x in enumerate(corner)) for axis in range(3)]


def regions(rng):
    points, tets, _ = rng.choice([general, lattice])(rng)
    plane = np.array([rng.uniform(-1, 1) for _ in range(3)])
    heights = [float(points[tet].mean(axis=0) @ plane) for tet in tets]
    cut = sorted(heights)[len(heights) // 2]
    return points, tets, [1 if h < cut else 2 for h in heights]


def apart(rng):
    """Two parts that share nothing, or one vertex, in which they touch."""
    (left, left_tets, left_tags), (right, right_tets, right_tags) = (rng.choice([general, lattice])(rng) for _ in "ab")
    last, first = left[:, 0].argmax(), right[:, 0].argmin()
    right = right + (left[last] - right[first])
    number = list(range(len(left), len(left) + len(right)))
    if rng.random() < 0.5:
        right = right + np.array([rng.randrange(1, 30), 0, 0])
    else:
        number[first] = int(last)
    moved = [[number[v] for v in tet] for tet in right_tets]
    return np.concatenate([left, right]), left_tets + moved, left_tags + right_tags


def with_holes(rng):
    """Not convex, perhaps in several parts or touching itself in edges and vertices."""
    points, tets, tags = rng.choice([general, lattice])(rng)
    kept = [tet for tet in tets if rng.random() < 0.8] or tets
    return points, kept, tags[: len(kept)]


MESHES = {"general": general, "flat": flat, "coplanar": coplanar, "lattice": lattice, "regions": regions, "apart": apart,
          "holes": with_holes}


def write_mesh(path, mesh):
    points, tets, tags = mesh
    with open(path, "w") as file:
        print("MeshVersionFormatted 2\nDimension 3\nVertices\n%d" % len(points), file=file)
        for p in points:
            print(*p, 0, file=file)
        print("Tetrahedra\n%d" % len(tets), file=file)
        for tet, tag in zip(tets, tags):
            print(*(v + 1 for v in tet), tag, file=file)
        print("End", file=file)


def judge_mesh(directory, mesh, seed):
    rng = random.Random(seed)
    write_mesh(directory / "part.mesh", mesh)
    choice = ["--cells", "hex,prism,pyramid"] if rng.random() < 0.5 else []
    if rng.random() < 0.3:
        choice += ["--min-quality", "0.2"]
    tool(directory, "findhex", "--mesh", "part.mesh", *choice, "-o", "part.cand")
    report = check(directory, "candidates_check.py", "part.mesh", "part.cand", *choice)
    require(" 0 missing, 0 extra, 0 with other tets" in report, report)
    tool(directory, "buildgraph", "--candidates", "part.cand", "-o", "part.graph")
    check(directory, "graph_check.py", "part.graph")
    check(directory, "graph_from_candidates.py", "part.cand", "part.graph")
    judge_choice(directory, seed)
    smooth = rng.choice(["0", "5"])
    tool(directory, "assemble", "--mesh", "part.mesh", "--candidates", "part.cand", "--solution", "part.sol", "--smooth",
         smooth, "-o", "part.vtk")
    stats = json.loads(check(directory, "meshstats.py", "--json", "--exact", "part.vtk"))
    require("error" not in stats, stats)
    for key in ("open_quads", "twisted_quads", "inverted_cells", "invalid_hexes", "negative_volumes", "duplicate_cells"):
        require(stats[key] == 0, f"{key}: {stats}")
    judge_assembled(directory, "part.mesh", "part.vtk", smooth != "0")


# ---- graphs


def random_graph(rng):
    n = rng.choice([1, 2, 5, 20, 60, 200])
    weights = [rng.choice([0, 1, rng.randrange(1, 100), 10**12]) if rng.random() < 0.2 else rng.randrange(1, 50)
               for _ in range(n)]
    edges = set()
    form = rng.choice(["sparse", "dense", "cliques", "star", "none"])
    if form in ("sparse", "dense"):
        share = min(1, 3 / n) if form == "sparse" else 0.5
        edges = {(a, b) for a in range(n) for b in range(a) if rng.random() < share}
    elif form == "cliques":
        for _ in range(n):
            members = rng.sample(range(n), min(n, rng.randrange(2, 7)))
            edges |= {(max(a, b), min(a, b)) for a in members for b in members if a != b}
    elif form == "star":
        edges = {(a, 0) for a in range(1, n)}
    return weights, sorted(edges)


def write_graph(path, graph):
    weights, edges = graph
    lists = [[] for _ in weights]
    for a, b in edges:
        lists[a].append(b + 1)
        lists[b].append(a + 1)
    with open(path, "w") as file:
        print(len(weights), len(edges), 10, file=file)
        for weight, row in zip(weights, lists):
            print(weight, *sorted(row), file=file)


def weight_of(report):
    return int(report.split("weight ")[1].split(",")[0].split()[0])


def judge_choice(directory, seed):
    """part.graph to part.sol: each stage valid and no worse, and a bound that an optimum cannot pass."""
    rng = random.Random(seed)
    method = rng.choice(["anneal", "tabu"])
    tool(directory, "initsol", "--graph", "part.graph", "--iterations", rng.choice([0, 300]), "--method", method, "--seed",
         seed, "-o", "start.sol")
    first = weight_of(check(directory, "solution_check.py", "part.graph", "start.sol"))
    for threads in (1, 2):
        tool(directory, "lns", "--graph", "part.graph", "--solution", "start.sol", "--iterations", 20, "--seed", seed,
             "--threads", threads, "-o", f"part{threads}.sol")
    require((directory / "part1.sol").read_bytes() == (directory / "part2.sol").read_bytes(), "1 and 2 threads differ")
    (directory / "part1.sol").rename(directory / "part.sol")
    second = weight_of(check(directory, "solution_check.py", "part.graph", "part.sol"))
    require(second >= first, f"lns made {second} out of {first}")
    tool(directory, "certify", "--graph", "part.graph", "--solution", "part.sol", "--iterations", 20, "--certificate",
         "proof", "-o", "same.sol")
    bound = int(check(directory, "bound_check.py", "part.graph", "proof").split()[1])
    require(bound >= second, f"a bound of {bound} under a weight of {second}")


# ---- surfaces


def outward(points, faces, middle):
    for a, b, c in faces:
        yield (a, b, c) if np.dot(np.cross(points[b] - points[a], points[c] - points[a]), points[a] - middle) > 0 else (a, c, b)


def convex_surface(rng):
    points = points_in_general(rng, rng.randrange(6, 20), 40)
    hull = ConvexHull(points)
    return points.tolist(), list(outward(points, hull.simplices.tolist(), points[hull.vertices].mean(axis=0)))


def blocks(rng):
    """Boxes of a grid that grew at random: not convex, perhaps with handles, perhaps in two pieces."""
    grown = {(0, 0, 0)}
    for _ in range(rng.randrange(1, 14)):
        cell, axis = rng.choice(sorted(grown)), rng.randrange(3)
        grown.add(tuple(c + rng.choice([-1, 1]) * (i == axis) for i, c in enumerate(cell)))
    if rng.random() < 0.2:
        grown.add((rng.randrange(9), 9, 9))
    return grown


def in_one_piece(cells):
    """Over facets; nothing is in one piece too."""
    left = set(cells)
    reached = [left.pop()] if left else []
    for cell in reached:
        near = {p for p in left if sum(abs(x - y) for x, y in zip(p, cell)) == 1}
        left -= near
        reached += near
    return not left


def is_manifold(cells):
    """Around each corner what is inside is in one piece, and what is outside."""
    steps = list(itertools.product((0, 1), repeat=3))
    for corner in {tuple(c + s for c, s in zip(cell, step)) for cell in cells for step in steps}:
        around = {tuple(c - s for c, s in zip(corner, step)) for step in steps}
        if not (in_one_piece(around & cells) and in_one_piece(around - cells)):
            return False
    return True


def stepped_surface(rng):
    cells = blocks(rng)
    while not is_manifold(cells):
        cells = blocks(rng)
    planes = [list(itertools.accumulate(rng.randrange(2, 9) for _ in range(40))) for _ in range(3)]
    number, faces = {}, []
    for cell in sorted(cells):
        for axis, side in itertools.product(range(3), (0, 1)):
            if tuple(c + (2 * side - 1) * (i == axis) for i, c in enumerate(cell)) in cells:
                continue
            quad = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)) if side else ((0, 0), (0, 1), (1, 1), (1, 0)):
                corner = list(cell)
                corner[axis] += side
                corner[(axis + 1) % 3] += u
                corner[(axis + 2) % 3] += v
                quad.append(number.setdefault(tuple(corner), len(number)))
            faces += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
    return [[planes[i][c + 20] for i, c in enumerate(corner)] for corner in number], faces


def random_surface(rng):
    """With whole coordinates."""
    return rng.choice([convex_surface, stepped_surface])(rng)


def write_surface(path, surface):
    points, faces = surface
    with open(path, "w") as file:
        print("OFF\n%d %d 0" % (len(points), len(faces)), file=file)
        for p in points:
            print(*p, file=file)
        for face in faces:
            print(3, *face, file=file)


def area_of(surface):
    points, faces = surface
    corners = np.array(points, dtype=float)[np.array(faces)]
    return np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2


def judge_surface(directory, surface, seed):
    rng = random.Random(seed)
    points, faces = surface
    write_surface(directory / "part.off", surface)
    try:
        require("is_solid=True" in check(directory, "surfcheck.py", "part.off"), "the surface itself is bad")
    except Failure as failure:
        raise BadCase(str(failure)) from None
    volume = sum(float(np.linalg.det(np.array([points[v] for v in face], dtype=float))) for face in faces) / 6
    share, kind = rng.choice([0.15, 0.25]), rng.choice(["remesh", "keep"])
    inside = rng.choice(["best", "lattice", "frame", "none"])
    improve = [] if inside == "none" else rng.choice([[], ["--improve", "4"]])
    tool(directory, "tetmesh", "part.off", "--size", f"{100 * share:g}%", "--seed", seed, "--surface", kind, "--points", inside,
         *improve, "-o", "part.mesh")
    judge_remeshed(directory, surface, volume, share if kind == "remesh" else 0)
    tool(directory, "findhex", "--mesh", "part.mesh", "-o", "part.cand")
    tool(directory, "buildgraph", "--candidates", "part.cand", "-o", "part.graph")
    judge_choice(directory, seed)
    tool(directory, "assemble", "--mesh", "part.mesh", "--candidates", "part.cand", "--solution", "part.sol", "-o", "part.vtk")
    stats = json.loads(check(directory, "meshstats.py", "--json", "--exact", "part.vtk"))
    for key in ("facets_of_three_cells", "open_quads", "twisted_quads", "odd_boundary_edges", "inverted_cells", "invalid_hexes", "negative_volumes", "duplicate_cells", "unused_points"):
        require(stats[key] == 0, f"{key}: {stats}")
    judge_assembled(directory, "part.mesh", "part.vtk", True)


def judge_remeshed(directory, surface, volume, size_share):
    """part.mesh against the surface: as near as promised for sizes of this share of the diagonal, of 0 the same."""
    points, cells = MESHSTATS["read"](str(directory / "part.mesh"))
    given = np.array(surface[0], dtype=float)
    before, after = given[np.array(surface[1])], points[np.array(skin(tets_only(cells))[0])]
    diagonal = np.linalg.norm(np.ptp(given, axis=0))
    most = max(REMESHING * size_share, 1e-9) * diagonal
    for these, others in ((before, after), (after, before)):
        samples = np.concatenate([these.mean(axis=1), these.reshape(-1, 3), (these + np.roll(these, 1, axis=1)).reshape(-1, 3) / 2])
        off = farthest(samples, others)
        require(off <= 1.001 * most, f"the surfaces are {off} apart, expected {most} at most")
    made = MESHSTATS["tetvol"](points, cells["tet"]).sum()
    room = min(area_of(surface) * most, 2 * REMESHING * volume) if size_share else 1e-9 * volume
    require(abs(made - volume) <= room, f"a mesh of volume {made} in a surface of {volume}, expected {room} more or less at most")


# ---- cases


def judge(kind, case, seed, shrinking=False):
    """None, or what is wrong."""
    with tempfile.TemporaryDirectory() as directory:
        directory = pathlib.Path(directory)
        try:
            if kind in MESHES:
                judge_mesh(directory, case, seed)
            elif kind == "graph":
                write_graph(directory / "part.graph", case)
                judge_choice(directory, seed)
            else:
                judge_surface(directory, case, seed)
        except BadCase as failure:
            return None if shrinking else str(failure)
        except Failure as failure:
            return str(failure)
    return None


def components(faces):
    """Lists of faces that hang together by vertices."""
    parts = []
    for face in faces:
        near = [part for part in parts if part[0] & set(face)]
        parts = [part for part in parts if part not in near]
        parts.append((set(face).union(*(part[0] for part in near)), [f for part in near for f in part[1]] + [face]))
    return [part[1] for part in parts]


def without_unused(points, faces):
    used = sorted({v for face in faces for v in face})
    number = {v: i for i, v in enumerate(used)}
    return [points[v] for v in used], [tuple(number[v] for v in face) for face in faces]


def smaller_surfaces(points, faces):
    """Without one of its pieces, or with the ends of an edge made one, which leaves a closed surface closed."""
    parts = components(faces)
    if len(parts) > 1:
        for part in parts:
            yield without_unused(points, [face for face in faces if face not in part])
    for gone, stays in sorted({(face[i], face[i - 1]) for face in faces for i in range(3)}):
        rest = [tuple(stays if v == gone else v for v in face) for face in faces if not {gone, stays} <= set(face)]
        if len(rest) >= 4:
            yield without_unused(points, rest)


def smaller(kind, case):
    """Parts of the case, the small ones first."""
    if kind in MESHES:
        points, tets, tags = case
        for size in (len(tets) // 2, len(tets) // 4, len(tets) // 8, 1):
            for start in range(0, len(tets), max(size, 1)):
                rest = [i for i in range(len(tets)) if not start <= i < start + size]
                if size and rest:
                    yield points, [tets[i] for i in rest], [tags[i] for i in rest]
    elif kind == "graph":
        weights, edges = case
        for gone in range(len(weights)):
            place = lambda v: v - (v > gone)
            yield weights[:gone] + weights[gone + 1 :], [(place(a), place(b)) for a, b in edges if gone not in (a, b)]
    else:
        yield from smaller_surfaces(*case)


def shrink(kind, case, seed, seconds=60):
    end = time.monotonic() + seconds
    found = True
    while found and time.monotonic() < end:
        found = False
        for part in smaller(kind, case):
            if time.monotonic() > end:
                break
            if judge(kind, part, seed, shrinking=True):
                case, found = part, True
                break
    return case


def keep(directory, kind, case, seed):
    directory.mkdir(parents=True, exist_ok=True)
    if kind in MESHES:
        write_mesh(directory / f"{kind}-{seed}.mesh", case)
    elif kind == "graph":
        write_graph(directory / f"{kind}-{seed}.graph", case)
    else:
        write_surface(directory / f"{kind}-{seed}.off", case)


def main():
    kinds = {**MESHES, "graph": random_graph, "surface": random_surface}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--keep", type=pathlib.Path, default="failed-cases")
    parser.add_argument("kinds", nargs="*", choices=[[], *kinds])
    options = parser.parse_args()
    first = time.time_ns() % 10**9 if options.seed == "new" else int(options.seed)
    chosen = options.kinds or [kind for kind in kinds if kind != "surface" or (BIN / "tetmesh").exists()]
    counts, failures = {}, 0
    for seed in range(first, first + options.cases):
        kind = chosen[seed % len(chosen)]
        case = kinds[kind](random.Random(seed))
        counts[kind] = counts.get(kind, 0) + 1
        wrong = judge(kind, case, seed)
        if wrong is None:
            continue
        failures += 1
        print(f"{kind}, seed {seed}: {wrong}", flush=True)
        keep(options.keep, kind, shrink(kind, case, seed), seed)
    print(", ".join(f"{count} {kind}" for kind, count in counts.items()), f"from seed {first}: {failures} failed")
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
