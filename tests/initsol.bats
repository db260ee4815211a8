# initsol: METIS graphs in, a maximal independent set out.

load helpers

setup_file() {
  load helpers
  "$PYTHON" "$DATA/ring_graph.py" 3000 2000 1 >"$BATS_FILE_TMPDIR/ring.graph"
  printf '4 4 10\n11 2 3\n12 1 3\n13 1 2 4\n14 3\n' >"$BATS_FILE_TMPDIR/small.graph"
}

setup() {
  cd "$BATS_TEST_TMPDIR" || return 1
  cp "$BATS_FILE_TMPDIR"/*.graph .
}

# Reductions solve the ring, and leave nothing to search.
whole() {
  initsol ring.graph --no-reductions "$@"
}

# weight_of SOLUTION: by the independent checker, which fails when the set is not independent or not maximal.
weight_of() {
  "$CHECKERS/solution_check.py" ring.graph "$1" | sed 's/.*weight //'
}

@test "the solution is independent and maximal, and its weight is the one in --stats" {
  run "$CHECKERS/graph_check.py" ring.graph
  assert_success
  whole --iterations 3000 -o out.sol --stats stats.json
  run "$CHECKERS/solution_check.py" ring.graph out.sol
  assert_success
  "$PYTHON" - "$output" <<'PYTHON'
import json, sys
stats = json.load(open("stats.json"))
assert sys.argv[1] == f"{stats['chosen']} chosen, weight {stats['weight']}", (sys.argv[1], stats)
assert stats["iterations"] == 3000 and stats["weight"] > stats["greedy_weight"] and not stats["complete"]
PYTHON
}

@test "what reductions solve is optimal, and ends at once" {
  initsol ring.graph --time-limit 100 -o solved.sol --stats stats.json
  certify --graph ring.graph --solution solved.sol --exact -o proven.sol --stats proven.json
  "$PYTHON" - "$(weight_of solved.sol)" <<'PYTHON'
import json, sys
stats, proven = json.load(open("stats.json")), json.load(open("proven.json"))
assert stats["complete"] and stats["seconds"] < 50 and stats["iterations"] == 0, stats
assert stats["weight"] == int(sys.argv[1]) == proven["bound"], (stats, proven)
PYTHON
  initsol ring.graph --no-reductions --iterations 3000 -o searched.sol
  assert [ "$(weight_of searched.sol)" -lt "$(weight_of solved.sol)" ]
}

@test "without a limit the search ends by itself, on the same bytes" {
  "$PYTHON" "$DATA/random_graph.py" 1500 >hard.graph
  initsol hard.graph -o one.sol --threads 1 --stats one.json
  initsol hard.graph -o two.sol --threads 2
  assert_same_bytes one.sol two.sol
  grep -q '"complete": false' one.json
}

@test "--iterations 0 and --time-limit 0 give the greedy solution" {
  initsol ring.graph --iterations 0 -o none.sol
  initsol ring.graph --time-limit 0 -o no_time.sol
  assert_same_bytes none.sol no_time.sol
  initsol ring.graph --iterations 3000 -o some.sol
  assert [ "$(weight_of some.sol)" -gt "$(weight_of none.sol)" ]
}

@test "--greedy weight and weight-degree differ" {
  initsol ring.graph --iterations 0 --greedy weight -o weight.sol
  initsol ring.graph --iterations 0 --greedy weight-degree -o degree.sol
  initsol ring.graph --iterations 0 -o default.sol
  assert_different_bytes weight.sol degree.sol
  assert_same_bytes degree.sol default.sol
}

@test "--greedy quality needs candidates" {
  assert_fails_with 1 "initsol: .*needs candidates" initsol ring.graph --greedy quality --iterations 0 -o out.sol
  assert [ ! -e out.sol ]
}

# bats test_tags=optimized
@test "--method, --seed, --hot, --cold, --starts change the search" {
  whole --iterations 4000 -o base.sol
  whole --iterations 4000 --method anneal -o same.sol
  assert_same_bytes base.sol same.sol
  whole --iterations 4000 --method tabu -o tabu.sol
  whole --method descend -o descend.sol
  assert [ "$(weight_of descend.sol)" -lt "$(weight_of base.sol)" ]
  whole --iterations 4000 --seed 2 -o seed.sol
  whole --iterations 4000 --hot 1 -o hot.sol
  whole --iterations 4000 --cold 0.2 -o cold.sol
  whole --iterations 4000 --starts 3 -o starts.sol
  for other in tabu descend seed hot cold starts; do
    assert_different_bytes base.sol $other.sol
    weight_of $other.sol >/dev/null
  done
  assert [ "$(weight_of starts.sol)" -ge "$(weight_of base.sol)" ]
}

@test "--seed, --tenure, --patience, --escape, --starts change tabu search" {
  tabu() {
    whole --method tabu --iterations 4000 --patience 50 "$@"
  }
  tabu -o base.sol
  tabu --seed 2 -o seed.sol
  tabu --tenure 5 -o tenure.sol
  whole --method tabu --iterations 4000 -o patience.sol
  tabu --escape restart -o restart.sol
  tabu --escape rebuild -o rebuild.sol
  tabu --starts 3 -o starts.sol
  for other in seed tenure patience restart rebuild starts; do
    assert_different_bytes base.sol $other.sol
    weight_of $other.sol >/dev/null
  done
  assert [ "$(weight_of starts.sol)" -ge "$(weight_of base.sol)" ]
}

@test "bad values of options end with 2" {
  assert_fails_with 2 "initsol: .*--greedy" initsol ring.graph --greedy luck
  assert_fails_with 2 "initsol: .*--method" initsol ring.graph --method luck
  assert_fails_with 2 "initsol: .*--hot" initsol ring.graph --hot 0
  assert_fails_with 2 "initsol: .*--cold" initsol ring.graph --cold nan
  assert_fails_with 2 "initsol: --tenure is no option of --method anneal" initsol ring.graph --tenure 5 -o out.sol
  assert_fails_with 2 "initsol: --hot is no option of --method tabu" initsol ring.graph --method tabu --hot 1 -o out.sol
  assert_fails_with 2 "initsol: .*--escape" initsol ring.graph --escape luck
  assert_fails_with 2 "initsol: .*--starts" initsol ring.graph --starts 0
  assert_fails_with 2 "initsol: .*--tenure" initsol ring.graph --tenure -1
  assert_fails_with 2 "initsol: .*--patience" initsol ring.graph --patience 0
  assert_fails_with 2 "initsol: .*--time-limit" initsol ring.graph --time-limit -1
  assert_fails_with 2 "initsol: .*--iterations" initsol ring.graph --iterations 1.5
}

@test "--starts gives the same bytes on 1 and 2 threads" {
  for method in anneal tabu; do
    whole --method $method --iterations 3000 --starts 4 --threads 1 -o one.sol
    whole --method $method --iterations 3000 --starts 4 --threads 2 -o two.sol
    assert_same_bytes one.sol two.sol
  done
}

@test "--time-limit is kept, and --log ends with the weight of the solution" {
  whole --time-limit 0.5 -o out.sol --log log.jsonl
  "$PYTHON" - "$(weight_of out.sol)" <<'PYTHON'
import json, sys
points = [json.loads(line) for line in open("log.jsonl")]
assert points[-1]["weight"] == int(sys.argv[1])
for key in ("seconds", "iteration", "weight"):
    values = [point[key] for point in points]
    assert values == sorted(values), key
# By the clock: on a machine that has other work it may end late.
assert 0.5 <= points[-1]["seconds"] < 20
PYTHON
}

@test "a signal writes the best so far and ends with 0" {
  for signal in INT TERM; do
    initsol ring.graph --no-reductions --time-limit 60 -o out.sol --log log.jsonl 3>&- &
    local pid=$!
    await test -s log.jsonl
    kill -s $signal $pid
    wait $pid
    weight_of out.sol >/dev/null
    rm out.sol log.jsonl
  done
}

@test "extreme graphs" {
  printf '0 0 10\n' >empty.graph
  initsol empty.graph -o empty.sol
  assert [ -e empty.sol ]
  assert [ ! -s empty.sol ]
  printf '1 0 10\n0\n' >one.graph
  initsol one.graph -o one.sol
  assert_equal "$(cat one.sol)" 1
  printf '3 3 10\n5 2 3\n7 1 3\n6 1 2\n' >complete.graph
  initsol complete.graph --iterations 100 -o complete.sol
  assert_equal "$(cat complete.sol)" 2
  printf '3 0 10\n4611686018427387904\n4611686018427387903\n0\n' >huge.graph
  initsol huge.graph --iterations 100 -o huge.sol
  assert_equal "$(tr '\n' ' ' <huge.sol)" "1 2 3 "
  printf '3 2\n2\n1 3\n2\n' >unweighted.graph
  initsol unweighted.graph --iterations 100 -o unweighted.sol
  assert_equal "$(tr '\n' ' ' <unweighted.sol)" "1 3 "
}

@test "a malformed line is named by its number" {
  # malform LINE TEXT MESSAGE: the small graph with one line replaced.
  malform() {
    sed "$1s/.*/$2/" small.graph >bad.graph
    assert_fails_with 1 "^initsol: bad.graph:$3" initsol bad.graph --iterations 1 -o out.sol
  }
  malform 1 "4 x 10" "1: expected the number of edges, found 'x'"
  malform 1 "4 4 200" "1: expected a format"
  malform 1 "5 4 10" "6: expected the lines of 5 vertices, found 4"
  malform 1 "3 4 10" "5: expected nothing after the lines of 3 vertices|4: expected a neighbour from 1 to 3, found '4'"
  malform 1 "4 5 10" " expected 5 edges"
  malform 1 "4 3 10" "[45]: expected 3 edges"
  malform 2 "" "2: expected the vertex weight, found the end of the line"
  malform 2 "eleven 2 3" "2: expected the vertex weight, found 'eleven'"
  malform 2 "-11 2 3" "2: expected the vertex weight, found '-11'"
  malform 3 "12 1 1" "3: expected each neighbour once"
  malform 3 "12 1 2" "3: expected no loops"
  malform 3 "12 1 0" "3: expected a neighbour from 1 to 4, found '0'"
  malform 3 "12 1 5" "3: expected a neighbour from 1 to 4, found '5'"
  malform 3 "12 1 4" "3: expected every edge at both ends, found 4 beside 2"
  malform 5 "9223372036854775807 3" "5: expected weights whose sum fits 64 bits"
  assert [ ! -e out.sol ]
}

