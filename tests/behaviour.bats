# What all tools of the pipeline have in common: help, exit codes, messages, streams, files, limits.

load helpers

# Each stage's input as a bundle: $STAGES/<tool>.in
setup_file() {
  load helpers
  export STAGES="$BATS_FILE_TMPDIR"
  cd "$STAGES"
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 >lattice.mesh
  cp "$DATA/cube.stl" tetmesh.in
  findhex --mesh lattice.mesh --min-quality 0.4 -o buildgraph.in --format tar
  $PYTHON - <<'PYTHON'
import tarfile
with tarfile.open("buildgraph.in") as whole, tarfile.open("findhex.in", "w", format=tarfile.PAX_FORMAT) as start:
    for member in whole:
        if member.name.startswith("mesh/"):
            start.addfile(member, whole.extractfile(member))
PYTHON
  buildgraph buildgraph.in -o initsol.in --format tar
  initsol --iterations 0 initsol.in -o lns.in --format tar
  lns --iterations 10 lns.in -o assemble.in --format tar
  cp assemble.in certify.in
  cp lns.in lns-mpi.in
}

READERS="findhex buildgraph initsol lns certify assemble"
TOOLS="$READERS"
if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then TOOLS="tetmesh $TOOLS"; fi
if [[ -x "$HEXPIPE_BIN/lns-mpi" ]]; then
  TOOLS+=" lns-mpi"
  READERS+=" lns-mpi"
  # The MPI library's own leaks are known by its name, to which stacks have to reach: its plugins are unloaded by the end.
  # Such stacks make the other tools twice as slow.
  export LSAN_OPTIONS="suppressions=$HEXPIPE_SOURCE/tests/leaks_of_mpi.txt:print_suppressions=0"
  if sanitized; then
    lns-mpi() { ASAN_OPTIONS="${ASAN_OPTIONS:-}:fast_unwind_on_malloc=0" command lns-mpi "$@"; }
    export -f lns-mpi
  fi
fi

# limited TOOL: the options that make its result independent of the clock.
limited() {
  case $1 in
    initsol | lns | lns-mpi | certify) echo "--iterations 20" ;;
    tetmesh) echo "--size 0.5" ;;
  esac
}

# product_ending TOOL: of the file format of what it makes.
product_ending() {
  case $1 in
    tetmesh) echo mesh ;;
    findhex) echo cand ;;
    buildgraph) echo graph ;;
    initsol | lns | lns-mpi | certify) echo sol ;;
    assemble) echo vtk ;;
  esac
}

# bats test_tags=optimized
@test "--help explains itself, with an example that names the tool, on standard output" {
  for tool in $TOOLS; do
    run_apart $tool --help
    assert_success
    assert_equal "$stderr" ""
    assert_output --partial "Example:"
    assert_output --regexp "Example:.*$tool "
    assert_output --partial "--output"
    assert [ "$(wc -L <<<"$output")" -le 100 ]
    refute_output --regexp "\{false\}|an? candidates|=\["
  done
}

# bats test_tags=optimized
@test "--help begins with the few options that matter first, then goes by subject, and ends with what all tools have" {
  local first groups
  for tool in $TOOLS; do
    groups=$($tool --help | sed -nE 's/^([A-Z][A-Za-z, ]+):$/\1/p' | tr '\n' ';')
    [[ $groups == "Positionals;Options;"*"This run;"* ]] || fail "$tool: $groups"
    first=$($tool --help | sed -n '/^Options:/,/^$/p' | grep -oE '^  (-.,)?--[a-z-]+')
    assert [ "$(wc -l <<<"$first")" -le 4 ]
    grep -q -- --output <<<"$first"
    [[ $groups != *"For experts"* || $groups == *"This run;For experts;"* ]] || fail "$tool: $groups"
  done
}

