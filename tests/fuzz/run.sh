#!/usr/bin/env bash
# run.sh FUZZER [SECONDS [TARGET...]] - fuzzes each target (all of them) for this many seconds of processor time, from the seeds
# and from what earlier runs in this directory found (fuzz-corpus/). Prints a line for each: processor time, executions of all
# runs here together, edges covered, findings, which lie in fuzz-findings/. Ends with 1 when there are any.
#
# run.sh --table - prints the table again.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
runs=fuzz-corpus/runs # a line for each start of the fuzzer: target, seconds, executions, edges

# dictionary TARGET: its own words and, for text, numbers at the edges of their types.
dictionary() {
  local name=$1
  case $1 in
    members | tool-*) name=bundle ;;
    pipeline | mesh-surface) name=medit ;;
    packed) name=obj ;;
    surface) name=off ;;
  esac
  cat "$here/dictionaries/text_numbers.dict"
  if [[ -e $here/dictionaries/$name.dict ]]; then cat "$here/dictionaries/$name.dict"; fi
}

# sum_of TARGET COLUMN, over all runs.
sum_of() {
  awk -v target="$1" -v column="$2" '$1 == target { sum += $column } END { printf "%.0f\n", sum }' "$runs"
}

findings_of() {
  find "fuzz-findings/$1" -type f 2>/dev/null | wc -l
}

# fuzz TARGET SECONDS. A file that takes over 10 s or 1 GiB is a finding too.
fuzz() {
  local target=$1 log=fuzz-corpus/$1.log TIMEFORMAT='%U %S' times executions edges
  mkdir -p "fuzz-corpus/$target" "fuzz-findings/$target"
  dictionary "$target" >"fuzz-corpus/$target.dict"
  # shellcheck disable=SC2016
  times=$({ time bash -c 'ulimit -St "$0"; exec "$@"' "$2" "$fuzzer" --target="$target" "fuzz-corpus/$target" \
    "$here/corpus/$target" -dict="fuzz-corpus/$target.dict" -artifact_prefix="fuzz-findings/$target/" -timeout=10 \
    -rss_limit_mb=1024 -max_len=32768 -print_final_stats=1 >"$log" 2>&1 || true; } 2>&1)
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  edges=$(grep -ao 'cov: [0-9]*' "$log" | tail -1 | cut -d' ' -f2)
  if ((${executions:-0} == 0)); then
    echo "$target: the fuzzer did not run: see $log" >&2
    exit 1
  fi
  awk -v target="$target" -v rest="$executions ${edges:-0}" '{ print target, $1 + $2, rest }' <<<"$times" >>"$runs"
}

heading() {
  printf '%-16s %8s %12s %8s %9s\n' target seconds executions edges findings
}

line() {
  local edges
  edges=$(awk -v target="$1" '$1 == target { edges = $4 } END { print edges }' "$runs")
  printf '%-16s %8s %12s %8s %9s\n' "$1" "$(sum_of "$1" 2)" "$(sum_of "$1" 3)" "$edges" "$(findings_of "$1")"
}

if [[ $1 == --table ]]; then
  heading
  for target in $(cut -d' ' -f1 "$runs" | sort -u); do line "$target"; done
  exit
fi

fuzzer=$(realpath "$1")
seconds=${2:-1200}
targets=("${@:3}")
# Without one it tells which it has.
if ((${#targets[@]} == 0)); then mapfile -t targets < <({ "$fuzzer" 2>&1 || true; } | sed -n 's/^  //p'); fi
# Tools read and write files, in memory where that can be.
TMPDIR=$(mktemp -d -p /dev/shm 2>/dev/null || mktemp -d)
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
heading
findings=0
for target in "${targets[@]}"; do
  fuzz "$target" "$seconds"
  line "$target"
  findings=$((findings + $(findings_of "$target")))
done
((findings == 0))
