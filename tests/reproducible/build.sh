#!/usr/bin/env bash
# build.sh [TARGET...] - are two builds the same, in other directories, of other names, at other times?
#
# Copies the tracked files to two directories, builds these executables in each without a cache (all of them, and the
# Debian packages), and compares. Prints a line for each file; ends with 1 when any differs.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export CCACHE_DISABLE=1 SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-1700000000}

directories=("$scratch/one" "$scratch/another/of/a/longer/name")
# Both before anything is built: who works on the files meanwhile changes neither.
for directory in "${directories[@]}"; do
  mkdir -p "$directory/source"
  git -C "$here" ls-files -z | tar -C "$here" --null --ignore-failed-read -cf - -T - | tar -C "$directory/source" -xf -
done

# build DIRECTORY [TARGET...]
build() {
  local directory=$1
  shift
  cmake -S "$directory/source" -B "$directory/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DHEXPIPE_TESTS=OFF >"$directory/log"
  cmake --build "$directory/build" --parallel "${JOBS:-$(nproc)}" ${1:+--target "$@"} >>"$directory/log"
  if (($# == 0)); then (cd "$directory/build" && umask 022 && cpack >>"$directory/log"); fi
}

# products DIRECTORY: checksums of what was built.
products() {
  cd "$1/build"
  find bin -maxdepth 1 -type f -print0 | sort -z | xargs -0 sha256sum
  find . -maxdepth 1 -name '*.deb' -print0 | sort -z | xargs -0 --no-run-if-empty sha256sum
}

for directory in "${directories[@]}"; do build "$directory" "$@"; done
(products "${directories[0]}") >"$scratch/first"
(products "${directories[1]}") >"$scratch/second"
cut -c1-16,65- "$scratch/first"
if ! diff "$scratch/first" "$scratch/second"; then
  echo "two builds differ"
  exit 1
fi
echo "$(wc -l <"$scratch/first") files, the same in two builds"
