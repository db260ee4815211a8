# The mesh formats, judged by gmsh, meshio and VTK: they find in our files what we put there, and we in theirs.
# bats file_tags=both

load helpers

MESH="$DATA/meshes/one_of_each.msh"
CONTENTS="$DATA/meshes/one_of_each.txt"

# contents READER FILE...: what that program finds in a mesh.
contents() {
  "$PYTHON" "$CHECKERS/mesh_contents.py" "$@" 2>judge.log || fail "$* failed: $(cat judge.log)"
}

# file_of FORMAT: a name with the ending of the format.
file_of() {
  local ending=${1%%[-2]*}
  echo "out-$1.$ending"
}

# assert_contents EXPECTED READER FILE...
assert_contents() {
  local expected=$1
  shift
  if sanitized; then return; fi # the other programs read in the optimized half what they would read here
  contents "$@" >found.txt
  if ! diff "$expected" found.txt; then fail "$* finds another mesh"; fi
}

@test "meshio finds the same mesh in every format" {
  for format in mesh msh msh-binary msh22 msh22-binary vtk vtu; do
    mesh_convert "$MESH" "$format" "$(file_of "$format")"
    assert_contents "$CONTENTS" meshio "$(file_of "$format")"
  done
}

@test "VTK finds the same mesh and positive volumes" {
  {
    cat "$CONTENTS"
    printf 'volume %s\n' 'hex 1' 'prism 0.5166666667' 'pyramid 0.3333333333' 'tet 0.1833333333'
  } >expected.txt
  for format in vtk vtu; do
    mesh_convert "$MESH" "$format" "$(file_of "$format")"
    assert_contents expected.txt vtk --volumes "$(file_of "$format")"
  done
}

@test "Gmsh finds the same mesh in .msh" {
  for format in msh msh-binary msh22 msh22-binary; do
    mesh_convert "$MESH" "$format" "$(file_of "$format")"
    assert_contents "$CONTENTS" gmsh "$(file_of "$format")"
  done
}

@test "Gmsh finds in .mesh and .vtk what it reads of them" {
  # Gmsh drops prisms and pyramids of MEDIT files.
  grep -vE '^(prism|pyramid)' "$CONTENTS" >expected.txt
  mesh_convert "$MESH" mesh out.mesh
  assert_contents expected.txt gmsh out.mesh
  # Gmsh drops tags of VTK files, and reads wedges unturned, though it writes them turned.
  contents gmsh --no-tags "$MESH" |
    sed -E 's/^(prism -) (\S+) (\S+) (\S+) (\S+) (\S+) (\S+)$/\1 \2 \4 \3 \5 \7 \6/' >expected.txt
  mesh_convert "$MESH" vtk out.vtk
  assert_contents expected.txt gmsh --no-tags out.vtk
}

@test "qualities arrive in .msh, .vtk and .vtu, and facets show those of their cells" {
  printf 'quality %s\n' 'hex 1' 'prism 0.75' 'pyramid 0.1' 'quad 1' 'quad 1' 'quad 1' 'tet 0.3333333333' \
    'triangle 0.1' 'triangle 0.3333333333' 'triangle 0.75' >expected.txt
  for format in msh msh-binary vtk vtu; do
    mesh_convert "$MESH" "$format" "$(file_of "$format")"
    contents meshio --quality "$(file_of "$format")" | grep quality | diff expected.txt - || fail "$format"
  done
}

@test "meshio reads Abaqus files, pyramids excepted, with a set for each region" {
  sed -e '/^3 7 2/d; /^7 2 2 20/d; s/^10$/8/; /ElementData/,$d' "$MESH" >without_pyramid.msh
  mesh_convert without_pyramid.msh inp out.inp
  run "$PYTHON" -c 'if True:
    import meshio
    mesh = meshio.read("out.inp")
    for name, lists in sorted(mesh.cell_sets.items()):
        print(name, [(block.type, len(cells)) for block, cells in zip(mesh.cells, lists) if len(cells)])'
  assert_success
  assert_output "EALL [('hexahedron', 1), ('wedge', 1), ('tetra', 1)]
region_1 [('hexahedron', 1)]
region_2 [('wedge', 1)]
region_4 [('tetra', 1)]"
}

