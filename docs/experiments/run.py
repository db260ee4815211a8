#!/usr/bin/python3
"""run.py [--out FOLDER] [--seconds S] [--size LENGTH] [EXPERIMENT...] - the dissertation's experiments on our models.

K. Verhetsel, Solving the Maximum Weight Independent Set Problem: Application to Indirect Hex-Mesh Generation (UCLouvain,
2017), chapter 4. Each experiment leaves a CSV and an SVG in FOLDER; without names all are run. S is the time of a search.
Tools are taken from build/bin or HEXPIPE_BIN. Needs gnuplot.
"""
import argparse
import io
import json
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tarfile
import time

import numpy

import sheets

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("HEXPIPE_BIN", ROOT / "build" / "bin"))
DATA = ROOT / "tests" / "data"


def tool(name, *arguments):
    """Runs a tool and returns its --stats."""
    stats = Bench.folder / f"{name}.stats.json"
    subprocess.run([BIN / name, *map(str, arguments), "-q", "--stats", stats], check=True, stdin=subprocess.DEVNULL)
    return json.loads(stats.read_text())


class Bench:
    """What the experiments share: options, and the graph that the searches run on, made once."""
    folder = out = None
    optima = {}
    seconds = 4
    size = 3

    @classmethod
    def graph(cls, part="bracket", size=None):
        """A bundle with the graph of a part; its bundle of candidates has the same name."""
        size = size or cls.size
        target = cls.folder / f"{part}-{size}.tar"
        if not target.exists():
            tool("tetmesh", DATA / f"{part}.stl", "--size", size, "-o", cls.folder / "mesh.tar")
            tool("findhex", cls.folder / "mesh.tar", "-o", cls.folder / "cand.tar")
            tool("buildgraph", cls.folder / "cand.tar", "-o", target)
        return target

    @classmethod
    def start(cls):
        """Greedy and nothing else, so that the compared runs begin alike."""
        target = cls.folder / "greedy.tar"
        if not target.exists():
            tool("initsol", cls.graph(), "--iterations", 0, "-o", target)
        return target

    @classmethod
    def bound(cls):
        target = cls.folder / "bound.json"
        if not target.exists():
            stats = tool("certify", cls.start(), "--iterations", 150, "-o", cls.folder / "certified.tar")
            target.write_text(json.dumps(stats["bound"]))
        return json.loads(target.read_text())

    @classmethod
    def bound_log(cls):
        """The bound as a log that has it from the beginning, because it takes longer than the searches."""
        target = cls.folder / "bound.jsonl"
        target.write_text(json.dumps({"seconds": 0, "bound": cls.bound()}) + "\n")
        return target

    @classmethod
    def gap(cls, weight):
        return 100 * (cls.bound() - weight) / cls.bound()


def sizes():
    """Table 4.1: sizes of meshes and graphs."""
    rows = []
    cases = [("bracket", size) for size in (7, 6, 5, 4)] + [("notch", "5%"), ("plate-holes", "3%")]
    for part, size in cases:
        graph = Bench.graph(part, size)
        history = history_of(graph)
        rows.append([part, size, *mesh_counts(graph), history["buildgraph"]["vertices"], history["buildgraph"]["edges"],
                     2 * history["buildgraph"]["edges"] / history["buildgraph"]["vertices"]])
    sheets.write_table(Bench.out / "sizes.csv",
                       ["part", "size", "points", "tets", "candidates", "conflicts", "mean degree"], rows)
    series = [(name, [(row[3], row[column]) for row in sorted(rows, key=lambda row: row[3])], "linespoints lw 2 pt 7")
              for name, column in (("candidates", 4), ("conflicts", 5))]
    sheets.draw(Bench.out / "sizes.svg", "Sizes of the graphs", "tets", "number", series, ["set logscale xy", "set format y '10^{%L}'"])


def history_of(bundle):
    with tarfile.open(bundle) as archive:
        entries = [json.load(archive.extractfile(member)) for member in archive if member.name.startswith("history/")]
    return {entry["tool"]: entry for entry in entries}


def array_of(bundle, name):
    with tarfile.open(bundle) as archive:
        return numpy.load(io.BytesIO(archive.extractfile(f"{name}.npy").read()))


def mesh_counts(bundle):
    return len(array_of(bundle, "mesh/points")), len(array_of(bundle, "mesh/tets"))


