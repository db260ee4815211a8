# Formats that libraries write and read: VTK, Gmsh, meshio and the libraries' own tools find what we put there, and bad files
# end in one line.

load helpers

export LSAN_OPTIONS="suppressions=$BATS_TEST_DIRNAME/leaks_of_hdf5.txt:print_suppressions=0"

# need FORMAT: skips where it was not built.
need() {
  if mesh_convert "$DATA/meshes/one_of_each.msh" "$1" /dev/null 2>&1 | grep -q 'expected a mesh format'; then
    skip "$1 was not built"
  fi
}

# groups READER FILE: what that program finds.
groups() {
  timeout 60 "$PYTHON" "$CHECKERS/group_contents.py" "$@" 2>judge.log || fail "$* failed: $(cat judge.log)"
}

# is_a_second_old FILE: the clock shows another second than when it was written. To be awaited.
is_a_second_old() {
  (($(date +%s) > $(stat -c %Y "$1")))
}

# source_mesh: a mesh of all kinds of cells, in single precision, with names; expected.txt: its groups.
NAMES='{"surfaces": {"10": "main inlet", "20": "wall"}, "regions": {"2": "steel", "3": "steel", "4": "steel"}}'
source_mesh() {
  sed '/ElementData/,$d; s/ 2.1$/ 2.125/' "$DATA/meshes/one_of_each.msh" >source.msh
  cat >expected.txt <<'END'
hex region_1 0,0,0 1,0,0 1,1,0 0,1,0 0,0,1 1,0,1 1,1,1 0,1,1
prism steel 0,0,1 0,1,1 0,0.5,2 1,0,1 1,1,1 1,0.5,2.125
pyramid steel 1,0,0 1,1,0 1,1,1 1,0,1 2,0.5,0.5
quad main_inlet 0,0,0 0,1,0 1,1,0 1,0,0
quad surface_7 1,0,0 1,1,0 1,1,1 1,0,1
quad wall 0,0,0 1,0,0 1,0,1 0,0,1
tet steel 1,1,1 1,0,1 2,0.5,0.5 1,0.5,2.125
triangle main_inlet 1,0,1 2,0.5,0.5 1,0.5,2.125
triangle surface_30 0,0,1 0,0.5,2 0,1,1
triangle wall 1,0,0 1,1,0 2,0.5,0.5
END
}

# lattice_of_two_regions: tets.mesh, whose cells are in regions 3 and 5 by turns, and its facets in file order.
lattice_of_two_regions() {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 >plain.mesh
  $PYTHON - <<'PYTHON'
import itertools
lines = open("plain.mesh").read().split("\n")
at = lines.index("Tetrahedra")
count = int(lines[at + 1])
faces = {}
for i in range(at + 2, at + 2 + count):
    corners = lines[i].split()[:4]
    lines[i] = " ".join(corners + [str(3 + 2 * (i % 2))])
    for face in itertools.combinations(corners, 3):
        faces.setdefault(tuple(sorted(face)), []).append(face)
outer = [found[0] for found in faces.values() if len(found) == 1]
triangles = "".join(" ".join(face) + " 8\n" for face in outer)
open("tets.mesh", "w").write("\n".join(lines).replace("End", "Triangles\n%d\n%sEnd" % (len(outer), triangles)))
PYTHON
}

# keeps_tets FORMAT: written and read again, a mesh of tets is the same, in the same order, with its names.
keeps_tets() {
  lattice_of_two_regions
  mesh_convert tets.mesh "$1" "mesh.$1" '{"regions": {"5": "steel"}}'
  mesh_convert "mesh.$1" mesh back.mesh
  mesh_convert tets.mesh mesh expected.mesh
  sed -i '/Triangles/,$d' expected.mesh back.mesh
  assert_same_bytes expected.mesh back.mesh
  findhex "mesh.$1" -o found.tar
  run tar xOf found.tar names.json
  assert_output '{"regions":{"5":"steel"}}'
  # By way of a pipe, in and out. A mesh in MED has the name `mesh` there.
  mesh_convert tets.mesh "$1" - '{"regions": {"5": "steel"}}' | cat >piped
  assert_same_bytes "mesh.$1" piped
  mesh_convert - mesh from_pipe.mesh <piped
  mesh_convert "mesh.$1" mesh back.mesh
  assert_same_bytes back.mesh from_pipe.mesh
}

