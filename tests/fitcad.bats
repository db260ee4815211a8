# fitcad: the boundary of a result on the CAD's own faces and curves.
# bats file_tags=both

load helpers

setup_file() {
  # OpenCASCADE keeps what it made at its start.
  export LSAN_OPTIONS="suppressions=$BATS_TEST_DIRNAME/leaks_of_occt.txt:print_suppressions=0"
}

# cad NAME COMMANDS: NAME.step, by gmsh's OpenCASCADE.
cad() {
  printf 'SetFactory("OpenCASCADE");\n%s\n' "$2" >"$1.geo"
  gmsh -0 "$1.geo" -o "$1.step" >gmsh.log
}

# result NAME SIZE OPTIONS...: NAME.tar of NAME.step, with options of tessellate.
result() {
  local name=$1 size=$2
  shift 2
  tessellate -q "$name.step" "$@" | tetmesh -q --size "$size" | findhex | buildgraph | initsol --iterations 100 | assemble -q -o "$name.tar"
}

# holds_for MESH EXPRESSION: of the boundary's vertices p (n,3), of those of each tag (of[tag]), and of all facets.
holds_for() {
  $PYTHON - "$@" <<'PYTHON'
import io, sys, tarfile
import numpy as np
arrays = {}
with tarfile.open(sys.argv[1]) as bundle:
    for member in bundle:
        if member.name.startswith("result/"):
            arrays[member.name[7:-4]] = np.load(io.BytesIO(bundle.extractfile(member).read()))
facets = [(list(f), t) for kind in ("triangles", "quads") for f, t in zip(arrays[kind], arrays[f"{kind}_tags"])]
points = arrays["points"]
p = points[sorted({v for f, _ in facets for v in f})]
of = {int(tag): points[sorted({v for f, t in facets if t == tag for v in f})] for tag in {t for _, t in facets}}
middles = np.array([points[f].mean(axis=0) for f, _ in facets])
norm = np.linalg.norm
from_axis = lambda q: norm(q[:, :2], axis=1)
from_origin = lambda q: norm(q, axis=1)
assert eval(sys.argv[2]), (sys.argv[2], {tag: len(q) for tag, q in of.items()})
PYTHON
}

# All of the cylinder's side is at one distance from the axis; its ends are flat.
ON_CYLINDER='sorted(abs(from_axis(q) - 2).max() < 7.5e-6 for q in of.values()) == [False, False, True]'

# bats test_tags=optimized
@test "on a cylinder and on a sphere, vertices of the boundary are on the CAD, and were not before" {
  cad cylinder 'Cylinder(1) = {0, 0, 0, 0, 0, 5, 2};'
  result cylinder 0.8
  fitcad cylinder.tar -o fitted.tar --stats cylinder.json
  run holds_for cylinder.tar "$ON_CYLINDER"
  assert_failure
  holds_for fitted.tar "$ON_CYLINDER"
  holds_for fitted.tar 'set(np.round(p[from_axis(p) < 1.9999][:, 2], 9)) == {0, 5}'
  holds 'cylinder["distance"]["vertices"] < 1e-6 * cylinder["diagonal"] < cylinder["distance_before"]["vertices"]' cylinder.json
  holds 'cylinder["held"] == cylinder["strays"] == 0' cylinder.json
  # As far as chords are inside: found from the mesh alone.
  local within
  within=$($PYTHON -c "import json; d = json.load(open('cylinder.json'))['distance']; print(d['to_cad'])")
  holds_for fitted.tar "$within >= 2 - min(from_axis(middles[(middles[:, 2] > 1e-9) & (middles[:, 2] < 5 - 1e-9)])) - 1e-9 > 0.005"
  fitcad -q cylinder.tar -o cylinder.msh
  assert_conforming cylinder.msh

  cad ball 'Sphere(1) = {0, 0, 0, 1};'
  result ball 0.3
  fitcad -q ball.tar -o fitted.tar --stats ball.json
  run holds_for ball.tar 'abs(from_origin(p) - 1).max() < 2e-6'
  assert_failure
  holds_for fitted.tar 'abs(from_origin(p) - 1).max() < 2e-6'
  holds 'ball["distance"]["vertices"] < 1e-6 * ball["diagonal"]' ball.json
}

