# assemble --order 2: meshes of second order, as VTK, Gmsh, meshio, MED's tools and CalculiX read them.

load helpers

# For all tests, up to a solution: a quarter of a ring. Its volume is 1.17810.
setup_file() {
  load helpers
  cd "$BATS_FILE_TMPDIR"
  "$DATA/ring.py" >ring.stl
  tetmesh ring.stl --size 0.3 -q | findhex | buildgraph | initsol --iterations 20000 -o choice.tar
}

# choice: choice.tar and its surface, ring.stl.
choice() {
  ln -s "$BATS_FILE_TMPDIR"/{choice.tar,ring.stl} .
}

# cells FILE: what another program reads, in cells.txt.
cells() {
  timeout 120 "$PYTHON" "$CHECKERS/curved_cells.py" "$1" >cells.txt 2>judge.log || fail "cannot read $1: $(cat judge.log)"
}

# assert_near WANTED RELATIVE FOUND
assert_near() {
  $PYTHON -c 'import sys; a, e, b = map(float, sys.argv[1:]); assert abs(a - b) <= e * abs(a), (a, b)' "$@"
}

# value KEY: of cells.txt
value() {
  awk -v key="$1" '$1 == key { print $NF }' cells.txt
}

@test "nodes of the boundary lie on the surface, and the volume is that of the curved part" {
  choice
  assemble choice.tar --order 2 --surface ring.stl --stats stats.json -o ring.vtu
  cells ring.vtu
  assert_equal "$(value is_positive)" 1
  assert_near 1.178097 2e-4 "$(value volume)"
  run holds 'stats["second_order"]["too_far_from_given_surface"] == 0 and stats["second_order"]["bent_cells"] > 20' stats.json
  assert_success
  # The mesh of first order lacks what lies between chords and arcs.
  assemble choice.tar --stats straight.json -o straight.vtu
  run holds 'straight["volume"]["cells"] < 1.1755' straight.json
  assert_success
  $PYTHON - <<'PYTHON'
import meshio, numpy as np
for kind in ("wedge15", "pyramid13"):  # which Debian's meshio 5.0 reads, but forgot here
    meshio._mesh.topological_dimension.setdefault(kind, 3)
mesh = meshio.read("ring.vtu")
surface = mesh.cell_data["surface"]
for block, tags in zip(mesh.cells, surface):
    if block.type not in ("triangle6", "quad8"):
        continue
    for tag, radius in ((1, 1.0), (2, 2.0)):
        nodes = np.asarray(block.data)[np.asarray(tags).ravel() == tag]
        middles = nodes[:, {"triangle6": 3, "quad8": 4}[block.type]:].ravel()
        off = abs(np.hypot(*mesh.points[middles, :2].T) - radius)
        assert off.size == 0 or off.max() < 2e-5, (tag, off.max())
PYTHON
}

@test "a surface in the bundle needs no option, and one that is too far away is told" {
  choice
  $PYTHON - <<'PYTHON'
import io, tarfile
import numpy as np
corners = np.array([[float(x) for x in line.split()[1:]] for line in open("ring.stl") if line.startswith("vertex")])
points, triangles = np.unique(corners, axis=0, return_inverse=True)
with tarfile.open("surface.tar", "w") as tar:
    for name, rows in (("points", points.astype("<f8")), ("triangles", triangles.reshape(-1, 3).astype("<i4"))):
        data = io.BytesIO()
        np.save(data, rows)
        member = tarfile.TarInfo("surface/%s.npy" % name)
        member.size = data.tell()
        data.seek(0)
        tar.addfile(member, data)
PYTHON
  tetmesh surface.tar --size 0.3 -q | findhex | buildgraph | initsol --iterations 20000 |
    assemble --order 2 --stats stats.json -o ring.vtu
  run holds 'stats["second_order"]["on_given_surface"] == stats["second_order"]["nodes_of_boundary"] > 0' stats.json
  assert_success
  cells ring.vtu
  assert_near 1.178097 2e-4 "$(value volume)"
  run_apart assemble choice.tar --order 2 --surface "$DATA/bracket.stl" --stats far.json -o far.vtu
  assert_success
  run holds 'far["second_order"]["on_given_surface"] == 0' far.json
  assert_success
  [[ "$stderr" == *"nodes of the boundary have no place on the surface near them"* ]]
}

