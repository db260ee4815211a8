# What solvers and mesh converters make of our files: CalculiX, OpenFOAM, Gmsh and meshio find what we put there.

load helpers

MESH="$DATA/meshes/one_of_each.msh"

need_calculix() {
  command -v ccx >/dev/null || skip "calculix-ccx is not installed"
}

# openfoam is large: only where it happens to be installed.
need_openfoam() {
  command -v checkMesh >/dev/null || skip "openfoam is not installed"
  export WM_PROJECT_DIR=${WM_PROJECT_DIR:-/usr/share/openfoam}
}

# openfoam_case DIRECTORY: the dictionaries that every application of OpenFOAM wants to see.
openfoam_case() {
  mkdir -p "$1/system" "$1/constant"
  local head='FoamFile { version 2.0; format ascii; class dictionary; object dictionary; }'
  echo "$head
application laplacianFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1;
writeControl timeStep; writeInterval 1; writePrecision 12;" >"$1/system/controlDict"
  echo "$head
ddtSchemes { default steadyState; } gradSchemes { default Gauss linear; } divSchemes { default none; }
laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; }
snGradSchemes { default corrected; }" >"$1/system/fvSchemes"
  echo "$head
solvers { T { solver PCG; preconditioner DIC; tolerance 1e-12; relTol 0; } } SIMPLE { nNonOrthogonalCorrectors 20; }" \
    >"$1/system/fvSolution"
}

# whole_mesh [TAG]: whole.msh has a cell of each kind, and all of their outer faces as one surface.
whole_mesh() {
  sed '/ElementData/,$d' "$MESH" >plain.msh
  "$PYTHON" "$DATA/meshes/whole_surface.py" plain.msh whole.msh "${1:-1}" >judge.log 2>&1 || fail "$(cat judge.log)"
}

# inp_fields FILE: the widest field and the longest line.
inp_fields() {
  awk -F', *' '{ if (length($0) > line) line = length($0)
                 for (i = 1; i <= NF; ++i) if (length($i) > field) field = length($i) }
               END { print field, line }' <(grep -v '^\*' "$1")
}

# volume_of FILE.inp: of all elements together, as CalculiX measures it.
volume_of() {
  echo "*INCLUDE, INPUT=$1
*MATERIAL, NAME=STEEL
*ELASTIC
210000, 0.3
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
*STEP
*STATIC
*BOUNDARY
NALL, 1, 3, 0
*EL PRINT, ELSET=EALL, TOTALS=ONLY
EVOL
*END STEP" >case.inp
  rm -f case.dat
  timeout 60 ccx case >ccx.log || return 1
  awk '/total volume/ { getline; getline; printf "%.3f\n", $1 }' case.dat
}

@test "CalculiX reads coordinates of many digits as they are meant" {
  mesh_convert "$DATA/meshes/long_numbers.mesh" inp long.inp
  run sed -n 4p long.inp
  assert_output "1, 0, 0, 0"
  # Digits that do not fit are left out at their end; what is small beside the mesh but not nothing stays.
  sed 's/1.110223024625157e-16/-9.52639091424853e-05/; s/^1 0 0 0$/1.0000000000000002 1.2345678901234567e-11 0 0/' \
    "$DATA/meshes/long_numbers.mesh" >longer.mesh
  mesh_convert longer.mesh inp longer.inp
  run sed -n '4,5p' longer.inp
  assert_output "1, 0, 0, -9.5263909142485e-05
2, 1.0000000000000002, 1.23456789012346e-11, 0"
  local name found
  for name in long longer; do
    found=$(inp_fields $name.inp)
    assert [ "${found% *}" -le 20 ]
  done
  need_calculix
  for name in long longer; do
    run volume_of $name.inp
    assert_output "1.000"
  done
}

@test "lines of .inp are of 80 characters at most" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 12 >big.mesh
  mesh_convert big.mesh inp big.inp
  run inp_fields big.inp
  assert [ "${output#* }" -le 80 ]
  assert [ "${output#* }" -gt 60 ]
}

