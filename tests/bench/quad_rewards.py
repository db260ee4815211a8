#!/usr/bin/python3
"""quad_rewards.py [--rewards 0,0.1] [--weight W] [--sizes middle,fine] [--no-lns] [--models DIR] [MODEL...] - does a choice
that minds open quads make better meshes than one that assemble mends?

For each model and size, the same candidates go through `buildgraph --quad-reward R | initsol | lns | assemble` for each R, on
one thread, each stage with its defaults. 0 is the pipe as it was, with `assemble --exchange quads`. Prints a line for each: processor
seconds of buildgraph, initsol, lns and assemble, and what assemble's statistics and tests/checkers/meshstats.py say of the mesh.
The tools are taken from build/bin, or from HEXPIPE_BIN.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import model_sizes  # noqa: E402
import pipeline  # noqa: E402

COLUMNS = ("model", "size", "reward", "buildgraph", "initsol", "lns", "assemble", "volume %", "number %", "hexes", "prisms",
           "pyramids", "tets", "least hex", "mean hex", "least other", "open before merging")


def processor_seconds(tool, *arguments):
    process = subprocess.Popen([os.path.join(pipeline.BIN, tool), *arguments, "-q", "--threads", "1"])
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{tool} {' '.join(arguments)}: status {status}")
    return usage.ru_utime + usage.ru_stime


def measure(folder, candidates, reward, options):
    path = {name: os.path.join(folder, name) for name in ("graph.tar", "start.tar", "choice.tar", "mesh.vtu", "stats.json")}
    seconds = {"buildgraph": processor_seconds("buildgraph", candidates, "--weight", options.weight, "--quad-reward", reward,
                                               "-o", path["graph.tar"]),
               "initsol": processor_seconds("initsol", path["graph.tar"], "-o", path["start.tar"])}
    choice = path["start.tar"]
    if options.lns:
        seconds["lns"] = processor_seconds("lns", choice, "-o", path["choice.tar"])
        choice = path["choice.tar"]
    seconds["assemble"] = processor_seconds("assemble", choice, "-o", path["mesh.vtu"], "--stats", path["stats.json"])
    with open(path["stats.json"]) as file:
        stats = json.load(file)
    check = subprocess.run([os.path.join(model_sizes.ROOT, "tests", "checkers", "meshstats.py"), "--json", "--exact", path["mesh.vtu"]],
                           check=True, capture_output=True, text=True)
    mesh = json.loads(check.stdout)
    if not mesh["is_conforming"] or mesh["invalid_hexes"] or mesh["inverted_cells"]:
        sys.exit(f"{candidates}, reward {reward}: the mesh is wrong")
    return seconds, stats


def row_of(seconds, stats):
    cells = stats["cells"]
    hexes = cells["hex"]
    others = [cell["scaled_jacobian"]["least"] for kind, cell in cells.items() if kind != "hex" and cell["count"] > 0]
    row = [f"{seconds[stage]:.1f}" if stage in seconds else "-" for stage in ("buildgraph", "initsol", "lns", "assemble")]
    row += [f"{100 * hexes['share_of_volume']:.2f}", f"{100 * hexes['share_of_number']:.2f}"]
    row += [str(cells.get(kind, {"count": 0})["count"]) for kind in ("hex", "prism", "pyramid", "tet")]
    row += [f"{hexes['scaled_jacobian']['least']:.3f}", f"{hexes['scaled_jacobian']['mean']:.4f}"]
    row += [f"{min(others):.3f}" if others else "-", str(stats["conformity"]["quads_against_tets"])]
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", default=["simp.stl", "spot.obj", "blub.off", "mambo-m1.stl", "mambo-m6.stl"])
    parser.add_argument("--rewards", default="0,0.1")
    parser.add_argument("--weight", default="quality")
    parser.add_argument("--sizes", default="coarse,middle")
    parser.add_argument("--no-lns", dest="lns", action="store_false")
    parser.add_argument("--models", dest="folder", default=model_sizes.MODELS)
    options = parser.parse_args()
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS), flush=True)
    for model in options.models:
        source = model if os.path.exists(model) else os.path.join(options.folder, model)
        for level in options.sizes.split(","):
            size = model_sizes.size_of(source, model_sizes.LEVELS.index(level))
            with tempfile.TemporaryDirectory() as folder:
                mesh, candidates = os.path.join(folder, "mesh.tar"), os.path.join(folder, "candidates.tar")
                processor_seconds("tetmesh", source, "--size", repr(size), "-o", mesh)
                processor_seconds("findhex", mesh, "-o", candidates)
                for reward in options.rewards.split(","):
                    row = row_of(*measure(folder, candidates, reward, options))
                    print("| " + " | ".join([os.path.basename(model), f"{size:.4g}", reward, *row]) + " |", flush=True)


if __name__ == "__main__":
    main()
