# The direction of includes: tools -> formats -> common, and each library in its place.
# bats file_tags=optimized

load helpers

# All lists are made once, and the tests ask them: a process for each of some thousand files takes half a minute.
setup_file() {
  cd "$HEXPIPE_SOURCE" || return 1
  grep -rHE '^[[:space:]]*#[[:space:]]*include' --include='*.hpp' --include='*.cpp' common formats tools tests |
    sed -E 's/^([^:]+):[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]([^>"]+)[>"].*/\1:\2/' >"$BATS_FILE_TMPDIR/includes"
  find common formats tools -name '*.hpp' >"$BATS_FILE_TMPDIR/headers"
}

# includes_of PATHS...: "file:included" for every #include in the sources there.
includes_of() {
  local path
  for path; do grep -E "^$path[/:]" "$BATS_FILE_TMPDIR/includes" || true; done
}

# headers: those of the project, one a line.
headers() {
  cat "$BATS_FILE_TMPDIR/headers"
}

# assert_none TITLE: standard input must be empty.
assert_none() {
  local found
  found=$(cat)
  if [[ -n "$found" ]]; then fail "$1: $found"; fi
}

@test "the search finds includes at all" {
  run includes_of common formats tools
  assert_success
  assert [ "${#lines[@]}" -gt 100 ]
}

@test "common includes nothing of formats or tools" {
  includes_of common | grep -E ':(formats|tools)/' | assert_none "common must know no format and no tool"
}

@test "formats includes nothing of tools" {
  includes_of formats | grep -E ':tools/' | assert_none "formats must know no tool"
}

@test "no tool includes another" {
  local tool
  for tool in "$HEXPIPE_SOURCE"/tools/*/; do
    tool=$(basename "$tool")
    includes_of "tools/$tool" | grep -E ':tools/' | grep -vE ":tools/$tool/" | assert_none "$tool includes another tool"
  done
}

@test "CLI11 only in main.cpp, common/run and the options that lns and lns-mpi share" {
  includes_of common formats tools | grep -E ':CLI/' | grep -vE '^(tools/[a-z-]+/main\.cpp|common/run/[^:]+|common/mwis/lns_options\.[ch]pp):' |
    assert_none "CLI11 out of place"
  includes_of common formats tools | grep -E ':common/run/tool_main.hpp' |
    grep -vE '^(tools/[a-z-]+/main\.cpp|common/run/[^:]+):' | assert_none "tool_main out of place"
}

@test "TetGen in one file of tetmesh, CGAL only in tetmesh and wrap" {
  run bash -c "grep -rlE '#include [<\"]tetgen.h' '$HEXPIPE_SOURCE'/{common,formats,tools}"
  assert_equal "${#lines[@]}" 1
  assert_output --partial "tools/tetmesh/"
  includes_of common formats tools | grep -E ':CGAL/' | grep -vE '^tools/(tetmesh|wrap)/' | assert_none "CGAL out of place"
}

@test "OpenMesh only where surfaces are read and in tetmesh" {
  includes_of common formats tools | grep -E ':OpenMesh/' |
    grep -vE '^(tools/tetmesh/|formats/surfaces/)' | assert_none "OpenMesh out of place"
}

@test "every header is included once" {
  local header first
  for header in $(headers); do
    read -r first <"$HEXPIPE_SOURCE/$header"
    [[ $first == '#pragma once' ]] || fail "$header begins with: $first"
  done
}

# lines_behind HEADER: of the .cpp files of its own, which may be a reader and a writer.
lines_behind() {
  local stem=${1%.hpp}
  cat "$stem.cpp" "${stem}_reader.cpp" "${stem}_writer.cpp" 2>/dev/null | wc -l
}

# is_shared HEADER: two rooms beside its own include it, or three files of its own that are not its .cpp.
is_shared() {
  awk -F: -v header="$1" '
    function room(file) { sub("/[^/]*$", "", file); return file }
    $2 == header && $1 != substr(header, 1, length(header) - 4) ".cpp" { if (room($1) == room(header)) ++own; else others[room($1)] }
    END { exit !(length(others) >= 2 || own >= 3) }' "$BATS_FILE_TMPDIR/includes"
}

# A header that says little and hides little costs a reader one more file. It is worth that where much is behind it, or where
# several places need its subject and nothing else: put into a longer header only for its length, it would tell each of
# them about something that they do not use.
@test "a header of fewer than 30 lines has more than that behind it, or a subject that several places share" {
  local header
  cd "$HEXPIPE_SOURCE"
  for header in $(find common formats tools tests -name '*.hpp' -exec wc -l {} + | awk '$1 < 30 && $2 != "total" { print $2 }'); do
    # A tool's options have their name in every tool; what is behind the resources is made by the build.
    [[ $header == */options.hpp || $header == tools/viewmesh/resources.hpp ]] && continue
    (($(lines_behind "$header") >= 30)) || is_shared "$header" ||
      fail "$header is small, and so is what it stands for: it joins another header of its room"
  done
}

