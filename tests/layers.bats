# Layers at walls: assemble --boundary-layers and --pillow.
# bats file_tags=both

load helpers

# $WORK: box.tar, a box of 6 x 6 x 6 hexes with a name for each side, and pipe.tar, of which hexes, prisms, pyramids and
# tets are left.
setup_file() {
  load helpers
  export WORK="$BATS_FILE_TMPDIR"
  cd "$WORK"
  if ! command -v tetmesh >/dev/null; then return; fi
  $PYTHON "$DATA/box.py" 6 >box.off
  tetmesh box.off --size 1 --tags-by-angle --name 1=floor --name '2=a lid' | findhex | buildgraph | initsol --iterations 0 -o box.tar
  $PYTHON - >pipe.off <<PYTHON
from math import cos, sin, pi
n, length = 24, 3
ring = [(cos(2 * pi * i / n), sin(2 * pi * i / n)) for i in range(n)]
points = [(x, y, z) for z in (0, length) for x, y in ring] + [(0, 0, 0), (0, 0, length)]
faces = []
for i in range(n):
    j = (i + 1) % n
    faces += [(i, j, n + j), (i, n + j, n + i), (2 * n, j, i), (2 * n + 1, n + i, n + j)]
print("OFF\n%d %d 0" % (len(points), len(faces)))
for p in points:
    print("%.9f %.9f %.9f" % p)
for f in faces:
    print(3, *f)
PYTHON
  tetmesh pipe.off --size 0.38 --tags-by-angle --name 1=inlet --name 2=outlet --name 3=wall | findhex | buildgraph |
    initsol --iterations 5000 -o pipe.tar
}

setup() {
  if ! command -v tetmesh >/dev/null; then skip "tetmesh makes the parts"; fi
  mkdir "$BATS_TEST_TMPDIR/work" && cd "$BATS_TEST_TMPDIR/work"
}

# expect FILE EXPRESSION: a Python expression over the checker's findings s.
expect() {
  $PYTHON -c "
import json, sys
s = json.loads(sys.argv[1])
assert eval(sys.argv[2]), (sys.argv[2], s)" "$($PYTHON "$CHECKERS/meshstats.py" --json --exact "$1")" "$2"
}

sound='s["is_conforming"] and s["open_quads"] == s["invalid_hexes"] == s["inverted_cells"] == s["unused_points"] == 0'

@test "layers on one side of a box, as another program sees them" {
  assemble "$WORK/box.tar" --boundary-layers 'floor=3' --first-height 0.05 --stats stats.json -o mesh.vtu
  expect mesh.vtu "$sound and s['hexes'] == 216 + 3 * 36 and abs(s['volume'] - 216) < 1e-9"
  holds 'stats["layers"]["cells"] == 108 and stats["layers"]["share_of_area_with_all_height"] == 1' stats.json
  # The same by number, and with blanks.
  assemble "$WORK/box.tar" --boundary-layers ' 1 = 3 ' --first-height 0.05 -o number.vtu
  assert_same_bytes mesh.vtu number.vtu
}

@test "layers on several sides, and on all of the boundary" {
  assemble "$WORK/box.tar" --boundary-layers 'floor=3, a lid=2' --first-height 0.05 -o two.vtu
  expect two.vtu "$sound and s['hexes'] == 216 + 5 * 36 and abs(s['volume'] - 216) < 1e-9"
  assemble "$WORK/box.tar" --boundary-layers 'all=2' --first-height 0.05 -o all.vtu
  expect all.vtu "$sound and s['hexes'] == 216 + 2 * 216 and abs(s['volume'] - 216) < 1e-9"
}

@test "--first-height and --growth tell the heights" {
  for options in "0.05 --growth 1.2" "0.05 --growth 2" "0.04 --growth 2"; do
    # shellcheck disable=SC2086
    assemble "$WORK/box.tar" --boundary-layers floor=3 --first-height $options -o mesh.vtu
    $PYTHON - "$options" <<'PYTHON'
import sys, meshio
first, growth = float(sys.argv[1].split()[0]), float(sys.argv[1].split()[2])
floor = {1: 0, 2: 1, 3: 2}
points = meshio.read("mesh.vtu").points
best = None
for axis in range(3):
    for side in (0, 6):
        heights = sorted({round(abs(p[axis] - side), 9) for p in points})[:4]
        want = [0, first, first * (1 + growth), first * (1 + growth + growth**2)]
        best = best or all(abs(a - b) < 1e-6 for a, b in zip(heights, want))
assert best, sys.argv
PYTHON
  done
}

