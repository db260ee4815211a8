#!/usr/bin/python3
"""make_corpus.py BIN - write the seeds of the fuzzers to corpus/ beside this file, with the tools in BIN.

A seed is a small whole file that its reader takes. What fuzzing found is in findings/ and is not touched.
"""
import gzip
import io
import pathlib
import re
import struct
import subprocess
import sys
import tarfile
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
DATA = ROOT / "tests/data"
BIN = pathlib.Path(sys.argv[1]).resolve()


def run(*command, stdin=None):
    return subprocess.run(command, input=stdin, check=True, stdout=subprocess.PIPE).stdout


def tool(name, *options, stdin=None):
    return run(BIN / name, *options, "-q", stdin=stdin)


def seed(reader, name, data):
    folder = HERE / "corpus" / reader
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())


def only(bundle, *folders):
    """The members of these folders as a bundle of their own."""
    out = io.BytesIO()
    with tarfile.open(fileobj=io.BytesIO(bundle)) as whole, tarfile.open(
        fileobj=out, mode="w", format=tarfile.PAX_FORMAT
    ) as part:
        for member in whole:
            if member.name.split("/")[0] in folders:
                part.addfile(member, whole.extractfile(member))
    # Python fills up to 20 blocks; two of zeros behind the last full one are the end.
    used = len(out.getvalue().rstrip(b"\0"))
    return out.getvalue()[: (used + 511) // 512 * 512].ljust((used + 511) // 512 * 512 + 1024, b"\0")


def meshes():
    targets = {"mesh": "medit", "vtk": "vtk", "vtu": "vtu", "su2": "su2", "bdf": "nastran", "inp": "abaqus"}
    for kind, source in (("all_kinds", DATA / "meshes/one_of_each.msh"), ("tets", DATA / "meshes/cube.1.node")):
        convert = lambda form: run(BIN / "mesh_convert", source, form, "/dev/stdout")
        for form, target in targets.items():
            seed(target, kind, convert(form))
        for form in ("msh", "msh-binary", "msh22", "msh22-binary"):
            seed("msh", f"{kind}.{form}", convert(form))
    parts = [(DATA / "meshes" / f"cube.1.{part}").read_text() for part in ("node", "ele", "face")]
    seed("tetgen", "cube", "=====\n".join(parts))
    seed("tetgen", "without_faces", "=====\n".join(parts[:2]))


def decks():
    """Parts of the solvers' formats that our writers do not use."""
    seed("su2", "blanks", "% a tet\nNDIME = 3\nNELEM=1\n10 0 1 2 3\nNPOIN= 4 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nNMARK= 2\n"
         "MARKER_TAG= inlet\nMARKER_ELEMS= 1\n5 0 3 2\nMARKER_TAG= surface_1\nMARKER_ELEMS= 1\n5 0 1 3\nSEND_RECV= 1\n")
    seed("nastran", "fields", "SOL 101\nCEND\nBEGIN BULK\n$HMNAME COMP 7\"steel\"\nGRID,11,,0.,0.,0.\n"
         "GRID          12              1.      0.     0.0\nGRID*                 13                             .0              1.\n"
         "*                    0.0\ngrid,14,0,0.,0.,+1.+0\nCTETRA         1       7      11      12      13      14\n"
         "CTRIA3,2,5,11,14,13\nPSOLID,7,1\nENDDATA\n")
    seed("abaqus", "deck", "** two tets\n*Heading\n*Part, name=P\n*Node\n 10, 0., 0., 0.\n 20, 1.D0, 0., 0.\n 30, 0., +1.,\n"
         " 40, 0., 0., 1.\n 50, 1., 1., 1.\n 61, .5, 0., 0.\n 62, .5, .5, 0.\n 63, 0., .5, 0.\n 64, 0., 0., .5\n 65, .5, 0., .5\n"
         " 66, 0., .5, .5\n*ELEMENT, TYPE=C3D10,\n ELSET=first\n 7, 10, 20, 30, 40, 61, 62, 63,\n 64, 65, 66\n"
         "*Element, type=C3D4, elset=second\n 9, 20, 30, 40, 50\n*Element, type=S3, elset=skin\n 11, 20, 40, 30\n"
         "*Elset, elset=\"All of it\", generate\n 7, 9, 2\n*Elset, elset=_S4, internal\n 7\n*Elset, elset=nested\n second,\n"
         "*Surface, type=ELEMENT, name=Load\n _S4, S4\n 9, S2\n*Solid Section, elset=FIRST, material=Steel\n,\n*End Part\n")
    collapsed = run(BIN / "mesh_convert", DATA / "meshes/one_of_each.msh", "inp", "/dev/stdout", "", "collapsed")
    seed("abaqus", "collapsed", collapsed)


def sizes():
    tet = (ROOT / "formats/README.md").read_text().split("<!-- example tet.msh22 -->\n```\n")[1].split("```")[0]
    seed("sizes", "places", "# x y z size\n0 0 0 0.5\n10 0 0 2\n")
    seed("sizes", "by_vertex", "0.5\n0.5\n2\n")
    seed("sizes", "background", tet + '$NodeData\n1\n"size"\n1\n0\n3\n0\n1\n4\n1 0.5\n2 0.5\n3 2\n4 2\n$EndNodeData\n')


def examples():
    """What formats/README.md shows, so that every form that it tells of is among the seeds."""
    text = (ROOT / "formats/README.md").read_text()
    readers = {"mesh": "medit", "msh": "msh", "vtk": "vtk", "vtu": "vtu", "su2": "su2", "bdf": "nastran", "inp": "abaqus",
               "stl": "stl", "obj": "obj", "ply": "ply", "off": "off"}
    for name, content in re.findall(r"<!-- (?:example|surface) (\S+) -->\n```\n(.*?)```", text, re.DOTALL):
        reader = readers.get(name.split(".")[-1])
        if reader:
            seed(reader, "readme-" + name.split(".")[0], content)


def stages():
    mesh = run("/usr/bin/python3", DATA / "lattices/lattice.py", "kuhn", "1")
    found = tool("findhex", "--cells", "hex,prism,pyramid", stdin=mesh)
    graph = tool("buildgraph", stdin=found)
    solution = tool("initsol", "--iterations", "1", stdin=graph)
    result = tool("assemble", stdin=solution)
    for folder in ("mesh", "candidates", "graph", "result", "history"):
        seed("members", folder, only(result if folder == "result" else solution, folder))
    seed("members", "graph_and_solution", only(solution, "graph", "solution"))
    seed("bundle", "mesh.tar", only(solution, "mesh"))
    seed("bundle", "solution.tar.zst", run("zstd", "-19", "-c", stdin=solution))
    with tarfile.open(fileobj=io.BytesIO(solution)) as bundle:
        for member in bundle:
            if member.name in ("mesh/points.npy", "graph/offsets.npy", "candidates/kind.npy"):
                seed("npy", member.name.split("/")[1], bundle.extractfile(member).read()[:128])
    seed("cand", "lattice", tool("findhex", "--cells", "hex,prism,pyramid", "--format", "cand", stdin=mesh))
    seed("metis", "lattice", tool("buildgraph", "--format", "graph", stdin=found))
    seed("metis", "edge_weights", "% a path\n3 2 11\n5 2 1\n7 1 1 3 1\n5 2 1\n")
    seed("metis", "unweighted", "4 2\n2\n1\n4\n3\n")
    seed("dimacs", "weights", "c a path\np edge 3 2\nn 2 7\ne 1 2\ne 2 3\n")
    seed("dimacs", "vertex_cover", "c twice\np td 4 3\n1 2\n2 3\n3 4\n")
    seed("dimacs", "colouring", "p col 3 4\nv 1 5\ne 1 2\ne 2 1\ne 2 3\ne 3 2\n")
    # The first byte is the number of vertices.
    seed("sol", "numbers", b"\x05" + b"1\n3\n")
    seed("sol", "flags", b"\x03" + b"1\n0\n1\n")


def tools():
    """Behind a byte that chooses options: the input of each tool, or a mesh for the whole pipeline."""
    lattice = lambda kind, size: run("/usr/bin/python3", DATA / "lattices/lattice.py", kind, size)
    inputs = {"findhex": ["mesh"], "buildgraph": ["candidates"], "initsol": ["graph", "candidates"], "lns": ["graph", "solution"],
              "certify": ["graph", "solution", "candidates"], "assemble": ["mesh", "candidates", "solution"]}
    for name, kind, size, cells in (("cube", "kuhn", "1", "hex,prism,pyramid"), ("cubes", "kuhn", "2", "hex")):
        graph = tool("buildgraph", stdin=tool("findhex", "--cells", cells, "--min-quality", "0.8", stdin=lattice(kind, size)))
        solution = tool("initsol", "--iterations", "1", stdin=graph)
        for choice, (tool_name, folders) in enumerate(inputs.items()):
            seed("tool-" + tool_name, name, bytes([choice % 2]) + only(solution, *folders))
        seed("tool-mesh-part", name, bytes([1]) + only(solution, "mesh"))
        seed("tool-viewmesh", name, bytes([3]) + only(solution, "mesh", "candidates", "graph", "solution"))
        seed("tool-viewmesh", name + "-result", b"\0" + only(tool("assemble", stdin=solution), "result"))
    with tempfile.TemporaryDirectory() as folder:
        mesh = pathlib.Path(folder) / "lattice.mesh"
        mesh.write_bytes(lattice("kuhn", "1"))
        seed("tool-merge-parts", "share", b"\0" + tool("findhex", mesh, "--part", "1/1"))
        tool("mesh-part", mesh, "--parts", "1", "-o", f"{folder}/parts")
        found = pathlib.Path(folder) / "found.tar"
        found.write_bytes(tool("findhex", f"{folder}/parts/part-0000.tar"))
        seed("tool-merge-parts", "part", b"\1" + tool("buildgraph", found, "--neighbours", found))
    for choice, (kind, size) in enumerate((("kuhn", "1"), ("kuhn", "2"), ("five", "1"))):
        seed("pipeline", f"{kind}{size}", bytes([choice]) + lattice(kind, size))
    readme = (ROOT / "formats/README.md").read_text()
    seed("pipeline", "readme", b"\x07" + readme.split("<!-- example tet.mesh -->\n```\n")[1].split("```")[0].encode())


def surfaces():
    binary = bytearray(80) + (4).to_bytes(4, "little")
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    for face in faces:
        binary += struct.pack("<12fH", 0, 0, 0, *(x for c in face for x in corners[c]), 7)
    seed("stl", "binary", bytes(binary))
    for order, mark in (("little", "<"), ("big", ">")):
        head = f"ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty float x\nproperty double y\nproperty short z\n" \
               "element face 4\nproperty uchar flag\nproperty list uchar int vertex_indices\nend_header\n"
        body = b"".join(struct.pack(mark + "fdh", *c) for c in corners)
        body += b"".join(struct.pack(mark + "BB3i", 1, 3, *f) for f in faces)
        seed("ply", f"{order}_endian", head.encode() + body)
    seed("off", "polygons", "COFF 5 5 8\n" + "\n".join(f"{x} {y} {z} 1 0 0 1" for x, y, z in
         ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (.5, .5, 1))) + "\n4 3 2 1 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n")
    seed("obj", "continued", "o part\nv 0 0 0\nv 1 0 0\nv 0 1 0 1.0\nv 0 0 1\nvn 0 0 1\nf 1//1 \\\n 3//1 2//1\nf 1 2 4 \n"
         "usemtl steel\nf -3 -2 -1\nf 1 4 3\n")


