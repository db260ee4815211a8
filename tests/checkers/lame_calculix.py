#!/usr/bin/python3
"""lame_calculix.py FILE.inp - a quarter of a ring under pressure inside, solved by CalculiX on a mesh of tests/data/ring.py.

The ring has the radii 1 and 2 and does not stretch along its axis; G. Lamé's solution is exact. Prints one line of JSON:
  unknowns      three a node that an element has
  elements
  displacement  the error of displacements, root of the mean square over the nodes, as a share of that of the exact ones
  stress        the greatest error of a stress at a point of integration, as a share of the pressure
"""
import json
import subprocess
import sys

import numpy as np

YOUNG, POISSON, PRESSURE = 210000.0, 0.3, 100.0
INSIDE, OUTSIDE = 1.0, 2.0


def exact_displacements(points):
    radius = np.hypot(points[:, 0], points[:, 1])
    factor = (1 + POISSON) * PRESSURE * INSIDE ** 2 / (YOUNG * (OUTSIDE ** 2 - INSIDE ** 2))
    out = factor * ((1 - 2 * POISSON) * radius + OUTSIDE ** 2 / radius)
    return np.column_stack([out * points[:, 0] / radius, out * points[:, 1] / radius, 0 * out])


def exact_stresses(points):
    """xx, yy, zz, xy, xz, yz"""
    radius = np.hypot(points[:, 0], points[:, 1])
    c, s = points[:, 0] / radius, points[:, 1] / radius
    factor = PRESSURE * INSIDE ** 2 / (OUTSIDE ** 2 - INSIDE ** 2)
    radial, around = factor * (1 - OUTSIDE ** 2 / radius ** 2), factor * (1 + OUTSIDE ** 2 / radius ** 2)
    return np.column_stack([radial * c * c + around * s * s, radial * s * s + around * c * c,
                            POISSON * (radial + around), (radial - around) * c * s, 0 * c, 0 * c])


def read_mesh(path):
    """Points by number, the nodes that elements have, the number of elements, and the sets that have all nodes."""
    nodes, used, elements, section, continues, sets = {}, set(), 0, "", False, []
    with open(path) as file:
        for line in file:
            if line.startswith("*"):
                section = line.split(",")[0].strip()
                # Those that are tied to others (NTIED) are not in NALL.
                if section == "*NODE" and "NSET=" in line:
                    sets.append(line.split("NSET=")[1].strip())
            elif section == "*NODE":
                number, *at = line.split(",")
                nodes[int(number)] = [float(x) for x in at]
            elif section == "*ELEMENT":
                numbers = [int(x) for x in line.split(",") if x.strip()]
                elements += not continues
                used.update(numbers if continues else numbers[1:])
                continues = line.rstrip().endswith(",")
    return nodes, sorted(used), elements, sets


def write_case(path, node_sets):
    with open("case.inp", "w") as case:
        print("*INCLUDE, INPUT=" + path, file=case)
        print("*MATERIAL, NAME=STEEL\n*ELASTIC\n%r, %r" % (YOUNG, POISSON), file=case)
        print("*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n*BOUNDARY", file=case)
        print("x0, 1, 1, 0\ny0, 2, 2, 0\nbottom, 3, 3, 0\ntop, 3, 3, 0", file=case)
        print("*STEP\n*STATIC\n*DSLOAD\ninner, P, %r" % PRESSURE, file=case)
        for name in node_sets:
            print("*NODE PRINT, NSET=%s\nU" % name, file=case)
        print("*EL PRINT, ELSET=EALL\nS, COORD\n*END STEP", file=case)


def read_answer():
    displacements, stresses, places, section = {}, [], [], None
    with open("case.dat") as file:
        for line in file:
            words = line.split()
            if line.startswith(" displacements"):
                section = "u"
            elif line.startswith(" stresses"):
                section = "s"
            elif line.startswith(" global coordinates"):
                section = "x"
            elif section == "u" and len(words) == 4:
                displacements[int(words[0])] = [float(x) for x in words[1:]]
            elif section == "s" and len(words) == 8:
                stresses.append([float(x) for x in words[2:]])
            elif section == "x" and len(words) == 5:
                places.append([float(x) for x in words[2:]])
    return displacements, np.array(stresses), np.array(places)


def main():
    nodes, used, elements, node_sets = read_mesh(sys.argv[1])
    write_case(sys.argv[1], node_sets)
    with open("ccx.log", "w") as log:
        subprocess.run(["ccx", "case"], stdout=log, stderr=log, check=True)
    displacements, stresses, places = read_answer()
    exact = exact_displacements(np.array([nodes[i] for i in used]))
    error = np.array([displacements[i] for i in used]) - exact
    result = dict(unknowns=3 * len(used), elements=elements,
                  displacement=float(np.sqrt((error ** 2).sum() / (exact ** 2).sum())))
    if len(places) == len(stresses):
        result["stress"] = float(abs(stresses - exact_stresses(places)).max() / PRESSURE)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