@test "a border of tags stays where it is beside a curve of the surface that only passes by" {
  "$DATA/lattices/lattice.py" kuhn 4 >lattice.mesh
  $PYTHON - <<'PYTHON'
# The mesh has the border of two tags at x = 2, the surface at x = 2.2.
import itertools
words = open("lattice.mesh").read().split()
def rows(section, width):
    at = words.index(section) + 2
    return [words[i:i + width] for i in range(at, at + width * int(words[at - 1]), width)]
points = [[float(x) for x in row[:3]] for row in rows("Vertices", 4)]
faces = {}
for tet in rows("Tetrahedra", 5):
    for face in itertools.combinations(tet[:4], 3):
        faces.setdefault(frozenset(face), []).append(face)
with open("tagged.mesh", "w") as mesh:
    print(*words[:words.index("End")], "Triangles", sum(len(at) == 1 for at in faces.values()), sep="\n", file=mesh)
    for (face, *others) in faces.values():
        at = [points[int(v) - 1] for v in face]
        is_low = all(p[2] == 4 and p[0] <= 2 for p in at)
        if not others:
            print(*face, 1 if is_low else 2, file=mesh)
    print("End", file=mesh)
def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]
def top(x0, x1):
    return quad((x0, 0, 4), (x1, 0, 4), (x1, 4, 4), (x0, 4, 4))
rest = top(2.2, 4) + quad((0, 0, 0), (0, 4, 0), (4, 4, 0), (4, 0, 0))
for x, y, u, v in ((0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)):
    rest += quad((x, y, 0), (u, v, 0), (u, v, 4), (x, y, 4))
with open("surface.stl", "w") as stl:
    for name, triangles in (("low", top(0, 2.2)), ("rest", rest)):
        print("solid", name, file=stl)
        for t in triangles:
            print("facet normal 0 0 0", "outer loop", *("vertex %g %g %g" % p for p in t), "endloop", "endfacet", sep="\n", file=stl)
        print("endsolid", file=stl)
PYTHON
  findhex --mesh tagged.mesh | buildgraph | initsol -o lattice.tar
  run_apart assemble lattice.tar --smooth 0 --order 2 --surface surface.stl --stats stats.json -o lattice.vtu
  assert_success
  [[ "$stderr" == *"vertices of the boundary stay off the surface: it is further than a tenth of an edge away"* ]]
  run holds 'stats["second_order"]["corners_off_surface"] > 0 and stats["second_order"]["bent_cells"] == 0' stats.json
  assert_success
}

# bats test_tags=optimized
@test "without a surface, flat faces between roundings stay flat, and the volume is nearer than with straight edges" {
  tetmesh "$DATA/bracket.stl" --size 6 -q | findhex | buildgraph | initsol --iterations 20000 -o bracket.tar
  assemble bracket.tar --stats straight.json -q -o straight.vtu
  run_apart assemble bracket.tar --order 2 -o bracket.vtu
  assert_success
  assert_equal "$(grep -c 'no surface was given: nodes of the boundary lie on arcs through its vertices' <<<"$stderr")" 1
  cells bracket.vtu
  $PYTHON - "$(value volume)" <<'PYTHON'
import json, sys
true, bent = 286808, float(sys.argv[1])
straight = json.load(open("straight.json"))["volume"]["cells"]
assert abs(bent - true) < abs(straight - true), (bent, straight)
PYTHON
}

@test "without a surface, nodes lie on arcs through the vertices" {
  choice
  assemble choice.tar --order 2 -o ring.vtu
  cells ring.vtu
  assert_near 1.178097 1e-3 "$(value volume)"
  assert_equal "$(value is_positive)" 1
}