@test "--version names tool, version and licence" {
  for tool in $TOOLS; do
    local licence=MIT
    if [[ $tool == tetmesh ]]; then licence="AGPL-3.0, because it links TetGen"; fi
    run_apart $tool --version
    assert_success
    assert_line --index 0 --regexp "^$tool \(hexpipe\) [0-9]+\.[0-9]+\.[0-9]+$"
    assert_line --index 1 "Licence: $licence"
    assert_equal "${#lines[@]}" 2
  done
}

# bats test_tags=optimized
@test "a bad command line ends with 2 and one line" {
  for tool in $TOOLS; do
    assert_fails_with 2 "$tool: .*--no-such-option" $tool --no-such-option
    assert_fails_with 2 "$tool: .*threads" $tool --threads many
    assert_fails_with 2 "$tool: .*threads" $tool --threads -1
    assert_fails_with 2 "$tool: .*extra" $tool "$STAGES/$tool.in" extra another
    assert_fails_with 2 "$tool: .*x.png" $tool "$STAGES/$tool.in" -o x.png
    assert_fails_with 2 "$tool: .*'png'" $tool "$STAGES/$tool.in" --format png
  done
}

# bats test_tags=optimized
@test "a misspelled option is answered with the one that was meant" {
  for tool in $TOOLS; do
    assert_fails_with 2 "^$tool: The following arguments were not expected: --thread 2 \(did you mean --threads\? see $tool --help\)$" \
      $tool "$STAGES/$tool.in" --thread 2
  done
  printf 'threads=1\nthread=2\n' >near.ini
  assert_fails_with 2 "^findhex: near.ini:2: expected the name of an option, found 'thread' \(did you mean --threads\?" \
    findhex "$STAGES/findhex.in" --config near.ini -o out.tar
}

@test "two outputs in one file are refused before either is written" {
  for tool in $TOOLS; do
    assert_fails_with 2 "^$tool: expected different files for --output and --stats, found ./out.tar for both$" \
      $tool $(limited $tool) "$STAGES/$tool.in" -o out.tar --stats ./out.tar
    assert_fails_with 2 "expected different files for --output and --stats, found standard output for both$" \
      $tool $(limited $tool) "$STAGES/$tool.in" --stats -
    assert [ ! -e out.tar ]
  done
  assert_fails_with 2 "for --log and --fragments, found x for both" lns "$STAGES/lns.in" -o out.tar --log x --fragments x
  ln -s x link
  touch x
  assert_fails_with 2 "for --log and --fragments, found link for both" lns "$STAGES/lns.in" -o out.tar --log x --fragments link
  # Several outputs may go to /dev/null.
  lns -q --iterations 5 "$STAGES/lns.in" -o /dev/null --log /dev/null --stats /dev/null
}

# bats test_tags=optimized
@test "statistics and a log go to standard output by '-', where the product does not" {
  for tool in $TOOLS; do
    $tool -q $(limited $tool) "$STAGES/$tool.in" -o out.tar --stats - >stats.json
    assert_equal "$($PYTHON -c 'import json; print(json.load(open("stats.json"))["tool"])')" "$tool"
  done
  lns -q --iterations 5 "$STAGES/lns.in" -o out.tar --log - >log
  assert grep -q '^{"seconds":' log
  assert_fails_with 2 "for --stats and --log, found standard output for both" lns "$STAGES/lns.in" -o out.tar --stats - --log -
  assert_fails_with 2 "for --output and --stats, found standard output for both" merge-parts "$STAGES/lns.in" --stats -
  assert [ ! -e - ]
}

@test "what is written beside the product does not replace what is read" {
  for tool in $TOOLS; do
    cp "$STAGES/$tool.in" part.in
    assert_fails_with 2 "^$tool: expected different files for [a-z]* and --stats, found ./part.in for both: it would be lost$" \
      $tool $(limited $tool) part.in -o out.tar --stats ./part.in
    assert_same_bytes part.in "$STAGES/$tool.in"
  done
  cp "$STAGES/lns.in" part.in
  assert_fails_with 2 "for --graph and --log, found part.in for both" lns --graph part.in --solution other -o out.tar --log part.in
  # A product has its name when everything is read.
  cp "$STAGES/lns.in" part.tar
  lns -q --iterations 5 part.tar -o part.tar --stats stats.json
}