@test "layers on the wall of a pipe slide along its ends, and the other way round" {
  assemble "$WORK/pipe.tar" -o plain.vtu
  for walls in wall=5 'inlet=4, outlet=4' all=5; do
    assemble "$WORK/pipe.tar" --boundary-layers "$walls" --first-height 0.01 --stats stats.json -o mesh.vtu
    expect mesh.vtu "$sound and abs(s['volume_gap']) < 1e-12"
    holds 'stats["layers"]["share_of_area_with_layers"] > 1 - 1e-9 and stats["layers"]["scaled_jacobian"]["least"] > 0.2' stats.json
  done
}

# bats test_tags=optimized
@test "layers are the same for any number of threads" {
  assemble --threads 1 "$WORK/pipe.tar" --boundary-layers all=4 --first-height 0.02 -o one.vtu
  assemble --threads 3 "$WORK/pipe.tar" --boundary-layers all=4 --first-height 0.02 -o three.vtu
  assert_same_bytes one.vtu three.vtu
}

@test "heights beyond the half of a part are lower, which is told" {
  assemble "$WORK/box.tar" --boundary-layers all=3 --first-height 2 --stats stats.json -o mesh.vtu 2>said
  expect mesh.vtu "$sound and abs(s['volume'] - 216) < 1e-9"
  grep -q "warning: layers have the height that --first-height and --growth give on 0.0 % of the walls' area, less on 100.0 %" said
  holds 'stats["layers"]["share_of_area_with_layers"] > 1 - 1e-9 and stats["layers"]["least_share_of_height"] < 0.5' stats.json
}

@test "a knife edge, a tip of ten facets, and a plate lower than its layers have valid layers" {
  $PYTHON "$DATA/surfaces.py" narrow
  $PYTHON "$DATA/surfaces.py" box 6 6 0.4 >plate.obj
  local part size height
  while read -r part size height; do
    tetmesh -q "$part" --size "$size" | findhex | buildgraph | initsol --iterations 1000 |
      assemble -q --boundary-layers all=5 --first-height "$height" --growth 1.2 --stats stats.json -o mesh.vtu
    expect mesh.vtu "$sound"
    holds 'stats["layers"]["share_of_area_with_some_layers"] == 1 and stats["layers"]["share_of_area_with_layers"] > 0.9' stats.json
  done <<'PARTS'
knife.off 0.35 0.05
star.off 0.5 0.04
plate.obj 0.4 1
PARTS
}

# bats test_tags=optimized
@test "every format takes layers, with names" {
  local format
  for format in mesh msh vtk inp su2 bdf; do
    assemble -q "$WORK/pipe.tar" --boundary-layers wall=2 --first-height 0.02 -o "mesh.$format"
    assert [ -s "mesh.$format" ]
  done
  grep -q '"outlet"' mesh.msh
  assemble -q "$WORK/pipe.tar" --boundary-layers wall=2 --first-height 0.02 -o polyMesh
  assert [ -s polyMesh/faces ]
}

# bats test_tags=optimized
@test "with --order 2, feet on curved walls keep the first height" {
  # Between the coarse ring's corners, vertices are up to 0.017 off the fine one.
  "$DATA/ring.py" 6 >coarse.stl
  "$DATA/ring.py" >ring.stl
  tetmesh coarse.stl --size 0.3 -q | findhex | buildgraph | initsol --iterations 20000 -o ring.tar
  assemble -q ring.tar --boundary-layers 'inner=3, outer=3' --first-height 0.02 --order 2 --surface ring.stl --stats stats.json -o ring.vtu
  holds 'stats["layers"]["share_of_area_with_all_height"] == 1 and stats["second_order"]["corners_off_surface"] > 0' stats.json
  $PYTHON - <<'PYTHON'
import meshio, numpy as np
for kind in ("wedge15", "pyramid13"):
    meshio._mesh.topological_dimension.setdefault(kind, 3)
mesh = meshio.read("ring.vtu")
corners = {"triangle6": 3, "quad8": 4, "tetra10": 4, "pyramid13": 5, "wedge15": 6, "hexahedron20": 8}
feet, others = set(), set()
for block, tags in zip(mesh.cells, mesh.cell_data["surface"]):
    nodes = np.asarray(block.data)[:, :corners[block.type]]
    others.update(nodes.ravel())
    if block.type in ("triangle6", "quad8"):
        feet.update(nodes[np.isin(np.asarray(tags).ravel(), (1, 2))].ravel())
others = mesh.points[sorted(others - feet)]
heights = np.array([np.linalg.norm(others - foot, axis=1).min() for foot in mesh.points[sorted(feet)]])
assert len(heights) > 50 and abs(heights / 0.02 - 1).max() < 0.15, (len(heights), heights.min(), heights.max())
PYTHON
}