def fragment(offsets, neighbours, count, rng):
    """Vertices around a random one, in breadth-first order."""
    found = [rng.randrange(len(offsets) - 1)]
    seen = set(found)
    for vertex in found:
        around = [int(w) for w in neighbours[offsets[vertex]:offsets[vertex + 1]] if int(w) not in seen]
        rng.shuffle(around)
        seen.update(around)
        found.extend(around)
        if len(found) >= count:
            break
    return sorted(found[:count])


def write_metis(path, vertices, offsets, neighbours, weights):
    place = {vertex: i + 1 for i, vertex in enumerate(vertices)}
    lists = [[place[int(w)] for w in neighbours[offsets[v]:offsets[v + 1]] if int(w) in place] for v in vertices]
    edges = sum(map(len, lists)) // 2
    with open(path, "w") as file:
        print(len(vertices), edges, 10, file=file)
        for vertex, around in zip(vertices, lists):
            print(weights[vertex], *around, file=file)
    return edges


EXACT = ["complete-search", "clique-partition", "clique-cover", "clique-lp", "branch-and-reduce", "branch-and-cut"]


def exact():
    """Table 4.2, figures 4.1 and 4.2: the exact algorithms on fragments of growing size, and how dense these are.

    Each begins with one vertex and no bound, and has two seconds; one that proves nothing at a size is not tried at larger
    ones. coinor-cbc solves the smaller ones by a program of its own, its start included.
    """
    graph = Bench.graph()
    offsets, neighbours, weights = (array_of(graph, f"graph/{name}") for name in ("offsets", "neighbours", "weights"))
    (Bench.folder / "first.sol").write_text("1\n")
    rng, rows, densities, tried = random.Random(1), [], [], exact_algorithms()
    for count in (25, 50, 75, 100, 150, 200, 300, 400):
        paths = [Bench.folder / f"fragment-{count}-{i}.graph" for i in range(3)]
        dense = [2 * write_metis(path, fragment(offsets, neighbours, count, rng), offsets, neighbours, weights)
                 / count / (count - 1) for path in paths]
        densities += [(count, density) for density in dense]
        for name in list(tried):
            runs = [(by_cbc if name == "coinor-cbc" else by_certify)(path, name) for path in paths]
            agree_on_optima(paths, runs)
            done = [run for run in runs if run["complete"]]
            rows.append([count, statistics.mean(dense), name, len(done), *(
                statistics.median(run[key] for run in done) if done and key in done[0] else "" for key in ("seconds", "nodes"))])
            if not done or name == "coinor-cbc" and count >= 100:
                tried.remove(name)
    sheets.write_table(Bench.out / "exact.csv", ["vertices", "density", "algorithm", "proven of 3", "seconds", "nodes"], rows)
    sheets.draw(Bench.out / "exact.svg", "Time to the proven optimum of a fragment", "vertices", "seconds, median", [
        (name, [(row[0], row[4]) for row in rows if row[2] == name and row[3]], "linespoints lw 2 pt 7 ps 0.7")
        for name in dict.fromkeys(row[2] for row in rows)], ["set logscale y", "set format y '10^{%L}'"])
    sheets.draw(Bench.out / "density.svg", "Density of fragments", "vertices", "edges / possible edges",
                [("fragments", densities, "points pt 7 ps 0.9")], ["set yrange [0:]", "unset key"])


def exact_algorithms():
    """Those that this build of certify offers, and cbc."""
    offered = subprocess.run([BIN / "certify", "--help"], capture_output=True, text=True, check=True).stdout
    return [name for name in EXACT if name in offered] + ["coinor-cbc"]


def by_certify(path, name):
    return tool("certify", "--graph", path, "--solution", Bench.folder / "first.sol", "--exact", "--algorithm", name,
                "--iterations", 0, "--time-limit", 2, "-o", Bench.folder / "best.sol")


def by_cbc(path, _):
    begin = time.monotonic()
    solution = Bench.folder / "cbc.sol"
    done = subprocess.run([ROOT / "tests" / "checkers" / "solve_with_cbc.py", path, solution],
                          stdout=subprocess.DEVNULL, check=False)
    seconds = time.monotonic() - begin
    weights = [int(line.split()[0]) for line in open(path).read().splitlines()[1:]]
    chosen = [int(line) for line in open(solution)] if done.returncode == 0 else []
    return {"complete": done.returncode == 0, "seconds": seconds, "weight": sum(weights[v - 1] for v in chosen)}


