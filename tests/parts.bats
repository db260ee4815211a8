# mesh-part, findhex and buildgraph on parts, merge-parts: what is put together is what a single run makes.

load helpers

setup_file() {
  if [[ ! -x "$HEXPIPE_BIN/mesh-part" ]]; then skip "mesh-part is not built"; fi
}

bar() { $PYTHON "$DATA/bar.py" "$@"; }

# run_parts BUNDLE K DIR OPTIONS...: parts, their candidates and their graphs, in DIR.
run_parts() {
  local whole=$1 parts=$2 dir=$3 part
  shift 3
  mkdir "$dir"
  mesh-part -q "$whole" --parts "$parts" -o "$dir"
  for part in "$dir"/part-*.tar; do findhex -q "$part" "$@" -o "${part/part-/candidates-}"; done
  for part in "$dir"/candidates-*.tar; do
    buildgraph -q "$part" --neighbours "$dir"/candidates-*.tar -o "${part/candidates-/graph-}"
  done
}

# parts_equal_whole NAME "K..." OPTIONS...: of the mesh NAME.mesh.
parts_equal_whole() {
  local name=$1 counts=$2 k
  shift 2
  findhex -q --mesh "$name.mesh" "$@" -o "$name.candidates.tar"
  buildgraph -q "$name.candidates.tar" -o "$name.graph.tar"
  for k in $counts; do
    run_parts "$name.mesh" "$k" "$name.$k" "$@"
    merge-parts "$name.$k"/candidates-*.tar -o merged.tar
    assert_same_bytes merged.tar "$name.candidates.tar"
    merge-parts "$name.$k"/graph-*.tar -o merged.tar
    assert_same_bytes merged.tar "$name.graph.tar"
  done
}

ALL="--cells hex,prism,pyramid --min-quality 0.1"

# bats test_tags=optimized
@test "parts of a bar of Delaunay tets give the candidates and the graph of a single run" {
  bar >bar.mesh
  parts_equal_whole bar "1 2 3 7 16" $ALL
}

# bats test_tags=optimized
@test "so do those of a lattice" {
  bar --kuhn >kuhn.mesh
  parts_equal_whole kuhn "3 16" $ALL
}

# bats test_tags=optimized
@test "so do those of a mesh with dislocations" {
  if [[ ! -x "$HEXPIPE_BIN/tetmesh" ]]; then skip "without tetmesh"; fi
  tetmesh -q "$DATA/plate-holes.stl" --size 17 -o plate.tar
  run tar tf plate.tar
  assert_line mesh/dislocations.npy
  findhex -q plate.tar -o plate.candidates.tar
  buildgraph -q plate.candidates.tar -o plate.graph.tar
  run_parts plate.tar 3 plate.3
  merge-parts plate.3/graph-*.tar -o merged.tar
  assert_same_bytes merged.tar plate.graph.tar
}

# bats test_tags=optimized
@test "so do those of two regions with tags, of pieces that do not touch, and of tets turned inside out" {
  bar --regions >regions.mesh
  parts_equal_whole regions "7" $ALL
  bar --length 10 --apart >apart.mesh
  parts_equal_whole apart "3" $ALL
  bar --folded >folded.mesh
  parts_equal_whole folded "7" $ALL
}

# bats test_tags=optimized
@test "so do those of a mesh with ridges, which some parts have none of" {
  bar --kuhn >plain.mesh
  $PYTHON - >ridges.mesh <<'PYTHON'
import itertools
text = open("plain.mesh").read().replace("End\n", "")
words = text.split()
at = words.index("Tetrahedra")
tets = [words[at + 2 + 5 * i:at + 6 + 5 * i] for i in range(60)]
edges = sorted({tuple(sorted(map(int, edge))) for tet in tets for edge in itertools.combinations(tet, 2)})
print(text + f"Edges\n{len(edges)}")
for a, b in edges:
    print(a, b, 0)
print(f"Ridges\n{len(edges)}")
print(*range(1, len(edges) + 1), sep="\n")
print("End")
PYTHON
  parts_equal_whole ridges "3 16" $ALL
  tar tf "$(ls ridges.16/candidates-*.tar | tail -1)" >members.txt
  assert_equal "$(grep -c '^mesh/ridges.npy$' members.txt)" 1
  findhex -q --mesh plain.mesh $ALL -o plain.candidates.cand
  findhex -q --mesh ridges.mesh $ALL -o ridges.candidates.cand
  assert [ "$(wc -l <ridges.candidates.cand)" -lt "$(wc -l <plain.candidates.cand)" ]
}

# bats test_tags=optimized
@test "so do parts as small as a tet, and a mesh that is one" {
  bar --length 1 --kuhn >small.mesh
  parts_equal_whole small 54 $ALL
  # More parts than files that a process may have open at first.
  (ulimit -Sn 20 && merge-parts small.54/graph-*.tar -o few.tar)
  assert_same_bytes few.tar small.graph.tar
  printf 'MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n9 9 9 0\nTetrahedra\n1\n1 2 3 4 7\nEnd\n' >tet.mesh
  parts_equal_whole tet "1" $ALL
}

