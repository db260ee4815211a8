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

# The MPI library's own leaks are known by its name, to which stacks have to reach: its plugins are unloaded by the end.
export LSAN_OPTIONS="suppressions=$HEXPIPE_SOURCE/tests/leaks_of_mpi.txt:print_suppressions=0"
export ASAN_OPTIONS="${ASAN_OPTIONS:-}:fast_unwind_on_malloc=0"

# on RANKS OPTIONS...: the search of the ring on that number of ranks.
on() {
  local ranks=$1
  shift
  mpirun --oversubscribe -n "$ranks" lns-mpi --graph ring.graph --solution start.sol "$@"
}

# start_long OPTIONS...: a search of two ranks that takes minutes; $job is mpirun. Goes on when a round is over, which needs
# both of them.
start_long() {
  "$PYTHON" "$DATA/random_graph.py" 1000 >ring.graph
  initsol ring.graph --iterations 0 -o start.sol
  rm -f log.jsonl out.sol
  mpirun --oversubscribe -n 2 lns-mpi --graph ring.graph --solution start.sol --iterations 100000000 \
    --round 20 --log log.jsonl -o out.sol "$@" 2>message 3>&- &
  job=$!
  await test -s log.jsonl
}

weight_of() {
  "$CHECKERS/solution_check.py" ring.graph "$1" | sed 's/.*weight //'
}

@test "the first of several ranks tells the version and the help for all" {
  run --separate-stderr mpirun --oversubscribe -n 2 lns-mpi --version
  assert_success
  assert_line --index 0 --regexp '^lns-mpi \(hexpipe\) '
  assert_equal "${#lines[@]} $stderr" "2 "
  run mpirun --oversubscribe -n 2 lns-mpi --help
  assert_success
  assert_equal "$(grep -c '^Usage: ' <<<"$output")" 1
}

# bats test_tags=optimized
@test "the result is independent and heavier, and the same on 1, 2 and 4 ranks" {
  for ranks in 1 2 4; do on $ranks --iterations 200 --no-reductions --round 20 -o $ranks.sol; done
  run "$CHECKERS/solution_check.py" ring.graph 1.sol
  assert_success
  assert [ "$(weight_of 1.sol)" -gt "$(weight_of start.sol)" ]
  assert_same_bytes 1.sol 2.sol
  assert_same_bytes 1.sol 4.sol
}

# bats test_tags=optimized
@test "a bundle through pipes, and without mpirun" {
  on 2 --iterations 50 -o two.sol
  lns-mpi --graph ring.graph --solution start.sol --iterations 50 -o alone.sol
  initsol ring.graph --iterations 0 --greedy weight |
    mpirun --oversubscribe -n 2 lns-mpi --iterations 50 >out.tar
  run "$CHECKERS/bundle_check.py" out.tar
  assert_success
  assert_output --regexp "lns-mpi$"
  lns out.tar --iterations 0 -o piped.sol
  assert_same_bytes two.sol alone.sol
  assert_same_bytes two.sol piped.sol
}

# bats test_tags=optimized
@test "every option changes the search" {
  whole() { lns-mpi --graph ring.graph --solution start.sol --iterations 60 --no-reductions "$@"; }
  whole -o base.sol
  whole --blocks 9 -o blocks.sol
  whole --overlap 1 -o overlap.sol
  whole --round 3 -o round.sol
  whole --seed 2 -o seed.sol
  whole --fragment-size 20 -o size.sol
  for other in blocks overlap round seed size; do assert_different_bytes base.sol $other.sol; done
  lns-mpi --iterations 5 --free-running <(initsol ring.graph --iterations 0) | tar xO --wildcards 'history/*lns-mpi.json' |
    grep -q depends_on_timing
  # The search ends long before its 5000 fragments.
  lns-mpi --graph ring.graph --solution start.sol --iterations 5000 --round 5 --target-gap 0.5 --bound 500000 \
    --stats stats.json -o target.sol
  "$PYTHON" -c 'import json; stats = json.load(open("stats.json")); assert stats["rounds"] <= 1, stats'
}

