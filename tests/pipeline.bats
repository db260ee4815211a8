# The stages together, the way users chain, swap and drive them.
# bats file_tags=both

load helpers

# Everything that holds before cells are made conforming: no overlap, a closed skin, no inverted cell.
mesh_is_valid() {
  $PYTHON "$CHECKERS/meshstats.py" --json --exact "$1" >found.json
  holds 'found["hexes"] > 0 and not any(found[fault] for fault in
    ["facets_of_three_cells", "twisted_quads", "odd_boundary_edges", "duplicate_cells", "unused_points",
     "inverted_cells", "invalid_hexes", "negative_volumes"])' found.json
}

@test "a surface becomes a mesh through one line of pipes, and other programs open it" {
  shell "tetmesh '$DATA/bracket.stl' --size 6 -q | findhex | buildgraph | initsol --iterations 2000 |
    lns --iterations 200 | tee stages.tar | assemble -o bracket.vtu"
  mesh_is_valid bracket.vtu
  "$CHECKERS/bundle_check.py" stages.tar
  for format in msh vtk mesh inp; do assemble stages.tar -o bracket.$format; done
  assemble stages.tar -o bracket22.msh --format msh22
  cat >count.py <<'PYTHON'
import sys, meshio
for path in sys.argv[1:]:
    mesh = meshio.read(path)
    cells = {kind: sum(len(block.data) for block in mesh.cells if block.type == kind) for kind in ("hexahedron", "tetra")}
    print(len(mesh.points), cells)
PYTHON
  run $PYTHON count.py bracket.vtu bracket.msh bracket22.msh bracket.vtk bracket.mesh
  assert_success
  assert_equal "$(grep -E 'hexahedron' <<<"$output" | sort -u | wc -l)" 1
  run gmsh bracket.msh -0 -o gmsh.vtk
  assert_success
  refute_output --partial "Error"
  run $PYTHON -c "
import vtk
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName('bracket.vtu')
reader.Update()
grid = reader.GetOutput()
assert grid.GetNumberOfCells() > 100
assert reader.GetErrorCode() == 0"
  assert_success
}

# bats test_tags=optimized
@test "a plate of one and a half sizes becomes hexes, for it has as many layers everywhere" {
  for size in 8 8.4 8.8; do
    shell "tetmesh -q '$DATA/plate-holes.stl' --size $size | findhex -q | buildgraph -q |
      initsol -q --iterations 2000 | assemble -q --stats stats.json -o plate.vtu"
    $PYTHON -c 'import json
share = json.load(open("stats.json"))["cells"]["hex"]["share_of_volume"]
assert share > 0.94, share'
  done
}

# bats test_tags=optimized
@test "Makefile.examples drives it through files, several parts at a time" {
  make -s -j2 -f "$HEXPIPE_SOURCE/Makefile.examples" BIN="$HEXPIPE_BIN" MODELS="$DATA" SIZE=8 TIME=1 bracket.vtu bracket.msh
  mesh_is_valid bracket.vtu
  mesh_is_valid bracket.msh
  for file in bracket.mesh bracket.cand bracket.graph bracket.start.sol bracket.sol bracket.lns.jsonl; do assert [ -s $file ]; done
  # Nothing is made twice.
  run make -s -f "$HEXPIPE_SOURCE/Makefile.examples" BIN="$HEXPIPE_BIN" MODELS="$DATA" bracket.vtu
  assert_output ""
}

@test "Makefile.examples takes the tools on the PATH where it is installed" {
  mkdir doc
  cp "$HEXPIPE_SOURCE/Makefile.examples" doc
  touch part.stl
  run make -n -f doc/Makefile.examples part.mesh
  assert_success
  assert_output "$HEXPIPE_BIN/tetmesh part.stl --size 3 -o part.mesh"
}