@test "the checkers share no header with the project" {
  if grep -rnE '#include "(common|formats|tools)/' "$CHECKERS"; then fail "a checker includes the project's headers"; fi
}

# assert_floors FOLDER ROOMS...: the rooms of a folder from the ground up; "." are the files at its root. A room includes
# rooms that stand before it, and every subfolder is listed.
assert_floors() {
  local folder=$1 room here below=""
  shift
  local rooms=("$@")
  for room in $(cd "$HEXPIPE_SOURCE/$folder" && find . -mindepth 2 -name '*.hpp' -printf '%h\n' | sed 's|^\./||' | sort -u); do
    [[ " ${rooms[*]} " == *" $room "* ]] || fail "$folder/$room is on no floor"
  done
  for room in "${rooms[@]}"; do
    below+="${below:+|}$room"
    if [[ $room == . ]]; then here="$folder/[^/]+"; else here="$folder/$room/[^:/]+"; fi
    includes_of "$folder" | grep -E "^$here:$folder/" | grep -vE ":$folder/(${below//./[^/]+\\.hpp\$})(/[^/]*)?$" |
      assert_none "$folder/$room includes a room above it"
  done
}

@test "no file leads back to itself by its includes" {
  # A header and its .cpp count as one. tsort says where they have no order.
  run bash -c 'sed -E "s/\.[ch]pp//g; s/:/ /" | awk "\$1 != \$2" | tsort >/dev/null' \
    < <(includes_of common formats tools | grep -E ':(common|formats|tools)/')
  assert_output ""
}

@test "rooms stand on floors: mwis, formats, tetmesh, assemble" {
  assert_floors common/mwis ground bounds reduce exact exact/historical local_search .
  assert_floors formats streams surfaces polyhedra meshes meshes/libraries choice pipeline points
  assert_floors tools/tetmesh geometry fields solid sizing surface volume tetgen search .
  assert_floors tools/assemble hybrid choice shape conform gap layers order pieces .
}

@test "the files at the root of tetmesh stand on floors" {
  local file below="(asked_sizes|point_kind|options|statistics)"
  for file in meshing improve tetmesh main; do
    includes_of tools/tetmesh | grep -E "^tools/tetmesh/$file\.[ch]pp:tools/tetmesh/[^/]+\.hpp$" |
      grep -vE ":tools/tetmesh/($below|$file)\.hpp$" | assert_none "$file includes a file above it"
    below+="|$file"
  done
}

