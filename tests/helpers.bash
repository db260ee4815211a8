# Loaded by every .bats file: `load helpers`. Puts the built tools on the PATH and gives each test a directory of its own.
#
# tests/run.sh runs most tests in one of its two halves. Tags above a test, or at the top of a file, say in which:
#   # bats test_tags=optimized  The optimized half alone: takes long under the sanitizers and runs no code there that others
#                               do not run. A build with sanitizers never runs it.
#   # bats test_tags=both       Both: about results, which have to be the same whatever the compiler made of the code, or
#                               with a smaller share of the work under the sanitizers.
#   no tag                      The sanitized half alone: about what does not depend on it, like messages and formats.

export BATS_LIB_PATH="${BATS_LIB_PATH:-/usr/lib/bats}"
# Not by their load.bash: each test would run `dirname` thirty times to find what lies beside it, half of what a test costs.
for library in "$BATS_LIB_PATH"/bats-{support,assert}/src/*.bash; do source "$library"; done
bats_require_minimum_version 1.8.0 # which knows tags

HEXPIPE_SOURCE="${HEXPIPE_SOURCE:-$(cd "$BATS_TEST_DIRNAME/.." && pwd)}"
HEXPIPE_BIN="${HEXPIPE_BIN:-$HEXPIPE_SOURCE/build/bin}"
DATA="$HEXPIPE_SOURCE/tests/data"
CHECKERS="$HEXPIPE_SOURCE/tests/checkers"
# Debian's python3, for which the apt packages numpy, meshio and vtk are installed.
PYTHON=/usr/bin/python3
export PATH="$HEXPIPE_BIN:$PATH"
# A machine without any would take text for bytes.
export LANG="${LANG:-C.UTF-8}"

# An empty directory: Bats keeps files of its own in BATS_TEST_TMPDIR.
setup() {
  mkdir "$BATS_TEST_TMPDIR/work" && cd "$BATS_TEST_TMPDIR/work" || return 1
}

# stdout and stderr apart: $output and $stderr.
run_apart() {
  run --separate-stderr "$@"
}

# assert_fails_with CODE PATTERN COMMAND...: exit code CODE, nothing on stdout, one line on stderr that matches PATTERN
# (extended regular expression).
assert_fails_with() {
  local code=$1 pattern=$2
  shift 2
  run_apart "$@"
  assert_equal "$status" "$code"
  assert_equal "$output" ""
  assert_equal "$(wc -l <<<"$stderr")" 1
  if ! grep -Eq -- "$pattern" <<<"$stderr"; then
    fail "standard error does not match '$pattern': $stderr"
  fi
}

# A command in a shell, for pipes: assert_fails_with 1 'cut off' shell 'head -c 100 x.tar | findhex'
shell() {
  bash -o pipefail -c "$1"
}

# assert_same_bytes A B
assert_same_bytes() {
  if ! cmp "$1" "$2"; then fail "$1 and $2 differ"; fi
}

# assert_different_bytes A B: an option has to change something.
assert_different_bytes() {
  if cmp -s "$1" "$2"; then fail "$1 and $2 are the same"; fi
}

# holds EXPRESSION FILE.json...: in the Python expression, what a file holds goes by its name without the ending.
holds() {
  $PYTHON -c '
import json, pathlib, sys
files = {pathlib.Path(path).stem: json.load(open(path)) for path in sys.argv[2:]}
assert eval(sys.argv[1], files), (sys.argv[1], {name: files[name] for name in files if name != "__builtins__"})' "$@"
}

# assert_conforming FILE: valid cells that fit together, and nothing besides, by the independent checker.
assert_conforming() {
  $PYTHON "$CHECKERS/meshstats.py" --json --exact "$1" >conforming.json
  holds 'conforming["is_conforming"] and not any(conforming[fault] for fault in
    ["open_quads", "inverted_cells", "invalid_hexes", "negative_volumes", "unused_points"])' conforming.json
  rm conforming.json
}

# await COMMAND...: tries until it succeeds. Under load and sanitizers, what usually takes a moment may take minutes.
await() {
  local end=$((SECONDS + 300))
  until "$@" >/dev/null 2>&1; do
    if ((SECONDS > end)); then fail "waited for this in vain: $*"; fi
    sleep 0.02
  done
}

# takes_signals PID: the tool has begun, and SIGINT reaches its own handler. To be awaited.
takes_signals() {
  local name="" key value caught=""
  # The name first: a shell catches signals, too, until it becomes the tool.
  read -r name <"/proc/$1/comm" || return 1
  while read -r key value; do
    if [[ $key == SigCgt: ]]; then caught=$value; fi
  done <"/proc/$1/status"
  [[ -n $caught && $name != bash ]] && ((16#$caught & 2))
}

# waits_for_input PID: the tool has begun, and sleeps until something comes down a pipe. To be awaited.
waits_for_input() {
  takes_signals "$1" && grep -q '^State:[[:space:]]*S' "/proc/$1/status"
}

# has_taken_signals PID: none waits to be handled. To be awaited.
has_taken_signals() {
  grep -q '^ShdPnd:[[:space:]]*0*$' "/proc/$1/status"
}

# has_ended PID: nothing but a zombie is left. To be awaited, where the process is nobody's child here.
has_ended() {
  ! grep -qs '^State:[[:space:]]*[^Z]' "/proc/$1/status"
}

sanitized() {
  [[ -n "${HEXPIPE_SANITIZE:-}" ]]
}
