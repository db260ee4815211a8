# tetmesh: surfaces as they come, good and bad, and every option.

load helpers

SURFACES="$PYTHON $DATA/surfaces.py"
CONTENTS="$PYTHON $CHECKERS/tet_contents.py"

# Small surfaces for all tests: $FILES/<name>.
setup_file() {
  load helpers
  export FILES="$BATS_FILE_TMPDIR"
  cd "$FILES"
  $PYTHON "$DATA/surfaces.py" samples
}

# stats_in FILE KEY
stats_in() {
  $PYTHON -c 'import json, sys; print(json.load(open(sys.argv[1]))[sys.argv[2]])' "$@"
}

# stats KEY: of the last run with --stats stats.json.
stats() {
  stats_in stats.json "$1"
}

# array BUNDLE MEMBER EXPRESSION: of the array a.
array() {
  $CONTENTS array "$@"
}

# regions BUNDLE: the tags and the volume of each region.
regions() {
  $CONTENTS regions "$1"
}

# bats test_tags=both
@test "the same surface from every format is the same mesh" {
  tetmesh "$FILES/cube.off" --surface keep --points none -o off.tar
  for file in cube.obj cube.ascii.ply cube.binary_little_endian.ply cube.binary_big_endian.ply; do
    tetmesh "$FILES/$file" --surface keep --points none -o other.tar
    assert_same_bytes off.tar other.tar
  done
  # STL tells points in another order.
  for file in cube.stl solid.stl cube.ascii.stl; do
    tetmesh "$FILES/$file" --surface keep --points none --stats stats.json -o stl.tar
    assert_equal "$(regions stl.tar)" 1:1
    assert_equal "$(stats surface_points)" 8
  done
}

# bats test_tags=both
@test "the surfaces in formats/README.md are the tet that they say" {
  $SURFACES documented "$HEXPIPE_SOURCE/formats/README.md"
  assert_equal "$(ls | tr '\n' ' ')" "tet.obj tet.off tet.ply tet.stl "
  for format in stl obj ply off; do
    tetmesh -q --surface keep --points none tet.$format -o tet.tar
    assert_equal "$(regions tet.tar)" 1:0.166666667
    local tags="[1, 1, 1, 1]"
    if [[ $format == stl || $format == obj ]]; then tags="[1, 2, 2, 2]"; fi
    assert_equal "$(array tet.tar mesh/triangle_tags.npy 'a.tolist()')" "$tags"
  done
}

# bats test_tags=optimized
@test "file, redirection, pipe and process substitution give the same bytes" {
  for file in cube.stl cube.ascii.stl cube.obj cube.off cube.ascii.ply cube.binary_big_endian.ply; do
    local surface="$FILES/$file"
    tetmesh -q --size 0.3 "$surface" -o file.tar
    tetmesh -q --size 0.3 <"$surface" >redirected.tar
    cat "$surface" | tetmesh -q --size 0.3 | cat >piped.tar
    tetmesh -q --size 0.3 <(cat "$surface") >substituted.tar
    tetmesh -q --size 0.3 - <"$surface" >dashed.tar
    for other in redirected piped substituted dashed; do assert_same_bytes file.tar $other.tar; done
  done
}

# bats test_tags=optimized
@test "1 and 2 threads, and two runs, give the same bytes" {
  tetmesh "$DATA/bracket.stl" --size 6 --threads 1 -o one.tar
  tetmesh "$DATA/bracket.stl" --size 6 --threads 2 -o two.tar
  tetmesh "$DATA/bracket.stl" --size 6 --threads 2 -o again.tar
  assert_same_bytes one.tar two.tar
  assert_same_bytes two.tar again.tar
}

# bats test_tags=optimized
@test "a real part: surface kept, volume right, conforming by the independent checker" {
  run_apart tetmesh "$DATA/bracket.stl" --surface keep --size 5 -o part.msh --stats stats.json
  assert_success
  assert_equal "$output$stderr" ""
  assert_equal "$(stats dropped_points)" 0
  assert_equal "$(stats surface_triangles)" 6370
  holds 'abs(stats["volume"] - 286808.4132332) < 1e-4' stats.json
  holds 'stats["points"] == stats["surface_points"] + stats["interior_points"] + stats["added_points"]' stats.json
  holds '0 < stats["least_dihedral"] < 60 and stats["greatest_dihedral"] < 180' stats.json
  assert_conforming part.msh
}

# bats test_tags=both
@test "a raw CAD tessellation with slivers" {
  tetmesh -q "$DATA/plate-holes.stl" --surface keep --size 3% -o plate.tar --stats stats.json
  assert_equal "$(stats surface_points)" 618
  assert_equal "$(regions plate.tar | cut -c 1-8)" 1:767362
}

# bats test_tags=optimized
@test "the same tessellation out of the axes, where TetGen fails in some orders of its input" {
  for turn in 1 2 3 4; do
    $SURFACES turned "$DATA/plate-holes.stl" $turn >turned.obj
    for points in none lattice; do
      tetmesh -q turned.obj --surface keep --points $points -o turned.tar --stats stats.json
      assert_equal "$(regions turned.tar | cut -c 1-8)" 1:767362
      stats tetgen_runs >>runs
    done
  done
  assert [ "$(sort -n runs | tail -1)" -gt 1 ]
}

# bats test_tags=both
@test "shells that nearly touch are filled, as near as TetGen can tell them apart" {
  for gap in 1e-8 1e-9 1e-12; do
    $SURFACES beside $gap 0.25 0.25 >near.obj
    tetmesh near.obj --size 0.25 -o near.mesh --stats stats.json
    assert_equal "$(stats surface_remeshed) $(stats regions)" "True 2"
    assert_conforming near.mesh
  done
}

# bats test_tags=both
@test "where TetGen fails on the new surface, the given one is kept, with a warning" {
  # New points on an edge of the one come within 4 steps of doubles to corners of the other.
  $SURFACES beside 8.9e-16 0.25 0.5 >near.obj
  run_apart tetmesh near.obj --size 0.25 --points none -o near.mesh --stats stats.json
  assert_success
  assert_equal "$(wc -l <<<"$stderr")" 1
  grep -q "^tetmesh: warning: the surface is kept as it is: near.obj: TetGen failed: " <<<"$stderr"
  assert_equal "$(stats surface_remeshed) $(stats surface_points)" "False 16"
}

@test "surfaces that bound nothing are named by triangle, with how many there are" {
  cd "$FILES"
  assert_fails_with 1 "^tetmesh: hole.stl: triangle [0-9]+: expected a closed surface, found 3 edges" tetmesh hole.stl
  assert_fails_with 1 "^tetmesh: flipped.stl: triangle 7: .* found 1 triangle flipped" tetmesh flipped.stl
  assert_fails_with 1 "^tetmesh: duplicated.stl: triangle 13: .* found 1 with the corners of another; the first repeats triangle 5" tetmesh --strict duplicated.stl
  assert_fails_with 1 "^tetmesh: intersecting.stl: triangle 3: .* found [0-9]+ pairs .* triangles 3 and" tetmesh intersecting.stl
  assert_fails_with 1 "^tetmesh: intersecting.obj:[0-9]+: .* lines [0-9]+ and [0-9]+" tetmesh intersecting.obj
  assert_fails_with 1 "^tetmesh: flat.stl: triangle 1: expected a closed surface, found" tetmesh flat.stl
  assert_fails_with 1 "^tetmesh: degenerate.stl: triangle 13: expected triangles with an area" tetmesh --strict degenerate.stl
  assert_fails_with 1 "^tetmesh: nan.stl: triangle 4: expected coordinates up to 1e\+50, found nan" tetmesh nan.stl
  assert_fails_with 1 "^tetmesh: inward.stl: triangle 1: expected a shell that points outward, found 12" tetmesh inward.stl
  assert_fails_with 1 "^tetmesh: zero.obj:4: expected a vertex index, counted from 1 .*, found '0'" tetmesh zero.obj
}

# volumes_of MESH: of each region, from its tets. Without meshio, which takes a third of a second to begin.
volumes_of() {
  $PYTHON - "$1" <<'PYTHON'
import sys
words = open(sys.argv[1]).read().split()
def rows(keyword, width):
    begin = words.index(keyword) + 2
    return (words[i:i + width] for i in range(begin, begin + width * int(words[begin - 1]), width))
points = [[float(x) for x in row[:3]] for row in rows("Vertices", 4)]
volumes = {}
for *tet, tag in rows("Tetrahedra", 5):
    origin, *corners = (points[int(vertex) - 1] for vertex in tet)
    (a, b, c), (d, e, f), (g, h, i) = ([x - y for x, y in zip(corner, origin)] for corner in corners)
    six = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    volumes[int(tag)] = volumes.get(int(tag), 0) + six / 6
print({tag: round(v, 9) for tag, v in sorted(volumes.items())})
PYTHON
}

