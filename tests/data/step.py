#!/usr/bin/python3
"""Writes small STEP files for tests: bodies of flat faces, with names, colours, layers and units.

    step.py KIND > FILE

KIND is one of those at the end of this file.
"""
import sys

SIDES = {"bottom": (0, 3, 2, 1), "top": (4, 5, 6, 7), "front": (0, 1, 5, 4), "right": (1, 2, 6, 5), "back": (2, 3, 7, 6), "left": (3, 0, 4, 7)}


class Step:
    def __init__(self, unit="mm"):
        self.lines, self.unit, self.items, self.styles = [], unit, [], []

    def add(self, text):
        self.lines.append(text)
        return f"#{len(self.lines)}"

    def point(self, p):
        return self.add("CARTESIAN_POINT('',(%s))" % ",".join(f"{float(c)!r}" for c in p))

    def direction(self, d):
        length = sum(c * c for c in d) ** 0.5
        return self.add("DIRECTION('',(%s))" % ",".join(f"{c / length!r}" for c in d))

    def shell(self, points, faces, names={}, closed=True):
        """A shell of flat faces: name -> corners, counter-clockwise from outside. Two faces share each edge."""
        vertices = [self.add(f"VERTEX_POINT('',{self.point(p)})") for p in points]
        edges, made = {}, []
        for key, corners in faces.items():
            loop = []
            for a, b in zip(corners, corners[1:] + corners[:1]):
                low, high = min(a, b), max(a, b)
                if (low, high) not in edges:
                    along = [points[high][i] - points[low][i] for i in range(3)]
                    vector = self.add(f"VECTOR('',{self.direction(along)},1.)")
                    line = self.add(f"LINE('',{self.point(points[low])},{vector})")
                    edges[low, high] = self.add(f"EDGE_CURVE('',{vertices[low]},{vertices[high]},{line},.T.)")
                loop.append(self.add(f"ORIENTED_EDGE('',*,*,{edges[low, high]},{'.T.' if a < b else '.F.'})"))
            bound = self.add(f"FACE_OUTER_BOUND('',{self.add('EDGE_LOOP(%s,(%s))' % (chr(39) * 2, ','.join(loop)))},.T.)")
            u = [points[corners[1]][i] - points[corners[0]][i] for i in range(3)]
            v = [points[corners[2]][i] - points[corners[0]][i] for i in range(3)]
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            place = self.add(f"AXIS2_PLACEMENT_3D('',{self.point(points[corners[0]])},{self.direction(normal)},{self.direction(u)})")
            plane = self.add(f"PLANE('',{place})")
            made.append(self.add(f"ADVANCED_FACE('{names.get(key, '')}',({bound}),{plane},.T.)"))
        self.faces = dict(zip(faces, made))
        return self.add(f"{'CLOSED' if closed else 'OPEN'}_SHELL('',({','.join(made)}))")

    def box(self, low, high, name="", names={}, without=()):
        points = [tuple((low, high)[(i >> k) & 1][k] for k in range(3)) for i in (0, 1, 3, 2, 4, 5, 7, 6)]
        faces = {key: corners for key, corners in SIDES.items() if key not in without}
        shell = self.shell(points, faces, names, closed=not without)
        if without:
            self.items.append(self.add(f"SHELL_BASED_SURFACE_MODEL('',({shell}))"))
        else:
            self.items.append(self.add(f"MANIFOLD_SOLID_BREP('{name}',{shell})"))

    def sheet(self, points, name):
        """A face of four corners that belongs to no body."""
        shell = self.shell(points, {"face": (0, 1, 2, 3)}, {"face": name}, closed=False)
        self.items.append(self.add(f"SHELL_BASED_SURFACE_MODEL('',({shell}))"))

    def colour(self, item, red, green, blue):
        rgb = self.add(f"COLOUR_RGB('',{float(red)},{float(green)},{float(blue)})")
        fill = self.add(f"FILL_AREA_STYLE('',({self.add(f'FILL_AREA_STYLE_COLOUR({chr(39)*2},{rgb})')}))")
        side = self.add(f"SURFACE_SIDE_STYLE('',({self.add(f'SURFACE_STYLE_FILL_AREA({fill})')}))")
        usage = self.add(f"SURFACE_STYLE_USAGE(.BOTH.,{side})")
        self.styles.append(self.add(f"STYLED_ITEM('',({self.add(f'PRESENTATION_STYLE_ASSIGNMENT(({usage}))')}),{item})"))

    def layer(self, name, item):
        self.add(f"PRESENTATION_LAYER_ASSIGNMENT('{name}','',({item}))")

    def text(self, product="product", representation="ADVANCED_BREP_SHAPE_REPRESENTATION"):
        prefix = {"m": "$", "mm": ".MILLI."}.get(self.unit)
        if prefix:
            length = self.add(f"(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT({prefix},.METRE.))")
        else:
            metre = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
            measure = self.add(f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),{metre})")
            exponents = self.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
            length = self.add(f"(CONVERSION_BASED_UNIT('INCH',{measure})LENGTH_UNIT()NAMED_UNIT({exponents}))")
        angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        solid = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
        precision = self.add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7),{length},'distance_accuracy_value','')")
        context = self.add(
            f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({precision}))"
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid}))REPRESENTATION_CONTEXT('',''))")
        shape = self.add(f"{representation}('',({','.join(self.items)}),{context})")
        application = self.add("APPLICATION_CONTEXT('automotive_design')")
        self.add(f"APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,{application})")
        part = self.add(f"PRODUCT('{product}','{product}','',({self.add(f'PRODUCT_CONTEXT({chr(39)*2},{application},{chr(39)}mechanical{chr(39)})')}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',{part})")
        definition = self.add(f"PRODUCT_DEFINITION('','',{formation},{self.add(f'PRODUCT_DEFINITION_CONTEXT({chr(39)}part definition{chr(39)},{application},{chr(39)}design{chr(39)})')})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION({self.add(f'PRODUCT_DEFINITION_SHAPE({chr(39)*2},{chr(39)*2},{definition})')},{shape})")
        if self.styles:
            self.add(f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',({','.join(self.styles)}),{context})")
        head = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','2024-01-01T00:00:00',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n"
        body = "".join(f"#{i + 1}={line};\n" for i, line in enumerate(self.lines))
        return head + body + "ENDSEC;\nEND-ISO-10303-21;\n"


def box(names={}, name="", unit="mm", **more):
    step = Step(unit)
    step.box((0, 0, 0), (10, 20, 30), name, names, **more)
    return step


def coloured():
    step = box({"top": "inlet"})
    step.colour(step.items[0], 0.5, 0.5, 0.5)
    step.colour(step.faces["top"], 1, 0, 0)
    step.colour(step.faces["bottom"], 1, 0, 0)
    step.layer("outflow", step.faces["left"])
    return step


def bodies(*boxes):
    step = Step()
    for i, (low, high) in enumerate(boxes):
        step.box(low, high, f"body {i + 1}")
    return step


def grid(count):
    return bodies(*[((3 * (i % 10), 3 * (i // 10 % 10), 3 * (i // 100)), (3 * (i % 10) + 2, 3 * (i // 10 % 10) + 2, 3 * (i // 100) + 2)) for i in range(count)])


def baffles(*spans):
    """A room 6 x 4 x 4 with sheets at x = 3, from y and z to y and z."""
    step = Step()
    step.box((0, 0, 0), (6, 4, 4), "room", {"left": "inlet", "right": "outlet"})
    for i, (low, high) in enumerate(spans):
        step.sheet([(3, low[0], low[1]), (3, high[0], low[1]), (3, high[0], high[1]), (3, low[0], high[1])], "vane" if i == 0 else f"vane {i + 1}")
    return step


def in_channel():
    """A channel with a C as its profile, and a thin plate on the inner side of each arm."""
    step = Step()
    profile = [(0, 0), (6, 0), (6, 1), (1, 1), (1, 5), (6, 5), (6, 6), (0, 6)]
    count = len(profile)
    faces = {"bottom": tuple(reversed(range(count))), "top": tuple(range(count, 2 * count))}
    for i in range(count):
        faces[f"side {i}"] = (i, (i + 1) % count, (i + 1) % count + count, i + count)
    shell = step.shell([(x, y, z) for z in (0, 2) for x, y in profile], faces)
    step.items.append(step.add(f"MANIFOLD_SOLID_BREP('channel',{shell})"))
    step.box((2, 1, 0.5), (5, 1.25, 1.5), "lower plate")
    step.box((2, 4.75, 0.5), (5, 5, 1.5), "upper plate")
    return step


def roof(rise):
    """A box 4 x 4 x 2 whose top rises to a ridge in the middle, which is less sharp than 40 degrees."""
    step = Step()
    points = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (0, 0, 2), (4, 0, 2), (4, 4, 2), (0, 4, 2), (2, 0, 2 + rise), (2, 4, 2 + rise)]
    faces = {"bottom": (0, 3, 2, 1), "west": (3, 0, 4, 7), "east": (1, 2, 6, 5), "south": (0, 1, 5, 8, 4),
             "north": (2, 3, 7, 9, 6), "left": (4, 8, 9, 7), "right": (8, 5, 6, 9)}
    shell = step.shell(points, faces, {"left": "roof", "right": "roof"})
    step.items.append(step.add(f"MANIFOLD_SOLID_BREP('house',{shell})"))
    return step


KINDS = {
    "box": lambda: box().text(),
    "named": lambda: box({"left": "inlet", "right": "outlet"}, "pipe").text(),
    "one-name": lambda: box({"left": "wall", "right": "wall"}).text(),
    "odd-names": lambda: box({"left": "Ein\\X2\\006C00E400DF\\X0\\ 1", "right": "a ''b'' \"c\"", "top": "x" * 200}, "St\\X\\FCck").text(),
    "clash": lambda: box({"left": "wall", "right": "WALL", "top": "surface_1", "bottom": "Wall"}, "wall").text(),
    "metres": lambda: box(unit="m").text(),
    "inches": lambda: box(unit="inch").text(),
    "coloured": lambda: coloured().text(),
    "sheets": lambda: box(without=("top",)).text(representation="MANIFOLD_SURFACE_SHAPE_REPRESENTATION"),
    "closed-shell": lambda: closed_shell().text(representation="MANIFOLD_SURFACE_SHAPE_REPRESENTATION"),
    "nothing": lambda: Step().text(),
    "touching": lambda: bodies(((0, 0, 0), (4, 4, 4)), ((4, 0, 0), (8, 4, 4))).text(),
    "half-touching": lambda: bodies(((0, 0, 0), (4, 4, 4)), ((4, 1, 1), (7, 3, 3))).text(),
    "overlapping": lambda: bodies(((0, 0, 0), (4, 4, 4)), ((2, 2, 2), (6, 6, 6))).text(),
    "two-of-three": lambda: bodies(((10, 0, 0), (14, 4, 4)), ((0, 0, 0), (4, 4, 4)), ((2, 2, 2), (6, 6, 6))).text(),
    "twice": lambda: bodies(((0, 0, 0), (4, 4, 4)), ((0, 0, 0), (4, 4, 4))).text(),
    "in-channel": lambda: in_channel().text(),
    "in-another": lambda: bodies(((0, 0, 0), (6, 6, 6)), ((2, 2, 2), (4, 4, 4))).text(),
    "through-another": lambda: bodies(((0, 0, 0), (6, 2, 2)), ((2, -1, -1), (4, 3, 3))).text(),
    "apart": lambda: bodies(((0, 0, 0), (4, 4, 4)), ((5, 0, 0), (9, 4, 4))).text(),
    "many": lambda: grid(500).text(),
    "baffle": lambda: baffles(((0, 0), (4, 2))).text(),
    "floating-baffle": lambda: baffles(((1, 1), (3, 3))).text(),
    "poking-baffle": lambda: baffles(((1, 2), (3, 6))).text(),
    "baffle-outside": lambda: baffles(((1, 4), (3, 6))).text(),
    "roof": lambda: roof(0.4).text(),
}


def closed_shell():
    step = Step()
    points = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (0, 0, 4), (4, 0, 4), (4, 4, 4), (0, 4, 4)]
    shell = step.shell(points, SIDES)
    step.items.append(step.add(f"SHELL_BASED_SURFACE_MODEL('',({shell}))"))
    return step


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in KINDS:
        sys.exit(__doc__ + "\n" + " ".join(KINDS))
    sys.stdout.write(KINDS[sys.argv[1]]())