# bats test_tags=optimized
@test "what meshio writes is read" {
  sed '/ElementData/,$d' "$MESH" >plain.msh
  "$CHECKERS/foreign_meshes.py" meshio plain.msh . >names.txt
  assert_equal "$(wc -l <names.txt)" 12
  contents meshio --no-tags plain.msh >untagged.txt
  while read -r name; do
    mesh_convert "$name" msh22 back.msh
    # Its .msh 4.1 has no tags of elements, but of the entities that the nodes are on.
    if [[ "$name" == *-4.1-* ]]; then
      assert_contents untagged.txt meshio --no-tags back.msh
    else
      assert_contents "$CONTENTS" meshio back.msh
    fi
  done <names.txt
}

@test "what VTK writes is read" {
  sed '/ElementData/,$d' "$MESH" >plain.msh
  "$CHECKERS/foreign_meshes.py" vtk plain.msh . >names.txt
  assert_equal "$(wc -l <names.txt)" 52
  # One look by meshio; the others have to give the same bytes.
  mesh_convert plain.msh msh22 first.msh
  assert_contents "$CONTENTS" meshio first.msh
  while read -r name; do
    mesh_convert "$name" msh22 back.msh
    assert_same_bytes first.msh back.msh || fail "$name"
  done <names.txt
}

@test "what Gmsh writes is read" {
  local geometry="$DATA/meshes/all_kinds.geo" name
  gmsh -3 -v 2 "$geometry" -format msh22 -o text22.msh
  gmsh -3 -v 2 "$geometry" -bin -format msh22 -o binary22.msh
  gmsh -3 -v 2 "$geometry" -format msh41 -o text41.msh
  gmsh -3 -v 2 "$geometry" -bin -format msh41 -o binary41.msh
  gmsh -3 -v 2 "$geometry" -string 'Mesh.SaveParametric=1;' -format msh22 -o parametric22.msh
  gmsh -3 -v 2 "$geometry" -string 'Mesh.SaveParametric=1;' -bin -format msh41 -o parametric41.msh
  gmsh -3 -v 2 "$geometry" -format vtk -o all.vtk
  gmsh -3 -v 2 "$geometry" -format mesh -o all.mesh
  contents meshio text22.msh >expected.txt
  assert_equal "$(cut -d' ' -f1 expected.txt | sort -u | xargs)" "hex prism pyramid quad tet triangle"
  for name in text22 binary22 text41 binary41 parametric22 parametric41; do
    mesh_convert "$name.msh" msh-binary back.msh
    assert_contents expected.txt meshio back.msh
  done
  # Neither format has physical groups; in .mesh Gmsh writes no prisms and pyramids.
  contents meshio --no-tags text22.msh | grep -vE '^(quad|triangle)' >cells.txt
  mesh_convert all.vtk msh back.msh
  contents meshio --no-tags back.msh | grep -vE '^(quad|triangle)' | diff cells.txt -
  mesh_convert all.mesh msh back.msh
  contents meshio --no-tags back.msh | grep -E '^(hex|tet)' >found.txt
  grep -E '^(hex|tet)' cells.txt | diff - found.txt
}

@test "a partitioned .msh is the mesh that it was" {
  local geometry="$DATA/meshes/all_kinds.geo" name
  gmsh -3 -v 2 "$geometry" -format msh22 -o whole.msh
  contents meshio whole.msh >expected.txt
  gmsh -3 -v 2 "$geometry" -part 3 -format msh22 -o text22.msh
  gmsh -3 -v 2 "$geometry" -part 3 -bin -format msh22 -o binary22.msh
  gmsh -3 -v 2 "$geometry" -part 3 -format msh41 -o text41.msh
  gmsh -3 -v 2 "$geometry" -part 3 -bin -format msh41 -o binary41.msh
  gmsh -3 -v 2 "$geometry" -part 3 -part_topo -part_ghosts -format msh41 -o topology41.msh
  for name in text22 binary22 text41 binary41 topology41; do
    mesh_convert "$name.msh" msh-binary back.msh
    contents meshio back.msh | diff <(grep -v '^point' expected.txt | sort) <(grep -v '^point' | sort)
  done
  mesh_convert "$DATA/readers/gmsh-partitioned.msh" mesh whole.mesh
  $PYTHON -c '
import meshio, numpy as np
mesh = meshio.read("whole.mesh")
tets = next(block.data for block in mesh.cells if block.type == "tetra")
p = mesh.points[tets]
print(round(abs(np.linalg.det(p[:, 1:] - p[:, :1])).sum() / 6, 9))' >volume.txt
  assert_equal "$(cat volume.txt)" 1.0
}