# bats test_tags=both
@test "bodies that touch in a face, an edge or a corner, and rooms with a wall between them, are regions" {
  local name
  for name in edge-touch face-touch-two-bodies; do
    tetmesh -q "$DATA/touching/$name.off" --size 0.3 -o $name.mesh
    assert_equal "$(volumes_of $name.mesh)" "{1: 1.0, 2: 1.0}"
  done
  tetmesh -q "$DATA/touching/inner-wall.off" --size 0.3 -o wall.mesh
  assert_equal "$(volumes_of wall.mesh)" "{1: 0.5, 2: 0.5}"
  tetmesh -q "$FILES/corner.stl" --size 0.4 -o corner.mesh
  assert_equal "$(volumes_of corner.mesh)" "{1: 1.0, 2: 1.0}"
}

# bats test_tags=both
@test "an interface of two bodies is meshed once, and told" {
  run_apart tetmesh "$DATA/touching/face-touch-two-bodies.off" --size 0.3 --stats stats.json -o touch.tar
  assert_success
  assert_equal "$(stats surface_remeshed)" True
  assert_equal "$stderr" "tetmesh: warning: $DATA/touching/face-touch-two-bodies.off: bodies touch: they share 2 triangles that two of them had"
  findhex touch.tar | buildgraph | initsol --iterations 2000 | assemble -o touch.msh
  run $PYTHON "$CHECKERS/meshstats.py" --json touch.msh
  assert_output --partial '"is_conforming": true'
  # Both bodies are all hexes, which share quads across it.
  run $PYTHON - <<'PYTHON'
import meshio
mesh = meshio.read("touch.msh")
sides = {}
for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
    if block.type == "hexahedron":
        for cell, tag in zip(block.data, tags):
            for face in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
                sides.setdefault(frozenset(cell[list(face)].tolist()), set()).add(int(tag))
print(sum(s == {1, 2} for s in sides.values()), {block.type for block in mesh.cells})
PYTHON
  assert_line --regexp "^9 \{'(hexahedron', 'quad|quad', 'hexahedron)'\}$"
}

# bats test_tags=both
@test "a fin is told and goes" {
  run_apart tetmesh "$DATA/touching/fin-on-edge.off" --size 0.5 -o fin.mesh
  assert_success
  assert_equal "$stderr" "tetmesh: warning: $DATA/touching/fin-on-edge.off: a triangle with the same on both sides is left out"
  tetmesh "$DATA/cube.stl" --size 0.5 -o cube.mesh
  assert_equal "$(volumes_of fin.mesh)" "$(volumes_of cube.mesh)"
}

# baffle KIND OPTIONS...: KIND.obj, and from it KIND.msh, through the whole pipe.
baffle() {
  local kind=$1
  shift
  $PYTHON "$DATA/baffles.py" "$kind" >"$kind.obj"
  tetmesh "$kind.obj" --keep-baffles "$@" | findhex -q | buildgraph -q | initsol -q --iterations 100 | assemble -q -o "$kind.msh"
}