# bats test_tags=optimized
@test "OpenFOAM finds layers well" {
  command -v checkMesh >/dev/null || skip "openfoam is not installed"
  export WM_PROJECT_DIR=${WM_PROJECT_DIR:-/usr/share/openfoam}
  mkdir -p case/system case/constant
  local head='FoamFile { version 2.0; format ascii; class dictionary; object dictionary; }'
  echo "$head application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep; writeInterval 1;" >case/system/controlDict
  echo "$head ddtSchemes { default steadyState; } gradSchemes { default Gauss linear; } divSchemes { default none; } laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } snGradSchemes { default corrected; }" >case/system/fvSchemes
  echo "$head" >case/system/fvSolution
  assemble -q "$WORK/pipe.tar" --boundary-layers wall=5 --first-height 0.01 -o case/constant/polyMesh
  run checkMesh -case case
  assert_success
  assert_output --partial "Mesh OK."
}

@test "--pillow puts one layer under the boundary, behind those of walls" {
  assemble "$WORK/box.tar" --pillow -o pillow.vtu
  expect pillow.vtu "$sound and s['hexes'] == 216 + 216 and abs(s['volume'] - 216) < 1e-9"
  assemble "$WORK/box.tar" --pillow --boundary-layers floor=2 --first-height 0.05 -o both.vtu
  expect both.vtu "$sound and s['hexes'] == 216 + 216 + 72"
}

@test "bad walls: one line, which says what is expected" {
  assert_fails_with 1 "box.tar: .*expected a surface by its name or number, found 'flor' \(did you mean 'floor'\?\); there are 1 \(floor\)" \
    assemble "$WORK/box.tar" --boundary-layers flor=3 --first-height 0.05 -o x.vtu
  assert_fails_with 1 "expected as many layers on surfaces that touch, found [34] on surface .* and [34] on ." \
    assemble "$WORK/box.tar" --boundary-layers 'floor=3, 3=4' --first-height 0.05 -o x.vtu
  assert_fails_with 1 "expected a region by its name or number, found 'water'; there are 1" \
    assemble "$WORK/box.tar" --boundary-layers 'floor in water=3' --first-height 0.05 -o x.vtu
  assert_fails_with 2 "expected 1 to 100 layers on 'floor', found '0'" assemble "$WORK/box.tar" --boundary-layers floor=0 --first-height 0.05 -o x.vtu
  assert_fails_with 2 "as 'wall=5', found 'floor'" assemble "$WORK/box.tar" --boundary-layers floor --first-height 0.05 -o x.vtu
  assert_fails_with 2 "--first-height: expected a number" assemble "$WORK/box.tar" --boundary-layers floor=3 --first-height -1 -o x.vtu
  assert_fails_with 2 "--growth: expected a number" assemble "$WORK/box.tar" --boundary-layers floor=3 --first-height 0.1 --growth 0 -o x.vtu
  assert_fails_with 2 "--boundary-layers goes with --first-height" assemble "$WORK/box.tar" --boundary-layers floor=3 -o x.vtu
  assert_fails_with 1 "box.tar: mesh: --first-height: expected at least 1.04e-08, 1e-09 of the diagonal of the mesh, found 1e-08" \
    assemble "$WORK/box.tar" --boundary-layers floor=3 --first-height 1e-8 -o x.vtu
  assert_fails_with 2 "--growth: expected layers of heights that differ by a factor of at most 1e\+06, found 1e\+07 for 8 layers on 'floor'" \
    assemble "$WORK/box.tar" --boundary-layers floor=8 --first-height 0.05 --growth 0.1 -o x.vtu
  assert_fails_with 2 "go with --boundary-layers" assemble "$WORK/box.tar" --growth 1.1 -o x.vtu
  assert_fails_with 2 "go with --conformity pyramids" assemble "$WORK/box.tar" --pillow --conformity none -o x.vtu
  assert [ ! -e x.vtu ]
}
