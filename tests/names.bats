# Names of groups, from the files that have them to the last stage.

load helpers

names_of() {
  tar xOf "$1" names.json
}

@test "findhex takes the names of a .msh, in either version" {
  cat >named.msh <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
5
2 5 "inlet"
3 7 "steel"
3 8 "nowhere"
2 9 "surface 9"
1 1 "a curve"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
$EndNodes
$Elements
3
1 4 2 7 7 1 2 3 4
2 2 2 5 5 1 4 3
3 2 2 9 9 1 2 4
$EndElements
END
  findhex --mesh named.msh -o two.tar --format tar
  assert_equal "$(names_of two.tar)" '{"surfaces":{"5":"inlet"},"regions":{"7":"steel"}}'
  gmsh named.msh -save -format msh41 -o four.msh >/dev/null
  findhex --mesh four.msh -o four.tar --format tar
  assert_equal "$(names_of four.tar)" '{"surfaces":{"5":"inlet"},"regions":{"7":"steel"}}'
}

@test "tetmesh takes the names of STL solids and of OBJ groups, and of materials where there are no groups" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  cat >tet.obj <<'END'
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
usemtl red
f 1 3 2
g sides # all of them
f 1 2 4
usemtl blue
f 2 3 4
f 1 4 3
END
  tetmesh tet.obj --surface keep --points none -o tet.tar
  assert_equal "$(names_of tet.tar)" '{"surfaces":{"1":"sides"}}'
  grep -v '^g' tet.obj >materials.obj
  tetmesh materials.obj --surface keep --points none -o materials.tar
  assert_equal "$(names_of materials.tar)" '{"surfaces":{"1":"red","2":"blue"}}'
  $PYTHON - <<'PYTHON'
points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
with open("tet.stl", "wb") as file:
    for name, triangles in (("Einlaß 1".encode("latin-1"), [(0, 2, 1)]), ("sides".encode(), [(0, 1, 3), (1, 2, 3), (0, 3, 2)])):
        file.write(b"solid  " + name + b"\n")
        for t in triangles:
            file.write(b"facet normal 0 0 0\nouter loop\n" + b"".join(b"vertex %g %g %g\n" % points[i] for i in t) + b"endloop\nendfacet\n")
        file.write(b"endsolid\n")
PYTHON
  tetmesh tet.stl --surface keep --points none -o stl.tar
  assert_equal "$(names_of stl.tar)" '{"surfaces":{"1":"Einlaß 1","2":"sides"}}'
  # One solid: its name is that of the only tag.
  sed -e '0,/endsolid/!{/^solid/d}' -e '0,/endsolid/{/endsolid/d}' tet.stl >one.stl
  tetmesh one.stl --surface keep --points none -o one.tar
  assert_equal "$(names_of one.tar)" '{"surfaces":{"1":"Einlaß 1"}}'
}

@test "tetmesh takes surfaces in mesh formats, with tags and names" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  cat >cube.geo <<'END'
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Physical Surface("inlet", 7) = {1};
Physical Surface("walls", 8) = {2 : 6};
END
  gmsh -2 cube.geo -format msh41 -o cube.msh >/dev/null
  gmsh -2 cube.geo -format msh22 -o cube22.msh >/dev/null
  for file in cube.msh cube22.msh; do
    tetmesh $file --size 0.3 -o $file.tar
    assert_equal "$(names_of $file.tar)" '{"surfaces":{"7":"inlet","8":"walls"}}'
  done
  tetmesh "$DATA/cube.stl" --surface keep --points none -o tets.mesh
  $PYTHON - <<'PYTHON'
import meshio, numpy as np
points = np.array([(x, y, z) for z in (0., 1.) for y in (0., 1.) for x in (0., 1.)])
quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
meshio.write("quads.vtk", meshio.Mesh(points, [("quad", np.array(quads))]), binary=False)
meshio.write("quads.vtu", meshio.Mesh(points, [("quad", np.array(quads))]))
meshio.write("quads.mesh", meshio.Mesh(points, [("quad", np.array(quads))], cell_data={"medit:ref": [np.arange(1, 7)]}))
PYTHON
  for file in quads.vtk quads.vtu quads.mesh; do
    tetmesh $file --surface keep --points none --stats stats.json -o $file.tar
    assert_equal "$($PYTHON -c 'import json; s = json.load(open("stats.json")); print(s["surface_triangles"], s["volume"])')" "12 1.0"
  done
  assert_fails_with 1 "tets.mesh: expected a surface, found a mesh of [0-9]+ cells; findhex takes it where they are tets" tetmesh tets.mesh -o x.mesh
}

