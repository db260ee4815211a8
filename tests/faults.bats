# Each call of the system fails once, the disk is full, the tool is killed: tests/faults/README.md. A quick share of it.
# The sanitizers interpose the same calls.
# bats file_tags=optimized

load helpers

for_tools() {
  HEXPIPE_BIN="$HEXPIPE_BIN" timeout 300 "$PYTHON" "$HEXPIPE_SOURCE/tests/faults/inject.py" \
    --per-kind 6 --disk 5 --kills 5 --pipes 3 --stalls 5 "$@" || fail "see above"
}

@test "faults leave the old output or the whole new one: findhex, buildgraph" {
  for_tools findhex buildgraph
}

@test "faults leave the old output or the whole new one: initsol, lns, certify" {
  for_tools initsol lns certify
}

@test "faults leave the old output or the whole new one: assemble" {
  for_tools assemble
}

@test "faults leave the old output or the whole new one: tetmesh" {
  [[ -x $HEXPIPE_BIN/tetmesh ]] || skip "built without TetGen"
  for_tools tetmesh
}

@test "faults leave the old output or the whole new one: merge-parts" {
  for_tools merge-parts
}

@test "faults leave the old output or the whole new one: mesh-part" {
  [[ -x $HEXPIPE_BIN/mesh-part ]] || skip "built without METIS"
  for_tools mesh-part
}

@test "faults leave the old output or the whole new one: viewmesh" {
  [[ -x $HEXPIPE_BIN/viewmesh ]] || skip "built without it"
  for_tools viewmesh
}

@test "memory that is missing at the end, for statistics and history, is an error and no crash" {
  "$PYTHON" "$DATA/lattices/lattice.py" kuhn 1 >part.mesh
  findhex -q --mesh part.mesh | buildgraph -q | initsol -q --iterations 5 -o part.tar
  local library="$HEXPIPE_BIN/../lib/libfail_calls.so" tool input last case calls number code
  for case in "findhex part.mesh 600" "certify part.tar 150" "assemble part.tar 150"; do
    read -r tool input last <<<"$case"
    LD_PRELOAD=$library HEXPIPE_FAULT=count:count $tool -q $input -o out.tar
    calls=$(sed -n 's/^memory //p' count)
    # Every third: allocations come in longer rows of a kind.
    for ((number = calls - last; number <= calls; number += 3)); do
      code=0
      LD_PRELOAD=$library HEXPIPE_FAULT=memory:$number $tool -q $input -o out.tar 2>message || code=$?
      if ((code > 1)); then fail "$tool ends with $code when allocation $number of $calls fails"; fi
    done
  done
}

@test "memory that is missing anywhere behind the options is an error in time, and leaves nothing" {
  "$PYTHON" "$DATA/lattices/lattice.py" kuhn 1 >part.mesh
  findhex -q --mesh part.mesh | buildgraph -q | initsol -q --iterations 5 -o part.tar
  local library="$HEXPIPE_BIN/../lib/libfail_calls.so" calls number code
  LD_PRELOAD=$library HEXPIPE_FAULT=count:count lns -q --iterations 5 --threads 2 part.tar -o out.tar
  calls=$(sed -n 's/^memory //p' count)
  for ((number = calls / 2; number <= calls; number += 1)); do
    code=0
    LD_PRELOAD=$library HEXPIPE_FAULT=memory:$number timeout 120 lns -q --iterations 5 --threads 2 part.tar -o out.tar 2>message || code=$?
    if ((code > 1)); then fail "lns ends with $code when allocation $number of $calls fails"; fi
  done
  assert_equal "$(ls)" "$(printf '%s\n' count message out.tar part.mesh part.tar)"
}

@test "a library that never ends holds no tool up" {
  "$PYTHON" "$DATA/lattices/lattice.py" kuhn 1 >part.mesh
  findhex -q --mesh part.mesh | buildgraph -q | initsol -q --iterations 5 -o part.tar
  certify -q part.tar -o certified.tar
  local waits="timeout -k 1 20 env LD_PRELOAD=$HEXPIPE_BIN/../lib/libfail_calls.so HEXPIPE_FAULT=exit:1" tool
  for tool in findhex buildgraph initsol lns certify assemble; do
    run $waits $tool --version
    assert_success
    assert_output --partial "$tool (hexpipe)"
    run -2 $waits $tool --no-such-option
  done
  shell "$waits certify -q part.tar | cat >piped.tar"
  run -1 $waits certify -q --memory 1M part.tar -o none.tar
  # It waits where nobody leaves it out.
  run -124 ${waits/20/0.2} sleep 0
  assert_same_bytes certified.tar piped.tar
}

@test "help that cannot be written is an error" {
  run_apart bash -c "findhex --help >/dev/full"
  assert_equal "$status" 1
  assert_equal "$stderr" "findhex: stdout: cannot write: No space left on device"
}
