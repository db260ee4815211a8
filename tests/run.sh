#!/usr/bin/env bash
# Runs every test twice: optimized, and with asserts under the address and undefined-behaviour sanitizers. Installs what is
# missing, treats warnings as errors. Ends with the closing line of ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
./bootstrap.sh tests

# Sanitized tools are slow, and TetGen leaks what it allocates.
export ASAN_OPTIONS="${ASAN_OPTIONS:-detect_leaks=1:abort_on_error=0}"
export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"
jobs=$(nproc)
# Many of them wait: for signals, for a stalled input, for a time limit.
tests_at_once=$((2 * jobs))

for preset in ci ci-sanitize; do
  cmake --preset "$preset"
  cmake --build --preset "$preset" --parallel "$jobs"
  # tests/reproducible.bats compares the results of the sanitized tools with those of the optimized ones.
  if [[ $preset == ci-sanitize ]]; then export HEXPIPE_OTHER_BIN="$PWD/build-ci/bin"; fi
  ctest --test-dir "build-$preset" --output-on-failure --parallel "$tests_at_once" --no-tests=error
done