# bats test_tags=optimized
@test "every format has the same cells, volumes and groups, in its own reader" {
  choice
  for nodes in serendipity full; do
    assemble choice.tar --order 2 --nodes $nodes --surface ring.stl --stats $nodes.json -o ring-$nodes.vtu
    cells ring-$nodes.vtu
    head -8 cells.txt >expected.txt
    run holds "sum($nodes['cells'][k]['count'] for k in $nodes['cells']) == $(awk '/^(hex|prism|pyramid|tet) / { n += $2 } END { print n }' cells.txt)" $nodes.json
    assert_success
    for format in msh msh-binary msh22 msh22-binary vtk med exo; do
      ending=${format%-binary}
      ending=${ending%22}
      mesh_convert "$DATA/meshes/one_of_each.msh" "$format" /dev/null 2>/dev/null || continue
      assemble choice.tar --order 2 --nodes $nodes --surface ring.stl -q --format $format -o "read-$format.$ending"
      # meshio knows no hex of 27 nodes in MED.
      [[ $nodes == full && $format == med ]] && continue
      cells "read-$format.$ending"
      for key in hex prism pyramid tet; do
        assert_equal "$format $(grep "^$key " cells.txt | cut -d' ' -f2)" "$format $(grep "^$key " expected.txt | cut -d' ' -f2)"
      done
      assert_near "$(awk '$1 == "volume" { print $2 }' expected.txt)" 1e-7 "$(value volume)"
      assert_equal "$(value is_positive)" 1
      [[ $format == vtk ]] || for name in inner outer bottom top x0 y0; do
        [[ $format == med ]] || grep -q "^names .*$name" cells.txt || fail "$format lacks $name: $(grep ^names cells.txt)"
      done
    done
  done
}

@test "Gmsh finds all Jacobians positive, by bounds of its own" {
  command -v gmsh >/dev/null || skip "gmsh is not installed"
  choice
  cat >judge.geo <<'GEO'
Merge "ring.msh";
Plugin(AnalyseMeshQuality).JacobianDeterminant = 1;
Plugin(AnalyseMeshQuality).DimensionOfElements = 3;
Plugin(AnalyseMeshQuality).Run;
GEO
  for nodes in serendipity full; do
    # At the apex of a pyramid, Gmsh's bound may be 0: its Jacobian vanishes there.
    for pyramids in split keep; do
      assemble choice.tar --order 2 --nodes $nodes --surface ring.stl --pyramids $pyramids -q -o ring.msh
      timeout 120 gmsh judge.geo -0 -v 5 >gmsh.log 2>&1 || fail "$(tail -5 gmsh.log)"
      run awk '/minJ +=/ { sub(",", "", $5); print $5 }' gmsh.log
      assert [ "$(awk -v j="$output" -v p=$pyramids 'BEGIN { print (j != "" && (j > 0 || (p == "keep" && j == 0))) }')" = 1 ]
    done
  done
}

# bats test_tags=optimized
@test "CalculiX: pyramids become tets with tied nodes, and the volume is right" {
  choice
  run_apart assemble choice.tar --order 2 --surface ring.stl --solver calculix -v -o ring.inp
  assert_success
  assert_equal "$(grep -c 'pyramids are written as four tets each' <<<"$stderr")" 1
  run grep -c '^\*EQUATION' ring.inp
  assert [ "$output" -gt 0 ]
  run grep -oE 'TYPE=C3D[0-9R]+' ring.inp
  assert_output --partial TYPE=C3D20
  assert_output --partial TYPE=C3D10
  # Lines hold 16 numbers at most.
  run awk -F, '!/^\*/ && NF > 17 { print FNR }' ring.inp
  assert_output ""
  command -v ccx >/dev/null || skip "calculix-ccx is not installed"
  echo "*INCLUDE, INPUT=ring.inp
*MATERIAL, NAME=STEEL
*ELASTIC
210000, 0.3
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
*STEP
*STATIC
*BOUNDARY
x0, 1, 1, 0
y0, 2, 2, 0
bottom, 3, 3, 0
*EL PRINT, ELSET=EALL, TOTALS=ONLY
EVOL
*END STEP" >case.inp
  timeout 120 ccx case >ccx.log || fail "$(tail -3 ccx.log)"
  run awk '/total volume/ { getline; getline; print $1 }' case.dat
  assemble choice.tar --order 2 --surface ring.stl -q -o ring.vtu
  cells ring.vtu
  assert_near "$(value volume)" 2e-5 "$output"
}

