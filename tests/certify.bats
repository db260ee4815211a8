# certify: a graph and a solution in, a bound and a gap out.

load helpers

setup_file() {
  load helpers
  cd "$BATS_FILE_TMPDIR"
  "$PYTHON" "$DATA/ring_graph.py" 3000 2000 1 >ring.graph
  initsol ring.graph --iterations 0 -o greedy.sol
  lns --graph ring.graph --solution greedy.sol --iterations 300 -o good.sol
}

setup() {
  cd "$BATS_TEST_TMPDIR" || return 1
  cp "$BATS_FILE_TMPDIR"/*.graph "$BATS_FILE_TMPDIR"/*.sol .
}

# number KEY FILE: of --stats.
number() {
  "$PYTHON" -c "import json; print(json.load(open('$2'))['$1'])"
}

@test "the certificate proves the bound in the eyes of an independent checker" {
  certify --graph ring.graph --solution good.sol --iterations 50 --certificate proof --stats stats.json -o out.sol
  run "$CHECKERS/bound_check.py" ring.graph proof
  assert_success
  assert_output --regexp "^bound $(number bound stats.json) by "
  assert_same_bytes good.sol out.sol
  # A proof that somebody touched is none.
  sed '2s/^[0-9]*/0/' proof >less
  run "$CHECKERS/bound_check.py" ring.graph less
  assert_failure
  sed '2s/$/ 3000/' proof >no_clique
  run "$CHECKERS/bound_check.py" ring.graph no_clique
  assert_failure
}

@test "weight, bound and gap belong together, and lns is nearer to the bound than greedy" {
  for name in greedy good; do
    certify --graph ring.graph --solution $name.sol --iterations 100 --stats $name.json -o out.sol
    run "$CHECKERS/solution_check.py" ring.graph $name.sol
    assert_output --regexp "weight $(number weight $name.json)$"
  done
  "$PYTHON" - <<'PYTHON'
import json
greedy, good = (json.load(open(f"{name}.json")) for name in ("greedy", "good"))
assert greedy["bound"] == good["bound"]
for stats in greedy, good:
    assert abs(stats["gap"] - (1 - stats["weight"] / stats["bound"])) < 1e-9
    assert stats["maximal"]
assert 0 <= good["gap"] < 0.02 < greedy["gap"]
assert good["fixed_out"] > greedy["fixed_out"]
PYTHON
}

@test "more iterations give a better bound, and the same bytes twice" {
  for count in 0 10 200; do
    certify --graph ring.graph --solution good.sol --iterations $count --certificate proof$count --stats $count.json -o out.sol
  done
  assert [ "$(number bound 200.json)" -lt "$(number bound 10.json)" ]
  assert [ "$(number bound 10.json)" -lt "$(number bound 0.json)" ]
  certify --graph ring.graph --solution good.sol --iterations 10 --certificate again --threads 1 -o out.sol
  assert_same_bytes proof10 again
}

@test "the time limit is kept, and --log ends with the bound" {
  certify --graph ring.graph --solution greedy.sol --time-limit 0.3 --iterations 1000000000 --log log.jsonl \
    --stats stats.json -o out.sol
  "$PYTHON" - <<'PYTHON'
import json
points = [json.loads(line) for line in open("log.jsonl")]
assert points[-1]["bound"] == json.load(open("stats.json"))["bound"]
bounds = [point["bound"] for point in points]
assert bounds == sorted(bounds, reverse=True)
assert 0.3 <= points[-1]["seconds"] < 20  # nothing else would end it; a machine under load takes its time
PYTHON
}

