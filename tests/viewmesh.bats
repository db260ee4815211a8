# viewmesh: a page and a picture of any stage.

load helpers

# Mesa keeps what it allocates for a context: not ours to free.
export LSAN_OPTIONS="suppressions=$HEXPIPE_SOURCE/tests/leaks_of_mesa.txt:print_suppressions=0"

setup_file() {
  load helpers
  cd "$BATS_FILE_TMPDIR"
  cp "$DATA/random_points.mesh" mesh.mesh
  findhex --mesh mesh.mesh | buildgraph >graph.tar
  initsol --iterations 1000 <graph.tar >solution.tar
  assemble <solution.tar >result.tar
  assemble <solution.tar --stats result.json --format vtu >result.vtu
}

setup() {
  cd "$BATS_TEST_TMPDIR" || return 1
  ln -s "$BATS_FILE_TMPDIR"/*.{mesh,tar,vtu,json} .
}

# scene PAGE KEY: a value of the data in a page, as JSON.
scene() {
  "$PYTHON" - "$1" "$2" <<'PYTHON'
import json, re, sys
text = open(sys.argv[1]).read()
print(json.dumps(json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text)[1])[sys.argv[2]]))
PYTHON
}

# size PICTURE: width and height from its header.
size() {
  "$PYTHON" -c "import struct, sys; print(*struct.unpack('>II', open(sys.argv[1], 'rb').read()[16:24]))" "$1"
}

@test "a page of each stage tells what it shows" {
  viewmesh mesh.mesh -o mesh.html
  viewmesh graph.tar -o candidates.html
  viewmesh solution.tar -o solution.html
  viewmesh <result.tar >result.html
  assert_equal "$(scene mesh.html content)" '"result"'
  assert_equal "$(scene candidates.html content)" '"candidates"'
  assert_equal "$(scene solution.html content)" '"solution"'
  assert_equal "$(scene result.html content)" '"result"'
  assert_equal "$(scene mesh.html kindBegin)" "[0, 0, 0, 0, 298]"
  run scene result.html history
  assert_output --regexp 'findhex.*buildgraph.*initsol.*"seed".*"weight".*assemble'
}

@test "the same cells from the file and from the bundle" {
  viewmesh result.vtu -o file.html
  viewmesh result.tar -o bundle.html
  for key in points corners quality kindBegin layer; do
    assert_equal "$(scene file.html $key)" "$(scene bundle.html $key)"
  done
}

@test "the numbers of the page are those of the mesh, read by another program" {
  viewmesh result.vtu -o page.html
  run "$PYTHON" - <<'PYTHON'
import base64, json, re, zlib
import meshio, numpy as np
data = json.loads(re.search(r'id="data">(.*?)</script>', open("page.html").read())[1])
def words(text):
    raw = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8)
    return np.ascontiguousarray(raw.reshape(4, -1).T).view("<u4").ravel()
def integers(text, stride):
    coded = words(text).astype(np.int64)
    return np.cumsum(((coded >> 1) ^ -(coded & 1)).reshape(-1, stride), axis=0)
mesh = meshio.read("result.vtu")
points = words(data["points"]).view("<f4").reshape(3, -1).T * data["unit"] + data["centre"]
assert np.allclose(points, mesh.points, atol=1e-6)
names = {"hex": "hexahedron", "prism": "wedge", "pyramid": "pyramid", "tet": "tetra"}
for kind, packed in zip(data["kinds"], data["corners"]):
    theirs = mesh.cells_dict.get(names[kind["name"]], np.empty((0, kind["corners"])))
    assert np.array_equal(integers(packed, kind["corners"]), theirs), kind
quality = np.concatenate([q for block, q in zip(mesh.cells, mesh.cell_data["quality"]) if block.type in names.values()])
assert np.allclose(words(data["quality"]).view("<f4"), quality)
measures = {name: integers(text, 1).ravel() for name, text in data["measures"].items()}
assert list(measures) == ["orthogonality", "weight", "determinant", "flatness"]
ours = json.load(open("result.json"))["finite_volumes"]
for name, limit, unit, sign in (("orthogonality", 70, 100, -1), ("weight", .05, 1e4, 1), ("determinant", .001, 1e4, 1), ("flatness", .8, 1e4, 1)):
    values = sign * measures[name]
    assert len(values) == len(quality) and np.sum(values < sign * limit * unit) == ours[name]["cells"], name
    assert 0 <= sign * ours[name]["worst"] * unit - values.min() < 1, (name, ours[name], values.min())
assert len(words(data["layer"])) == data["kindBegin"][4] == len(quality)
PYTHON
  assert_success
}

@test "--show goes back to an earlier stage, and says what is missing" {
  viewmesh result.tar --show candidates -o page.html
  assert_equal "$(scene page.html content)" '"candidates"'
  viewmesh result.tar --show mesh -o page.html
  assert_equal "$(scene page.html kindBegin)" "[0, 0, 0, 0, 298]"
  assert_fails_with 1 "graph.tar: expected a solution to show the solution, found none" viewmesh graph.tar --show solution -o no.html
  assert_fails_with 1 "result.vtu: expected the tet mesh to show the mesh" viewmesh result.vtu --show mesh -o no.html
  assert_fails_with 2 "show" viewmesh result.vtu --show nothing -o no.html
  assert [ ! -e no.html ]
}

@test "the page needs nothing from elsewhere" {
  viewmesh result.vtu -o page.html
  run grep -oE '(src|href)="[^"]*"|@import|url\(' page.html
  assert_output ""
}

@test "the page has the notices that the licences of its script ask for" {
  viewmesh result.vtu -o page.html
  for word in "2026 The hexpipe developers" "three.js authors" "MIT License" "Permission is hereby granted"; do
    grep -q "$word" page.html
  done
}

@test "a page under the name of a picture, and a picture under that of a page, are refused" {
  assert_fails_with 2 "^viewmesh: -o writes a page: .*'x.png' \(a picture: --png x.png\)" viewmesh result.vtu -o x.png
  assert_fails_with 2 "^viewmesh: --png writes a picture: .*'x.html' \(a page: -o x.html\)" viewmesh result.vtu --png x.html
  assert [ ! -e x.png ]
  assert [ ! -e x.html ]
}

@test "--title is the page's, and is not markup" {
  viewmesh result.vtu --title 'A <b> & "c"' -o page.html
  grep -q '<title>A &lt;b> &amp; "c"</title>' page.html
  assert_equal "$(scene page.html title)" '"A <b> & \"c\""'
}

@test "the same bytes twice, by pipe, with any number of threads" {
  viewmesh result.tar --title result -o one.html --png one.png
  viewmesh --title result --threads 1 <result.tar >two.html
  cat result.tar | viewmesh --title result --png two.png
  assert_same_bytes one.html two.html
  assert_same_bytes one.png two.png
}

# bats test_tags=optimized
@test "every part of --view changes the picture, and the page opens with it" {
  viewmesh result.vtu --size 400,250 --png plain.png
  for part in up=y up=-x axes=off legend=off clip=x:0.5 clip=-x:0.5 clip=1,1,0:0.5 quality=0,0.15 peel=1 kinds=hex,tet colour=quality colour=kind \
    colour=region colour=surface colour=orthogonality colour=weight colour=determinant colour=flatness edges=off theme=dark camera=10,20 camera=10,20,1,0,0,0 camera=-52,28,2,0,0,0 camera=-52,28,1,0.3,0,0; do
    viewmesh result.vtu --size 400,250 --view "$part" --png part.png -o part.html
    assert_different_bytes plain.png part.png
    run scene part.html state
    assert_output --partial "$part"
  done
  # --view takes the words of a page.
  state=$(scene part.html state)
  viewmesh result.vtu --size 400,250 --view "${state//\"/}" --png again.png
  assert_same_bytes part.png again.png
}

# add_member NAME ARRAY: more.tar is result.tar with one member more, an array in NumPy's words.
add_member() {
  "$PYTHON" - "$1" "$2" <<'PYTHON'
import io, sys, tarfile
import numpy as np
with tarfile.open("result.tar") as old, tarfile.open("more.tar", "w", format=tarfile.PAX_FORMAT) as new:
    for member in old:
        new.addfile(member, old.extractfile(member))
    data = io.BytesIO()
    np.save(data, eval(sys.argv[2]))
    member = tarfile.TarInfo(sys.argv[1])
    member.size = data.tell()
    data.seek(0)
    new.addfile(member, data)
PYTHON
}

# bats test_tags=optimized
@test "dislocations of a bundle are in the page, and in pictures where asked for" {
  add_member mesh/dislocations.npy "np.array([[0, 0, 0, .5, .5, .5], [.5, .5, .5, 1, 1, 0]])"
  viewmesh more.tar -o page.html --size 400,250 --png without.png
  assert_equal "$(scene page.html dislocations | "$PYTHON" -c 'import json, sys; print(sorted(json.load(sys.stdin)))')" "['lengths', 'points', 'sizes']"
  viewmesh more.tar --size 400,250 --png with.png --view dislocations=on
  assert_different_bytes without.png with.png
  # They come with the mesh alone, too.
  viewmesh --mesh more.tar --size 400,250 --png mesh.png --view dislocations=on -o mesh.html
  lengths() { scene "$1" dislocations | "$PYTHON" -c 'import json, sys; print(json.load(sys.stdin)["lengths"])'; }
  assert_equal "$(lengths mesh.html)" "$(lengths page.html)"
  add_member mesh/dislocations.npy "np.array([[0, 0, 0, .5, .5, np.nan]])"
  assert_fails_with 1 "^viewmesh: more.tar: mesh/dislocations.npy: expected finite coordinates, found nan" viewmesh more.tar -o no.html
  add_member mesh/dislocations.npy "np.zeros((2, 3))"
  assert_fails_with 1 "^viewmesh: more.tar: mesh/dislocations.npy" viewmesh more.tar -o no.html
  assert [ ! -e no.html ]
}

# bats test_tags=optimized
@test "the title is the file's name where none is given" {
  viewmesh result.vtu -o page.html
  assert_equal "$(scene page.html title)" '"result.vtu"'
  viewmesh --mesh mesh.mesh -o page.html
  assert_equal "$(scene page.html title)" '"mesh.mesh"'
  viewmesh <result.tar -o page.html
  assert_equal "$(scene page.html title)" '"hexpipe result"'
  # It stands in the legend, too.
  viewmesh result.vtu --size 400,250 --png one.png
  viewmesh result.vtu --size 400,250 --title other --png two.png
  assert_different_bytes one.png two.png
}

@test "surfaces and regions have their names, and go and come by them" {
  viewmesh "$DATA/two_hexes.msh" -o page.html --png whole.png --size 320,200 --view 'colour=surface&camera=-130,20,1,0,0,0'
  run scene page.html groups
  assert_output '{"region": [{"tag": 1, "name": "steel"}, {"tag": 2, "name": "air"}], "surface": [{"tag": 3, "name": "inlet"}, {"tag": 4, "name": "outer wall"}, {"tag": 5, "name": "surface_5"}]}'
  assert_equal "$(scene page.html volume)" "[2.0, 0.0, 0.0, 0.0]"
  for hidden in region:air surface:inlet 'surface:outer wall' 'region:2,surface:5'; do
    viewmesh "$DATA/two_hexes.msh" --png part.png --size 320,200 --view "hidden=$hidden&color=surface&camera=-130,20,1,0,0,0"
    assert_different_bytes whole.png part.png
  done
  # A name and its number are the same group; a page has the number.
  viewmesh "$DATA/two_hexes.msh" --size 320,200 --png name.png --view 'hidden=region:steel,surface:inlet' -o page.html
  viewmesh "$DATA/two_hexes.msh" --size 320,200 --png number.png --view 'hidden=region:1,surface:3'
  assert_same_bytes name.png number.png
  run scene page.html state
  assert_output --partial "hidden=region:1,surface:3&"
  assert_fails_with 2 "--view: hidden: expected a region of steel, air, found 'water'" \
    viewmesh "$DATA/two_hexes.msh" -o no.html --view hidden=region:water
  assert_fails_with 2 "--view: hidden: expected a surface of inlet, outer wall, surface_5, found '7'" \
    viewmesh "$DATA/two_hexes.msh" -o no.html --view hidden=surface:7
  assert [ ! -e no.html ]
}

@test "a quad of a candidate has the surface of its two triangles" {
  "$PYTHON" "$DATA/bar.py" --regions --kuhn --length 3 | findhex -o lattice.tar
  viewmesh lattice.tar --show candidates --view colour=surface -o page.html
  run "$PYTHON" - <<'PYTHON'
import base64, json, re, zlib
import numpy as np
data = json.loads(re.search(r'id="data">(.*?)</script>', open("page.html").read())[1])
raw = np.frombuffer(zlib.decompress(base64.b64decode(data["surfaceFacets"]["facets"])), np.uint8)
coded = np.ascontiguousarray(raw.reshape(4, -1).T).view("<u4").ravel().astype(np.int64)
facets = np.cumsum((coded >> 1) ^ -(coded & 1))
# The bar of 3 x 3 x 3 cubes has 9 quads on each end and 9 on either side of the interface.
assert len(facets) >= 36 and data["groups"]["surface"], facets
PYTHON
  assert_success
}

# bats test_tags=optimized
@test "wrong words in --view end with 2" {
  while read -r state; do
    assert_fails_with 2 "--view: " viewmesh result.vtu --view "$state" -o no.html
  done <"$DATA/wrong_views.txt"
  assert_fails_with 2 "--view: kinds: expected none or some of hex, prism, pyramid, tet, found ''" \
    viewmesh result.vtu --view kinds= -o no.html
  assert_fails_with 2 "--view: colour: expected one of the first five for candidates, because its cells are no mesh, found 'weight'" \
    viewmesh solution.tar --show candidates --view colour=weight -o no.html
  assert [ ! -e no.html ]
}

@test "--size is the picture's size, and the picture shows the mesh on the background" {
  viewmesh result.vtu --size 300,200 --view colour=region --png picture.png
  assert_equal "$(size picture.png)" "300 200"
  viewmesh --size 320,240 result.vtu --png before.png  # the file may follow
  assert_equal "$(size before.png)" "320 240"
  assert [ ! -e result.html ]
  run "$PYTHON" - <<'PYTHON'
import numpy as np
from vtk import vtkPNGReader
from vtk.util.numpy_support import vtk_to_numpy
reader = vtkPNGReader()
reader.SetFileName("picture.png")
reader.Update()
image = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(200, 300, 3).astype(int)
corners = image[[0, 0, -1, -1], [0, -1, 0, -1]]
assert (corners > 200).all(), corners
# The first region's blue in the middle, with dark edges.
middle = image[60:140, 100:200].reshape(-1, 3)
assert np.mean(middle[:, 0] < middle[:, 2]) > 0.3, middle.mean(axis=0)
assert len(np.unique(middle, axis=0)) > 100
PYTHON
  assert_success
  assert_fails_with 2 "size" viewmesh result.vtu --size 0,100 --png no.png
}

@test "a solution beyond the candidates is told as assemble tells it" {
  count=$("$PYTHON" -c 'import io, tarfile, numpy; t = tarfile.open("graph.tar")
print(len(numpy.load(io.BytesIO(t.extractfile("candidates/kind.npy").read()))))')
  "$PYTHON" "$DATA/change_array.py" solution.tar beyond.tar solution/chosen.npy "np.array([0, $count], '<i4')"
  "$PYTHON" - <<'PYTHON'
import tarfile
with tarfile.open("beyond.tar") as old, tarfile.open("graphless.tar", "w", format=tarfile.PAX_FORMAT) as new:
    for member in old:
        if not member.name.startswith("graph/"):
            new.addfile(member, old.extractfile(member))
PYTHON
  local message="graphless.tar: .*expected candidates from 1 to $count, found $((count + 1))$"
  assert_fails_with 1 "^viewmesh: $message" viewmesh graphless.tar -o no.html
  assert_fails_with 1 "^assemble: $message" assemble graphless.tar -o no.vtu
}

@test "of the graph in a bundle no more is read than how many candidates it has" {
  "$PYTHON" "$DATA/change_array.py" solution.tar edgeless.tar graph/neighbours.npy "a[:0]"
  viewmesh solution.tar --title choice -o whole.html
  viewmesh edgeless.tar --title choice -o edgeless.html
  assert_same_bytes whole.html edgeless.html
  count=$("$PYTHON" -c 'import io, tarfile, numpy; t = tarfile.open("solution.tar")
print(len(numpy.load(io.BytesIO(t.extractfile("graph/weights.npy").read()))))')
  "$PYTHON" "$DATA/change_array.py" edgeless.tar beyond.tar solution/chosen.npy "np.array([0, $count], '<i4')"
  assert_fails_with 1 "^viewmesh: beyond.tar: " viewmesh beyond.tar -o no.html
}

@test "nothing to show is one clear line" {
  cat >empty.mesh <<<$'MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 0\nEnd'
  assert_fails_with 1 "^viewmesh: empty.mesh: expected cells in the result, found none" viewmesh empty.mesh -o no.html
  sed '/^Vertices/{n;n;s/^[^ ]*/nan/}' mesh.mesh >nan.mesh
  assert_fails_with 1 "^viewmesh: nan.mesh:[0-9]+: " viewmesh nan.mesh -o no.html
  sed 's/Tetrahedra/Dodecahedra/' mesh.mesh >unknown.mesh
  assert_fails_with 1 "^viewmesh: unknown.mesh" viewmesh unknown.mesh -o no.html
  "$PYTHON" - <<'PYTHON'