# bats test_tags=optimized
@test "a seed that is negative or too large for 64 bits, and a time limit of NaN, end with 2" {
  for tool in initsol lns $(grep -oE "tetmesh|lns-mpi" <<<"$TOOLS"); do
    for seed in -1 18446744073709551616 1.5 ""; do
      assert_fails_with 2 "^$tool: --seed: expected a whole number" $tool "$STAGES/$tool.in" --seed "$seed"
    done
    run_apart $tool $(limited $tool) -q "$STAGES/$tool.in" --seed 18446744073709551615 -o out.tar
    assert_success
  done
  for tool in initsol lns certify; do
    assert_fails_with 2 "^$tool: --time-limit: expected a number" timeout 120 $tool "$STAGES/$tool.in" --time-limit nan
  done
}

@test "two inputs from standard input are refused" {
  assert_fails_with 2 "at most one" lns --graph - --solution -
}

# bats test_tags=optimized
@test "an unknown key in a --config file ends with 2; a known one counts" {
  echo "no-such-key=1" >bad.ini
  echo "threads=0" >good.ini
  for tool in $TOOLS; do
    assert_fails_with 2 "$tool: " $tool --config bad.ini "$STAGES/$tool.in"
    run_apart $tool --config good.ini $(limited $tool) "$STAGES/$tool.in" -o "out.$(product_ending $tool)"
    assert_success
    rm out.*
  done
}

# bats test_tags=optimized
@test "a bundle is not written to a terminal" {
  for tool in $TOOLS; do
    run script -qec "$tool '$STAGES/$tool.in' 2>message" /dev/null </dev/null
    assert_equal "$status" 2
    assert_equal "$(wc -l <message)" 1
    grep -q "terminal" message
  done
}

# on_terminal COMMAND: runs it on a terminal of its own; the lines that were shown there, over each other or not.
on_terminal() {
  TERM=xterm script -qec "$1" /dev/null </dev/null | tr '\r' '\n' | sed 's/\x1b\[K//g'
}

# Under the sanitizers the line takes long to come.
# bats test_tags=optimized
@test "progress is a line on a terminal; -q shows none, lines of -v stay whole, files get none" {
  [[ -x "$HEXPIPE_BIN/tetmesh" ]] || skip "tetmesh is not built"
  # Rounds in place of seconds: on a busy machine the first round may take longer than any number of them.
  local search="tetmesh '$DATA/bracket.stl' --size 8 --improve 12 -o out.mesh"
  on_terminal "$search -v" >shown
  grep -Eq '^tetmesh: [0-9]+ %, (~?[0-9]+ s|~[0-9]+ s left), round [0-9]+, about [0-9.]+ % in hexes$' shown
  grep -Eq '^tetmesh: [0-9]+ changes in [0-9]+ rounds: about' shown
  grep -Eq '^tetmesh: [0-9]+ points .* degrees$' shown
  on_terminal "$search -q" >shown
  assert_equal "$(cat shown)" ""
  run_apart shell "$search"
  assert_success
  assert_equal "$stderr" ""
  TERM=dumb run script -qec "$search" /dev/null </dev/null
  assert_output ""
}

# bats test_tags=optimized
@test "nothing to read at a terminal ends with 2" {
  for tool in $READERS; do
    run script -qec "$tool -o out.tar" /dev/null </dev/null
    assert_equal "$status" 2
    assert_output --partial "nothing to read"
  done
}

