# hexpipe: the usual pipe in one command.

load helpers

# Mesa keeps what it allocates for a context, OpenCASCADE what it made at its start: not ours to free.
export LSAN_OPTIONS="suppressions=$BATS_FILE_TMPDIR/leaks.txt:print_suppressions=0"

quick() {
  hexpipe "$DATA/cube.stl" --size 0.5 --effort quick "$@"
}

setup_file() {
  cat "$HEXPIPE_SOURCE/tests/leaks_of_mesa.txt" "$HEXPIPE_SOURCE/tests/leaks_of_occt.txt" >"$BATS_FILE_TMPDIR/leaks.txt"
  # Without tetmesh there is no pipe from a surface.
  [[ -x "${HEXPIPE_BIN:-build/bin}/tetmesh" ]] || skip "tetmesh is not built"
}

@test "one command makes the mesh, a page and a picture, and says what came out in three lines" {
  [[ -x "$HEXPIPE_BIN/viewmesh" ]] || skip "viewmesh is not built"
  run_apart quick -o cube.msh --page cube.html --png cube.png
  assert_success
  assert_equal "$output" ""
  assert_equal "$(wc -l <<<"$stderr")" 3
  grep -Eq "^hexpipe: [0-9]+ hexes.*; hexes fill [0-9.]+ % of the volume$" <<<"$stderr"
  grep -Eq "^hexpipe: least scaled Jacobian [0-9.]+ \(a [a-z]+\); boundary within" <<<"$stderr"
  grep -Eq "^hexpipe: cube.msh after [0-9.]+ s$" <<<"$stderr"
  grep -q "<html" cube.html
  head -c 4 cube.png | grep -q PNG
  run "$PYTHON" "$CHECKERS/meshstats.py" --exact cube.msh
  assert_success
}

# bats test_tags=optimized
@test "on a terminal, one line shows the stage at work, and what it has" {
  # Iterations in place of seconds: on a busy machine the stages before it may take longer than those.
  TERM=xterm script -qec "hexpipe '$DATA/bracket.stl' --size 6 -o out.vtu --lns '--worth 0 --iterations 800'" /dev/null </dev/null |
    tr '\r' '\n' | sed 's/\x1b\[K//g' >shown
  grep -Eq '^hexpipe: [0-9]+ s, 1/6 tetmesh' shown
  grep -Eq '^hexpipe: [0-9]+ s, 5/6 lns: .*[0-9]+ hexes, [0-9.]+ % of the volume' shown
  grep -Eq '^hexpipe: out.vtu after [0-9.]+ s$' shown
  TERM=xterm script -qec "hexpipe '$DATA/cube.stl' --size 0.5 --effort quick -o out.vtu -q" /dev/null </dev/null >shown
  assert_equal "$(cat shown)" ""
}

# bats test_tags=optimized
@test "--dry-run prints a shell command that makes the same bytes, and does nothing" {
  run_apart quick -o "it's.vtu" --keep 'two words' --seed 3 --lns '--iterations 20' --initsol "--iterations 100" --dry-run
  assert_success
  assert [ ! -e "it's.vtu" ]
  assert [ ! -e 'two words' ]
  bash -e -o pipefail -c "$output"
  mv "it's.vtu" by_hand.vtu
  mv 'two words' by_hand
  quick -q -o "it's.vtu" --keep 'two words' --seed 3 --lns '--iterations 20' --initsol "--iterations 100"
  assert_same_bytes by_hand.vtu "it's.vtu"
  for stage in mesh candidates conflicts solution choice; do assert_same_bytes "by_hand/$stage.tar" "two words/$stage.tar"; done
}

# bats test_tags=optimized
@test "--from goes on from each stage that was kept, to the same mesh" {
  local fixed=(--initsol '--iterations 100' --lns '--iterations 20') stage
  quick -q -o all.vtu --keep stages "${fixed[@]}"
  for stage in mesh candidates conflicts solution choice; do
    fixed=()
    [[ $stage != mesh && $stage != candidates && $stage != conflicts ]] || fixed+=(--initsol '--iterations 100')
    [[ $stage == choice ]] || fixed+=(--lns '--iterations 20')
    cp -r stages copy
    hexpipe -q --keep copy --from $stage "${fixed[@]}" -o again.vtu
    assert_same_bytes all.vtu again.vtu
    rm -r copy again.vtu
  done
}

# bats test_tags=optimized
@test "each effort, --threads, --size and options of a stage reach the tools" {
  run quick -o x.vtu --dry-run --threads 2 --seed 7
  assert_output --partial "tetmesh $DATA/cube.stl --size 0.5 --threads 2 --seed 7"
  assert_output --partial "lns --threads 2 --seed 7 --time-limit 3"
  run quick -o x.vtu --dry-run --lns '--time-limit 9'
  assert_output --partial "lns --time-limit 9 --slim |"
  # What is kept may go to certify.
  run quick -o x.vtu --dry-run --keep stages
  refute_output --partial "--slim"
  run hexpipe a.stl -o x.inp --solver calculix --dry-run
  assert_output --partial "assemble --solver calculix -o x.inp"
  run hexpipe a.stl --effort thorough -o x.vtu --dry-run
  assert_output --partial "tetmesh a.stl --improve 100000 --time-limit 60 |"
  run hexpipe part.STEP -o x.vtu --dry-run
  assert_line --index 0 "tessellate part.STEP |"
  assert_line "  fitcad -o x.vtu"
  run hexpipe part.step -o x.inp --solver calculix --dry-run
  assert_line "  assemble |"
  assert_line "  fitcad --solver calculix -o x.inp"
  run hexpipe --mesh tets.msh -o x.vtu --dry-run
  assert_line --index 0 "findhex --mesh tets.msh |"
}