# inside MESH GROUP: the facets of a group by kind, what kinds of cells are on their sides, and their area.
inside() {
  $PYTHON - "$@" <<'PYTHON'
import collections, contextlib, io, sys
import meshio, numpy as np
with contextlib.redirect_stdout(io.StringIO()):
    mesh, name = meshio.read(sys.argv[1]), sys.argv[2]
faces = {"hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
         "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
         "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
         "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (0, 2, 5, 3))}
cells, regions, area, kinds = collections.Counter(), set(), 0, collections.Counter()
for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
    for face in faces.get(block.type, ()):
        for corners in block.data[:, list(face)]:
            cells[frozenset(corners.tolist())] += 1
    if block.type in faces:
        regions.update(tags.tolist())
for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
    if block.type not in ("triangle", "quad"):
        continue
    for corners in block.data[tags == mesh.field_data[name][0]]:
        kinds[block.type] += 1
        assert cells[frozenset(corners.tolist())] == 2, "a cell on both sides"
        p = mesh.points[corners]
        for i in range(2, len(p)):
            area += np.linalg.norm(np.cross(p[i - 1] - p[0], p[i] - p[0])) / 2
print(dict(kinds), f"{area:.4f}", len(regions))
PYTHON
}

# bats test_tags=optimized
@test "baffles are kept if asked for: hexes on both sides share their quads, and they keep their names" {
  local kind
  for kind in standing floating through-roof; do baffle "$kind" -q --size 0.5; done
  run inside standing.msh vane
  assert_output "{'quad': 32} 8.0000 1"
  run inside floating.msh vane
  assert_output "{'quad': 16} 4.0000 1"
  # What is outside goes.
  run inside through-roof.msh vane
  assert_output "{'quad': 16} 4.0000 1"
  # Without the option, there is none.
  tetmesh -q standing.obj --size 0.5 -o none.msh
  run ! grep -q vane none.msh
}

# bats test_tags=optimized
@test "baffles cross, bulge and close to a ring; the surface is made anew and each keeps its area" {
  baffle cross -q --size 0.5
  run inside cross.msh vane
  assert_output "{'quad': 32} 8.0000 1"
  run inside cross.msh fence
  assert_output "{'quad': 32} 8.0000 1"
  baffle tee -q --size 0.5
  run inside tee.msh fence
  assert_output "{'quad': 16} 4.0000 1"
  # A dome that is wider than its rim: a body with a hole, without the option.
  run_apart baffle dome --size 0.5
  assert_success
  assert_equal "$stderr" ""
  run inside dome.msh dome
  assert_output --regexp " 12\.6[0-9]+ 1$"
  assert_fails_with 1 "dome.obj:[0-9]+: expected a closed surface, found 4 edges of a single triangle" tetmesh dome.obj -o x.mesh
  # A flat ring between circles of 0.8 and 1.6: 5.96, less what chords of a size cut off.
  baffle ring -q --size 0.5
  run inside ring.msh strip
  assert_output --regexp " 5\.[789][0-9]+ 1$"
}

# bats test_tags=both
@test "baffles with --surface keep, on a lattice and in a bundle" {
  $PYTHON "$DATA/baffles.py" floating >floating.obj
  tetmesh floating.obj --keep-baffles --surface keep --points none -o kept.msh
  run inside kept.msh vane
  assert_output "{'triangle': 8} 4.0000 1"
  tetmesh floating.obj --keep-baffles --points lattice --size 1 -o lattice.msh
  run inside lattice.msh vane
  assert_output --regexp "^\{'triangle': [0-9]+\} 4.0000 1$"
}

@test "baffles that cannot be kept are refused or told" {
  local kind
  for kind in moebius crossing touching outside none through-roof; do $PYTHON "$DATA/baffles.py" "$kind" >"$kind.obj"; done
  assert_fails_with 1 "moebius.obj:[0-9]+: expected a baffle with two sides, found one that has a single side, like Möbius' strip$" tetmesh moebius.obj --keep-baffles
  for kind in crossing touching; do
    assert_fails_with 1 "$kind.obj:[0-9]+: expected a surface that does not intersect itself, found .*; a baffle shares whole edges with what it meets$" tetmesh "$kind.obj" --keep-baffles
  done
  run_apart tetmesh outside.obj --keep-baffles --size 2 -o outside.mesh
  assert_success
  assert_equal "$stderr" "tetmesh: warning: outside.obj: 8 triangles with the same on both sides are left out
tetmesh: warning: outside.obj: --keep-baffles finds no sheet that ends inside"
  run_apart tetmesh none.obj --keep-baffles --size 2 -o none.mesh
  assert_success
  assert_equal "$stderr" "tetmesh: warning: none.obj: --keep-baffles finds no sheet that ends inside"
  run_apart tetmesh through-roof.obj --keep-baffles --size 2 -o through-roof.mesh
  assert_success
  assert_equal "$stderr" "tetmesh: warning: through-roof.obj: 8 triangles with the same on both sides are left out"
  run tetmesh none.obj --keep-baffles --repair -o x.mesh
  assert_failure 2
  run tetmesh none.obj --keep-baffles --unite -o x.mesh
  assert_failure 2
}

@test "a body with a hole is no fin, wherever it touches another" {
  local touching="$DATA/touching"
  assert_fails_with 1 "edge-touch-hole.off:31: expected a closed surface, found 11 triangles that enclose a space with a hole; an edge of the hole is from \(4, 2, 2\) to \(4, 4, 2\) \(see --repair\)$" \
    tetmesh "$touching/edge-touch-hole.off"
  assert_fails_with 1 "fin-and-hole.off:12: expected a closed surface, found 12 triangles .* \(see --repair\)$" tetmesh "$touching/fin-and-hole.off"
  assert_fails_with 1 "vertex-touch-hole.off:32: expected a closed surface, found 3 edges .* \(see --repair\)$" tetmesh "$touching/vertex-touch-hole.off"
  # The edge of the wall hides one side of the hole, so it is not found.
  assert_fails_with 1 "wall-and-hole.off:17: expected a closed surface, found 5 triangles .* \(see wrap\)$" tetmesh "$touching/wall-and-hole.off" --repair
  tetmesh -q "$touching/edge-touch-hole.off" --repair --size 1 -o edge.mesh
  assert_equal "$(volumes_of edge.mesh)" "{1: 8.0, 2: 8.0}"
  tetmesh -q "$touching/vertex-touch-hole.off" --repair --size 1 -o vertex.mesh
  assert_equal "$(volumes_of vertex.mesh)" "{1: 8.0, 2: 1.0}"
  run_apart tetmesh "$touching/fin-and-hole.off" --repair --size 1 -o fin.mesh
  assert_success
  assert_regex "$stderr" "1 hole filled by 1 triangle.*a triangle with the same on both sides is left out"
  assert_equal "$(volumes_of fin.mesh)" "{1: 8.0}"
}

@test "where sheets meet, triangles that intersect name the next step, too" {
  # A cube with a fin, and a tet that sticks out of its side.
  printf 'v %s\n' "0.5 0.2 0.2" "1.5 0.2 0.2" "0.5 0.4 0.2" "0.5 0.2 0.4" >crossing.obj
  printf 'f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' >>crossing.obj
  awk 'NR == 2 { points = $1 } NR > 2 && NR <= 2 + points { print "v", $0 } NR > 2 + points && NR > 2 { print "f", $2 + 5, $3 + 5, $4 + 5 }' \
    "$DATA/touching/fin-on-edge.off" >>crossing.obj
  assert_fails_with 1 "crossing.obj:[0-9]+: .* pairs of triangles that do; .* \(see --repair\)$" tetmesh crossing.obj
  assert_fails_with 1 "crossing.obj:[0-9]+: .* pairs of triangles that do; .* \(see wrap\)$" tetmesh crossing.obj --repair
}

@test "3MF: placed objects in millimetres, named, with colours as groups" {
  python3 "$DATA/threemf.py" knobs.3mf
  tetmesh -q knobs.3mf --size 0.5 -o knobs.msh
  assert_equal "$(grep -oE '"(base|knob).*"' knobs.msh | sort | tr '\n' ' ')" '"base" "base_#00FF00" "knob" "knob" '
  tetmesh knobs.3mf --size 0.5 -o knobs.mesh
  assert_equal "$(volumes_of knobs.mesh)" "{1: 1.0, 2: 1.0, 3: 1.0}"
  python3 "$DATA/threemf.py" inch.3mf inch
  run_apart tetmesh inch.3mf --size 10 --points none --surface keep -o inch.mesh
  assert_success
  assert_equal "$stderr" "tetmesh: warning: inch.3mf: its unit, inch, became millimetres"
  # 25.4 to the third power
  assert_equal "$(volumes_of inch.mesh | grep -oE '[0-9]+\.[0-9]{2}' | sort -u)" "16387.06"
  head -c 900 knobs.3mf >cut.3mf
  assert_fails_with 1 "cut.3mf: expected a 3MF file that is whole, found a damaged zip archive: .*$" tetmesh cut.3mf
  python3 "$DATA/threemf.py" unit.3mf ell
  assert_fails_with 1 "unit.3mf: expected micron, millimeter, .* as the unit, found 'ell'$" tetmesh unit.3mf
}

@test "where sheets meet, --shells regions takes triangles of any orientation" {
  sed '0,/^3 0 2 1/s//3 0 1 2/' "$DATA/touching/inner-wall.off" >turned.off
  assert_fails_with 1 "turned.off:11: expected triangles that point outward where sheets meet, found 1 that" tetmesh turned.off -o x.mesh
  tetmesh -q turned.off --shells regions --size 0.3 -o turned.mesh
  assert_equal "$(volumes_of turned.mesh)" "{1: 0.5, 2: 0.5}"
  assert_fails_with 1 "expected --shells oriented or regions" tetmesh turned.off --shells holes -o x.mesh
}

@test "a fault that --repair mends is told with it, until it is tried" {
  cd "$FILES"
  for name in hole flipped duplicated degenerate; do
    assert_fails_with 1 " \(see --repair\)$" tetmesh --strict $name.stl
    tetmesh -q $name.stl --repair --surface keep --points none -o "$BATS_TEST_TMPDIR/out.tar"
  done
  assert_fails_with 1 "found [0-9]+ pairs .* \(see --repair\)$" tetmesh --strict "$DATA/readers/folded-sliver.off"
  assert_fails_with 1 "found [0-9]+ pairs .* \(see --unite\)$" tetmesh --repair intersecting.stl
  assert_fails_with 1 "found 3 edges of .*\)$" tetmesh hole.stl --repair --largest-hole 0
  run tetmesh hole.stl --repair --largest-hole 0
  refute_output --partial "see --repair"
  assert_output --partial "(see wrap)"
}

# The unit tests and the fuzzers read such files.
# bats test_tags=optimized
@test "surfaces are read as other programs write them" {
  # same_volume FILE: as the cube of 12 triangles has it
  same_volume() {
    run_apart tetmesh "$1" --surface keep --points none -o found.mesh
    assert_success
    assert_equal "$(volumes_of found.mesh)" "{1: 1.0}"
  }
  same_volume "$DATA/readers/binary-stl-trailing-byte.stl"
  assert_equal "$stderr" "tetmesh: warning: $DATA/readers/binary-stl-trailing-byte.stl: left out 1 byte behind the last of 12 facets"
  for file in "$DATA"/readers/{stl-end-solid.stl,medit-surface.mesh}; do
    same_volume "$file"
    assert_equal "$stderr" ""
  done
  cd "$FILES"
  for file in cube.stl solid.stl cube.ascii.stl cube.obj cube.off cube.*.ply; do
    gzip -c "$file" >"$BATS_TEST_TMPDIR/$file.gz"
    same_volume "$BATS_TEST_TMPDIR/$file.gz"
    tetmesh -q --surface keep --points none -o "$BATS_TEST_TMPDIR/piped.mesh" <"$BATS_TEST_TMPDIR/$file.gz"
    assert_same_bytes found.mesh "$BATS_TEST_TMPDIR/piped.mesh"
  done
  cd "$BATS_TEST_TMPDIR"
  for file in cube.ascii.stl cube.obj cube.off; do
    tr '\n' '\r' <"$FILES/$file" >"$file"
    same_volume "$file"
    for code in LE BE; do
      { printf '\ufeff' && cat "$FILES/$file"; } | iconv -f UTF-8 -t "UTF-16$code" >"$file"
      same_volume "$file"
    done
  done
  { printf OFF && tail -n +2 "$FILES/cube.off"; } >touching.off
  same_volume touching.off
  # Nastran's and Abaqus' shells
  printf 'GRID,%d,,%s\n' 1 0.,0.,0. 2 1.,0.,0. 3 0.,1.,0. 4 0.,0.,1. >tet.bdf
  printf 'CTRIA3,%d,1,%s\n' 1 1,3,2 2 1,2,4 3 2,3,4 4 1,4,3 >>tet.bdf
  tetmesh -q tet.bdf --surface keep --points none -o tet.mesh
  assert_equal "$(volumes_of tet.mesh)" "{1: 0.166666667}"
  assert_fails_with 1 "^tetmesh: cut.gz: expected the rest of a gzip file" shell 'gzip -c "'"$FILES"'/cube.obj" | head -c 60 >cut.gz; tetmesh cut.gz'
}

# bats test_tags=optimized
@test "surfaces come in mesh formats, too" {
  for format in mesh msh msh-binary msh22 msh22-binary vtk vtu; do
    mesh_convert "$DATA/readers/medit-surface.mesh" $format surface.$format
    tetmesh -q surface.$format --surface keep --points none -o found.mesh
    assert_equal "$(volumes_of found.mesh)" "{1: 1.0}"
  done
  $PYTHON - "$FILES/cube.obj" <<'END'
import sys, vtk
reader = vtk.vtkOBJReader()
reader.SetFileName(sys.argv[1])
strips = vtk.vtkStripper()
strips.SetInputConnection(reader.GetOutputPort())
for name, source in (("plain", reader), ("strips", strips)):
    for writer, ending in ((vtk.vtkXMLPolyDataWriter(), "vtp"), (vtk.vtkPolyDataWriter(), "vtk")):
        writer.SetInputConnection(source.GetOutputPort())
        writer.SetFileName(f"{name}.{ending}")
        writer.Write()
END
  for name in plain.vtp plain.vtk strips.vtp strips.vtk; do
    tetmesh -q $name --surface keep --points none -o found.mesh
    assert_equal "$(volumes_of found.mesh)" "{1: 1.0}"
  done
}

@test "missing, empty and other input" {
  : >empty
  assert_fails_with 1 "^tetmesh: missing.stl: .*No such file" tetmesh missing.stl
  assert_fails_with 1 "^tetmesh: empty: expected a surface .*empty" tetmesh empty
  assert_fails_with 1 "^tetmesh: stdin: expected a surface .*empty" shell ": | tetmesh"
  assert_fails_with 1 "^tetmesh: \.: .*directory" tetmesh .
  tetmesh -q "$FILES/cube.stl" --size 0.5 -o bundle.tar
  assert_fails_with 1 "^tetmesh: bundle.tar: expected a bundle with a surface, found one with a mesh; findhex takes it" tetmesh bundle.tar
  tetmesh -q "$FILES/cube.stl" --size 0.5 -o bundle.tar.zst
  assert_fails_with 1 "^tetmesh: bundle.tar.zst: expected a bundle with a surface, found one with a mesh; findhex takes it" tetmesh bundle.tar.zst
}

# The unit tests of the readers try every length.
# bats test_tags=both
@test "a surface cut anywhere is an error and leaves nothing" {
  local cuts=40
  if sanitized; then cuts=12; fi
  for file in cube.stl solid.stl cube.ascii.stl cube.obj cube.off cube.ascii.ply cube.binary_little_endian.ply cube.binary_big_endian.ply; do
    local size length
    size=$(stat -c %s "$FILES/$file")
    # A text may lose its last line end, ASCII STL also the name after endsolid.
    case $file in
      *.ascii.stl) size=$((size - 4)) ;;
      *.obj | *.off | *.ascii.ply) size=$((size - 1)) ;;
    esac
    for ((length = 0; length < size; length += 1 + size / cuts)); do
      if head -c $length "$FILES/$file" | tetmesh -q --points none -o out.mesh 2>message; then
        fail "$file: took $length of $size bytes"
      fi
      assert_equal "$(wc -l <message)" 1
    done
    # The last that is missing.
    if head -c $((size - 1)) "$FILES/$file" | tetmesh -q --points none -o out.mesh 2>message; then
      fail "$file: took $((size - 1)) of $size bytes"
    fi
  done
  assert_equal "$(ls)" message
}