@test "missing, empty and nonsense input end with 1 and leave the old output" {
  : >empty
  echo "certainly no mesh, graph or bundle" >nonsense
  for tool in $TOOLS; do
    echo old >out.tar
    assert_fails_with 1 "^$tool: missing: .*No such file" $tool missing -o out.tar
    assert_fails_with 1 "^$tool: empty" $tool empty -o out.tar
    assert_fails_with 1 "^$tool: nonsense" $tool nonsense -o out.tar
    assert_fails_with 1 "^$tool: .*directory" $tool . -o out.tar
    assert_fails_with 1 "^$tool: stdin" shell ": | $tool -o out.tar"
    assert_equal "$(cat out.tar)" old
    assert_equal "$(ls | tr '\n' ' ')" "empty nonsense out.tar "
  done
}

@test "a bundle that lacks what the tool needs is named" {
  assert_fails_with 1 "expected candidates for buildgraph, found mesh" buildgraph "$STAGES/findhex.in"
  assert_fails_with 1 "expected graph for initsol, found mesh, candidates" initsol "$STAGES/buildgraph.in"
  assert_fails_with 1 "expected solution for lns, found mesh, candidates, graph" lns "$STAGES/initsol.in"
  assert_fails_with 1 "expected solution for assemble" assemble "$STAGES/initsol.in"
}

# bats test_tags=optimized
@test "success is silent" {
  for tool in $TOOLS; do
    run_apart $tool $(limited $tool) "$STAGES/$tool.in" -o out.tar -q
    assert_success
    assert_equal "$output$stderr" ""
  done
}

# bats test_tags=optimized
@test "-v speaks on standard error only" {
  for tool in $TOOLS; do
    run_apart $tool $(limited $tool) "$STAGES/$tool.in" -o out.tar -v
    assert_success
    assert_equal "$output" ""
    assert [ -n "$stderr" ]
  done
}

# bats test_tags=optimized
@test "file, pipe and process substitution give the same bytes" {
  for tool in $READERS; do
    $tool $(limited $tool) "$STAGES/$tool.in" -o file.tar
    $tool $(limited $tool) <"$STAGES/$tool.in" >redirected.tar
    cat "$STAGES/$tool.in" | $tool $(limited $tool) | cat >piped.tar
    $tool $(limited $tool) <(cat "$STAGES/$tool.in") >substituted.tar
    $tool $(limited $tool) - <"$STAGES/$tool.in" >dashed.tar
    for other in redirected piped substituted dashed; do assert_same_bytes file.tar $other.tar; done
  done
}

# bats test_tags=optimized
@test "1 and 2 threads, and two runs, give the same bytes" {
  for tool in $TOOLS; do
    $tool $(limited $tool) --threads 1 "$STAGES/$tool.in" -o one.tar -q
    $tool $(limited $tool) --threads 2 "$STAGES/$tool.in" -o two.tar -q
    $tool $(limited $tool) --threads 2 "$STAGES/$tool.in" -o again.tar -q
    assert_same_bytes one.tar two.tar
    assert_same_bytes two.tar again.tar
  done
}

@test "names of files, threads and times stay out of the history" {
  for tool in $TOOLS; do
    local log=() certificate=()
    case $tool in initsol | lns | lns-mpi | certify) log=(--log secret.log) ;; esac
    case $tool in certify) certificate=(--certificate secret.cert) ;; esac
    $tool $(limited $tool) -q "$STAGES/$tool.in" -o secret.tar --threads 2 --stats secret.json "${log[@]}" "${certificate[@]}"
    run tar xOf secret.tar "$(tar tf secret.tar | grep "history/.*-$tool.json")"
    assert_success
    assert_output --partial "\"tool\": \"$tool\""
    refute_output --regexp "secret|$STAGES|thread|seconds|timeout"
  done
}

