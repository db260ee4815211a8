#!/usr/bin/python3
"""run.py [--seconds S] [--threads N] [--seeds N] [--only WORD] [PEER...] GRAPH... - hexpipe and its peers.

Every solver gets the same METIS graph (plain or .zst), the same threads and the same CPU seconds for each of them: their
clocks are those of cpu_clock.c, preloaded, so that the figures do not depend on what else the machine does. A table for
each graph: weights after a tenth, half and all of the time, how far the last one is from the best in the table and from
the bound that `certify` proves, CPU seconds and memory in all. Our solutions are checked by
tests/checkers/solution_check.py where the graph is small enough. With several seeds the last weight is the mean, and the
worst and the best stand in brackets.

Ours is `initsol` for two fifths of the time, then `lns`. Peers are programs that are built elsewhere; each is left out
with a word when it is not there:
  CHILS                    --chils FILE, or CHILS in the environment; https://github.com/KarlsruheMIS/CHILS
  LearnAndReduce + CHILS   --learn-and-reduce FILE (its reduce_and_chils), or LEARN_AND_REDUCE in the environment;
                           https://github.com/KarlsruheMIS/LearnAndReduce; half of the time is for reductions
  GNN-VC, DynWVC2, FastWVC, HILS
                           --gnn-mwvc FOLDER, or GNN_MWVC in the environment; https://github.com/KennethLangedal/GNN-MWVC.
                           They have one thread, and so get the time of all
Published figures for the graphs of ../shared/graphs (40 CPU s, one thread, one seed; its README.md) stand below them.
Without graphs it takes these three.
"""
import argparse
import dataclasses
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
CHECKED_UP_TO = 100_000_000  # bytes of graph
START_SHARE = 0.4  # of the time for initsol
PARTS = (0.1, 0.5)
PUBLISHED = {
    "block-28k": {"LearnAndReduce + CHILS": 33_031_419, "GNN-VC": 33_028_596, "DynWVC2": 33_028_385,
                  "Bregman-Sinkhorn": 33_023_247, "CHILS -p 4": 33_005_878, "HILS": 32_966_136},
    "sphere-56k": {"CHILS -p 4": 68_962_670, "GNN-VC": 68_960_371, "DynWVC2": 68_955_718, "Bregman-Sinkhorn": 68_950_600},
    "random-33k": {"GNN-VC": 10_074_721, "CHILS -p 4": 10_062_724, "DynWVC2": 10_007_809, "Bregman-Sinkhorn": 9_849_615},
}


@dataclasses.dataclass
class Run:
    parts: list  # weights after the parts of the time, None where unknown
    weight: int
    cpu: float = 0
    mebibytes: float = 0
    note: str = ""