@test "tetmesh takes surfaces in .vtp, as VTK writes them in each encoding, without their lines and points" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  $PYTHON - <<'PYTHON'
import vtk
points = vtk.vtkPoints()
for z in (0, 1):
    for y in (0, 1):
        for x in (0, 1):
            points.InsertNextPoint(x, y, z)
surface = vtk.vtkPolyData()
surface.SetPoints(points)
def cells(lists):
    array = vtk.vtkCellArray()
    for corners in lists:
        array.InsertNextCell(len(corners))
        for corner in corners:
            array.InsertCellPoint(corner)
    return array
surface.SetVerts(cells([(0,), (7,)]))
surface.SetLines(cells([(0, 1, 2)]))
surface.SetPolys(cells([(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4), (2, 4, 6)]))
tags = vtk.vtkIntArray()
tags.SetName("tag")
for tag in (90, 91, 92, 1, 2, 3, 4, 5, 6, 6):
    tags.InsertNextValue(tag)
surface.GetCellData().AddArray(tags)
writer = vtk.vtkXMLPolyDataWriter()
writer.SetInputData(surface)
for mode in ("Ascii", "Binary", "Appended"):
    getattr(writer, f"SetDataModeTo{mode}")()
    writer.SetFileName(f"{mode}.vtp")
    writer.Write()
surface.SetPolys(cells([(0, 2, 3, 1, 5)]))
surface.GetCellData().Initialize()
writer.SetFileName("five.vtp")
writer.Write()
PYTHON
  for mode in Ascii Binary Appended; do
    tetmesh $mode.vtp --surface keep --points none --stats stats.json -o $mode.mesh
    assert_equal "$($PYTHON -c 'import json; s = json.load(open("stats.json")); print(s["surface_triangles"], s["volume"])')" "12 1.0"
    assert_equal "$(awk '/^Triangles/ {on = 1; getline; next} on && NF == 4 {print $4}' $mode.mesh | sort -n | uniq -c | tr -s ' \n' ' ')" " 2 1 2 2 2 3 2 4 2 5 2 6 "
  done
  assert_fails_with 1 "five.vtp: triangle 1: expected a closed surface, found 5 edges of a single triangle" tetmesh five.vtp -o x.mesh
}

@test "tetmesh --tags-by-angle makes groups, and --name names them" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  tetmesh "$DATA/cube.stl" --size 0.4 --tags-by-angle --name 3=inlet --name 'region 1=steel' -o cube.tar
  assert_equal "$(names_of cube.tar)" '{"surfaces":{"3":"inlet"},"regions":{"1":"steel"}}'
  tetmesh "$DATA/cube.stl" --size 0.4 --tags-by-angle -o cube.mesh
  tetmesh "$DATA/cube.stl" --size 0.4 --tags-by-angle 100 -o whole.mesh
  tags() { $PYTHON -c 'import meshio, sys; m = meshio.read(sys.argv[1]); print(sorted({int(t) for c, d in zip(m.cells, m.cell_data["medit:ref"]) if c.type == "triangle" for t in d}))' "$1"; }
  run tags cube.mesh
  assert_line "[1, 2, 3, 4, 5, 6]"
  run tags whole.mesh
  assert_line "[1]"
  assert_fails_with 1 "cube.stl: expected --name of a surface tag \(1\), found 3" tetmesh "$DATA/cube.stl" --name 3=inlet -o x.mesh
  assert_fails_with 1 "cube.stl: expected --name of a region from 1 to 1, found 2" tetmesh "$DATA/cube.stl" --name 'region 2=air' -o x.mesh
  assert_fails_with 2 "expected --name TAG=NAME or 'region TAG=NAME', found 'inlet'" tetmesh "$DATA/cube.stl" --name inlet -o x.mesh
}

# bats test_tags=optimized
@test "tetmesh --size NAME=LENGTH is the size at a surface" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  points() { tetmesh "$DATA/cube.stl" --tags-by-angle --name 3=inlet "$@" --stats stats.json -o cube.mesh && $PYTHON -c 'import json; print(json.load(open("stats.json"))["points"])'; }
  local plain
  plain=$(points --size 0.25)
  assert [ "$(points --size 0.25 --size inlet=0.08)" -gt $((2 * plain)) ]
  assert_equal "$(points --size 0.25 --size 3=0.08)" "$(points --size surface_3=0.08 --size 0.25)"
  assert [ "$(points --size 0.25 --size inlet=0.08 --grading 1)" -lt "$(points --size 0.25 --size inlet=0.08 --grading 0.1)" ]
  # Fine where it is asked for, and not on the other side.
  points --size 0.25 --size inlet=0.08
  run $PYTHON - <<'PYTHON'
