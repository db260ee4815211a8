#!/usr/bin/env bash
# run.sh FUZZ_READERS [SECONDS [READER...]] - fuzzes each reader (all of them) for so many seconds, from the seeds and from
# what earlier runs in this directory found (fuzz-corpus/). Prints a line for each: executions, edges covered, findings,
# which lie in fuzz-findings/. Ends with 1 when there are any.
set -euo pipefail
fuzzer=$(realpath "$1")
seconds=${2:-1200}
readers=("${@:3}")
here=$(cd "$(dirname "$0")" && pwd)
if ((${#readers[@]} == 0)); then mapfile -t readers < <(ls "$here/corpus"); fi

# dictionary READER: its own words and, for text, numbers at the edges of their types.
dictionary() {
  local name=$1
  case $1 in
    msh*) name=msh ;;
    members) name=bundle ;;
  esac
  cat "$here/dictionaries/text_numbers.dict"
  if [[ -e $here/dictionaries/$name.dict ]]; then cat "$here/dictionaries/$name.dict"; fi
}

printf '%-14s %12s %8s %9s\n' reader executions edges findings
findings=0
for reader in "${readers[@]}"; do
  mkdir -p "fuzz-corpus/$reader" "fuzz-findings/$reader"
  dictionary "$reader" >"fuzz-corpus/$reader.dict"
  # A file that takes over 10 s or 1 GiB is a finding too.
  "$fuzzer" --reader="$reader" "fuzz-corpus/$reader" "$here/corpus/$reader" -dict="fuzz-corpus/$reader.dict" \
    -artifact_prefix="fuzz-findings/$reader/" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -max_len=32768 \
    -print_final_stats=1 >"fuzz-corpus/$reader.log" 2>&1 || true
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "fuzz-corpus/$reader.log")
  edges=$(grep -o 'cov: [0-9]*' "fuzz-corpus/$reader.log" | tail -1 | cut -d' ' -f2)
  found=$(find "fuzz-findings/$reader" -type f | wc -l)
  findings=$((findings + found))
  printf '%-14s %12s %8s %9s\n' "$reader" "${executions:-?}" "${edges:-?}" "$found"
done
((findings == 0))