class Bench:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.clock = folder / "cpu_clock.so"
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", HERE / "cpu_clock.c", "-o", self.clock], check=True)

    def call(self, command):
        """Runs a solver on the CPU clock; its standard output, CPU seconds and largest memory."""
        threads = self.options.threads
        environment = dict(os.environ, CPU_CLOCK_THREADS=str(threads), OMP_NUM_THREADS=str(threads))
        usage = self.folder / "usage"
        done = subprocess.run(["/usr/bin/time", "-f", "%U %S %M", "-o", usage, "env", f"LD_PRELOAD={self.clock}",
                               *map(str, command)], stdout=subprocess.PIPE, text=True, env=environment, check=True)
        user, system, kibibytes = usage.read_text().split()[-3:]
        return done.stdout, float(user) + float(system), int(kibibytes) / 1024

    def ours(self, graph, seed, *extra):
        start, best = self.folder / "start.sol", self.folder / "best.sol"
        seconds = self.options.seconds
        cpu = memory = 0
        curve = []
        for tool, begin, end, arguments in (
                ("initsol", 0, START_SHARE * seconds, ["-o", start, "--starts", self.options.threads]),
                ("lns", START_SHARE * seconds, seconds, ["--solution", start, "-o", best, *extra])):
            log, stats = self.folder / "log.jsonl", self.folder / "stats.json"
            _, used, mebibytes = self.call(
                [self.options.bin / tool, "--graph", graph, "--threads", self.options.threads, "--seed", seed,
                 "--time-limit", end - begin, "--log", log, "--stats", stats, *arguments])
            cpu, memory = cpu + used, max(memory, mebibytes)
            points = [json.loads(line) for line in open(log)]
            curve += [(begin + point["seconds"], point["weight"]) for point in points]
        result = json.load(open(stats))
        self.check(graph, best, result["weight"])
        parts = [max((w for t, w in curve if t <= part * seconds), default=None) for part in PARTS]
        return Run(parts, result["weight"], cpu, memory, "optimal" if result["complete"] else "")

    def check(self, graph, solution, weight):
        if graph.stat().st_size > CHECKED_UP_TO:
            return
        checked = subprocess.run([ROOT / "tests/checkers/solution_check.py", graph, solution], capture_output=True, text=True)
        if not checked.stdout.rstrip().endswith(f"weight {weight}"):
            sys.exit(f"{graph}: {checked.stdout}")

    def chils(self, graph, seed, *extra):
        out, cpu, memory = self.call([self.options.chils, "-g", graph, "-t", self.options.seconds, "-r", seed, "-b",
                                      "-c", self.options.threads, *extra])
        tenth, half, last = map(int, out.strip().split(",")[3:6])
        return Run([tenth, half], last, cpu, memory)

    def learn_and_reduce(self, graph, seed):
        half = self.options.seconds / 2
        out, cpu, memory = self.call([self.options.learn_and_reduce, graph, f"--time_limit={half}", f"--seed={seed}",
                                      f"--chils_time_limit={half}", "--chils_n_solutions=4"])
        return Run([None, None], int(out.strip().splitlines()[-1].split(",")[-2]), cpu, memory)

    def cover(self, graph, command, field):
        """A solver that prints a line of fields, one of which is the weight of the vertices it leaves out."""
        out, cpu, memory = self.call([self.options.gnn_mwvc / command[0], *command[1:]])
        return Run([None, None], weight_of_all(graph) - int(out.strip().splitlines()[-1].split(",")[field]), cpu, memory)

    def gnn_vc(self, graph, seed):
        return self.cover(graph, ["GNN_VC", graph, self.folder / "cover", f"{self.options.seconds:g}", -1, 0], 2)

    def dyn_wvc(self, graph, seed):
        return self.cover(graph, ["DynWVC2", graph, seed, round(self.options.seconds), 0], 1)

    def fast_wvc(self, graph, seed):
        return self.cover(graph, ["FastWVC", graph, seed, round(self.options.seconds), 0], 1)

    def hils(self, graph, seed):
        out, cpu, memory = self.call([self.options.gnn_mwvc / "HILS", "-T", self.options.seconds, "-i", 10 ** 9, f"-s{seed}",
                                      graph])
        return Run([None, None], int(out.strip().splitlines()[-1].split(",")[1]), cpu, memory)

    def bound(self, graph):
        stats, solution = self.folder / "certify.json", self.folder / "best.sol"
        if not solution.exists():  # ours was not among those asked for
            self.call([self.options.bin / "initsol", "--graph", graph, "--iterations", 0, "-o", solution])
        self.call([self.options.bin / "certify", "--graph", graph, "--solution", solution, "--stats", stats,
                   "--time-limit", self.options.seconds, "-o", self.folder / "certified.sol"])
        return json.load(open(stats))["bound"]

    def chosen_solvers(self):
        return [(name, solve) for name, solve in self.solvers() if self.options.only in name]

    def solvers(self):
        options = self.options
        yield "hexpipe", self.ours
        if options.threads > 1:
            yield "hexpipe, free-running", lambda graph, seed: self.ours(graph, seed, "--free-running")
        if options.chils:
            yield "CHILS -p 1", lambda graph, seed: self.chils(graph, seed, "-p", 1)
            yield "CHILS -p 4 -s 1", lambda graph, seed: self.chils(graph, seed, "-p", 4, "-s", 1)
        if options.learn_and_reduce:
            yield "LearnAndReduce + CHILS", self.learn_and_reduce
        if options.gnn_mwvc:
            yield "GNN-VC", self.gnn_vc
            yield "DynWVC2", self.dyn_wvc
            yield "FastWVC", self.fast_wvc
            yield "HILS", self.hils


