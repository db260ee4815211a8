#!/usr/bin/env bash
# Runs the tests in two halves: of the tools compiled by g++ and optimized, and compiled by clang++ with asserts under the
# address and undefined-behaviour sanitizers. Unit tests run once, under the sanitizers, but for those that would take too
# long there; so do tests of the tools, by their tags (helpers.bash), which leave results in both halves; wrap, whose CGAL
# takes too long to compile twice, is in the optimized half alone (the preset `sanitize` has it). Installs what is
# missing, treats warnings as errors. Ends with the closing line of ctest.
#
# What can wait for something else does not hold it up: most packages are installed while the optimized half compiles, and
# the sanitized half compiles in the time that the optimized tests leave.
set -euo pipefail
cd "$(dirname "$0")/.."
logs=$(mktemp -d)
jobs=$(nproc)
# Many tests wait: for signals, for a stalled input, for a time limit. With two for each processor a quarter of the time
# was left.
tests_at_once=$((3 * jobs))

sanitized_build=  # a process group
trap 'if [[ -n $sanitized_build ]]; then kill -- "-$sanitized_build" 2>/dev/null || true; fi; rm -rf "$logs"' EXIT

# outcome PID LOG: waits for a job. Only one that failed is heard.
outcome() {
  if ! wait "$1"; then
    cat "$2" >&2
    return 1
  fi
}

# build PRESET OPTIONS...
build() {
  cmake --preset "$@"
  cmake --build --preset "$1" --parallel "$jobs"
}

# What failed is said once more at the end, above ctest's closing lines: there may be thousands of lines between.
run_tests() {
  local log="$logs/tests-$1" status=0
  ctest --test-dir "build-$1" --output-on-failure --parallel "$tests_at_once" --no-tests=error 2>&1 | tee "$log" || status=$?
  if ((status != 0)); then
    printf '\n'
    sed '/% tests passed/,$d' "$log" |
      grep -a -E -A 12 '^not ok |: Failure$|ERROR: |runtime error:|[*]{3}(Timeout|Exception)' |
      grep -a -Ev '^(ok |\[  )' | cut -c 1-300 | head -n 60 || true
    sed -n '/% tests passed/,$p' "$log"
  fi
  return $status
}

# Names the compiler of the sanitized half. clang++ needs two thirds of the time of g++ for sanitized code, and sees other
# faults. Without it g++ does both.
choose_sanitizing_compiler() {
  local version
  for version in 16 19; do
    if ! command -v "clang++-$version" >/dev/null; then continue; fi
    export CC="clang-$version" CXX="clang++-$version" LDFLAGS="-fuse-ld=lld"
    # Leaks of libraries are known by the names of their functions. What it says of plugins that are gone by then would
    # be one more line on the standard error of a tool.
    export ASAN_SYMBOLIZER_PATH="$PWD/build-ci-sanitize/llvm-symbolizer"
    mkdir -p build-ci-sanitize
    printf '#!/bin/sh\nexec /usr/lib/llvm-%s/bin/llvm-symbolizer "$@" 2>/dev/null\n' "$version" >"$ASAN_SYMBOLIZER_PATH"
    chmod +x "$ASAN_SYMBOLIZER_PATH"
    return
  done
}

./bootstrap.sh compile-tests
./bootstrap.sh tests >"$logs/packages" 2>&1 &
packages=$!
build ci -DHEXPIPE_OPTIMIZED_HALF=ON
outcome "$packages" "$logs/packages"

set -m
(
  choose_sanitizing_compiler
  renice -n 19 -p $BASHPID >/dev/null
  build ci-sanitize
) >"$logs/sanitized-build" 2>&1 &
sanitized_build=$!
set +m
run_tests ci
outcome "$sanitized_build" "$logs/sanitized-build"
sanitized_build=

choose_sanitizing_compiler
# Sanitized tools are slow, and TetGen leaks what it allocates.
export ASAN_OPTIONS="${ASAN_OPTIONS:-detect_leaks=1:abort_on_error=0}"
export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"
# tests/reproducible.bats compares the results of the sanitized tools with those of the optimized ones.
export HEXPIPE_OTHER_BIN="$PWD/build-ci/bin"
run_tests ci-sanitize
