# assemble: the mesh from the chosen cells. What all tools do alike is in behaviour.bats.
# bats file_tags=both

load helpers

# $WORK: a lattice with moved vertices and two regions, its candidates, graph and a solution that leaves tets, as files and
# as the bundle stages.tar.
setup_file() {
  load helpers
  export WORK="$BATS_FILE_TMPDIR"
  cd "$WORK"
  $PYTHON - >moved.mesh <<PYTHON
import random, subprocess
random.seed(5)
n, region = 4, {}
lines = subprocess.run(["$PYTHON", "$DATA/lattices/lattice.py", "kuhn", str(n)], capture_output=True, text=True).stdout.split("\n")
start = lines.index("Vertices") + 2
points = [[float(x) for x in line.split()[:3]] for line in lines[start : start + (n + 1) ** 3]]
for i, p in enumerate(points):
    if all(0 < x < n for x in p) and p[0] != 2:
        points[i] = [x + random.uniform(-0.17, 0.17) for x in p]
    lines[start + i] = "%r %r %r 0" % tuple(points[i])
first = lines.index("Tetrahedra") + 2
for i in range(first, lines.index("End")):
    tet = [int(x) for x in lines[i].split()[:4]]
    lines[i] = "%d %d %d %d " % tuple(tet) + ("7" if sum(points[v - 1][0] for v in tet) < 8 else "9")
print("\n".join(lines), end="")
PYTHON
  findhex --mesh moved.mesh --cells hex,prism -o moved.cand
  findhex --mesh moved.mesh --cells hex,prism | buildgraph >graph.tar
  buildgraph graph.tar -o moved.graph
  initsol --iterations 0 graph.tar -o full.sol
  # Half of the cells, so that there is something to make conforming.
  awk 'NR % 2' full.sol >moved.sol
  FILES="--mesh $WORK/moved.mesh --candidates $WORK/moved.cand --solution $WORK/moved.sol"
  export FILES
}

stats_of() {
  $PYTHON "$CHECKERS/meshstats.py" --json --exact "$1"
}

# expect FILE EXPRESSION: a Python expression over the checker's findings s.
expect() {
  $PYTHON -c "
import json, sys
s = json.loads(sys.argv[1])
assert eval(sys.argv[2]), (sys.argv[2], s)" "$(stats_of "$1")" "$2"
}

@test "the mesh is conforming and valid, as another program sees it" {
  assemble $FILES -o mesh.vtu
  expect mesh.vtu 's["is_conforming"] and s["open_quads"] == 0 and s["invalid_hexes"] == s["inverted_cells"] == s["unused_points"] == 0'
  expect mesh.vtu 's["hexes"] > 5 and s["pyramids"] > 5 and s["tets"] > 5'
  expect mesh.vtu 'abs(s["volume_gap"]) < 1e-12 and abs(s["volume"] - 64) < 1e-9'
}

@test "--conformity none leaves quads against triangles, and says how many" {
  assemble $FILES --conformity none -v -o mesh.vtu 2>summary
  expect mesh.vtu 's["open_quads"] > 10 and s["facets_of_three_cells"] == s["twisted_quads"] == s["odd_boundary_edges"] == s["invalid_hexes"] == s["inverted_cells"] == 0'
  expect mesh.vtu 's["pyramids"] == 0'
  found=$(stats_of mesh.vtu | $PYTHON -c 'import json, sys; print(json.load(sys.stdin)["open_quads"])')
  grep -q " $found quads non-conforming" summary
}