# bats test_tags=optimized
@test "clean of Makefile.examples takes away what the examples made, and nothing else" {
  examples() { make -s -j2 -f "$HEXPIPE_SOURCE/Makefile.examples" BIN="$HEXPIPE_BIN" PARTS="$DATA" SIZE=8 TIME=1 "$@"; }
  touch engine.msh backup.tar page.html bracket.stl.orig
  mkdir engine.pieces
  local theirs
  theirs=$(ls)
  examples bracket.parts.graph bracket.conflicts.tar bracket.vtk bracket.inp
  if [[ -x "$HEXPIPE_BIN/viewmesh" ]]; then
    # A library's own leaks, as in viewmesh.bats.
    LSAN_OPTIONS="suppressions=$HEXPIPE_SOURCE/tests/leaks_of_mesa.txt:print_suppressions=0" examples bracket.html bracket.png
  fi
  if [[ -x "$HEXPIPE_BIN/mesh-part" ]]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    # The MPI library's own leaks, as in behaviour.bats.
    export LSAN_OPTIONS="suppressions=$HEXPIPE_SOURCE/tests/leaks_of_mpi.txt:print_suppressions=0"
    export ASAN_OPTIONS="${ASAN_OPTIONS:-}:fast_unwind_on_malloc=0"
    examples parts PIECES=3
  fi
  assert [ "$(ls | wc -l)" -gt 20 ]
  examples clean
  assert_equal "$(ls)" "$theirs"
}

# bats test_tags=optimized
@test "files and pipes give the same result" {
  tetmesh "$DATA/bracket.stl" --size 8 -q -o b.mesh
  findhex --mesh b.mesh -o b.cand
  buildgraph --candidates b.cand -o b.graph
  initsol --graph b.graph --iterations 500 -o b.start.sol
  lns --graph b.graph --solution b.start.sol --iterations 50 -o b.sol
  assemble --mesh b.mesh --candidates b.cand --solution b.sol -o files.vtu
  shell "tetmesh '$DATA/bracket.stl' --size 8 -q | findhex | buildgraph | initsol --iterations 500 | lns --iterations 50 |
    assemble -o pipes.vtu"
  assert_same_bytes files.vtu pipes.vtu
}

# bats test_tags=optimized
@test "the whole pipeline gives the same bytes for 1 and 2 threads" {
  for threads in 1 2; do
    shell "tetmesh '$DATA/bracket.stl' --size 8 -q --threads $threads | findhex --threads $threads |
      buildgraph --threads $threads | initsol --iterations 500 --threads $threads |
      lns --iterations 50 --threads $threads | assemble --threads $threads >$threads.tar"
  done
  assert_same_bytes 1.tar 2.tar
}

# bats test_tags=optimized
@test "the Python stage of formats/README.md works in the middle of a pipe" {
  sed -n '/^```python stage$/,/^```$/p' "$HEXPIPE_SOURCE/formats/README.md" | sed '1d;$d' >stage.py
  assert [ "$(grep -c . stage.py)" -le 20 ]
  shell "tetmesh '$DATA/bracket.stl' --size 8 -q | findhex | tee plain.tar | $PYTHON stage.py | buildgraph | initsol --iterations 100 |
    lns --iterations 10 | assemble -o out.tar"
  run "$CHECKERS/bundle_check.py" out.tar
  assert_success
  # The stage there squares all qualities: it has to have changed something.
  tar xOf plain.tar candidates/quality.npy >before.npy
  tar xOf out.tar candidates/quality.npy >after.npy
  assert_different_bytes before.npy after.npy
}

# bats test_tags=optimized
@test "coinor-cbc stands in for initsol and lns, and finds the optimum" {
  $PYTHON "$DATA/box.py" 7 >box.off
  tetmesh box.off --size 1 --jitter 0.1 -q -o b.mesh
  findhex --mesh b.mesh -o b.cand
  buildgraph --candidates b.cand -o b.graph
  $PYTHON "$CHECKERS/solve_with_cbc.py" b.graph b.cbc.sol
  $PYTHON "$CHECKERS/solution_check.py" b.graph b.cbc.sol
  assemble --mesh b.mesh --candidates b.cand --solution b.cbc.sol -o b.vtu
  mesh_is_valid b.vtu
  # Ours may not be better than the optimum; on a graph this small it has to reach it.
  shell "initsol --graph b.graph --iterations 5000 | lns --iterations 2000 -o b.sol"
  optimum=$($PYTHON "$CHECKERS/solution_check.py" b.graph b.cbc.sol | grep -oE 'weight [0-9]+')
  ours=$($PYTHON "$CHECKERS/solution_check.py" b.graph b.sol | grep -oE 'weight [0-9]+')
  assert_equal "$ours" "$optimum"
}

