#!/usr/bin/python3
"""run.py weak [--ranks 1,2,4,8,16,32,64] [--vertices N] - how lns-mpi scales, by counted communication.
run.py equal GRAPH [--seconds S] [--ranks 1,2,4,8,16] [--seeds 1,2,3] [--optimum W] - lns-mpi and lns in the same CPU seconds, all told.
run.py points VERTICES - a graph for these on standard output.

`weak` gives every rank a block of a conflict graph of the same size: points at random in a box that grows with the ranks,
an edge where two are nearer than the distance that makes the average degree 65, as conflict graphs of cells have it.
Ranks may be more than the machine has processors: what they send is counted, not timed. A row for each number of ranks:
vertices that a rank holds for each that it owns, what it sends to set up the halos and in a round, and memory, of the first
rank, which reads and cuts the graph, and of the fullest other; beside them what the model of docs/many-machines.md predicts.

`equal` starts all from the same choice, a greedy one, in a bundle. The clock of each process is the CPU time that it has
used (../mwis/cpu_clock.c), a share of S seconds, so there may be more ranks than processors; ranks sleep while they
wait. The table has what the processes used together, and what their mean weight of all seeds is against that of lns.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
DEGREE = 65
MPI = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def write_points_graph(file, vertices, seed):
    """Unit density; the radius holds DEGREE others on the average."""
    from scipy.spatial import cKDTree
    rng = np.random.default_rng(seed)
    points = rng.random((vertices, 3)) * vertices ** (1 / 3)
    # As a mesh generator numbers: what is near is near in the file.
    points = points[np.lexsort(np.floor(points / 4).T)]
    radius = (DEGREE / (4 / 3 * np.pi)) ** (1 / 3)
    pairs = cKDTree(points).query_pairs(radius, output_type="ndarray").astype(np.int32)
    both = np.concatenate([pairs, pairs[:, ::-1]])
    edges = len(pairs)
    del pairs
    both = both[np.lexsort((both[:, 1], both[:, 0]))]
    ends = np.searchsorted(both[:, 0], np.arange(vertices + 1))
    weights = rng.integers(500, 1500, vertices).tolist()
    names = [str(number) for number in range(1, vertices + 1)]
    print(vertices, edges, 10, file=file)
    for v, weight in enumerate(weights):
        row = both[ends[v]:ends[v + 1], 1].tolist()
        file.write(f"{weight} {' '.join([names[u] for u in row])}\n")


# --- communication

def box(ranks):
    """Blocks along each axis, as even as can be."""
    sides = [1, 1, 1]
    while sides[0] * sides[1] * sides[2] < ranks:
        sides[sides.index(min(sides))] *= 2
    return sides


class Model:
    """A block in a box of blocks, one for each rank: how thick its halo is, fitted on 8 ranks of 10,000 vertices."""
    thickness = 14.0

    def __init__(self, ranks, vertices):
        self.ranks = ranks
        self.sides = box(ranks)
        self.vertices = vertices

    def held(self, share=1.0):
        """Of a vertex owned, on the average; a block at an end of an axis has a neighbour on one side of it alone."""
        thick = share * self.thickness / self.vertices ** (1 / 3)
        return np.prod([1 + thick * (1 - 1 / side) for side in self.sides])

    def most_held(self):
        thick = self.thickness / self.vertices ** (1 / 3)
        return np.prod([1 + thick * (1 if side > 2 else 1 - 1 / side) for side in self.sides])

    def partners(self):
        """Blocks that meet in a corner are partners."""
        return np.prod([3 - 2 / side for side in self.sides]) - 1

    def setup_bytes(self):
        """The first rank sends a block, 12 bytes a neighbour; neighbours send the halo, 8, but not in the last of its three
        layers, whose rows nobody needs."""
        block = self.vertices * (12 * DEGREE + 29) * (self.ranks - 1) / self.ranks
        return block + self.vertices * ((self.held(2 / 3) - 1) * 8 * DEGREE + (self.held() - 1) * 41)

    def mebibytes(self, base):
        """12 bytes a neighbour in rows as read, 8 in rows that came, and 8 in both put together."""
        return base + DEGREE * self.vertices * (4 + 16 * self.most_held()) / 2 ** 20


def run(bin_folder, folder, ranks, vertices, rounds, extra=()):
    graph, start, stats = folder / "points.graph", folder / "start.sol", folder / "stats.json"
    with open(graph, "w") as file:
        write_points_graph(file, vertices * ranks, 1)
    subprocess.run([bin_folder / "initsol", graph, "--iterations", "0", "-o", start], check=True)
    done = subprocess.run(
        ["mpirun", "--oversubscribe", "-n", str(ranks), "/usr/bin/time", "-f", "memory %M", bin_folder / "lns-mpi", "--graph",
         graph, "--solution", start, "--blocks", str(ranks), "--threads", "1", "--round", "2", "--iterations",
         str(2 * vertices * ranks // 1000 * rounds), "--no-reductions", "--stats", stats, "-o", folder / "out.sol", *extra],
        env=MPI, check=True, stderr=subprocess.PIPE, text=True)
    result = json.load(open(stats))
    result["mebibytes"] = sorted(int(text) / 1024 for text in re.findall(r"memory (\d+)", done.stderr))
    return result


def weak(options):
    print("| ranks | vertices a rank | held a vertex owned | most held | partners a rank | setup, KiB a rank | messages a round "
          "a rank | bytes a round a rank | MiB of the first rank | of the fullest other |")
    print("|" + " --- |" * 10)
    base = None
    for ranks in map(int, filter(None, options.ranks.split(","))):
        with tempfile.TemporaryDirectory() as name:
            r = run(options.bin, pathlib.Path(name), ranks, options.vertices, options.rounds)
        rounds, memory = r["rounds"], r["mebibytes"]
        model = Model(ranks, options.vertices)
        if base is None and ranks > 1:
            base = memory[-2] - model.mebibytes(0)
        predicted_memory = f" ({model.mebibytes(base):.0f})" if ranks > 1 else ""
        others = f"{memory[-2]:.0f}" if ranks > 1 else "-"
        print(f"| {ranks} | {options.vertices:,} | {r['held_vertices'] / r['vertices']:.2f} ({model.held():.2f}) | "
              f"{r['most_held_vertices'] / options.vertices:.2f} ({model.most_held():.2f}) | "
              f"{r['partners'] / ranks:.1f} ({model.partners():.1f}) | "
              f"{r['setup_bytes'] / ranks / 1024:,.0f} ({model.setup_bytes() / 1024:,.0f}) | "
              f"{r['round_messages'] / ranks / rounds:.1f} ({2 * model.partners():.1f} at most) | "
              f"{r['round_bytes'] / ranks / rounds:,.0f} | {memory[-1]:.0f} | {others}{predicted_memory} |", flush=True)


# --- weight

def weight_of(stats):
    return json.load(open(stats))["weight"]


def timed(command, env):
    done = subprocess.run(["/usr/bin/time", "-f", "cpu %U %S", *map(str, command)], env=env, check=True,
                          stderr=subprocess.PIPE, text=True)
    return sum(map(float, re.findall(r"cpu (\S+) (\S+)", done.stderr)[-1]))


def equal(options):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        clock = folder / "cpu_clock.so"
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", HERE.parent / "mwis/cpu_clock.c", "-o", clock, "-ldl"], check=True)
        start, stats, out = folder / "start.tar", folder / "stats.json", folder / "out.sol"
        subprocess.run([options.bin / "initsol", options.graph, "--iterations", "0", "--format", "tar", "--stats", stats, "-o",
                        start], check=True)
        print(f"| | weight | {'below the optimum' if options.optimum else 'less than lns'} | CPU s |")
        print("| --- | --- | --- | --- |")
        print(f"| start | {weight_of(stats):,} | | |", flush=True)
        search = ["--threads", "1", "--stats", stats, "-q", "-o", out, *options.extra.split()]
        against = options.optimum

        def row(title, command, env):
            nonlocal against
            weights, used = [], []
            for seed in options.seeds.split(","):
                used.append(timed([*command, *search, "--seed", seed], env))
                weights.append(weight_of(stats))
            mean = sum(weights) / len(weights)
            below = f"{100 * (1 - mean / against):.3f} %" if against else ""
            against = against or mean
            print(f"| {title} | {' · '.join(f'{weight:,}' for weight in weights)} | {below} | "
                  f"{sum(used) / len(used):.0f} |", flush=True)

        if not options.without_lns:
            row("lns, one thread", [options.bin / "lns", start, "--time-limit", options.seconds],
                dict(os.environ, LD_PRELOAD=str(clock)))
        for ranks in map(int, filter(None, options.ranks.split(","))):
            # Other transports measure their clock against the processor's when they start, and take seconds for it
            # where time goes by the work done.
            row(f"lns-mpi, {ranks} rank{'s' if ranks > 1 else ''}",
                ["mpirun", "--oversubscribe", "--mca", "pml", "ob1", "-n", ranks, "-x", f"LD_PRELOAD={clock}",
                 options.bin / "lns-mpi", start, "--time-limit", options.seconds / ranks], MPI)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="what", required=True)
    binaries = argparse.ArgumentParser(add_help=False)
    binaries.add_argument("--bin", type=pathlib.Path, default=os.environ.get("HEXPIPE_BIN", ROOT / "build/bin"))
    one = commands.add_parser("weak", parents=[binaries])
    one.add_argument("--ranks", default="1,2,4,8,16")
    one.add_argument("--vertices", type=int, default=10000, help="of a rank")
    one.add_argument("--rounds", type=int, default=4)
    two = commands.add_parser("equal", parents=[binaries])
    two.add_argument("graph", type=pathlib.Path)
    two.add_argument("--seconds", type=float, default=60)
    two.add_argument("--ranks", default="1,2,4")
    two.add_argument("--seeds", default="1")
    two.add_argument("--optimum", type=int, default=0)
    two.add_argument("--extra", default="", help="options of both")
    two.add_argument("--without-lns", action="store_true")
    three = commands.add_parser("points")
    three.add_argument("vertices", type=int)
    options = parser.parse_args()
    if options.what == "points":
        return write_points_graph(sys.stdout, options.vertices, 1)
    options.bin = pathlib.Path(options.bin).resolve()
    if not (options.bin / "lns-mpi").exists():
        sys.exit(f"skipped: no lns-mpi in {options.bin}")
    (weak if options.what == "weak" else equal)(options)


if __name__ == "__main__":
    main()
