#!/usr/bin/python3
"""parts.py [--parts K...] [--lattice N] [--model FILE --size SIZE] [--huge] - what it costs to work in parts, and that it changes nothing.

A lattice of five tets a cube of N x N x N cubes (or the tets that tetmesh fills a model with) goes through findhex and
buildgraph as a whole, and in K parts through mesh-part, findhex and buildgraph of each, and merge-parts. Printed are tets a
part, ghosts and halo in percent of what is the part's own, processor seconds of all parts together against those of the
whole, and the peak memory of a part against that of the whole. Ends with 1 when what is merged has not the bytes of the whole.
--huge merges a graph whose array of neighbours takes 8.8 GB, through pipes.
"""
import argparse
import filecmp
import glob
import io
import json
import os
import subprocess
import sys
import tarfile
import tempfile

import numpy as np

import bench_meshes as meshes


def members(path, *names):
    with tarfile.open(path) as tar:
        return [np.load(io.BytesIO(tar.extractfile(name).read())) for name in names]


def halo_share(path, part):
    owners, = members(path, "candidates/part.npy")
    own = int((owners == part).sum())
    return 100 * (len(owners) - own) / max(own, 1)


def write_mesh(path, points, tets):
    """With tags, as tools write it: merge-parts does not leave out what may be missing."""
    triangles = np.zeros((0, 3), "<i4")
    arrays = {"points": points, "tets": tets.astype("<i4"), "tet_tags": np.zeros(len(tets), "<i4"), "triangles": triangles,
              "triangle_tags": np.zeros(0, "<i4")}
    with tarfile.open(path, "w", format=tarfile.PAX_FORMAT) as tar:
        for name, array in arrays.items():
            data = io.BytesIO()
            np.save(data, array)
            member = tarfile.TarInfo(f"mesh/{name}.npy")
            member.size = data.tell()
            data.seek(0)
            tar.addfile(member, data)


def single_run():
    find = meshes.run([meshes.tool("findhex"), "-q", "mesh.tar", "-o", "candidates.tar"])
    build = meshes.run([meshes.tool("buildgraph"), "-q", "candidates.tar", "-o", "graph.tar"])
    return find, build


def run_parts(count):
    split = meshes.run([meshes.tool("mesh-part"), "-q", "mesh.tar", "--parts", count, "--stats", "split.json", "-o", "parts"])
    find, build = [], []
    for path in sorted(glob.glob("parts/*")):
        find.append(meshes.run([meshes.tool("findhex"), "-q", path, "-o", path.replace("parts/part", "candidates")]))
    for path in sorted(glob.glob("candidates-*")):
        build.append(meshes.run([meshes.tool("buildgraph"), "-q", path, "--neighbours", *sorted(glob.glob("candidates-*")),
                                 "-o", path.replace("candidates", "graph")]))
    return split, find, build


def total(runs):
    return sum(seconds for seconds, _ in runs), max(peak for _, peak in runs)


def report(count, whole, split, find, build, merge):
    with open("split.json") as file:
        counts = json.load(file)
    halo = np.mean([halo_share(path, part) for part, path in enumerate(sorted(glob.glob("graph-*")))])
    row = [count, counts["tets"] // count, f"{100 * counts['ghost_tets'] / counts['tets']:.0f}", f"{halo:.0f}", counts["most_neighbours"],
           f"{split[0]:.1f}"]
    for of_whole, runs in zip(whole, (find, build)):
        seconds, peak = total(runs)
        row += [f"{seconds:.1f} / {of_whole[0]:.1f}", f"{peak / 2**20:.0f} / {of_whole[1] / 2**20:.0f}"]
    row += [f"{merge[0]:.1f}", f"{merge[1] / 2**20:.0f}"]
    print("|", " | ".join(map(str, row)), "|", flush=True)


def compare(count, whole):
    split, find, build = run_parts(count)
    merge = meshes.run([meshes.tool("merge-parts"), *sorted(glob.glob("graph-*")), "-o", "merged.tar"])
    report(count, whole, split, find, build, merge)
    same = filecmp.cmp("merged.tar", "graph.tar", shallow=False)
    subprocess.run("rm -rf parts candidates-* graph-* merged.tar", shell=True, check=True)
    return same