@test "the options of a tool end at its driver" {
  local tool name driver
  for tool in "$HEXPIPE_SOURCE"/tools/*/; do
    name=$(basename "$tool")
    case $name in
      hexpipe) driver=plan ;;
      lns-mpi) driver=job ;;
      merge-parts) driver=merges ;;
      *) driver=${name//-/_} ;;
    esac
    includes_of "tools/$name" | grep ":tools/$name/options\.hpp$" | grep -vE "^tools/$name/(main\.cpp|options\.cpp|$driver\.hpp):" |
      assert_none "inner code of $name includes the options"
  done
}

@test "run includes nothing of its neighbours in common, mesh only run" {
  includes_of common/run | grep -E ':common/' | grep -vE ':common/run/' | assert_none "common/run includes its neighbours"
  includes_of common/mesh | grep -E ':common/' | grep -vE ':common/(run|mesh)/' | assert_none "common/mesh includes rooms above it"
}

# namespace_of ROOM: the one of its files. common/mesh and common/run speak the language of all rooms.
namespace_of() {
  local room=$1
  case $room in
    common/mesh | common/run) echo hexpipe ;;
    common/*) echo "hexpipe::${room#common/}" ;;
    formats/pipeline) echo hexpipe::pipeline ;;
    formats/polyhedra) echo hexpipe::polyhedra ;;
    formats/*) echo hexpipe::formats ;;
    tools/viewmesh) echo hexpipe::viewmesh ;;
    tools/hexpipe) echo hexpipe::front_door ;;
    tools/*) echo "hexpipe::${room#tools/}" ;;
  esac | sed 's|/|::|g; s|-|_|g'
}

@test "each file is in the namespace of its room" {
  local room expected
  cd "$HEXPIPE_SOURCE"
  for room in $(headers | sed 's|/[^/]*$||' | sort -u); do
    expected="namespace $(namespace_of "$room") {"
    (grep -LxF "$expected" "$room"/*.hpp || true) | grep -vxE 'tools/viewmesh/resources.hpp|common/mwis/ground/bits.hpp' |
      assert_none "expected '$expected'"
  done
}

@test "every room has a README, which names files that are there" {
  local room page name
  for room in $(cd "$HEXPIPE_SOURCE" && ls -d common/*/ common/mwis/*/ formats/*/ tools/{tetmesh,assemble}{,/*}/ tools/viewmesh{,/picture,/page}/); do
    page="$HEXPIPE_SOURCE/${room%/}/README.md"
    assert [ -e "$page" ]
    grep -q '^| read in this order ' "$page" || fail "$page does not say in which order to read its files"
    for name in $(sed -n '/^| read in this order /,/^$/p' "$page" | cut -d'|' -f2 | grep -oE '`[^`]+`' | tr -d '`'); do
      [[ -e "${page%/*}/$name" ]] || fail "$page names $name, which is not there"
    done
  done
}

@test "a README names the rooms beside its own that the room includes, and none besides" {
  local page room named included
  for page in $(cd "$HEXPIPE_SOURCE" && grep -l '^It builds on \[' common/*/README.md common/mwis/*/README.md formats/*/README.md tools/*/*/README.md); do
    room=$(dirname "$page")
    named=$(cd "$HEXPIPE_SOURCE/$room" && grep '^It builds on \[' README.md | grep -oE '\([^)]*README\.md\)' | tr -d '()' |
      sed 's|/README.md$||' | xargs realpath --relative-to="$HEXPIPE_SOURCE" | sort)
    included=$(includes_of "$room" | grep -E "^$room/[^/:]+:" | sed -E 's/^[^:]*://; s|/[^/]*$||' | sort -u)
    comm -23 <(echo "$named") <(echo "$included") | assert_none "$page names what $room does not include"
    comm -13 <(echo "$named") <(echo "$included" | grep -E "^$(dirname "$room")/[^/]+$" | grep -vx "$room") |
      assert_none "$page does not name what $room includes"
  done
}

@test "every header stands in the README of its room" {
  local header page
  cd "$HEXPIPE_SOURCE"
  for header in $(headers); do
    page=${header%/*}/README.md
    [[ ! -e $page || $(<"$page") == *"\`${header##*/}\`"* ]] || fail "$header stands in no README"
  done
}

@test "each test runs in one half of tests/run.sh at least" {
  cd "$HEXPIPE_SOURCE/tests"
  grep -nE '^# *bats ' ./*.bats | grep -vE ':# bats (file|test)_tags=(optimized|both)$' | assert_none "unknown tags"
  # What skips under the sanitizers would run nowhere.
  grep -nE 'sanitized.*skip' ./*.bats | grep -v assert_none | assert_none "expected the tag 'optimized'"
}

@test "what the README of the benchmarks says to run can be run" {
  local command
  cd "$HEXPIPE_SOURCE"
  for command in $(grep -oE '`tests/bench/[a-z_/-]+\.(py|sh)' tests/bench/README.md docs/log/*.md | sed 's/.*`//' | sort -u); do
    [[ -x $command ]] || fail "$command is not there, or nobody may run it"
  done
}
