# Programs that CI does not install, because they are large: Netgen, deal.II, FreeCAD, dolfinx, OpenFOAM, MFEM. docs/solvers.md
# tells how these tests are run.
# bats file_tags=optimized

load helpers

need_python() {
  PYTHONPATH=$2 "$PYTHON" -c "import $1" 2>/dev/null || skip "$3 is not installed"
}

# with_med COMMAND...: skips where hexpipe was built without MED.
with_med() {
  if ! "$@" 2>said; then
    grep -q 'expected result as' said && skip "hexpipe was built without MED"
    fail "$(cat said)"
  fi
}

# Two bodies of 2 x 4 x 4 with cells of all kinds: copper up to x = 2, steel from there; left is at x = 0, right at x = 4.
# bodies.tar, and bodies.json with the number of each kind of cells.
two_bodies() {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 4 >lattice.mesh
  $PYTHON "$DATA/lattices/two_bodies.py" lattice.mesh 4 >bodies.mesh
  mesh_convert bodies.mesh msh named.msh '{"surfaces": {"1": "left", "2": "right", "3": "around", "4": "between"},
    "regions": {"1": "copper", "2": "steel"}}'
  findhex --mesh named.msh --min-quality 0.4 --cells hex,prism -o all.tar
  findhex --mesh named.msh --min-quality 0.4 --cells hex,prism | buildgraph | initsol --iterations 0 -o full.sol
  awk 'NR % 3' full.sol >part.sol
  assemble --mesh named.msh --candidates all.tar --solution part.sol --stats bodies.json -o bodies.tar
}

# expect_counts FILE HEX PRISM PYRAMID TET: lines of a kind and a number, with the program's names for the kinds.
expect_counts() {
  local file=$1 ours
  shift
  for ours in hex prism pyramid tet; do
    grep -qx "$1 $("$PYTHON" -c 'import json, sys
print(json.load(open("bodies.json"))["cells"][sys.argv[1]]["count"])' $ours)" "$file" || fail "$ours: $(cat "$file")"
    shift
  done
}

@test "Netgen finds cells, volumes and names in a .msh 2.2" {
  need_python netgen.read_gmsh "" python3-netgen
  two_bodies
  assemble bodies.tar --format msh22 -o part.msh
  "$PYTHON" "$CHECKERS/netgen_contents.py" part.msh >found.txt
  expect_counts found.txt hex prism pyramid tet
  for line in "volume copper 32" "volume steel 32" "area left 16" "area right 16" "area around 64" "area between 16"; do
    grep -qx "$line" found.txt || fail "$line: $(cat found.txt)"
  done
}

@test "deal.II finds cells, volumes and numbers of groups, and conducts heat through two bodies exactly" {
  [[ -e /usr/share/cmake/deal.II/deal.IIConfig.cmake ]] || skip "libdeal.ii-dev is not installed"
  two_bodies
  cat >CMakeLists.txt <<CMAKE
cmake_minimum_required(VERSION 3.13)
find_package(deal.II 9.4 REQUIRED)
deal_ii_initialize_cached_variables()
project(laplace CXX)
add_executable(laplace_dealii $CHECKERS/laplace_dealii.cpp)
deal_ii_setup_target(laplace_dealii)
CMAKE
  { cmake -S . -B build && cmake --build build; } >built.txt 2>&1 || fail "$(tail -20 built.txt)"
  assemble bodies.tar --solver dealii -o part.msh 2>said
  grep -qx 'assemble: warning: 18 facets that are not on the boundary are left out: the solver takes none' said
  build/laplace_dealii part.msh >found.txt
  expect_counts found.txt Hex Wedge Pyramid Tet
  for line in "volume 1 32" "volume 2 32" "area 1 16" "area 2 16" "area 3 64"; do
    grep -qx "$line" found.txt || fail "$line: $(cat found.txt)"
  done
  assert awk '/^error/ { exit !($2 < 1e-10) }' found.txt
  # The facets between the bodies are what it stops at.
  assemble bodies.tar -o all.msh
  run build/laplace_dealii all.msh
  assert_failure
  assert_output --partial "boundary"
}

@test "FreeCAD finds cells, volumes and names in MED, whatever the file is called" {
  need_python FreeCAD /usr/lib/freecad-python3/lib freecad-python3
  two_bodies
  with_med assemble bodies.tar -o bracket.v2.med
  "$PYTHON" "$CHECKERS/freecad_contents.py" bracket.v2.med >found.txt
  expect_counts found.txt hex prism pyramid tet
  for line in "volume copper 32" "volume steel 32" "area left 16" "area right 16" "area around 64" "area between 16"; do
    grep -qx "$line" found.txt || fail "$line: $(cat found.txt)"
  done
}

