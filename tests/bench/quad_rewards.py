#!/usr/bin/python3
"""quad_rewards.py [--kinds 0,0.1,volume:0.1+exchange] [--with BEFORE] [--seeds 1,2,3] [--sizes coarse,middle] [--models DIR]
[MODEL...] - does a choice that minds open quads make better meshes than one that assemble mends, or than tools of another version?

For each model and size, the same tets go through findhex | buildgraph | initsol | lns | assemble, on one thread, each stage with its
defaults. A kind is the price of an open quad (`buildgraph --quad-reward`): 0 is the pipe as it is, with `assemble --exchange
quads`; with `+exchange` assemble exchanges after a choice with prices, too; `volume:` before it is another `--weight`. With BEFORE,
a folder of tools of an earlier version, these run first, with all of their defaults. Printed as Markdown are, for each, means over
the seeds of initsol and lns: processor seconds of initsol, lns and assemble, and of assemble alone, and what assemble's statistics
say of the mesh; tests/checkers/meshstats.py has to find it valid and conforming, and counts its open quads: the inner ones that a
pyramid has. `+-` is half of the range between the seeds.
Then each kind is compared with the first one (BEFORE, if that is given): where hexes have less of the volume or of the number by
more than LOWER points, and how seconds and open quads compare. Models are those of ../shared/models; the tools are taken from
build/bin, or from HEXPIPE_BIN. Ends with 1 if the pipe as it is has less than BEFORE somewhere, or more open quads in the mean.
"""
import argparse
import glob
import json
import os
import statistics
import subprocess
import sys
import tempfile
import typing

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bench_meshes  # noqa: E402
import model_sizes  # noqa: E402

MESHSTATS = os.path.join(model_sizes.ROOT, "tests", "checkers", "meshstats.py")
SECONDS, PERCENT = ("seconds", "assemble s"), ("volume %", "number %")
COUNTS, QUALITIES = ("hexes", "prisms", "pyramids", "tets", "open quads"), ("least hex", "mean hex", "least other")
COLUMNS = ("model", "size", "kind") + SECONDS + PERCENT + COUNTS + QUALITIES
LOWER = 0.05


BIN = os.path.abspath(bench_meshes.BIN)


class Kind(typing.NamedTuple):
    name: str
    tools: str
    graph_options: tuple = ()
    assemble_options: tuple = ()


def kind_of(name):
    words, _, exchange = name.partition("+")
    weight, _, price = words.rpartition(":")
    return Kind(name, BIN, ("--weight", weight or "quality", "--quad-reward", price), ("--exchange", "quads") if exchange else ())


def seconds_of(tools, tool, *arguments):
    return bench_meshes.run([os.path.join(tools, tool), *arguments, "-q", "--threads", "1"])[0]


def check(mesh):
    found = json.loads(subprocess.run([MESHSTATS, "--json", "--exact", mesh], check=True, capture_output=True, text=True).stdout)
    if not found["is_conforming"] or found["invalid_hexes"] or found["inverted_cells"]:
        sys.exit(f"{mesh}: not a valid, conforming mesh")
    return found


def measure(kind, seed):
    """From candidates.tar in the working folder to a mesh: numbers by the names of COLUMNS."""
    seconds_of(kind.tools, "buildgraph", "candidates.tar", *kind.graph_options, "-o", "graph.tar")
    searches = seconds_of(kind.tools, "initsol", "graph.tar", "--seed", seed, "-o", "start.tar")
    searches += seconds_of(kind.tools, "lns", "start.tar", "--seed", seed, "-o", "choice.tar")
    assembling = seconds_of(kind.tools, "assemble", "choice.tar", *kind.assemble_options, "-o", "mesh.vtu", "--stats", "stats.json")
    found = check("mesh.vtu")
    with open("stats.json") as file:
        stats = json.load(file)
    cells = stats["cells"]
    count = {name: cells[name]["count"] if name in cells else 0 for name in ("hex", "prism", "pyramid", "tet")}
    others = [cell["scaled_jacobian"]["least"] for name, cell in cells.items() if name != "hex" and cell["count"] > 0]
    return {"seconds": searches + assembling, "assemble s": assembling,
            "volume %": 100 * cells["hex"]["share_of_volume"], "number %": 100 * count["hex"] / sum(count.values()),
            "hexes": count["hex"], "prisms": count["prism"], "pyramids": count["pyramid"], "tets": count["tet"],
            "open quads": found["quads_at_pyramids"], "least hex": cells["hex"]["scaled_jacobian"]["least"],
            "mean hex": cells["hex"]["scaled_jacobian"]["mean"], "least other": min(others, default=1)}