# bats test_tags=optimized
@test "--exchange lets hexes give way to others: fewer quads face tets, fewer pyramids" {
  if ! command -v tetmesh; then skip "tetmesh makes the part"; fi
  tetmesh "$DATA/bracket.stl" --size 9 | findhex | buildgraph | initsol --iterations 20000 -o bracket.tar
  # Merging and prisms take pyramids away afterwards, and so hide how many each choice needs.
  assemble bracket.tar --merge none --fill none --exchange none --stats none.json -o none.vtu
  assemble bracket.tar --merge none --fill none -v --stats quads.json -o quads.vtu 2>summary
  expect quads.vtu 's["is_conforming"] and s["open_quads"] == 0 and s["invalid_hexes"] == s["inverted_cells"] == s["unused_points"] == 0'
  $PYTHON - "$(stats_of none.vtu)" "$(stats_of quads.vtu)" <<PYTHON
import json, sys
none, quads = (json.load(open(f)) for f in ("none.json", "quads.json"))
made = quads["exchange"]
assert "exchange" not in none and made["hexes_in"] > 0, made
assert made["open_quads_after"] < made["open_quads_before"], made
said = "{hexes_out} hexes exchanged for {hexes_in} others: {open_quads_after} open quads".format(**made)
assert said in open("summary").read(), said
without, withal = map(json.loads, sys.argv[1:])
assert withal["pyramids"] < without["pyramids"], (withal, without)
assert quads["cells"]["hex"]["share_of_volume"] > none["cells"]["hex"]["share_of_volume"]
PYTHON
  assemble bracket.tar --merge none --fill none --exchange quads -o default.vtu
  assert_same_bytes quads.vtu default.vtu
}

@test "--exchange does not fill a solution of three hexes up" {
  awk 'NR <= 2 || NR == 9' "$WORK/full.sol" >three.sol
  assemble --mesh "$WORK/moved.mesh" --candidates "$WORK/moved.cand" --solution three.sol --fill none --stats three.json -o three.vtu
  $PYTHON - <<PYTHON
import json
three = json.load(open("three.json"))
assert three["cells"]["hex"]["count"] + three["cells"]["prism"]["count"] <= 3, three["cells"]
PYTHON
}

@test "--fill makes prisms of tets between hexes: fewer quads face tets, hexes stay" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 5 >kuhn.mesh
  findhex --mesh kuhn.mesh -o kuhn.cand
  findhex --mesh kuhn.mesh | buildgraph | initsol --iterations 0 -o full.sol
  awk '!(NR <= 5 || NR % 17 == 0)' full.sol >kuhn.sol  # without a column at an edge, and some more
  local files="--mesh kuhn.mesh --candidates kuhn.cand --solution kuhn.sol"
  assemble $files --fill none --stats none.json -o none.vtu
  assemble $files -v --stats prisms.json -o prisms.vtu 2>summary
  expect prisms.vtu 's["is_conforming"] and s["open_quads"] == 0 and s["invalid_hexes"] == s["inverted_cells"] == s["unused_points"] == 0'
  expect prisms.vtu 'abs(s["volume_gap"]) < 1e-12 and abs(s["volume"] - 125) < 1e-9'
  $PYTHON - <<PYTHON
import json
none, prisms = (json.load(open(f)) for f in ("none.json", "prisms.json"))
made = prisms["conformity"]["prisms_between_cells"]
assert made >= 5 and none["conformity"]["prisms_between_cells"] == none["cells"]["prism"]["count"] == 0, made
assert f" {made} prisms made of tets between the cells" in open("summary").read()
assert prisms["cells"]["hex"]["count"] >= none["cells"]["hex"]["count"]
assert prisms["conformity"]["quads_against_tets"] < none["conformity"]["quads_against_tets"]
PYTHON
  assemble $files --fill prisms -o default.vtu
  assert_same_bytes prisms.vtu default.vtu
}

@test "--merge makes the cells between hexes fewer and better, with two regions" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 6 >kuhn.mesh
  awk '/Tetrahedra/ {tets = 1} tets && NF == 5 {$5 = 1 + (++n > 600)} {print}' kuhn.mesh >regions.mesh
  findhex --mesh regions.mesh -o regions.cand
  findhex --mesh regions.mesh | buildgraph | initsol --iterations 0 -o full.sol
  awk 'NR % 5' full.sol >regions.sol
  local files="--mesh regions.mesh --candidates regions.cand --solution regions.sol"
  assemble $files --merge none --stats none.json -o none.vtu
  assemble $files -v --stats vertices.json -o vertices.vtu 2>summary
  expect vertices.vtu 's["is_conforming"] and s["open_quads"] == 0 and s["invalid_hexes"] == s["inverted_cells"] == s["unused_points"] == 0'
  expect vertices.vtu 'abs(s["volume_gap"]) < 1e-12 and abs(s["volume"] - 216) < 1e-9'
  $PYTHON - <<PYTHON
