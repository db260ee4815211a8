# tessellate: CAD files to surfaces with curves, bodies and names.

load helpers

setup_file() {
  # OpenCASCADE keeps what it made at its start.
  export LSAN_OPTIONS="suppressions=$BATS_TEST_DIRNAME/leaks_of_occt.txt:print_suppressions=0"
}

# step KIND...: KIND.step by tests/data/step.py.
step() {
  local kind
  for kind in "$@"; do $PYTHON "$DATA/step.py" "$kind" >"$kind.step"; done
}

# surface BUNDLE EXPRESSION: of its arrays, by name, and of `names`.
surface() {
  $PYTHON - "$@" <<'PYTHON'
import io, json, math, sys, tarfile
import numpy as np
arrays, names = {}, {}
with tarfile.open(sys.argv[1]) as bundle:
    for member in bundle:
        data = bundle.extractfile(member).read()
        if member.name == "names.json":
            names = json.loads(data)
        elif member.name.startswith(("surface/", "mesh/")) and member.name.endswith(".npy"):
            arrays[member.name.replace("mesh/", "mesh_").replace("surface/", "")[:-4]] = np.load(io.BytesIO(data))
globals().update(arrays)

def tags_of(name):
    return [int(tag) for tag, value in names["surfaces"].items() if value == name]

def area(tag):
    return float(sum(np.linalg.norm(np.cross(points[b] - points[a], points[c] - points[a])) / 2 for (a, b, c), t in zip(triangles, triangle_tags) if t == tag))

def volume():
    return float(sum(np.linalg.det(points[list(t)]) / 6 for t in triangles))

def volumes():
    return [round(float(sum(((back == region) * 1 - (front == region) * 1) * np.linalg.det(points[list(t)]) / 6 for t, (back, front) in zip(triangles, sides))), 6)
            for region in range(1, int(sides.max()) + 1)]

def bodies():
    return "; ".join("{} {} {}".format(names["regions"][str(region)], *[corner.round(6).tolist() for corner in (corners.min(0), corners.max(0))])
                     for region in range(1, int(sides.max()) + 1) for corners in [points[np.unique(triangles[sides[:, 0] == region])]])

def open_edges():
    count = {}
    for t in triangles:
        for i in range(3):
            edge = (min(t[i], t[i - 2]), max(t[i], t[i - 2]))
            count[edge] = count.get(edge, 0) + 1
    return sum(c != 2 for c in count.values())

print(eval(sys.argv[2]))
PYTHON
}

@test "a real part becomes a closed surface near the CAD's, with its edges as curves" {
  tessellate "$DATA/simp.step" -o simp.tar
  assert_equal "$(surface simp.tar 'open_edges()')" 0
  # By OpenCASCADE's own integration over the CAD's faces.
  run surface simp.tar 'round(volume() / 172052, 3)'
  assert_output 1.0
  # Half of a cylinder goes on smoothly into the other half: one tag, and no curve between them.
  assert_equal "$(surface simp.tar 'sorted(set(sides[:, 0])) == [1] and set(sides[:, 1]) == {0}')" True
  assert [ "$(surface simp.tar 'len(curves)')" -gt 50 ]
}

# bats test_tags=optimized
@test "its bundle goes through the whole pipeline" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  step named
  tessellate named.step | tetmesh --size 5 | findhex | buildgraph | initsol --iterations 100 | assemble -o named.tar
  run bash -c "tar tf named.tar"
  assert_line surface/points.npy
  assert_line surface/curves.npy
  assert_line names.json
  run tar xOf named.tar names.json
  assert_output '{"surfaces":{"4":"outlet","6":"inlet"},"regions":{"1":"pipe"}}'
}

@test "--deviation and --angle ask for more triangles" {
  tessellate "$DATA/simp.step" -o default.tar
  tessellate "$DATA/simp.step" --deviation 0.001 -o near.tar
  tessellate "$DATA/simp.step" --angle 4 -o round.tar
  local count
  count=$(surface default.tar 'len(triangles)')
  assert [ "$(surface near.tar 'len(triangles)')" -gt $((2 * count)) ]
  assert [ "$(surface round.tar 'len(triangles)')" -gt $((2 * count)) ]
}

# bats test_tags=optimized
@test "the default deviation is a hundredth of the size that tetmesh chooses" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  tessellate "$DATA/simp.step" --stats cad.json | tetmesh --tries 1 --stats mesh.json -o mesh.tar
  run $PYTHON -c 'import json; print(abs(json.load(open("mesh.json"))["size"] / json.load(open("cad.json"))["deviation"] / 100 - 1) < 0.01)'
  assert_output True
}