import io, tarfile
with tarfile.open("graph.tar") as old, tarfile.open("meshless.tar", "w", format=tarfile.PAX_FORMAT) as new, \
     tarfile.open("history.tar", "w", format=tarfile.PAX_FORMAT) as history:
    for member in old:
        if not member.name.startswith("mesh/"):
            new.addfile(member, old.extractfile(member))
        if member.name.startswith("history/"):
            history.addfile(member, old.extractfile(member))
PYTHON
  assert_fails_with 1 "^viewmesh: meshless.tar: expected the tet mesh to show the candidates, found none" viewmesh meshless.tar -o no.html
  assert_fails_with 1 "^viewmesh: history.tar: expected a mesh to show, found none" viewmesh history.tar -o no.html
  assert_fails_with 1 "^viewmesh: missing.vtu: .*No such file" viewmesh missing.vtu -o no.html
  assert_fails_with 1 "^viewmesh: stdin: " shell "head -c 5000 result.tar | viewmesh -o no.html"
  assert [ ! -e no.html ]
}

@test "outputs that cannot be written, and terminals" {
  assert_fails_with 1 "^viewmesh: /dev/full: cannot write" viewmesh result.vtu -o /dev/full
  assert_fails_with 1 "^viewmesh: /dev/full: cannot write" viewmesh result.vtu --size 320,200 --png /dev/full
  assert_fails_with 1 "^viewmesh: nowhere/x.png: cannot write" viewmesh result.vtu --png nowhere/x.png
  run script -qec "viewmesh result.vtu 2>message" /dev/null </dev/null
  assert_equal "$status" 2
  grep -q "standard output is a terminal" message
}