import json
none, merged = (json.load(open(f)) for f in ("none.json", "vertices.json"))
gone = merged["merging"]["vertices_gone"]
assert gone > 10 and set(none["merging"].values()) == {0}, (none["merging"], gone)
assert f" {gone} vertices between the hexes merged into others" in " " + open("summary").read()
assert merged["points"] < none["points"]
before, after = none["cells"], merged["cells"]
# A hole of one cube becomes a hex again.
assert after["hex"]["count"] == before["hex"]["count"] - merged["merging"]["hexes_gone"]
assert after["hex"]["count"] > before["hex"]["count"]
assert after["hex"]["share_of_volume"] > before["hex"]["share_of_volume"] - 0.005
assert after["tet"]["count"] < 0.8 * before["tet"]["count"], (before, after)
for kind in ("tet", "pyramid"):
    for what in ("least", "mean"):
        assert after[kind]["scaled_jacobian"][what] >= before[kind]["scaled_jacobian"][what] - 1e-9, (kind, what)
PYTHON
  assemble $files --merge vertices --threads 2 -o default.vtu
  assert_same_bytes vertices.vtu default.vtu
}

# Under the sanitizers the unit tests mend random meshes.
# bats test_tags=optimized
@test "--mend finite-volumes leaves less that checkMesh counts as wrong; it is the default for OpenFOAM alone" {
  if ! command -v tetmesh; then skip "tetmesh makes the part"; fi
  tetmesh "$DATA/bracket.stl" --size 3.3 | findhex | buildgraph | initsol --iterations 20000 -o part.tar
  assemble part.tar --stats default.json -o default.vtu
  assemble part.tar --mend quality -o quality.vtu
  assert_same_bytes default.vtu quality.vtu
  assemble part.tar --mend finite-volumes --stats mended.json -o mended.vtu
  expect mended.vtu 's["is_conforming"] and s["open_quads"] == 0 and s["invalid_hexes"] == s["inverted_cells"] == 0'
  assemble part.tar --mend finite-volumes --threads 1 --format msh22 -o mended.msh
  assemble part.tar --solver openfoam --threads 2 --format msh22 -o openfoam.msh
  assert_same_bytes mended.msh openfoam.msh
  mkdir -p case/constant
  assemble part.tar --stats poly.json -o case/constant/polyMesh
  $PYTHON - <<PYTHON
import json
before, after, poly = (json.load(open(f + ".json")) for f in ("default", "mended", "poly"))
wrong = lambda stats: stats["finite_volumes"]["determinant"]["misses"] + stats["finite_volumes"]["weight"]["misses"]
assert wrong(after) < 0.7 * wrong(before), (wrong(before), wrong(after))
assert wrong(poly) == wrong(after)
assert after["cells"]["hex"]["share_of_volume"] > before["cells"]["hex"]["share_of_volume"] - 0.001
PYTHON
}

@test "--smooth moves vertices, more rounds more" {
  for rounds in 0 1 5; do assemble $FILES --smooth $rounds -o $rounds.vtu; done
  assert_different_bytes 0.vtu 1.vtu
  assert_different_bytes 1.vtu 5.vtu
  expect 0.vtu 's["is_conforming"]'
  least() { stats_of $1 | $PYTHON -c 'import json, sys; print(json.load(sys.stdin)["least_tet_jacobian"])'; }
  $PYTHON -c "assert $(least 5.vtu) > $(least 0.vtu)"
  assemble $FILES -o default.vtu
  assert_same_bytes default.vtu 5.vtu
}

@test "-v sums up on standard error; without it there is none" {
  run_apart assemble $FILES -o mesh.vtu
  assert_success
  assert_equal "$stderr" ""
  run_apart assemble $FILES -v -o mesh.vtu
  for word in hex prism pyramid tet "number %" "volume %" "least SJ" "0 quads non-conforming" before after; do
    assert grep -q -- "$word" <<<"$stderr"
  done
}

