# buildgraph: the conflicts are those of the definitions, and the weights those that are asked for. What all tools do alike
# is in behaviour.bats.

load helpers

setup_file() {
  load helpers
  cd "$BATS_FILE_TMPDIR"
  findhex -q --mesh "$DATA/random_points.mesh" --cells hex,prism,pyramid --min-quality 0.2 -o mixed.cand
  findhex -q --mesh "$DATA/jittered_lattice.mesh" -o hexes.cand
  findhex -q --mesh "$DATA/jittered_lattice.mesh" -o hexes.tar
  export INPUTS="$BATS_FILE_TMPDIR"
  COUNT=$(($(wc -l <hexes.cand) - 1))
  export COUNT
}

@test "the graph is that of all pairs" {
  for name in hexes mixed; do
    buildgraph "$INPUTS/$name.cand" -o $name.graph
    run "$CHECKERS/graph_from_candidates.py" "$INPUTS/$name.cand" $name.graph
    assert_success
    assert_output --partial " 0 wrong"
    "$CHECKERS/graph_check.py" $name.graph
  done
}

@test "candidates come from a bundle, a file as operand or by role, alike" {
  buildgraph "$INPUTS/hexes.tar" --format graph >bundle.graph
  buildgraph "$INPUTS/hexes.cand" --format graph >operand.graph
  buildgraph --candidates "$INPUTS/hexes.cand" --format graph >role.graph
  buildgraph --candidates <(cat "$INPUTS/hexes.cand") --format graph >substituted.graph
  buildgraph --format graph <"$INPUTS/hexes.cand" >piped.graph
  for other in operand role substituted piped; do assert_same_bytes bundle.graph $other.graph; done
}

@test "--weight and --weight-scale say what a candidate is worth" {
  local cand="$INPUTS/hexes.cand"
  buildgraph "$cand" -o plain.graph
  for weight in quality volume count 'quality*volume'; do
    for scale in 1000 1e6; do
      buildgraph "$cand" --weight "$weight" --weight-scale $scale -o w.graph
      run "$CHECKERS/graph_from_candidates.py" "$cand" w.graph --weight "$weight" --weight-scale $scale
      assert_success
      if [[ "$weight $scale" == "quality 1e6" ]]; then assert_same_bytes plain.graph w.graph
      else assert_different_bytes plain.graph w.graph; fi
    done
  done
}

@test "weights that vanish or pass what others can hold are warned of; those beyond 64 bits are errors" {
  local cand="$INPUTS/hexes.cand"
  run_apart buildgraph "$cand" --weight-scale 1e-3 -o small.graph
  assert_success
  assert_equal "$stderr" "buildgraph: warning: $COUNT of $COUNT weights are rounded to 0: a greater --weight-scale keeps them apart"
  run_apart buildgraph "$cand" --weight-scale 1e9 -o large.graph
  assert_success
  assert_equal "$(wc -l <<<"$stderr")" 1
  grep -q "^buildgraph: warning: .*--weight-scale" <<<"$stderr"
  # A bundle holds them.
  run_apart buildgraph "$cand" --weight-scale 1e9 -o large.tar
  assert_equal "$stderr" ""
  assert_fails_with 1 "^buildgraph: .*candidates: expected weights whose sum fits 64 bits" buildgraph "$cand" --weight-scale 1e18 -o out.graph
  assert [ ! -e out.graph ]
}

@test "bad options end with 2" {
  assert_fails_with 2 "buildgraph: .*--weight" buildgraph "$INPUTS/hexes.cand" --weight size -o out.graph
  assert_fails_with 2 "buildgraph: .*--weight-scale" buildgraph "$INPUTS/hexes.cand" --weight-scale 0 -o out.graph
  assert_fails_with 2 "buildgraph: .*--weight-scale" buildgraph "$INPUTS/hexes.cand" --weight-scale -1 -o out.graph
  assert_fails_with 2 "buildgraph: .*--weight-scale" buildgraph "$INPUTS/hexes.cand" --weight-scale nan -o out.graph
  assert_fails_with 2 "buildgraph: .*--weight-scale" buildgraph "$INPUTS/hexes.cand" --weight-scale inf -o out.graph
}

@test "malformed candidates are named by line" {
  local cand="$INPUTS/hexes.cand"
  sed '5s/^hex/cube/' "$cand" >kind.cand
  assert_fails_with 1 "^buildgraph: kind.cand:5: expected hex, prism or pyramid, found 'cube'" buildgraph kind.cand -o out.graph
  sed '7s/ [0-9]*$//' "$cand" >short.cand
  assert_fails_with 1 "^buildgraph: short.cand:7: expected a tet, found the end of the line" buildgraph short.cand -o out.graph
  sed '7s/$/ 1/' "$cand" >long.cand
  assert_fails_with 1 "^buildgraph: long.cand:7: expected the end of the line, found '1'" buildgraph long.cand -o out.graph
  sed "1s/ 1 $COUNT / 1 $((COUNT + 1)) /" "$cand" >count.cand
  assert_fails_with 1 "^buildgraph: count.cand:$((COUNT + 2)): expected $((COUNT + 1)) candidates, found $COUNT" buildgraph count.cand -o out.graph
  sed '$d' "$cand" >lines.cand
  assert_fails_with 1 "^buildgraph: lines.cand:$((COUNT + 1)): expected $COUNT candidates, found $((COUNT - 1))" buildgraph lines.cand -o out.graph
  head -c -3 "$cand" >cut.cand
  assert_fails_with 1 "^buildgraph: cut.cand:$((COUNT + 1)): " buildgraph cut.cand -o out.graph
  sed '3s/^hex [0-9.]*/hex nan/' "$cand" >nan.cand
  assert_fails_with 1 "^buildgraph: nan.cand:3: expected the quality, found 'nan'" buildgraph nan.cand -o out.graph
  sed '3s/^hex [0-9.]*/hex -0.5/' "$cand" >negative.cand
  assert_fails_with 1 "^buildgraph: .*candidates: expected no negative weight" buildgraph negative.cand -o out.graph
  assert [ ! -e out.graph ]
}

@test "numbers far beyond the rest need no memory" {
  printf 'hexpipe-candidates 1 2 3 0\n' >far.cand
  printf 'pyramid 0.5 1 2 0 1 2 3 4 2147483647 1 2147483647\npyramid 0.5 1 1 0 1 2 3 5 6 7\n' >>far.cand
  run bash -c "ulimit -v 4000000; buildgraph far.cand --format graph"
  if sanitized; then run buildgraph far.cand --format graph; fi
  assert_success
  assert_output "2 1 10
500000 2
500000 1"
}

@test "-v and --stats describe the graph" {
  run_apart buildgraph "$INPUTS/hexes.cand" -v --stats stats.json -o out.graph
  assert_success
  read -r vertices edges _ <out.graph
  grep -q "^buildgraph: $vertices vertices, $edges edges, greatest degree [0-9]*, density 0\.[0-9]*, total weight [0-9]*$" <<<"$stderr"
  run $PYTHON -c "
import json
stats = json.load(open('stats.json'))
rows = [[int(x) for x in line.split()] for line in open('out.graph')][1:]
assert stats['vertices'] == $vertices == len(rows), stats
assert stats['edges'] == $edges, stats
assert stats['max_degree'] == max(len(row) for row in rows) - 1, stats
assert stats['total_weight'] == sum(row[0] for row in rows), stats
assert abs(stats['density'] - 2 * $edges / ($vertices * ($vertices - 1))) < 1e-12, stats"
  assert_success
}