@test "a DIMACS graph gives what the METIS graph does" {
  "$PYTHON" - >ring.col <<'PYTHON'
header, *rows = open("ring.graph").read().splitlines()
print("c a ring\np edge", *header.split()[:2])
for v, row in enumerate(rows, 1):
    weight, *neighbours = map(int, row.split())
    print("n", v, weight)
    for u in neighbours:
        if u < v:
            print("e", u, v)
PYTHON
  initsol ring.graph --iterations 1000 -o metis.sol
  initsol ring.col --iterations 1000 -o dimacs.sol
  initsol --iterations 1000 --format sol <ring.col >pipe.sol
  assert_same_bytes metis.sol dimacs.sol
  assert_same_bytes metis.sol pipe.sol
  sed 's/^e 1 .*/e 1 1/' ring.col >loop.col
  assert_fails_with 1 "^initsol: loop.col:[0-9]+: expected no loops" initsol loop.col --iterations 1 -o out.sol
}

@test "graphs of other programs, and what options say of them" {
  initsol small.graph -o metis.sol
  printf '%%%%MatrixMarket matrix coordinate pattern symmetric\n4 4 4\n2 1\n3 1\n3 2\n4 3\n' >small.mtx
  printf '0 1\n0 2\n1 2\n2 3\n' >small.edges
  sed 's/^1[1-4]/1/' small.graph >unweighted.graph
  initsol unweighted.graph -o unweighted.sol
  initsol small.mtx -o mtx.sol
  initsol small.edges --graph-format edges -o edges.sol
  for other in mtx edges; do assert_same_bytes unweighted.sol $other.sol; done
  # Without the option it is a METIS header.
  assert_fails_with 1 "initsol: small.edges:[0-9]+: expected" initsol small.edges -o out.sol

  initsol small.graph --complement -o clique.sol
  assert_equal "$(tr '\n' ' ' <clique.sol)" "1 2 3 "

  sed 's/^1\([1-4]\)/1.\1/' small.graph >real.graph
  assert_fails_with 1 "initsol: real.graph:2: .*--weight-scale takes others" initsol real.graph -o out.sol
  initsol real.graph --weight-scale 10 -o real.sol
  assert_same_bytes metis.sol real.sol

  printf '4 4 10\n11 2 3 1\n12 1 3\n13 1 2 4 4\n14 3 3\n' >loops.graph
  assert_fails_with 1 "initsol: loops.graph:2: expected no loops, .*--tolerant" initsol loops.graph -o out.sol
  run initsol loops.graph --tolerant -o tolerant.sol
  assert_success
  assert_output --partial "loops.graph: left out 1 loops and 1 repeated edges"
  assert_same_bytes metis.sol tolerant.sol

  printf '%s' "$(cat small.graph)" >open.graph
  initsol open.graph -o open.sol
  assert_same_bytes metis.sol open.sol

  initsol small.graph -o bundle.tar
  assert_fails_with 2 "initsol: .*do nothing without a graph file" initsol bundle.tar --complement -o out.sol
  assert_fails_with 2 "initsol: .*--graph-format" initsol small.graph --graph-format pdf -o out.sol
}