@test "--stats agrees with what the checker counts" {
  assemble $FILES --stats stats.json -o mesh.vtu
  $PYTHON - "$(stats_of mesh.vtu)" <<'PYTHON'
import json, sys
found = json.loads(sys.argv[1])
stats = json.load(open("stats.json"))
cells = stats["cells"]
for kind, name in dict(hex="hexes", prism="prisms", pyramid="pyramids", tet="tets").items():
    assert cells[kind]["count"] == found[name], kind
    assert abs(100 * cells[kind]["share_of_volume"] - found[kind + "_volume_percent"]) < 0.006, kind
    assert sum(cells[kind]["scaled_jacobian"]["histogram"]) == cells[kind]["count"]
assert abs(sum(c["share_of_number"] for c in cells.values()) - 1) < 1e-12
assert abs(cells["hex"]["scaled_jacobian"]["least"] - found["least_hex_jacobian"]) < 1e-4
assert all(0 < c["scaled_jacobian"]["least_inside"] <= c["scaled_jacobian"]["least"] + 1e-12 for c in cells.values())
assert stats["poor_cells"] == []
assert stats["points"] == found["points"]
assert stats["nonconforming_quads"] == 0
volume = stats["volume"]
assert abs(volume["cells"] - volume["input"] - volume["bulge_of_boundary_quads"]) < 1e-9
assert volume["flat_tets_taken_off"] == stats["smoothing"]["flat_tets_taken_off"] == 0
assert stats["conformity"]["quads_against_tets"] > 0
assert set(stats["conformity"]["cells_given_back"]) >= {"flat_corner", "no_valid_position", "poor_elements"}
PYTHON
}

@test "--require writes a result that is good enough, and otherwise nothing but where it is not" {
  assemble $FILES -v --stats plain.json -o plain.vtu 2>summary
  assemble $FILES --require 'hexes 0.1, cells 0.01,orthogonality 179, weight 1e-3, determinant 0, flatness 0.1' -o good.vtu
  assert_same_bytes plain.vtu good.vtu
  echo old >old.vtu
  run_apart assemble $FILES --require 'orthogonality 20, cells 0.9' -o old.vtu
  assert_failure 1
  assert_equal "$(wc -l <<<"$stderr")" 1
  assert_equal "$(<old.vtu)" old
  assert_fails_with 1 'assemble: --require flatness 1: [0-9]+ faces miss it, the worst, 0.[0-9]+, at \(' \
    assemble $FILES --require 'flatness 1'
  $PYTHON - "$stderr" <<'PYTHON'
import json, re, sys
stats = json.load(open("plain.json"))
assert "finite volumes: " in open("summary").read()
fv = stats["finite_volumes"]
assert re.search(r"flatness 1: (\d+) faces", sys.argv[1])
found = [float(x) for x in re.search(r"the worst, (\S+), at \((\S+), (\S+), (\S+)\)", sys.argv[1]).groups()]
expected = [fv["flatness"]["worst"]] + fv["flatness"]["place"]
assert all(abs(a - b) <= 1e-4 * max(1, abs(b)) for a, b in zip(found, expected)), (found, expected)
PYTHON
  run_apart assemble $FILES --require 'hexes 1, cells 0.7, orthogonality 1, weight 0.5, determinant 1'
  assert_failure 1
  for word in "hexes 1: [0-9]+ hexes miss" "cells 0.7: [0-9]+ cells" "orthogonality 1: [0-9]+ faces" "weight 0.5: [0-9]+ faces" "determinant 1: [0-9]+ cells"; do
    grep -qE -- "$word" <<<"$stderr" || fail "$word: $stderr"
  done
}

@test "--stats lists the poor cells that are left, one by one" {
  # Cubes pressed to plates: their tets are flat, and no vertex may leave the corners and edges of a box.
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 | awk 'NF == 4 && !tets { $3 *= 0.01 } /Tetrahedra/ { tets = 1 } { print }' >flat.mesh
  findhex --mesh flat.mesh --min-quality 0.9 -o flat.cand
  echo 1 >flat.sol
  assemble --mesh flat.mesh --candidates flat.cand --solution flat.sol -v --stats stats.json -o mesh.vtu 2>summary
  $PYTHON - <<'PYTHON'
import json
stats = json.load(open("stats.json"))
poor = stats["poor_cells"]
assert poor and all(p["scaled_jacobian"] < (0.1 if p["kind"] == "hex" else 0.02) for p in poor)
assert min(p["scaled_jacobian"] for p in poor) == min(c["scaled_jacobian"]["least"] for c in stats["cells"].values() if c["count"])
assert all(0 <= x <= 2 for p in poor for x in p["middle"])
assert "%d poor cells" % len(poor) in open("summary").read()
PYTHON
}

