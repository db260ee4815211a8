#!/usr/bin/python3
"""name_faces.py NAME=AXIS:VALUE... [body NAME=NUMBER...] < IN.step > OUT.step - names faces and bodies of a STEP file.

A flat face at right angles to an axis (x, y or z), at this value of it, gets the name: base=z:0. Bodies are numbered from 1 in the
order of the file: body plate=1.
"""
import re
import sys


def main():
    text = sys.stdin.read()
    entities = {number: (kind, arguments) for number, kind, arguments in re.findall(r"#(\d+)\s*=\s*([A-Z_0-9]+)\s*\((.*?)\)\s*;", text, re.S)}
    refs = lambda number: re.findall(r"#(\d+)", entities[number][1])
    numbers = lambda number: [float(x) for x in re.findall(r"-?\d+\.?\d*(?:E[+-]?\d+)?", entities[number][1].split("(", 1)[1])]
    wanted, bodies, words = [], {}, iter(sys.argv[1:])
    for word in words:
        if word == "body":
            name, number = next(words).split("=")
            bodies[int(number)] = name
            continue
        name, place = word.split("=")
        axis, value = place.split(":")
        wanted.append((name, "xyz".index(axis), float(value)))
    count = {name: 0 for name, _, _ in wanted}

    def renamed(number, name):
        nonlocal text
        text, changes = re.subn(rf"(#{number}\s*=\s*[A-Z_]+\s*\()'[^']*'", rf"\g<1>'{name}'", text)
        assert changes == 1, (number, name)

    for number, (kind, _) in entities.items():
        surface = refs(number)[-1] if kind == "ADVANCED_FACE" else None
        if entities.get(surface, ("", ""))[0] != "PLANE":
            continue
        point, normal = refs(refs(surface)[0])[:2]
        for name, axis, value in wanted:
            if abs(abs(numbers(normal)[axis]) - 1) < 1e-9 and abs(numbers(point)[axis] - value) < 1e-6:
                renamed(number, name)
                count[name] += 1
    solids = [number for number, (kind, _) in entities.items() if kind == "MANIFOLD_SOLID_BREP"]
    for index, name in bodies.items():
        renamed(solids[index - 1], name)
    missing = [name for name, found in count.items() if found == 0]
    if missing:
        sys.exit(f"no face for {', '.join(missing)}")
    sys.stdout.write(text)


if __name__ == "__main__":
    main()
