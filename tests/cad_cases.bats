# From STEP with names to cases of CalculiX and OpenFOAM that run, with boundary conditions and materials by name.
# bats file_tags=optimized

load helpers

setup_file() {
  # OpenCASCADE keeps what it made at its start.
  export LSAN_OPTIONS="suppressions=$BATS_TEST_DIRNAME/leaks_of_occt.txt:print_suppressions=0"
}

need_calculix() {
  command -v ccx >/dev/null || skip "calculix-ccx is not installed"
}

need_openfoam() {
  command -v laplacianFoam >/dev/null || skip "openfoam is not installed"
  export WM_PROJECT_DIR=${WM_PROJECT_DIR:-/usr/share/openfoam}
}

# A bar of 10 x 20 x 30 with the faces inlet and outlet, 10 apart: the body pipe.
bar() {
  $PYTHON "$DATA/step.py" named >bar.step
  tessellate -q bar.step | tetmesh -q --size 5 | findhex | buildgraph | initsol --iterations 100 | assemble -q | fitcad -q -o bar.tar
}

# A hollow boss on a plate, two bodies that are joined: its lower face is base, its upper one load.
boss() {
  cat >boss.geo <<'END'
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 4, 3, 0.6};
Cylinder(2) = {2, 1.5, 0.6, 0, 0, 1.2, 0.9};
Cylinder(3) = {2, 1.5, 0.6, 0, 0, 1.2, 0.4};
BooleanDifference{ Volume{2}; Delete; }{ Volume{3}; Delete; }
END
  gmsh -0 boss.geo -o nameless.step >gmsh.log
  $PYTHON "$DATA/name_faces.py" base=z:0 load=z:1.8 body plate=1 body boss=2 <nameless.step >boss.step
  tessellate -q boss.step --join | tetmesh -q --size 0.35 | findhex | buildgraph | initsol --iterations 200 | assemble -q | fitcad -q -o boss.tar
}

# openfoam_case VALUES: a folder `case` in which laplacianFoam finds the temperature; VALUES are those of the patches.
openfoam_case() {
  mkdir -p case/system case/constant case/0
  local head='FoamFile { version 2.0; format ascii; class dictionary; object dictionary; }'
  echo "$head
application laplacianFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1;
writeControl timeStep; writeInterval 1; writePrecision 12;" >case/system/controlDict
  echo "$head
ddtSchemes { default steadyState; } gradSchemes { default Gauss linear; } divSchemes { default none; }
laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; }
snGradSchemes { default corrected; }" >case/system/fvSchemes
  echo "$head
solvers { T { solver PCG; preconditioner DIC; tolerance 1e-12; relTol 0; } } SIMPLE { nNonOrthogonalCorrectors 20; }" >case/system/fvSolution
  echo "$head
DT DT [0 2 -1 0 0 0 0] 1;" >case/constant/transportProperties
  echo "FoamFile { version 2.0; format ascii; class volScalarField; object T; }
dimensions [0 0 0 1 0 0 0]; internalField uniform 0;
boundaryField { $1 \".*\" { type zeroGradient; } }" >case/0/T
}

# temperatures: T of all cells, and x, y and z of their centres.
temperatures() {
  $PYTHON - "$1" <<'PYTHON'
import re, sys
import numpy as np
def field(name):
    text = open("case/1/" + name).read()
    return np.array([float(x) for x in re.search(r"internalField\s+nonuniform List<scalar>\s*\d+\s*\((.*?)\)", text, re.S).group(1).split()])
T, x, y, z = (field(name) for name in ("T", "Cx", "Cy", "Cz"))
assert len(T) > 20
assert eval(sys.argv[1]), (sys.argv[1], T.min(), T.max())
PYTHON
}