# bats test_tags=optimized
@test "at a terminal a line tells how far it is; -q shows none" {
  "$PYTHON" "$DATA/bar.py" --kuhn --length 4000 >long.tar
  TERM=xterm script -qec "viewmesh long.tar --png long.png -o long.html" /dev/null </dev/null | tr '\r' '\n' | sed 's/\x1b\[K//g' >shown
  grep -Eq '^viewmesh: [0-9]+ %, .*(reading|measuring cells|drawing|drawing the picture|writing the page)$' shown
  TERM=xterm run script -qec "viewmesh long.tar -q -o long.html" /dev/null </dev/null
  assert_output ""
}

@test "--help, --version, --stats" {
  run_apart viewmesh --help
  assert_output --regexp "Example:.*viewmesh "
  assert [ "$(wc -L <<<"$output")" -le 100 ]
  run viewmesh --version
  assert_line --regexp "^viewmesh \(hexpipe\) [0-9.]+$"
  viewmesh result.vtu -o page.html --stats stats.json
  run "$PYTHON" -c "import json; s = json.load(open('stats.json')); assert s['hex'] > 0 and s['tool'] == 'viewmesh', s"
  assert_success
}

# bats test_tags=optimized
@test "the page works in a browser, as a file" {
  if ! command -v tetmesh; then skip "tetmesh makes the part"; fi
  tetmesh "$DATA/bracket.stl" --size 5 --tags-by-angle 40 | findhex | buildgraph | initsol --iterations 20000 |
    certify --iterations 20 -o chosen.tar
  assemble chosen.tar | viewmesh -o bracket.html
  viewmesh chosen.tar --show candidates -o candidates.html
  viewmesh chosen.tar -o chosen.html
  findhex chosen.tar -o bracket.cand
  run timeout 600 "$PYTHON" "$HEXPIPE_SOURCE/tests/browser/page_test.py" bracket.html screenshots bracket.cand \
    candidates.html chosen.html
  assert_success
  assert_output "the page works"
  assert [ "$(ls screenshots | wc -l)" -ge 15 ]
}