# The address sanitizer takes terabytes of addresses.
# bats test_tags=optimized
@test "--memory is an error before too much is taken, and stays out of the history" {
  for tool in $TOOLS; do
    assert_fails_with 2 "$tool: --memory: " $tool "$STAGES/$tool.in" --memory lots
    assert_fails_with 2 "$tool: --memory: " $tool "$STAGES/$tool.in" --memory=-1
    assert_fails_with 2 "$tool: --memory: expected at least 1M, found 8 bytes; 8G are 8 gibibytes" \
      $tool "$STAGES/$tool.in" --memory 8
    assert_fails_with 1 "^$tool: .*memory" $tool $(limited $tool) -q "$STAGES/$tool.in" -o out.tar --memory 1M
    assert [ ! -e out.tar ]
    $tool $(limited $tool) -q "$STAGES/$tool.in" -o limited.tar --memory 2G
    $tool $(limited $tool) -q "$STAGES/$tool.in" -o free.tar
    assert_same_bytes limited.tar free.tar
  done
  "$PYTHON" "$DATA/ring_graph.py" 20000 2000 1 >ring.graph
  # Enough to read the file, and not for the graph; how much that is depends on the system's libraries.
  local mebibytes foreseen=
  for mebibytes in $(seq 4 2 40); do
    if initsol ring.graph --iterations 0 -o ring.sol --memory "${mebibytes}M" 2>message; then break; fi
    assert [ ! -e ring.sol ]
    if grep -Eqx "initsol: ring.graph: expected [0-9]+ MiB of memory, found [0-9]+ MiB left" message; then foreseen=yes; fi
  done
  assert [ -s ring.sol ]
  assert_equal "$foreseen" yes
}

@test "statistics that cannot be written are an error before the work, not after it" {
  for tool in $TOOLS; do
    assert_fails_with 1 "$tool: nowhere/statistics.json: cannot write: No such file or directory" \
      $tool $(limited $tool) -q "$STAGES/$tool.in" -o out.tar --stats nowhere/statistics.json
    assert [ ! -e out.tar ]
  done
}

@test "what is no UTF-8 in an option does not lose the run" {
  $PYTHON - <<'PYTHON'
import os, shutil
shutil.copy(os.environ["STAGES"] + "/lns.in", b"part\xff.in")
PYTHON
  lns --iterations 5 $'part\xff.in' --stats $'stats\xff.json' -o out.tar
  assert [ -s out.tar ]
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then
    echo '0 0 0 0.5' >$'sizes\xff.txt'
    run_apart tetmesh "$STAGES/tetmesh.in" --size 0.5 --size-field $'sizes\xff.txt' -o mesh.tar
    assert_success
    assert_equal "$stderr" ""
    run tar xOf mesh.tar history/01-tetmesh.json
    assert_output --partial $'"size-field": "sizes\uFFFD.txt"'
  fi
}

# bats test_tags=optimized
@test "a default of several values stands in the history as it would be typed" {
  findhex -q "$STAGES/findhex.in" -o out.tar
  run tar xOf out.tar "$(tar tf out.tar | grep 'history/.*-findhex.json')"
  assert_output --partial '"cells": "hex"'
}

# bats test_tags=optimized
@test "every output is a bundle that the independent checker accepts" {
  for tool in $TOOLS; do
    $tool $(limited $tool) "$STAGES/$tool.in" -o out.tar -q
    run "$CHECKERS/bundle_check.py" out.tar
    assert_success
    assert_output --partial "history"
    assert_output --regexp "$tool$"
  done
}

# bats test_tags=optimized
@test "compressed bundles are written by name or by --compress, and read" {
  for tool in $READERS; do
    $tool $(limited $tool) "$STAGES/$tool.in" -o plain.tar
    $tool $(limited $tool) "$STAGES/$tool.in" -o small.tar.zst
    $tool $(limited $tool) --compress <"$STAGES/$tool.in" >small.too
    zstd -dqc small.tar.zst | cmp - plain.tar
    zstd -dqc small.too | cmp - plain.tar
    zstd -qc "$STAGES/$tool.in" | $tool $(limited $tool) >from_compressed.tar
    assert_same_bytes plain.tar from_compressed.tar
  done
}

# bats test_tags=optimized
@test "the product alone: by ending, by --format on standard output, the same bytes" {
  for tool in $TOOLS; do
    local ending
    ending=$(product_ending $tool)
    $tool $(limited $tool) "$STAGES/$tool.in" -o "out.$ending" -q
    $tool $(limited $tool) "$STAGES/$tool.in" --format "$ending" -q >stdout.file
    assert_same_bytes "out.$ending" stdout.file
    assert [ "$(head -c 400 stdout.file | tr -d '\0' | wc -c)" -gt 0 ]
  done
}