class Zeros(io.RawIOBase):
    """So many bytes, all 0."""
    def __init__(self, size):
        self.left = size

    def readinto(self, buffer):
        count = min(len(buffer), self.left)
        buffer[:count] = bytes(count)
        self.left -= count
        return count


def write_huge(file, neighbours):
    """A part of one part: two candidates that list that many neighbours each, more than 8 GiB in all."""
    about = {"part": 0, "parts": 1, "neighbours": [], "mesh": {"points": 0, "tets": 0, "triangles": 0, "checksum": "0"}}
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<i4", "fortran_order": False, "shape": (2 * neighbours,)})
    small = {"candidates/key.npy": np.arange(2, dtype="<u8"), "candidates/part.npy": np.zeros(2, "<i4"),
             "graph/offsets.npy": np.array([0, neighbours, 2 * neighbours])}
    with tarfile.open(fileobj=file, mode="w|", format=tarfile.PAX_FORMAT) as tar:
        def add(name, size, content):
            member = tarfile.TarInfo(name)
            member.size = size
            tar.addfile(member, content)
        text = json.dumps(about).encode()
        add("mesh/part.json", len(text), io.BytesIO(text))
        for name, array in small.items():
            data = io.BytesIO()
            np.save(data, array)
            add(name, data.tell(), io.BytesIO(data.getvalue()))
        size = header.tell() + 8 * neighbours
        add("graph/neighbours.npy", size, io.BufferedReader(Joined(header.getvalue(), Zeros(8 * neighbours)), 1 << 20))


class Joined(io.RawIOBase):
    def __init__(self, first, rest):
        self.first, self.rest = first, rest

    def readinto(self, buffer):
        if not self.first:
            return self.rest.readinto(buffer)
        count = min(len(buffer), len(self.first))
        buffer[:count], self.first = self.first[:count], self.first[count:]
        return count

    def readable(self):
        return True


def merge_huge():
    neighbours = 1_100_000_000
    os.mkfifo("part.tar")
    merge = subprocess.Popen([meshes.tool("merge-parts"), "part.tar"], stdout=subprocess.PIPE)
    if os.fork() == 0:
        with open("part.tar", "wb") as file:
            write_huge(file, neighbours)
        os._exit(0)
    sizes = {}
    with tarfile.open(fileobj=merge.stdout, mode="r|") as tar:
        for member in tar:
            sizes[member.name] = member.size
    _, status, usage = os.wait4(merge.pid, 0)
    print(f"{sizes['graph/neighbours.npy']} bytes of neighbours merged: {usage.ru_utime + usage.ru_stime:.1f} s, "
          f"{usage.ru_maxrss >> 10} MiB, status {status}")
    return status == 0 and sizes["graph/neighbours.npy"] == 8 * neighbours + 128


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", type=int, nargs="+", default=[1, 4, 16])
    parser.add_argument("--lattice", type=int, default=40)
    parser.add_argument("--model")
    parser.add_argument("--size", default="3")
    parser.add_argument("--huge", action="store_true")
    options = parser.parse_args()
    if options.model:
        options.model = os.path.abspath(options.model)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if options.huge:
            sys.exit(0 if merge_huge() else 1)
        if options.model:
            meshes.run([meshes.tool("tetmesh"), "-q", options.model, "--size", options.size, "-o", "mesh.tar"])
        else:
            write_mesh("mesh.tar", *meshes.five(options.lattice))
        whole = single_run()
        print("| parts | tets each | ghosts % | halo % | neighbours | split s | findhex s, parts / whole | MiB | buildgraph s | MiB | merge s | MiB |")
        print("|" + "---|" * 12)
        differ = [count for count in options.parts if not compare(count, whole)]
        print("merged bytes:", f"other than the whole's with {differ} parts" if differ else "those of the whole")
        os.chdir("/")
    sys.exit(1 if differ else 0)


main()