# pressed FILE.inp: with the pressure 210 on SURFACE_1, which is all of the boundary, every point moves by -0.0004 of its
# place, whatever the cells are: E = 210000, nu = 0.3. Held are three points, so that it neither moves nor turns.
pressed() {
  $PYTHON - "$1" <<'PYTHON'
import sys
nodes, reading = {}, False
for line in open(sys.argv[1]):
    if line.startswith("*"):
        reading = line.upper().startswith("*NODE")
    elif reading:
        number, *at = line.split(",")
        nodes[int(number)] = tuple(float(c) for c in at)
by_place = {at: number for number, at in nodes.items()}
with open("case.inp", "w") as case:
    print("*INCLUDE, INPUT=%s\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3" % sys.argv[1], file=case)
    print("*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n*BOUNDARY", file=case)
    for at, first, last in (((0, 0, 0), 1, 3), ((1, 0, 0), 2, 3), ((0, 1, 0), 3, 3)):
        print("%d, %d, %d, 0" % (by_place[at], first, last), file=case)
    print("*STEP\n*STATIC\n*DSLOAD\nSURFACE_1, P, 210\n*NODE PRINT, NSET=NALL\nU\n*END STEP", file=case)
PYTHON
  rm -f case.dat
  timeout 60 ccx case >ccx.log || return 1
  $PYTHON - "$1" <<'PYTHON'
import sys
nodes, reading = {}, False
for line in open(sys.argv[1]):
    if line.startswith("*"):
        reading = line.upper().startswith("*NODE")
    elif reading:
        number, *at = line.split(",")
        nodes[int(number)] = [float(c) for c in at]
moved = [line.split() for line in open("case.dat") if len(line.split()) == 4]
assert len(moved) == len(nodes), (len(moved), len(nodes))
for number, *by in moved:
    for found, c in zip(map(float, by), nodes[int(number)]):
        assert abs(found + 0.0004 * c) < 1e-9, (number, by, nodes[int(number)])
PYTHON
}

@test "CalculiX presses all kinds of cells alike, with collapsed pyramids" {
  need_calculix
  # With flat faces: on warped ones its prisms are not integrated exactly.
  whole_mesh
  sed -i 's/^11 1.0 0.5 2.1$/11 1 0.5 2/' whole.msh
  mesh_convert whole.msh inp collapsed.inp "" collapsed
  grep -q '^11, 1, 0.5, 2$' collapsed.inp
  grep -q '^3, 2, 3, 7, 6, 9, 9, 9, 9$' collapsed.inp
  pressed collapsed.inp
  mesh_convert whole.msh inp incompatible.inp "" collapsed C3D8I
  grep -A1 -n 'TYPE=C3D8I' incompatible.inp | grep -q '1, 1, 2, 3, 4, 5, 6, 7, 8'
  pressed incompatible.inp
  # As they are, it has no such cells.
  mesh_convert whole.msh inp kept.inp
  grep -q 'TYPE=C3D5' kept.inp
  run pressed kept.inp
  assert_failure
}

@test "CalculiX takes split pyramids for what they are, but quads against triangles do not balance" {
  need_calculix
  whole_mesh
  sed -i 's/^11 1.0 0.5 2.1$/11 1 0.5 2/' whole.msh
  mesh_convert whole.msh inp collapsed.inp "" collapsed
  mesh_convert whole.msh inp split.inp "" split 2>said
  assert_equal "$(<said)" "mesh_convert: 1 pyramids are written as two tets each: their quads face two triangles"
  assert_equal "$(grep -c 'C3D5\|, 9, 9' split.inp)" 0
  assert_equal "$(volume_of split.inp)" "$(volume_of collapsed.inp)"
  assert_equal "$(volume_of split.inp)" 2.000
  # docs/solvers.md advises against it.
  run pressed split.inp
  assert_failure
}

# bend FILE.inp: how far the end of a beam of 10 x 1 x 1 bends under a force, beside what beam theory says.
bend() {
  cat >case.inp <<INP
*INCLUDE, INPUT=$1
*MATERIAL, NAME=STEEL
*ELASTIC
210000, 0
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
*BOUNDARY
root, 1, 3, 0
*STEP
*STATIC
*CLOAD
tip, 3, 0.25
*NODE PRINT, NSET=tip
U
*END STEP
INP
  timeout 60 ccx case >ccx.log
  # F L^3 / (3 E I) with four nodes of 0.25, and shear: 6/5 F L / (G A)
  awk 'NF == 4 { sum += $4; ++count } END { theory = 1000 / (3 * 210000 / 12) + 1.2 * 10 / 105000
                                            printf "%.3f\n", sum / count / theory }' case.dat
}