# bats test_tags=both
@test "a bundle cut anywhere is an error, and nothing looks complete" {
  local step=2
  if sanitized; then step=10; fi
  for tool in $READERS; do
    local size complete length cut
    size=$(stat -c %s "$STAGES/$tool.in")
    # Behind the first block of zeros the archive is complete. tarfile pads to 10240.
    complete=$($PYTHON -c "
import sys
data = open(sys.argv[1], 'rb').read()
print((len(data.rstrip(b'\0')) + 511) // 512 * 512)" "$STAGES/$tool.in")
    # A spread of block boundaries and points around them.
    for cut in $(seq 0 $step 40); do
      length=$((cut * complete / 40 / 512 * 512 + cut % 3))
      if ((length >= complete)); then continue; fi
      run_apart shell "head -c $length '$STAGES/$tool.in' | $tool $(limited $tool) -o out.tar"
      if ((status != 1)); then fail "$tool read $length of $size bytes and ended with $status"; fi
      assert_equal "$(wc -l <<<"$stderr")" 1
      assert [ ! -e out.tar ]
      # On standard output what passed on is cut off as well.
      run shell "head -c $length '$STAGES/$tool.in' | $tool $(limited $tool) >passed.tar 2>/dev/null"
      assert_equal "$status" 1
      if tar tf passed.tar 2>/dev/null | grep "history/.*-$tool.json"; then fail "looks complete: $length bytes"; fi
    done
  done
}

@test "a full disk is an error for bundle, product and stats" {
  for tool in $TOOLS; do
    assert_fails_with 1 "$tool: /dev/full: cannot write: No space left" $tool $(limited $tool) -q "$STAGES/$tool.in" -o /dev/full
    assert_fails_with 1 "$tool: stdout: cannot write: No space left" shell "$tool -q $(limited $tool) '$STAGES/$tool.in' >/dev/full"
    assert_fails_with 1 "$tool: /dev/full: cannot write" $tool $(limited $tool) -q "$STAGES/$tool.in" -o out.tar --stats /dev/full
    assert_fails_with 1 "$tool: nowhere/out.tar: cannot write: No such file" $tool -q $(limited $tool) "$STAGES/$tool.in" -o nowhere/out.tar
    rm -f out.tar
  done
}

@test "a file that is open already is gone on with, not replaced" {
  local in="$STAGES/initsol.in"
  initsol -q "$in" --iterations 20 --log initsol.log -o initsol.sol
  {
    echo before
    initsol -q "$in" --iterations 20 --format sol -o /dev/stdout --stats /dev/stdout
    echo behind
  } >all
  sed -n "2,$(($(wc -l <initsol.sol) + 1))p" all >found.sol
  assert_same_bytes initsol.sol found.sol
  assert_equal "$(sed -n '1p;$p' all | xargs)" "before behind"
  assert grep -q '"tool": "initsol"' all
  echo before >log
  initsol -q "$in" --iterations 20 --log /dev/stderr -o again.sol 2>>log
  assert_equal "$(head -1 log) $(wc -l <log)" "before $(($(wc -l <initsol.log) + 1))"
  {
    initsol -q "$in" --iterations 20 --log /dev/stdout -o again.sol
    echo behind
  } >all
  assert_equal "$(tail -1 all) $(wc -l <all)" "behind $(($(wc -l <initsol.log) + 1))"
  ln -s /dev/fd/7 link
  echo before >old
  exec 7>>old
  initsol -q "$in" --iterations 20 --format sol -o link
  exec 7>&-
  assert_equal "$(head -1 old)" before
  assert_same_bytes <(tail -n +2 old) initsol.sol
}

@test "a file that may not be written is not replaced either" {
  echo precious >kept.cand
  chmod 444 kept.cand
  cp "$STAGES/findhex.in" findhex.tar
  local as_nobody=()
  if ((EUID == 0)); then
    # Root may write everything.
    chmod 777 .
    as_nobody=(setpriv --reuid=65534 --clear-groups --inh-caps=-all)
    if ! "${as_nobody[@]}" test -x "$HEXPIPE_BIN/findhex" -a -w .; then skip "nobody cannot get here"; fi
  fi
  assert_fails_with 1 "findhex: kept.cand: cannot write: Permission denied" "${as_nobody[@]}" findhex findhex.tar -o kept.cand
  assert_equal "$(cat kept.cand)" precious
}

@test "a name of a file that is empty is a bad command line, not standard input or output" {
  for tool in $READERS; do
    assert_fails_with 2 "expected the name of a file, found none" shell "$tool '' <'$STAGES/$tool.in'"
    assert_fails_with 2 "output: expected the name of a file, found none" shell "$tool '$STAGES/$tool.in' -o '' | cat"
  done
  for tool in $TOOLS; do
    assert_fails_with 2 "stats: expected the name of a file, found none" shell "$tool '$STAGES/$tool.in' --stats '' | cat"
  done
  assert_fails_with 2 "graph: expected the name of a file, found none" initsol "$STAGES/initsol.in" --graph "" -o out.tar
  assert_fails_with 2 "^tetmesh: [a-z]*: expected the name of a file, found none" shell "tetmesh '' | cat"
}

@test "a reader that goes away is an error" {
  local pipe
  for tool in $TOOLS; do
    # The only reader of this pipe has ended before anything is written, so that even a small bundle meets nobody.
    exec {pipe}> >(true)
    wait $!
    assert_fails_with 1 "^$tool: stdout: cannot write: Broken pipe$" shell "$tool -q $(limited $tool) '$STAGES/$tool.in' >&$pipe"
    exec {pipe}>&-
  done
}

# bats test_tags=optimized
@test "--stats writes JSON with the tool's name and seconds" {
  for tool in $TOOLS; do
    $tool $(limited $tool) -q "$STAGES/$tool.in" -o out.tar --stats stats.json
    run $PYTHON -c "
import json
stats = json.load(open('stats.json'))
assert stats['tool'] == '$tool', stats
assert stats['seconds'] >= 0, stats
assert len(stats) > 2, stats"
    assert_success
  done
}

# bats test_tags=optimized
@test "a killed tool leaves neither a temporary file nor a half-written one" {
  mkfifo slow
  for tool in $READERS; do
    echo old >out.tar
    exec 8<>slow
    head -c 700 "$STAGES/$tool.in" >&8
    $tool -o out.tar slow 2>/dev/null 8>&- &
    local reader=$!
    await waits_for_input $reader
    # A search reads on for a second, for a search upstream may be about to answer.
    kill -TERM $reader
    local code=0
    wait $reader || code=$?
    assert_equal "$code" 143
    exec 8>&-
    assert_equal "$(cat out.tar)" old
    assert_equal "$(ls | tr '\n' ' ')" "out.tar slow "
  done
}

@test "members that no tool knows pass through untouched" {
  $PYTHON - "$STAGES/findhex.in" with.tar <<'PYTHON'
import io, sys, tarfile
with tarfile.open(sys.argv[1]) as old, tarfile.open(sys.argv[2], "w", format=tarfile.PAX_FORMAT) as new:
    note = tarfile.TarInfo("notes/of the user.txt")
    note.size = 5
    new.addfile(note, io.BytesIO(b"hello"))
    for member in old:
        new.addfile(member, old.extractfile(member))
PYTHON
  findhex <with.tar | buildgraph | initsol --iterations 5 | lns --iterations 5 | assemble >through.tar
  assert_equal "$(tar xOf through.tar 'notes/of the user.txt')" hello
}

@test "arrays of the wrong shape or type are named" {
  # damage MEMBER EXPRESSION [TOOL]: copies the input of a tool (buildgraph) with one array changed.
  damage() {
    $PYTHON "$DATA/change_array.py" "$STAGES/${3:-buildgraph}.in" damaged.tar "$1" "$2"
  }
  damage candidates/vertices.npy 'a[:, :7]'
  assert_fails_with 1 "candidates/vertices.npy: expected an array of shape \(n,8\), found \([0-9]+,7\)" buildgraph damaged.tar -o out.tar
  damage candidates/vertices.npy 'a.astype("f4")'
  assert_fails_with 1 "candidates/vertices.npy: expected numbers of type i4, found f4" buildgraph damaged.tar -o out.tar
  damage candidates/kind.npy 'a[:-1]'
  assert_fails_with 1 "candidates" buildgraph damaged.tar -o out.tar
  damage candidates/tet_offsets.npy 'a[::-1].copy()'
  assert_fails_with 1 "candidates" buildgraph damaged.tar -o out.tar
  damage candidates/kind.npy 'a + 40'
  assert_fails_with 1 "candidates" buildgraph damaged.tar -o out.tar
  damage candidates/quality.npy 'a * np.nan'
  assert_fails_with 1 "candidates" buildgraph damaged.tar -o out.tar
  damage candidates/vertices.npy 'a.astype(">i4")'
  assert_fails_with 1 "little-endian" buildgraph damaged.tar -o out.tar
  damage candidates/tets.npy 'a + 1000000' assemble
  assert_fails_with 1 "candidates" assemble damaged.tar -o out.tar
  damage mesh/points.npy 'a * np.inf' assemble
  assert_fails_with 1 "mesh" assemble damaged.tar -o out.tar
  damage graph/neighbours.npy 'np.roll(a, 1)' lns
  assert_fails_with 1 "graph" lns damaged.tar -o out.tar
  damage solution/chosen.npy 'np.arange(len(a) + 2, dtype="i4")' lns
  assert_fails_with 1 "solution" lns damaged.tar -o out.tar
  damage solution/chosen.npy 'a + 100000' assemble
  assert_fails_with 1 "solution" assemble damaged.tar -o out.tar
  # Wider integers are taken where they fit: a stage in Python makes them without thinking.
  damage candidates/vertices.npy 'a.astype("i8")'
  buildgraph "$STAGES/buildgraph.in" --format graph >plain.graph
  buildgraph damaged.tar --format graph >wide.graph
  assert_same_bytes plain.graph wide.graph
}

@test "a link, a device or a way out in a bundle is an error" {
  $PYTHON - <<'PYTHON'
import io, tarfile
def bundle(path, name, kind, link=""):
    with tarfile.open(path, "w", format=tarfile.PAX_FORMAT) as archive:
        member = tarfile.TarInfo(name)
        member.type, member.linkname = kind, link
        archive.addfile(member, io.BytesIO(b""))
bundle("link.tar", "mesh/points.npy", tarfile.SYMTYPE, "/etc/passwd")
bundle("hard.tar", "mesh/points.npy", tarfile.LNKTYPE, "/etc/passwd")
bundle("device.tar", "mesh/points.npy", tarfile.CHRTYPE)
bundle("out.of.tar", "../points.npy", tarfile.REGTYPE)
PYTHON
  for file in link hard device out.of; do
    for tool in $READERS; do assert_fails_with 1 "$file.tar: " $tool $file.tar; done
  done
}

# bats test_tags=optimized
@test "standard error that cannot be written changes nothing" {
  for tool in $TOOLS; do
    $tool $(limited $tool) "$STAGES/$tool.in" -v -o out.tar 2>/dev/full
    $tool $(limited $tool) "$STAGES/$tool.in" -v -o other.tar 2>&-
    assert_same_bytes out.tar other.tar
    run -1 shell "$tool missing -o out.tar 2>/dev/full"
    assert_fails_with 1 "$tool: stdout: cannot write" shell "$tool $(limited $tool) -q '$STAGES/$tool.in' >&-"
  done
}