# bats test_tags=optimized
@test "CalculiX opens a ring under pressure as Lamé says, with tied nodes, twenty times as exactly as at first order" {
  command -v ccx >/dev/null || skip "calculix-ccx is not installed"
  choice
  local order
  for order in 1 2; do
    assemble choice.tar $([[ $order = 1 ]] || echo --order 2 --surface ring.stl) --solver calculix -q -o ring.inp
    "$PYTHON" "$HEXPIPE_SOURCE/tests/checkers/lame_calculix.py" ring.inp >answer.json
    "$PYTHON" -c "import json; print(json.load(open('answer.json'))['displacement'])" >order-$order
  done
  run grep -c '^\*NODE, NSET=NTIED' ring.inp
  assert_output 1
  assert [ "$(paste order-1 order-2 | awk '{ print ($1 < 0.04 && $2 < 0.0015 && $1 > 20 * $2) }')" = 1 ]
}

@test "inp needs no --solver for pyramids of second order" {
  choice
  run_apart assemble choice.tar --order 2 --surface ring.stl -o ring.inp
  assert_success
  [[ "$stderr" == *"pyramids are written as four tets each"* ]]
  run_apart assemble choice.tar --order 2 --surface ring.stl --solver abaqus --hex-element C3D8R -v -o ring.inp
  assert_success
  [[ "$stderr" == *"for abaqus: pyramids are kept (of second order split), hexes are C3D8R (of second order C3D20R)"* ]]
  grep -q 'TYPE=C3D20R' ring.inp
}

# lattice_with_pyramids: choice.tar with every other cube of a lattice as a hex, so that all bases of pyramids are squares.
lattice_with_pyramids() {
  "$DATA/lattices/lattice.py" kuhn 4 >lattice.mesh
  findhex --mesh lattice.mesh -o candidates.tar
  mkdir arrays && tar xf candidates.tar -C arrays
  $PYTHON - >lattice.sol <<'PYTHON'
import numpy as np
points, vertices, kinds = (np.load("arrays/" + name + ".npy") for name in ("mesh/points", "candidates/vertices", "candidates/kind"))
for i in np.flatnonzero(kinds == 12):
    corners = points[vertices[i]]
    if (np.ptp(corners, axis=0) == 1).all() and corners.min(axis=0).sum() % 2 == 0:
        print(i + 1)
PYTHON
  for pyramids in split collapsed; do
    assemble candidates.tar --solution lattice.sol --smooth 0 --exchange none --fill none --merge none \
      --order 2 --solver calculix --pyramids $pyramids -q -o $pyramids.inp
  done
}

@test "CalculiX takes boundary conditions on the nodes of a region, beside tied nodes" {
  command -v ccx >/dev/null || skip "calculix-ccx is not installed"
  lattice_with_pyramids
  region=$(sed -n 's/^\*ELSET, ELSET=//p' split.inp | head -1)
  for nodes in NALL "$region"; do
    echo "*INCLUDE, INPUT=split.inp
*MATERIAL, NAME=STEEL
*ELASTIC
210000, 0.3
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
*BOUNDARY
$nodes, 1, 3, 0
*STEP
*STATIC
*NODE PRINT, NSET=NTIED
U
*END STEP" >case.inp
    run timeout 120 ccx case
    assert_success
    refute_output --partial ERROR
    # Tied nodes are there, and stay with the others.
    run awk 'NF == 4 && $2 + 0 == 0 && $3 + 0 == 0 && $4 + 0 == 0 { n += 1 } NF == 4 && $1 ~ /^[0-9]+$/ { all += 1 } END { print (all > 100 && n == all) }' case.dat
    assert_output 1
  done
}

# stress_error NAME: under the pressure 210 from all sides, the greatest error of a stress, in the pressure.
stress_error() {
  $PYTHON - "$1" <<'PYTHON'
import sys
nodes, reading = {}, False
for line in open(sys.argv[1] + ".inp"):
    if line.startswith("*"):
        reading = line.startswith("*NODE")
    elif reading:
        number, *at = line.split(",")
        nodes[tuple(float(c) for c in at)] = int(number)
with open("case.inp", "w") as case:
    print("*INCLUDE, INPUT=%s.inp\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3" % sys.argv[1], file=case)
    print("*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n*BOUNDARY", file=case)
    for at, first in (((0, 0, 0), 1), ((4, 0, 0), 2), ((0, 4, 0), 3)):
        print("%d, %d, 3, 0" % (nodes[at], first), file=case)
    print("*STEP\n*STATIC\n*DSLOAD\nsurface_0, P, 210\n*EL PRINT, ELSET=EALL\nS\n*END STEP", file=case)
PYTHON
  rm -f case.dat
  timeout 120 ccx case >ccx.log || return 1
  awk '/^ *[0-9]+ +[0-9]+ / { for (i = 3; i <= 8; ++i) { e = $i + (i < 6 ? 210 : 0); if (e < 0) e = -e; if (e > most) most = e } }
       END { printf "%.2g\n", most / 210 }' case.dat
}