@test "on a curved surface vertices slide where cells are poor, and --stats tells how far the boundary deviates" {
  $PYTHON - >curved.mesh <<PYTHON
import math
lines = open("$WORK/moved.mesh").read().split("\n")
start, count = lines.index("Vertices") + 2, int(lines[lines.index("Vertices") + 1])
for i in range(start, start + count):  # a bent block, and a slice that is nearly as thin as paper
    x, y, z = (float(w) for w in lines[i].split()[:3])
    x = 1.95 + 0.1 * (x - 1) if 0.5 < x < 1.5 else x
    lines[i] = "%r %r %r 0" % ((8 + z) * math.cos(x / 4), (8 + z) * math.sin(x / 4), y)
print("\n".join(lines), end="")
PYTHON
  findhex --mesh curved.mesh -o curved.cand
  echo 1 >one.sol
  assemble --mesh curved.mesh --candidates curved.cand --solution one.sol --smooth 0 --stats held.json -o held.msh
  assemble --mesh curved.mesh --candidates curved.cand --solution one.sol --stats slid.json -o slid.msh
  $PYTHON -c '
import json
held, slid = (json.load(open(name)) for name in ("held.json", "slid.json"))
assert held["boundary"]["vertices_moved"] == 0 and held["boundary"]["greatest_deviation"] < 1e-9, held["boundary"]
assert slid["boundary"]["vertices_moved"] > 0
assert 0 < slid["boundary"]["greatest_deviation"] < 0.07, slid["boundary"]
assert slid["cells"]["tet"]["scaled_jacobian"]["least"] > held["cells"]["tet"]["scaled_jacobian"]["least"]'
  expect slid.msh 's["is_conforming"] and s["invalid_hexes"] == s["inverted_cells"] == 0'
}

@test "smoothing takes next to nothing off a part that is thinner than its edges are long" {
  findhex -q --mesh "$DATA/thin.mesh" | buildgraph -q | initsol -q --iterations 10 |
    assemble -q --stats stats.json -o thin.vtk
  $PYTHON -c '
import json
volume = json.load(open("stats.json"))["volume"]
assert abs(volume["cells"] - volume["input"]) < 0.01 * volume["input"], volume'
}

@test "regions and the interface between them come through" {
  for conformity in pyramids none; do
    assemble $FILES --conformity $conformity -o mesh.vtk
    $PYTHON - <<'PYTHON'
import meshio, numpy as np
mesh = meshio.read("mesh.vtk")
names = [name for name in mesh.cell_data if set(np.concatenate(mesh.cell_data[name])) >= {7, 9}]
assert names, list(mesh.cell_data)
area = 0.0
for block, tags in zip(mesh.cells, mesh.cell_data[names[0]]):
    at = mesh.points[block.data]
    if block.type in ("hexahedron", "wedge", "pyramid", "tetra"):
        middle = at[:, :, 0].mean(axis=1)
        assert set(tags) <= {7, 9} and ((tags == 7) == (middle < 2)).all(), block.type
    elif block.type in ("triangle", "quad"):
        inside = (abs(at[:, :, 0] - 2) < 1e-12).all(axis=1)
        d = at[:, 2:] - at[:, :1]
        first = np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])
        second = np.cross(at[:, 2] - at[:, 0], at[:, 3] - at[:, 0]) if block.type == "quad" else 0 * first
        area += (np.linalg.norm(first, axis=1) + np.linalg.norm(second, axis=1))[inside].sum() / 2
assert abs(area - 16) < 1e-9, area
PYTHON
  done
}

@test "same bytes for 1 and 2 threads, and from files, bundle and pipe" {
  assemble $FILES --threads 1 -o 1.vtu
  assemble $FILES --threads 2 -o 2.vtu
  assert_same_bytes 1.vtu 2.vtu
  initsol --iterations 0 "$WORK/graph.tar" -o stages.tar
  assemble stages.tar -o bundle.vtu
  shell "cat stages.tar | assemble -o pipe.vtu"
  assert_same_bytes bundle.vtu pipe.vtu
  assemble <(cat stages.tar) -o fifo.vtu
  assert_same_bytes bundle.vtu fifo.vtu
}