@test "bound and gap are in the history of the bundle" {
  certify --graph ring.graph --solution good.sol --iterations 10 >out.tar
  tar xf out.tar
  grep -q '"bound"' history/*certify.json
  grep -q '"gap"' history/*certify.json
  [ -f solution/chosen.npy ]
}

@test "assemble reports weight, bound and gap, unless the graph is another" {
  findhex --mesh "$DATA/jittered_lattice.mesh" | buildgraph | initsol --iterations 100 | certify --iterations 10 -o chosen.tar
  assemble chosen.tar -v --stats stats.json -o mesh.tar 2>log
  tar xf mesh.tar
  "$PYTHON" - <<'PYTHON'
import glob, json
certified = json.load(open(glob.glob("history/*certify.json")[0]))
choice = {key: certified[key] for key in ("weight", "bound", "gap")}
assert json.load(open("stats.json"))["choice"] == choice
assert json.load(open(glob.glob("history/*assemble.json")[0]))["choice"] == choice
assert f"the choice weighs {choice['weight']}, at most {choice['bound']} is possible" in open("log").read()
PYTHON
  # It needs only the weights of the bundle's graph, and passes the rest on as it is.
  "$PYTHON" "$DATA/change_array.py" chosen.tar edgeless.tar graph/neighbours.npy "a[:0]"
  assemble edgeless.tar --stats edgeless.json -o passed.tar
  assert_equal "$("$PYTHON" -c 'import json; print(json.load(open("edgeless.json"))["choice"])')" \
    "$("$PYTHON" -c 'import json; print(json.load(open("stats.json"))["choice"])')"
  for member in offsets neighbours weights; do
    assert_same_bytes <(tar xOf edgeless.tar graph/$member.npy) <(tar xOf passed.tar graph/$member.npy)
  done
  buildgraph chosen.tar --weight count -o other.graph
  # Nor do stages behind the one that took the other graph; a bound of its own counts.
  initsol chosen.tar --graph other.graph --iterations 10 -o swapped.tar
  tar xOf swapped.tar history/05-initsol.json | tr -d ' \n' | grep -qF '"replaced":["graph"]'
  assemble swapped.tar --stats stats.json -o mesh.vtu
  assert_equal "$(grep -c '"choice"' stats.json)" 0
  assert_fails_with 1 "lns: --target-gap needs a bound" lns swapped.tar --target-gap 0.1 -o out.tar
  certify swapped.tar --iterations 10 --stats proven.json | assemble --stats stats.json -o mesh.vtu
  "$PYTHON" -c 'import json; a, b = (json.load(open(f)) for f in ("stats.json", "proven.json")); assert a["choice"]["bound"] == b["bound"]'
  assemble chosen.tar --graph other.graph --stats stats.json -o mesh.vtu
  assert_equal "$(grep -c '"choice"' stats.json)" 0
}

@test "what is no solution is refused" {
  seq 3000 >all.sol
  assert_fails_with 1 "certify: all.sol: .*neighbours" certify --graph ring.graph --solution all.sol -o out.sol
  assert_fails_with 1 "certify: .*solution.*initsol" certify ring.graph -o out.sol
  assert_fails_with 1 "certify: .*No such file" certify --graph ring.graph --solution good.sol --iterations 1 \
    --certificate no/such/place -o out.sol
  assert [ ! -e out.sol ]
}

@test "a solution that is not maximal is told" {
  head -1 good.sol >one.sol
  run_apart certify --graph ring.graph --solution one.sol --iterations 1 -v -o out.sol
  assert_success
  assert_equal "$(grep -c 'not maximal' <<<"$stderr")" 1
}

@test "--exact proves the optimum, which cbc finds too, and writes it" {
  "$PYTHON" "$DATA/ring_graph.py" 200 200 2 >small.graph
  printf "1\n" >one.sol
  certify --graph small.graph --solution one.sol --exact --stats stats.json -o best.sol
  assert_equal "$(number complete stats.json)" True
  assert_equal "$(number bound stats.json)" "$(number weight stats.json)"
  assert_equal "$(number gap stats.json)" 0.0
  "$CHECKERS/solve_with_cbc.py" small.graph cbc.sol
  run "$CHECKERS/solution_check.py" small.graph cbc.sol
  assert_output --regexp "weight $(number weight stats.json)$"
  run "$CHECKERS/solution_check.py" small.graph best.sol
  assert_output --regexp "weight $(number weight stats.json)$"
  certify --graph small.graph --solution one.sol --stats bound.json -o out.sol
  assert_equal "$(number complete bound.json)" False
}

# all_algorithms: the names that --help lists, which take more than a line.
all_algorithms() {
  certify --help | tr -d '\n ' | sed -n 's/.*--algorithm[A-Z]*:{\([a-z,-]*\)}.*/\1/p' | tr , ' '
}