def agree_on_optima(paths, runs):
    for path, run in zip(paths, runs):
        if run["complete"] and Bench.optima.setdefault(path, run["weight"]) != run["weight"]:
            raise SystemExit(f"{path}: {run['weight']} where another proved {Bench.optima[path]}")


def compare(name, title, program, source, cases):
    """Runs a search with each case's options: a table of weights and gaps, a sheet of curves under the bound."""
    rows, runs = [], []
    for label, options in cases:
        log = Bench.folder / f"{name}-{len(runs)}.jsonl"
        limit = [] if "--iterations" in options else ["--time-limit", Bench.seconds]
        stats = tool(program, source, *options, *limit, "--log", log, "-o", Bench.folder / "compared.tar")
        rows.append([label, stats["weight"], stats["chosen"], Bench.gap(stats["weight"]), stats["iterations"], stats["seconds"]])
        runs.append((label, log))
    sheets.write_table(Bench.out / f"{name}.csv", ["case", "weight", "chosen", "gap %", "iterations", "seconds"], rows)
    sheets.draw_curves(Bench.out / f"{name}.svg", title, runs + [("certified", Bench.bound_log())])


def initial():
    """Tables 4.3 and 4.4, figure 4.3: ways to an initial solution."""
    cases = [(f"greedy by {order}", ["--greedy", order, "--iterations", 0]) for order in ("quality", "weight", "weight-degree")]
    cases += [("descent", ["--method", "descend"])]
    cases += [(f"tabu, {escape}", ["--method", "tabu", "--escape", escape]) for escape in ("restart", "rebuild", "best")]
    cases += [("annealing", ["--method", "anneal"])]
    compare("initial", "Ways to an initial solution", "initsol", Bench.graph(), cases)


def lns():
    """Tables 4.5 and 4.6, figures 4.4 to 4.8: fragment sizes, a start by local search, sizes that adapt."""
    cases = [(f"fragments of {size}", ["--fragment-size", size, "--largest-fragment", size]) for size in (25, 50, 100, 200)]
    cases += [("adaptive", [])]
    compare("lns-from-greedy", "Large neighbourhood search from a greedy start", "lns", Bench.start(), cases)
    searched = Bench.folder / "searched.tar"
    tool("initsol", Bench.graph(), "--time-limit", Bench.seconds, "-o", searched)
    compare("lns-from-search", "Large neighbourhood search from an annealed start", "lns", searched, cases)


def threads():
    """Figure 4.9: parallel speed, for the same work; of three runs in turn the fastest."""
    counts, seconds, weights = sorted({1, 2, os.cpu_count() or 1}), {}, {}
    for _ in range(3):
        for count in counts:
            stats = tool("lns", Bench.start(), "--iterations", 300, "--threads", count, "-o", Bench.folder / "threads.tar")
            seconds[count] = min(stats["seconds"], seconds.get(count, stats["seconds"]))
            weights[count] = stats["weight"]
    rows = [[count, seconds[count], seconds[1] / seconds[count], weights[count]] for count in counts]
    sheets.write_table(Bench.out / "threads.csv", ["threads", "seconds", "speedup", "weight"], rows)
    sheets.draw(Bench.out / "threads.svg", "Parallel speed of lns", "threads", "speedup", [
        ("measured", [(row[0], row[2]) for row in rows], "linespoints lw 2 pt 7"),
        ("ideal", [(row[0], row[0]) for row in rows], "lines dt 3"),
    ], ["set yrange [0:]", "set xtics 1"])


def qualities(mesh):
    return array_of(mesh, "result/hexes_quality")


def quality():
    """Figures 4.10 and 4.11: quality of the chosen hexes, and what a threshold on it costs."""
    rows, series, bins = [], [], 20
    for threshold in (0.1, 0.3, 0.5, 0.7):
        mesh = mesh_of("bracket", Bench.size, ["--min-quality", threshold])
        values = qualities(mesh)
        counts = [int(((values >= i / bins) & (values < (i + 1) / bins + (i == bins - 1))).sum()) for i in range(bins)]
        rows += [[threshold, i / bins, count] for i, count in enumerate(counts)]
        series.append((f"better than {threshold}", [((i + 0.5) / bins, n) for i, n in enumerate(counts)], "histeps lw 2"))
    sheets.write_table(Bench.out / "quality.csv", ["threshold", "scaled Jacobian from", "hexes"], rows)
    sheets.draw(Bench.out / "quality.svg", "Scaled Jacobian of the chosen hexes", "scaled Jacobian", "hexes", series,
                ["set key inside left top"])