import meshio
mesh = meshio.read("cube.mesh")
counts = {}
for block, tags in zip(mesh.cells, mesh.cell_data["medit:ref"]):
    if block.type == "triangle":
        for tag in tags:
            counts[int(tag)] = counts.get(int(tag), 0) + 1
print(max(counts, key=counts.get))
PYTHON
  assert_line 3
  assert_fails_with 1 "cube.stl: expected --size of a surface by its name or number, found 'outlet'; there are 1 \(cube\)$" tetmesh "$DATA/cube.stl" --size outlet=1 -o x.mesh
  assert_fails_with 2 "expected one --size for the whole model, found a second one: '2'" tetmesh "$DATA/cube.stl" --size 1 --size 2 -o x.mesh
  assert_fails_with 2 "expected a positive length such as" tetmesh "$DATA/cube.stl" --size 1=x -o x.mesh
}

# bats test_tags=optimized
@test "tetmesh --size 'body NAME=LENGTH' is the size in a body, smaller or larger than elsewhere" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  local bodies="$DATA/touching/face-touch-two-bodies.off"
  # tets_in ARGUMENTS...: of both bodies.
  tets_in() { tetmesh -q "$bodies" --name 'region 2=bolt' --grading 1 "$@" -o bodies.mesh && $PYTHON -c '
import meshio
mesh = meshio.read("bodies.mesh")
tags = [int(tag) for block, tags in zip(mesh.cells, mesh.cell_data["medit:ref"]) if block.type == "tetra" for tag in tags]
print(tags.count(1), tags.count(2))' | tail -1; }
  local plain coarse fine
  read -r plain _ < <(tets_in --size 0.4 --size 'body 1=0.4')
  read -r coarse fine < <(tets_in --size 0.4 --size 'body bolt=0.1')
  assert [ "$fine" -gt $((4 * coarse)) ]
  assert [ "$coarse" -gt "$plain" ]  # at the interface
  # The size of all the others is the smaller one.
  assert_equal "$(tets_in --size 0.1 --size 'body 1=0.4')" "$coarse $fine"
  assert_equal "$(tets_in --size 'body region_1=0.4' --size 'body 2=0.1')" "$coarse $fine"
  assert_fails_with 1 "expected --size of a body by its name or number, found 'nut'; there are 1, 2 \(bolt\)$" \
    tetmesh "$bodies" --name 'region 2=bolt' --size 'body nut=1' -o x.mesh
}

@test "tetmesh --size 'box X,Y,Z,X,Y,Z=LENGTH' is the size in a box" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  # Lengths are those of the scaled model.
  tetmesh "$DATA/cube.stl" --scale 10 --size 3 --size 'box 0,0,0, 4,4,4=0.8' --grading 1 -o box.mesh
  run $PYTHON - <<'PYTHON'
import meshio, numpy as np
points = meshio.read("box.mesh").points
inside = (points < 4.4).all(axis=1)
print(inside.sum() > 100, 20 < (~inside).sum() < inside.sum())
PYTHON
  assert_line "True True"
  assert_fails_with 1 "cube.stl: expected --size in a box that meets the model, from 0,0,0 to 1,1,1, found 'box 2,0,0,3,1,1'" \
    tetmesh "$DATA/cube.stl" --size 'box 2,0,0,3,1,1=0.1' -o x.mesh
  local box
  for box in '0,0,0,0,1,1' '1,0,0,0,1,1' '0,0,0,1,1' '0,0,0,1,1,1,1' '0,0,0,1,1,x' '' '0,0,0,1,1,nan'; do
    assert_fails_with 2 "expected a box by its lowest and its highest corner, .* found 'box $box=0.1'" tetmesh "$DATA/cube.stl" --size "box $box=0.1" -o x.mesh
  done
  assert_fails_with 2 "expected a positive length such as .* found '0'" tetmesh "$DATA/cube.stl" --size 'box 0,0,0,1,1,1=0' -o x.mesh
  assert_fails_with 2 "expected a positive length such as .* found '-1'" tetmesh "$DATA/cube.stl" --size 'body 1=-1' -o x.mesh
}