@test "bad options end with 2" {
  local cube="$FILES/cube.stl"
  for size in 0 -1 abc 3mm nan; do assert_fails_with 2 "^tetmesh: .*$size" tetmesh "$cube" --size $size; done
  assert_fails_with 2 "^tetmesh: .*points" tetmesh "$cube" --points some
  assert_fails_with 2 "^tetmesh: .*clearance" tetmesh "$cube" --clearance 0
  assert_fails_with 2 "^tetmesh: .*jitter" tetmesh "$cube" --jitter -1
  assert_fails_with 2 "^tetmesh: expected --jitter below half of --clearance" tetmesh "$cube" --jitter 0.3
  assert_fails_with 2 "^tetmesh: .*shells" tetmesh "$cube" --shells some
  assert_fails_with 2 "^tetmesh: .*tetgen-timeout" tetmesh "$cube" --tetgen-timeout 0
  assert_fails_with 2 "^tetmesh: .*seed" tetmesh "$cube" --seed x
}

@test "an option of NaN and an empty size end with 2" {
  local cube="$FILES/cube.stl"
  for option in clearance jitter tetgen-timeout; do
    assert_fails_with 2 "^tetmesh: .*--$option: expected a number .*nan" timeout 120 tetmesh "$cube" --$option nan
  done
  assert_fails_with 2 "^tetmesh: expected a positive length .*''" tetmesh "$cube" --size ""
}

@test "an output that cannot be written is told before TetGen starts" {
  assert_fails_with 1 "^tetmesh: nowhere/x.mesh: cannot write: No such file" \
    tetmesh "$FILES/fine.stl" --size 0.02 --tetgen-timeout 0.001 -o nowhere/x.mesh
}

@test "a size of which the box holds too many points is an error, at once" {
  assert_fails_with 1 "^tetmesh: .*cube.stl: expected a size .*1e-06" timeout 120 tetmesh "$FILES/cube.stl" --size 1e-6
}

# bats test_tags=optimized
@test "every option changes something" {
  local fine="$FILES/fine.stl"
  tetmesh "$fine" --size 0.2 -o base.mesh
  tetmesh "$fine" --size 0.15 -o size.mesh
  tetmesh "$fine" --size 0.2 --seed 2 -o seed.mesh
  tetmesh "$fine" --size 0.2 --jitter 0.1 -o jitter.mesh
  tetmesh "$fine" --size 0.2 --clearance 1.1 -o clearance.mesh
  tetmesh "$fine" --size 0.2 --points none -o points.mesh
  tetmesh "$fine" --size 0.2 --surface keep -o surface.mesh
  for option in size seed jitter clearance points surface; do assert_different_bytes base.mesh $option.mesh; done
  # The same size as a percentage of the diagonal, and the default, which is the surface's own spacing.
  tetmesh "$fine" --size 11.547005383792515% -o percent.mesh --stats stats.json
  $PYTHON -c "assert abs($(stats size) - 0.2) < 1e-9"
  tetmesh "$fine" -o default.mesh --stats stats.json
  $PYTHON -c "assert 0.05 < $(stats size) < 0.06, '6,000 cubes'"
  assert_fails_with 1 "TetGen failed: it took longer than --tetgen-timeout" tetmesh "$fine" --size 0.02 --tetgen-timeout 0.001 -q
}

# bats test_tags=optimized
@test "a size of its own is one of several, unless nearly all becomes hexes at once" {
  local part="$DATA/plate-holes.stl"
  tetmesh -q "$part" -o own.mesh --stats own.json
  tetmesh -q "$part" --tries 1 -o once.mesh --stats once.json
  holds '[round(t["size"] / once["size"], 6) for t in own["tried"]] == [1, 0.95]' own.json once.json
  holds 'own["size"] == max(own["tried"], key=lambda t: t["estimated_hex_share"])["size"]' own.json
  holds '"tried" not in once' once.json
  tetmesh -q "$DATA/cube.stl" -o cube.mesh --stats cube.json
  holds 'len(cube["tried"]) == 1 and cube["tried"][0]["estimated_hex_share"] > 0.96' cube.json
  # A size that was asked for stays.
  for option in '--size 0.2' '--curvature 12' '--layers 2'; do
    tetmesh -q "$DATA/cube.stl" $option -o asked.mesh --stats asked.json
    holds '"tried" not in asked' asked.json
  done
}

# bats test_tags=optimized
@test "--stats tells where rows end, and the bundle has the lines inside" {
  local part="$DATA/plate-holes.stl"
  tetmesh -q "$part" --size 11 --points frame -o frame.tar --stats stats.json
  $PYTHON -c "assert $(stats row_ends) > 0"
  $PYTHON -c "d = $(stats dislocations); assert d['length'] > 0 and d['surface_ends'] > 0, d
assert d['at_singularities'] + d['closed'] <= d['length'], d"
  assert_equal "$(array frame.tar mesh/dislocations.npy 'a.shape[1]')" 6
  # In sizes; a line along which several rows end counts as many times.
  local length=$(array frame.tar mesh/dislocations.npy 'float((((a[:, :3] - a[:, 3:]) ** 2).sum(axis=1) ** 0.5).sum()) / 11')
  $PYTHON -c "assert 0 < $length <= $(stats dislocations)['length'] * 1.000001"
  findhex -q frame.tar -o candidates.tar
  assert_equal "$(array candidates.tar mesh/dislocations.npy 'a.tolist()')" "$(array frame.tar mesh/dislocations.npy 'a.tolist()')"
  tetmesh -q "$part" --size 11 --points lattice -o lattice.tar --stats stats.json
  run tar tf lattice.tar
  refute_line mesh/dislocations.npy
  run stats dislocations
  assert_failure
}

# A block with a step 0.03 high.
@test "--short-features takes out a step that is too low for the size, and the poor cells at it" {
  cat >step.obj <<'EOF'
v 0 0 0
v 4 0 0
v 4 2 0
v 2 2 0
v 2 2.03 0
v 0 2.03 0
v 0 0 4
v 4 0 4
v 4 2 4
v 2 2 4
v 2 2.03 4
v 0 2.03 4
f 1 2 8 7
f 2 3 9 8
f 3 4 10 9
f 4 5 11 10
f 5 6 12 11
f 6 1 7 12
f 6 5 4 3 2 1
f 7 8 9 10 11 12
EOF
  # mesh OPTIONS...: writes stats.json and cells.json
  mesh() {
    tetmesh -q step.obj --size 0.5 "$@" --stats stats.json | findhex -q | buildgraph -q | initsol -q | lns -q |
      assemble -q -o step.vtu --stats cells.json
  }
  only_hexes='all(kind == "hex" or of["count"] == 0 for kind, of in cells["cells"].items())'
  mesh --short-features 0.05 # it is longer
  holds "stats['short_features'] == 0 and not ($only_hexes)" stats.json cells.json
  mesh --short-features 0.08
  holds "stats['short_features'] == 2 and $only_hexes and cells['cells']['hex']['count'] == 256" stats.json cells.json
  holds 'stats["surface_remeshed"] and 0.029 < stats["distance_from_input"] < 0.0301' stats.json
  assert_fails_with 2 "^tetmesh: .*short-features" tetmesh step.obj --short-features 0.3
}

# bats test_tags=optimized
@test "--stretch joins rows on faces with features, as far as it may" {
  local part="$DATA/plate-holes.stl"
  tetmesh -q "$part" --size 11 --points none -o base.mesh
  tetmesh -q "$part" --size 11 --points none --stretch 0 -o zero.mesh
  assert_same_bytes base.mesh zero.mesh
  tetmesh -q "$part" --size 11 --points none --stretch 1e-6 -o least.mesh
  tetmesh -q "$part" --size 11 --points none --stretch 0.6 -o joined.mesh --stats stats.json
  assert_equal "$(stats surface_remeshed)" True
  assert_different_bytes base.mesh joined.mesh
  assert_different_bytes least.mesh joined.mesh
  assert_fails_with 2 "^tetmesh: .*stretch" tetmesh "$part" --stretch -1
}