@test "CalculiX bends a beam of one layer of hexes as far as it should with C3D8I, by node sets with names" {
  need_calculix
  $PYTHON - >beam.mesh <<'PYTHON'
n = 10
def at(i, j, k): return 4 * i + 2 * k + j + 1
print("MeshVersionFormatted 2\nDimension 3\nVertices\n%d" % (4 * (n + 1)))
for i in range(n + 1):
    for k in range(2):
        for j in range(2):
            print(i, j, k, 0)
print("Hexahedra\n%d" % n)
for i in range(n):
    print(*(at(i + a, b, c) for a, b, c in ((0,0,0),(1,0,0),(1,1,0),(0,1,0),(0,0,1),(1,0,1),(1,1,1),(0,1,1))), 1)
print("Quadrilaterals\n2\n%d %d %d %d 4\n%d %d %d %d 5\nEnd" % (at(0,0,0), at(0,0,1), at(0,1,1), at(0,1,0),
      at(n,0,0), at(n,1,0), at(n,1,1), at(n,0,1)))
PYTHON
  local names='{"surfaces": {"4": "root", "5": "tip"}}' found
  mesh_convert beam.mesh inp good.inp "$names" "" C3D8I
  mesh_convert beam.mesh inp reduced.inp "$names" "" C3D8R
  mesh_convert beam.mesh inp plain.inp "$names"
  found=$(bend good.inp)
  assert awk -v x="$found" 'BEGIN { exit !(x > 0.97 && x < 1.03) }'
  assert_different_bytes good.inp reduced.inp
  assert_different_bytes plain.inp reduced.inp
}

@test "assemble writes for a solver, and says what that means" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 4 >lattice.mesh
  findhex --mesh lattice.mesh | buildgraph | initsol --iterations 0 -o solved.tar
  run_apart assemble solved.tar --solver calculix -v -o a.inp
  assert_success
  [[ "$stderr" == *"for calculix: pyramids are collapsed (of second order split), hexes are C3D8I (of second order C3D20)"* ]]
  grep -q 'TYPE=C3D8I' a.inp
  assemble solved.tar --solver calculix --pyramids keep --hex-element C3D8 -o b.inp
  assemble solved.tar -o c.inp
  assert_same_bytes b.inp c.inp
  # The other commands of docs/solvers.md.
  grep -oE 'assemble stages.tar --solver [a-z0-9-]+ -o part[.][a-z0-9]+' "$HEXPIPE_SOURCE/docs/solvers.md" >commands
  assert_equal "$(wc -l <commands)" 8
  cp solved.tar stages.tar
  while read -r command; do
    rm -f part.*
    if ! $command 2>said; then
      # A format that needs a library, where it was not built.
      grep -q 'expected result as' said
      continue
    fi
    assert [ -s part.* ]
  done <commands
  assemble solved.tar --no-facets -o cells.vtu
  assemble solved.tar -o all.vtu
  assert_different_bytes cells.vtu all.vtu
  run "$PYTHON" "$CHECKERS/mesh_contents.py" vtk cells.vtu
  assert_success
  assert_equal "$(cut -d' ' -f1 <<<"$output" | sort -u)" hex
  assert_fails_with 2 "solver calculix goes with inp, found vtu" assemble solved.tar --solver calculix -o a.vtu
  assert_fails_with 2 "pyramids collapsed goes with inp.* found su2" assemble solved.tar --pyramids collapsed -o a.su2
  assert_fails_with 2 "hex-element goes with inp, found msh" assemble solved.tar --hex-element C3D8I -o a.msh
  assert_fails_with 2 "polyMesh is a folder" assemble solved.tar --format polyMesh
  # They change no bundle, and so not its history either.
  assemble solved.tar -o one.tar
  assemble solved.tar --no-facets -o two.tar
  assert_same_bytes one.tar two.tar
}

@test "for deal.II no facet lies between two cells" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 >lattice.mesh
  $PYTHON "$DATA/lattices/two_bodies.py" lattice.mesh 2 >bodies.mesh
  findhex --mesh bodies.mesh | buildgraph | initsol --iterations 0 -o bodies.tar
  local order options
  for order in 1 2; do
    options="--order $order"
    assemble bodies.tar $options -o all.msh 2>/dev/null
    run_apart assemble bodies.tar $options --solver dealii -o outer.msh
    assert_success
    [[ "$stderr" == *"4 facets that are not on the boundary are left out: the solver takes none"* ]]
    "$PYTHON" - <<'PYTHON' 2>/dev/null
import meshio
def elements(path, kinds):
    mesh = meshio.read(path)
    return sorted(mesh.points[element].tolist() for block in mesh.cells if block.type.startswith(kinds) for element in block.data)
cells = ("hexahedron", "wedge", "pyramid", "tetra")
assert elements("all.msh", cells) == elements("outer.msh", cells) != []
inner = lambda facet: all(x == 1 for x, y, z in facet)
facets = elements("all.msh", ("triangle", "quad"))
assert elements("outer.msh", ("triangle", "quad")) == [facet for facet in facets if not inner(facet)]
assert sum(map(inner, facets)) == 4
PYTHON
  done
  assert_fails_with 2 "solver dealii goes with msh or msh-binary, found vtu" assemble bodies.tar --solver dealii -o a.vtu
}