# survives_damage FORMAT: a file that is cut off or has wrong bytes ends in one line, or is read.
survives_damage() {
  local number
  lattice_of_two_regions
  mesh_convert tets.mesh "$1" "good.$1"
  $PYTHON - "good.$1" <<'PYTHON'
import random, sys
data = open(sys.argv[1], "rb").read()
random.seed(1)
for i in range(5):
    open("cut%d" % i, "wb").write(data[:len(data) * (i + 1) // 6])
for i in range(10):
    bad = bytearray(data)
    for _ in range(1 + i % 4):
        bad[random.randrange(min(len(data), 4000))] = random.choice((0, 1, 127, 128, 255))
    open("bad%d" % i, "wb").write(bad)
PYTHON
  for number in {0..4}; do
    assert_fails_with 1 "mesh_convert: cut$number: " mesh_convert cut$number mesh out.mesh
  done
  for number in {0..9}; do
    run_apart timeout 120 mesh_convert bad$number mesh out.mesh
    assert [ "$status" -le 1 ]
    assert [ "$(wc -l <<<"$stderr")" -eq 1 ]
    if ((status == 1)) && ! grep -qE "^mesh_convert: (bad$number: |not enough memory)" <<<"$stderr"; then fail "$stderr"; fi
  done
}

# leaves_old_file FORMAT: where the disk is full in the middle, and where the mesh cannot be written.
leaves_old_file() {
  lattice_of_two_regions
  $PYTHON "$DATA/lattices/lattice.py" kuhn 12 >large.mesh
  mesh_convert tets.mesh "$1" "out.$1"
  cp "out.$1" before
  run_apart bash -c "trap '' XFSZ; ulimit -f 64; exec mesh_convert large.mesh $1 out.$1"
  assert_failure 1
  assert_equal "$stderr" "mesh_convert: out.$1: cannot write: File too large"
  assert_same_bytes before "out.$1"
  assert_equal "$(ls | grep -c "^out.$1")" 1
  assert_fails_with 1 "no/out.$1: cannot write: No such file" mesh_convert tets.mesh "$1" "no/out.$1"
  assert_fails_with 1 'cannot write: No space left' mesh_convert tets.mesh "$1" /dev/full
  assert_equal "$(umask; chmod 640 "out.$1"; mesh_convert large.mesh "$1" "out.$1"; stat -c %a "out.$1")" "$(umask; echo 640)"
}

@test "VTK and meshio find cells, volumes, groups and names in Exodus files" {
  need exo
  source_mesh
  mesh_convert source.msh exo out.exo "$NAMES" 2>said
  assert_equal "$(<said)" "mesh_convert: surface 'main inlet' is written as main_inlet: Exodus II allows no such name, or another has it"
  groups exodus out.exo >found.txt
  # Blocks have one kind of cells each. VTK keeps Exodus' wedges, which are the other way round than its own.
  sed -E 's/^(prism|pyramid|tet) steel/\1 steel_\1/' expected.txt | diff - <(grep -vE '^(nodes|volume)' found.txt)
  run grep -E '^(nodes|volume)' found.txt
  assert_output 'nodes main_inlet 0,0,0 0,1,0 1,0,0 1,0,1 1,0.5,2.125 1,1,0 2,0.5,0.5
nodes surface_30 0,0,1 0,0.5,2 0,1,1
nodes surface_7 1,0,0 1,0,1 1,1,0 1,1,1
nodes wall 0,0,0 0,0,1 1,0,0 1,0,1 1,1,0 2,0.5,0.5
volume hex 1
volume prism -0.53125
volume pyramid 0.3333333333
volume tet 0.1875'
  groups meshio-exodus out.exo >found.txt
  sed -E 's/^(hex|prism|pyramid|tet) \S+/\1 -/' expected.txt | grep -vE '^(quad|triangle)' |
    diff - <(grep -v nodes found.txt)
  # Regions of several kinds are one again.
  mesh_convert out.exo msh22 back.msh
  mesh_convert source.msh msh22 again.msh "$NAMES"
  sed 's/^\(2 .*\) 2 3 3 /\1 2 2 2 /; s/^\(3 7 2\) 3 3/\1 2 2/; s/^\(4 4 2\) 4 4/\1 2 2/' again.msh |
    sed -n '/^.Elements/,/^5/p' | sed '/^5/d' >expected.cells
  sed -n '/^.Elements/,/^5/p' back.msh | sed '/^5/d' | diff expected.cells -
}

# example NAME: the block of formats/README.md that is marked so.
example() {
  awk -v title="<!-- example $1 -->" '/^```/ { inside = found && !inside; if (!inside) found = 0; next }
                                      $0 == title { found = 1 } inside' "$HEXPIPE_SOURCE/formats/README.md"
}

@test "the example of Exodus in formats/README.md is what we write and read" {
  need exo
  example tet.mesh >source.mesh
  example tet.cdl >tet.cdl
  mesh_convert source.mesh exo tet.exo
  ncdump tet.exo | grep -v '^$' | diff tet.cdl -
  ncgen -o by_hand.exo tet.cdl
  mesh_convert by_hand.exo mesh back.mesh
  assert_same_bytes source.mesh back.mesh
}

@test "the script for MED in formats/README.md reads what we write" {
  need med
  example tet.mesh >source.mesh
  mesh_convert source.mesh med tet.med
  sed -n '/<!-- script med.py -->/,/^```$/p' "$HEXPIPE_SOURCE/formats/README.md" | sed '1,2d;$d' >med.py
  run "$PYTHON" -c 'exec(open("med.py").read())
print(points.tolist(), cells.tolist(), family_of_cell, groups[family_of_cell[0]], groups[-5])'
  assert_output "[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] [[0, 2, 1, 3]] [-7] ['region_7'] ['surface_5']"
}

@test "the example of CGNS in formats/README.md is what we write" {
  need cgns
  example tet.mesh >source.mesh
  mesh_convert source.mesh cgns tet.cgns
  cgnslist -l tet.cgns | diff <(example tet.cgnslist) -
}

@test "Exodus names are as long as they are, and told apart by more than their case" {
  need exo
  source_mesh
  local long
  long=$(printf 'inlet%.0s' {1..20})
  mesh_convert source.msh exo out.exo "{\"surfaces\": {\"7\": \"$long\", \"10\": \"Wall\", \"20\": \"wall\", \"30\": \"Öl\"}}" 2>said
  assert_equal "$(<said)" "mesh_convert: surface 'wall' is written as wall_2: Exodus II allows no such name, or another has it"
  groups exodus out.exo >found.txt
  assert_equal "$(grep -cE "^(quad|nodes) $long " found.txt)" 2
  assert_equal "$(grep -c '^nodes Öl ' found.txt)" 1
  # Two surfaces of one name are one set.
  mesh_convert source.msh exo out.exo '{"surfaces": {"7": "wall", "20": "wall"}}'
  groups exodus out.exo >found.txt
  assert_equal "$(grep -c '^nodes' found.txt)" 3
  assert_equal "$(grep -cE '^(quad|triangle) wall' found.txt)" 3
}

@test "Exodus files are read as they were written" {
  need exo
  keeps_tets exo
  # Also in the other forms of NetCDF.
  nccopy -k nc4 -d 1 mesh.exo out.nc4
  mesh_convert out.nc4 mesh from_hdf5.mesh
  assert_same_bytes back.mesh from_hdf5.mesh
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 >lattice.mesh
  findhex lattice.mesh | buildgraph | initsol --iterations 0 | assemble -o result.e
  groups exodus result.e >found.txt
  grep -q '^hex' found.txt
}

@test "Exodus files of other programs are read as far as they are meshes of first order" {
  need exo
  # meshio writes tets as TETRA, and those of second order as TETRA10.
  $PYTHON - <<'PYTHON' 2>/dev/null
import meshio, numpy
points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [.5, 0, 0], [.5, .5, 0], [0, .5, 0], [0, 0, .5], [.5, 0, .5], [0, .5, .5]]
meshio.write_points_cells("four.e", points[:4], [("tetra", [[0, 1, 2, 3]]), ("line", [[0, 1]])])
meshio.write_points_cells("ten.e", points, [("tetra10", [list(range(10))])])
PYTHON
  mesh_convert four.e mesh four.mesh
  sed -n '/Tetrahedra/,+2p' four.mesh | xargs | grep -qx 'Tetrahedra 1 1 2 3 4 .*'
  assert_fails_with 1 'ten.e: expected elements of first order only, found TETRA10 of 10 points' mesh_convert ten.e mesh out.mesh
  printf 'netcdf flat { dimensions: num_dim = 2 ; x = 3 ; variables: int a(x) ; :api_version = 6.02f ; :version = 6.02f ;
:floating_point_word_size = 8 ; :title = "flat" ; data: a = 1, 2, 3 ; }' | ncgen -o flat.e
  assert_fails_with 1 'flat.e: expected 3 dimensions, found 2' mesh_convert flat.e mesh out.mesh
  printf 'netcdf other { dimensions: x = 3 ; variables: int a(x) ; data: a = 1, 2, 3 ; }' | ncgen -o other.nc
  assert_fails_with 1 'other.nc: cannot read as Exodus II: NetCDF: Attribute not found' mesh_convert other.nc mesh out.mesh
}

