#!/usr/bin/python3
"""The exact algorithms of certify by name on fragments of growing size, as in the dissertation's table 4.2.

For each size and algorithm: the share of fragments that are proven within the limit, and the median seconds and nodes of these.
All start from one vertex, without a bound, so that each has to find the optimum as well; all that finish have to agree. An
algorithm that proved nothing at a size is not tried at larger ones. Goal: branch and cut proves everything to 400 vertices.
"""
import argparse
import csv
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
CERTIFY = pathlib.Path(os.environ.get("HEXPIPE_BIN", ROOT / "build" / "bin")) / "certify"
GRAPHS = ROOT.parent / "shared" / "graphs"
ALGORITHMS = ["complete-search", "clique-partition", "clique-cover", "clique-lp", "branch-and-reduce", "branch-and-cut"]


def open_graph(name, folder):
    packed = GRAPHS / f"{name}.graph.zst"
    if not packed.exists():
        sys.exit(f"skipped: no {packed}")
    path = folder / f"{name}.graph"
    with open(path, "wb") as out:
        subprocess.run(["zstd", "-dc", packed], stdout=out, check=True)
    return path


def cut(graph, vertices, seed, folder):
    path = folder / f"{vertices}-{seed}.graph"
    with open(path, "w") as out:
        subprocess.run([ROOT / "tests/data/graph_fragment.py", graph, str(vertices), str(seed)], stdout=out, check=True)
    return path


def prove(fragment, algorithm, limit, folder):
    start, stats = folder / "start.sol", folder / "stats.json"
    start.write_text("1\n")
    subprocess.run([CERTIFY, "--graph", fragment, "--solution", start, "--exact", "--algorithm", algorithm, "--iterations", "0",
                    "--time-limit", str(limit), "--stats", stats, "-o", folder / "best.sol"], check=True)
    return json.loads(stats.read_text())


def density(fragment):
    vertices, edges = map(int, open(fragment).readline().split()[:2])
    return 2 * edges / vertices / (vertices - 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--graph", default="block-28k", help="of ../shared/graphs")
    parser.add_argument("--sizes", default="25,50,75,100,150,200,300,400,600")
    parser.add_argument("--fragments", type=int, default=5, help="of each size")
    parser.add_argument("--limit", type=float, default=2, help="seconds for one fragment")
    options = parser.parse_args()
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["vertices", "density", "algorithm", "proven", "seconds", "nodes"])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        graph = open_graph(options.graph, folder)
        trying = list(ALGORITHMS)
        for size in map(int, options.sizes.split(",")):
            fragments = [cut(graph, size, seed, folder) for seed in range(1, options.fragments + 1)]
            mean_density = statistics.mean(map(density, fragments))
            optima = {}
            for algorithm in list(trying):
                runs = [prove(fragment, algorithm, options.limit, folder) for fragment in fragments]
                proven = [run for run in runs if run["complete"]]
                for fragment, run in zip(fragments, runs):
                    if run["complete"] and optima.setdefault(fragment, run["weight"]) != run["weight"]:
                        sys.exit(f"{algorithm}: {run['weight']} where another proved {optima[fragment]}")
                if not proven:
                    trying.remove(algorithm)
                median = [statistics.median(run[key] for run in proven) if proven else "" for key in ("seconds", "nodes")]
                seconds = f"{median[0]:.3f}" if proven else ""
                table.writerow([size, f"{mean_density:.3f}", algorithm, len(proven) / len(runs), seconds, median[1]])
                sys.stdout.flush()


main()