# bats test_tags=optimized
@test "a user's own mesh from Gmsh, with regions, is the start" {
  cat >two.geo <<'GEO'
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
Coherence;
Physical Volume("left", 11) = {1};
Physical Volume("right", 12) = {2};
Physical Surface("all", 21) = Surface{:};
Mesh.MeshSizeMax = 0.25;
GEO
  for version in 2.2 4.1; do
    for binary in "" -bin; do
      gmsh -3 -format msh${version/.2/2} $binary two.geo -o two.msh >/dev/null || gmsh -3 -format msh${version/.1/} $binary two.geo -o two.msh
      shell "findhex --mesh two.msh | buildgraph | initsol --iterations 100 | lns --iterations 100 | tee two.tar | assemble -o two.vtu"
      mesh_is_valid two.vtu
      $PYTHON - two.tar <<'PYTHON'
import io, sys, tarfile
import numpy as np
with tarfile.open(sys.argv[1]) as t:
    load = lambda name: np.load(io.BytesIO(t.extractfile(name).read()))
    assert sorted(set(load("mesh/tet_tags.npy"))) == [11, 12]
    assert set(load("mesh/triangle_tags.npy")) == {21}
PYTHON
    done
  done
}

@test "Ctrl-C over a whole pipe stops the searches, and the mesh of what they found is written" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 3 >lattice.mesh
  findhex --mesh lattice.mesh | buildgraph -o graph.tar
  # A process group of its own, as a terminal gives to each pipeline.
  setsid bash -o pipefail -c 'echo $$ >group; initsol graph.tar --no-reductions --time-limit 60 | lns | assemble -o out.vtk' 2>message &
  local pipeline=$!
  await test -s group
  for tool in initsol lns assemble; do await pgrep -g "$(cat group)" -x $tool; done
  await takes_signals "$(pgrep -g "$(cat group)" -x initsol)"
  for tool in lns assemble; do await waits_for_input "$(pgrep -g "$(cat group)" -x $tool)"; done
  SECONDS=0
  kill -INT -- "-$(cat group)"
  wait $pipeline || true
  assert [ "$SECONDS" -lt 30 ]
  assert_equal "$(cat message)" ""
  mesh_is_valid out.vtk
}

@test "SIGTERM to the searches of a pipe lets the answer of the first come through the others" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 3 >lattice.mesh
  findhex --mesh lattice.mesh | buildgraph -o graph.tar
  mkfifo first second
  initsol graph.tar --no-reductions --time-limit 60 >first &
  local searches=($!)
  lns <first >second &
  searches+=($!)
  certify <second >out.tar &
  searches+=($!)
  await takes_signals "${searches[0]}"
  await waits_for_input "${searches[1]}"
  await waits_for_input "${searches[2]}"
  kill -TERM "${searches[@]}"
  local search
  for search in "${searches[@]}"; do wait "$search"; done
  run "$CHECKERS/solution_check.py" out.tar
  assert_success
}

@test "Ctrl-C ends a tool that waits for a pipe the second time" {
  mkfifo pipe
  exec 8<>pipe
  findhex <pipe >out.tar 2>/dev/null 8>&- &
  local reader=$!
  await waits_for_input $reader
  kill -INT $reader
  await has_taken_signals $reader
  await waits_for_input $reader
  kill -INT $reader
  local code=0
  wait $reader || code=$?
  exec 8>&-
  assert_equal "$code" 130
}

# Under the sanitizers TetGen begins late, and the signal is the same.
# bats test_tags=optimized
@test "Ctrl-C ends tetmesh once its pipe is read, and leaves no file" {
  cat "$DATA/cube.stl" | { tetmesh -q --size 0.02 -o out.tar & echo $! >tool; wait $! || echo $? >code; } &
  await test -s tool
  await pgrep -P "$(cat tool)"  # TetGen, once the surface is read
  kill -INT "$(cat tool)"
  wait
  assert_equal "$(cat code)" 130
  assert_equal "$(ls | tr '\n' ' ')" "code tool "
}