@test "--fragments writes what was improved, the same on any number of ranks, as viewmesh reads it" {
  for ranks in 1 2; do on $ranks --iterations 200 --round 20 --fragments $ranks.txt --stats stats.json -o out.sol; done
  assert_same_bytes 1.txt 2.txt
  "$PYTHON" - <<'PYTHON'
import json
lines = [list(map(int, line.split())) for line in open("1.txt")]
assert len(lines) == json.load(open("stats.json"))["improvements"] > 10, len(lines)
for line in lines:
    assert len(set(line)) == len(line) > 1 and 1 <= min(line) <= max(line) <= 3000, line
PYTHON
}

@test "a run that is killed goes on from its checkpoint to the same result, on any number of ranks" {
  search() { on "$@" --iterations 300 --no-reductions --round 10; }
  search 2 -o straight.sol
  search 2 --checkpoint state --checkpoint-interval 0 -o killed.sol &
  local job=$! run rank ranks
  await test -e state/checkpoint.json
  run=$(pgrep -P $job)
  ranks=$(pgrep -P "$run" -x lns-mpi)
  kill -KILL "$run"
  wait $job || true
  # mpirun's processes end with it.
  for rank in $ranks; do await has_ended "$rank"; done
  grep -q '"round"' state/checkpoint.json
  search 3 --checkpoint state -v -o resumed.sol 2>message
  grep -q "goes on after round" message
  assert_same_bytes straight.sol resumed.sol
  # One round alone is left.
  assert_equal "$(ls state | wc -l)" 2
}

# Cut-off ones are read in the same way.
# bats test_tags=optimized
@test "a checkpoint of another graph, and a damaged one, are errors" {
  on 2 --iterations 20 --checkpoint state -o one.sol
  "$PYTHON" "$DATA/ring_graph.py" 3000 1500 2 >other.graph
  initsol other.graph --iterations 0 -o other.sol
  cp other.graph ring.graph
  cp other.sol start.sol
  run_apart on 2 --iterations 20 --checkpoint state -o out.sol
  assert_equal "$status" 1
  assert_equal "$(grep -c '^lns-mpi: ' <<<"$stderr")" 1
  grep -q "^lns-mpi: state/checkpoint.json: expected a checkpoint of this graph and its blocks" <<<"$stderr"
  echo '{"round": 1}' >state/checkpoint.json
  run_apart on 2 --iterations 20 --checkpoint state -o out.sol
  assert_equal "$status" 1
  grep -q "^lns-mpi: state/checkpoint.json: expected the title of a checkpoint" <<<"$stderr"
  assert [ ! -e out.sol ]
}