@test "parts have a part of the mesh, and the option changes how many there are" {
  bar >bar.mesh
  mesh-part bar.mesh --parts 5 -o five
  mesh-part bar.mesh --parts 5 -o again
  assert_equal "$(ls five | tr '\n' ' ')" "part-0000.tar part-0001.tar part-0002.tar part-0003.tar part-0004.tar "
  for part in five/*; do assert_same_bytes $part again/$(basename $part); done
  run $PYTHON - five <<'PYTHON'
import glob, io, json, sys, tarfile
import numpy as np
own = []
for i, path in enumerate(sorted(glob.glob(sys.argv[1] + "/*"))):
    tar = tarfile.open(path)
    array = lambda name: np.load(io.BytesIO(tar.extractfile(f"mesh/{name}.npy").read()))
    about = json.load(tar.extractfile("mesh/part.json"))
    assert about["part"] == i and about["parts"] == 5, about
    assert about["neighbours"] and i not in about["neighbours"]
    numbers, owners = array("tet_number"), array("tet_part")
    assert (np.diff(numbers) > 0).all() and len(numbers) < about["mesh"]["tets"]
    own.append(numbers[owners == i])
    assert 0.8 < len(own[-1]) / about["mesh"]["tets"] * 5 < 1.2
together = np.concatenate(own)
assert (np.sort(together) == np.arange(about["mesh"]["tets"])).all()
print("good")
PYTHON
  assert_output good
  mesh-part bar.mesh --parts 5 --compress -o packed
  zstd -qd packed/part-0003.tar.zst -o unpacked.tar
  assert_same_bytes unpacked.tar five/part-0003.tar
  mesh-part bar.mesh --parts 5 --seed 9 -o other
  assert_different_bytes five/part-0000.tar other/part-0000.tar
  # part-*.tar and part-*.tar.zst together would be of two runs.
  assert_fails_with 1 "five: expected no parts but the 5 to be written, found part-000..tar: remove it" mesh-part bar.mesh --parts 5 --compress -o five
  assert_fails_with 1 "five: expected no parts but the 4 to be written, found part-0004.tar" mesh-part bar.mesh --parts 4 -o five
}

@test "mesh-part says what is wrong in a line" {
  bar --length 1 --kuhn >small.mesh
  assert_fails_with 1 "small.mesh: mesh: expected at least one tet for each of the 55 parts, found 54" mesh-part small.mesh --parts 55 -o out
  assert_fails_with 2 "parts" mesh-part small.mesh -o out
  assert_fails_with 2 "parts" mesh-part small.mesh --parts 0 -o out
  assert_fails_with 2 "output" mesh-part small.mesh --parts 2
  assert_fails_with 1 "/dev/null/x: cannot make the directory" mesh-part small.mesh --parts 2 -o /dev/null/x
  assert_fails_with 1 "expected.*mesh" mesh-part /dev/null --parts 2 -o out
}

@test "there may be more parts than files that a process has open; a failure leaves those that were there" {
  bar --length 12 >bar.mesh
  (ulimit -Sn 30 && mesh-part -q bar.mesh --parts 60 -o many && merge-parts -q many/*.tar -o merged.tar)
  cp -r many before
  (ulimit -n 30 && assert_fails_with 1 "many/part-00..\.tar: cannot write: Too many open files" mesh-part bar.mesh --parts 60 --seed 2 -o many)
  (ulimit -n 30 && assert_fails_with 1 "new/part-00..\.tar: cannot write: Too many open files" mesh-part bar.mesh --parts 60 -o new)
  assert [ ! -e new ]
  diff -r before many
}

@test "parts that do not belong together are refused" {
  bar --length 12 >bar.mesh
  run_parts bar.mesh 4 four
  run_parts bar.mesh 3 three
  bar --length 12 --folded >other.mesh
  run_parts other.mesh 4 other
  findhex -q four/part-0001.tar --min-quality 0.5 -o strict.tar
  findhex -q --mesh bar.mesh -o whole.tar
  local merged="merge-parts four/graph-0000.tar four/graph-0001.tar four/graph-0002.tar"
  assert_fails_with 1 "merge-parts: expected all 4 parts, found no part 3" $merged -o out.tar
  assert_fails_with 1 "other/graph-0003.tar: expected a part of the same mesh as four/graph-0000.tar, found one of another" $merged other/graph-0003.tar -o out.tar
  assert_fails_with 1 "three/graph-0001.tar: expected one of 4 parts as four/graph-0000.tar, found part 1 of 3" $merged three/graph-0001.tar -o out.tar
  assert_fails_with 1 "four/graph-0001.tar: expected each part once, found part 1 of 4 as in four/graph-0001.tar" $merged four/graph-0001.tar -o out.tar
  assert_fails_with 1 "four/candidates-0003.tar: expected" $merged four/candidates-0003.tar -o out.tar
  assert_fails_with 1 "whole.tar: expected a part of a mesh as four/graph-0000.tar, found a whole" $merged whole.tar -o out.tar
  assert_fails_with 1 "bar.mesh: expected a bundle" $merged bar.mesh -o out.tar
  findhex -q --mesh bar.mesh --part 1/1 -o share.tar
  assert_fails_with 1 "/dev/fd/[0-9]+: expected a file, because shares and pieces are read twice, found a pipe" shell "merge-parts <(cat share.tar) -o out.tar"
  assert_fails_with 2 "expected an output as tar, tar.zst, found 'out.graph'" $merged four/graph-0003.tar -o out.graph
  head -c 20000 four/graph-0003.tar >cut.tar
  assert_fails_with 1 "cut.tar: .*(found: |expected)" $merged cut.tar -o out.tar
  assert_fails_with 1 "strict.tar: history/.*: expected a run with the same version and options" \
    merge-parts four/candidates-0000.tar strict.tar four/candidates-000[23].tar -o out.tar
  local build="buildgraph four/candidates-0001.tar"
  assert_fails_with 1 "four/candidates-0001.tar.*: expected the neighbours of part 1 of 4 with --neighbours, found no part" $build -o out.tar
  assert_fails_with 1 "other/candidates-0002.tar: expected a part of the same mesh" $build --neighbours four/candidates-0000.tar other/candidates-0002.tar -o out.tar
  assert_fails_with 1 "three/candidates-0002.tar: expected one of 4 parts" $build --neighbours three/candidates-0002.tar -o out.tar
  assert_fails_with 1 "expected each part once, found part 0 of 4" $build --neighbours four/candidates-0000.tar four/candidates-0000.tar -o out.tar
  findhex -q four/part-0000.tar --min-quality 0.5 -o strict.tar
  assert_fails_with 1 "strict.tar: expected candidates found with the version and options of" $build --neighbours strict.tar four/candidates-000[23].tar -o out.tar
  assert_fails_with 1 "whole.tar: expected a part of a mesh, as mesh-part makes them, found a whole" $build --neighbours whole.tar -o out.tar
  assert_fails_with 2 "--neighbours goes with the candidates of a part" buildgraph whole.tar --neighbours four/candidates-0000.tar -o out.tar
  for option in --reduce --cover "--part 1/2"; do
    assert_fails_with 2 "buildgraph: --part, --reduce, --cover and --quad-reward need the whole graph" $build --neighbours four/candidates-*.tar $option -o out.tar
  done
  assert_fails_with 2 "findhex: --part does not go with a mesh that is part 1 of 4 already" findhex four/part-0001.tar --part 1/2 -o out.tar
  assert [ ! -e out.tar ]
}

@test "lists of a part that end before they begin are refused" {
  bar --length 6 >bar.mesh
  run_parts bar.mesh 2 two
  # with_end MEMBER PLACE VALUE: a part whose array says otherwise.
  with_end() {
    $PYTHON "$DATA/change_array.py" two/graph-0001.tar bad.tar "$1" "[*a[:$2], $3, *a[$2:][1:]]"
  }
  for member in candidates/tet_offsets.npy graph/offsets.npy; do
    for first in -9223372036854775808 -1 100000; do
      with_end "$member" 0 "$first"
      assert_fails_with 1 "bad.tar: $member: expected ascending ends of lists, found [0-9]+ after $first" merge-parts two/graph-0000.tar bad.tar -o out.tar
    done
    with_end "$member" 1 -9223372036854775808
    assert_fails_with 1 "bad.tar: $member: expected ascending ends of lists, found -9223372036854775808 after 0" merge-parts two/graph-0000.tar bad.tar -o out.tar
  done
  assert [ ! -e out.tar ]
}

@test "members of parts in another order are an error, not a crash" {
  bar --length 4 >bar.mesh
  run_parts bar.mesh 2 two --min-quality 1  # no candidates: their arrays are as long as those that are not there
  # in_order MEMBER...: parts whose members begin so.
  in_order() {
    $PYTHON - "$@" <<'PYTHON'
import glob, io, os, sys, tarfile
first = ["mesh/part.json", *sys.argv[1:]]
for path in glob.glob("two/graph-*"):
    with tarfile.open(path) as old, tarfile.open(os.path.basename(path), "w", format=tarfile.PAX_FORMAT) as new:
        members = {m.name: (m, old.extractfile(m).read()) for m in old}
        for name in [*first, *(n for n in members if n not in first)]:
            new.addfile(members[name][0], io.BytesIO(members[name][1]))
PYTHON
  }
  in_order mesh/points.npy
  assert_fails_with 1 "graph-0000.tar: mesh/points.npy: expected the numbers of its rows and of what they name before it" merge-parts graph-000[01].tar -o out.tar
  in_order mesh/tet_number.npy mesh/tets.npy
  assert_fails_with 1 "graph-0000.tar: mesh/tets.npy: expected the numbers of its rows and of what they name before it" merge-parts graph-000[01].tar -o out.tar
  in_order candidates/part.npy candidates/kind.npy candidates/key.npy
  run_apart merge-parts graph-000[01].tar -o out.tar
  assert [ "$status" -le 1 ]
}

# bats test_tags=both
@test "parts that claim a whole of any size cost no memory for it" {
  bar --length 1 --kuhn >small.mesh
  mesh-part -q small.mesh --parts 2 -o two
  for part in two/*; do
    $PYTHON - "$part" <<'PYTHON'
import io, json, os, sys, tarfile
with tarfile.open(sys.argv[1]) as old, tarfile.open(os.path.basename(sys.argv[1]), "w", format=tarfile.PAX_FORMAT) as new:
    for member in old:
        data = old.extractfile(member).read()
        if member.name == "mesh/part.json":
            about = json.loads(data)
            about["mesh"]["points"] = 2**31 - 1
            data = json.dumps(about).encode()
            member.size = len(data)
        new.addfile(member, io.BytesIO(data))
PYTHON
  done
  local limit=(--memory 100M)
  if sanitized; then limit=(); fi  # the address sanitizer takes terabytes of addresses
  assert_fails_with 1 "expected the whole mesh in the parts, found [0-9]+ of 2147483647 points" \
    merge-parts "${limit[@]}" part-000[01].tar -o out.tar
}

@test "merge-parts writes to a pipe, in any order of parts, and compresses" {
  bar --length 12 >bar.mesh
  run_parts bar.mesh 3 three
  merge-parts three/graph-*.tar -o whole.tar
  merge-parts three/graph-0002.tar three/graph-0000.tar three/graph-0001.tar | cat >piped.tar
  assert_same_bytes whole.tar piped.tar
  merge-parts three/graph-*.tar --compress | zstd -d >unpacked.tar
  assert_same_bytes whole.tar unpacked.tar
}

@test "a solution in parts is put together by what owners say" {
  bar --length 12 >bar.mesh
  run_parts bar.mesh 3 three
  merge-parts three/graph-*.tar -o whole.tar
  initsol -q whole.tar --iterations 2000 -o solved.tar
  $PYTHON "$DATA/split_solution.py" solved.tar solved three/graph-*.tar
  merge-parts solved/*.tar -o merged.tar
  assert_same_bytes solved.tar merged.tar
}

# solve_parts MESH K DIR OPTIONS...: also the solution of a single run, as DIR/solved.tar, and in parts, in DIR/solved.
solve_parts() {
  run_parts "$@"
  merge-parts "$3"/graph-*.tar | initsol -q --iterations 2000 -o "$3/solved.tar"
  $PYTHON "$DATA/split_solution.py" "$3/solved.tar" "$3/solved" "$3"/graph-*.tar
}

# assemble_round DIR ROUND OPTIONS...: the pieces of a round, in DIR/ROUND.
assemble_round() {
  local dir=$1 round=$2 part before=()
  shift 2
  if ((round > 1)); then before=(--before "$dir/$((round - 1))"/*.tar); fi
  mkdir "$dir/$round"
  for part in "$dir"/solved/*.tar; do
    assemble -q "$part" --neighbours "$dir"/solved/*.tar "${before[@]}" "$@" -o "$dir/$round/$(basename "$part")"
  done
}

# assemble_parts DIR OPTIONS...: rounds until all pieces are settled, the last one as DIR/pieces.
assemble_parts() {
  local dir=$1 round part
  shift
  for round in 1 2 3 4 5 6 7 8; do
    assemble_round "$dir" $round "$@"
    for part in "$dir/$round"/*.tar; do
      if ! tar xOf "$part" result/piece.json | grep -q '"settled":true'; then continue 2; fi
    done
    mv "$dir/$round" "$dir/pieces"
    return
  done
  fail "pieces of $dir do not settle"
}

# statistics FILE: what the checker counts, as lines NAME=VALUE.
statistics() {
  $PYTHON "$CHECKERS/meshstats.py" --exact "$1" | tr ' ' '\n'
}

# assert_is_whole STATISTICS VOLUME: conforming, valid, nothing overlaps or is missing.
assert_is_whole() {
  assert grep -qx is_conforming=True <<<"$1"
  run grep -E '^(inverted_cells|invalid_hexes|negative_volumes|quads_against_triangles|twisted_quads|half_covered_quads|odd_boundary_edges|open_quads|unused_points|duplicate_cells)=.*[1-9]' <<<"$1"
  assert_output ""
  assert $PYTHON -c 'import sys; a, b, gap = map(float, sys.argv[1:]); sys.exit(abs(a - b) > 1e-9 * b or abs(gap) > 1e-9)' \
    "$(sed -n s/^volume=//p <<<"$1")" "$2" "$(sed -n s/^volume_gap=//p <<<"$1")"
}

# bats test_tags=optimized
@test "pieces of a lattice are the hexes of a single run, for any number of parts" {
  bar --length 6 --kuhn >kuhn.mesh
  for k in 2 7; do
    solve_parts kuhn.mesh $k k$k
    assemble -q k$k/solved.tar -o whole.vtu
    assemble_parts k$k
    merge-parts k$k/pieces/*.tar -o merged.vtu
    stats=$(statistics merged.vtu)
    assert_is_whole "$stats" 54
    assert_equal "$(grep ^hexes= <<<"$stats")" "$(statistics whole.vtu | grep ^hexes=)"
    assert [ "$(sed -n s/^hexes=//p <<<"$stats")" -gt 20 ]
  done
}

# bats test_tags=optimized
@test "pieces of Delaunay tets conform, with their regions, tags, and pieces that do not touch" {
  for options in "--length 10" "--length 5 --regions --apart"; do
    rm -rf k
    bar $options >bar.mesh
    solve_parts bar.mesh 4 k $ALL
    assemble_parts k
    merge-parts k/pieces/*.tar -o merged.vtu
    stats=$(statistics merged.vtu)
    assert_is_whole "$stats" "$(statistics bar.mesh | sed -n s/^volume=//p)"
    assert [ "$(sed -n s/^prisms=//p <<<"$stats")" -gt 5 ]
  done
}

@test "one part is assembled as the whole" {
  bar --length 6 >bar.mesh
  solve_parts bar.mesh 1 one $ALL
  assemble -q one/solved.tar -o whole.vtu
  assemble_parts one
  merge-parts one/pieces/*.tar -o merged.vtu
  assert_same_bytes whole.vtu merged.vtu
}

# surface_of BUNDLE: a checksum of each member of the surface.
surface_of() {
  local member
  for member in $(tar tf "$1" | grep ^surface/ | sort); do echo "$member $(tar xOf "$1" "$member" | sha256sum)"; done
}

# bats test_tags=optimized
@test "the surface and the CAD's faces go through parts and pieces, to fitcad and to nodes of second order" {
  if [[ ! -x "$HEXPIPE_BIN/tessellate" ]]; then skip "tessellate is not built"; fi
  tessellate -q "$DATA/simp.step" --unit mm | tetmesh -q --size 12 -o mesh.tar
  local whole
  whole=$(surface_of mesh.tar)
  assert_equal "$(wc -l <<<"$whole")" 8
  solve_parts mesh.tar 2 k
  for bundle in k/part-0001.tar k/graph-0000.tar k/solved.tar; do assert_equal "$(surface_of $bundle)" "$whole"; done
  assemble -q k/solved.tar | fitcad -q -o fitted.msh --stats fitted.json
  assert $PYTHON -c 'import json; found = json.load(open("fitted.json")); assert found["distance"]["vertices"] < 1e-6 * found["diagonal"]'
  # Without the surface, a warning says that nodes lie on arcs through the vertices.
  run_apart assemble k/solved.tar --order 2 -o order-2.vtu
  assert_success
  refute_regex "$stderr" "arcs"
  assemble_parts k
  merge-parts k/pieces/*.tar -o pieces.tar
  assert_equal "$(surface_of pieces.tar)" "$whole"
  fitcad -q pieces.tar -o pieces.msh
  # Parts of other surfaces are not of one mesh.
  mkdir other
  tar xf k/graph-0001.tar -C other
  $PYTHON -c 'import numpy; p = numpy.load("other/surface/points.npy"); p[0] += 1e-9; numpy.save("other/surface/points.npy", p)'
  (cd other && tar tf ../k/graph-0001.tar | tar cf ../other.tar --no-recursion -T -)
  assert_fails_with 1 "other.tar: surface/points.npy: expected the same as in the first bundle, found other bytes" merge-parts k/graph-0000.tar other.tar
}

# bats test_tags=optimized
@test "pieces are files of VTK with a .pvtu, points that several have are the same in all" {
  bar --length 8 --regions >bar.mesh
  solve_parts bar.mesh 3 k $ALL
  assemble_parts k
  merge-parts k/pieces/*.tar -o 'R&D.pvtu'  # a name that XML wants escaped
  merge-parts k/pieces/part-000[210].tar -o merged.vtu
  assert_equal "$(ls 'R&D' | tr '\n' ' ')" "part-0000.vtu part-0001.vtu part-0002.vtu "
  run $PYTHON - <<'PYTHON'
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

def read(reader, path):
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()

pieces, whole = read(vtk.vtkXMLPUnstructuredGridReader(), "R&D.pvtu"), read(vtk.vtkXMLUnstructuredGridReader(), "merged.vtu")
numbers = vtk_to_numpy(pieces.GetPointData().GetGlobalIds())
points = vtk_to_numpy(pieces.GetPoints().GetData())
order = np.lexsort((np.arange(len(numbers)), numbers))
first = np.concatenate([[True], np.diff(numbers[order]) > 0])
assert (points[order][~first] == points[order][np.flatnonzero(~first) - 1]).all()
assert (points[order][first] == vtk_to_numpy(whole.GetPoints().GetData())).all()
assert 0 < (~first).sum() < len(numbers) / 2
def of_cells(grid, name):
    # A facet between two pieces says what the cell is on whose side it is written.
    data, types = vtk_to_numpy(grid.GetCellData().GetArray(name)), vtk_to_numpy(grid.GetCellTypesArray())
    return np.sort(data if name == "surface" else data[types >= 10])

for name in "region", "surface", "kind", "quality":
    assert (of_cells(pieces, name) == of_cells(whole, name)).all(), name
print("good")
PYTHON
  assert_output good
  # The merged mesh as a bundle, in any order of pieces, is a result like any other.
  merge-parts k/pieces/*.tar -o merged.tar
  merge-parts k/pieces/part-000[120].tar | cat >piped.tar
  assert_same_bytes merged.tar piped.tar
  merge-parts k/pieces/*.tar -o merged.tar.zst
  zstd -qd merged.tar.zst -o unpacked.tar
  assert_same_bytes merged.tar unpacked.tar
  # Its options reach the pieces, and the same round gives the same bytes.
  assemble -q k/solved/part-0001.tar --neighbours k/solved/*.tar --before k/pieces/*.tar -o again.tar
  assert_same_bytes again.tar k/pieces/part-0001.tar
  assemble -q k/solved/part-0001.tar --neighbours k/solved/*.tar --smooth 0 -o rough.tar
  assert_different_bytes rough.tar k/1/part-0001.tar
  # Vertices that no hex uses and no other piece has merge in a piece, too.
  local gone=0 i
  for i in k/solved/part-*.tar; do
    assemble -q "$i" --neighbours k/solved/*.tar --stats piece.json -o again.tar
    gone=$((gone + $($PYTHON -c 'import json; print(json.load(open("piece.json"))["merging"]["vertices_gone"])')))
  done
  assert [ "$gone" -gt 0 ]
}

@test "assemble of a part, and merge-parts of pieces, say what is wrong in a line" {
  bar --length 12 >bar.mesh
  solve_parts bar.mesh 3 k $ALL
  assemble_round k 1
  local one="assemble k/solved/part-0001.tar"
  assert_fails_with 1 "mesh: expected the neighbours of part 1 of 3 with --neighbours, found none" shell "initsol -q k/graph-0001.tar --iterations 9 | assemble -o out.tar"
  assert_fails_with 1 "expected the neighbours of part 1 of 3 with --neighbours, found no part 2" $one --neighbours k/solved/part-000[01].tar -o out.tar
  assert_fails_with 1 "k/graph-0000.tar: expected a solution, found none" $one --neighbours k/graph-0000.tar k/solved/part-000[12].tar -o out.tar
  assert_fails_with 2 "before goes with --neighbours" $one --before k/1/*.tar -o out.tar
  assert_fails_with 2 "exchange quads goes with --conformity pyramids, without --neighbours" $one --exchange quads --neighbours k/solved/*.tar -o out.tar
  assert_fails_with 2 "fill prisms goes with --conformity pyramids, without --neighbours" $one --fill prisms --neighbours k/solved/*.tar -o out.tar
  assert_fails_with 2 "conformity none does not go with --neighbours" $one --conformity none --neighbours k/solved/*.tar -o out.tar
  assert_fails_with 2 "neighbours goes with a part of a mesh" assemble k/solved.tar --neighbours k/solved/*.tar -o out.tar
  local with="$one --neighbours k/solved/part-0000.tar k/solved/part-0001.tar k/solved/part-0002.tar"
  assert_fails_with 1 "expected the pieces of part 1 of 3 and its neighbours, found no piece 2" $with --before k/1/part-000[01].tar -o out.tar
  assert_fails_with 1 "k/1/part-0000.tar: expected each piece once, found 0 as in k/1/part-0000.tar" $with --before k/1/part-0000.tar k/1/*.tar -o out.tar
  assert_fails_with 1 "k/graph-0000.tar: expected a piece of a mesh, as assemble makes them of parts, found none" $with --before k/graph-0000.tar -o out.tar
  # Solutions that were searched apart, and cells of two parts in one place.
  merge-parts k/graph-*.tar | initsol -q --iterations 50 --seed 5 -o other.tar
  $PYTHON "$DATA/split_solution.py" other.tar others k/graph-*.tar
  assert_fails_with 1 "others/part-0000.tar: expected a solution made with the version and options of k/solved/part-0001.tar" $one --neighbours others/part-0000.tar k/solved/part-000[12].tar -o out.tar
  # A candidate of the first part that shares a tet with a chosen one of the second: both are told by their own numbers.
  read -r row theirs < <($PYTHON - k/solved/part-0000.tar k/solved/part-0001.tar <<'PYTHON'
import io, sys, tarfile
import numpy as np

def arrays(path):
    with tarfile.open(path) as tar:
        return {m.name: np.load(io.BytesIO(tar.extractfile(m).read())) for m in tar if m.name.endswith(".npy")}

first, second = arrays(sys.argv[1]), arrays(sys.argv[2])
chosen = second["solution/chosen.npy"]
chosen = chosen[second["candidates/part.npy"][chosen] == 1]
theirs = second["candidates/key.npy"][chosen]
key, part, offsets, neighbours = (first[n + ".npy"] for n in ("candidates/key", "candidates/part", "graph/offsets", "graph/neighbours"))
beside = lambda v: np.isin(theirs, key[neighbours[offsets[v]:offsets[v + 1]]])
row = next(v for v in np.flatnonzero(part == 0) if beside(v).any())
print(row, "|".join(str(v + 1) for v in chosen[beside(row)]))
PYTHON
  )
  $PYTHON "$DATA/change_array.py" k/solved/part-0000.tar crossing.tar solution/chosen.npy "np.array([$row], '<i4')"
  local mine="($theirs)" other="$((row + 1)) of crossing.tar"
  assert_fails_with 1 "part-0001.tar: solution: expected candidates that fit together, found (($mine and $other|$other and $mine) which|($mine|$other) with a quad that another crosses)" $one --neighbours crossing.tar k/solved/part-000[12].tar -o out.tar
  # A tet is told by its number in the bundle, a ghost too.
  local turned='np.concatenate([a[:N], a[N:N + 1][:, [1, 0, 2, 3]], a[N + 1:]])' tet
  for tet in 0 100; do
    $PYTHON "$DATA/change_array.py" k/solved/part-0001.tar turned.tar mesh/tets.npy "${turned//N/$tet}"
    assert_fails_with 1 "turned.tar: mesh: expected positively oriented tets, found tet $((tet + 1)) flat or inverted" assemble turned.tar --neighbours turned.tar k/solved/part-000[02].tar -o out.tar
  done
  # Pieces.
  assert_fails_with 1 "k/1/part-0000.tar: expected a settled piece, found one that needs another round of assemble --before" merge-parts k/1/*.tar -o out.vtu
  mv k/1 first
  assemble_parts k
  local merged="merge-parts k/pieces/part-0000.tar k/pieces/part-0001.tar"
  assert_fails_with 1 "expected all 3 pieces, found no piece 2" $merged -o out.pvtu
  assert_fails_with 1 "k/pieces/part-0001.tar: expected each piece once, found 1 as in k/pieces/part-0001.tar" $merged k/pieces/part-0001.tar -o out.vtu
  assert_fails_with 2 "expected an output as mesh, .*inp, .*pvtu, tar, tar.zst, found 'out.vtuu'" $merged k/pieces/part-0002.tar -o out.vtuu
  assert_fails_with 1 "k/graph-0002.tar: expected a piece" $merged k/graph-0002.tar -o out.vtu
  assert_fails_with 1 "/dev/null/x: cannot make the directory" $merged k/pieces/part-0002.tar -o /dev/null/x.pvtu
  bar --length 12 --folded >folded.mesh
  solve_parts bar.mesh 2 two $ALL
  assemble_parts two
  assert_fails_with 1 "two/pieces/part-0001.tar: expected one of 3 pieces as k/pieces/part-0000.tar, found one of 2" $merged two/pieces/part-0001.tar -o out.vtu
  bar --length 11 >shorter.mesh
  solve_parts shorter.mesh 3 shorter $ALL
  assemble_parts shorter
  assert_fails_with 1 "shorter/pieces/part-0002.tar: expected a piece of the same mesh as k/pieces/part-0000.tar, found one of another" $merged shorter/pieces/part-0002.tar -o out.vtu
  $PYTHON "$DATA/change_array.py" k/pieces/part-0002.tar moved.tar result/points.npy 'a + 1e-12'
  assert_fails_with 1 "moved.tar: expected point [0-9]+ where the other pieces have it, found it elsewhere" $merged moved.tar -o out.vtu
  assert_fails_with 1 "moved.tar: expected point" $merged moved.tar -o new.pvtu
  assert [ ! -e new ] && [ ! -e new.pvtu ]
  # The earlier files stay, all of them.
  merge-parts k/pieces/*.tar -o whole.pvtu
  cp -r whole before
  $PYTHON "$DATA/change_array.py" k/pieces/part-0000.tar bent.tar result/points.npy 'a * 1.5'
  assert_fails_with 1 "expected point [0-9]+ where the other pieces have it" merge-parts bent.tar k/pieces/part-000[12].tar -o whole.pvtu
  diff -r before whole
  assert [ ! -e out.vtu ] && [ ! -e out.tar ]
}

# bats test_tags=optimized
@test "the commands of docs/many-machines.md split a mesh, and assemble its parts in as many rounds as they need" {
  # page FIRST LAST: the indented lines between two that begin like these.
  page() { sed -n "/^    $1/,/^    $2/s/^    //p" "$HEXPIPE_SOURCE/docs/many-machines.md"; }
  # Parts of these points settle in the third round.
  cp "$DATA/random_points.mesh" engine.msh
  page "mesh-part engine.msh" "for i in .* buildgraph" >split.sh
  page "before=" "merge-parts" >assemble.sh
  bash -e split.sh
  merge-parts graph-*.tar | initsol -q --iterations 2000 -o whole.tar
  # In place of lns-mpi, which would take the hour that the page gives it.
  $PYTHON "$DATA/split_solution.py" whole.tar split graph-*.tar
  mkdir solved
  for part in split/*; do mv "$part" "solved/graph-${part#*-}"; done
  bash -e assemble.sh
  assert_equal "$(ls engine | wc -l) $(ls -d round-* | wc -l)" "16 3"
  merge-parts round-3/*.tar -o merged.vtu
  assert grep -qx is_conforming=True <<<"$(statistics merged.vtu)"
}

# bats test_tags=optimized
@test "the Slurm script's jobs run the pipeline, each when those before it have succeeded" {
  bar >bar.mesh
  mkdir bin
  # Runs a job at once, all numbers of its array, and prints its number; a search by one process stands for that of lns-mpi.
  cat >bin/sbatch <<'SBATCH'
#!/usr/bin/env bash
set -e
array= after= command=
while (($#)); do
  case $1 in
    --array=*) array=${1#--array=} ;;
    --dependency=afterok:*) after=${1#--dependency=afterok:} ;;
    --wrap) command=$2; shift ;;
  esac
  shift
done
job=$(($(cat jobs 2>/dev/null || echo 0) + 1))
[[ "$after" == "${job/#1/}" || "$after" == "$((job - 1))" ]]
if [[ -n "$array" ]]; then
  for i in $(seq "${array%-*}" "${array#*-}"); do SLURM_ARRAY_TASK_ID=$i sh -c "$command" >&2; done
else
  sh -c "$command" >&2
fi
echo $job | tee jobs
SBATCH
  printf '#!/bin/sh\nexec "$@"\n' >bin/srun
  cat >bin/lns-mpi <<SEARCH
#!/usr/bin/env bash
set -e -o pipefail
echo "\$@" >searched
merge-parts graphs/*.tar | initsol -q --iterations 1000 -o whole.tar
$PYTHON "$DATA/split_solution.py" whole.tar solved graphs/*.tar
SEARCH
  chmod +x bin/*
  run_apart env PATH="$PWD/bin:$PATH" "$HEXPIPE_SOURCE/docs/slurm/submit.sh" bar.mesh 5 scratch
  assert_success
  assert_equal "$output" 11
  assert_equal "$(ls scratch/mesh | tr '\n' ' ')" "part-0000.vtu part-0001.vtu part-0002.vtu part-0003.vtu part-0004.vtu "
  assemble -q scratch/whole.tar -o whole.vtu
  merge-parts scratch/pieces-6/*.tar -o merged.vtu
  assert_equal "$(statistics merged.vtu | grep ^hexes=)" "$(statistics whole.vtu | grep ^hexes=)"
  assert_equal "$(cat scratch/searched | cut -d ' ' -f 1-7)" "--parts graphs/part-0000.tar graphs/part-0001.tar graphs/part-0002.tar graphs/part-0003.tar graphs/part-0004.tar --time-limit"
  run_apart "$HEXPIPE_SOURCE/docs/slurm/submit.sh" bar.mesh
  assert_equal "$status" 2
}

@test "a mesh that mesh-part refuses leaves no directory" {
  # Three tets at one facet.
  printf '%s\n' 'MeshVersionFormatted 2' 'Dimension 3' 'Vertices' 6 '0 0 0 0' '1 0 0 0' '0 1 0 0' '0 0 1 0' '0 0 2 0' '0 0 3 0' \
    'Tetrahedra' 3 '1 2 3 4 1' '1 2 3 5 1' '1 2 3 6 1' 'End' >bad.mesh
  assert_fails_with 1 "bad.mesh: .*expected at most two tets at each facet" mesh-part bad.mesh --parts 2 -o parts
  assert [ ! -e parts ]
  mkdir parts
  assert_fails_with 1 "bad.mesh: .*expected at most two tets at each facet" mesh-part bad.mesh --parts 2 -o parts
  assert [ -d parts ]
}