@test "a prism that gmshToFoam would turn round goes back to its tets" {
  cat >warped.mesh <<'MESH'
MeshVersionFormatted 2
Dimension 3
Vertices
6
.1 .13859 .21934 0
.07927 .13784 .21934 0
.1 .13645 .23754 0
.1 .17926 .21308 0
.07681 .17868 .21538 0
.1 .17677 .21751 0
Tetrahedra
3
1 2 3 5 1
1 5 3 6 1
1 5 6 4 1
End
MESH
  local cells count
  sed 's/^.07681 .17868 .21538 0$/.07927 .17784 .21934 0/; s/^.1 .17926 .21308 0$/.1 .17859 .21934 0/
       s/^.1 .17677 .21751 0$/.1 .17645 .23754 0/' warped.mesh >upright.mesh
  for cells in warped upright; do
    findhex --mesh $cells.mesh --cells prism --min-quality 0.05 | buildgraph | initsol --iterations 0 -o $cells.tar
    assemble $cells.tar --smooth 0 --fill none --stats $cells.json -o $cells.msh22
  done
  count() { "$PYTHON" -c 'import json, sys; print(json.load(open(sys.argv[1]))["cells"]["prism"]["count"])' "$1"; }
  assert_equal "$(count upright.json)" 1
  assert_equal "$(count warped.json)" 0
  need_openfoam
  openfoam_case case
  mv upright.msh22 upright.msh
  run gmshToFoam -case case upright.msh
  assert_success
  refute_output --partial Inverting
}

@test "OpenFOAM finds cells, patches, zones and the volume in a polyMesh" {
  need_openfoam
  openfoam_case case
  whole_mesh 5
  # A facet between two cells, on surface 7.
  sed -i 's/^16$/17/; s/^.EndElements/17 3 2 7 7 2 3 7 6\n&/' whole.msh
  mesh_convert whole.msh polyMesh case/constant/polyMesh \
    '{"surfaces": {"5": "main inlet"}, "regions": {"1": "main_inlet", "2": "water"}}' 2>said
  assert_equal "$(grep -c "'main inlet' is written as main_inlet" said)" 1
  run checkMesh -case case -allTopology
  assert_success
  for line in "hexahedra: +1" "prisms: +1" "pyramids: +1" "tetrahedra: +1" "polyhedra: +0" "boundary patches: +1" "face zones: +1" \
    "cell zones: +4" "Upper triangular ordering OK" "main_inlet +[0-9]+ .*ok" "Total volume = 2.04166"; do
    assert_output --regexp "$line"
  done
  run cat case/constant/polyMesh/cellZones
  for name in main_inlet_2 water region_3 region_4; do assert_output --partial "$name"; done
  # The facet looks as its face does, from the hex to the pyramid.
  run bash -c 'tr -s "\n" " " <case/constant/polyMesh/faceZones | grep -o "surface_7.*"'
  assert_output --partial "surface_7 { type faceZone; faceLabels List<label> 1 ( 1 ) ; flipMap List<bool> 1 ( 0 ) ; }"
}

@test "checkMesh counts the faces and cells that --stats counts as poor for finite volumes" {
  need_openfoam
  openfoam_case case
  $PYTHON "$DATA/lattices/lattice.py" kuhn 5 >kuhn.mesh
  findhex --mesh kuhn.mesh -o kuhn.cand
  findhex --mesh kuhn.mesh | buildgraph | initsol --iterations 0 -o full.sol
  awk '!(NR <= 5 || NR % 7 == 0)' full.sol >kuhn.sol
  # Without smoothing there are poor ones.
  assemble --mesh kuhn.mesh --candidates kuhn.cand --solution kuhn.sol --smooth 0 --stats stats.json \
    --solver openfoam --polyhedra none -o case/constant/polyMesh
  checkMesh -case case -allGeometry >found.txt
  $PYTHON - <<'PYTHON'
import json, re
ours, text = json.load(open("stats.json"))["finite_volumes"], open("found.txt").read()
def number(pattern):
    found = re.search(pattern + r"\s*([0-9.e+-]+)", text)
    return float(found.group(1)) if found else 0
assert ours["orthogonality"]["misses"] == number(r"\(> 70 degrees\) faces:") + number("non-orthogonality errors:") > 0
assert ours["determinant"]["misses"] == number("small determinant.*number of cells:") > 0
assert ours["inner_faces"] == number("internal faces:")
for measure, pattern in (("orthogonality", "non-orthogonality Max:"), ("flatness", r"butterfly\) : min ="),
                         ("weight", "interpolation weight : minimum:"), ("determinant", r"\(wellposedness\) : minimum:")):
    assert abs(ours[measure]["worst"] - number(pattern)) < 1e-5 * max(1, number(pattern)), (measure, ours[measure], number(pattern))
assert abs(ours["mean_orthogonality"] - number("Max: [0-9.]+ average:")) < 1e-3
PYTHON
}