@test "the DIMACS example of formats/README.md is the path beside it" {
  "$PYTHON" - "$HEXPIPE_SOURCE/formats/README.md" >path.col <<'PYTHON'
import re, sys
print(re.search(r"<!-- dimacs path.col -->\n```\n(.*?)```", open(sys.argv[1]).read(), re.S)[1], end="")
PYTHON
  initsol path.col --iterations 10 -o path.sol --stats path.json
  assert_equal "$(tr '\n' ' ' <path.sol)" "1 3 "
  grep -q '"weight": 10' path.json
}

@test "every truncated prefix of a graph is refused" {
  local size prefix
  size=$(stat -c %s small.graph)
  for ((prefix = 0; prefix < size - 1; ++prefix)); do
    head -c $prefix small.graph >cut.graph
    assert_fails_with 1 "^initsol: cut.graph" initsol cut.graph --iterations 1 -o out.sol
  done
}

@test "a full disk is noticed" {
  assert_fails_with 1 "initsol: .*No space left" shell "initsol ring.graph --iterations 1 --format sol >/dev/full"
  # Under the log it does not cost the solution.
  assert_fails_with 1 "initsol: /dev/full: .*No space left" initsol ring.graph --iterations 1 -o out.sol --log /dev/full
  initsol ring.graph --iterations 1 -o whole.sol
  assert_same_bytes whole.sol out.sol
}