@test "cells that cannot stand together are an error of one line" {
  assert_fails_with 1 "assemble: /dev/fd/[0-9]+: solution: .*(share a tet|cross)" \
    assemble --mesh "$WORK/moved.mesh" --candidates "$WORK/moved.cand" --solution <(printf '1\n2\n3\n4\n5\n6\n7\n8\n')
}

@test "another mesh's candidates are an error of one line" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 >small.mesh
  $PYTHON "$DATA/lattices/lattice.py" five 4 >other.mesh
  assert_fails_with 1 "candidates: expected vertices below 27" \
    assemble --mesh small.mesh --candidates "$WORK/moved.cand" --solution "$WORK/moved.sol"
  assert_fails_with 1 "moved.cand: candidates: expected" \
    assemble --mesh other.mesh --candidates "$WORK/moved.cand" --solution "$WORK/moved.sol"
}

@test "two copies of a tet are an error" {
  # One tet, whose mesh has no candidates, and the same tet twice.
  printf '%s\n' "MeshVersionFormatted 2" "Dimension 3" Vertices 4 "0 0 0 0" "1 0 0 0" "0 1 0 0" "0 0 1 0" >points
  { cat points && printf '%s\n' Tetrahedra 1 "1 2 3 4 1" End; } >once.mesh
  { cat points && printf '%s\n' Tetrahedra 2 "1 2 3 4 1" "1 2 3 4 1" End; } >twice.mesh
  findhex once.mesh | buildgraph | initsol -o once.tar
  assemble once.tar -o once.vtu
  assert_fails_with 1 "^assemble: twice.mesh: .*found tets 1 and 2 on one side of that at vertices [1-4] [1-4] [1-4]$" \
    assemble once.tar --mesh twice.mesh -o out.vtu
}

@test "regions that candidates do not respect are an error that names the file" {
  # Every tet of another region.
  awk '/^Tetrahedra/ {tets = 1} tets && NF == 5 {$5 = NR} {print}' "$WORK/moved.mesh" >regions.mesh
  assert_fails_with 1 "moved.cand: candidates: expected candidates of this mesh, found candidate" \
    assemble --mesh regions.mesh --candidates "$WORK/moved.cand" --solution "$WORK/moved.sol"
}

@test "a solution beyond the candidates is an error of one line" {
  assert_fails_with 1 "assemble: .*9999" \
    assemble --mesh "$WORK/moved.mesh" --candidates "$WORK/moved.cand" --solution <(echo 9999999)
}

@test "a command line that makes no sense ends with 2" {
  assert_fails_with 2 "assemble: .*conformity" assemble $FILES --conformity maybe -o x.vtu
  assert_fails_with 2 "assemble: .*smooth" assemble $FILES --smooth -1 -o x.vtu
  assert_fails_with 2 "assemble: .*exchange" assemble $FILES --exchange hexes -o x.vtu
  assert_fails_with 2 "exchange quads goes with --conformity pyramids" assemble $FILES --exchange quads --conformity none -o x.vtu
  assert_fails_with 2 "assemble: .*fill" assemble $FILES --fill tets -o x.vtu
  assert_fails_with 2 "fill prisms goes with --conformity pyramids" assemble $FILES --fill prisms --conformity none -o x.vtu
  assert_fails_with 2 "assemble: .*merge" assemble $FILES --merge tets -o x.vtu
  assert_fails_with 2 "merge vertices goes with --conformity pyramids" assemble $FILES --merge vertices --conformity none -o x.vtu
  assert_fails_with 2 "--require: expected hexes, cells, .*flatness and a number, found 'faces 3'" assemble $FILES --require 'hexes 0.1, faces 3' -o x.vtu
  assert_fails_with 2 "--require: expected weight and a number from 0 to 0.5, found 'weight 0.6'" assemble $FILES --require 'weight 0.6' -o x.vtu
  assert_fails_with 2 "--require: expected hexes and a number from 0 to 1, found 'hexes'" assemble $FILES --require 'hexes' -o x.vtu
  assert_fails_with 2 "--require: expected .*, found ''" assemble $FILES --require 'hexes 0.1,' -o x.vtu
  assert_fails_with 2 "--require does not go with --neighbours" assemble $FILES --require 'hexes 0.1' --neighbours x.tar -o x.vtu
  assert_fails_with 2 "assemble: .*mend" assemble $FILES --mend tets -o x.vtu
  assert_fails_with 2 "mend finite-volumes goes with --merge vertices" assemble $FILES --mend finite-volumes --merge none -o x.vtu
  assert_fails_with 2 "merge vertices goes with .*--smooth of 1 or more" assemble $FILES --merge vertices --smooth 0 -o x.vtu
}