def mesh_of(part, size, find=()):
    """A result, as a bundle, by the whole pipeline with short searches."""
    folder = Bench.folder
    target = folder / f"result-{part}-{size}{''.join(map(str, find))}.tar"
    if target.exists():
        return target
    tool("tetmesh", DATA / f"{part}.stl", "--size", size, "-o", folder / "m.tar")
    tool("findhex", folder / "m.tar", *find, "-o", folder / "c.tar")
    tool("buildgraph", folder / "c.tar", "-o", folder / "g.tar")
    tool("initsol", folder / "g.tar", "--time-limit", Bench.seconds, "-o", folder / "i.tar")
    tool("assemble", folder / "i.tar", "-o", target)
    return target


def share():
    """Share of hexes against size, by number and by volume of the part."""
    rows = []
    for size in (8, 7, 6, 5, 4):
        mesh = mesh_of("bracket", size)
        hexes = len(array_of(mesh, "result/hexes"))
        total = hexes + sum(len(array_of(mesh, f"result/{kind}")) for kind in ("prisms", "pyramids", "tets"))
        rows.append([size, total, hexes, 100 * hexes / total, 100 * hex_volume(mesh)])
    sheets.write_table(Bench.out / "share.csv", ["size", "cells", "hexes", "% of cells", "% of volume"], rows)
    sheets.draw(Bench.out / "share.svg", "Share of hexes against size (bracket)", "size", "%", [
        ("of the volume", [(row[0], row[4]) for row in rows], "linespoints lw 2 pt 7"),
        ("of the cells", [(row[0], row[3]) for row in rows], "linespoints lw 2 pt 5"),
    ], ["set yrange [0:100]"])


def hex_volume(mesh):
    """The part of the tets' volume that hexes have; trilinear hexes by six tets of two diagonals, averaged."""
    points = array_of(mesh, "result/points")

    def tets(cells):
        a, b, c, d = (points[cells[:, i]] for i in range(4))
        return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a).sum() / 6
    hexes = array_of(mesh, "result/hexes")
    five = [[(0, 1, 3, 4), (1, 2, 3, 6), (1, 5, 6, 4), (3, 6, 7, 4), (1, 6, 3, 4)],
            [(1, 2, 0, 5), (2, 3, 0, 7), (2, 6, 7, 5), (0, 7, 4, 5), (0, 2, 7, 5)]]
    inside = sum(abs(tets(hexes[:, list(corners)])) for way in five for corners in way) / 2
    return inside / tets(array_of(mesh, "mesh/tets"))


def pictures():
    """Figure 4.12: the meshes."""
    for part, size, view in (("bracket", Bench.size, "clip=z:0.5&camera=-50,35"),
                             ("notch", "5%", "camera=-40,25&colour=kind"),
                             ("plate-holes", "2%", "camera=-60,40&colour=kind")):
        tool("viewmesh", mesh_of(part, size), "--png", Bench.out / f"{part}.png", "--size", "1200,800", "--view", view)


EXPERIMENTS = [sizes, exact, initial, lns, threads, quality, share, pictures]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", default="experiments", type=pathlib.Path)
    parser.add_argument("--seconds", default=Bench.seconds, type=float)
    parser.add_argument("--size", default=Bench.size, type=float)
    parser.add_argument("names", nargs="*", metavar="EXPERIMENT", help=", ".join(e.__name__ for e in EXPERIMENTS))
    options = parser.parse_args()
    known = {experiment.__name__: experiment for experiment in EXPERIMENTS}
    for name in options.names:
        if name not in known:
            parser.error(f"expected one of {', '.join(known)}, found '{name}'")
    Bench.out, Bench.seconds, Bench.size = options.out, options.seconds, options.size
    Bench.folder = options.out / "work"
    Bench.folder.mkdir(parents=True, exist_ok=True)
    for name in options.names or known:
        begin = time.monotonic()
        known[name]()
        print(f"{name}: {time.monotonic() - begin:.0f} s", file=sys.stderr)


main()