@test "damaged Exodus files end in one line" {
  need exo
  # The search for leaks of clang 16 crashes on what NetCDF leaves of such a file.
  export ASAN_OPTIONS="${ASAN_OPTIONS:-}:detect_leaks=0"
  survives_damage exo
}

@test "an old Exodus file stays where a new one cannot be written" {
  need exo
  leaves_old_file exo
  # A facet that is on no cell has no side.
  sed 's/^8 3 2 10 10 1 4 3 2$/8 3 2 10 10 1 4 3 9/' "$DATA/meshes/one_of_each.msh" >loose.msh
  assert_fails_with 1 'out.exo: cannot write quads.0.: Exodus II surfaces consist of facets of cells, and it is none' \
    mesh_convert loose.msh exo out.exo
}

@test "meshio and MED's own tools find cells, groups and names in MED files" {
  need med
  source_mesh
  mesh_convert source.msh med out.med "$NAMES" 2>said
  assert_equal "$(<said)" "mesh_convert: surface 'main inlet' is written as main_inlet: MED allows no such name, or another has it"
  groups med out.med >found.txt
  diff expected.txt found.txt
  run medconforme out.med
  assert_success
  run mdump4 out.med NODALE FULL_INTERLACE 0
  assert_success
  for line in "TRIA3 : 3" "QUAD4 : 3" "TETRA4 : 1" "HEXA8 : 1" "PENTA6 : 1" "PYRA5 : 1" "gro = main_inlet" "gro = steel"; do
    assert_output --partial "$line"
  done
  # A name is that of one group, whatever is in it.
  mesh_convert source.msh med same.med '{"surfaces": {"7": "steel"}, "regions": {"2": "steel"}}' 2>said
  assert_equal "$(<said)" "mesh_convert: region 'steel' is written as steel_2: MED allows no such name, or another has it"
  groups med same.med | grep -q '^prism steel_2'
}