# tagged_lattice N: tagged.mesh, tets in a cube. The sides x = 0 and x = N are surfaces 1 and 2, the others 3.
tagged_lattice() {
  $PYTHON "$DATA/lattices/lattice.py" kuhn "$1" >untagged.mesh
  $PYTHON - "$1" <<'PYTHON'
import itertools, sys
words = iter(open("untagged.mesh").read().split())
sections = {}
for word in words:
    if word in ("Vertices", "Tetrahedra"):
        sections[word] = [[next(words) for _ in range(4 if word == "Vertices" else 5)] for _ in range(int(next(words)))]
points = [[float(c) for c in p[:3]] for p in sections["Vertices"]]
faces = {}
for tet in sections["Tetrahedra"]:
    for face in itertools.combinations(map(int, tet[:4]), 3):
        faces[tuple(sorted(face))] = faces.get(tuple(sorted(face)), 0) + 1
text = open("untagged.mesh").read().replace("End", "")
lines = []
for face, count in faces.items():
    if count == 1:
        xs = {points[v - 1][0] for v in face}
        lines.append("%d %d %d %d" % (*face, 1 if xs == {0} else 2 if xs == {float(sys.argv[1])} else 3))
open("tagged.mesh", "w").write(text + "Triangles\n%d\n%s\nEnd\n" % (len(lines), "\n".join(lines)))
PYTHON
}

# expect_linear_heat N: laplacianFoam on case finds the temperature x at the centres of cells, N at x = N.
expect_linear_heat() {
  mkdir case/0
  echo 'FoamFile { version 2.0; format ascii; class volScalarField; object T; }
dimensions [0 0 0 1 0 0 0]; internalField uniform 0;
boundaryField { surface_1 { type fixedValue; value uniform 0; } surface_2 { type fixedValue; value uniform '"$1"'; }
  surface_3 { type zeroGradient; } }' >case/0/T
  echo 'FoamFile { version 2.0; format ascii; class dictionary; object transportProperties; }
DT DT [0 2 -1 0 0 0 0] 1;' >case/constant/transportProperties
  run laplacianFoam -case case
  assert_success
  run postProcess -case case -latestTime -func writeCellCentres
  assert_success
  $PYTHON - <<'PYTHON'
import re
def field(name):
    text = open("case/1/" + name).read()
    return [float(x) for x in re.search(r"internalField\s+nonuniform List<scalar>\s*\d+\s*\((.*?)\)", text, re.S).group(1).split()]
T, x = field("T"), field("Cx")
assert len(T) == len(x) > 60
assert max(abs(a - b) for a, b in zip(T, x)) < 1e-6, max(abs(a - b) for a, b in zip(T, x))
PYTHON
}

@test "OpenFOAM conducts heat through a mesh of hexes and tets exactly" {
  need_openfoam
  openfoam_case case
  tagged_lattice 4
  findhex --mesh tagged.mesh | buildgraph | initsol --iterations 0 |
    assemble --smooth 0 --solver openfoam --polyhedra none -o case/constant/polyMesh
  expect_linear_heat 4
}