# lattice_mesh N FORMAT FILE: a conforming mesh of all kinds of cells on a lattice of N cubes along each axis.
lattice_mesh() {
  $PYTHON "$DATA/lattices/lattice.py" kuhn $1 >lattice.mesh
  findhex --mesh lattice.mesh --min-quality 0.4 --cells hex,prism -o lattice.cand
  findhex --mesh lattice.mesh --min-quality 0.4 --cells hex,prism | buildgraph | initsol --iterations 0 -o full.sol
  awk 'NR % 4' full.sol >part.sol
  assemble --mesh lattice.mesh --candidates lattice.cand --solution part.sol --format $2 -o $3
}

# bats test_tags=optimized
@test "GetFEM solves Poisson's equation: a linear field exactly, errors of second order in L2 and first in H1" {
  $PYTHON -c "import getfem, scipy" 2>/dev/null || skip "python3-getfem and python3-scipy are not installed"
  for n in 3 6 12; do lattice_mesh $n msh22 $n.msh; done
  $PYTHON "$CHECKERS/poisson_getfem.py" 3.msh 6.msh 12.msh >errors
  $PYTHON - <<'PYTHON'
import json
runs = [json.loads(line) for line in open("errors") if line.strip()]
assert len(runs) == 3
for n, run in zip((3, 6, 12), runs):
    assert run["patch"] < 1e-10 and run["merged"] == 0, run
    assert run["boundary_faces"] == run["tagged_faces"] > 0, run
    assert abs(run["volume"] - n ** 3) < 1e-9 * n ** 3, run
for coarse, fine in zip(runs, runs[1:]):
    assert coarse["l2"] / fine["l2"] > 3.4 and coarse["h1"] / fine["h1"] > 1.8, (coarse, fine)
    assert 3.5 < fine["condition"] / coarse["condition"] < 7, (coarse, fine)  # as the square of the cells along an edge
PYTHON
}

@test "CalculiX stretches a block of hexes without error" {
  command -v ccx >/dev/null || skip "calculix-ccx is not installed"
  $PYTHON "$DATA/lattices/lattice.py" kuhn 3 >lattice.mesh
  findhex --mesh lattice.mesh --min-quality 0.9 -o cubes.cand
  findhex --mesh lattice.mesh --min-quality 0.9 | buildgraph | initsol --iterations 0 -o cubes.sol
  assemble --mesh lattice.mesh --candidates cubes.cand --solution cubes.sol -o block.inp
  $PYTHON - <<'PYTHON'
# The boundary nodes move by 0.001 x. Then the inner ones have to, for the strain is the same everywhere.
nodes = {}
reading = False
for line in open("block.inp"):
    if line.startswith("*"):
        reading = line.upper().startswith("*NODE")
    elif reading:
        number, x, y, z = line.split(",")
        nodes[int(number)] = (float(x), float(y), float(z))
with open("case.inp", "w") as case:
    print("*INCLUDE, INPUT=block.inp\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3", file=case)
    print("*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n*STEP\n*STATIC\n*BOUNDARY", file=case)
    for number, at in nodes.items():
        if any(c in (0, 3) for c in at):
            print("%d, 1, 1, %r\n%d, 2, 3, 0" % (number, 0.001 * at[0], number), file=case)
    print("*NODE PRINT, NSET=NALL\nU\n*END STEP", file=case)
PYTHON
  run timeout 60 ccx case
  assert_success
  $PYTHON - <<'PYTHON'
moved = [[float(x) for x in line.split()] for line in open("case.dat") if len(line.split()) == 4]
place = {}
for line in open("block.inp"):
    words = line.split(",")
    if len(words) == 4 and words[0].strip().isdigit() and int(words[0]) not in place:
        place[int(words[0])] = float(words[1])
assert len(moved) == 64
for number, x, y, z in moved:
    assert abs(x - 0.001 * place[int(number)]) < 1e-9 and abs(y) < 1e-9 and abs(z) < 1e-9, (number, x, y, z)
PYTHON
}