@test "names pass through all stages, shares and parts" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  tetmesh "$DATA/cube.stl" --size 0.25 --name 1=skin -o mesh.tar
  findhex mesh.tar -o candidates.tar
  buildgraph candidates.tar -o graph.tar
  initsol graph.tar --iterations 0 | lns --iterations 10 | assemble -o result.tar
  for stage in candidates graph result; do assert_equal "$(names_of $stage.tar)" '{"surfaces":{"1":"skin"}}'; done
  for i in 1 2; do findhex mesh.tar --part $i/2 -o share$i.tar; done
  merge-parts share1.tar share2.tar -o merged.tar
  assert_same_bytes merged.tar candidates.tar
  if [[ ! -x "$HEXPIPE_BIN/mesh-part" ]]; then return; fi
  mesh-part mesh.tar --parts 2 -o parts
  for i in 0 1; do findhex parts/part-000$i.tar -o candidates$i.tar; done
  for i in 0 1; do buildgraph candidates$i.tar --neighbours candidates?.tar -o graph$i.tar; done
  merge-parts graph0.tar graph1.tar -o merged.tar
  assert_same_bytes merged.tar graph.tar
}

@test "names of another mesh do not pass beside the one that replaces it" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  tetmesh "$DATA/cube.stl" --size 0.5 --name 1=skin -o mesh.tar
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 >lattice.mesh
  findhex mesh.tar --mesh lattice.mesh -o other.tar
  run tar tf other.tar
  refute_line names.json
}

@test "what is no names.json is an error that names it" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  tetmesh "$DATA/cube.stl" --size 0.5 -o mesh.tar
  tar --delete -f mesh.tar names.json
  broken() {
    printf '%s' "$1" >names.json
    cp mesh.tar broken.tar
    tar rf broken.tar names.json
    assert_fails_with 1 "broken.tar: names.json: $2" findhex broken.tar
  }
  broken '{' "expected a JSON object with the names of surfaces, regions and curves, found no JSON"
  broken '[]' "expected a JSON object with the names of surfaces, regions and curves, found something else"
  broken '{"surfaces":[]}' "expected \"surfaces\" as an object"
  broken '{"regions":{"x":"steel"}}' "expected the number of a tag, found 'x'"
  broken '{"regions":{"1":2}}' "expected a name for tag '1' of \"regions\", found something else"
  broken '{"regions":{"1":""}}' "expected a name for tag '1' of \"regions\", found an empty one"
}

# bundle NAME ARRAYS: surface/ members of a tet, with what the Python expression changes.
bundle() {
  $PYTHON - "$1" "$2" <<'PYTHON'
import io, sys, tarfile
import numpy as np
arrays = {"points": np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], "<f8"),
          "triangles": np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)], "<i4")}
arrays.update(eval(sys.argv[2]))
with tarfile.open(sys.argv[1], "w", format=tarfile.PAX_FORMAT) as out:
    for name, array in arrays.items():
        data = io.BytesIO()
        np.save(data, np.array(array))
        member = tarfile.TarInfo(f"surface/{name}.npy")
        member.size = len(data.getvalue())
        out.addfile(member, io.BytesIO(data.getvalue()))
PYTHON
}