@test "gzip and UTF-16 are read wherever a file is, also from a pipe" {
  for format in mesh msh msh-binary vtk vtu inp; do
    mesh_convert "$MESH" "$format" plain
    mesh_convert plain msh22 expected.msh
    gzip -c plain >packed.gz
    mesh_convert packed.gz msh22 found.msh
    assert_same_bytes expected.msh found.msh
    mesh_convert - msh22 found.msh <packed.gz
    assert_same_bytes expected.msh found.msh
    mesh_convert <(gzip -c plain) msh22 found.msh
    assert_same_bytes expected.msh found.msh
    if [ "$format" = mesh ]; then
      for code in UTF-16LE UTF-16BE; do
        { printf '\ufeff' && cat plain; } | iconv -f UTF-8 -t "$code" | mesh_convert - msh22 found.msh
        assert_same_bytes expected.msh found.msh
      done
    fi
  done
  gzip -c "$MESH" | head -c 100 >cut.gz
  assert_fails_with 1 'cut.gz: expected the rest of a gzip file, found its end; is it cut off\?$' mesh_convert cut.gz msh22 out.msh
  for file in "$DATA"/meshes/cube.1.*; do gzip -c "$file" >"$(basename "$file").gz"; done
  mesh_convert cube.1.node.gz msh22 found.msh
  mesh_convert "$DATA/meshes/cube.1.node" msh22 expected.msh
  assert_same_bytes expected.msh found.msh
}

@test "files that are no meshes are called what they are" {
  printf 'ISO-10303-21;\nHEADER;\n' >part.step
  printf '*KEYWORD\n*NODE\n' >part.k
  assert_fails_with 1 "part.step: expected a mesh, found CAD in STEP$" mesh_convert part.step msh out.msh
  assert_fails_with 1 "part.k: expected a mesh, found an LS-DYNA file; meshio or Gmsh can convert it$" mesh_convert part.k msh out.msh
}

@test "meshes that Gmsh cannot give us are refused with a reason" {
  local geometry="$DATA/meshes/all_kinds.geo"
  gmsh -3 -v 2 "$geometry" -order 2 -format msh41 -o second_order.msh
  assert_fails_with 1 'second_order.msh:[0-9]+: expected elements of first order' mesh_convert second_order.msh vtu out.vtu
  gmsh -3 -v 2 "$geometry" -format msh4 -string 'Mesh.MshFileVersion=4.0;' -format msh40 -o old.msh
  assert_fails_with 1 'old.msh:2: expected version 2.2 or 4.1 of the format, found .4.' mesh_convert old.msh vtu out.vtu
  assert_equal "$(ls out.vtu* 2>/dev/null)" ""
}

@test "what TetGen writes is read, by its .node or its .ele" {
  mesh_convert "$DATA/meshes/cube.1.node" vtu a.vtu
  mesh_convert "$DATA/meshes/cube.1.ele" vtu b.vtu
  assert_same_bytes a.vtu b.vtu
  contents vtk --volumes a.vtu >found.txt
  run bash -c "grep -v volume found.txt | cut -d' ' -f1,2 | sort | uniq -c | sed 's/^ *//'"
  assert_output "6 tet 7
2 triangle -3
6 triangle 0
2 triangle 5
2 triangle 6"
  run awk '/volume/ { if ($3 <= 0) exit 1; sum += $3 } END { printf "%.9f", sum }' found.txt
  assert_output "1.000000000"
  cp "$DATA/meshes/cube.1.node" alone.node
  assert_fails_with 1 'alone.ele: cannot open' mesh_convert alone.node vtu out.vtu
  assert_fails_with 1 'stdin: expected the path of a TetGen' shell "mesh_convert - vtu out.vtu <$DATA/meshes/cube.1.ele"
}

