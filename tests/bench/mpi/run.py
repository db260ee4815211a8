#!/usr/bin/python3
"""run.py weak [--ranks 1,2,4,8,16] [--vertices N] - how lns-mpi scales, by counted communication.

`weak` gives every rank a block of a conflict graph of the same size: points at random in a box that grows with the ranks,
an edge where two are nearer than the distance that makes the average degree 65, as conflict graphs of cells have it.
Ranks may be more than the machine has processors: what they send is counted, not timed. A row for each number of ranks:
vertices that a rank holds for each that it owns, what it sends to set up the halos and in a round, and memory.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.spatial import cKDTree

ROOT = pathlib.Path(__file__).resolve().parents[3]
DEGREE = 65
MPI = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def write_points_graph(path, vertices, seed):
    """Unit density; the radius holds DEGREE others on the average."""
    rng = np.random.default_rng(seed)
    points = rng.random((vertices, 3)) * vertices ** (1 / 3)
    radius = (DEGREE / (4 / 3 * np.pi)) ** (1 / 3)
    pairs = cKDTree(points).query_pairs(radius, output_type="ndarray")
    both = np.concatenate([pairs, pairs[:, ::-1]])
    both = both[np.lexsort((both[:, 1], both[:, 0]))]
    rows = np.split(both[:, 1] + 1, np.searchsorted(both[:, 0], np.arange(1, vertices)))
    weights = rng.integers(500, 1500, vertices)
    with open(path, "w") as file:
        print(vertices, len(pairs), 10, file=file)
        for weight, row in zip(weights, rows):
            print(weight, *row.tolist(), file=file)


def run(bin_folder, folder, ranks, vertices, rounds, extra=()):
    graph, start, stats = folder / "points.graph", folder / "start.sol", folder / "stats.json"
    write_points_graph(graph, vertices * ranks, 1)
    subprocess.run([bin_folder / "initsol", graph, "--iterations", "0", "-o", start], check=True)
    done = subprocess.run(
        ["/usr/bin/time", "-f", "%M", "mpirun", "--oversubscribe", "-n", str(ranks), bin_folder / "lns-mpi", "--graph", graph,
         "--solution", start, "--blocks", str(ranks), "--threads", "1", "--round", "2", "--iterations",
         str(2 * vertices * ranks // 1000 * rounds), "--no-reductions", "--stats", stats, "-o", folder / "out.sol", *extra],
        env=MPI, check=True, stderr=subprocess.PIPE, text=True)
    result = json.load(open(stats))
    result["mebibytes"] = int(done.stderr.split()[-1]) / 1024
    return result


def weak(options):
    print("| ranks | vertices | held a vertex owned | most held | setup, KiB a rank | messages a round a rank | bytes a round a "
          "rank | MiB of the largest rank |")
    print("|" + " --- |" * 8)
    for ranks in map(int, options.ranks.split(",")):
        with tempfile.TemporaryDirectory() as name:
            r = run(options.bin, pathlib.Path(name), ranks, options.vertices, options.rounds)
        rounds = r["rounds"]
        print(f"| {ranks} | {r['vertices']:,} | {r['held_vertices'] / r['vertices']:.2f} | "
              f"{r['most_held_vertices'] / options.vertices:.2f} | {r['setup_bytes'] / ranks / 1024:,.0f} | "
              f"{r['round_messages'] / ranks / rounds:.1f} | {r['round_bytes'] / ranks / rounds:,.0f} | "
              f"{r['mebibytes']:.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["weak"])
    parser.add_argument("--ranks", default="1,2,4,8,16")
    parser.add_argument("--vertices", type=int, default=10000, help="of a rank")
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--bin", type=pathlib.Path, default=os.environ.get("HEXPIPE_BIN", ROOT / "build/bin"))
    options = parser.parse_args()
    options.bin = pathlib.Path(options.bin).resolve()
    if not (options.bin / "lns-mpi").exists():
        sys.exit(f"skipped: no lns-mpi in {options.bin}")
    weak(options)


if __name__ == "__main__":
    main()
