"""The edge lengths at which the benchmarks mesh the models of ../shared/models: coarse, middle and fine, by the name of the file.

Meshes depend on the last bit of the size. So where a benchmark computes or rounds it in its own way, it is kept as it is: the
figures of the log are those of exactly these numbers."""
import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MODELS = os.path.join(ROOT, "..", "shared", "models")
sys.path.insert(0, os.path.join(ROOT, "tests", "checkers"))

LEVELS = ("coarse", "middle", "fine")
# As in the models' README: for these MAMBO models, otherwise the longest side of the bounding box by these numbers.
SIZES = {"mambo-s1": (5.2, 3.3, 2.3), "mambo-s27": (3.2, 2.05, 1.42), "mambo-m1": (5.1, 3.2, 2.2), "mambo-m6": (3.2, 2.1, 1.45)}
PARTS = (16, 28, 40)
# assemble.py has a size of its own for one more.
SIZES_OF_ASSEMBLE = SIZES | {"mambo-s22": (5.2, 3.3, 2.3)}
# checkmesh.py: the eleven models in its order, middle and fine, rounded to four digits.
ROUNDED = {
    "bridge.stl": (0.3571, 0.25), "mambo-m1.stl": SIZES["mambo-m1"][1:], "mambo-m6.stl": SIZES["mambo-m6"][1:],
    "mambo-s1.stl": SIZES["mambo-s1"][1:], "mambo-s22.stl": (3.857, 2.7), "mambo-s27.stl": SIZES["mambo-s27"][1:],
    "notch.stl": (0.03571, 0.025), "plate-holes.stl": (10.89, 7.623), "simp.stl": (6.786, 4.75), "spot.obj": (0.06135, 0.04295),
    "blub.off": (0.1039, 0.07273),
}


def name_of(path):
    return os.path.basename(path).rsplit(".", 1)[0]


def longest_side(path):
    import surfcheck
    points, _ = surfcheck.read(path)
    return float((points.max(axis=0) - points.min(axis=0)).max())


def size_of(path, level):
    """The size of a model at LEVELS[level]."""
    sizes = SIZES.get(name_of(path))
    return sizes[level] if sizes else longest_side(path) * (1 / PARTS[level])


def size_of_assemble(path, level):
    sizes = SIZES_OF_ASSEMBLE.get(name_of(path))
    return sizes[level] if sizes else longest_side(path) / PARTS[level]