@test "a cut pipe anywhere in the chain is an error at its end" {
  for bytes in 0 1000 20000; do
    assert_fails_with 1 "findhex: stdin: " bash -c "set -o pipefail; tetmesh '$DATA/bracket.stl' --size 8 -q 2>/dev/null | head -c $bytes | findhex -o out.tar"
    assert [ ! -e out.tar ]
  done
}

@test "--stats counts the seconds of the tool, not those that it waits for the pipe" {
  local begin waits writes end tool
  mkfifo mesh
  begin=$(date +%s%N)
  findhex -q --stats stats.json <mesh >found.tar &
  tool=$!
  exec {writer}>mesh
  await waits_for_input "$tool"
  waits=$(date +%s%N)
  # How long nobody writes: more than all that findhex does.
  sleep 0.4
  writes=$(date +%s%N)
  cat "$DATA/jittered_lattice.mesh" >&"$writer"
  exec {writer}>&-
  wait "$tool"
  end=$(date +%s%N)
  holds "stats['seconds'] < ($end - $begin - ($writes - $waits)) / 1e9" stats.json
}

# Tests of failing pipes write each tool's messages to a file of its own.
@test "a pipe fails once: the first tool says why, those behind it end with code 1 without a word" {
  printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >open.off
  tetmesh open.off 2>1.txt | findhex 2>2.txt | buildgraph 2>3.txt | initsol 2>4.txt | lns 2>5.txt |
    assemble -o no.vtu 2>6.txt || assert_equal "${PIPESTATUS[*]}" "1 1 1 1 1 1"
  assert_equal "$(cat ?.txt)" "tetmesh: open.off:6: expected a closed surface, found 3 edges of a single triangle; the first is from (0, 0, 0) to (1, 0, 0) (see --repair)"
  assert [ ! -e no.vtu ]
  # A bad command line, too.
  assert_fails_with 1 "^tetmesh: The following argument" shell 'tetmesh --no-such open.off | findhex | buildgraph'
}

# bats test_tags=optimized
@test "in a pipe that another program fills, a tool says what it found" {
  assert_fails_with 1 "^findhex: stdin: expected a bundle or the mesh, found nothing" shell 'true | findhex'
  tetmesh -q "$DATA/cube.stl" --size 0.2 -o cube.tar
  assert_fails_with 1 "^findhex: stdin: .*Truncated" shell 'head -c 1500 cube.tar | findhex'
  # What comes in place of a failed tool's product is judged for itself.
  assert_fails_with 1 "Truncated" shell '{ tetmesh no.stl 2>/dev/null || head -c 1500 cube.tar; } | findhex'
  shell '{ tetmesh no.stl 2>/dev/null || cat cube.tar; } | findhex -q | buildgraph -q -o cube.graph'
}

# bats test_tags=optimized
@test "a tool whose reader failed ends without a word" {
  tetmesh -q "$DATA/bracket.stl" --size 6 -o bracket.tar
  mkfifo go
  # findhex has more to write than a pipe holds, and does so when buildgraph has failed.
  { cat go >/dev/null; findhex -q bracket.tar; } 2>1.txt | { buildgraph --no-such 2>2.txt; echo >go; } || true
  assert_equal "$(cat ?.txt)" "buildgraph: The following argument was not expected: --no-such (see buildgraph --help)"
}

@test "after a signal those behind the tool that it ended are silent" {
  mkfifo feed
  { findhex feed 2>1.txt & echo $! >pid; wait; } | { buildgraph 2>2.txt || echo $? >code; } | { initsol 2>3.txt || true; } &
  exec {feeder}>feed
  kill -TERM "$(<pid)"
  wait %1 || true
  exec {feeder}>&-
  assert_equal "$(cat code)" 1
  assert_equal "$(cat ?.txt)" ""
}
