"""Tet meshes of any size for the benchmarks: lattices, and Delaunay tetrahedra of lattice points that were moved."""
import io
import json
import os
import subprocess
import sys
import tarfile
import tempfile
import typing

import numpy as np
from scipy.spatial import Delaunay

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))


def grid(n):
    return np.stack(np.meshgrid(*[np.arange(n + 1.0)] * 3, indexing="ij"), -1).reshape(-1, 3)


def cubes(n):
    """The eight vertices of each cube of a grid of n: bit 0 of the corner along z, bit 1 along y, bit 2 along x."""
    i, j, k = (x.ravel() for x in np.meshgrid(*[np.arange(n)] * 3, indexing="ij"))
    vertex = lambda a, b, c: (i + a) * (n + 1) ** 2 + (j + b) * (n + 1) + k + c
    return np.stack([vertex(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)], -1), (i + j + k) % 2


def positive(points, tets):
    """Without the flat ones, the others turned to the positive sense."""
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    volume = np.einsum("ni,ni->n", edges[:, 0], np.cross(edges[:, 1], edges[:, 2]))
    tets, volume = tets[np.abs(volume) > 1e-9], volume[np.abs(volume) > 1e-9]
    return np.where((volume < 0)[:, None], tets[:, [0, 2, 1, 3]], tets).astype(np.int32)


def kuhn(n):
    """Six tets a cube, around the diagonal."""
    corners, _ = cubes(n)
    paths = [[0, a, a + b, 7] for a in (1, 2, 4) for b in (1, 2, 4) if b != a]
    return grid(n), positive(grid(n), np.concatenate([corners[:, path] for path in paths]))


def five(n):
    """Five tets a cube, turned from cube to cube."""
    corners, odd = cubes(n)
    tets = [[0, 3, 5, 6], [1, 0, 3, 5], [2, 0, 3, 6], [4, 0, 5, 6], [7, 3, 5, 6]]
    flipped = np.where(odd[:, None] == 1, corners[:, [7 ^ c for c in range(8)]], corners)
    return grid(n), positive(grid(n), np.concatenate([flipped[:, tet] for tet in tets]))


def jittered(n, share, seed=1):
    """Delaunay tets of points moved by up to this share of a cube's side. Points on the box stay on its sides, and move
    alike on opposite ones, so that boxes fit together."""
    points = grid(n)
    move = np.random.default_rng(seed).uniform(-share, share, (n, n, n, 3))
    index = points.astype(int)
    moved = points + np.where((index == 0) | (index == n), 0, move[tuple((index % n).T)])
    return moved, positive(moved, Delaunay(moved).simplices)


def random_points(count, seed=1):
    """Delaunay tets of points anywhere in a unit cube."""
    points = np.random.default_rng(seed).uniform(0, 1, (count, 3))
    simplices = Delaunay(points).simplices
    edges = points[simplices[:, 1:]] - points[simplices[:, :1]]
    negative = np.linalg.det(edges) < 0
    return points, np.where(negative[:, None], simplices[:, [0, 2, 1, 3]], simplices).astype(np.int32)


def tiled(tile, n, copies):
    """Copies of a box of n cubes along x, welded."""
    points, tets = tile
    right, left = np.flatnonzero(points[:, 0] == n), np.flatnonzero(points[:, 0] == 0)
    place = lambda side: side[np.lexsort(points[side][:, :0:-1].T)]
    right, left = place(right), place(left)
    fresh = np.setdiff1d(np.arange(len(points)), left)
    all_points, all_tets, number = [points], [tets], np.arange(len(points))
    count = len(points)
    for copy in range(1, copies):
        last = number
        number = np.empty(len(points), np.int64)
        number[left] = last[right]
        number[fresh] = count + np.arange(len(fresh))
        count += len(fresh)
        all_points.append(points[fresh] + [copy * n, 0, 0])
        all_tets.append(number[tets].astype(np.int32))
    return np.concatenate(all_points), np.concatenate(all_tets)


def write_bundle(path, mesh):
    with tarfile.open(path, "w", format=tarfile.PAX_FORMAT) as tar:
        for name, array in (("mesh/points.npy", mesh[0]), ("mesh/tets.npy", mesh[1].astype(np.int32))):
            buffer = io.BytesIO()
            np.save(buffer, array)
            member = tarfile.TarInfo(name)
            member.size = buffer.tell()
            buffer.seek(0)
            tar.addfile(member, buffer)
        buffer = io.BytesIO()
        np.save(buffer, np.zeros((0, 3), np.int32))
        member = tarfile.TarInfo("mesh/triangles.npy")
        member.size = buffer.tell()
        buffer.seek(0)
        tar.addfile(member, buffer)


def write_medit(path, mesh):
    points, tets = mesh
    with open(path, "w") as file:
        print(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(points)}", file=file)
        np.savetxt(file, np.c_[points, np.zeros(len(points))], fmt="%.17g %.17g %.17g %d")
        print(f"Tetrahedra\n{len(tets)}", file=file)
        np.savetxt(file, np.c_[tets + 1, np.ones(len(tets), int)], fmt="%d")
        print("End", file=file)


# The peak of a process counts what it was before it became the command: so a small one starts it.
STARTER = """
import json, os, sys
process = os.spawnvp(os.P_NOWAIT, sys.argv[2], sys.argv[2:])
_, status, usage = os.wait4(process, 0)
with open(sys.argv[1], "w") as file:
    json.dump([status, usage.ru_utime, usage.ru_stime, usage.ru_maxrss * 1024], file)
"""


class Usage(typing.NamedTuple):
    """Processor seconds and peak memory in bytes."""
    user: float
    system: float
    peak: int

    @property
    def seconds(self):
        return self.user + self.system


def run_apart(command, **options):
    """The usage of a command that has to succeed."""
    command = list(map(str, command))
    with tempfile.NamedTemporaryFile() as report:
        subprocess.run([sys.executable, "-S", "-c", STARTER, report.name, *command], check=True, **options)
        status, *usage = json.load(open(report.name))
    if status != 0:
        raise SystemExit(f"{' '.join(command)}: status {status}")
    return Usage(*usage)


def run(command, **options):
    """Processor seconds, user and system, and peak memory in bytes of a command that has to succeed."""
    usage = run_apart(command, **options)
    return usage.seconds, usage.peak


def run_pipe(*commands):
    """Likewise for commands that are piped into each other: seconds and peak memory of each."""
    with tempfile.TemporaryDirectory() as folder:
        processes, above = [], subprocess.DEVNULL
        for number, command in enumerate(commands):
            last = number + 1 == len(commands)
            processes.append(subprocess.Popen([sys.executable, "-S", "-c", STARTER, os.path.join(folder, str(number)),
                                               *map(str, command)], stdin=above,
                                              stdout=None if last else subprocess.PIPE))
            if above != subprocess.DEVNULL:
                above.close()
            above = processes[-1].stdout
        for process in processes:
            process.wait()
        reports = [json.load(open(os.path.join(folder, str(number)))) for number in range(len(commands))]
    for command, (status, *_) in zip(commands, reports):
        if status != 0:
            raise SystemExit(f"{' '.join(map(str, command))}: status {status}")
    return [(user + system, peak) for _, user, system, peak in reports]


def tool(name):
    return os.path.join(BIN, name)