# assert_solid CAD VOLUME: closed triangles of about this volume, without a warning, which tetmesh takes (with these
# options). Leaves NAME.tar, and what --stats says in stats.json.
assert_solid() {
  local name=${1##*/} volume=$2
  name=${name%.*}
  run_apart tessellate "$1" -o "$name.tar" --stats stats.json
  assert_success
  assert_equal "$stderr" ""
  assert_equal "$(surface "$name.tar" 'open_edges()')" 0
  run surface "$name.tar" "abs(volume() / $volume - 1) < 1e-3"
  assert_output True
  holds 'stats["crossings"] == 0' stats.json
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then tetmesh -q "$name.tar" "${@:3}" -o mesh.tar; fi
}

# Where two edges of a face run into a tip, their polygons cross within the tolerance of the edges. Volumes are by
# OpenCASCADE's own integration over the CAD's faces.
@test "gaps that OpenCASCADE leaves at tips of faces are closed" {
  assert_solid "$DATA/tip.step" 28.7984 --size 0.5
  holds 'stats["joined_nodes"] > 0' stats.json
  assert_solid "$DATA/sphere-tip.step" 31.1413 --size 0.5
  holds 'stats["joined_nodes"] > 0' stats.json
}

# A cone that is cut open along a seam, between circles of 1.45 and 1.85, and a face of a box between two edges that are
# one within their tolerance.
@test "faces of which OpenCASCADE makes no triangles are filled or become nothing" {
  assert_solid "$DATA/frustum.brep" 3.43797
  # Two circles of 143 nodes, and none between them.
  holds 'stats["points"] < 300' stats.json
  assert_solid "$DATA/sliver.brep" 480
}

# thin NAME INNER: NAME.step, a cylinder of the radius 10 with a cylinder of the radius INNER as a hole in it.
thin() {
  cat >"$1.geo" <<END
SetFactory("OpenCASCADE");
Cylinder(1) = {0, 0, 0, 0, 0, 10, 10};
Cylinder(2) = {0, 0, 1, 0, 0, 8, $2};
Rotate {{0, 0, 1}, {0, 0, 0}, Pi/24} { Volume{2}; }
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
END
  gmsh -0 "$1.geo" -o "$1.step" >gmsh.log
}

@test "where triangles of a body cross each other, those of their faces are made anew, finer" {
  thin wall 9.99
  run --separate-stderr tessellate wall.step --unit mm --deviation 0.5 --angle 30 -o wall.tar --stats stats.json
  assert_success
  assert_regex "$stderr" "^tessellate: warning: wall.step: [0-9]+ pairs of triangles crossed each other; none do since triangles were made anew, within 0.5 of the faces$"
  # How many there are depends on OpenCASCADE's version.
  assert_equal "$($PYTHON -c 'import json; print(json.load(open("stats.json"))["crossings"] > 10)')" True
  assert_equal "$(surface wall.tar 'open_edges()')" 0
  run surface wall.tar 'abs(volume() / (math.pi * (10 * 100 - 8 * 9.99**2)) - 1) < 0.01'
  assert_output True
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then
    tetmesh wall.tar --surface keep --points none -o wall.mesh
  fi
}

@test "where neither finer nor coarser triangles help, the first ones stay, which is told" {
  thin film 9.999999
  run --separate-stderr tessellate film.step --unit mm -o film.tar
  assert_success
  assert_regex "$stderr" "^tessellate: warning: film.step: [0-9]+ pairs of triangles cross each other, and so do finer and coarser ones$"
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then
    assert_fails_with 1 "expected a surface that does not intersect itself" tetmesh film.tar -o film.mesh
  fi
}

@test "names of faces and bodies are groups, colours and layers where a face has no name" {
  step named coloured
  tessellate named.step -o named.tar
  assert_equal "$(surface named.tar 'names["regions"]')" "{'1': 'pipe'}"
  assert_equal "$(surface named.tar '[area(tags_of(name)[0]) for name in ("inlet", "outlet")]')" "[600.0, 600.0]"
  tessellate coloured.step -o coloured.tar
  assert_equal "$(surface coloured.tar 'sorted(names["surfaces"].values())')" "['colour_ff0000', 'inlet', 'outflow']"
  assert_equal "$(surface coloured.tar 'area(tags_of("inlet")[0])')" 200.0
}

@test "faces of one name have one tag, whatever the name is" {
  step one-name odd-names
  tessellate one-name.step -o one.tar
  assert_equal "$(surface one.tar 'area(tags_of("wall")[0])')" 1200.0
  tessellate odd-names.step -o odd.tar
  assert_equal "$(surface odd.tar 'sorted(names["surfaces"].values()) == sorted(["Einl\u00e4\u00df 1", "a \u0027b\u0027 \"c\"", "x" * 200])')" True
  assert_equal "$(surface odd.tar 'names["regions"]["1"] == "St\u00fcck"')" True
}

@test "lengths are in the file's unit, which is told, or in that of --unit" {
  step box metres inches
  run_apart tessellate box.step -o box.tar
  assert_success
  assert_equal "$stderr" ""
  run_apart tessellate metres.step -o metres.tar
  assert_success
  assert_equal "$stderr" "tessellate: warning: metres.step: its unit is the metre, and so is that of all lengths (see --unit)"
  assert_equal "$(surface metres.tar 'points.max(axis=0).tolist()')" "[10.0, 20.0, 30.0]"
  run_apart tessellate metres.step --unit mm -o mm.tar
  assert_equal "$stderr" ""
  assert_equal "$(surface mm.tar 'points.max(axis=0).tolist()')" "[10000.0, 20000.0, 30000.0]"
  tessellate inches.step --unit m -o m.tar
  assert_equal "$(surface m.tar 'np.allclose(points.max(axis=0), [0.254, 0.508, 0.762])')" True
  run bash -c 'tar xOf mm.tar history/01-tessellate.json | grep unit'
  assert_output --partial '"unit": "millimetre"'
}

