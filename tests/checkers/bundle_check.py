#!/usr/bin/python3
"""bundle_check.py FILE... - is this a hexpipe bundle whose members fit together?

Reads with tarfile and numpy alone. Prints a line a file with the roles found and their sizes, or what is wrong; exits 1
when anything is.
"""
import io
import json
import sys
import tarfile

import numpy as np

MEMBERS = {  # member: (dtype, columns; 0 = one dimension)
    "mesh/points.npy": ("<f8", 3), "mesh/tets.npy": ("<i4", 4), "mesh/tet_tags.npy": ("<i4", 0),
    "mesh/triangles.npy": ("<i4", 3), "mesh/triangle_tags.npy": ("<i4", 0), "mesh/dislocations.npy": ("<f8", 6),
    "candidates/vertices.npy": ("<i4", 8), "candidates/kind.npy": ("|u1", 0), "candidates/quality.npy": ("<f8", 0),
    "candidates/volume.npy": ("<f8", 0), "candidates/tets.npy": ("<i4", 0), "candidates/tet_offsets.npy": ("<i8", 0),
    "candidates/boundary_tets.npy": ("<i4", 0), "candidates/boundary_tet_offsets.npy": ("<i8", 0),
    "graph/offsets.npy": ("<i8", 0), "graph/neighbours.npy": ("<i4", 0), "graph/weights.npy": ("<i8", 0),
    "graph/quads.npy": ("<i4", 4),
    "graph/clique_offsets.npy": ("<i8", 0), "graph/clique_members.npy": ("<i4", 0),
    "solution/chosen.npy": ("<i4", 0),
    "result/points.npy": ("<f8", 3), "result/hexes.npy": ("<i4", 8), "result/prisms.npy": ("<i4", 6),
    "result/pyramids.npy": ("<i4", 5), "result/tets.npy": ("<i4", 4), "result/triangles.npy": ("<i4", 3),
    "result/quads.npy": ("<i4", 4),
}
for cells in ("hexes", "prisms", "pyramids", "tets", "triangles", "quads"):
    MEMBERS[f"result/{cells}_tags.npy"] = ("<i4", 0)
    MEMBERS[f"result/{cells}_quality.npy"] = ("<f8", 0)


def require(condition, message):
    if not condition:
        raise ValueError(message)


def read(path):
    data = {}
    with tarfile.open(path) as archive:
        for member in archive:
            require(member.isfile(), f"{member.name} is no plain file")
            require(member.name not in data, f"{member.name} stands twice")
            require(member.mtime == 0 and member.uid == 0, f"{member.name} carries a time or an owner")
            raw = archive.extractfile(member).read()
            if member.name.endswith(".npy"):
                array = np.load(io.BytesIO(raw))
                if member.name in MEMBERS:
                    dtype, columns = MEMBERS[member.name]
                    shape_fits = array.ndim == 1 if columns == 0 else array.ndim == 2 and array.shape[1] == columns
                    require(array.dtype.str == dtype and shape_fits,
                            f"{member.name} is {array.dtype.str} {array.shape}")
                data[member.name] = array
            elif member.name.endswith(".json"):
                data[member.name] = json.loads(raw)
            else:
                data[member.name] = raw
    return data


def in_range(data, name, count, low=0):
    array = data[name]
    require(array.size == 0 or (array.min() >= low and array.max() < count), f"{name} leaves [{low}, {count})")


def offsets(data, name, items):
    array = data[name]
    require(array[0] == 0 and (np.diff(array) >= 0).all() and array[-1] == len(data[items]),
            f"{name} does not fit {items}")
    return len(array) - 1


def check_mesh(data):
    vertices = len(data["mesh/points.npy"])
    require(np.isfinite(data["mesh/points.npy"]).all(), "a coordinate is not finite")
    for name in ("mesh/tets.npy", "mesh/triangles.npy"):
        in_range(data, name, vertices)
    require(len(data["mesh/tet_tags.npy"]) == len(data["mesh/tets.npy"]), "tet_tags do not fit tets")
    require(len(data["mesh/triangle_tags.npy"]) == len(data["mesh/triangles.npy"]), "triangle_tags do not fit")
    return f"mesh {vertices} points {len(data['mesh/tets.npy'])} tets"


