# lns: a graph and a solution in, a solution that is not worse out.

load helpers

setup_file() {
  load helpers
  cd "$BATS_FILE_TMPDIR"
  "$PYTHON" "$DATA/ring_graph.py" 6000 3000 1 >ring.graph
  initsol ring.graph --iterations 0 --greedy weight -o start.sol
  # A path of five whose optimum is its odd vertices, and a solution to begin with.
  printf '5 4 10\n10 2\n11 1 3\n10 2 4\n11 3 5\n10 4\n' >path.graph
  printf '2\n4\n' >path.sol
}

setup() {
  cd "$BATS_TEST_TMPDIR" || return 1
  cp "$BATS_FILE_TMPDIR"/*.graph "$BATS_FILE_TMPDIR"/*.sol .
}

ring() {
  lns --graph ring.graph --solution start.sol "$@"
}

weight_of() {
  "$CHECKERS/solution_check.py" ring.graph "$1" | sed 's/.*weight //'
}

@test "the result is independent, maximal and heavier; --stats tells its weight" {
  ring --iterations 300 --no-reductions -o out.sol --stats stats.json
  run "$CHECKERS/solution_check.py" ring.graph out.sol
  assert_success
  assert [ "$(weight_of out.sol)" -gt "$(weight_of start.sol)" ]
  "$PYTHON" - "$output" <<'PYTHON'
import json, sys
stats = json.load(open("stats.json"))
assert sys.argv[1] == f"{stats['chosen']} chosen, weight {stats['weight']}", (sys.argv[1], stats)
assert stats["iterations"] <= 300 and stats["improvements"] > 0
PYTHON
}

@test "the optimum of small graphs is found and known to be one" {
  for seed in 1 2 3 4 5; do
    "$PYTHON" "$DATA/ring_graph.py" 24 30 $seed >tiny.graph
    initsol tiny.graph --iterations 0 -o tiny.sol
    lns --graph tiny.graph --solution tiny.sol -o best.sol --stats stats.json
    run "$CHECKERS/solution_check.py" --optimum tiny.graph best.sol
    assert_success
    assert_output --regexp "weight ([0-9]+), optimum \1$"
    grep -q '"complete": true' stats.json
  done
}

@test "zero iterations and zero seconds give the start" {
  ring --iterations 0 -o none.sol
  ring --time-limit 0 -o no_time.sol
  assert_same_bytes start.sol none.sol
  assert_same_bytes start.sol no_time.sol
}

@test "a start that is not maximal is taken" {
  printf '4\n' >path.sol
  lns --graph path.graph --solution path.sol --iterations 0 -o out.sol
  assert_equal "$(tr '\n' ' ' <out.sol)" "2 4 "
  lns --graph path.graph --solution path.sol -o out.sol
  assert_equal "$(tr '\n' ' ' <out.sol)" "1 3 5 "
}

@test "every option changes the search" {
  # Reductions leave little of this graph to search.
  whole() { ring --iterations 40 --no-reductions "$@"; }
  whole -o base.sol
  ring --iterations 40 -o kernel.sol
  whole --seed 2 -o seed.sol
  whole --fragment-size 50 -o size.sol
  whole --fragment-size 50 --largest-fragment 20 -o largest.sol
  whole --batch 3 -o batch.sol
  whole --fragment-size 600 -o large.sol
  whole --fragment-size 600 --node-limit 1 -o nodes.sol
  whole --annealed-fragment 0 -o exact.sol
  whole --annealed-fragment 300 -o annealed.sol
  assert_different_bytes exact.sol annealed.sol
  for other in kernel seed size batch large exact annealed; do assert_different_bytes base.sol $other.sol; done
  assert_different_bytes size.sol largest.sol
  assert_different_bytes large.sol nodes.sol
}

@test "recombining finds more, where it takes its turn when the others have worked as long" {
  long() {
    ring --no-reductions --fragment-size 30 --largest-fragment 30 --node-limit 3 --annealed-fragment 0 --iterations 8000 \
      --seed 2 "$@"
  }
  long --recombined-fragment 0 -o alone.sol
  long --recombined-fragment 50 -o recombined.sol
  assert [ "$(weight_of recombined.sol)" -gt "$(weight_of alone.sol)" ]
}

@test "the history says of --no-reductions what was given" {
  initsol ring.graph --iterations 0 -o start.tar
  lns start.tar --iterations 1 --no-reductions -o given.tar
  run tar xOf given.tar history/02-lns.json
  assert_output --partial '"no-reductions": "true"'
  lns start.tar --iterations 1 -o not.tar
  run tar xOf not.tar history/02-lns.json
  refute_output --partial '"no-reductions": "true"'
  lns start.tar --iterations 1 --no-reductions=false -o undone.tar
  run tar xOf undone.tar history/02-lns.json
  refute_output --partial '"no-reductions": "true"'
}

@test "--target-gap ends the search at a bound that is given or that certify proved" {
  initsol ring.graph --iterations 0 --greedy weight | certify -o proven.tar --stats bound.json
  lns proven.tar --no-reductions --target-gap 0.08 --time-limit 100 --stats stats.json -o bundle.sol
  lns proven.tar --graph ring.graph --no-reductions --target-gap 0.08 --time-limit 100 -o given.sol \
    --bound "$("$PYTHON" -c 'import json; print(json.load(open("bound.json"))["bound"])')"
  assert_same_bytes bundle.sol given.sol
  "$PYTHON" - "$(weight_of start.sol)" "$(weight_of bundle.sol)" <<'PYTHON'
import json, sys
bound, (start, weight) = json.load(open("bound.json"))["bound"], map(int, sys.argv[1:])
assert start < 0.92 * bound <= weight, (start, bound, weight)
stats = json.load(open("stats.json"))
assert stats["seconds"] < 50 and not stats["complete"]
PYTHON
  assert_fails_with 1 "lns: --target-gap needs a bound: .*certify" ring --target-gap 0.1 -o out.sol
  assert_fails_with 2 "lns: .*--target-gap" ring --target-gap 1.5 -o out.sol
  assert_fails_with 2 "lns: .*--bound" ring --bound -1 -o out.sol
  assert_fails_with 2 "lns: --bound does nothing without --target-gap" ring --bound 5 -o out.sol
}

# A hundred stars with a centre of weight 5 and three rays of 2; one of them has its centre chosen.
@test "lns begins where certify found that solution and bound differ" {
  "$PYTHON" - <<'PYTHON'
stars = 100
with open("stars.graph", "w") as file:
    print(4 * stars, 3 * stars, 10, file=file)
    for star in range(stars):
        centre = 4 * star + 1
        print(5, centre + 1, centre + 2, centre + 3, file=file)
        file.write(3 * f"2 {centre}\n")
with open("stars.sol", "w") as file:
    for star in range(stars):
        for v in ([1] if star == 63 else [2, 3, 4]):
            print(4 * star + v, file=file)
PYTHON
  certify --graph stars.graph --solution stars.sol -o certified.tar
  local options=(--no-reductions --batch 1 --iterations 1 --annealed-fragment 0 --recombined-fragment 0 --fragment-size 4)
  for seed in 1 2 3; do
    lns certified.tar "${options[@]}" --seed $seed -o best.sol
    assert_equal "$("$CHECKERS/solution_check.py" stars.graph best.sol)" "300 chosen, weight 600"
  done
  lns --graph stars.graph --solution stars.sol "${options[@]}" -o elsewhere.sol
  assert_equal "$("$CHECKERS/solution_check.py" stars.graph elsewhere.sol)" "298 chosen, weight 599"
}

@test "gaps that do not belong to the solution are named" {
  certify --graph ring.graph --solution start.sol --iterations 5 -o certified.tar
  "$PYTHON" - <<'PYTHON'
import io, tarfile
import numpy
source = tarfile.open("certified.tar")
with tarfile.open("short.tar", "w", format=tarfile.USTAR_FORMAT) as target:
    for member in source:
        data = source.extractfile(member).read()
        if member.name == "solution/gaps.npy":
            short = io.BytesIO()
            numpy.save(short, numpy.load(io.BytesIO(data))[:-1])
            data = short.getvalue()
            member.size = len(data)
        target.addfile(member, io.BytesIO(data))
PYTHON
  assert_fails_with 1 "lns: short.tar: .*expected a gap for each of the .* chosen, found" lns short.tar -o out.sol
}

@test "--free-running improves too, and says that its result depends on the timing" {
  ring --free-running --no-reductions --iterations 300 --threads 2 -o free.sol
  assert [ "$(weight_of free.sol)" -gt "$(weight_of start.sol)" ]
  ring --free-running --iterations 20 | tar xO --wildcards 'history/*-lns.json' >history.json
  grep -q '"depends_on_timing": *true' history.json
  ring --iterations 20 | tar xO --wildcards 'history/*-lns.json' >history.json
  refute grep -q depends_on_timing history.json
  run lns --help
  assert_output --regexp "--free-running +Threads do not wait"
}

@test "bad values of options end with 2" {
  assert_fails_with 2 "lns: .*--fragment-size" ring --fragment-size 0
  assert_fails_with 2 "lns: .*--largest-fragment" ring --largest-fragment 100000
  assert_fails_with 2 "lns: .*--node-limit" ring --node-limit 0
  assert_fails_with 2 "lns: .*--annealed-fragment" ring --annealed-fragment -1
  assert_fails_with 2 "lns: .*--batch" ring --batch -1
  assert_fails_with 2 "lns: .*--seed" ring --seed x
}

@test "the same bytes for 1 and 2 threads" {
  ring --iterations 200 --no-reductions --threads 1 -o one.sol
  ring --iterations 200 --no-reductions --threads 2 -o two.sol
  assert_same_bytes one.sol two.sol
}

@test "graph and solution from pipes" {
  ring --iterations 20 -o file.sol
  lns --graph <(cat ring.graph) --solution <(cat start.sol) --iterations 20 -o pipe.sol
  lns --graph - --solution start.sol --iterations 20 -o stdin.sol <ring.graph
  lns --graph ring.graph --solution - --iterations 20 --format sol <start.sol >stdout.sol
  for other in pipe stdin stdout; do assert_same_bytes file.sol $other.sol; done
}

@test "a line for each vertex is read too" {
  "$PYTHON" - <<'PYTHON'
chosen = {int(line) for line in open("start.sol")}
with open("flags.sol", "w") as file:
    for v in range(1, 6001):
        print(int(v in chosen), file=file)
PYTHON
  ring --iterations 20 -o numbers.sol
  lns --graph ring.graph --solution flags.sol --iterations 20 -o flags_out.sol
  assert_same_bytes numbers.sol flags_out.sol
}

@test "--time-limit is kept, and --log ends with the weight of the solution" {
  ring --time-limit 0.5 --no-reductions --node-limit 1000000000 -o out.sol --log log.jsonl --stats stats.json
  "$PYTHON" - "$(weight_of out.sol)" <<'PYTHON'
import json, sys
points = [json.loads(line) for line in open("log.jsonl")]
assert points[-1]["weight"] == int(sys.argv[1])
for key in ("seconds", "iteration", "weight"):
    values = [point[key] for point in points]
    assert values == sorted(values), key
complete = json.load(open("stats.json"))["complete"]
# By the clock: on a machine that has other work it may end late.
assert complete or 0.5 <= points[-1]["seconds"] < 20
PYTHON
}

# bats test_tags=optimized
@test "--fragments writes what was improved, a line each" {
  ring --iterations 300 --no-reductions -o out.sol --fragments parts --stats stats.json
  "$PYTHON" - <<'PYTHON'
import json
parts = [[int(word) for word in line.split()] for line in open("parts")]
assert len(parts) == json.load(open("stats.json"))["improvements"] > 0
assert all(part and len(set(part)) == len(part) and 1 <= min(part) and max(part) <= 6000 for part in parts)
start, end = ({int(line) for line in open(name)} for name in ("start.sol", "out.sol"))
assert start != end and start ^ end <= set().union(*parts), "what changed lies in no fragment"
PYTHON
  # Of a graph that reductions make smaller, the numbers are those of the whole.
  "$PYTHON" "$DATA/random_graph.py" 1500 >dense.graph
  initsol dense.graph --iterations 0 --greedy weight -o dense.sol
  lns --graph dense.graph --solution dense.sol --iterations 300 -o reduced.sol --fragments reduced_parts
  "$PYTHON" - <<'PYTHON'
numbers = [int(word) for line in open("reduced_parts") for word in line.split()]
assert numbers and 1 <= min(numbers) and max(numbers) <= 1500
PYTHON
}

@test "a signal writes the best so far and ends with 0" {
  # Dense and without structure, so that the search does not end by itself.
  "$PYTHON" "$DATA/random_graph.py" 1500 >hard.graph
  initsol hard.graph --iterations 0 -o hard.sol
  for signal in INT TERM; do
    lns --graph hard.graph --solution hard.sol --time-limit 60 -o out.sol --log log.jsonl 3>&- &
    local pid=$!
    await test -s log.jsonl
    kill -s $signal $pid
    wait $pid
    run "$CHECKERS/solution_check.py" hard.graph out.sol
    assert_success
    rm out.sol log.jsonl
  done
}

@test "--worth ends the search when it gains too little; without limits it is on" {
  "$PYTHON" "$DATA/random_graph.py" 300 >hard.graph
  initsol hard.graph --iterations 0 -o hard.sol
  hard() { lns --graph hard.graph --solution hard.sol --no-reductions --stats "$1.json" -o "$1.sol" "${@:2}"; }
  hard usual --threads 1
  hard again --threads 2
  assert_same_bytes usual.sol again.sol
  hard named --time-limit 100 --worth 5e-5
  assert_same_bytes usual.sol named.sol
  hard hasty --worth 1
  "$PYTHON" - <<'PYTHON'
import json
usual, hasty = (json.load(open(f"{name}.json")) for name in ("usual", "hasty"))
assert 0 < hasty["iterations"] < usual["iterations"] and hasty["weight"] <= usual["weight"], (hasty, usual)
PYTHON
  assert_fails_with 2 "lns: .*--worth" hard out --worth 2
}

# bats test_tags=optimized
@test "--worth judges a large graph by a sample of its places" {
  "$PYTHON" "$DATA/ring_graph.py" 60000 40000 1 >large.graph
  initsol large.graph --no-reductions --iterations 60000 -o large.sol
  large() { lns --graph large.graph --solution large.sol --no-reductions --stats "$1.json" -o "$1.sol" "${@:2}"; }
  large usual
  large whole --worth 0
  "$PYTHON" - <<'PYTHON'
import json
usual, whole = (json.load(open(f"{name}.json")) for name in ("usual", "whole"))
assert whole["complete"] and not usual["complete"], (usual, whole)
assert usual["iterations"] < 0.9 * whole["iterations"], (usual, whole)
assert usual["improvements"] > 0 and usual["weight"] >= (1 - 5e-5) * whole["weight"], (usual, whole)
PYTHON
}

# bats test_tags=optimized
@test "--worth judges a search once exact fragments have gone over the whole graph" {
  # A lattice of 12 x 12 x 12 hexes, where greedy finds the best choice. Half of each fragment counts as seen, at least 6
  # of the hexes.
  tetmesh "$DATA/cube.stl" --size 0.083 | findhex | buildgraph | initsol --iterations 0 -o lattice.tar
  lns lattice.tar --no-reductions --stats stats.json -o out.sol
  holds "stats['chosen'] == 12 ** 3 and 0 < stats['iterations'] < 12 ** 3 / 6" stats.json
}

@test "what initsol has proven to be the best is not searched again" {
  initsol ring.graph --stats proof.json -o best.tar
  holds "proof['complete']" proof.json
  lns best.tar --no-reductions --stats stats.json -o kept.sol
  holds "stats['complete'] and stats['iterations'] == 0 and stats['weight'] == proof['weight']" stats.json proof.json
  # Nothing is known of a graph from a file, nor of one that a stage unknown here may have changed.
  lns best.tar --graph ring.graph --no-reductions --iterations 20 --stats file.json -o file.sol
  initsol ring.graph --iterations 0 -o start.tar
  mkdir mine && tar xf best.tar -C mine && sed -i 's/"tool": "initsol"/"tool": "mine"/' mine/history/01-initsol.json
  tar cf mine.tar -C mine $(tar tf best.tar)
  lns mine.tar --no-reductions --iterations 20 --stats unknown.json -o unknown.sol
  holds "file['iterations'] > 0 and unknown['iterations'] > 0" file.json unknown.json
  # Another solution is improved until it weighs as much.
  lns best.tar --solution start.sol --stats other.json -o other.sol
  holds "other['complete'] and other['weight'] == proof['weight']" other.json proof.json
}

@test "what reductions solve ends at once" {
  ring --time-limit 100 -o solved.sol --stats stats.json --log log.jsonl
  "$PYTHON" - "$(weight_of solved.sol)" <<'PYTHON'
import json, sys
stats = json.load(open("stats.json"))
assert stats["complete"] and stats["seconds"] < 50 and stats["iterations"] == 0, stats
assert json.loads(open("log.jsonl").readlines()[-1])["weight"] == stats["weight"] == int(sys.argv[1])
PYTHON
  initsol ring.graph -o optimal.sol
  assert_equal "$(weight_of optimal.sol)" "$(weight_of solved.sol)"
}

@test "a missing solution is an error that names initsol" {
  assert_fails_with 1 "lns: .*solution.*initsol" lns ring.graph -o out.sol
  assert_fails_with 1 "lns: missing.sol: .*No such file" lns --graph ring.graph --solution missing.sol -o out.sol
}

@test "solutions that are none are named" {
  # refuse TEXT MESSAGE
  refuse() {
    printf "$1" >bad.sol
    assert_fails_with 1 "^lns: bad.sol$2" lns --graph path.graph --solution bad.sol --iterations 1 -o out.sol
  }
  refuse '' ': expected a solution, found no numbers'
  refuse '1\n2\n' ': .*neighbours'
  refuse '1\n0\n1\n1\n0\n' ': .*neighbours'
  refuse '1\n6\n' ':2: expected a vertex from 1 to 5'
  refuse '3\n0\n' ':2: expected a vertex from 1 to 5'
  refuse '1\n1\n' ':2: expected each vertex once'
  refuse '1\nx\n' ":2: expected one number, found 'x'"
  refuse '1 3\n' ":1: expected one number, found '1 3'"
  refuse '1\n\n3\n' ':2: expected a number, found an empty line'
  assert_fails_with 1 "^lns: start.sol:[0-9]+: expected a vertex" \
    lns --graph path.graph --solution start.sol --iterations 1 -o out.sol
  assert [ ! -e out.sol ]
}

@test "every truncated prefix of a solution is refused or a solution itself" {
  printf '0\n1\n0\n1\n0\n' >flags.sol
  local size prefix
  size=$(stat -c %s flags.sol)
  for ((prefix = 0; prefix < size - 1; ++prefix)); do
    head -c $prefix flags.sol >cut.sol
    assert_fails_with 1 "^lns: cut.sol" lns --graph path.graph --solution cut.sol --iterations 1 -o out.sol
  done
}

@test "extreme graphs" {
  printf '0 0 10\n' >empty.graph
  : >empty.sol
  lns --graph empty.graph --solution empty.sol -o out.sol
  assert [ -e out.sol ]
  assert [ ! -s out.sol ]
  printf '1 0 10\n0\n' >one.graph
  printf '1\n' >one.sol
  lns --graph one.graph --solution one.sol -o out.sol
  assert_equal "$(cat out.sol)" 1
  printf '3 3 10\n5 2 3\n7 1 3\n6 1 2\n' >complete.graph
  lns --graph complete.graph --solution one.sol -o out.sol --fragment-size 1
  assert_equal "$(cat out.sol)" 2
}

@test "a full disk is noticed" {
  assert_fails_with 1 "lns: .*No space left" \
    shell "lns --graph path.graph --solution path.sol --iterations 1 --format sol >/dev/full"
}

@test "what goes wrong beside the solution does not cost it" {
  ring --iterations 30 --no-reductions -o whole.sol
  for side in log fragments; do
    assert_fails_with 1 "lns: /dev/full: .*No space left" ring --iterations 30 --no-reductions -o $side.sol --$side /dev/full
    assert_same_bytes whole.sol $side.sol
    assert_fails_with 1 "lns: no/such/place: .*No such file" ring -o none.sol --$side no/such/place
    assert_fails_with 1 "lns: no/such/place: .*No such file" lns missing.tar --$side no/such/place
    assert [ ! -e none.sol ]
  done
}

@test "a disk that fills up under --fragments during the search does not cost the solution" {
  # Each of 900 stars is improved, which makes lines of 200 numbers, more than a buffer holds.
  "$PYTHON" - <<'PYTHON'
stars, rays = 900, 200
with open("stars.graph", "w") as graph, open("stars.sol", "w") as solution:
    print(stars * (rays + 1), stars * rays, 10, file=graph)
    for centre in range(1, stars * (rays + 1), rays + 1):
        print(5, *range(centre + 1, centre + 1 + rays), file=graph)
        graph.write(rays * f"2 {centre}\n")
        print(centre, file=solution)
PYTHON
  assert_fails_with 1 "lns: /dev/full: .*No space left" lns --graph stars.graph --solution stars.sol --no-reductions \
    --annealed-fragment 0 --recombined-fragment 0 --fragment-size 201 --target-gap 0 --bound 360000 \
    --fragments /dev/full -o out.sol
  assert_equal "$("$CHECKERS/solution_check.py" stars.graph out.sol)" "180000 chosen, weight 360000"
}

@test "where the fragments are written leaves the bundle as it is" {
  ring --iterations 30 --fragments here -o here.tar
  ring --iterations 30 --fragments there -o there.tar
  ring --iterations 30 -o nowhere.tar
  assert_same_bytes here there
  assert_same_bytes here.tar there.tar
  assert_same_bytes here.tar nowhere.tar
}

@test "vertices without conflicts do not keep the search going" {
  { echo 60 0 10; yes 1 | head -60; } >isolated.graph
  printf '1\n' >one.sol
  lns --graph isolated.graph --solution one.sol --no-reductions --time-limit 100 -o out.sol --stats stats.json
  grep -q '"complete": true' stats.json
  assert_equal "$(wc -l <out.sol)" 60
}

# bats test_tags=optimized
@test "--slim leaves the conflicts out, which assemble does not miss and certify does" {
  tetmesh "$DATA/cube.stl" --size 0.3 | findhex | buildgraph --cover | initsol --iterations 100 -o start.tar
  lns start.tar --iterations 20 -o full.tar
  lns start.tar --iterations 20 --slim -o slim.tar
  assert_equal "$(tar tf slim.tar)" "$(tar tf full.tar | grep -Ev '^graph/(offsets|neighbours|clique_offsets|clique_members)[.]npy$')"
  assert_equal "$(tar xOf slim.tar graph/weights.npy | md5sum)" "$(tar xOf full.tar graph/weights.npy | md5sum)"
  for bundle in full slim; do
    assemble $bundle.tar -o $bundle.vtu
    viewmesh $bundle.tar -o $bundle.html
  done
  assert_same_bytes full.vtu slim.vtu
  local missed="expected conflicts for certify, found weights alone: the tool that wrote this left them out \\(--slim\\)"
  assert_fails_with 1 "slim.tar: graph: $missed" certify slim.tar
  # From a file beside the bundle, too.
  buildgraph full.tar -o own.graph
  lns start.tar --graph own.graph --iterations 20 --slim -o own.tar
  assert_equal "$(tar tf own.tar | grep -c neighbours)" 0
  assemble own.tar -o own.vtu
  assert_same_bytes full.vtu own.vtu
  assert_fails_with 2 "--slim leaves members out of a bundle, and 'sol' is none" lns start.tar --iterations 20 --slim -o out.sol
}
