#!/usr/bin/python3
"""buildgraph.py [--large] [--cliques] - stored edges a second and core, memory over that of the graph, and the share of reading and writing.

Kuhn lattices whose graphs have 12.7 million conflicts (and with --large 63 million). Printed are stored (directed) edges a
second of processor time, with reading and writing and without; peak memory over the graph's own arrays; and the share of the
processor time of the whole pipeline from findhex to assemble that reads, checks and writes streams, with short searches.
Goals: 40 million edges a second, 1.3 times the memory, less than 10 % for streams. Ends with 1 when one is missed.

--cliques measures the options instead: what --reduce leaves out, what --cover adds to the graph's bytes and time, and the bound
and seconds of certify with the cliques at tets (a bundle with candidates), with the cover, and with what it finds in the graph.
Ends with 1 when the cliques at tets give a bound that is more than 1 % higher than that from the graph alone, or take longer.
"""
import argparse
import json
import os
import sys
import tempfile

import bench_meshes as meshes


def clique_cases():
    yield "points moved by 2 %", meshes.jittered(14, 0.02)
    yield "points moved by 15 %", meshes.jittered(12, 0.15)
    yield "points moved by 30 %", meshes.jittered(14, 0.3)
    yield "five tets a cube", meshes.five(12)
    yield "random points", meshes.random_points(2000)


def read(path):
    with open(path) as file:
        return json.load(file)


def measure(n):
    meshes.write_bundle("mesh.tar", meshes.kuhn(n))
    meshes.run([meshes.tool("findhex"), "-q", "mesh.tar", "--folded-quads", "keep", "--flat-corners", "keep",
                "--max-boundary-tets", 5, "--stats", "find.json", "-o", "candidates.tar"])
    with open(os.devnull, "wb") as nothing:
        seconds, peak = meshes.run([meshes.tool("buildgraph"), "-q", "candidates.tar", "--threads", 1, "--format", "tar",
                                    "--stats", "build.json"], stdout=nothing)
    stats = read("build.json")
    directed = 2 * stats["edges"]
    graph = 4 * directed + 8 * (stats["vertices"] + 1) + 8 * stats["vertices"]
    phases = stats["cpu_seconds"]
    rate, memory = directed / seconds / 1e6, peak / graph
    print(f"kuhn {n}: {stats['edges']} conflicts; {seconds:.2f} s, {rate:.1f} million stored edges/s "
          f"({directed / phases['build'] / 1e6:.1f} without streams), {memory:.2f} times the graph's memory "
          f"({peak / 2**20:.0f} MiB)", flush=True)
    return rate < 40 or memory > 1.3


def stream_share(n):
    """Of the pipeline from findhex to assemble, in processor time, with searches of a few seconds: those of initsol and lns
    count as much as an lns that reads, checks and passes on a bundle without a search."""
    meshes.write_bundle("mesh.tar", meshes.jittered(n, 0.3))
    stages = ("{0} -q mesh.tar --threads 1 --stats find.json | {1} -q --threads 1 --stats build.json | "
              "{2} -q --threads 1 --iterations 2000 | tee solution.tar | {3} -q --threads 1 --iterations 100 | "
              "{4} -q -o mesh.vtu").format(*map(meshes.tool, ("findhex", "buildgraph", "initsol", "lns", "assemble")))
    total, _ = meshes.run(["bash", "-o", "pipefail", "-c", stages])
    idle, _ = meshes.run(["bash", "-o", "pipefail", "-c", f"{meshes.tool('lns')} -q --iterations 0 solution.tar | cat >idle.tar"])
    streams = sum(read(name)["cpu_seconds"][phase] for name in ("find.json", "build.json") for phase in ("read", "write"))
    streams += 2 * idle
    print(f"jittered {n}: streams take {streams:.2f} of {total:.2f} s of the pipeline from findhex to assemble, "
          f"{100 * streams / total:.1f} %")
    return streams / total > 0.1


def certified(*inputs):
    seconds, _ = meshes.run([meshes.tool("certify"), "-q", *inputs, "--threads", 1, "--stats", "certify.json", "-o", "out.sol"])
    return read("certify.json")["bound"], seconds


def measure_reduction(name):
    """Prisms and pyramids have few conflicts that hexes around them have not."""
    meshes.run([meshes.tool("findhex"), "-q", "mesh.tar", "--cells", "hex,prism,pyramid", "-o", "mixed.tar"])
    build = [meshes.tool("buildgraph"), "-q", "mixed.tar", "--threads", 1, "--stats", "build.json", "-o", "graph.tar"]
    meshes.run(build)
    whole = read("build.json")
    meshes.run([*build, "--reduce"])
    reduced = read("build.json")
    print(f"{name}: with prisms and pyramids {whole['vertices']} candidates, "
          f"{100 * reduced['dominated'] / whole['vertices']:.1f} % dominated, and with them "
          f"{100 - 100 * reduced['edges'] / whole['edges']:.1f} % of the conflicts", flush=True)


def measure_cliques(name, mesh):
    meshes.write_bundle("mesh.tar", mesh)
    measure_reduction(name)
    meshes.run([meshes.tool("findhex"), "-q", "mesh.tar", "-o", "candidates.tar"])
    build = [meshes.tool("buildgraph"), "-q", "candidates.tar", "--threads", 1, "--stats", "build.json", "-o"]
    meshes.run([*build, "reduced.tar", "--reduce"])
    reduced = read("build.json")
    covered_seconds, _ = meshes.run([*build, "cover.tar", "--cover"])
    cover = read("build.json")
    plain_seconds, _ = meshes.run([*build, "plain.tar"])
    meshes.run([*build, "plain.graph"])
    choose = [meshes.tool("initsol"), "-q", "--iterations", 2000]
    meshes.run([*choose, "plain.tar", "-o", "chosen.tar"])
    meshes.run([*choose, "cover.tar", "-o", "chosen-cover.tar"])
    meshes.run([*choose, "plain.graph", "-o", "chosen.sol"])
    tets, tets_seconds = certified("chosen.tar")
    with_cover, cover_seconds = certified("chosen-cover.tar")
    alone, alone_seconds = certified("--graph", "plain.graph", "--solution", "chosen.sol")
    candidates = reduced["vertices"] + reduced["dominated"]
    graph = 16 * candidates + 8 * cover["edges"]
    print(f"{name}: {candidates} candidates, {100 * reduced['dominated'] / candidates:.1f} % dominated; the cover adds "
          f"{100 * (8 * cover['cliques'] + 4 * cover['clique_members']) / graph:.0f} % to the graph's bytes and takes "
          f"{covered_seconds / plain_seconds:.1f} times its seconds; bounds: cliques at tets {tets} in {tets_seconds:.1f} s, "
          f"cover {with_cover} in {cover_seconds:.1f} s, graph alone {alone} in {alone_seconds:.1f} s", flush=True)
    return tets > 1.01 * alone or tets_seconds > alone_seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true")
    parser.add_argument("--cliques", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if options.cliques:
            sys.exit(1 if any([measure_cliques(*case) for case in clique_cases()]) else 0)
        missed = [measure(n) for n in ((12, 20) if options.large else (12,))]
        missed.append(stream_share(16))
    sys.exit(1 if any(missed) else 0)


main()