@test "MED files are read as they were written, and have the same bytes at any time" {
  need med
  keeps_tets med
  await is_a_second_old mesh.med
  mkdir later
  mesh_convert tets.mesh med later/mesh.med '{"regions": {"5": "steel"}}'
  assert_same_bytes mesh.med later/mesh.med
}

@test "a mesh in MED has the name of its file, by which FreeCAD looks for it" {
  need med
  source_mesh
  local name
  for name in bracket bracket.v2; do
    mesh_convert source.msh med $name.med
    mdump4 $name.med NODALE FULL_INTERLACE 0 >dump.txt
    grep -q "$name" dump.txt
  done
  mesh_convert source.msh med - >piped.med
  mdump4 piped.med NODALE FULL_INTERLACE 0 | grep -q 'mesh'
  # At most 64 bytes of it.
  name=$(printf 'n%.0s' {1..70})
  mesh_convert source.msh med $name.med
  groups med $name.med >/dev/null
}

@test "MED files of other programs are read as far as they are meshes of first order" {
  need med
  $PYTHON - <<'PYTHON' 2>/dev/null
import meshio, numpy
points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1],
                      [.5, 0, 0], [.5, .5, 0], [0, .5, 0], [0, 0, .5], [.5, 0, .5], [0, .5, .5]], float)
families = [numpy.array([-1, -2]), numpy.array([-3])]
mesh = meshio.Mesh(points[:5], [("tetra", [[0, 2, 1, 3], [1, 2, 4, 3]]), ("triangle", [[0, 2, 1]])],
                   cell_data={"cell_tags": families})
mesh.cell_tags = {-1: ["all", "steel"], -2: ["all", "copper"], -3: ["inlet"]}
mesh.point_tags = {}
mesh.write("two.med")
meshio.write_points_cells("ten.med", points, [("tetra10", [[0, 1, 2, 3, 5, 6, 7, 8, 9, 10]])])
PYTHON
  # Of a family's groups, the smallest says most.
  findhex two.med -o found.tar
  run tar xOf found.tar names.json
  assert_output '{"surfaces":{"3":"inlet"},"regions":{"1":"steel","2":"copper"}}'
  assert_fails_with 1 'ten.med: expected hexes, prisms, pyramids and tets of first order, found TETRA10' \
    mesh_convert ten.med mesh out.mesh
}

@test "damaged MED files end in one line" {
  need med
  survives_damage med
}

@test "an old MED file stays where a new one cannot be written" {
  need med
  leaves_old_file med
}