@test "FreeCAD pulls a cube with CalculiX exactly, with collapsed pyramids; others it leaves out" {
  need_python FreeCAD /usr/lib/freecad-python3/lib freecad-python3
  command -v ccx >/dev/null || skip "calculix-ccx is not installed"
  two_bodies
  assemble bodies.tar --solver calculix -o part.inp
  "$PYTHON" "$CHECKERS/freecad_tension.py" part.inp >found.txt
  # Ten times the last digit that CalculiX writes.
  assert awk '/^error/ { good = $2 < 1e-7 } END { exit !good }' found.txt
  # docs/solvers.md says so.
  with_med assemble bodies.tar -o part.med
  "$PYTHON" "$CHECKERS/freecad_tension.py" part.med >found.txt
  assert awk '/^error/ { poor = $2 > 1e-4 } END { exit !poor }' found.txt
}

@test "dolfinx takes tets with their groups, and no mesh of several kinds of cells" {
  need_python dolfinx.io.gmshio,gmsh "" "python3-dolfinx-real or python3-gmsh"
  two_bodies
  run "$PYTHON" "$CHECKERS/dolfinx_contents.py" named.msh
  assert_success
  assert_output "tetrahedron 384
cells 1 192
cells 2 192
facets 1 32
facets 2 32
facets 3 128
facets 4 32"
  assemble bodies.tar -o part.msh
  run "$PYTHON" "$CHECKERS/dolfinx_contents.py" part.msh
  assert_failure
  assert_output --partial AssertionError
}

@test "simpleFoam finds the friction of a square duct on a mesh with layers" {
  command -v simpleFoam >/dev/null || skip "openfoam is not installed"
  export WM_PROJECT_DIR=${WM_PROJECT_DIR:-/usr/share/openfoam}
  mkdir -p case/system case/constant case/0
  $PYTHON "$DATA/square_duct.py" 1.5 >duct.stl
  tetmesh duct.stl --size 0.16 | findhex | buildgraph | initsol --iterations 100000 |
    assemble --boundary-layers wall=3 --first-height 0.03 --growth 1.3 --solver openfoam -o case/constant/polyMesh
  local head='FoamFile { version 2.0; format ascii; class dictionary; object dictionary; }'
  echo "$head
application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 500; deltaT 1; writeControl timeStep;
writeInterval 500; functions { flow { type surfaceFieldValue; libs (fieldFunctionObjects); fields (phi); operation sum;
regionType patch; name outlet; writeFields no; log yes; writeControl writeTime; } }" >case/system/controlDict
  echo "$head
ddtSchemes { default steadyState; } gradSchemes { default Gauss linear; }
divSchemes { default none; div(phi,U) bounded Gauss linearUpwind grad(U); div((nuEff*dev2(T(grad(U))))) Gauss linear; }
laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; }
snGradSchemes { default corrected; }" >case/system/fvSchemes
  echo "$head
solvers { p { solver GAMG; smoother GaussSeidel; tolerance 1e-9; relTol 0.05; }
  U { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-10; relTol 0.1; } }
SIMPLE { consistent yes; nNonOrthogonalCorrectors 1; residualControl { p 1e-5; U 1e-6; } }
relaxationFactors { equations { U 0.9; } }" >case/system/fvSolution
  echo "$head transportModel Newtonian; nu 0.1;" >case/constant/transportProperties
  echo "$head simulationType laminar;" >case/constant/turbulenceProperties
  # A pressure drives the flow, which is that of a long duct then: it is the same at each x.
  echo 'FoamFile { version 2.0; format ascii; class volVectorField; object U; }
dimensions [0 1 -1 0 0 0 0]; internalField uniform (0.35 0 0); boundaryField { inlet { type zeroGradient; }
  outlet { type zeroGradient; } wall { type noSlip; } }' >case/0/U
  echo 'FoamFile { version 2.0; format ascii; class volScalarField; object p; }
dimensions [0 2 -2 0 0 0 0]; internalField uniform 0; boundaryField { inlet { type fixedValue; value uniform 1.5; }
  outlet { type fixedValue; value uniform 0; } wall { type zeroGradient; } }' >case/0/p
  run simpleFoam -case case
  assert_success
  assert_output --partial "SIMPLE solution converged"
  # f Re = 2 (dp / L) D^2 / (nu U) is 56.9 in a square duct.
  local flow
  flow=$(sed -n 's/^ *sum(outlet) of phi = //p' <<<"$output" | tail -1)
  assert awk -v U="$flow" 'BEGIN { found = 2 / (0.1 * U); exit !(found > 0.97 * 56.9 && found < 1.03 * 56.9) }'
}

@test "MFEM finds cells, volumes and groups, and conducts heat through two bodies exactly" {
  [[ -n ${MFEM_DIR:-} ]] || skip "MFEM_DIR does not name a build of MFEM"
  two_bodies
  g++ -std=c++17 -I "$MFEM_DIR" "$CHECKERS/laplace_mfem.cpp" -L "$MFEM_DIR" -lmfem -o laplace_mfem
  assemble bodies.tar --format msh22 -o part.msh
  ./laplace_mfem part.msh >found.txt
  expect_counts found.txt hex prism pyramid tet
  for line in "volume 5 32" "volume 6 32" "area 1 16" "area 2 16" "area 3 64" "named left 1" "named steel 6"; do
    grep -qx "$line" found.txt || fail "$line: $(cat found.txt)"
  done
  assert awk '/^error/ { exit !($2 < 1e-10) }' found.txt
}