def weight_of_all(graph):
    with open(graph) as file:
        next(file)
        return sum(int(line.split(maxsplit=1)[0]) for line in file)


def plain_file(graph, folder):
    if graph.suffix != ".zst":
        return graph
    plain = folder / graph.stem
    with open(plain, "wb") as file:
        subprocess.run(["zstd", "-dqc", graph], stdout=file, check=True)
    return plain


def mean(runs):
    weights = [run.weight for run in runs]
    parts = [None if None in column else sum(column) // len(column) for column in zip(*(run.parts for run in runs))]
    note = f"{min(weights):,} … {max(weights):,}" if len(runs) > 1 else runs[0].note
    return Run(parts, sum(weights) // len(weights), sum(run.cpu for run in runs) / len(runs),
               max(run.mebibytes for run in runs), note)


def percent_below(weight, other):
    return f"{100 * (1 - weight / other):.3f} %"


def print_table(name, rows, bound, seconds):
    published = PUBLISHED.get(name, {})
    best = max([run.weight for run in rows.values()] + list(published.values()))
    print(f"\n{name}: proven bound {bound:,}\n")
    print("| solver | " + " | ".join(f"{part * seconds:g} s" for part in (*PARTS, 1)) +
          " | below the best | below the bound | CPU s | MiB |")
    print("|" + " --- |" * (len(PARTS) + 6))
    for solver, run in rows.items():
        last = f"{run.weight:,}" + (f" ({run.note})" if run.note else "")
        print("| " + " | ".join([solver, *(f"{w:,}" if w else "–" for w in run.parts), last,
                                 percent_below(run.weight, best), percent_below(run.weight, bound), f"{run.cpu:.1f}",
                                 f"{run.mebibytes:.0f}"]) + " |")
    for solver, weight in published.items():
        print(f"| {solver}, published, 40 s | – | – | {weight:,} | {percent_below(weight, best)} | "
              f"{percent_below(weight, bound)} | 40 | – |")
    sys.stdout.flush()


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("graphs", nargs="*", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--bin", type=pathlib.Path, default=os.environ.get("HEXPIPE_BIN", ROOT / "build/bin"))
    parser.add_argument("--chils", type=pathlib.Path, default=os.environ.get("CHILS"))
    parser.add_argument("--learn-and-reduce", type=pathlib.Path, default=os.environ.get("LEARN_AND_REDUCE"))
    parser.add_argument("--gnn-mwvc", type=pathlib.Path, default=os.environ.get("GNN_MWVC"))
    parser.add_argument("--only", default="", help="the solvers whose names hold this word")
    options = parser.parse_args()
    options.bin = pathlib.Path(options.bin).resolve()
    for peer in ("chils", "learn_and_reduce", "gnn_mwvc"):
        path = getattr(options, peer)
        if path is None or not pathlib.Path(path).exists():
            print(f"skipped: {peer.replace('_', '-')}: " + (f"no {path}" if path else "not given"))
            setattr(options, peer, None)
    return options


def main():
    options = parse_options()
    graphs = options.graphs or sorted((ROOT.parent / "shared/graphs").glob("*.graph.zst"))
    if not graphs:
        sys.exit("skipped: no graphs given, and none in ../shared/graphs")
    for graph in graphs:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            bench = Bench(options, folder)
            plain = plain_file(graph, folder)
            rows = {solver: mean([solve(plain, seed) for seed in range(1, options.seeds + 1)])
                    for solver, solve in bench.chosen_solvers()}
            print_table(plain.stem, rows, bench.bound(plain), options.seconds)


if __name__ == "__main__":
    main()