@test "Code_Aster has names of 24 characters" {
  need med
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 >lattice.mesh
  findhex lattice.mesh | buildgraph | initsol --iterations 0 -o solved.tar
  mkdir with && tar xf solved.tar -C with
  echo '{"regions": {"1": "a-name-of-more-than-24-characters"}}' >with/names.json
  tar cf named.tar --format=pax -C with $(tar tf solved.tar) names.json
  assemble named.tar --solver code-aster -o out.med 2>said
  grep -q "is written as a-name-of-more-than-24-c: " said
  mdump4 out.med NODALE FULL_INTERLACE 0 | grep -q 'gro = a-name-of-more-than-24-c$'
  assemble named.tar -o long.med
  mdump4 long.med NODALE FULL_INTERLACE 0 | grep -q 'gro = a-name-of-more-than-24-characters$'
}

@test "VTK and CGNS' own tools find cells, volumes, sections and boundary conditions in CGNS files" {
  need cgns
  source_mesh
  mesh_convert source.msh cgns out.cgns "$NAMES"
  groups cgns out.cgns >found.txt
  sed -E 's/^(hex|prism|pyramid|tet) \S+/\1 -/; s/main_inlet/main inlet/' expected.txt | LC_ALL=C sort | diff - <(grep -v volume found.txt)
  run grep volume found.txt
  assert_output 'volume hex 1
volume prism -0.53125
volume pyramid 0.3333333333
volume tet 0.1875'
  run cgnscheck out.cgns
  assert_success
  refute_output --partial ERROR
  cgnslist -l out.cgns >list
  for section in region_1 steel_prism steel_pyramid steel_tet main\ inlet_tri main\ inlet_quad surface_7; do
    grep -q -- "+-$section  -- Elements_t" list || fail "$section: $(cat list)"
  done
  grep -q -- '+-wall  -- Family_t' list
  # A name that the format needs for itself goes to none.
  mesh_convert source.msh cgns named.cgns '{"regions": {"1": "ZoneBC"}, "surfaces": {"7": "a name of more than 24 characters"}}' 2>said
  assert_equal "$(grep -c 'is written as \(ZoneBC_2\|a name of more than 24 c\): CGNS' said)" 2
  await is_a_second_old out.cgns
  mesh_convert source.msh cgns later.cgns "$NAMES"
  assert_same_bytes out.cgns later.cgns
  assert_fails_with 1 'out.cgns: cannot read CGNS: it is written only' mesh_convert out.cgns mesh out.mesh
}

@test "an old CGNS file stays where a new one cannot be written" {
  need cgns
  leaves_old_file cgns
}

@test "names that no format can hold, that two groups have, or that no cell has, leave files that are read" {
  local format names
  source_mesh
  names='{"surfaces": {"7": "/", "10": "both", "20": "\u00fc\u4e2d", "30": "both", "99": "nobody"}, "regions": {"1": "both", "2": "*", "77": "nobody"}}'
  for format in exo med cgns inp su2 bdf msh; do
    if [[ $format =~ exo|med|cgns ]]; then need $format; fi
    mesh_convert source.msh $format "out.$format" "$names" 2>said || fail "$format: $(cat said)"
    if grep -aq nobody "out.$format"; then fail "$format has a group of nothing"; fi
    if [[ $format != cgns ]]; then mesh_convert "out.$format" msh22 back.msh || fail "$format is not read"; fi
  done
  # meshio cannot read names that are not ASCII.
  mdump4 out.med NODALE FULL_INTERLACE 0 | sed -n 's/^.*gro = \([^ ]*\).*/\1/p' | LC_ALL=C sort -u | xargs >found.txt
  assert_equal "$(<found.txt)" "_ __2 both both_2 region_3 region_4 ü中"
  groups cgns out.cgns | grep -E '^(quad|triangle)' | cut -d' ' -f2 | LC_ALL=C sort -u | xargs >found.txt
  assert_equal "$(<found.txt)" "_ _____ both"
}

@test "a tool starts without these libraries, and says so where a module is not there" {
  need exo
  source_mesh
  if ldd "$HEXPIPE_BIN/assemble" | grep -E 'netcdf|hdf5|exoII|libmed|cgns|libmpi'; then fail "assemble loads them"; fi
  mkdir bin
  cp "$HEXPIPE_BIN/mesh_convert" bin
  assert_fails_with 1 'mesh_convert: cannot load the module for the format: .*mesh_exodus.so: cannot open shared object file' \
    bin/mesh_convert source.msh exo out.exo
  assert [ ! -e out.exo ]
}