@test "curves that are hardly sharp, corners, and interfaces between bodies" {
  # A cone that turns by 17 degrees from the cylinder below it, both in a block that is cut off behind.
  cad vessel 'Cylinder(1) = {0, 0, 0, 0, 0, 2, 1}; Cone(2) = {0, 0, 2, 0, 0, 1, 1, 0.7}; BooleanUnion(3) = {Volume{1}; Delete;}{Volume{2}; Delete;};
    Box(4) = {-1.5, -1.5, -1, 3, 3, 5}; BooleanFragments{Volume{3, 4}; Delete;}{}'
  result vessel 0.41 --join
  fitcad -q vessel.tar -o fitted.tar --stats vessel.json
  holds 'vessel["distance"]["vertices"] < 1e-6 * vessel["diagonal"]' vessel.json
  # The box has eight corners.
  holds 'vessel["on_corners"] >= 8' vessel.json
  # Inside the block: the bottom, the side, the cone and the top; on the circle between side and cone there are vertices.
  holds_for fitted.tar 'all(min(abs(q[2]), abs(q[2] - 3), abs(norm(q[:2]) - 1), abs(norm(q[:2]) - 1 + 0.3 * (q[2] - 2))) < 1e-6 for q in p[(abs(p[:, :2]) < 1.49).all(axis=1) & (p[:, 2] > -0.99) & (p[:, 2] < 3.99)])'
  holds_for fitted.tar '(norm(np.column_stack([from_axis(p) - 1, p[:, 2] - 2]), axis=1) < 1e-6).sum() >= 12'
}

# bats test_tags=optimized
@test "faces that meet at a small angle: vertices near a curve that belong on a face go there, and none is held" {
  # A bar with three sides. At one end two of its corners have 6 degrees, and its sides are twisted.
  cad bar 'Point(1) = {0, 0, 0}; Point(2) = {0, 0, 5}; Point(3) = {1, 0.84, 0}; Point(4) = {1, -0.84, 0}; Point(5) = {1, 9, 5}; Point(6) = {1, -9, 5};
    Line(1) = {1, 2}; Line(2) = {3, 4}; Line(3) = {1, 3}; Line(4) = {1, 4}; Line(5) = {5, 6}; Line(6) = {2, 5}; Line(7) = {2, 6}; Line(8) = {3, 5}; Line(9) = {4, 6};
    Curve Loop(1) = {7, -9, -4, 1}; Surface(1) = {1}; Curve Loop(3) = {6, -8, -3, 1}; Surface(2) = {3}; Curve Loop(5) = {3, 2, -4}; Surface(3) = {5};
    Curve Loop(7) = {8, 5, -9, -2}; Surface(4) = {7}; Curve Loop(9) = {6, 5, -7}; Surface(5) = {9}; Surface Loop(1) = {5, 2, 4, 1, 3}; Volume(1) = {1};'
  result bar 0.26
  run_apart fitcad bar.tar -v -o bar.msh --stats bar.json
  assert_success
  holds 'bar["held"] == bar["strays"] == 0 and bar["distance"]["vertices"] < 1e-6 * bar["diagonal"] < bar["distance_before"]["vertices"]' bar.json
  grep -Eq '[0-9]+ cells other than hexes became poorer than 0.02' <<<"$stderr"
  holds 'bar["poorer_cells"] > 0' bar.json
  holds 'bar["cells"]["hex"]["scaled_jacobian"]["least"] > 0.3' bar.json
  assert_conforming bar.msh
}

@test "what is on the CAD to rounding stays where it is" {
  $PYTHON "$DATA/step.py" named >box.step
  result box 5
  fitcad -q box.tar -o fitted.tar --stats box.json
  holds 'box["moved"] == 0 and box["boundary_vertices"] > 50' box.json
}

@test "lengths are in the bundle's unit" {
  cad cylinder 'Cylinder(1) = {0, 0, 0, 0, 0, 5, 2};'
  result cylinder 0.0012 --unit m
  fitcad -q cylinder.tar -o fitted.tar --stats cylinder.json
  holds 'abs(cylinder["diagonal"] - 7.55e-3) < 1e-4' cylinder.json
  holds_for fitted.tar 'sorted(abs(from_axis(q) - 2e-3).max() < 7e-9 for q in of.values()) == [False, False, True]'
}

@test "--reach leaves vertices that are further from the CAD, which is told" {
  cad ball 'Sphere(1) = {0, 0, 0, 1};'
  result ball 0.4
  run_apart fitcad ball.tar --reach 1e-5 -o near.tar --stats near.json
  assert_success
  grep -Eq '^fitcad: warning: [0-9]+ of [0-9]+ vertices of the boundary are too far from the CAD' <<<"$stderr"
  holds 'near["strays"] > 10' near.json
  fitcad ball.tar -o all.tar
  assert_different_bytes near.tar all.tar
  fitcad ball.tar -o again.tar
  assert_same_bytes all.tar again.tar
}