def check_candidates(data):
    count = len(data["candidates/kind.npy"])
    require(np.isin(data["candidates/kind.npy"], (12, 13, 14)).all(), "an unknown kind")
    for name in ("vertices", "quality", "volume"):
        require(len(data[f"candidates/{name}.npy"]) == count, f"{name} does not fit kind")
    for prefix in ("", "boundary_"):
        items = f"candidates/{prefix}tets.npy"
        require(offsets(data, f"candidates/{prefix}tet_offsets.npy", items) == count, f"{prefix}tet_offsets")
        if "mesh/tets.npy" in data:
            in_range(data, items, len(data["mesh/tets.npy"]))
    if "mesh/points.npy" in data:
        in_range(data, "candidates/vertices.npy", len(data["mesh/points.npy"]), low=-1)
    return f"candidates {count}"


def check_graph(data):
    count = offsets(data, "graph/offsets.npy", "graph/neighbours.npy")
    start, to, weights = (data[f"graph/{n}.npy"] for n in ("offsets", "neighbours", "weights"))
    require(len(weights) == count and (weights >= 0).all(), "weights do not fit the graph")
    quads = len(data.get("graph/quads.npy", ()))
    require("candidates/kind.npy" not in data or len(data["candidates/kind.npy"]) + quads == count,
            "graph and candidates differ")
    in_range(data, "graph/neighbours.npy", count)
    source = np.repeat(np.arange(count, dtype=np.int64), np.diff(start))
    key = source * count + to
    require((np.diff(key) > 0).all(), "neighbours are not ascending")
    require((source != to).all(), "a loop")
    require((np.sort(to.astype(np.int64) * count + source) == key).all(), "an edge has one side")
    return f"graph {count} vertices {len(to) // 2} edges"


def check_solution(data):
    chosen = data["solution/chosen.npy"]
    require((np.diff(chosen) > 0).all(), "chosen is not ascending")
    if "graph/weights.npy" not in data:
        return f"solution {len(chosen)}"
    start, to, weights = (data[f"graph/{n}.npy"] for n in ("offsets", "neighbours", "weights"))
    in_range(data, "solution/chosen.npy", len(weights))
    inside = np.zeros(len(weights), bool)
    inside[chosen] = True
    for v in chosen:
        require(not inside[to[start[v]:start[v + 1]]].any(), f"{v} and a neighbour are both chosen")
    return f"solution {len(chosen)} weight {weights[chosen].sum()}"


def check_result(data):
    vertices = len(data["result/points.npy"])
    sizes = []
    for cells in ("hexes", "prisms", "pyramids", "tets", "triangles", "quads"):
        in_range(data, f"result/{cells}.npy", vertices)
        count = len(data[f"result/{cells}.npy"])
        require(len(data[f"result/{cells}_tags.npy"]) == count, f"{cells}_tags do not fit")
        if cells not in ("triangles", "quads"):
            require(len(data[f"result/{cells}_quality.npy"]) == count, f"{cells}_quality do not fit")
        sizes.append(f"{count} {cells}")
    return f"result {vertices} points " + " ".join(sizes)


CHECKS = {"mesh/points.npy": check_mesh, "candidates/kind.npy": check_candidates, "graph/offsets.npy": check_graph,
          "solution/chosen.npy": check_solution, "result/points.npy": check_result}


def main():
    wrong = 0
    for path in sys.argv[1:]:
        try:
            data = read(path)
            history = [data[name]["tool"] for name in data if name.startswith("history/")]
            found = [check(data) for name, check in CHECKS.items() if name in data]
            print(f"{path}: {'; '.join(found)}; history {' '.join(history)}")
        except (ValueError, KeyError, tarfile.TarError, OSError, EOFError) as error:
            print(f"{path}: WRONG: {error}")
            wrong = 1
    sys.exit(wrong)


main()