@test "CalculiX stretches a bar from STEP by the names of its faces, as far as theory says" {
  need_calculix
  bar
  fitcad -q bar.tar --solver calculix -o part.inp
  cat >case.inp <<'END'
*INCLUDE, INPUT=part.inp
*MATERIAL, NAME=CORK
*ELASTIC
1000, 0
*SOLID SECTION, ELSET=pipe, MATERIAL=CORK
*STEP
*STATIC
*BOUNDARY
inlet, 1, 3, 0
*DSLOAD
outlet, P, -2
*NODE PRINT, NSET=outlet
U
*END STEP
END
  timeout 60 ccx case >ccx.log
  # p L / E = 2 x 10 / 1000, and no contraction.
  awk 'NF == 4 { ++count; if (sqrt(($2 * $2 - 0.0004)^2) > 1e-7 || sqrt($3 * $3 + $4 * $4) > 1e-5) bad = 1 } END { exit bad || count < 10 }' case.dat || fail "$(cat case.dat)"
}

@test "OpenFOAM conducts heat through a bar from STEP by the names of its faces" {
  need_openfoam
  bar
  openfoam_case "inlet { type fixedValue; value uniform 0; } outlet { type fixedValue; value uniform 10; }"
  fitcad -q bar.tar --solver openfoam -o case/constant/polyMesh
  run laplacianFoam -case case
  assert_success
  run postProcess -case case -latestTime -func writeCellCentres
  assert_success
  # It rises by 10 from one face to the other, which are 10 apart.
  temperatures 'min(abs(T - x).max(), abs(T - 10 + x).max()) < 1e-3'
}

@test "CalculiX loads two bodies of an assembly that are joined, each of its own material" {
  need_calculix
  boss
  assert_equal "$(tar xOf boss.tar names.json | $PYTHON -c 'import json, sys; n = json.load(sys.stdin); print(sorted(n["surfaces"].values()), sorted(n["regions"].values()))')" "['base', 'load'] ['boss', 'plate']"
  fitcad -q boss.tar --solver calculix -o part.inp
  # case MODULUS: CalculiX on the assembly with a boss of that stiffness.
  loaded() {
    cat >case.inp <<END
*INCLUDE, INPUT=part.inp
*MATERIAL, NAME=STEEL
*ELASTIC
210000, 0.3
*MATERIAL, NAME=SOFT
*ELASTIC
$1, 0.3
*SOLID SECTION, ELSET=plate, MATERIAL=STEEL
*SOLID SECTION, ELSET=boss, MATERIAL=SOFT
*STEP
*STATIC
*BOUNDARY
base, 1, 3, 0
*DSLOAD
load, P, 100
*NODE PRINT, NSET=base, TOTALS=ONLY
RF
*NODE PRINT, NSET=load
U
*END STEP
END
    timeout 100 ccx case >ccx.log
  }
  loaded 70000
  # What presses from above is held below: 100 times the ring's area, whose circles are chords.
  awk '/total force/ { getline; getline; force = $3 } END { area = 3.14159265 * (0.81 - 0.16); exit !(force > 93 * area && force < 101 * area) }' case.dat || fail "$(cat case.dat)"
  # About p h / E: 100 x 1.2 / 70000.
  sunk() { awk 'NF == 4 { sum -= $4; ++count } END { printf "%.9f\n", sum / count }' case.dat; }
  local stiff soft
  stiff=$(sunk)
  assert awk -v u="$stiff" 'BEGIN { exit !(u > 0.0015 && u < 0.0025) }'
  loaded 700
  soft=$(sunk)
  assert awk -v u="$soft" -v v="$stiff" 'BEGIN { exit !(u > 70 * v && u < 100 * v) }'
}

@test "OpenFOAM conducts heat through two bodies of an assembly that are joined" {
  need_openfoam
  boss
  openfoam_case "base { type fixedValue; value uniform 0; } load { type fixedValue; value uniform 1; }"
  fitcad -q boss.tar --solver openfoam -o case/constant/polyMesh
  grep -q plate case/constant/polyMesh/cellZones
  grep -q boss case/constant/polyMesh/cellZones
  run checkMesh -case case
  assert_output --partial 'Boundary openness'
  refute_output --partial '***Total volume'
  run laplacianFoam -case case
  assert_success
  run postProcess -case case -latestTime -func writeCellCentres
  assert_success
  # Between the values at the boundary, and all but linear in the boss, whose foot is warmer than the base.
  temperatures 'T.min() > -0.02 and T.max() < 1.02 and abs(np.polyfit(z[z > 0.9], T[z > 0.9], 1)[0] - 0.7) < 0.15'
}
