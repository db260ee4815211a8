#!/usr/bin/python3
"""What `certify --exact` proves in a minute: graphs of codes, keller4, satisfiable problems of model RB, and a FOLDER of cliques.

The graphs of codes (Sloane), of Keller's conjecture and of model RB (Xu, Li) are made here; their optima are known. Files of a
FOLDER are searched for (*.clq, *.wclq: maximum weight cliques in DIMACS format) and solved in the complement, where they have at
most --most vertices. For each: vertices, share of pairs in conflict, processor seconds of certify on one thread, its weight and
bound. Goal: each graph that is made here is proven, with the known optimum, but for those where the proof ends (BEYOND).
"""
import argparse
import itertools
import json
import math
import os
import pathlib
import random
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
BIN = pathlib.Path(os.environ.get("HEXPIPE_BIN", ROOT / "build" / "bin"))

# By code and length of words: the largest code (Sloane, Challenge problems: independent sets in graphs).
CODES = {"1dc": {6: 10, 7: 16, 8: 30, 9: 52, 10: 94}, "2dc": {7: 5, 8: 7, 9: 11, 10: 16}, "1tc": {6: 20, 7: 38, 8: 63, 9: 110, 10: 196},
         "1et": {6: 18, 7: 28, 8: 50, 9: 100, 10: 171}, "1zc": {7: 18, 8: 36, 9: 62, 10: 112}}
BEYOND = {"1dc.512", "1dc.1024", "1tc.1024", "1et.1024", "1zc.256", "1zc.512", "1zc.1024", "frb30-15-2"}


def deletions(word, count):
    """What is left of a word, as a text, without `count` of its letters."""
    words = {word}
    for _ in range(count):
        words = {w[:i] + w[i + 1:] for w in words for i in range(len(w))}
    return words


def received(code, word):
    """The words that a channel may make of a word: two words are in conflict if they may become the same."""
    if code in ("1dc", "2dc"):
        return deletions(word, int(code[0]))
    made = {word}
    if code == "1zc":
        made |= {word[:i] + "0" + word[i + 1:] for i in range(len(word)) if word[i] == "1"}
    else:
        for i in range(len(word) if code == "1et" else len(word) - 1):
            letters, j = list(word), (i + 1) % len(word)
            letters[i], letters[j] = letters[j], letters[i]
            made.add("".join(letters))
    return made


def code_graph(code, length):
    sources = {}
    for number, letters in enumerate(itertools.product("01", repeat=length)):
        for word in received(code, "".join(letters)):
            sources.setdefault(word, []).append(number)
    edges = set()
    for words in sources.values():
        edges |= set(itertools.combinations(sorted(set(words)), 2))
    return 2 ** length, edges


def keller_graph(dimension):
    """As keller4 of DIMACS: the neighbours of one vertex, whose cliques are the independent sets here."""
    words = list(itertools.product(range(4), repeat=dimension))
    start = words[0]

    def adjacent(a, b):
        differences = [(x - y) % 4 for x, y in zip(a, b)]
        return sum(d != 0 for d in differences) >= 2 and 2 in differences

    words = [w for w in words if adjacent(start, w)]
    edges = {(i, j) for (i, a), (j, b) in itertools.combinations(enumerate(words), 2) if not adjacent(a, b)}
    return len(words), edges


def rb_graph(variables, values, seed):
    """Model RB at its threshold with a solution hidden in it, as frb30-15: values of a variable exclude each other, and so do a
    quarter of the pairs of values in each constraint."""
    rng = random.Random(seed)
    solution = [rng.randrange(values) for _ in range(variables)]
    edges = {(v * values + a, v * values + b) for v in range(variables) for a, b in itertools.combinations(range(values), 2)}
    for _ in range(round(0.8 / math.log(4 / 3) * variables * math.log(variables))):
        x, y = sorted(rng.sample(range(variables), 2))
        pairs = [(a, b) for a in range(values) for b in range(values) if (a, b) != (solution[x], solution[y])]
        for a, b in rng.sample(pairs, round(0.25 * values * values)):
            edges.add((x * values + a, y * values + b))
    return variables * values, edges


def write_metis(path, vertices, edges):
    around = [[] for _ in range(vertices)]
    for a, b in edges:
        around[a].append(b + 1)
        around[b].append(a + 1)
    with open(path, "w") as out:
        out.write(f"{vertices} {len(edges)}\n" + "".join(" ".join(map(str, sorted(row))) + "\n" for row in around))


def prove(graph, options, limit, folder):
    bundle, stats = folder / "start.sol", folder / "stats.json"
    subprocess.run([BIN / "initsol", "-q", "--graph", graph, *options, "--threads", "1", "-o", bundle], check=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([BIN / "certify", "-q", "--graph", graph, *options, "--solution", bundle, "--exact", "--threads", "1",
                    "--time-limit", str(limit), "--stats", stats, "-o", folder / "best.sol"], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(stats.read_text()), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def size_of_clique_file(path):
    for text in open(path):
        if text.startswith("p "):
            vertices, edges = map(int, text.split()[2:4])
            return vertices, 1 - 2 * edges / vertices / (vertices - 1)
    return 0, 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", nargs="*", help="with files of maximum weight cliques")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--most", type=int, default=1024, help="vertices")
    parser.add_argument("--only", default="", help="graphs whose names begin so")
    options = parser.parse_args()
    made = [(f"{code}.{2 ** length}", lambda c=code, l=length: code_graph(c, l), best)
            for code, sizes in CODES.items() for length, best in sizes.items()]
    made.append(("keller4", lambda: keller_graph(4), 11))
    made += [(f"frb30-15-{seed}", lambda s=seed: rb_graph(30, 15, s), 30) for seed in (1, 2, 3)]
    missed = 0
    print(f"{'graph':18} {'vertices':>8} {'in conflict':>11} {'seconds':>8} {'weight':>7} {'bound':>7}")

    def show(name, vertices, share, found, seconds, wanted):
        proven = found["complete"] and wanted in (None, found["weight"])
        print(f"{name:18} {vertices:8} {100 * share:10.1f}% {seconds:8.2f} {found['weight']:7} {found['bound']:7}"
              f"{'' if proven else '  not proven' if not found['complete'] else f'  expected {wanted}'}", flush=True)
        return proven

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for name, make, best in made:
            if not name.startswith(options.only):
                continue
            vertices, edges = make()
            write_metis(folder / "graph.graph", vertices, edges)
            found, seconds = prove(folder / "graph.graph", [], options.seconds, folder)
            proven = show(name, vertices, 2 * len(edges) / vertices / (vertices - 1), found, seconds, best)
            missed += not proven and name not in BEYOND
        files = [path for given in options.folder for path in pathlib.Path(given).rglob("*.*clq")]
        for path in sorted(files, key=lambda file: file.stat().st_size):
            vertices, share = size_of_clique_file(path)
            if path.stem.startswith(options.only) and 0 < vertices <= options.most:
                found, seconds = prove(path, ["--graph-format", "dimacs", "--complement"], options.seconds, folder)
                show(path.stem, vertices, share, found, seconds, None)
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