# A plate of one layer, from which some hexes were left out: halves, polyhedra and faces with more corners meet there.
# bats test_tags=optimized
@test "--polyhedra makes a thin plate and a part OK for checkMesh, and heat flows through it exactly" {
  need_openfoam
  openfoam_case case
  # Exact for linear fields on any cells.
  sed -i 's/gradSchemes { default Gauss linear; }/gradSchemes { default leastSquares; }/' case/system/fvSchemes
  $PYTHON - >plate.mesh <<'PYTHON'
import itertools
n = 6
at = lambda i, j, k: (k * (n + 1) + j) * (n + 1) + i + 1
print("MeshVersionFormatted 2\nDimension 3\nVertices\n%d" % (2 * (n + 1) ** 2))
for k in range(2):
    for j in range(n + 1):
        for i in range(n + 1):
            print(i, j, k, 0)
tets, sides = [], []
for j in range(n):
    for i in range(n):
        corner = [at(i + a, j + b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
        for path in itertools.permutations((4, 2, 1)):
            tet = [0, path[0], path[0] + path[1], 7]
            odd = path in ((4, 1, 2), (2, 4, 1), (1, 2, 4))
            tets.append([corner[v] for v in (tet if not odd else [tet[0], tet[2], tet[1], tet[3]])])
points = {at(i, j, k): (i, j, k) for i in range(n + 1) for j in range(n + 1) for k in range(2)}
faces = {}
for tet in tets:
    for face in itertools.combinations(tet, 3):
        faces[tuple(sorted(face))] = faces.get(tuple(sorted(face)), 0) + 1
for face in (f for f, count in faces.items() if count == 1):
    xs = {points[v][0] for v in face}
    sides.append("%d %d %d %d" % (*face, 1 if xs == {0} else 2 if xs == {n} else 3))
print("Tetrahedra\n%d" % len(tets))
for tet in tets:
    print(*tet, 1)
print("Triangles\n%d\n%s\nEnd" % (len(sides), "\n".join(sides)))
PYTHON
  findhex --mesh plate.mesh -o plate.cand
  findhex --mesh plate.mesh | buildgraph | initsol --iterations 0 -o full.sol
  awk 'NR % 5 != 0' full.sol >plate.sol
  plate() { assemble --mesh plate.mesh --candidates plate.cand --solution plate.sol --smooth 0 "$@"; }
  plate --polyhedra none -o case/constant/polyMesh
  run checkMesh -case case -allGeometry -allTopology
  assert_output --partial "Failed 1 mesh checks"
  run_apart plate -o case/constant/polyMesh
  assert_equal "$(grep -c 'are halved' <<<"$stderr")" 1
  run checkMesh -case case -allGeometry -allTopology
  assert_output --partial "Mesh OK"
  expect_linear_heat 6
  plate --polyhedra mend --threads 2 --format polyMesh -o mended
  assert_same_bytes mended/faces case/constant/polyMesh/faces
  assert_same_bytes mended/points case/constant/polyMesh/points
  assert_fails_with 2 "--polyhedra goes with polyMesh, found msh" plate --polyhedra mend -o plate.msh
  if ! command -v tetmesh; then return 0; fi
  tetmesh "$DATA/bracket.stl" --size 3 | findhex | buildgraph | initsol --iterations 20000 |
    assemble -o case/constant/polyMesh 2>/dev/null
  run checkMesh -case case -allGeometry -allTopology
  assert_output --partial "Mesh OK"
}

@test "a polyMesh folder is whole or not there, and another folder is left alone" {
  whole_mesh
  mesh_convert whole.msh polyMesh polyMesh
  assert_equal "$(ls polyMesh | xargs)" "boundary cellZones faceZones faces neighbour owner points"
  cp -r polyMesh before
  $PYTHON "$DATA/lattices/lattice.py" kuhn 6 >other.mesh
  # The disk is full in the middle of it: the file of points takes more than a block of 1024 bytes.
  run_apart bash -c "trap '' XFSZ; ulimit -f 1; exec mesh_convert other.mesh polyMesh polyMesh"
  assert_failure 1
  [[ "$stderr" == *"cannot write: File too large"* ]]
  diff -r before polyMesh
  assert_equal "$(ls -d polyMesh*)" polyMesh
  # One that is there is replaced, with what lay in it.
  touch polyMesh/sets
  mesh_convert other.mesh polyMesh polyMesh 2>said
  assert_equal "$(<said)" "mesh_convert: 432 faces on no surface become the patch defaultFaces"
  assert [ ! -e polyMesh/sets ]
  grep -q defaultFaces polyMesh/boundary
  mkdir home
  touch home/thesis.tex
  assert_fails_with 1 "home: the folder holds 'thesis.tex', which is none of the files" mesh_convert whole.msh polyMesh home
  assert_equal "$(ls home)" thesis.tex
  touch file
  assert_fails_with 1 "file: expected a folder to write" mesh_convert whole.msh polyMesh file
  assert_fails_with 1 "no/polyMesh: cannot write: No such file" mesh_convert whole.msh polyMesh no/polyMesh
}

@test "quads against two triangles are no polyMesh" {
  whole_mesh
  run mesh_convert whole.msh polyMesh polyMesh "" split
  assert_failure 1
  assert_line "mesh_convert: polyMesh: cannot write cell 1: a quad of it faces two triangles"
  assert [ ! -e polyMesh ]
}

@test "Gmsh and meshio find the same mesh in SU2 and Nastran files" {
  local format reader turn
  whole_mesh
  for format in su2 bdf; do
    mesh_convert whole.msh $format out.$format 2>/dev/null
    for reader in meshio gmsh; do
      # Gmsh writes SU2 only.
      if [[ $reader-$format == gmsh-su2 ]]; then continue; fi
      "$PYTHON" "$CHECKERS/mesh_contents.py" $reader --no-tags whole.msh >expected.txt 2>/dev/null
      "$PYTHON" "$CHECKERS/mesh_contents.py" $reader --no-tags out.$format 2>judge.log >as_it_is.txt || fail "$(cat judge.log)"
      # SU2 has VTK's wedges, which meshio takes as they are.
      if [[ $format == su2 ]]; then turn='s/^(prism -) (\S+) (\S+) (\S+) (\S+) (\S+) (\S+)$/\1 \2 \4 \3 \5 \7 \6/'; else turn=; fi
      sed -E "$turn" as_it_is.txt >found.txt
      diff expected.txt found.txt || fail "$reader $format"
    done
  done
}

@test "what Gmsh writes as SU2 and Nastran is read" {
  local format
  gmsh -3 -v 2 "$DATA/meshes/all_kinds.geo" -format msh22 -o all.msh
  "$PYTHON" "$CHECKERS/mesh_contents.py" meshio --no-tags all.msh 2>/dev/null | grep -E '^(hex|prism|pyramid|tet) ' >expected.txt
  for format in su2 bdf; do
    gmsh -3 -v 2 "$DATA/meshes/all_kinds.geo" -string 'Mesh.BdfFieldFormat=2;' -format $format -o all.$format
    mesh_convert all.$format msh22 back.msh
    # With fewer digits in .bdf, as Gmsh itself reads them.
    if [[ $format == bdf ]]; then
      "$PYTHON" "$CHECKERS/mesh_contents.py" gmsh --no-tags all.bdf | grep -E '^(hex|prism|pyramid|tet) ' >expected.txt
    fi
    "$PYTHON" "$CHECKERS/mesh_contents.py" meshio --no-tags back.msh 2>/dev/null | grep -E '^(hex|prism|pyramid|tet) ' >found.txt
    assert [ "$(wc -l <found.txt)" -gt 10 ]
    diff expected.txt found.txt || fail "$format"
  done
}

@test "SU2 and Nastran files are read back with tags, or with names in their place" {
  mesh_convert "$MESH" bdf out.bdf
  mesh_convert "$MESH" msh22 expected.msh
  mesh_convert out.bdf msh22 found.msh
  assert_same_bytes expected.msh found.msh
  sed 's/^3 7 2 3 3/3 7 2 1 1/; s/^\([124] [456] 2\) . ./\1 1 1/' "$MESH" >one_region.msh
  mesh_convert one_region.msh su2 out.su2 2>said
  mesh_convert out.su2 su2 again.su2
  assert_same_bytes out.su2 again.su2
}

@test "Nastran bulk data in free, small and large fields are read" {
  printf '%s\n' 'SOL 101' 'CEND' 'DISP=ALL' 'BEGIN BULK' '$ a tet of property 7' 'GRID,11,,0.,0.,0.' \
    'GRID          12              1.      0.     0.0' 'GRID*                 13                             .0              1.' \
    '*                    0.0' 'grid,14,0,0.,0.,+1.+0' 'CTETRA         1       7      11      12      13      14' \
    'CTRIA3,2,5,11,14,13' 'PSOLID,7,1' 'ENDDATA' 'nothing' >hand.bdf
  mesh_convert hand.bdf mesh found.mesh
  sed -n '/<!-- example tet.mesh -->/,/^End/p' "$HEXPIPE_SOURCE/formats/README.md" | sed 1,2d >expected.mesh
  assert_same_bytes expected.mesh found.mesh
  assert_fails_with 1 'hand2.bdf:6: expected points in the basic coordinate system, found system .3.' \
    shell "sed 's/GRID,11,,/GRID,11,3,/' hand.bdf >hand2.bdf; mesh_convert hand2.bdf mesh out.mesh"
  assert_fails_with 1 'hand3.bdf:11: expected the number of a point, found 15' \
    shell "sed 's/      14$/      15/' hand.bdf >hand3.bdf; mesh_convert hand3.bdf mesh out.mesh"
  assert_fails_with 1 'hand4.bdf:11: expected elements of first order only' \
    shell "sed 's/      14$/      14      15/' hand.bdf >hand4.bdf; mesh_convert hand4.bdf mesh out.mesh"
}

@test "Abaqus files are read back as they were written, also with collapsed pyramids" {
  sed '/ElementData/,$d' "$MESH" >plain.msh
  mesh_convert plain.msh inp out.inp '{"regions": {"2": "steel"}, "surfaces": {"10": "inlet"}}'
  mesh_convert out.inp inp again.inp '{"regions": {"2": "steel"}, "surfaces": {"2": "inlet"}}'
  # The sets are the same, whatever the tags.
  diff <(sort out.inp) <(sort again.inp)
  mesh_convert plain.msh inp collapsed.inp "" collapsed
  mesh_convert plain.msh inp kept.inp
  mesh_convert collapsed.inp msh22 a.msh
  mesh_convert kept.inp msh22 b.msh
  assert_same_bytes a.msh b.msh
}

@test "Abaqus decks of tets are read with their sections, sets and surfaces" {
  cat >deck.inp <<'INP'
** a comment before
*Heading
 two tets
*Part, name=PART-1
*Node
 10, 0., 0., 0.
 20, 1.D0, 0., 0.
 30, 0., +1.,
 40, 0., 0., 1.
 50, 1., 1., 1.
 61, .5, 0., 0.
 62, .5, .5, 0.
 63, 0., .5, 0.
 64, 0., 0., .5
 65, .5, 0., .5
 66, 0., .5, .5
*ELEMENT, TYPE=C3D10,
 ELSET=first
 7, 10, 20, 30, 40, 61, 62, 63,
 64, 65, 66
** and one of first order
*Element, type=C3D4, elset=second
 9, 20, 30, 40, 50
*Element, type=T3D2, elset=bar
 11, 10, 20
*Elset, elset="All of it", generate
 7, 9, 2
*Elset, elset=_load_S4, internal
 7
*Elset, elset=nested
 second,
*Nset, nset=corners
 10, 20
*Surface, type=ELEMENT, name=Load
 _load_S4, S4
 9, S2
*Solid Section, elset=FIRST, material=Steel
,
*Solid Section, elset=nested, material=Copper
,
*End Part
INP
  mesh_convert deck.inp mesh deck.mesh
  run sed -n '/^Vertices/,/^End/p' deck.mesh
  assert_output "Vertices
5
0 0 0 0
1 0 0 0
0 1 0 0
0 0 1 0
1 1 1 0

Tetrahedra
2
1 2 3 4 1
2 3 4 5 2

Triangles
2
1 4 3 1
2 3 5 1

End"
  findhex deck.inp -o deck.tar
  run tar xOf deck.tar names.json
  assert_output '{"surfaces":{"1":"Load"},"regions":{"1":"first","2":"nested"}}'
  # Without sections, the smallest set that an element is in.
  sed '/Solid Section/,/^,/d' deck.inp >sets.inp
  findhex sets.inp -o sets.tar
  run tar xOf sets.tar names.json
  assert_output '{"surfaces":{"1":"Load"},"regions":{"1":"first","2":"nested"}}'
  # What another mesh, or none, would come of.
  local change message
  while IFS='|' read -r change message; do
    sed "$change" deck.inp >bad.inp
    assert_fails_with 1 "mesh_convert: bad.inp:[0-9]+: $message" mesh_convert bad.inp mesh out.mesh
  done <<'END'
s/C3D4/C3D20R/|expected C3D4, C3D5, C3D6, C3D8 or C3D10, found 'C3D20R'
s/ 9, 20, 30, 40, 50/ 9, 20, 30, 40/|expected 4 points of an element, found 3
s/ 9, 20, 30, 40, 50/ 9, 20, 30, 40, 51/|expected the number of a point, found 51
s/ 9, 20, 30, 40, 50/ 7, 20, 30, 40, 50/|expected elements of different numbers, found 7 twice
s/^ 50, 1/ 10, 1/|expected points of different numbers, found 10 twice
s/1.D0/1.x/|expected a coordinate, found '1.x'
s/ 9, S2/ 9, S5/|expected a face up to S4, found S5
s/_load_S4, S4/nobody, S4/|expected a set of elements, found 'NOBODY'
s/^ second,/ third,/|expected a number, or a set that stands before, found 'third'
s/^ 7, 9, 2/ 7, 9, 0/|expected a step of at least 1, found '0'
s/^.End Part/*NGEN/|expected points and elements one by one, found .NGEN
s/^.End Part/*Part, name=B/|expected one part, found a second
s/^.Node/*Node, system=C/|expected Cartesian coordinates, found 'C'
END
}

@test "surfaces and regions of one number are told apart in .msh 2.2" {
  whole_mesh
  mesh_convert whole.msh msh22 out.msh
  run sed -n '/PhysicalNames/,/EndPhysicalNames/p' out.msh
  assert_output '$PhysicalNames
5
2 1 "surface_1"
3 5 "region_1"
3 2 "region_2"
3 3 "region_3"
3 4 "region_4"
$EndPhysicalNames'
  mesh_convert out.msh msh22 again.msh
  assert_same_bytes out.msh again.msh
  mesh_convert out.msh mesh a.mesh
  mesh_convert whole.msh mesh b.mesh
  assert_same_bytes a.mesh b.mesh
  need_openfoam
  openfoam_case case
  run gmshToFoam -case case out.msh
  assert_success
  assert_output --partial 'region_1'
  grep -q region_1 case/constant/polyMesh/cellZones
}
