#!/usr/bin/python3
"""split_solution.py SOLVED.tar FOLDER GRAPH-PART.tar... - divides the solution of a whole graph among its parts, in bundles in the folder.

About candidates of other parts each part says the contrary of the truth, which must not count.
"""
import io
import os
import sys
import tarfile

import numpy as np


def arrays(path, *names):
    with tarfile.open(path) as tar:
        return [np.load(io.BytesIO(tar.extractfile(name).read())) for name in names]


def main():
    solved, folder, paths = sys.argv[1], sys.argv[2], sys.argv[3:]
    os.makedirs(folder, exist_ok=True)
    parts = [arrays(path, "candidates/key.npy", "candidates/part.npy") for path in paths]
    keys = np.sort(np.concatenate([key[part == i] for i, (key, part) in enumerate(parts)]))
    chosen = keys[arrays(solved, "solution/chosen.npy")[0]]
    with tarfile.open(solved) as tar:
        entries = [(m.name, tar.extractfile(m).read()) for m in tar if m.name.startswith("history/") and m.name.endswith(("initsol.json", "lns.json"))]
    for i, (path, (key, part)) in enumerate(zip(paths, parts)):
        data = io.BytesIO()
        np.save(data, np.flatnonzero(np.isin(key, chosen) == (part == i)).astype("<i4"))
        with tarfile.open(path) as old, tarfile.open(f"{folder}/part-{i:04}.tar", "w", format=tarfile.PAX_FORMAT) as new:
            for member in old:
                new.addfile(member, old.extractfile(member))
            for name, content in [("solution/chosen.npy", data.getvalue()), *((f"history/{5 + j:02}-{name.split('-', 1)[1]}", text) for j, (name, text) in enumerate(entries))]:
                member = tarfile.TarInfo(name)
                member.size = len(content)
                new.addfile(member, io.BytesIO(content))


main()