# bats test_tags=optimized
@test "every --algorithm proves the optimum that cbc finds on fragments of a real graph" {
  command -v cbc >/dev/null || skip "needs coinor-cbc"
  findhex --mesh "$DATA/jittered_lattice.mesh" | buildgraph -o part.graph
  printf "1\n" >one.sol
  assert [ "$(all_algorithms | wc -w)" -ge 5 ]
  for seed in 1 2; do
    "$DATA/graph_fragment.py" part.graph 60 $seed >small.graph
    "$CHECKERS/solve_with_cbc.py" small.graph cbc.sol
    run "$CHECKERS/solution_check.py" small.graph cbc.sol
    weight=${output##* }
    for algorithm in $(all_algorithms); do
      # Without passes of the dual, which would prove it alone.
      certify --graph small.graph --solution one.sol --exact --algorithm "$algorithm" --iterations 0 --stats stats.json \
        -o best.sol
      assert_equal "$algorithm $(number complete stats.json)" "$algorithm True"
      assert_equal "$algorithm $(number weight stats.json)" "$algorithm $weight"
      assert [ "$(number nodes stats.json)" -gt 0 ]
    done
  done
}

@test "--algorithm is one of those there are, for graphs that it can hold, with --exact" {
  assert_fails_with 2 "certify: --algorithm requires --exact" certify --graph ring.graph --solution good.sol \
    --algorithm branch-and-reduce -o best.sol
  assert_fails_with 2 "certify: --algorithm: .*guess" certify --graph ring.graph --solution good.sol --exact \
    --algorithm guess -o best.sol
  "$PYTHON" "$DATA/ring_graph.py" 5000 2000 1 >large.graph
  assert_fails_with 1 "certify: expected a graph of at most 4096 vertices .*, found 5000" certify --graph large.graph \
    --solution good.sol --exact --iterations 0 --algorithm clique-cover -o best.sol
}

# heavy_graph HEAVIEST EDGES NAME: one vertex and disjoint edges of weights 3 and 5, with the best solution.
heavy_graph() {
  "$PYTHON" - "$@" <<'PYTHON'
import sys
heaviest, edges, name = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
with open(name + ".graph", "w") as graph, open(name + ".sol", "w") as solution:
    print(1 + 2 * edges, edges, 10, file=graph)
    print(heaviest, file=graph)
    print(1, file=solution)
    for v in range(2, 2 + 2 * edges, 2):
        print(f"3 {v + 1}\n5 {v}", file=graph)
        print(v + 1, file=solution)
PYTHON
}

# bats test_tags=optimized
@test "weights of very different sizes overflow no bound" {
  heavy_graph 1000000000000000 100000 first
  heavy_graph 100000000000000000 3000 second
  heavy_graph 4000000000000000000 300 third
  for name in first second third; do
    certify -q --graph $name.graph --solution $name.sol --iterations 30 --certificate proof --stats stats.json -o out.sol
    assert_equal "$(number bound stats.json)" "$(number weight stats.json)"
    assert_equal "$(number complete stats.json)" True
    run "$CHECKERS/bound_check.py" $name.graph proof
    assert_success
  done
}

@test "what goes wrong beside the solution does not cost it" {
  certify --graph ring.graph --solution good.sol --iterations 5 -o whole.tar
  for side in log certificate; do
    assert_fails_with 1 "certify: /dev/full: .*No space left" certify --graph ring.graph --solution good.sol \
      --iterations 5 -o $side.tar --$side /dev/full
    assert_same_bytes whole.tar $side.tar
    assert_fails_with 1 "certify: no/such/place: .*No such file" certify missing.tar --$side no/such/place
  done
  # Nor the proof.
  assert_fails_with 1 "certify: /dev/full: .*No space left" certify --graph ring.graph --solution good.sol \
    --iterations 5 -o out.tar --log /dev/full --certificate proof
  run "$CHECKERS/bound_check.py" ring.graph proof
  assert_success
}

@test "a graph that is too large for the algorithm is refused before the search" {
  "$PYTHON" "$DATA/ring_graph.py" 5000 2000 1 >large.graph
  assert_fails_with 1 "certify: expected a graph of at most 4096 vertices .*, found 5000" certify --graph large.graph \
    --solution good.sol --exact --algorithm clique-cover --log log.jsonl -o best.sol
  printf '2 1 10\n400000000000000000 2\n400000000000000000 1\n' >heavy.graph
  printf '1\n' >one.sol
  assert_fails_with 1 "certify: expected weights of a sum below 2\^58 for clique-lp" certify --graph heavy.graph \
    --solution one.sol --exact --algorithm clique-lp --log log.jsonl -o best.sol
  assert [ ! -s log.jsonl ]
}

@test "the tools of the usual pipe do not load CLP, which takes a quarter of the time in which they start" {
  local tool
  for tool in tetmesh findhex buildgraph initsol lns assemble; do
    [[ -e $HEXPIPE_BIN/$tool ]] || continue # built without TetGen
    if ldd "$HEXPIPE_BIN/$tool" | grep -E 'libClp|lapack'; then fail "$tool loads it"; fi
  done
}

@test "extreme graphs" {
  printf '0 0 10\n' >empty.graph
  : >empty.sol
  certify --graph empty.graph --solution empty.sol --stats stats.json -o out.sol
  assert_equal "$(number complete stats.json)" True
  printf '3 3 10\n5 2 3\n7 1 3\n6 1 2\n' >complete.graph
  printf '2\n' >complete.sol
  certify --graph complete.graph --solution complete.sol --stats stats.json -o out.sol
  assert_equal "$(number bound stats.json)" 7
  assert_equal "$(number complete stats.json)" True
}