@test "CalculiX pulls at a block of hexes and prisms by its surface tag" {
  command -v ccx >/dev/null || skip "calculix-ccx is not installed"
  $PYTHON "$DATA/lattices/lattice.py" kuhn 3 >untagged.mesh
  $PYTHON - <<'PYTHON'
# The six sides get the tags 1 to 6: x = 0, x = 3, y = 0, ...
lines = open("untagged.mesh").read().split("\n")
start = lines.index("Vertices") + 2
points = [[float(x) for x in line.split()[:3]] for line in lines[start : start + 64]]
first = lines.index("Tetrahedra") + 2
tets = [[int(x) for x in line.split()[:4]] for line in lines[first : first + int(lines[first - 1])]]
sides = []
for a, b, c, d in tets:
    for facet in ((b, c, d), (a, d, c), (a, b, d), (a, c, b)):
        for axis in range(3):
            for end in (0, 3):
                if all(points[v - 1][axis] == end for v in facet):
                    sides.append("%d %d %d %d" % (*facet, 1 + 2 * axis + (end > 0)))
lines[lines.index("End"):] = ["Triangles", str(len(sides)), *sides, "End", ""]
open("tagged.mesh", "w").write("\n".join(lines))
PYTHON
  findhex --mesh tagged.mesh --min-quality 0.4 --cells hex,prism -o block.cand
  $PYTHON - <<'PYTHON'
# Columns of hexes and columns of two prisms each, whose triangles look up and down, in turns.
lines = open("tagged.mesh").read().split("\n")
start = lines.index("Vertices") + 2
points = [[float(x) for x in line.split()[:3]] for line in lines[start : start + 64]]
chosen = []
for number, line in enumerate(open("block.cand")):
    words = line.split()
    count = {"hex": 8, "prism": 6}.get(words[0], 0)
    at = [points[int(v) - 1] for v in words[5 : 5 + count]]
    low, high = ([f(p[axis] for p in at) for axis in range(3)] if at else [] for f in (min, max))
    if not at or any(h - l != 1 for l, h in zip(low, high)):
        continue
    upright = words[0] == "hex" or at[0][2] == at[1][2] == at[2][2]
    if upright and (words[0] == "hex") == ((low[0] + low[1]) % 2 == 0):
        chosen.append(number)
open("block.sol", "w").write("".join("%d\n" % number for number in chosen))
PYTHON
  assemble --mesh tagged.mesh --candidates block.cand --solution block.sol --smooth 0 --stats block.json -o block.inp
  $PYTHON - <<'PYTHON'
import json
cells = json.load(open("block.json"))["cells"]
assert cells["hex"]["count"] == 15 and cells["prism"]["count"] == 24, cells
assert cells["pyramid"]["count"] == cells["tet"]["count"] == 0, cells
nodes, reading = {}, False
for line in open("block.inp"):
    if line.startswith("*"):
        reading = line.upper().startswith("*NODE")
    elif reading:
        number, *at = line.split(",")
        nodes[int(number)] = [float(c) for c in at]
with open("case.inp", "w") as case:
    print("*INCLUDE, INPUT=block.inp\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3", file=case)
    print("*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n*STEP\n*STATIC\n*BOUNDARY", file=case)
    for number, at in nodes.items():
        for axis in range(3):
            if at[axis] == 0:
                print("%d, %d, %d, 0" % (number, axis + 1, axis + 1), file=case)
    print("*DSLOAD\nSURFACE_2, P, -210", file=case)
    print("*NODE PRINT, NSET=NALL\nU\n*END STEP", file=case)
json.dump(nodes, open("nodes.json", "w"))
PYTHON
  run timeout 60 ccx case
  assert_success
  $PYTHON - <<'PYTHON'
import json
nodes = json.load(open("nodes.json"))
moved = [line.split() for line in open("case.dat") if len(line.split()) == 4]
assert len(moved) == 64
for number, *by in moved:
    x, y, z = nodes[number]
    for found, exact in zip(map(float, by), (0.001 * x, -0.0003 * y, -0.0003 * z)):
        assert abs(found - exact) < 1e-9, (number, by, exact)
PYTHON
}