def shown(name, values):
    mean, spread = statistics.mean(values), (max(values) - min(values)) / 2
    if name in PERCENT:
        return f"{mean:.2f} +-{spread:.2f}" if len(values) > 1 else f"{mean:.2f}"
    return f"{mean:.0f}" if name in COUNTS else f"{mean:.3f}"


def compare(kind, first, rows):
    """Prints how a kind compares with the first one; returns whether it is nowhere lower, with no more open quads in the mean."""
    pairs = [(place, means[first.name], means[kind.name]) for place, means in rows]
    sums = {name: [sum(pair[side][name] for pair in pairs) for side in (1, 2)] for name in SECONDS + ("open quads",)}
    ratio_of_open = statistics.mean(now["open quads"] / max(1, before["open quads"]) for _, before, now in pairs)
    text = [f"{name} {after:.1f} in place of {before:.1f}" for name, (before, after) in sums.items()]
    is_lower = False
    for name in PERCENT:
        change = {place: now[name] - before[name] for place, before, now in pairs}
        lower = [f"{place} {gain:+.2f}" for place, gain in change.items() if gain < -LOWER]
        is_lower = is_lower or bool(lower)
        text.append(f"{name} {statistics.mean(change.values()):+.3f} in the mean, lower on {len(lower)} of {len(change)}"
                    + (f" ({', '.join(lower)})" if lower else ""))
    print(f"\n{kind.name} against {first.name}: {'; '.join(text)}; open quads {ratio_of_open:.3f} times, in the mean of the models", flush=True)
    return not is_lower and ratio_of_open <= 1


def bench(source, level, kinds, seeds):
    """A line for each kind; returns the model with its size, and the means by kind and column."""
    size, model = model_sizes.size_of(source, model_sizes.LEVELS.index(level)), model_sizes.name_of(source)
    seconds_of(BIN, "tetmesh", source, "--size", repr(size), "-o", "mesh.tar")
    means = {}
    for kind in kinds:
        seconds_of(kind.tools, "findhex", "mesh.tar", "-o", "candidates.tar")
        runs = [measure(kind, seed) for seed in seeds]
        by_name = {name: [run[name] for run in runs] for name in runs[0]}
        means[kind.name] = {name: statistics.mean(values) for name, values in by_name.items()}
        row = [model, f"{size:.4g}", kind.name] + [shown(name, by_name[name]) for name in COLUMNS[3:]]
        print("| " + " | ".join(row) + " |", flush=True)
    return f"{model} {size:.4g}", means


def models_of(options):
    folder = os.path.abspath(options.folder)
    if options.models:
        return [os.path.abspath(model if os.path.exists(model) else os.path.join(folder, model)) for model in options.models]
    return sorted(path for end in ("stl", "obj", "off") for path in glob.glob(os.path.join(folder, "*." + end)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*")
    parser.add_argument("--kinds", default="0,0.1")
    parser.add_argument("--with", dest="before", metavar="BEFORE")
    parser.add_argument("--seeds", default="1")
    parser.add_argument("--sizes", default="coarse,middle")
    parser.add_argument("--models", dest="folder", default=model_sizes.MODELS)
    options = parser.parse_args()
    sources = models_of(options)
    if not sources:
        print(f"skipped: no models in {options.folder}")
        return
    kinds = [kind_of(name) for name in options.kinds.split(",")]
    if options.before:
        kinds.insert(0, Kind("before", os.path.abspath(options.before)))
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        rows = [bench(source, level, kinds, options.seeds.split(",")) for source in sources for level in options.sizes.split(",")]
    verdicts = {kind.name: compare(kind, kinds[0], rows) for kind in kinds[1:]}
    sys.exit(1 if options.before and not verdicts.get("0", True) else 0)


if __name__ == "__main__":
    main()