# bats test_tags=optimized
@test "--feature-angle and --deviation say what of a surface stays" {
  local part="$DATA/bracket.stl"
  tetmesh -q "$part" --size 8 --points none -o base.mesh --stats stats.json
  local points=$(stats surface_points)
  tetmesh -q "$part" --size 8 --points none --feature-angle 100 -o angle.mesh
  assert_different_bytes base.mesh angle.mesh
  for deviation in 0.15 0.02; do
    tetmesh -q "$part" --size 8 --points none --deviation $deviation -o near.mesh --stats stats.json
    assert_equal "$(stats surface_remeshed)" True
    $PYTHON -c "assert 0 < $(stats distance_to_input) <= 8 * $deviation * 1.001"
    $PYTHON -c "assert 0 < $(stats distance_from_input) <= 8 * $deviation * 1.001"
  done
  assert [ "$(stats surface_points)" -gt $points ]
  assert_fails_with 2 "^tetmesh: .*feature-angle" tetmesh "$part" --feature-angle 0
  assert_fails_with 2 "^tetmesh: .*deviation" tetmesh "$part" --deviation 2
  assert_fails_with 2 "^tetmesh: .*surface" tetmesh "$part" --surface new
}

# bats test_tags=both
@test "remeshing takes little off a part that is thinner than a size" {
  $SURFACES wedge >wedge.off
  tetmesh -q wedge.off --size 25% --points none --stats stats.json -o wedge.mesh
  assert_equal "$(stats surface_remeshed)" True
  tetmesh -q wedge.off --size 25% --points none --surface keep --stats kept.json -o kept.mesh
  holds 'stats["volume"] > 0.95 * kept["volume"]' stats.json kept.json
}

# bats test_tags=both
@test "a surface is made anew: coarse, fine, of slivers, with its tags, and by the independent checker" {
  for part in bracket.stl plate-holes.stl notch.stl; do
    tetmesh -q "$DATA/$part" --size 5% --points none -o part.mesh --stats stats.json
    assert_equal "$(stats surface_remeshed)" True
    assert_conforming part.mesh
  done
  tetmesh -q "$FILES/attributes.stl" --size 0.25 -o out.tar
  assert_equal "$(array out.tar mesh/triangle_tags.npy '[int((a == k).sum()) for k in (5, 9)]')" "[64, 128]"
}

@test "coordinates beyond what products of them hold are told by their size" {
  for scale in 1e200 1e-200; do
    awk -v scale=$scale '$1 == "v" { print "v", $2 * scale, $3 * scale, $4 * scale; next } { print }' "$FILES/cube.obj" >scaled.obj
    assert_fails_with 1 "^tetmesh: scaled.obj: expected .*1e[+-]200; scale the surface" tetmesh scaled.obj
  done
}

@test "more points than --most-points are an error before memory is used" {
  assert_fails_with 1 "expected a size .* at most 100 points inside \(see --most-points\), found 0.1, which makes about 1e\+03" \
    tetmesh "$FILES/fine.stl" --size 0.1 --most-points 100
  assert_fails_with 1 "see --most-points.*1e-90.*1e\+270" timeout 120 tetmesh "$FILES/cube.stl" --size 1e-90
  tetmesh -q "$FILES/fine.stl" --size 0.1 --most-points 2000 -o out.tar
}

# bats test_tags=optimized
@test "far more points than --most-points are told before any is placed where sizes differ by place, too" {
  $SURFACES sized
  for _ in 1 2 3 4 5 6 7 8; do echo 1e-4; done >fine.txt
  assert_fails_with 1 "^tetmesh: cube.obj: expected sizes that make at most 1e\+06 points inside .* 0.0001 to 2, which make more than 4e\+06" \
    timeout 120 tetmesh cube.obj --size 2 --size-field fine.txt --most-points 1e6
}

@test "--most-points counts points of the user's own" {
  printf '.2 .2 .2\n.5 .5 .5\n' >two.xyz
  assert_fails_with 1 "^tetmesh: two.xyz: expected at most 1 points \(see --most-points\), found 2" \
    tetmesh "$FILES/cube.stl" --points two.xyz --most-points 1
}

@test "a file of no points is an error" {
  : >none.xyz
  assert_fails_with 1 "^tetmesh: none.xyz: expected points, found none" tetmesh "$FILES/cube.stl" --points none.xyz
}

@test "an option that does nothing beside the others ends with 2" {
  local cube="$FILES/cube.obj"
  echo 0.5 0.5 0.5 >own.xyz
  echo 0 0 0 0.5 >sizes.txt
  refused() {
    assert_fails_with 2 "^tetmesh: $1 does nothing $2$" tetmesh "$cube" "${@:3}"
  }
  refused --weld "without --repair" --weld 1
  refused --largest-hole "without --repair" --largest-hole 3
  refused --least-size "without --curvature" --least-size 0.1
  refused --grading "without --size-field, --layers, --curvature or a --size at a place" --grading 0.1
  refused --deviation "with --surface keep" --surface keep --deviation 0.1
  refused --short-features "with --surface keep" --surface keep --short-features 0.05
  refused --stretch "with --surface keep" --surface keep --stretch 0.5
  for points in none own.xyz; do
    refused --jitter "with --points $points" --points $points --jitter 0.1
    refused --clearance "with --points $points" --points $points --clearance 1
    refused --feature-angle "with --surface keep and --points $points" --surface keep --points $points --feature-angle 9
  done
  refused --layers "with --surface keep and --points none" --surface keep --points none --layers
  refused --size-field "with --surface keep and --points none" --surface keep --points none --size-field sizes.txt
  tetmesh -q "$cube" --size 0.5 --grading 0.1 --layers -o both.mesh
}

@test "the word behind --layers is the surface where it is no number" {
  cp "$FILES/cube.obj" part.obj
  tetmesh -q part.obj --size 1.5 --layers 2 -o two.tar
  tetmesh -q --size 1.5 --layers part.obj -o behind.tar
  assert_same_bytes two.tar behind.tar
  tetmesh -q --size 1.5 --layers - -o stdin.tar <part.obj
  assert_same_bytes <(tar xOf two.tar mesh/tets.npy) <(tar xOf stdin.tar mesh/tets.npy)
  assert_fails_with 2 "layers: Value 200 " tetmesh --layers 200 part.obj
  assert_fails_with 2 "layers: Value 2.5 " tetmesh --layers 2.5 part.obj
}

# bats test_tags=both
@test "faults that change no shape are mended with one warning, unless --strict refuses them" {
  cp "$DATA/readers/stray-triangle.off" "$DATA/readers/t-junctions.off" .
  $PYTHON - "$FILES/cube.stl" copies.stl <<'END'
import struct, sys
data = open(sys.argv[1], "rb").read()
flat = struct.pack("<12fH", 0, 0, 0, 0, 0, 0, .5, 0, 0, 1, 0, 0, 0)
open(sys.argv[2], "wb").write(data[:80] + struct.pack("<I", 14) + data[84:] + data[84:134] + flat)
END
  declare -A said=(
    [stray-triangle.off]="1 stray triangle removed"
    [t-junctions.off]="1 point on an edge of another triangle joined to it"
    [copies.stl]="1 triangle without area removed, 1 repeated triangle removed")
  for name in "${!said[@]}"; do
    assert_fails_with 1 "^tetmesh: $name:.* \(see --repair\)$" tetmesh --strict "$name"
    run_apart tetmesh "$name" --size 0.3 -o mended.mesh --stats stats.json
    assert_success
    assert_equal "$stderr" "tetmesh: warning: $name: mended: ${said[$name]} (see --strict)"
    assert_conforming mended.mesh
    assert_equal "$(volumes_of mended.mesh)" "{1: 1.0}"
  done
  run_apart tetmesh "$DATA/cube.stl" --size 0.3 -o good.mesh --stats stats.json
  assert_equal "$stderr" ""
  holds '"repair" not in stats' stats.json
  assert_fails_with 2 "repair excludes --strict" tetmesh --strict --repair "$DATA/cube.stl"
}

# bats test_tags=both
@test "--repair makes triangles anew where few intersect" {
  run_apart tetmesh "$DATA/readers/folded-sliver.off" --repair --size 0.3 -o folded.mesh
  assert_success
  assert_equal "$stderr" "tetmesh: warning: $DATA/readers/folded-sliver.off: repaired: 1 self-intersection mended by 4 triangles made anew"
  assert_conforming folded.mesh
  assert_equal "$(volumes_of folded.mesh)" "{1: 1.0}"
}

