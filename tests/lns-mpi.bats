# lns-mpi: what lns does, by several processes under mpirun.

load helpers

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

setup_file() {
  load helpers
  if [[ ! -x "$HEXPIPE_BIN/lns-mpi" ]]; then skip "built without MPI"; fi
  cd "$BATS_FILE_TMPDIR"
  "$PYTHON" "$DATA/ring_graph.py" 3000 1500 1 >ring.graph
  initsol ring.graph --iterations 0 --greedy weight -o start.sol
}

setup() {
  cd "$BATS_TEST_TMPDIR" || return 1
  cp "$BATS_FILE_TMPDIR"/*.graph "$BATS_FILE_TMPDIR"/*.sol .
}

# on RANKS OPTIONS...: the search of the ring on so many ranks.
on() {
  local ranks=$1
  shift
  # Leaks are the MPI library's own.
  ASAN_OPTIONS="${ASAN_OPTIONS:-}:detect_leaks=0" mpirun --oversubscribe -n "$ranks" \
    lns-mpi --graph ring.graph --solution start.sol "$@"
}

weight_of() {
  "$CHECKERS/solution_check.py" ring.graph "$1" | sed 's/.*weight //'
}

@test "the result is independent and heavier, and the same on 1, 2 and 4 ranks" {
  for ranks in 1 2 4; do on $ranks --iterations 200 --no-reductions --round 20 -o $ranks.sol; done
  run "$CHECKERS/solution_check.py" ring.graph 1.sol
  assert_success
  assert [ "$(weight_of 1.sol)" -gt "$(weight_of start.sol)" ]
  assert_same_bytes 1.sol 2.sol
  assert_same_bytes 1.sol 4.sol
}

@test "a bundle through pipes, and without mpirun" {
  on 2 --iterations 50 -o two.sol
  lns-mpi --graph ring.graph --solution start.sol --iterations 50 -o alone.sol
  initsol ring.graph --iterations 0 --greedy weight |
    ASAN_OPTIONS="${ASAN_OPTIONS:-}:detect_leaks=0" mpirun --oversubscribe -n 2 lns-mpi --iterations 50 >out.tar
  run "$CHECKERS/bundle_check.py" out.tar
  assert_success
  assert_output --regexp "lns-mpi$"
  lns out.tar --iterations 0 -o piped.sol
  assert_same_bytes two.sol alone.sol
  assert_same_bytes two.sol piped.sol
}
