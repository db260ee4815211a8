#!/usr/bin/python3
"""run.py [--seconds S] [--threads N] [--seeds N] [--bin DIR] GRAPH... - weights, bounds and curves of our solvers.

Solves every METIS graph (plain or .zst) by `initsol | lns` and bounds it by `certify`, with the same options for all, and
prints a table: the greedy weight, the weight at tenths of the time, the last one, the bound and the gap. Every solution
is checked by tests/checkers/solution_check.py where the graph is small enough to be read by it. With several seeds the
worst and the best last weight are printed. Without graphs it takes those of ../shared/graphs beside the repository.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
CHECKED_UP_TO = 100_000_000  # bytes of graph
CURVE = (0.05, 0.1, 0.2, 0.5)


def weight_at(log, seconds):
    weights = [json.loads(line)["weight"] for line in open(log) if json.loads(line)["seconds"] <= seconds]
    return weights[-1] if weights else None


def plain_file(graph, folder):
    if graph.suffix != ".zst":
        return graph
    plain = folder / graph.stem
    with open(plain, "wb") as file:
        subprocess.run(["zstd", "-dqc", graph], stdout=file, check=True)
    return plain


def solve(tool, graph, folder, options, seed):
    start, best, log, stats = (folder / name for name in ("start.sol", "best.sol", "lns.jsonl", "stats.json"))
    common = ["--graph", graph, "--threads", str(options.threads), "--stats", stats]
    subprocess.run([tool("initsol"), *common, "--iterations", "0", "-o", start], check=True)
    greedy = json.load(open(stats))["weight"]
    subprocess.run([tool("lns"), *common, "--solution", start, "--time-limit", str(options.seconds), "--seed", str(seed),
                    "--log", log, "-o", best], check=True)
    result = json.load(open(stats))
    if graph.stat().st_size <= CHECKED_UP_TO:
        checked = subprocess.run([ROOT / "tests/checkers/solution_check.py", graph, best], capture_output=True, text=True)
        if not checked.stdout.rstrip().endswith(f"weight {result['weight']}"):
            sys.exit(f"{graph}: {checked.stdout}")
    return greedy, [weight_at(log, part * options.seconds) for part in CURVE], result, best


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("graphs", nargs="*", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/bin")
    options = parser.parse_args()
    graphs = options.graphs or sorted((ROOT.parent / "shared/graphs").glob("*.graph.zst"))
    if not graphs:
        sys.exit("skipped: no graphs given, and none in ../shared/graphs")

    times = [f"{part * options.seconds:g} s" for part in CURVE] + [f"{options.seconds:g} s"]
    print("| graph | greedy | " + " | ".join(times) + " | bound | gap |")
    print("|" + " --- |" * (len(times) + 4))
    for graph in graphs:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            plain = plain_file(graph, folder)
            runs = [solve(lambda tool: options.bin / tool, plain, folder, options, seed)
                    for seed in range(1, options.seeds + 1)]
            greedy, curve, result, best = max(runs, key=lambda run: run[2]["weight"])
            subprocess.run([options.bin / "certify", "--graph", plain, "--solution", best, "--stats", folder / "c.json",
                            "--time-limit", str(options.seconds), "-o", folder / "out.sol"], check=True)
            proof = json.load(open(folder / "c.json"))
            weights = sorted(run[2]["weight"] for run in runs)
            last = f"{weights[-1]:,}" if len(weights) == 1 else f"{weights[0]:,} … {weights[-1]:,}"
            if result["complete"]:
                last += " (optimal)"
            cells = [plain.stem, f"{greedy:,}", *(f"{w:,}" if w else "–" for w in curve), last, f"{proof['bound']:,}",
                     f"{100 * (1 - weights[-1] / proof['bound']):.3f} %"]
            print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