# bats test_tags=optimized
@test "the page finds poor cells and dislocations, measures, and lets the part fit" {
  if ! command -v tetmesh; then skip "tetmesh makes the part"; fi
  tetmesh "$DATA/bracket.stl" --size 7 | findhex | buildgraph | initsol --iterations 20000 | assemble -o bracket.msh
  tetmesh "$DATA/plate-holes.stl" --size 11 --points frame | findhex | buildgraph | initsol --iterations 20000 | assemble -o plate.tar
  viewmesh bracket.msh -o bracket.html
  viewmesh plate.tar -o plate.html
  run timeout 600 "$PYTHON" "$HEXPIPE_SOURCE/tests/browser/finding_test.py" bracket.html plate.html screenshots
  assert_success
  assert_output "the page finds, measures and fits"
}

@test "--fragments shows parts of the graph one by one" {
  printf '1 2 3\n4 5\n' >parts
  viewmesh graph.tar --fragments parts --size 320,200 --png all.png -o page.html
  for fragment in 1 2; do viewmesh graph.tar --fragments parts --size 320,200 --view "fragment=$fragment" --png $fragment.png; done
  assert_different_bytes all.png 1.png
  assert_different_bytes 1.png 2.png
  assert_fails_with 2 "--fragments: expected candidates or a solution" viewmesh result.vtu --fragments parts -o no.html
  echo "1 x" >>parts
  count=$(scene page.html kindBegin | "$PYTHON" -c 'import json, sys; print(json.load(sys.stdin)[4])')
  assert_fails_with 1 "^viewmesh: parts:3: expected the number of a candidate, 1 to $count, found 'x'" \
    viewmesh graph.tar --fragments parts -o no.html
  # Those of another graph; a solution shows some of its candidates, but has no more.
  for stage in graph solution; do
    echo "$count $((count + 1))" >others
    assert_fails_with 1 "^viewmesh: others:1: expected the number of a candidate, 1 to $count, found '$((count + 1))'" \
      viewmesh $stage.tar --fragments others -o no.html
    echo "1 $count" >others
    viewmesh $stage.tar --fragments others -o page.html
  done
}