# Writes the blocks of formats/README.md that are marked as examples or scripts into files of these names.
extract_examples() {
  "$PYTHON" - "$HEXPIPE_SOURCE/formats/README.md" <<'END'
import re, sys
for name, block in re.findall(r"<!-- (?:example|script) (\S+) -->\n```\w*\n(.*?)```", open(sys.argv[1]).read(), re.S):
    open(name, "w").write(block)
END
}

@test "the examples in formats/README.md are what we write" {
  extract_examples
  cp tet.msh source.msh
  for format in mesh msh msh22 vtk vtu inp su2 bdf; do
    mesh_convert source.msh "$format" "written.$format"
    assert_same_bytes "tet.$format" "written.$format"
  done
}

@test "the examples in formats/README.md are read, all as the same mesh" {
  extract_examples
  mesh_convert tet.msh msh22 expected
  for name in tet.mesh tet.msh22 tet.vtk tet.vtu tet-ascii.vtu tet.node tet.ele tet.bdf tet.inp; do
    mesh_convert "$name" msh22 found
    assert_same_bytes expected found || fail "$name"
  done
}

@test "the scripts in formats/README.md read what we write" {
  extract_examples
  mesh_convert tet.msh vtu tet.vtu
  run "$PYTHON" -c 'exec(open("medit.py").read()); print(points[1], sections)'
  assert_output "[1.0, 0.0, 0.0] {'Tetrahedra': [[1, 2, 3, 4, 7]], 'Triangles': [[1, 4, 3, 5]]}"
  run "$PYTHON" -c 'exec(open("vtu.py").read())
print(points[1], *cells, *(arrays[name] for name in ("types", "region", "surface", "kind", "quality")))'
  assert_output "[1. 0. 0.] [0 1 2 3] [0 3 2] [10  5] [7 7] [0 5] [10 10] [0.75 0.75]"
}

@test "a format is told by content, not by name, and also from a pipe" {
  for format in mesh msh msh-binary msh22 msh22-binary vtk vtu; do
    mesh_convert "$MESH" "$format" disguised
    mesh_convert disguised msh22 from_file.msh
    cat disguised | mesh_convert - msh22 from_pipe.msh
    mesh_convert <(cat disguised) msh22 from_substitution.msh
    assert_same_bytes from_file.msh from_pipe.msh
    assert_same_bytes from_file.msh from_substitution.msh
  done
}

@test "a full disk is noticed in every format" {
  for format in mesh msh msh-binary msh22 msh22-binary vtk vtu inp bdf; do
    assert_fails_with 1 'cannot write: No space left' mesh_convert "$MESH" "$format" /dev/full
  done
  # Of meshes with more than SU2 holds, there is more to say.
  assert_fails_with 1 'cannot write: No space left' mesh_convert "$DATA/meshes/long_numbers.mesh" su2 /dev/full
}

@test "meshio reads a VTU whose arrays it would mix up in the order of the document" {
  # 8 points, 6 tets and 12 triangles: meshio's rewritten offset of one array is the offset of a later one.
  $PYTHON "$DATA/lattices/lattice.py" kuhn 1 >cube.mesh
  $PYTHON - <<'PYTHON'
import itertools
text = open("cube.mesh").read()
tets = [line.split()[:4] for line in text.split("Tetrahedra\n6\n")[1].splitlines()[:6]]
facets = sorted({tuple(sorted(f)) for tet in tets for f in itertools.combinations(tet, 3)})[:12]
triangles = "".join(" ".join(f) + " 1\n" for f in facets)
open("cube.mesh", "w").write(text.replace("End", f"Triangles\n12\n{triangles}End"))
PYTHON
  mesh_convert cube.mesh vtu cube.vtu
  contents meshio cube.mesh | diff - <(contents meshio cube.vtu)
}
