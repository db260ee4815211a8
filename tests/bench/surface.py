#!/usr/bin/python3
"""surface.py [--triangles N] - how long tetmesh takes to read and check a large surface.

Writes a sphere of about N triangles (3 million) as a binary STL, and as one with each hundredth triangle turned, and runs tetmesh on
them with no time for TetGen, so that it ends after reading and checking (of the second: reading, and --repair too). Prints
processor seconds and peak memory. The tool is taken from build/bin, or from HEXPIPE_BIN.
"""
import argparse
import os
import subprocess
import tempfile

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HEXPIPE_BIN", os.path.join(ROOT, "build", "bin"))


def sphere(bands):
    """Triangles of a sphere of `bands` bands of latitude and twice as many of longitude, outward."""
    latitude, longitude = np.pi * np.arange(bands + 1) / bands, np.pi * np.arange(2 * bands) / bands
    points = np.stack([np.outer(np.sin(latitude), np.cos(longitude)), np.outer(np.sin(latitude), np.sin(longitude)),
                       np.outer(np.cos(latitude), np.ones_like(longitude))], axis=-1)
    points[0], points[-1] = (0, 0, 1), (0, 0, -1)
    points = points.astype("<f4")
    upper, lower = points[:-1], points[1:]
    next_upper, next_lower = np.roll(upper, -1, axis=1), np.roll(lower, -1, axis=1)
    return np.vstack([np.stack([upper, lower, next_upper], axis=2)[1:].reshape(-1, 9),
                      np.stack([next_upper, lower, next_lower], axis=2)[:-1].reshape(-1, 9)])


def write_stl(name, triangles):
    facets = np.zeros(len(triangles), dtype=[("normal", "<3f4"), ("corners", "<9f4"), ("attribute", "<u2")])
    facets["corners"] = triangles
    with open(name, "wb") as file:
        file.write(b"\0" * 80 + np.uint32(len(facets)).tobytes() + facets.tobytes())


def measure(*options):
    process = subprocess.Popen([os.path.join(BIN, "tetmesh"), "-q", "--surface", "keep", "--points", "none", "--tetgen-timeout",
                                "0.001", "-o", os.devnull, "--format", "mesh", *options], stderr=subprocess.PIPE)
    said = process.stderr.read().decode()
    _, _, usage = os.wait4(process.pid, 0)
    assert "longer than --tetgen-timeout" in said, said
    return f"{usage.ru_utime + usage.ru_stime:.1f} | {usage.ru_maxrss // 1024}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--triangles", type=float, default=3e6)
    bands = int((parser.parse_args().triangles / 4) ** 0.5)
    with tempfile.TemporaryDirectory() as folder:
        triangles = sphere(bands)
        name = os.path.join(folder, "sphere.stl")
        write_stl(name, triangles)
        print("| surface | triangles | s | MiB |\n|---|---|---|---|")
        print(f"| sphere, read and checked | {len(triangles)} | {measure(name)} |")
        triangles[::100] = triangles[::100, [0, 1, 2, 6, 7, 8, 3, 4, 5]]
        write_stl(name, triangles)
        print(f"| every hundredth turned, read, repaired and checked | {len(triangles)} | {measure(name, '--repair')} |")


if __name__ == "__main__":
    main()
