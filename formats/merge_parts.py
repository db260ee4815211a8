#!/usr/bin/python3
"""merge_parts.py PART.tar... - put together what findhex or buildgraph made with --part 1/k ... k/k; bundles in, a bundle out.

What goes to standard output has the bytes of one run without --part. The parts come in their order, uncompressed, and are
files: they are read member by member. Members of earlier stages have to be the same in all.
"""
import io
import json
import sys
import tarfile

import numpy as np

BLOCK = 512


def fail(message):
    sys.exit(f"merge_parts.py: {message}")


class Part:
    def __init__(self, path):
        try:
            self.path, self.tar = path, tarfile.open(path, "r:")
            self.members = {member.name: member for member in self.tar}
        except (OSError, tarfile.TarError) as error:
            fail(f"{path}: expected an uncompressed bundle, found: {error}")

    def bytes_of(self, name):
        return self.tar.extractfile(self.members[name]).read()

    def array(self, name):
        return np.load(io.BytesIO(self.bytes_of(name)))

    def header(self, name):
        """As it stands in the file, so that what is written has the form that the tools give it."""
        self.tar.fileobj.seek(self.members[name].offset)
        return bytearray(self.tar.fileobj.read(BLOCK))


def add(part, name, data):
    if len(data) >= 8 << 30:
        fail(f"{name}: expected less than 8 GiB, found {len(data)} bytes: make this in one run")
    header = part.header(name)
    header[124:136] = b"%011o " % len(data)
    header[148:156] = b" " * 8
    header[148:156] = b"%06o\0 " % sum(header)
    out = sys.stdout.buffer
    out.write(header)
    out.write(data)
    out.write(bytes(-len(data) % BLOCK))


def add_array(part, name, array):
    data = io.BytesIO()
    np.save(data, array)
    add(part, name, data.getbuffer())


def lists_in_order(parts, offsets, items, order):
    """Lists of all parts one after another, then in this order."""
    lengths = np.concatenate([np.diff(part.array(offsets)) for part in parts])
    begins, lengths = (np.cumsum(lengths) - lengths)[order], lengths[order]
    ends = np.concatenate([[0], np.cumsum(lengths)])
    everything = np.concatenate([part.array(items) for part in parts])
    return ends, everything[np.repeat(begins - ends[:-1], lengths) + np.arange(ends[-1])]


def merge_candidates(parts):
    """Each kind in the order of the parts."""
    at = lambda name: f"candidates/{name}.npy"
    kinds = np.concatenate([part.array(at("kind")) for part in parts])
    order = np.argsort(kinds, kind="stable")
    for name in ("vertices", "kind", "quality", "volume"):
        add_array(parts[0], at(name), np.concatenate([part.array(at(name)) for part in parts])[order])
    for name in ("", "boundary_"):
        ends, items = lists_in_order(parts, at(name + "tet_offsets"), at(name + "tets"), order)
        add_array(parts[0], at(name + "tet_offsets"), ends)
        add_array(parts[0], at(name + "tets"), items)


def merge_graphs(parts):
    """Each conflict is in one part, at both ends, and later parts have the higher neighbours."""
    at = lambda name: f"graph/{name}.npy"
    weights = parts[0].bytes_of(at("weights"))
    if any(part.bytes_of(at("weights")) != weights for part in parts):
        fail("expected the same weights in all parts")
    degrees = [np.diff(part.array(at("offsets"))) for part in parts]
    offsets = np.concatenate([[0], np.cumsum(sum(degrees))])
    neighbours, filled = np.empty(offsets[-1], np.int32), offsets[:-1].copy()
    for part, degree in zip(parts, degrees):
        begins = np.cumsum(degree) - degree
        neighbours[np.repeat(filled - begins, degree) + np.arange(degree.sum())] = part.array(at("neighbours"))
        filled += degree
    add_array(parts[0], at("offsets"), offsets)
    add_array(parts[0], at("neighbours"), neighbours)
    add(parts[0], at("weights"), weights)


def merge_history(parts, name):
    """That of one run: the part is all, and what was found adds up."""
    entries = [json.loads(part.bytes_of(name)) for part in parts]
    shares = [entry["options"].pop("part", None) for entry in entries]
    if shares != [f"{i}/{len(parts)}" for i in range(1, len(parts) + 1)]:
        fail(f"expected the parts 1/{len(parts)} to {len(parts)}/{len(parts)} in order, found {', '.join(map(str, shares))}")
    first = json.loads(parts[0].bytes_of(name))
    if any(entry["options"] != entries[0]["options"] or entry["version"] != entries[0]["version"] for entry in entries):
        fail("expected parts of one run, found other options or versions")
    first["options"]["part"] = "1/1"
    if "candidates" in first:
        first["candidates"] = {kind: sum(entry["candidates"][kind] for entry in entries) for kind in first["candidates"]}
    if "edges" in first:
        first["edges"] = sum(entry["edges"] for entry in entries)
    return (json.dumps(first, indent=2, ensure_ascii=False) + "\n").encode()


def main(paths):
    if not paths or paths[0].startswith("-"):
        sys.exit(__doc__.strip())
    parts = [Part(path) for path in paths]
    names = list(parts[0].members)
    merge = {"findhex.json": merge_candidates, "buildgraph.json": merge_graphs}.get(names[-1].split("-")[-1])
    if merge is None or any(list(part.members) != names for part in parts):
        fail("expected bundles that findhex or buildgraph wrote last, with the same members")
    own = "candidates/" if merge is merge_candidates else "graph/"
    history = merge_history(parts, names[-1])
    for name in names[:-1]:
        if name.startswith(own):
            continue
        data = parts[0].bytes_of(name)
        if any(part.bytes_of(name) != data for part in parts[1:]):
            fail(f"{name}: expected the same in all parts")
        add(parts[0], name, data)
    merge(parts)
    add(parts[0], names[-1], history)
    sys.stdout.buffer.write(bytes(2 * BLOCK))


main(sys.argv[1:])