# bats test_tags=optimized
@test "the boundary of a mesh from CAD lies on the CAD, and --from knows that it is CAD" {
  [[ -x "$HEXPIPE_BIN/fitcad" ]] || skip "fitcad is not built"
  hexpipe -q "$DATA/simp.step" --size 14 --effort quick --initsol '--iterations 100' --lns '--iterations 10' --keep stages -o simp.vtu --stats simp.json
  holds "simp['fitcad']['distance']['vertices'] < 1e-6 * simp['fitcad']['diagonal'] < simp['fitcad']['distance_before']['vertices'] * 1e3" simp.json
  assert_conforming simp.vtu
  hexpipe -q --keep stages --from result -o again.vtu
  assert_same_bytes simp.vtu again.vtu
  hexpipe -q --keep stages --from result --solver calculix -o simp.inp
  grep -q "TYPE=C3D8I" simp.inp
}

@test "tets of another program go in by --mesh" {
  hexpipe -q --mesh "$DATA/jittered_lattice.mesh" --effort quick -o lattice.vtu --stats stats.json
  run "$PYTHON" -c "import json; s = json.load(open('stats.json')); assert s['assemble']['cells']['hex']['count'] > 0, s"
  assert_success
}

@test "of a pipe that breaks only the first tool that failed is heard, with its exit code" {
  assert_fails_with 1 "^hexpipe: tetmesh: none.stl: cannot open" hexpipe none.stl -o x.vtu
  assert_fails_with 2 "^hexpipe: lns: .*--nonsense" quick -o x.vtu --lns --nonsense
  assert_fails_with 1 "^hexpipe: assemble: nowhere/x.vtu: cannot write" quick -o nowhere/x.vtu
  assert_fails_with 1 "^hexpipe: .*: /dev/full: cannot write" quick -o /dev/full --assemble '--format vtu'
  assert [ ! -e x.vtu ]
}

# So it is where tetmesh is not installed, which is a package of its own.
@test "a tool that is not there is named, with the places where it was looked for" {
  mkdir alone
  cp "$HEXPIPE_BIN/hexpipe" alone
  run env PATH=/nowhere "$PWD/alone/hexpipe" "$DATA/bracket.stl" -o x.vtu
  assert_failure 1
  assert_output "hexpipe: tetmesh: cannot start: it is neither beside hexpipe nor on the PATH"
  assert [ ! -e x.vtu ]
}

@test "a stage that cannot be kept leaves no file that --from would take for whole" {
  printf 'solid nothing\nendsolid nothing\n' >empty.stl
  run hexpipe empty.stl -o x.vtu --keep stages
  assert_failure 1
  run find stages -type f
  assert_output ""
}

@test "options that contradict each other end with 2" {
  assert_fails_with 2 "nothing to mesh" hexpipe -o x.vtu
  assert_fails_with 2 "expected -o FILE" hexpipe part.stl
  assert_fails_with 2 "expected one of a surface, --mesh and --from" hexpipe part.stl --mesh tets.msh -o x.vtu
  assert_fails_with 2 "--from needs --keep" hexpipe --from choice -o x.vtu
  assert_fails_with 2 "expected --from surface, mesh" hexpipe --keep k --from nothing -o x.vtu
  assert_fails_with 2 "--from result goes with CAD" hexpipe --keep k --from result -o x.vtu
  assert_fails_with 2 "--fitcad does nothing without CAD" hexpipe part.stl --fitcad "--reach 0.1" -o x.vtu
  assert_fails_with 2 "--size does nothing" hexpipe --mesh tets.msh --size 3 -o x.vtu
  assert_fails_with 2 "--tetmesh does nothing" hexpipe --mesh tets.msh --tetmesh --repair -o x.vtu
  assert_fails_with 2 "--lns: expected a ' at the end" hexpipe part.stl --lns "--seed '3" -o x.vtu
  assert_fails_with 2 "--page and --png show" hexpipe part.stl -o x.inp --page x.html
}

# bats test_tags=optimized
@test "Ctrl-C once: the searches end, and the mesh is assembled" {
  # At 4 % initsol proves its choice the best, and lns has nothing to search.
  hexpipe "$DATA/bracket.stl" --size 2.5% -o bracket.vtu --initsol '--iterations 10' --lns '--time-limit 1000' 2>messages 3>&- &
  local pid=$!
  await searches "$pid"
  kill -INT "$pid"
  wait "$pid"
  grep -q "^hexpipe: stopping; assembling what there is (again: give up)$" messages
  run "$PYTHON" "$CHECKERS/meshstats.py" bracket.vtu
  assert_success
}

@test "Ctrl-C before there are hexes to choose from ends the pipe, and says so" {
  mkfifo never
  hexpipe never -o never.vtu 2>messages 3>&- &  # nobody writes the surface
  local pid=$! code=0
  await has_child "$pid" assemble
  kill -INT "$pid"
  wait "$pid" || code=$?
  assert_equal "$code" 1
  grep -q "^hexpipe: tetmesh: ended by signal 2$" messages
  assert [ ! -e never.vtu ]
}

# has_child PID NAME: PID started a process of that name, which has not ended.
has_child() {
  pgrep -P "$1" -x "$2"
}

# searches PID: initsol has given lns a first choice.
searches() {
  has_child "$1" lns && ! has_child "$1" initsol
}