# bats test_tags=optimized
@test "CalculiX finds a constant stress exactly where tets stand for pyramids, and not in collapsed hexes" {
  command -v ccx >/dev/null || skip "calculix-ccx is not installed"
  lattice_with_pyramids
  run grep -c '^\*EQUATION' split.inp
  assert [ "$output" -gt 300 ]
  run stress_error split
  assert_success
  assert [ "$(awk -v e="$output" 'BEGIN { print (e < 1e-6) }')" = 1 ]
  run stress_error collapsed
  assert [ "$(awk -v e="$output" 'BEGIN { print (e > 0.1) }')" = 1 ]
}

@test "what cannot hold second order is refused before any work, in one line" {
  choice
  for format in mesh su2 bdf cgns; do
    mesh_convert "$DATA/meshes/one_of_each.msh" $format /dev/null 2>/dev/null || continue
    assert_fails_with 2 "second order go with msh, vtu, vtk, inp, exo, med or tar, found $format" \
      assemble choice.tar --order 2 -o ring.$format
  done
  assert_fails_with 2 'second order go with .*, found polyMesh' assemble choice.tar --order 2 -o polyMesh
  assert_fails_with 2 'middles of quads and hexes: use --nodes serendipity' \
    assemble choice.tar --order 2 --nodes full -o ring.inp
  assert_fails_with 2 'no pyramids of second order: use --pyramids split or collapsed, found keep' \
    assemble choice.tar --order 2 --pyramids keep -o ring.inp
  assert_fails_with 2 '--hex-element C3D8I has no element of second order: C3D8 gives C3D20' \
    assemble choice.tar --order 2 --hex-element C3D8I -o ring.inp
  assert_fails_with 2 "--surface takes a file, found '-'" assemble choice.tar --order 2 --surface - -o ring.vtu
  assert_fails_with 2 '--nodes goes with --order 2' assemble choice.tar --nodes full -o ring.vtu
  assert_fails_with 2 '--surface goes with --order 2' assemble choice.tar --surface ring.stl -o ring.vtu
  # Before the mesh is read: there is none.
  assert_fails_with 1 'nowhere.stl: cannot open' assemble nowhere.tar --order 2 --surface nowhere.stl -o ring.vtu
}

@test "a bundle of second order has the columns of its numbering, and other stages take the corners" {
  choice
  assemble choice.tar -o first.tar
  for nodes in serendipity full; do
    assemble choice.tar --order 2 --nodes $nodes -o second.tar
    mkdir -p first second && tar xf first.tar -C first && tar xf second.tar -C second
    $PYTHON - $nodes <<'PYTHON'
import sys
import numpy as np
columns = {"serendipity": (20, 15, 13, 10, 6, 8), "full": (27, 18, 14, 10, 6, 9)}[sys.argv[1]]
points = np.load("second/result/points.npy")
old = np.load("first/result/points.npy")
assert (points[:len(old)] == old).all()
for name, wide in zip(("hexes", "prisms", "pyramids", "tets", "triangles", "quads"), columns):
    first, second = (np.load("%s/result/%s.npy" % (folder, name)) for folder in ("first", "second"))
    assert second.shape == (len(first), wide), second.shape
    assert (second[:, :first.shape[1]] == first).all()
    assert second[:, first.shape[1]:].min(initial=len(old)) >= len(old) and second.max(initial=0) < len(points)
PYTHON
  done
  command -v viewmesh >/dev/null || skip "viewmesh was not built"
  run_apart viewmesh second.tar -o page.html
  assert_success
  assert_equal "$stderr" "viewmesh: warning: second.tar: result: it is of second order; viewmesh takes the corners alone, with straight edges"
}

@test "the same bytes for any number of threads" {
  choice
  assemble choice.tar --order 2 --surface ring.stl --threads 1 -o one.vtu
  assemble choice.tar --order 2 --surface ring.stl --threads 3 -o three.vtu
  assert_same_bytes one.vtu three.vtu
}