@test "--cad takes the CAD's faces from a bundle beside the result, which may be a file" {
  cad ball 'Sphere(1) = {0, 0, 0, 1};'
  tessellate -q ball.step -o surface.tar
  result ball 0.4
  fitcad ball.tar -o one.tar
  mkdir ball && tar xf ball.tar -C ball
  (cd ball && tar cf ../ball.tar $(tar tf ../ball.tar | grep -v /shape))
  assert_fails_with 1 "expected the CAD's faces beside the result, found none" fitcad ball.tar -o x.tar
  fitcad ball.tar --cad surface.tar -o two.tar
  mkdir one two
  tar xf one.tar -C one && tar xf two.tar -C two
  assert_same_bytes one/result/points.npy two/result/points.npy
  assemble -q ball.tar -o ball.vtu
  fitcad ball.vtu --cad surface.tar -o fitted.tar
  holds_for fitted.tar 'abs(from_origin(p) - 1).max() < 2e-6'
  assert_fails_with 1 "^fitcad: ball.vtu: expected a bundle" fitcad ball.tar --cad ball.vtu -o x.tar
}

@test "names stay; a result without CAD, and a shape that is damaged, are errors" {
  $PYTHON "$DATA/step.py" named >named.step
  result named 4
  fitcad -q named.tar -o named.msh
  tessellate -q named.step -o surface.tar
  local name
  for name in $(tar xOf surface.tar names.json | tr -d '[]{}' | grep -o '"[a-z]*"' | sort -u | grep -v surfaces | grep -v regions | grep -v curves); do grep -q "$name" named.msh; done
  tetmesh -q "$DATA/cube.stl" --size 0.5 | findhex | buildgraph | initsol --iterations 10 | assemble -q -o cube.tar
  assert_fails_with 1 "^fitcad: cube.tar: result: expected the CAD's faces beside the result, found none" fitcad cube.tar -o x.vtu
  assert_fails_with 1 'expected result for fitcad' shell "tetmesh -q '$DATA/cube.stl' --size 0.5 | fitcad -o x.vtu"
  # replaced MEMBER: named.tar with standard input in place of a member.
  replaced() {
    mkdir -p out && tar xf named.tar -C out && cat >"out/$1"
    (cd out && tar cf ../damaged.tar $(tar tf ../named.tar))
    rm -r out
  }
  echo garbage | replaced surface/shape.brep
  assert_fails_with 1 "^fitcad: damaged.tar.*surface/shape.brep: " fitcad damaged.tar -o x.vtu
  echo '{"unit":1,"faces":[1],"edges":[]}' | replaced surface/shape.json
  assert_fails_with 1 "surface/shape.json: expected tags of [0-9]+ faces, found 1" fitcad damaged.tar -o x.vtu
  echo '{"unit":0,"faces":[1],"edges":[]}' | replaced surface/shape.json
  assert_fails_with 1 "surface/shape.json: expected a unit above 0, found 0" fitcad damaged.tar -o x.vtu
  echo '{"unit":1,"faces":"all"}' | replaced surface/shape.json
  assert_fails_with 1 "surface/shape.json: expected .* found something else" fitcad damaged.tar -o x.vtu
  echo '[' | replaced surface/shape.json
  assert_fails_with 1 "surface/shape.json: expected .* found no such object" fitcad damaged.tar -o x.vtu
  assert [ ! -e x.vtu ]
}

@test "layers at walls go onto the CAD with the rest, and stay valid" {
  cad cylinder 'Cylinder(1) = {0, 0, 0, 0, 0, 5, 2};'
  tessellate -q cylinder.step | tetmesh -q --size 0.8 | findhex | buildgraph | initsol --iterations 100 |
    assemble -q --boundary-layers all=3 --first-height 0.05 --growth 1.2 --stats layers.json -o cylinder.tar
  fitcad cylinder.tar -o fitted.tar --stats cylinder.json
  holds 'layers["layers"]["share_of_area_with_layers"] == 1' layers.json
  holds 'cylinder["distance"]["vertices"] < 1e-6 * cylinder["diagonal"] < cylinder["distance_before"]["vertices"]' cylinder.json
  holds_for fitted.tar "$ON_CYLINDER"
  fitcad cylinder.tar -o fitted.vtu
  assert_conforming fitted.vtu
}