@test "a checkpoint that is cut off, lacks a rank's file, or says nonsense is an error that names the file" {
  on 2 --iterations 20 --round 1 --checkpoint state -o one.sol
  local round
  round=$(echo state/round-*)
  cp -r state whole
  refuse() {
    run_apart timeout 200 mpirun --oversubscribe -n 2 lns-mpi --graph ring.graph --solution start.sol --iterations 20 \
      --round 1 --checkpoint state -o out.sol
    assert_equal "$status" 1
    assert_equal "$(grep -c '^lns-mpi: ' <<<"$stderr")" 1
    grep -Eq "^lns-mpi: $1" <<<"$stderr"
    assert [ ! -e out.sol ]
    rm -r state
    cp -r whole state
  }
  head -c 3000 whole/${round#state/}/0001.tar >$round/0001.tar
  refuse "$round/0001.tar: "
  rm $round/0000.tar
  refuse "$round/0000.tar: .*No such file"
  head -c 100 whole/checkpoint.json >state/checkpoint.json
  refuse "state/checkpoint.json: expected the title of a checkpoint"
  "$PYTHON" - whole/${round#state/}/0001.tar $round/0001.tar <<'PYTHON'
import io, sys, tarfile
import numpy as np
with tarfile.open(sys.argv[1]) as whole, tarfile.open(sys.argv[2], "w", format=tarfile.PAX_FORMAT) as damaged:
    for member in whole:
        array = np.load(io.BytesIO(whole.extractfile(member).read()))
        if member.name == "place_state.npy":
            array[0, 0] = 4000000000
        file = io.BytesIO()
        np.save(file, array)
        member.size = file.tell()
        file.seek(0)
        damaged.addfile(member, file)
PYTHON
  refuse "$round/0001.tar: expected the state of 2 blocks in this part of a checkpoint"
}

# bats test_tags=optimized
@test "--prove proves a bound on any number of ranks, close to that of certify" {
  for ranks in 1 2; do
    on $ranks --iterations 100 --prove 60 --certificate $ranks.proof --stats $ranks.json -o out.sol
    run "$CHECKERS/bound_check.py" ring.graph $ranks.proof
    assert_success
    cp out.sol best.sol
  done
  assert_same_bytes 1.proof 2.proof
  on 1 --iterations 100 --prove 3 --stats few.json -o out.sol
  certify --graph ring.graph --solution best.sol --iterations 60 --stats certify.json -o out.sol
  "$PYTHON" - "$output" "$(weight_of best.sol)" <<'PYTHON'
import json, sys
bound, few, single = (json.load(open(name + ".json"))["bound"] for name in ("1", "few", "certify"))
assert sys.argv[1].startswith(f"bound {bound} "), sys.argv
assert int(sys.argv[2]) <= bound < few, (bound, few)
assert bound < 1.01 * single, (bound, single)
PYTHON
}

@test "--prove on weights of very different sizes overflows no bound" {
  "$PYTHON" - <<'PYTHON'
with open("heavy.graph", "w") as graph, open("heavy.sol", "w") as solution:
    print("601 300 10\n4000000000000000000", file=graph)
    print(1, file=solution)
    for v in range(2, 602, 2):
        print(f"3 {v + 1}\n5 {v}", file=graph)
        print(v + 1, file=solution)
PYTHON
  for ranks in 1 2; do
    mpirun --oversubscribe -n $ranks lns-mpi --graph heavy.graph --solution heavy.sol --iterations 1 --prove 3 \
      --certificate $ranks.proof -o out.sol
    run "$CHECKERS/bound_check.py" heavy.graph $ranks.proof
    assert_success
    assert_output --regexp "^bound 4000000000000001500 "
  done
  assert_same_bytes 1.proof 2.proof
}

# bats test_tags=optimized
@test "SIGTERM to one rank, and SIGUSR1 to mpirun, write the best so far and end well" {
  local job
  for signal in TERM USR1; do
    start_long
    if [[ $signal == TERM ]]; then
      kill -TERM "$(pgrep -P $job -x lns-mpi | head -1)"
    else
      kill -USR1 $job
    fi
    wait $job
    run "$CHECKERS/solution_check.py" ring.graph out.sol
    assert_success
  done
}

# bats test_tags=optimized
@test "under a time limit a rank searches its blocks as one, and each rank has a block" {
  "$PYTHON" "$DATA/random_graph.py" 1000 >ring.graph
  initsol ring.graph --iterations 0 -o start.sol
  # Alone, it has nothing to wait for at the end of a round.
  lns-mpi --graph ring.graph --solution start.sol --time-limit 1 --stats stats.json -o out.sol
  "$PYTHON" -c 'import json; stats = json.load(open("stats.json")); assert (stats["rounds"], stats["blocks"]) == (1, 4), stats'
  on 6 --time-limit 1 --stats stats.json -o out.sol
  "$PYTHON" -c 'import json; stats = json.load(open("stats.json")); assert stats["blocks"] == 6 and stats["rounds"] > 1, stats'
  run "$CHECKERS/solution_check.py" ring.graph out.sol
  assert_success
  assert [ "$(weight_of out.sol)" -gt "$(weight_of start.sol)" ]
  # Each rank has as many blocks as the others. Blocks are small, so borders move by one edge.
  on 3 --time-limit 1 --stats stats.json -o out.sol
  on 3 --time-limit 1 --overlap 1 --stats one.json -o out.sol
  on 3 --time-limit 1 --overlap 2 --stats two.json -o out.sol
  "$PYTHON" - <<'PYTHON'
import json
usual, one, two = (json.load(open(name + ".json")) for name in ("stats", "one", "two"))
assert usual["blocks"] == 6, usual
assert usual["held_edges"] == one["held_edges"] < two["held_edges"], (usual, one, two)
PYTHON
  run_apart on 6 --iterations 10 -o out.sol
  assert_equal "$status" 1
  grep -q "expected at least a block for each of 6 ranks, found 4" <<<"$stderr"
}

# bats test_tags=optimized
@test "more ranks than blocks, and bad input, are one line of one rank" {
  refuse() {
    local ranks=$1 message=$2
    shift 2
    run_apart timeout 200 mpirun --oversubscribe -n "$ranks" lns-mpi --iterations 1 -o out.sol "$@"
    assert_equal "$status" 1
    assert_equal "$(grep -c '^lns-mpi: ' <<<"$stderr")" 1
    grep -Eq "^lns-mpi: $message" <<<"$stderr"
  }
  refuse 3 "expected at least a block for each of 3 ranks, found 2" --graph ring.graph --solution start.sol --blocks 2
  refuse 2 "missing.graph: .*No such file" --graph missing.graph --solution start.sol
  echo 99999 >bad.sol
  refuse 2 "bad.sol:1: expected a vertex from 1 to 3000" --graph ring.graph --solution bad.sol
  run_apart mpirun --oversubscribe -n 2 lns-mpi --no-such-option
  assert_equal "$status" 2
  assert_equal "$(grep -c '^lns-mpi: ' <<<"$stderr")" 1
}

# bats test_tags=optimized
@test "a rank that alone has a wrong option says so" {
  cat >wrapper <<'SHELL'
#!/bin/bash
if [[ $OMPI_COMM_WORLD_RANK == 1 ]]; then extra=(--no-such-option); fi
exec lns-mpi "${extra[@]}" "$@"
SHELL
  chmod +x wrapper
  run_apart timeout 200 mpirun --oversubscribe -n 2 ./wrapper --graph ring.graph --solution start.sol -o out.sol
  assert_equal "$status" 2
  assert_equal "$(grep -c '^lns-mpi: .*--no-such-option' <<<"$stderr")" 1
}

# bats test_tags=optimized
@test "a rank that dies ends the job, which names it" {
  local job
  start_long --checkpoint state --checkpoint-interval 0
  await test -e state/checkpoint.json
  kill -KILL "$(pgrep -P $job -x lns-mpi | tail -1)"
  local code=0
  wait $job || code=$?
  assert [ "$code" -ne 0 ]
  # Open MPI 5 breaks the line.
  tr '\n' ' ' <message | grep -Eq "process rank [01] .*signal 9"
  assert [ ! -e out.sol ]
  # Its checkpoint is whole, and not worse where a search goes on from there.
  local weight
  weight=$(sed -n 's/.*"weight": \([0-9]*\).*/\1/p' state/checkpoint.json)
  assert [ "$weight" -ge "$(weight_of start.sol)" ]
  on 2 --time-limit 1 --checkpoint state -v -o out.sol 2>message
  grep -q "goes on after round" message
  assert [ "$(weight_of out.sol)" -ge "$weight" ]
}

@test "ranks that are started with other options are an error, not a job that hangs" {
  cat >wrapper <<'SHELL'
#!/bin/bash
if [[ $OMPI_COMM_WORLD_RANK == 1 ]]; then extra=(--overlap 1); fi
exec lns-mpi "${extra[@]}" "$@"
SHELL
  chmod +x wrapper
  run_apart timeout 200 mpirun --oversubscribe -n 2 ./wrapper --graph ring.graph --solution start.sol --iterations 1 -o out.sol
  assert_equal "$status" 2
  assert_equal "$(grep -c '^lns-mpi: ' <<<"$stderr")" 1
  grep -q "^lns-mpi: rank 1: expected the options of the first rank, found others" <<<"$stderr"
}

# parts_of PREFIX MESH [QUALITY]: graph parts PREFIX0.tar to PREFIX2.tar, of three parts.
parts_of() {
  mesh-part "$2" --parts 3 -o "$1"
  local i
  for i in 0 1 2; do findhex "$1/part-000$i.tar" --min-quality "${3:-0.4}" -o "$1.candidates$i.tar"; done
  buildgraph "$1.candidates0.tar" --neighbours "$1.candidates1.tar" "$1.candidates2.tar" -o "${1}0.tar"
  buildgraph "$1.candidates1.tar" --neighbours "$1.candidates0.tar" "$1.candidates2.tar" -o "${1}1.tar"
  buildgraph "$1.candidates2.tar" --neighbours "$1.candidates0.tar" "$1.candidates1.tar" -o "${1}2.tar"
}

# bats test_tags=optimized
@test "parts that were made apart are searched together, and their solutions merge into one" {
  "$PYTHON" "$DATA/lattices/lattice.py" kuhn 3 >lattice.mesh
  parts_of part lattice.mesh
  for ranks in 1 3; do
    mpirun --oversubscribe -n $ranks lns-mpi --parts part0.tar part1.tar part2.tar --iterations 60 --stats stats.json -o $ranks
    "$PYTHON" -c 'import json; stats = json.load(open("stats.json")); assert stats["chosen"] == 27, stats'
  done
  for i in 0 1 2; do assert_same_bytes 1/part$i.tar 3/part$i.tar; done
  merge-parts 1/part0.tar 1/part1.tar 1/part2.tar -o merged.tar
  lns merged.tar --iterations 0 --stats stats.json -o merged.sol
  assert_equal "$(wc -l <merged.sol)" 27

  "$PYTHON" "$DATA/lattices/lattice.py" five 3 >other.mesh
  parts_of other other.mesh
  refuse() {
    local ranks=$1 message=$2
    shift 2
    run_apart mpirun --oversubscribe -n "$ranks" lns-mpi --iterations 1 -o out --parts "$@"
    assert_equal "$status" 1
    assert_equal "$(grep -c '^lns-mpi: ' <<<"$stderr")" 1
    grep -Eq "^lns-mpi: $message" <<<"$stderr"
  }
  refuse 3 "other2.tar: expected a part of the mesh of part0.tar, found one of another mesh" part0.tar part1.tar other2.tar
  refuse 3 "missing2.tar: .*No such file" part0.tar part1.tar missing2.tar
  refuse 1 "part0.tar: expected part 0 of 2, found part 0 of 3" part0.tar part2.tar
  refuse 3 "part2.tar: expected part 1 of 3, found part 2 of 3" part0.tar part2.tar part1.tar
  refuse 4 "expected at least a part for each of 4 ranks, found 3" part0.tar part1.tar part2.tar
  refuse 2 "part.candidates0.tar: expected graph" part.candidates0.tar part1.tar part2.tar
  # Parts of the same mesh, but with other candidates; only one rank gets them.
  parts_of fewer lattice.mesh 0.7
  refuse 2 "parts 0 and 1 disagree about the conflicts between them" part0.tar fewer1.tar part2.tar
  cat >wrapper <<'SHELL'
#!/bin/bash
if [[ $OMPI_COMM_WORLD_RANK == 1 ]]; then exec lns-mpi --iterations 1 -o out --parts other0.tar other1.tar other2.tar; fi
exec lns-mpi "$@"
SHELL
  chmod +x wrapper
  run_apart mpirun --oversubscribe -n 3 ./wrapper --iterations 1 -o out --parts part0.tar part1.tar part2.tar
  assert_equal "$status" 1
  grep -q "^lns-mpi: other1.tar: expected a part of the mesh of .*part0.tar, found one of another mesh" <<<"$stderr"
  assert_fails_with 2 "--fragments needs a graph that is not in parts" lns-mpi --parts part0.tar --fragments f -o out
  assert_fails_with 2 "--parts needs a directory" lns-mpi --parts part0.tar
  assert_fails_with 2 "expected --parts or a graph" lns-mpi --parts part0.tar --graph ring.graph -o out
}

# bats test_tags=optimized
@test "what goes wrong beside the solution does not cost it" {
  on 2 --iterations 30 --prove 2 -o whole.sol
  for side in log fragments certificate; do
    run on 2 --iterations 30 --prove 2 -o $side.sol --$side /dev/full
    assert_failure
    assert_output --partial "/dev/full: "
    assert_same_bytes whole.sol $side.sol
    assert_fails_with 1 "lns-mpi: no/such/place: .*No such file" lns-mpi missing.tar --prove 2 --$side no/such/place
  done
}

# bats test_tags=optimized
@test "a run that goes on gives nothing lighter than what it was given" {
  # Reductions leave out u, which v could replace; x keeps v out, and p comes in, one lighter than u, until the search
  # gets there.
  "$PYTHON" - <<'PYTHON'
weights, adjacent, chosen = [], [], []
def vertex(weight):
    weights.append(weight), adjacent.append(set())
    return len(weights)
def join(a, b):
    adjacent[a - 1].add(b), adjacent[b - 1].add(a)
core = [vertex(20) for _ in range(400)]
for i, z in enumerate(core):
    join(z, core[i - 1]), join(z, core[i - 17])
for z in core:
    u, v, x, y, p = map(vertex, (2, 3, 1, 10, 1))
    for edge in (u, v), (u, y), (u, p), (v, x), (v, y), (v, p), (y, z):
        join(*edge)
    chosen += [y, x, p] if adjacent[z - 1] & set(chosen) else [z, u, x]
with open("ring.graph", "w") as file:
    print(len(weights), sum(map(len, adjacent)) // 2, 10, file=file)
    for weight, row in zip(weights, adjacent):
        print(weight, *sorted(row), file=file)
with open("start.sol", "w") as file:
    print(*sorted(chosen), sep="\n", file=file)
PYTHON
  few() {
    on "$@" --iterations 1 --round 1 --fragment-size 2 --largest-fragment 2 --annealed-fragment 0 \
      --recombined-fragment 0 --checkpoint state
  }
  few 1 -o first.sol
  few 2 -o second.sol
  assert_same_bytes start.sol first.sol
  assert_same_bytes start.sol second.sol
  assert [ "$(sed -n 's/.*"weight": \([0-9]*\).*/\1/p' state/checkpoint.json)" -lt "$(weight_of start.sol)" ]
}

@test "options that would do nothing are refused" {
  refuse() { assert_fails_with 2 "lns-mpi: $1" lns-mpi --graph ring.graph --solution start.sol -o out.sol "${@:2}"; }
  refuse "--certificate requires --prove" --certificate proof
  refuse "--certificate needs a bound, and --prove 0 proves none" --prove 0 --certificate proof
  refuse "--checkpoint-interval requires --checkpoint" --checkpoint-interval 1
  refuse "--round does nothing without --iterations" --round 5 --time-limit 1
  refuse "--bound does nothing without --target-gap" --bound 5
  assert_fails_with 2 "lns-mpi: --blocks needs a graph that is not in parts" lns-mpi --parts part0.tar --blocks 3 -o out
}

@test "parts of the same name would be written to one file" {
  assert_fails_with 2 "lns-mpi: expected parts of different names, found a/part.tar and b/part.tar" \
    lns-mpi --parts a/part.tar b/part.tar -o out
}
