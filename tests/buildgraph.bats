# buildgraph: the conflicts are those of the definitions, and the weights those that are asked for. What all tools do alike
# is in behaviour.bats.

load helpers

setup_file() {
  load helpers
  cd "$BATS_FILE_TMPDIR"
  findhex -q --mesh "$DATA/random_points.mesh" --cells hex,prism,pyramid --min-quality 0.2 -o mixed.cand
  findhex -q --mesh "$DATA/random_points.mesh" --cells hex,prism,pyramid --min-quality 0.35 -o few.cand
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
  for weight in quality volume count 'quality*volume' 'quality^0.3*volume'; do
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

@test "--quad-reward puts the price of open quads into the graph, and all tools take it" {
  buildgraph "$INPUTS/hexes.tar" -o plain.tar
  buildgraph "$INPUTS/hexes.tar" --quad-reward 0 -o zero.tar
  buildgraph "$INPUTS/hexes.tar" --quad-reward 0.2 --stats graph.json -v -o quads.tar 2>said
  assert_equal "$(tar xOf plain.tar graph/weights.npy | sha256sum)" "$(tar xOf zero.tar graph/weights.npy | sha256sum)"
  assert_equal "$(tar tf zero.tar | grep -c quads)" 0
  holds 'graph["quads"] == 62' graph.json
  grep -q "of the vertices are quads that candidates can share" said
  initsol quads.tar --iterations 3000 -o start.tar
  lns start.tar --iterations 30 --stats lns.json -o choice.tar
  certify choice.tar --iterations 30 --stats certify.json --certificate proof.txt -o certified.tar
  for bundle in quads start choice certified; do
    "$CHECKERS/bundle_check.py" $bundle.tar
    run "$CHECKERS/quads_check.py" plain.tar $bundle.tar
    assert_success
  done
  assert_output --partial "value $($PYTHON -c 'import json; print(json.load(open("lns.json"))["value"])')"
  holds 'lns["value"] <= certify["value_bound"] and lns["value"] == certify["value"]' lns.json certify.json
  run "$CHECKERS/bound_check.py" quads.tar proof.txt
  assert_success
  # A file has no place for the quads, but the same vertices.
  buildgraph "$INPUTS/hexes.tar" --quad-reward 0.2 -o quads.graph 2>/dev/null
  initsol quads.graph --iterations 3000 -o start.sol
  assemble quads.tar --solution start.sol -o file.vtu
  assemble start.tar --stats mesh.json -o bundle.vtu
  assert_same_bytes file.vtu bundle.vtu
  assemble start.tar -o mesh.tar
  tar xOf mesh.tar --wildcards 'history/*-assemble.json' >history.json
  holds 'history["options"]["exchange"] == "none"' history.json
  holds '"exchange" not in mesh' mesh.json
  assemble certified.tar -v -o certified.vtu 2>said
  grep -q "the choice weighs $($PYTHON -c 'import json; print(json.load(open("certify.json"))["value"])')," said
  assemble start.tar --exchange quads --stats exchanged.json -o exchanged.vtu
  holds '"exchange" in exchanged' exchanged.json
}

@test "--quad-reward needs all candidates and conflicts" {
  assert_fails_with 2 "buildgraph: --quad-reward does not go with --part" buildgraph "$INPUTS/hexes.tar" --quad-reward 0.1 --part 1/2 -o out.tar
  assert_fails_with 2 "buildgraph: --quad-reward does not go with --part and --reduce" buildgraph "$INPUTS/hexes.tar" --quad-reward 0.1 --reduce -o out.tar
  assert_fails_with 2 "buildgraph: .*--quad-reward" buildgraph "$INPUTS/hexes.tar" --quad-reward -1 -o out.tar
  assert_fails_with 1 "candidates: expected (prices|weights) .*--weight-scale" buildgraph "$INPUTS/hexes.tar" --quad-reward 10 --weight-scale 1e16 -o out.tar
}

# bats test_tags=optimized
@test "fragments of lns and lns-mpi are candidates, whatever quads a graph has" {
  if ! command -v tetmesh; then skip "tetmesh makes the part"; fi
  tetmesh "$DATA/bracket.stl" --size 8 | findhex | buildgraph --quad-reward 0.2 --stats graph.json -o quads.tar
  initsol quads.tar --iterations 0 -o start.tar
  for tool in lns lns-mpi; do
    if ! command -v $tool >/dev/null; then continue; fi
    $tool start.tar --iterations 100 --fragments $tool.txt --stats found.json -o choice.tar
    holds 'found["improvements"] > 0' found.json
    assert [ -s $tool.txt ]
    holds 'max(map(int, open("'$tool.txt'").read().split())) <= graph["vertices"] - graph["quads"]' graph.json
  done
}

@test "a graph whose vertices are not its candidates and quads is refused" {
  buildgraph "$INPUTS/hexes.tar" --quad-reward 0.2 -o quads.tar
  $PYTHON - <<PYTHON
import io, tarfile
import numpy as np
with tarfile.open("quads.tar") as old, tarfile.open("cut.tar", "w", format=tarfile.PAX_FORMAT) as new:
    for member in old:
        data = old.extractfile(member).read()
        if member.name == "graph/quads.npy":
            out = io.BytesIO()
            np.save(out, np.load(io.BytesIO(data))[1:])
            data = out.getvalue()
            member.size = len(data)
        new.addfile(member, io.BytesIO(data))
PYTHON
  assert_fails_with 1 "certify: .*expected a vertex for each of the [0-9]+ candidates and [0-9]+ quads, found" shell 'initsol cut.tar --iterations 0 | certify --iterations 1 -o out.tar'
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

# bats test_tags=both
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

# number KEY FILE: of --stats.
number() {
  $PYTHON -c "import json; print(json.load(open('$2'))['$1'])"
}

# bats test_tags=optimized
@test "--cover adds an edge clique cover, which passes through the stages and certify prices" {
  for name in hexes mixed; do
    buildgraph "$INPUTS/$name.cand" --format tar >plain.tar
    buildgraph "$INPUTS/$name.cand" --cover -v --stats stats.json --format tar >cover.tar 2>notes
    run "$CHECKERS/cover_check.py" cover.tar
    assert_success
    assert_output "cover.tar: $(number cliques stats.json) cliques of $(number clique_members stats.json) vertices, $(number edges stats.json) edges"
    grep -q "^buildgraph: the edges are covered by $(number cliques stats.json) cliques of $(number clique_members stats.json) vertices together$" notes
    assert_same_bytes <(tar xOf plain.tar graph/neighbours.npy) <(tar xOf cover.tar graph/neighbours.npy)
    refute [ -n "$(tar tf plain.tar | grep clique)" ]
    # The checker can fail: a member that belongs elsewhere, an edge that is missing.
    for damage in "members[0] = members[1] - 1 if members[1] > 1 else members[2]" "members, offsets = members[offsets[1]:], offsets[1:] - offsets[1]"; do
      $PYTHON - "$damage" <<'PYTHON'
import io, sys, tarfile
import numpy as np
with tarfile.open("cover.tar") as old:
    files = {m.name: old.extractfile(m).read() for m in old}
load = lambda name: np.load(io.BytesIO(files[f"graph/clique_{name}.npy"]))
names = {"members": load("members"), "offsets": load("offsets")}
exec(sys.argv[1], names)
for name in ("members", "offsets"):
    buffer = io.BytesIO()
    np.save(buffer, names[name])
    files[f"graph/clique_{name}.npy"] = buffer.getvalue()
with tarfile.open("bad.tar", "w", format=tarfile.PAX_FORMAT) as new:
    for name, data in files.items():
        info = tarfile.TarInfo(name)
        info.size = len(data)
        new.addfile(info, io.BytesIO(data))
PYTHON
      run "$CHECKERS/cover_check.py" bad.tar
      assert_failure
      initsol bad.tar --iterations 0 -o bad.sol
      assert_fails_with 1 "^certify: bad.tar: graph: expected (cliques|every edge in a clique|ascending)" certify bad.tar --solution bad.sol -o out.sol
    done
  done
  initsol cover.tar --iterations 0 | certify --iterations 20 --certificate proof --stats certify.json -o certified.tar
  run "$CHECKERS/cover_check.py" certified.tar
  assert_success
  buildgraph "$INPUTS/mixed.cand" -o mixed.graph
  run "$CHECKERS/bound_check.py" mixed.graph proof
  assert_success
  assert [ "$(number cliques certify.json)" -ge "$(number cliques stats.json)" ]
}

# optimum BUNDLE: the weight that certify proves to be the best.
optimum() {
  initsol -q "$1" --iterations 2000 | lns -q --iterations 50 | certify -q --exact --stats exact.json -o best.tar
  assert_equal "$(number complete exact.json)" True
  number weight exact.json
}

# bats test_tags=optimized
@test "--reduce leaves out dominated candidates, of their list too, and the optimum is the same" {
  for name in hexes few; do
    buildgraph "$INPUTS/$name.cand" --format tar >whole.tar
    buildgraph "$INPUTS/$name.cand" --reduce -v --stats stats.json --format tar >reduced.tar 2>notes
    run "$CHECKERS/bundle_check.py" whole.tar reduced.tar
    assert_success
    local all left=$(number vertices stats.json) dropped=$(number dominated stats.json)
    all=$(($(wc -l <"$INPUTS/$name.cand") - 1))
    assert_equal "$((left + dropped))" "$all"
    assert [ "$dropped" -gt 0 ]
    grep -q "^buildgraph: $dropped of $all candidates are left out as dominated (" notes
    assert_equal "$(tar xOf reduced.tar --wildcards 'history/*-buildgraph.json' | grep -c "\"dominated\": $dropped")" 1
    assert_equal "$(optimum whole.tar)" "$(optimum reduced.tar)"
    # Through files, the candidates that are left are written beside the graph.
    buildgraph "$INPUTS/$name.cand" --reduce --reduced-candidates left.cand -o reduced.graph
    assert_equal "$(wc -l <left.cand)" "$((left + 1))"
    assert_equal "$(comm -13 <(sort "$INPUTS/$name.cand") <(tail -n +2 left.cand | sort) | wc -l)" 0
    run "$CHECKERS/graph_from_candidates.py" left.cand reduced.graph
    assert_success
    buildgraph reduced.tar --format graph >again.graph
    assert_same_bytes reduced.graph again.graph
    buildgraph left.cand --reduce -v --format tar 2>notes >again.tar
    grep -q "^buildgraph: 0 of $left candidates" notes
    buildgraph "$INPUTS/$name.cand" --reduce --cover --format tar >both.tar
    run "$CHECKERS/cover_check.py" both.tar
    assert_success
  done
}

@test "a reduced graph becomes a mesh" {
  findhex -q --mesh "$DATA/jittered_lattice.mesh" | buildgraph --reduce | initsol --iterations 100 | assemble -q -o out.vtu --stats stats.json
  assert [ -s out.vtu ]
  findhex -q --mesh "$DATA/jittered_lattice.mesh" -o all.cand
  buildgraph all.cand --reduce --reduced-candidates left.cand -o left.graph
  initsol left.graph --iterations 100 -o left.sol
  assemble -q --mesh "$DATA/jittered_lattice.mesh" --candidates left.cand --solution left.sol -o files.vtu
  assert_same_bytes out.vtu files.vtu
}

@test "--reduced-candidates that cannot be written cost no more than they must" {
  local cand="$INPUTS/hexes.cand"
  # Before anything is read.
  assert_fails_with 1 "buildgraph: no/such/place: .*No such file" buildgraph missing.cand --reduce --reduced-candidates no/such/place -o out.graph
  # A graph without its candidates would be of no use, a bundle has them.
  assert_fails_with 1 "buildgraph: /dev/full: .*No space left" buildgraph "$cand" --reduce --reduced-candidates /dev/full -o out.graph
  assert [ ! -e out.graph ]
  assert_fails_with 1 "buildgraph: /dev/full: .*No space left" buildgraph "$cand" --reduce --reduced-candidates /dev/full -o full.tar
  buildgraph "$cand" --reduce -o whole.tar
  assert_same_bytes whole.tar full.tar
}

@test "options that need each other say so" {
  local cand="$INPUTS/hexes.cand"
  assert_fails_with 2 "buildgraph: --reduce to a .graph needs --reduced-candidates" buildgraph "$cand" --reduce -o out.graph
  assert_fails_with 2 "buildgraph: --reduced-candidates does nothing without --reduce" buildgraph "$cand" --reduced-candidates left.cand -o out.graph
  assert_fails_with 2 "buildgraph: --cover needs a bundle" buildgraph "$cand" --cover -o out.graph
  for option in --reduce --cover; do
    assert_fails_with 2 "buildgraph: --part does not go with" buildgraph "$cand" $option --part 1/2 -o out.tar
  done
  assert [ ! -e out.graph ] && [ ! -e left.cand ]
}

@test "bundles of parts are merged into that of one run, byte for byte" {
  cp "$DATA/random_points.mesh" p.mesh
  findhex -q --mesh p.mesh -o whole.tar
  buildgraph -q whole.tar -o graph.tar
  for shares in 1 4; do
    rm -f p.candidates* p.conflicts*
    make -s -C "$HEXPIPE_SOURCE" -f Makefile.examples BIN="$HEXPIPE_BIN" MODELS="$PWD" SHARES=$shares -j2 "$PWD/p.conflicts.tar"
    assert_same_bytes whole.tar p.candidates.tar
    assert_same_bytes graph.tar p.conflicts.tar
  done
  local kinds="--cells hex,prism,pyramid --min-quality 0.1"
  findhex -q --mesh p.mesh $kinds -o kinds.tar
  for i in 1 2 3; do findhex -q --mesh p.mesh $kinds --part $i/3 -o kinds$i.tar; done
  merge-parts kinds1.tar kinds2.tar kinds3.tar -o merged.tar
  assert_same_bytes kinds.tar merged.tar
  assert_fails_with 1 "merge-parts: expected the parts 1/2 to 2/2 in order, found 1/3, 2/3" merge-parts kinds1.tar kinds2.tar -o out.tar
  assert_fails_with 1 "merge-parts: expected the parts 1/3" merge-parts kinds2.tar kinds1.tar kinds3.tar -o out.tar
  findhex -q --mesh p.mesh ${kinds/0.1/0.2} --part 3/3 -o other.tar
  assert_fails_with 1 "other.tar: history/.*: expected a run with the same version and options" merge-parts kinds1.tar kinds2.tar other.tar -o out.tar
  head -c 5000 kinds2.tar >cut.tar
  assert_fails_with 1 "cut.tar: .*(found: |cut off)" merge-parts kinds1.tar cut.tar kinds3.tar -o out.tar
  for i in 1 2; do buildgraph -q whole.tar --part $i/2 -o graph$i.tar; done
  for ends in '[]' 'a[:-1]'; do
    $PYTHON "$DATA/change_array.py" graph2.tar ends.tar graph/offsets.npy "np.array($ends, '<i8')"
    assert_fails_with 1 "ends.tar: graph/offsets.npy: expected [0-9]+ ends of lists, found [0-9]+$" merge-parts graph1.tar ends.tar -o out.tar
  done
  assert_fails_with 1 "p.mesh: expected a bundle of a part" merge-parts p.mesh -o out.tar
  initsol -q graph.tar --iterations 1 -o solved.tar
  assert_fails_with 1 "solved.tar: expected a bundle that findhex or buildgraph wrote last" merge-parts solved.tar -o out.tar
  assert [ ! -e out.tar ]
}