# bats test_tags=both
@test "triangles that intersect are made anew without --repair where they stay near" {
  run_apart tetmesh "$DATA/readers/folded-sliver.off" --size 0.3 -o folded.mesh --stats stats.json
  assert_success
  assert_equal "$stderr" "tetmesh: warning: $DATA/readers/folded-sliver.off: mended: 1 self-intersection mended by 4 triangles made anew (see --strict)"
  holds 'stats["repair"]["mended_folds"] == 1' stats.json
  assert_conforming folded.mesh
  assert_equal "$(volumes_of folded.mesh)" "{1: 1.0}"
  # More than a hundredth of the size that suits it.
  sed 's/0.99999/0.998/' "$DATA/readers/folded-sliver.off" >deep.off
  assert_fails_with 1 "^tetmesh: deep.off:[0-9]+: expected a surface that does not intersect itself, found [0-9]+ pairs .* \(see --repair\)$" tetmesh deep.off
  tetmesh -q deep.off --repair --size 0.3 -o deep.mesh
}

# bats test_tags=both
@test "--unite makes one body of bodies that overlap" {
  local boxes="$DATA/readers/overlapping-bodies.off"
  assert_fails_with 1 "overlapping-bodies.off:21: .* found 14 pairs of triangles that do.*\(see --unite\)$" tetmesh "$boxes"
  assert_fails_with 1 "overlapping-bodies.off:21: .* found 14 pairs of triangles that do.*\(see --unite\)$" tetmesh "$boxes" --repair
  run_apart tetmesh "$boxes" --unite --size 0.2 -o united.mesh --stats stats.json
  assert_success
  assert_equal "$stderr" "tetmesh: warning: $boxes: united 2 bodies that overlap"
  assert_conforming united.mesh
  # 2 - 0.5 * 0.7 * 0.8
  assert_equal "$(volumes_of united.mesh)" "{1: 1.72}"
  holds 'stats["united_bodies"] == 2 and stats["regions"] == 1' stats.json
  # The tags are those of the bodies.
  printf 'v %s\n' "0 0 0" "1 0 0" "0 1 0" "0 0 1" "0.2 0.2 0.2" "1.2 0.2 0.2" "0.2 1.2 0.2" "0.2 0.2 1.2" >tets.obj
  printf 'g one\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\ng two\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n' >>tets.obj
  tetmesh -q tets.obj --unite --surface keep --points none -o tets.msh
  assert_equal "$(grep -cE '^2 [0-9]+ "(one|two)"' tets.msh)" 2
  # What does not overlap stays; what is open or points inward is refused if it overlaps.
  run_apart tetmesh "$FILES/apart.stl" --unite --size 0.5 -o apart.mesh
  assert_success
  assert_equal "$stderr" ""
  sed '$d' tets.obj >open.obj
  assert_fails_with 1 "open.obj:[0-9]+: expected closed bodies that point outward for --unite, found an open one" tetmesh open.obj --unite
  sed -E 's/^f 5 7 6/f 5 6 7/; s/^f 5 6 8/f 5 8 6/; s/^f 6 7 8/f 6 8 7/; s/^f 5 8 7/f 5 7 8/' tets.obj >inward.obj
  assert_fails_with 1 "inward.obj:[0-9]+: expected closed bodies that point outward for --unite, found one that points inward" tetmesh inward.obj --unite
}

# bats test_tags=optimized
@test "--repair mends what is an error without it, and says so" {
  cd "$FILES"
  for file in hole flipped duplicated degenerate inward; do
    run tetmesh --strict $file.stl -o "$BATS_TEST_TMPDIR/out.tar"
    assert_failure 1
    run_apart tetmesh $file.stl --repair --size 0.5 -o "$BATS_TEST_TMPDIR/out.tar" --stats "$BATS_TEST_TMPDIR/stats.json"
    assert_success
    assert_equal "$(regions "$BATS_TEST_TMPDIR/out.tar")" 1:1
    echo "$stderr" >>"$BATS_TEST_TMPDIR/said"
    cp "$BATS_TEST_TMPDIR/stats.json" "$BATS_TEST_TMPDIR/$file.json"
  done
  assert_equal "$(grep -c "^tetmesh: warning: .*.stl: repaired: 1*[0-9] .*" "$BATS_TEST_TMPDIR/said")" 5
  grep -q "hole.stl: repaired: 1 hole filled by 1 triangle$" "$BATS_TEST_TMPDIR/said"
  cd "$BATS_TEST_TMPDIR"
  # Each act by its count, and no other.
  acts() {
    holds "{act: count for act, count in $1['repair'].items() if count} == $2" "$1.json"
  }
  acts hole '{"filled_holes": 1, "hole_triangles": 1}'
  acts flipped '{"turned_triangles": 1}'
  acts duplicated '{"duplicate_triangles": 1}'
  acts degenerate '{"degenerate_triangles": 1}'
  acts inward '{"turned_triangles": 12}'
  assert_fails_with 1 "hole.stl: triangle .* closed surface" tetmesh "$FILES/hole.stl" --repair --largest-hole 2
  # Corners that miss each other by 1e-5.
  awk '$1 == "vertex" && $2 == 1 && n++ % 2 { $2 = 1.00001 } { print }' "$FILES/cube.ascii.stl" >loose.stl
  assert_fails_with 1 "loose.stl:.* closed surface" tetmesh loose.stl
  assert_fails_with 1 "loose.stl:" tetmesh loose.stl --repair -q
  tetmesh loose.stl --repair --weld 0.01% -q --size 0.5 -o out.tar --stats stats.json
  holds 'stats["repair"]["welded_points"] > 0' stats.json
}

# bats test_tags=both
@test "points of the user's own, in every format, kept to the last bit" {
  $SURFACES points
  local cube="$FILES/cube.stl"
  { printf '\xef\xbb\xbf' && cat points.ply; } >points.marked.ply
  for format in npy xyz node ply marked.ply; do
    tetmesh "$cube" --surface keep --size 0.3 --points points.$format -o $format.tar -q --stats stats.json
    assert_equal "$(stats points_kept) $(stats interior_points) $(stats dropped_points)" "given 50 0"
    assert_equal "$(array $format.tar mesh/points.npy '(a[8:58] == np.load("points.npy")).all()')" True
  done
  run_apart tetmesh "$cube" --surface keep --size 0.3 --points outside.xyz -o out.tar
  assert_success
  # One warning hides no other.
  assert_equal "$(wc -l <<<"$stderr")" 2
  grep -q "^tetmesh: warning: 100 % of the surface lies in triangles with edges much longer than the size" <<<"$stderr"
  grep -q "^tetmesh: warning: outside.xyz:2: left out 3 of 4 points, which are outside" <<<"$stderr"
  assert_fails_with 1 "^tetmesh: bad.xyz:2: expected a finite coordinate, found 'x'" tetmesh "$cube" --points bad.xyz
  assert_fails_with 1 "^tetmesh: cut.xyz: expected the last line to have an end, found none; is the file cut off" tetmesh "$cube" --points cut.xyz
  assert_fails_with 1 "^tetmesh: short.node:" tetmesh "$cube" --points short.node
  assert_fails_with 1 "^tetmesh: flat.npy: expected an array of floats with three columns" tetmesh "$cube" --points flat.npy
  assert_fails_with 2 "^tetmesh: expected --points .* or a file, found 'nowhere.xyz'" tetmesh "$cube" --points nowhere.xyz
}

@test "points of the user's own that TetGen merges are told" {
  printf '.3 .3 .3\n.5 .5 .5\n.5 .5 .5000000001\n' >near.xyz
  run_apart tetmesh "$FILES/cube.stl" --size 0.5 --points near.xyz -o near.mesh
  assert_success
  assert_equal "$stderr" "tetmesh: warning: near.xyz: TetGen left out 1 of 3 points inside, too near to others"
}

# bats test_tags=optimized
@test "best keeps the points of which more is estimated to become hexes" {
  local part="$DATA/bracket.stl"
  for points in best frame lattice; do tetmesh -q "$part" --size 8 --points $points -o $points.mesh --stats $points.json; done
  assert_different_bytes frame.mesh lattice.mesh
  local better
  better=$($PYTHON -c "share = $(stats_in best.json estimated_hex_share); print(max(share, key=share.get))")
  holds "all(0 < best['estimated_hex_share'][kind] < 1 for kind in ('lattice', 'frame'))" best.json
  holds "best['points_kept'] == '$better'" best.json
  assert_same_bytes best.mesh $better.mesh
  for points in frame lattice; do
    holds "$points['points_kept'] == '$points' and 'estimated_hex_share' not in $points" $points.json
  done
}