@test "a curve of the CAD that is less sharp than the feature angle is an edge of the mesh" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  step roof
  tessellate roof.step | tetmesh --size 0.4 -o roof.tar
  # The ridge, from (2, 0, 2.4) to (2, 4, 2.4), in steps of a size.
  assert_equal "$(surface roof.tar 'sum((abs(mesh_points[:, 0] - 2) < 1e-9) & (abs(mesh_points[:, 2] - 2.4) < 1e-9))')" 11
  assert_equal "$(surface roof.tar 'sum(np.linalg.norm(points[a] - points[b]) for (a, b), tag in zip(curves, curve_tags) if abs(points[a] - points[b])[1] > 3 and points[a][2] > 2.3)')" 4.0
}

# bats test_tags=optimized
@test "bodies stand side by side, five hundred of them too" {
  step apart many
  tessellate apart.step -o apart.tar
  assert_equal "$(surface apart.tar 'sides.tolist() == [[1, 0]] * 12 + [[2, 0]] * 12')" True
  assert_equal "$(surface apart.tar 'names["regions"]')" "{'1': 'body 1', '2': 'body 2'}"
  tessellate many.step -o many.tar
  assert_equal "$(surface many.tar 'sides.max()')" 500
}

@test "an assembly has its parts in other files, beside it wherever it is" {
  mkdir elsewhere
  cp "$DATA"/stand/* elsewhere
  tessellate elsewhere/stand.step -o stand.tar
  assert_equal "$(surface stand.tar 'points.min(0).tolist(), points.max(0).tolist(), round(volume(), 9)')" "([0.0, 0.0, 0.0], [4.0, 3.0, 3.0], 16.0)"
  assert_equal "$(surface stand.tar 'names["regions"], sorted(names["surfaces"].values()), area(tags_of("socket")[0])')" \
    "({'1': 'base', '2': 'post', '3': 'post'}, ['socket'], 4.0)"
  # Standard input has no folder; the current one takes its place.
  (cd elsewhere && tessellate <stand.step -o ../piped.tar)
  assert_equal "$(surface piped.tar 'sides.max()')" 3
  assert_fails_with 1 "^tessellate: stdin: expected its part 'base.stp' beside it, which is the current folder for standard input, found no such file" \
    shell 'tessellate <elsewhere/stand.step'
  # Parts of parts are beside the file that names them.
  mkdir -p tower/parts
  sed "s/'base.stp'/'parts\/stand.step'/" elsewhere/stand.step >tower/tower.step
  cp elsewhere/post.stp tower
  cp elsewhere/* tower/parts
  tessellate tower/tower.step -o tower.tar
  assert_equal "$(surface tower.tar 'sides.max(), round(volume(), 9)')" "(5, 20.0)"
}

@test "--body takes bodies by name or number, and leaves out the others" {
  step many
  cp -r "$DATA/stand" .
  tessellate stand/stand.step --body post -o posts.tar
  assert_equal "$(surface posts.tar 'names["regions"], sides.max(), round(volume(), 9)')" "({'1': 'post', '2': 'post'}, 2, 4.0)"
  tessellate stand/stand.step --body 3 --body base -o two.tar
  assert_equal "$(surface two.tar 'names["regions"], round(volume(), 9)')" "({'1': 'base', '2': 'post'}, 14.0)"
  local missing
  for missing in 4 0 03 -1 Base ''; do
    assert_fails_with 1 "stand.step: expected a body of the name or number '$missing' \(--body\), found 3 bodies: 'base', 'post'$" \
      tessellate stand/stand.step --body "$missing"
  done
  assert_fails_with 1 "found 500 bodies: 'body 1', .*, 'body 10' and others$" tessellate many.step --body 501
}

@test "a part of an assembly that cannot be read is an error, and so are files that refer to each other in a circle" {
  cp "$DATA"/stand/* .
  mv post.stp other.stp
  assert_fails_with 1 "^tessellate: stand.step: expected its part 'post.stp' beside it, found no such file" tessellate stand.step -o x.tar
  head -c 9000 other.stp >post.stp
  assert_fails_with 1 "post.stp: expected END-ISO-10303-21; at the end" tessellate stand.step -o x.tar
  : >post.stp
  assert_fails_with 1 "post.stp: expected END-ISO-10303-21; at the end" tessellate stand.step -o x.tar
  sed 's/;$//' other.stp >post.stp
  assert_fails_with 1 "post.stp: expected a STEP file, found one that OpenCASCADE cannot read" tessellate stand.step -o x.tar
  cp stand.step post.stp
  assert_fails_with 1 "post.stp: expected parts in other files, found that 'post.stp' refers back to itself" tessellate stand.step -o x.tar
  sed 's/post.stp/stand.step/' stand.step >post.stp
  assert_fails_with 1 "post.stp: expected parts in other files, found that 'stand.step' refers back to itself" tessellate stand.step -o x.tar
  mv other.stp post.stp
  # Where a shape representation has the format, OpenCASCADE minds it.
  sed "s/STEP AP214/STEP AP999/; s/ REPRESENTATION('document format'/ SHAPE_REPRESENTATION('document format'/" stand.step >newer.step
  assert_fails_with 1 "newer.step: OpenCASCADE reads no part of the format 'STEP AP999' from another file, as 'base.stp' is" tessellate newer.step -o x.tar
  [[ ! -e x.tar ]]
  # A drawing is no part.
  sed 's/post.stp/post.pdf/' stand.step >drawing.step
  run_apart tessellate drawing.step -o x.tar
  assert_success
  assert_equal "$stderr" ""
}

@test "a solid of which OpenCASCADE makes none is told" {
  step apart
  # The shell of body 2 without its last face, and without any.
  sed -E "s/^(#299=CLOSED_SHELL\('',\(.*),#[0-9]+\)\);/\1));/" apart.step >open.step
  sed -E "s/^(#299=CLOSED_SHELL\('',\().*\)\);/\1));/" apart.step >none.step
  for file in open none; do
    run_apart tessellate $file.step -o x.tar
    assert_success
    assert_equal "${stderr_lines[0]}" "tessellate: warning: $file.step: a solid has no closed shell, and is left out; the first is #300 'body 2'"
    assert_equal "$(surface x.tar 'sides.max()')" 1
  done
}

@test "--join makes one face of two that touch" {
  step touching half-touching
  tessellate touching.step -o apart.tar
  tessellate touching.step --join -o joined.tar
  assert_equal "$(surface apart.tar 'len(triangles), open_edges()')" "(24, 0)"
  assert_equal "$(surface joined.tar 'len(triangles), sorted(map(tuple, sides.tolist())).count((1, 2))')" "(22, 2)"
  tessellate half-touching.step --join -o half.tar
  assert_equal "$(surface half.tar 'sorted(map(tuple, sides.tolist())).count((1, 2))')" 2
  # The triangles that a plate shares with no other body enclose less than nothing, as seen from the other arm.
  step in-channel
  tessellate in-channel.step --join -o channel.tar
  assert_equal "$(surface channel.tar 'volumes()')" "[32.0, 0.75, 0.75]"
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then
    tessellate half-touching.step -o half-apart.tar
    assert_fails_with 1 "half-apart.tar: .* intersect itself, .*; where bodies touch, tessellate --join makes one face of two" tetmesh half-apart.tar -o x.mesh
    # Across the interface and on its own, each body is filled with hexes alone.
    tetmesh -q joined.tar --size 0.5 | findhex | buildgraph | initsol --iterations 100 | assemble --stats stats.json -o joined.msh
    run $PYTHON -c 'import json; cells = json.load(open("stats.json"))["cells"]; print({k: v["count"] for k, v in cells.items() if v["count"]})'
    assert_output "{'hex': 1024}"
  fi
}

@test "of bodies that overlap one is cut, as --overlaps says, or they are refused by name" {
  step overlapping in-another through-another
  assert_fails_with 1 "overlapping.step: expected bodies that touch at most, found some that overlap: body 1 \('body 1'\) and body 2 \('body 2'\) by 12.5 % of the smaller one \(--overlaps .*\)" \
    tessellate overlapping.step --join
  assert_fails_with 1 "in-another.step: .* overlap: body 1 \('body 1'\) and body 2 \('body 2'\) by 100 % of the smaller one" tessellate in-another.step --overlaps refuse
  # Numbers are those of the file.
  step two-of-three
  assert_fails_with 1 "two-of-three.step: .* overlap: body 2 \('body 2'\) and body 3 \('body 3'\) by 12.5 %" tessellate two-of-three.step --body 2 --body 3 --join
  # A body of 64 and one of 64 with 8 in common; equal ones: the first is the smaller one.
  local rule
  for rule in first:64:56 last:56:64 small:64:56; do
    run_apart tessellate overlapping.step --overlaps "${rule%%:*}" --stats stats.json -o cut.tar
    assert_success
    assert_regex "$stderr" "^tessellate: warning: overlapping.step: bodies overlapped: body 1 \('body 1'\) and body 2 \('body 2'\) by 12.5 % of the smaller one; that is the (first|last|smaller) one's now \(--overlaps\)$"
    IFS=: read -r _ one other <<<"$rule"
    assert_equal "$(surface cut.tar 'volumes(), sorted(names["regions"].items())')" "([$one.0, $other.0], [('1', 'body 1'), ('2', 'body 2')])"
    holds 'stats["overlaps"] == 1 and stats["bodies"] == 2' stats.json
  done
  # Where two are the same, all triangles are there twice.
  step twice
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then
    tessellate -q twice.step -o twice.tar
    assert_fails_with 1 "twice.tar: .*expected distinct triangles, found 12 with .* \\(bodies that overlap: see tessellate --overlaps\\)" tetmesh twice.tar -o x.tar
  fi
  tessellate -q twice.step --overlaps small -o once.tar
  assert_equal "$(surface once.tar 'volumes()')" "[64.0]"
  # One that lies in another, of 216 and 8, leaves a cavity there, or nothing.
  tessellate -q in-another.step --overlaps small -o small.tar
  assert_equal "$(surface small.tar 'volumes()')" "[208.0, 8.0]"
  run_apart tessellate in-another.step --overlaps first -o first.tar
  assert_equal "${stderr_lines[1]}" "tessellate: warning: in-another.step: body 2 ('body 2') lies in others, and is left out (--overlaps)"
  assert_equal "$(surface first.tar 'volumes()')" "[216.0]"
  # A bar through a plate ends in two pieces, or makes a hole.
  tessellate -q through-another.step --overlaps last -o last.tar
  assert_equal "$(surface last.tar 'volumes(), list(names["regions"].values())')" "([8.0, 8.0, 32.0], ['body 1', 'body 1', 'body 2'])"
  tessellate -q through-another.step --overlaps first -o first.tar
  assert_equal "$(surface first.tar 'volumes()')" "[24.0, 24.0]"
  # Bodies that only touch stay as --join makes them.
  step touching
  run_apart tessellate touching.step --overlaps small --stats stats.json -o touching.tar
  assert_equal "$stderr" ""
  holds 'stats["overlaps"] == 0' stats.json
  assert_equal "$(surface touching.tar 'volumes(), sorted(map(tuple, sides.tolist())).count((1, 2))')" "([64.0, 64.0], 2)"
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then
    tetmesh -q small.tar --size 0.5 | findhex -q | buildgraph -q | initsol -q --iterations 1000 | assemble -q --stats stats.json -o small.msh
    assert_conforming small.msh
    holds 'stats["cells"]["hex"]["count"] == 1728 and stats["cells"]["tet"]["count"] == 0' stats.json
  fi
}

@test "closed shells without a solid are bodies, which is told; sheets are an error" {
  step closed-shell sheets nothing
  run_apart tessellate closed-shell.step -o shell.tar
  assert_success
  assert_equal "$stderr" "tessellate: warning: closed-shell.step: there are no solids: shells that are closed are taken for bodies, 1 body"
  assert_equal "$(surface shell.tar 'round(volume(), 9)')" 64.0
  assert_fails_with 1 "sheets.step: expected bodies, found no solid, and 1 shell of 5 faces that is not closed; 4 edges of a single face, the first from \(.*, 30\) to \(.*, 30\) \(--open writes its faces for wrap, which closes gaps\)$" tessellate sheets.step
  assert_fails_with 1 "nothing.step: expected bodies, found no solid and no face" tessellate nothing.step
}

@test "--open writes faces that enclose nothing, without sides, and wrap closes them" {
  step sheets box baffle nothing
  run_apart tessellate sheets.step --open --stats stats.json -o open.tar
  assert_success
  assert_equal "$stderr" ""
  # A box of 10 x 20 x 30 without its top.
  assert_equal "$(surface open.tar 'len(triangles), len(set(map(tuple, points.tolist()))), open_edges(), "sides" in arrays, sum(area(int(t)) for t in set(triangle_tags.tolist()))')" "(10, 8, 4, False, 2000.0)"
  holds 'stats["bodies"] == 0 and stats["faces"] == 5' stats.json
  # Bodies and loose faces are all there.
  tessellate -q baffle.step --open -o baffle.tar
  assert_equal "$(surface baffle.tar 'len(triangles), "vane" in names["surfaces"].values(), "regions" in names')" "(14, True, False)"
  assert_fails_with 1 "nothing.step: expected faces, found none" tessellate nothing.step --open
  assert_fails_with 2 "--open excludes --join|--join excludes --open" tessellate box.step --open --join
  if [[ -x "$HEXPIPE_BIN/wrap" ]]; then
    # Its open side is 10 wide.
    tessellate -q sheets.step --open | wrap -q --gap 12 -o closed.tar
    assert_equal "$(surface closed.tar 'open_edges(), round(volume() / 600) ')" "(0, 10)"
    step named
    tessellate -q named.step --open | wrap -q -o named.tar
    assert_equal "$(tar tf named.tar | grep history | tr '\n' ' ')" "history/01-tessellate.json history/02-wrap.json "
    assert_equal "$(surface named.tar 'sorted(names["surfaces"].values()), [round(area(tags_of(name)[0]) / 60) for name in ("inlet", "outlet")]')" "(['inlet', 'outlet'], [10, 10])"
    assert_fails_with 1 "expected a surface that encloses a room .*; its widest hole, 4 edges around \(5, 10, 30\), is about 13.3 wide" wrap open.tar --gap 4
  fi
}

@test "faces that belong to no body are told, and kept as baffles if asked for" {
  step baffle floating-baffle poking-baffle baffle-outside touching
  run_apart tessellate baffle.step -o without.tar
  assert_success
  assert_equal "$stderr" "tessellate: warning: baffle.step: a face that belongs to no body is left out (see --keep-baffles)"
  assert_equal "$(surface without.tar 'len(triangles), sides.tolist() == [[1, 0]] * 12')" "(12, True)"
  local kind
  for kind in baffle floating-baffle; do
    run_apart tessellate "$kind.step" --keep-baffles -o "$kind.tar"
    assert_success
    assert_equal "$stderr" ""
    assert_equal "$(surface "$kind.tar" 'sides.tolist().count([1, 1]), {names["surfaces"][str(t)] for t, s in zip(triangle_tags, sides.tolist()) if s == [1, 1]}')" "(2, {'vane'})"
  done
  # Where it stands, the faces of the room are cut, and share its edges.
  assert_equal "$(surface baffle.tar 'sorted(set(names["surfaces"].values())), len(set(map(tuple, points.tolist())))')" "(['inlet', 'outlet', 'vane'], 12)"
  # Half of it is inside.
  run_apart tessellate poking-baffle.step --keep-baffles -o poking.tar
  assert_equal "$stderr" "tessellate: warning: poking-baffle.step: 1 face outside of all bodies, or on their boundary, is no baffle and left out"
  assert_equal "$(surface poking.tar 'float(points[:, 2].max()), sides.tolist().count([1, 1])')" "(4.0, 2)"
  run_apart tessellate baffle-outside.step --keep-baffles -o outside.tar
  assert_equal "$stderr" "tessellate: warning: baffle-outside.step: 1 face outside of all bodies, or on their boundary, is no baffle and left out"
  # Without sheets, it joins bodies that touch.
  tessellate touching.step --keep-baffles -o kept.tar
  tessellate touching.step --join -o joined.tar
  assert_equal "$(surface kept.tar 'sides.tolist()')" "$(surface joined.tar 'sides.tolist()')"
}

# bats test_tags=optimized
@test "a baffle of CAD is in the mesh, with hexes on both sides, on the CAD's face" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  step baffle
  tessellate baffle.step --keep-baffles -o baffle.tar
  run_apart tetmesh baffle.tar --size 0.5 -o dropped.tar
  assert_success
  assert_equal "$stderr" "tetmesh: warning: baffle.tar: 2 triangles with the same on both sides are left out"
  tetmesh -q baffle.tar --size 0.5 --keep-baffles | findhex -q | buildgraph -q | initsol -q --iterations 100 | assemble -q -o case.tar
  fitcad -q case.tar -o case.msh
  mkdir constant
  fitcad -q case.tar -o constant/polyMesh
  run grep -c '^ *vane' constant/polyMesh/faceZones
  assert_output 1
  run $PYTHON - <<'PYTHON'
import meshio, contextlib, io
with contextlib.redirect_stdout(io.StringIO()):
    mesh = meshio.read("case.msh")
number = mesh.field_data["vane"][0]
for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
    vane = block.data[tags == number]
    if block.type in ("quad", "triangle") and len(vane):
        print(block.type, len(vane), set(mesh.points[vane.ravel()][:, 0].tolist()))
PYTHON
  assert_output "quad 32 {3.0}"
}

@test "IGES of other programs: a real part, numbers filled up by zeros, and what may follow the last line" {
  run_apart tessellate "$DATA/rounded-cube.igs" -o cube.tar
  assert_success
  assert_equal "$stderr" "tessellate: warning: $DATA/rounded-cube.igs: there are no solids: its faces are sewn to bodies, 1 body"
  assert_equal "$(surface cube.tar 'open_edges(), len(points) > 50')" "(0, True)"
  tessellate -q - <"$DATA/rounded-cube.igs" >piped.tar
  assert_equal "$(surface piped.tar 'triangles.tolist()')" "$(surface cube.tar 'triangles.tolist()')"
  sed -E 's/^(.{72})([SGDPT]) {6}(.)/\1\2000000\3/; s/^(.{72})([SGDPT]) {5}(..)/\1\200000\3/' "$DATA/rounded-cube.igs" >zeros.igs
  run ! cmp -s zeros.igs "$DATA/rounded-cube.igs"
  tessellate -q zeros.igs -o zeros.tar
  assert_equal "$(surface zeros.tar 'triangles.tolist()')" "$(surface cube.tar 'triangles.tolist()')"
  gzip -c "$DATA/rounded-cube.igs" >packed.igs.gz
  tessellate -q packed.igs.gz -o packed.tar
  assert_equal "$(surface packed.tar 'triangles.tolist()')" "$(surface cube.tar 'triangles.tolist()')"
  { cat "$DATA/rounded-cube.igs"; printf '\n\032'; } >followed.igs
  tessellate -q followed.igs -o followed.tar
  assert_equal "$(surface followed.tar 'triangles.tolist()')" "$(surface cube.tar 'triangles.tolist()')"
  sed '$d' "$DATA/rounded-cube.igs" >cut.igs
  assert_fails_with 1 "cut.igs: expected a line of section T at the end of an IGES file" tessellate cut.igs
}

@test "entities that cannot be read are told; a face without triangles is an error that names it" {
  step box
  sed "0,/(0.0,0.0,30.0)/s//(0.0,0.0,NAN)/" box.step >nan.step
  run_apart tessellate nan.step -o nan.tar
  assert_success
  assert_equal "$stderr" "tessellate: warning: nan.step: an entity is faulty, and may be taken for something else; the first is #9: Parameter n0.3 (coordinates) not a Real"
  sed -E "0,/EDGE_CURVE\('',#[0-9]+/s//EDGE_CURVE('',#99999/" box.step >dangling.step
  assert_fails_with 1 "dangling.step: expected bodies, found no solid and no face; .* faulty, and may be taken for something else; the first is #21: " tessellate dangling.step
  sed -E "0,/PLANE\('',(#[0-9]+)\)/s//CYLINDRICAL_SURFACE('',\1,0.001)/" box.step >thin.step
  assert_fails_with 1 "thin.step: face 1 of body 1: OpenCASCADE cannot make triangles of it" tessellate thin.step
  sed -E "0,/PLANE\('',(#[0-9]+)\)/s//SPHERICAL_SURFACE('',\1,0.)/" box.step >point.step
  assert_fails_with 1 "point.step: OpenCASCADE failed: LProp_NotDefined$" tessellate point.step
}

@test "names that bodies and faces share, or that differ by capitals alone, are told apart where a format needs it" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  step clash odd-names
  tessellate clash.step | tetmesh -q --size 15 | findhex -q | buildgraph -q | initsol -q --iterations 20 -o clash.tar
  run_apart assemble clash.tar -o clash.inp
  assert_success
  run grep -E '^\*NSET, NSET=[Ww]' clash.inp
  assert_equal "$(sed -E 's/.*SET=//' <<<"$output" | tr 'a-z' 'A-Z' | sort -u | wc -l)" 4
  tessellate -q odd-names.step | tetmesh -q --size 15 | findhex -q | buildgraph -q | initsol -q --iterations 20 -o odd.tar
  local format
  for format in mesh msh msh22 vtk vtu inp su2 bdf; do
    run_apart assemble odd.tar -o "odd.$format"
    assert_success
  done
  # Abaqus' names have 80 characters.
  run grep -cE 'x{81}' odd.inp
  assert_output 0
}

# The sanitizer catches the signal.
# bats test_tags=optimized
@test "where OpenCASCADE crashes, a line says on which file" {
  mkfifo endless.step
  exec {writer}<>endless.step
  tessellate endless.step -o x.tar 2>crash.txt &
  local tool=$! code=0
  # Until it handles SIGSEGV, which the shell that it comes from does, too.
  until [[ $(<"/proc/$tool/comm") == tessellate ]] &&
    ((0x$(awk '/^SigCgt/ {print $2}' "/proc/$tool/status") & 0x400)); do sleep 0.1; done
  kill -SEGV "$tool"
  wait "$tool" || code=$?
  exec {writer}>&-
  assert_equal "$code" 1
  assert_equal "$(cat crash.txt)" "tessellate: endless.step: OpenCASCADE crashed on it"
  [[ ! -e x.tar ]]
}

@test "files that are empty, cut off or no CAD are errors of one line" {
  step box
  : >empty.step
  assert_fails_with 1 "empty.step: expected CAD in STEP, IGES, BREP or FreeCAD.s FCStd, found nothing: it is empty" tessellate empty.step
  for bytes in 100 2000 4000; do
    head -c $bytes box.step >cut.step
    assert_fails_with 1 "cut.step: expected END-ISO-10303-21; at the end" tessellate cut.step
  done
  assert_fails_with 1 "cube.stl: expected CAD in STEP, IGES, BREP or FreeCAD.s FCStd, found" tessellate "$DATA/cube.stl"
  sed 's/MANIFOLD_SOLID_BREP/TESSELLATED_SOLID/' box.step >triangles.step
  assert_fails_with 1 "triangles.step: expected bodies with exact faces, found some of triangles" tessellate triangles.step
  sed 's/ADVANCED_FACE/NO_SUCH_FACE/' box.step >unknown.step
  assert_fails_with 1 "unknown.step: expected" tessellate unknown.step
  assert_fails_with 1 "none.step: cannot open" tessellate none.step
  assert_fails_with 2 "expected a surface as obj, stl, msh or tar, tar.zst, found 'x.step'" tessellate box.step -o x.step
}

@test "BREP and IGES, from a file and from a pipe" {
  cat >box.geo <<'END'
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 2, 3};
END
  gmsh -0 box.geo -o box.brep >/dev/null
  tessellate box.brep -o brep.tar
  assert_equal "$(surface brep.tar 'len(triangles), round(volume(), 9)')" "(12, 6.0)"
  tessellate <box.brep >piped.tar
  assert_same_bytes brep.tar piped.tar
  $PYTHON - box.igs <<'PYTHON'
import sys
# Six trimmed planes would be long; one that is cut off and one without entities say enough about the reader.
def line(text, section, number):
    return f"{text:<72}{section}{number:7d}\n"
start = line("", "S", 1)
head = line("1H,,1H;,4Hnone,4Hnone,4Hnone,4Hnone,32,38,6,308,15,4Hnone,1.,2,2HMM,1,", "G", 1) + line("0.01,15H20240101.000000,1E-07,100.,,,11,0,15H20240101.000000;", "G", 2)
open(sys.argv[1], "w").write(start + head)
open("whole.igs", "w").write(start + head + line("S      1G      2D      0P      0", "T", 1))
PYTHON
  assert_fails_with 1 "box.igs: expected a line of section T at the end of an IGES file" tessellate box.igs
  assert_fails_with 1 "whole.igs: expected" tessellate whole.igs
}

@test "-o writes for other meshers, with names" {
  step odd-names
  tessellate odd-names.step -o box.stl
  assert_equal "$(grep -c '^facet' box.stl)" 12
  assert grep -q "^solid Einläß 1$" box.stl
  run_apart tessellate odd-names.step -o box.obj
  assert_success
  assert_equal "$(grep -c '^f ' box.obj)" 12
  assert grep -q "^g Einläß_1$" box.obj
  assert_equal "$(head -1 <<<"$stderr" | cut -c1-60)" "tessellate: warning: the name 'a 'b' \"c\"' is written as a_'b"
  tessellate odd-names.step -o box.msh
  run $PYTHON -c 'import meshio; mesh = meshio.read("box.msh"); print(sum(len(c.data) for c in mesh.cells if c.type == "triangle"))'
  assert_output --partial 12
}

@test "tetmesh says how CAD files are meshed" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  assert_fails_with 1 "found CAD in STEP; 'tessellate .*simp.step [|] tetmesh' meshes it" tetmesh "$DATA/simp.step"
}

@test "the same bytes every time" {
  tessellate "$DATA/simp.step" -o one.tar
  tessellate "$DATA/simp.step" --threads 1 -o other.tar
  assert_same_bytes one.tar other.tar
}

# fcstd KIND...: KIND.FCStd by tests/data/fcstd.py.
fcstd() {
  local kind
  for kind in "$@"; do $PYTHON "$DATA/fcstd.py" "$kind" >"$kind.FCStd"; done
}

@test "FreeCAD's documents: what they show, where FreeCAD has it, with labels, and faces of constraints and colours" {
  # By FreeCAD itself, Part.getShape(object).BoundBox, its places are these.
  local plate='plate [0.0, 0.0, 0.0] [20.0, 10.0, 4.0]' foot='Fuß [8.0, 3.0, -6.0] [10.0, 5.0, 0.0]' link='second foot [16.0, 6.0, -6.0] [18.0, 8.0, 0.0]'
  run_apart tessellate "$DATA/legs.FCStd" --stats stats.json -o legs.tar
  assert_success
  assert_equal "$stderr" ""
  holds 'stats["unit"] == "millimetre"' stats.json
  assert_equal "$(surface legs.tar 'bodies()')" "$plate; $foot; $link"
  # The plate has a hole of radius 2; FreeCAD's constraint is on its face at x = 20.
  assert_equal "$(surface legs.tar 'round(volumes()[0]), volumes()[1:], area(tags_of("clamp")[0]), float(points[triangles[triangle_tags == tags_of("clamp")[0]]][:, :, 0].min())')" \
    "(750, [24.0, 24.0], 40.0, 20.0)"
  gzip -c "$DATA/legs.FCStd" | tessellate >piped.tar
  assert_equal "$(surface piped.tar 'bodies()')" "$plate; $foot; $link"
  fcstd coloured hidden array
  # A hidden object is none; of two names of a face the constraint's is its name.
  tessellate coloured.FCStd -o coloured.tar
  assert_equal "$(surface coloured.tar 'bodies()')" "$plate; $foot"
  assert_equal "$(surface coloured.tar 'sorted(names["surfaces"].values())')" "['clamp', 'colour_00ff00']"
  run_apart tessellate hidden.FCStd -o hidden.tar
  assert_equal "$stderr" "tessellate: warning: hidden.FCStd: the document shows no solid; hidden ones are taken"
  assert_equal "$(surface hidden.tar 'bodies()')" "$plate; $foot; $link; Hidden [40.0, 0.0, 0.0] [50.0, 10.0, 10.0]"
  tessellate array.FCStd -o array.tar
  assert_equal "$(surface array.tar 'bodies()')" "$plate; $foot; $link; second foot [21.0, 6.0, -6.0] [23.0, 8.0, 0.0]; second foot [26.0, 6.0, -6.0] [28.0, 8.0, 0.0]"
}

@test "FreeCAD's documents: groups and bodies in parts, links to them, arrays, and what no window has hidden" {
  run_apart tessellate "$DATA/nested.FCStd" -o nested.tar
  assert_success
  assert_equal "$stderr" "tessellate: warning: $DATA/nested.FCStd: the link 'big peg' is left out: it scales its target"
  # By FreeCAD itself, as above. The peg is listed in the part and in the group there, and is one body.
  assert_equal "$(surface nested.tar 'bodies().replace("; ", "\n")')" "Body [98.0, 10.0, 0.0] [100.0, 14.0, 1.0]
Peg [79.0, 0.0, 0.0] [80.0, 1.0, 5.0]
tube [0.0, 0.0, 0.0] [6.0, 6.0, 6.0]
Body [10.0, 100.0, 0.0] [14.0, 102.0, 1.0]
Peg [0.0, 120.0, 0.0] [1.0, 121.0, 5.0]
moved peg [0.0, 20.0, 50.0] [1.0, 21.0, 55.0]
Row_i0 [0.0, -50.0, 0.0] [1.0, -49.0, 5.0]
Row_i2 [10.0, -50.0, 0.0] [11.0, -49.0, 5.0]"
  # The hole goes through.
  assert_equal "$(surface nested.tar 'volumes()[2]')" 192.0
}

@test "FreeCAD's documents that are damaged, or lead nowhere, are refused; what no tool reads is named" {
  fcstd in-a-circle elsewhere without-shape damaged-shape cut-off short-array
  assert_fails_with 1 "in-a-circle.FCStd: expected at most 32 levels of groups and links, found more at 'second foot'" tessellate in-a-circle.FCStd
  assert_fails_with 1 "elsewhere.FCStd: expected feet/legs.FCStd, to which the link 'second foot' leads, found no such file" tessellate elsewhere.FCStd
  mkdir feet && cp "$DATA/legs.FCStd" feet
  tessellate elsewhere.FCStd -o elsewhere.tar
  assert_equal "$(surface elsewhere.tar 'len(names["regions"])')" 3
  assert_fails_with 1 "without-shape.FCStd: expected 'PartShape2.brp' in the FreeCAD file, found none" tessellate without-shape.FCStd
  assert_fails_with 1 "damaged-shape.FCStd: " tessellate damaged-shape.FCStd
  assert_fails_with 1 "cut-off.FCStd: expected well-formed XML in Document.xml, found: " tessellate cut-off.FCStd
  assert_fails_with 1 "short-array.FCStd: expected 3 places in PlacementList, found 171 bytes" tessellate short-array.FCStd
  head -c 3000 "$DATA/legs.FCStd" >cut.FCStd
  assert_fails_with 1 "cut.FCStd: expected a FreeCAD file that is whole, found a damaged zip archive: " tessellate cut.FCStd
  printf '%%PDF-1.5' >x.pdf
  assert_fails_with 1 "x.pdf: expected CAD in STEP, IGES, BREP or FreeCAD.s FCStd, found a PDF document$" tessellate x.pdf
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then
    assert_fails_with 1 "legs.FCStd: expected a surface in .*, found a FreeCAD file; 'tessellate .*legs.FCStd | tetmesh' meshes it" tetmesh "$DATA/legs.FCStd"
  fi
}