@test "tetmesh checks what a surface bundle says" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  i4() { echo "{'$1': np.array($2, '<i4')}"; }
  bundle good.tar "{'sides': np.array([(3, 0)] * 4, '<i4'), 'triangle_tags': np.array([5] * 4, '<i4')}"
  tetmesh --surface keep --points none <good.tar >mesh.tar
  run $PYTHON -c 'import io, numpy, tarfile; t = tarfile.open("mesh.tar"); print(*[set(numpy.load(io.BytesIO(t.extractfile(f"mesh/{name}_tags.npy").read())).tolist()) for name in ("tet", "triangle")])'
  assert_output "{3} {5}"
  assert_fails_with 1 "good.tar: expected a surface file for --scale, found a bundle; tessellate --unit scales CAD" tetmesh good.tar --scale 2 -o x.mesh
  fails() {
    bundle bad.tar "$1"
    assert_fails_with 1 "bad.tar: $2" tetmesh bad.tar -o x.mesh
  }
  fails "$(i4 triangle_tags '[1]')" "surface/triangle_tags.npy: expected a row for each of the 4 triangles, found 1"
  fails "$(i4 sides '[(1, 0)]')" "surface/sides.npy: expected a row for each of the 4 triangles, found 1"
  fails "$(i4 sides '[(0, 0)] * 4')" "surface/sides.npy: row 0: expected a region on a side, found none"
  fails "$(i4 sides '[(1, 1)] * 4')" "expected a surface that encloses something, found only sheets that do not"
  fails "$(i4 sides '[(-1, 0)] * 4')" "surface/sides.npy: row 0: expected regions from 0 to 4, found -1, 0"
  fails "$(i4 triangles '[(0, 1, 9)]')" "surface/triangles.npy: row 0: expected points from 0 to 3, found 9"
  fails "{'curves': np.array([(0, 0)], '<i4')}" "surface/curves.npy: row 0: expected an edge of a triangle, found 0, 0"
  fails "{'points': np.array([(0, 0, np.nan)] * 4)}" "surface/points.npy: row 0: expected coordinates up to"
  echo >other.txt
  tar cf none.tar other.txt
  assert_fails_with 1 "none.tar: expected a bundle with a surface, found none in it" tetmesh none.tar -o x.mesh
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 >lattice.mesh
  findhex --mesh lattice.mesh -o lattice.tar
  assert_fails_with 1 "lattice.tar: expected a bundle with a surface, found one with a mesh; findhex takes it" tetmesh lattice.tar -o x.mesh
}

@test "a curve in a surface bundle gets points, however flat the surface is there" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  bundle plain.tar "{'points': np.array([(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4), (1, 0.5, 0)], '<f8'), 'triangles': np.array([(0, 2, 4), (2, 1, 4), (1, 0, 4), (0, 1, 3), (1, 2, 3), (0, 3, 2)], '<i4')}"
  bundle curve.tar "{'points': np.array([(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4), (1, 0.5, 0)], '<f8'), 'triangles': np.array([(0, 2, 4), (2, 1, 4), (1, 0, 4), (0, 1, 3), (1, 2, 3), (0, 3, 2)], '<i4'), 'curves': np.array([(0, 4)], '<i4')}"
  on_line() {
    tetmesh "$1" --size 0.5 | $PYTHON -c 'import io, numpy, sys, tarfile
points = numpy.load(io.BytesIO(tarfile.open(fileobj=io.BytesIO(sys.stdin.buffer.read())).extractfile("mesh/points.npy").read()))
print(sum(abs(p[0] - 2 * p[1]) < 1e-9 and p[0] <= 1 and p[2] == 0 for p in points))'
  }
  assert_equal "$(on_line curve.tar)" 3
  assert [ "$(on_line plain.tar)" -lt 3 ]
}

@test "the surface bundle of formats/README.md is one, and its names are" {
  $PYTHON - "$HEXPIPE_SOURCE/formats/README.md" <<'PYTHON'
import re, sys
text = open(sys.argv[1]).read()
open("surface.py", "w").write(re.search(r"```python surface\n(.*?)```", text, re.S)[1])
open("names.json", "w").write(re.search(r"```json names.json\n(.*?)```", text, re.S)[1])
PYTHON
  $PYTHON surface.py >surface.tar
  run tar tf surface.tar
  assert_output "$(printf 'surface/%s.npy\n' points triangles triangle_tags sides curves curve_tags)
names.json"
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then return; fi
  tetmesh --surface keep --points none <surface.tar >mesh.tar
  assert_equal "$(names_of mesh.tar)" '{"surfaces":{"5":"bottom"},"regions":{"1":"steel"}}'
  mkdir mesh && tar xf mesh.tar -C mesh && cp names.json mesh
  (cd mesh && tar cf ../renamed.tar names.json mesh/*.npy)
  findhex renamed.tar -o candidates.tar
  assert_equal "$(names_of candidates.tar)" "$(cat names.json)"
  tar rf mesh.tar names.json
  assert_fails_with 1 "mesh.tar: names.json: expected names once, found them again" findhex mesh.tar
}

@test "a fold of a body onto itself, as CAD has some, goes" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  bundle fold.tar "{'points': np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (2, 2, 2)], '<f8'), 'triangles': np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2), (1, 2, 4), (2, 1, 4)], '<i4'), 'sides': np.array([(1, 0)] * 6, '<i4')}"
  run_apart tetmesh fold.tar --surface keep --points none -o fold.mesh
  assert_success
  assert_equal "$stderr" "tetmesh: warning: fold.tar: a triangle with the same on both sides is left out"
  assert_equal "$(sed -n '/^Triangles/{n;p}' fold.mesh)" 4
}
