#!/usr/bin/env bash
# results.sh [--with BIN] SURFACE... - does every stage make the same bytes, however it is run?
#
# It has two uses. Same input, options and seed have to give the same bytes for any number of threads, by files or by a
# pipe: so the whole pipeline runs by files with one thread, twice; by files with two threads; and as one pipe with two
# threads. And a change that only moves or renames code has to leave all results as they were: --with runs the
# executables of another build, too (the one before the change, or build-sanitize/bin).
#
#   HEXPIPE_BIN=build/bin tests/reproducible/results.sh --with ../before/build/bin tests/data/bracket.stl
#
# Prints a line for each surface, with the hash of its last product. Ends with 1 when any file differs. SIZE (8%) is that
# of tetmesh, HEXPIPE_BIN the folder of the tools (build/bin).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
bin=${HEXPIPE_BIN:-$here/../../build/bin}
size=${SIZE:-8%}
other=
if [[ ${1:-} == --with ]]; then
  other=$2
  shift 2
fi
if (($# == 0)); then
  echo "usage: results.sh [--with BIN] SURFACE..." >&2
  exit 2
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

tools=(tetmesh findhex buildgraph initsol lns certify assemble)
declare -A options=(
  [tetmesh]="--size $size" [findhex]="--cells hex,prism,pyramid" [buildgraph]="--cover" [initsol]="--iterations 2000"
  [lns]="--iterations 100" [certify]="--iterations 30" [assemble]="")

# stage BIN TOOL THREADS [INPUT]: to standard output, a bundle.
stage() {
  local bin=$1 tool=$2 threads=$3
  shift 3
  # shellcheck disable=SC2086
  "$bin/$tool" -q ${options[$tool]} --threads "$threads" "$@"
}

# by_files DIRECTORY BIN THREADS SURFACE
by_files() {
  local input=$4 tool
  mkdir "$1"
  for tool in "${tools[@]}"; do
    stage "$2" "$tool" "$3" "$input" -o "$1/$tool.tar"
    input=$1/$tool.tar
  done
}

# by_pipe DIRECTORY BIN THREADS SURFACE
by_pipe() {
  mkdir "$1"
  stage "$2" tetmesh "$3" "$4" | tee "$1/tetmesh.tar" | stage "$2" findhex "$3" | tee "$1/findhex.tar" |
    stage "$2" buildgraph "$3" | tee "$1/buildgraph.tar" | stage "$2" initsol "$3" | tee "$1/initsol.tar" |
    stage "$2" lns "$3" | tee "$1/lns.tar" | stage "$2" certify "$3" | tee "$1/certify.tar" |
    stage "$2" assemble "$3" >"$1/assemble.tar"
}

compared=0 differing=0
# compare SURFACE HOW: with the first run.
compare() {
  local tool
  for tool in "${tools[@]}"; do
    compared=$((compared + 1))
    if cmp -s "$scratch/first/$tool.tar" "$scratch/$2/$tool.tar"; then continue; fi
    differing=$((differing + 1))
    echo "$1: $tool differs: $2"
    return
  done
}

for surface in "$@"; do
  rm -rf "${scratch:?}"/*
  by_files "$scratch/first" "$bin" 1 "$surface"
  runs=(again two-threads pipe)
  by_files "$scratch/again" "$bin" 1 "$surface"
  by_files "$scratch/two-threads" "$bin" 2 "$surface"
  by_pipe "$scratch/pipe" "$bin" 2 "$surface"
  if [[ -n $other ]]; then
    runs+=(other-build)
    by_files "$scratch/other-build" "$other" 2 "$surface"
  fi
  for run in "${runs[@]}"; do compare "$surface" "$run"; done
  echo "$surface: $(sha256sum <"$scratch/first/assemble.tar" | cut -c1-16) $(stat -c %s "$scratch/first/assemble.tar") bytes"
done
echo "$compared files compared, $differing differ"
((differing == 0))