def solids():
    """Behind a byte that says what is done with them: tests/fuzz/surfaces.cpp."""
    def off(*cubes, skipped=0):
        points, faces = [], []
        for low, high in cubes:
            first = len(points)
            points += [[(low, high)[i >> axis & 1] for axis in range(3)] for i in range(8)]
            for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
                faces += [[first + v for v in face] for face in ((a, b, c), (a, c, d))]
        faces = faces[skipped:]
        return "\n".join(["OFF", f"{len(points)} {len(faces)} 0", *(" ".join(map(str, p)) for p in points),
                          *(" ".join(map(str, [3, *f])) for f in faces), ""]).encode()

    seed("surface", "cube-remeshed", b"\x08" + off((0, 1)))
    seed("surface", "hole-repaired", b"\x09" + off((0, 1), skipped=1))
    for name, choice in (("regions", 2), ("holes", 4)):
        seed("surface", name, bytes([choice]) + off((0, 3), (1, 2)))
    seed("surface", "stl-repaired", b"\x01" + (DATA / "cube.stl").read_bytes())


def others():
    """What other programs write: packed files, texts in other codes, surfaces in mesh formats, partitions, faults."""
    text = (ROOT / "formats/README.md").read_text()
    obj = text.split("<!-- surface tet.obj -->\n```\n")[1].split("```")[0]
    seed("packed", "obj.gz", gzip.compress(obj.encode(), mtime=0))
    seed("packed", "members.gz", gzip.compress(obj[:50].encode(), mtime=0) + gzip.compress(obj[50:].encode(), mtime=0) + bytes(512))
    for order in ("le", "be"):
        seed("packed", f"obj.utf-16{order}", ("\ufeff" + obj).encode(f"utf-16{order}"))
    seed("packed", "utf-16.gz", gzip.compress(("\ufeff" + obj).encode("utf-16le"), mtime=0))
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)))
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}" pid="5" p1="{b % 2}"/>' for a, b, c in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)))
    seed("threemf", "components", '<model unit="inch" xmlns:m="x"><resources><m:colorgroup id="5"><m:color color="#FF0000"/><m:color color="#00FF00"/></m:colorgroup>'
         f'<object id="1" name="tet" pid="5" pindex="1"><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object>'
         '<object id="2"><components><component objectid="1" transform="-1 0 0 0 1 0 0 0 1 2 0 0"/></components></object>'
         '</resources><build><item objectid="2"/><item objectid="1" transform="1 0 0 0 1 0 0 0 1 4 0 0"/></build></model>')
    production = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
    seed("threemf", "parts", "=====\n".join((
        f'<model requiredextensions="p" xmlns:p="{production}"><resources/><build><item objectid="7" p:path="/3D/Objects/Part.model"/></build></model>\n',
        f'<model><resources><object id="7" name="tet"><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object></resources></model>\n',
        '<Relationships><Relationship Target="/3D/3DModel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>\n',
        '<config><object id="7"><part subtype="negative_part"/></object></config>\n')))
    readers = DATA / "readers"
    for name in ("binary-stl-trailing-byte.stl", "stl-end-solid.stl"):
        seed("stl", name.removesuffix(".stl"), (readers / name).read_bytes())
    seed("off", "touching", "OFF4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")
    seed("msh", "partitioned", (readers / "gmsh-partitioned.msh").read_bytes())
    surface = (readers / "medit-surface.mesh").read_text()
    seed("mesh-surface", "medit", surface)
    seed("mesh-surface", "without-end", surface.split("End")[0])
    seed("mesh-surface", "nastran", "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nCTRIA3,1,1,1,2,3\n")
    arrays = lambda type, name, numbers, more="": f'<DataArray type="{type}" Name="{name}" {more} format="ascii">{numbers}</DataArray>'
    piece = lambda z: ('<Piece NumberOfPoints="3" NumberOfCells="1"><Points>'
                       + arrays("Float64", "Points", f"0 0 0 1 0 0 0 0 {z}", 'NumberOfComponents="3"') + "</Points><Cells>"
                       + arrays("Int32", "connectivity", "0 1 2") + arrays("Int32", "offsets", "3")
                       + arrays("UInt8", "types", "5") + "</Cells></Piece>")
    seed("mesh-surface", "pieces", '<VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid>' + piece(1)
         + piece(2) + "</UnstructuredGrid></VTKFile>\n")
    for name in ("stray-triangle", "t-junctions"):
        seed("surface", name, b"\x10" + (readers / f"{name}.off").read_bytes())
    seed("surface", "folded-sliver", b"\x01" + (readers / "folded-sliver.off").read_bytes())


meshes()
decks()
sizes()
examples()
stages()
tools()
surfaces()
solids()
others()