# bats test_tags=both
@test "best keeps other points in one body than in another where that is estimated to be the best" {
  # A box turned by half a radian, and a prism of six sides.
  $PYTHON - >two.off <<'PYTHON'
import math
cosine, sine = math.cos(0.5), math.sin(0.5)
points = [(cosine * x - sine * y, sine * x + cosine * y, z) for z in (0, 2) for y in (0, 2) for x in (0, 3)]
triangles = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
points += [(1.5 * math.cos(math.pi * k / 3) - 4, 1.5 * math.sin(math.pi * k / 3), z) for z in (0, 2) for k in range(6)] + [(-4, 0, 0), (-4, 0, 2)]
for k in range(6):
    l = (k + 1) % 6
    triangles += [(8 + a, 8 + b, 8 + c) for a, b, c in ((k, l, 6 + l), (k, 6 + l, 6 + k), (12, l, k), (13, 6 + k, 6 + l))]
print("OFF")
print(len(points), len(triangles), 0)
for p in points: print(*p)
for t in triangles: print(3, *t)
PYTHON
  local size surface best
  for size in 0.4 0.5; do
    for surface in remesh keep; do
      tetmesh -q two.off --size $size --surface $surface -o two.mesh --stats two.json
      best=$($PYTHON -c "share = $(stats_in two.json estimated_hex_share); print(max(share, key=share.get))")
      holds "two['points_kept'] == '$best'" two.json
      cat two.json >>all.json
    done
  done
  grep -q '"points_kept": "mixed"' all.json
  grep -q '"points_kept": "frame"' all.json
}

# bats test_tags=optimized
@test "--tries keeps the size of which most is estimated to become hexes" {
  local part="$DATA/bracket.stl"
  tetmesh -q "$part" --size 10 -o once.mesh --stats once.json
  tetmesh -q "$part" --size 10 --tries 4 -o tried.mesh --stats tried.json
  tetmesh -q "$part" --size 10 --tries 4 --threads 1 -o again.mesh
  assert_same_bytes tried.mesh again.mesh
  holds 'once["size"] == 10 and "tried" not in once' once.json
  holds 'len(tried["tried"]) == 4' tried.json
  holds 'all(abs(t["size"] - size) < 1e-9 for t, size in zip(tried["tried"], (10, 9.5, 9.75, 10.5)))' tried.json
  holds 'tried["size"] == max(tried["tried"], key=lambda t: t["estimated_hex_share"])["size"] != 10' tried.json
  holds 'tried["tried"][0]["estimated_hex_share"] == max(once["estimated_hex_share"].values())' tried.json once.json
  holds 'len({t["estimated_hex_share"] for t in tried["tried"]}) == 4' tried.json
  cp tried.json stats.json
  tetmesh -q "$part" --size "$(stats size)" -o direct.mesh
  assert_same_bytes tried.mesh direct.mesh
  assert_fails_with 1 "TetGen failed: it took longer than --tetgen-timeout" tetmesh "$part" --size 10 --tries 2 --tetgen-timeout 0.001 -o out.mesh
  assert_fails_with 1 "^tetmesh: .*: expected a size that makes at most 10 points inside" tetmesh "$part" --size 10 --tries 2 --most-points 10 -o out.mesh
  assert_fails_with 2 "^tetmesh: --tries has no sizes to try" tetmesh "$part" --surface keep --points none --tries 2 -o out.mesh
  for tries in 0 10 -1 x; do assert_fails_with 2 "tries" tetmesh "$part" --tries $tries -o out.mesh; done
  assert [ ! -e out.mesh ]
}

# bats test_tags=optimized
@test "--improve finds points that become more hexes" {
  local part="$DATA/bracket.stl" threads kind rounds=12
  tetmesh -q "$part" --size 10.2 -o plain.mesh
  for threads in 1 2; do
    tetmesh -q "$part" --size 10.2 --improve $rounds --threads $threads -o improved$threads.mesh --stats stats.json
  done
  assert_same_bytes improved1.mesh improved2.mesh
  run --separate-stderr tetmesh -v "$part" --size 10.2 --improve 2 -o two.mesh
  assert_regex "$stderr" "tetmesh: [0-9]+ changes in 2 rounds: about [0-9.]+ % in hexes, in place of [0-9.]+"
  holds 'stats["improved"]["rounds"] == 12 and stats["improved"]["changes"] > 10' stats.json
  holds 'stats["improved"]["estimated_hex_share"] > stats["improved"]["estimated_hex_share_before"] + 0.005' stats.json
  holds 'stats["tetgen_runs"] > 5 * 12 and stats["seconds_by_step"]["improving"] > 0' stats.json
  for kind in plain improved1; do
    findhex -q $kind.mesh | buildgraph -q | initsol -q --iterations 5000 | assemble -q -o $kind.vtu --stats $kind.json
    assert_conforming $kind.vtu
  done
  local share='["cells"]["hex"]["share_of_volume"]'
  holds "improved1$share > plain$share + 0.002" plain.json improved1.json
}

# bats test_tags=optimized
@test "--improve keeps a kept surface, and every flat face of a new one where it was" {
  local rounds=12 kept_rounds=5
  tetmesh -q "$DATA/notch.stl" --surface keep --size 0.1 -o before.mesh
  tetmesh -q "$DATA/notch.stl" --surface keep --size 0.1 --improve $kept_rounds -o kept.mesh --stats stats.json
  tetmesh -q "$DATA/bracket.stl" --size 8 -o plain.mesh
  tetmesh -q "$DATA/bracket.stl" --size 8 --improve $rounds -o improved.mesh
  $CONTENTS same_surface before.mesh kept.mesh
  holds 'stats["improved"]["changes"] > 0' stats.json
  $CONTENTS same_shape plain.mesh improved.mesh
}

# bats test_tags=optimized
@test "--improve gives up a run of TetGen that does not end" {
  tetmesh -q "$DATA/endless.off" --size 16% --surface keep --points lattice --improve 8 -o improved.mesh --stats stats.json
  holds 'stats["improved"]["rounds"] == 8' stats.json
  # Less: no run went on for ever. One seed in twelve meets one.
  holds '4 < stats["seconds"] < 60' stats.json
}

@test "a size larger than the model is told: it is in another unit" {
  run_apart tetmesh "$DATA/cube.stl" --size 30 -o cube.mesh
  assert_success
  grep -q "^tetmesh: warning: the size 30 is larger than the model, which measures 1 x 1 x 1$" <<<"$stderr"
  run_apart tetmesh "$DATA/cube.stl" --size 1 -o cube.mesh
  refute grep -q larger <<<"$stderr"
}

# bats test_tags=optimized
@test "--improve ends by --time-limit or a signal with the best mesh so far" {
  local part="$DATA/bracket.stl"
  tetmesh -q "$part" --size 8 -o plain.mesh
  tetmesh -q "$part" --size 8 --improve 1000000 --time-limit 0 -o at_once.mesh
  assert_same_bytes plain.mesh at_once.mesh
  tetmesh -q "$part" --size 8 --improve 1000000 --time-limit 2 -o limited.mesh --stats stats.json
  holds 'stats["improved"]["rounds"] > 0' stats.json
  for signal in INT TERM; do
    rm -f out.mesh shown
    # The line of progress, which needs a terminal, says when a round is over.
    script -qefc "exec tetmesh '$part' --size 8 --improve 1000000 --time-limit 600 -o out.mesh --stats stats.json" \
      shown </dev/null >/dev/null 3>&- &
    local terminal=$!
    await grep -aq "round [0-9]" shown
    kill -s $signal "$(pgrep -P $terminal -x tetmesh)"
    wait $terminal
    findhex -q out.mesh -o out.cand
    holds '0 < stats["improved"]["rounds"] < 1000000' stats.json
  done
  assert_fails_with 2 "^tetmesh: --time-limit does nothing without --improve" tetmesh "$part" --time-limit 5 -o none.mesh
  assert_fails_with 2 "^tetmesh: --improve does nothing with --points none" tetmesh "$part" --points none --improve 5 -o none.mesh
  for rounds in -1 x 1e9; do assert_fails_with 2 "improve" tetmesh "$part" --improve $rounds -o none.mesh; done
  assert [ ! -e none.mesh ]
}

# bats test_tags=optimized
@test "--size-field: edges are as long as it says, in every format" {
  $SURFACES sized
  local ratio
  for points in lattice frame; do
    tetmesh -q cube.obj --size 2 --size-field place.txt --points $points -o $points.tar --stats stats.json
    assert_equal "$(stats size) $(stats least_size)" "2.0 0.6"
    ratio=$($CONTENTS edges $points.tar "np.minimum(2, 0.6 + 0.3 * np.sqrt(x**2 + y**2 + z**2))")
    $PYTHON -c "assert 0.85 < $ratio < 1.15, $ratio"
    tetmesh -q cube.obj --size-field vertices.txt --points $points -o out.tar --stats stats.json
    assert_equal "$(stats size) $(stats least_size)" "1.6 0.8"
    ratio=$($CONTENTS edges out.tar "0.8 + 0.08 * z")
    $PYTHON -c "assert 0.85 < $ratio < 1.15, $ratio"
  done
  tetmesh -q cube.obj --size 2 --size-field place.npy --points lattice -o npy.tar
  assert_equal "$($CONTENTS mesh lattice.tar)" "$($CONTENTS mesh npy.tar)"
  tetmesh -q cube.obj --size-field background.msh -o out.tar
  ratio=$($CONTENTS edges out.tar "0.8 + 0.08 * z")
  $PYTHON -c "assert 0.85 < $ratio < 1.15, $ratio"
  tetmesh -q cube.obj --size-field background.msh -o out.mesh
  assert_conforming out.mesh
}

