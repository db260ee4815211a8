#!/usr/bin/env bash
# Runs every test twice: compiled by g++ and optimized, and compiled by clang++ with asserts under the address and
# undefined-behaviour sanitizers. Installs what is missing, treats warnings as errors. Ends with the closing line of ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
./bootstrap.sh tests

# Sanitized tools are slow, and TetGen leaks what it allocates.
export ASAN_OPTIONS="${ASAN_OPTIONS:-detect_leaks=1:abort_on_error=0}"
export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"
jobs=$(nproc)
# Many of them wait: for signals, for a stalled input, for a time limit.
tests_at_once=$((2 * jobs))

# clang++ needs two thirds of the time of g++ for sanitized code, and sees other faults. Without it g++ does both.
clang=
for version in 16 19; do
  if [[ -z $clang ]] && command -v "clang++-$version" >/dev/null; then clang=$version; fi
done

for preset in ci ci-sanitize; do
  if [[ $preset == ci-sanitize && -n $clang ]]; then
    export CC="clang-$clang" CXX="clang++-$clang" LDFLAGS="-fuse-ld=lld"
    # Leaks of libraries are known by the names of their functions. What it says of plugins that are gone by then would
    # be one more line on the standard error of a tool.
    export ASAN_SYMBOLIZER_PATH="$PWD/build-ci-sanitize/llvm-symbolizer"
    mkdir -p build-ci-sanitize
    printf '#!/bin/sh\nexec /usr/lib/llvm-%s/bin/llvm-symbolizer "$@" 2>/dev/null\n' "$clang" >"$ASAN_SYMBOLIZER_PATH"
    chmod +x "$ASAN_SYMBOLIZER_PATH"
  fi
  cmake --preset "$preset"
  cmake --build --preset "$preset" --parallel "$jobs"
  # tests/reproducible.bats compares the results of the sanitized tools with those of the optimized ones.
  if [[ $preset == ci-sanitize ]]; then export HEXPIPE_OTHER_BIN="$PWD/build-ci/bin"; fi
  ctest --test-dir "build-$preset" --output-on-failure --parallel "$tests_at_once" --no-tests=error
done