# bats test_tags=optimized
@test "--grading says how fast sizes change, --size how large they get" {
  $SURFACES sized
  local more=100000 points
  for grading in 0.1 0.3 1; do
    tetmesh -q cube.obj --size 2 --size-field place.txt --grading $grading -o out.tar --stats stats.json
    points=$(stats points)
    assert [ "$points" -lt "$more" ]
    more=$points
  done
  tetmesh -q cube.obj --size 1.2 --size-field place.txt --grading 1 -o out.tar --stats stats.json
  assert [ "$(stats points)" -gt "$points" ]
  assert_fails_with 2 "grading" tetmesh cube.obj --grading 0
}

@test "sizes that cannot be are named" {
  $SURFACES sized
  echo 1 >short.txt
  printf '0 0 0 1\n0 0 0 0\n' >zero.txt
  assert_fails_with 1 "^tetmesh: short.txt: expected 8 sizes, one for each vertex of cube.obj, found 1" tetmesh cube.obj --size-field short.txt
  assert_fails_with 1 "^tetmesh: zero.txt:2: expected a positive size, found 0" tetmesh cube.obj --size-field zero.txt
  assert_fails_with 1 "^tetmesh: none.txt: .*No such file" tetmesh cube.obj --size-field none.txt
  assert_fails_with 1 "^tetmesh: short.txt: expected sizes with their places" tetmesh "$FILES/cube.stl" --size-field short.txt
  echo 0 0 0 1e-4 >fine.txt
  assert_fails_with 1 "at most 1000 points inside" tetmesh cube.obj --size-field fine.txt --size 1 --surface keep --points lattice --most-points 1000
}

# bats test_tags=both
@test "--layers gives a thin wall as many elements across" {
  $SURFACES box 6 4.9 1 >plate.obj
  # Levels of points, in steps of a tenth. TetGen puts points of its own into some walls of one layer
  # (docs/log/points.md); they come last.
  levels() {
    tetmesh -q plate.obj --size 1.5 "$@" -o out.tar --stats stats.json
    array out.tar mesh/points.npy "len(np.unique(a[:len(a) - $(stats added_points), 2].round(1))) - 1"
  }
  assert_equal "$(levels)" 1
  for layers in 2 3; do assert_equal "$(levels --layers $layers)" $layers; done
  tetmesh -q plate.obj --size 1.5 --layers 2 -o two.mesh
  tetmesh -q plate.obj --size 1.5 --layers -o asked.mesh
  assert_same_bytes two.mesh asked.mesh
  assert_fails_with 2 "layers" tetmesh plate.obj --layers 0
}

# bats test_tags=optimized
@test "a part out of the axes gets the hexes of one along them" {
  $SURFACES turned "$DATA/bracket.stl" 1 >turned.obj
  for part in "$DATA/bracket.stl" turned.obj; do
    tetmesh -q "$part" --surface keep --size 5 -o out.tar --stats $(basename "${part%.*}").json
  done
  holds 'bracket["estimated_hex_share"]["lattice"] > 0.5' bracket.json
  holds 'abs(bracket["estimated_hex_share"]["lattice"] - turned["estimated_hex_share"]["lattice"]) < 0.01' bracket.json turned.json
}

@test "a surface far from the size is told, unless -q" {
  run_apart tetmesh "$FILES/cube.stl" --surface keep --size 0.2 -o out.tar
  assert_success
  assert_equal "$output" ""
  assert_equal "$(wc -l <<<"$stderr")" 1
  grep -q "^tetmesh: warning: 100 % of the surface .* longer than the size 0.2" <<<"$stderr"
  run_apart tetmesh "$FILES/cube.stl" --surface keep --size 0.2 -o out.tar -q
  assert_equal "$stderr" ""
  run_apart tetmesh "$FILES/fine.stl" --surface keep --size 0.2 -o out.tar
  assert_equal "$stderr" ""
}

@test "-v sums up; nothing that TetGen prints comes through" {
  run_apart tetmesh "$FILES/fine.stl" --size 0.2 -v -o out.tar
  assert_success
  assert_equal "$output" ""
  assert_equal "$(wc -l <<<"$stderr")" 1
  grep -Eq "^tetmesh: [0-9]+ points \([0-9]+ of the surface, 64 inside\), [0-9]+ tets, volume 1, size 0.2" <<<"$stderr"
}

# bats test_tags=optimized
@test "shells: apart, holes by orientation, regions in regions, and the rules" {
  tetmesh -q "$FILES/apart.stl" --size 0.5 -o out.tar
  assert_equal "$(regions out.tar)" "1:1 2:8"
  tetmesh -q "$FILES/hollow.stl" --size 0.5 -o out.tar
  assert_equal "$(regions out.tar)" 1:26
  tetmesh -q "$FILES/nested.stl" --size 0.5 -o out.tar
  assert_equal "$(regions out.tar)" "1:26 2:1"
  tetmesh -q "$FILES/hollow.stl" --size 0.5 --shells regions -o out.tar
  assert_equal "$(regions out.tar)" "1:26 2:1"
  tetmesh -q "$FILES/nested.stl" --size 0.5 --shells holes -o out.tar
  assert_equal "$(regions out.tar)" 1:26
  tetmesh -q "$FILES/inward.stl" --size 0.5 --shells holes -o out.tar
  assert_equal "$(regions out.tar)" 1:1
}

@test "surface tags: solids, attributes, groups, else shells" {
  tetmesh -q --surface keep --points none "$FILES/solids.stl" -o out.tar
  assert_equal "$(array out.tar mesh/triangle_tags.npy 'a.tolist()')" "[1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2]"
  tetmesh -q --surface keep --points none "$FILES/attributes.stl" -o out.tar
  assert_equal "$(array out.tar mesh/triangle_tags.npy 'a.tolist()')" "[5, 5, 5, 5, 9, 9, 9, 9, 9, 9, 9, 9]"
  tetmesh -q --surface keep --points none "$FILES/groups.obj" -o out.tar
  assert_equal "$(array out.tar mesh/triangle_tags.npy 'a.tolist()')" "[1, 1, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3]"
  tetmesh -q --surface keep --points none "$FILES/nested.stl" -o out.tar
  assert_equal "$(array out.tar mesh/triangle_tags.npy '[int((a == k).sum()) for k in (1, 2)]')" "[12, 12]"
}

@test "history says what was asked for and what came out" {
  tetmesh -q "$FILES/cube.stl" --surface keep --size 0.3 --seed 7 -o out.tar
  run $PYTHON -c "
import json, tarfile
entry = json.load(tarfile.open('out.tar').extractfile('history/01-tetmesh.json'))
assert entry['tool'] == 'tetmesh' and entry['options']['size'] == '0.3' and entry['options']['seed'] == '7', entry
assert entry['tets'] > 0 and entry['surface_triangles'] == 12, entry
assert not any('second' in key for key in entry), entry"
  assert_success
}

@test "TetGen's process goes when tetmesh is killed" {
  tetmesh -q "$FILES/cube.stl" --surface keep --points lattice --size 0.01 -o out.tar &
  local parent=$! child
  await pgrep -P $parent
  child=$(pgrep -P $parent)
  kill -KILL $parent
  wait $parent || true
  await has_ended "$child"
  assert [ ! -e out.tar ]
}

# bats test_tags=optimized
@test "--curvature makes elements small where the surface bends, down to --least-size" {
  points() { tetmesh -q "$DATA/bracket.stl" --size 8 "$@" --stats stats.json -o curved.mesh && $PYTHON -c 'import json; s = json.load(open("stats.json")); print(s["points"], s.get("least_size"))'; }
  read -r plain least <<<"$(points)"
  assert_equal "$least" None
  read -r coarse least <<<"$(points --curvature 12)"
  assert [ "$coarse" -gt "$plain" ]
  read -r fine least <<<"$(points --curvature 24)"
  assert [ "$fine" -gt "$coarse" ]
  read -r bounded least <<<"$(points --curvature 24 --least-size 4)"
  assert [ "$bounded" -lt "$fine" ]
  assert_equal "$least" 4.0
  # A cube does not bend.
  tetmesh "$DATA/cube.stl" --size 0.3 --curvature 100 -o curved.mesh
  tetmesh "$DATA/cube.stl" --size 0.3 -o plain.mesh
  assert_same_bytes curved.mesh plain.mesh
}

# bats test_tags=both
@test "--scale multiplies the coordinates" {
  tetmesh "$DATA/cube.stl" --surface keep --points none -o cube.mesh
  tetmesh "$DATA/cube.stl" --surface keep --points none --scale 0.5 -o half.mesh
  assert_equal "$(volumes_of cube.mesh) $(volumes_of half.mesh)" "{1: 1.0} {1: 0.125}"
  # Lengths are in the new unit.
  tetmesh "$DATA/cube.stl" --scale 1000 --size 300 --stats scaled.json -o scaled.mesh
  tetmesh "$DATA/cube.stl" --size 0.3 --stats plain.json -o plain.mesh
  assert_equal "$($PYTHON -c 'import json; print(json.load(open("scaled.json"))["surface_points"] == json.load(open("plain.json"))["surface_points"])')" True
}
