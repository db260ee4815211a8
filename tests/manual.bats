# Man pages and completion, as the build makes them beside the tools, and the pages that are installed with them.
# bats file_tags=optimized

load helpers

TOOLS="hexpipe merge-parts findhex buildgraph initsol lns certify assemble"
for optional in tessellate fitcad wrap tetmesh mesh-part lns-mpi viewmesh; do
  if [[ -x "$HEXPIPE_BIN/$optional" ]]; then TOOLS="$TOOLS $optional"; fi
done
MANUAL="$HEXPIPE_BIN/../manual"

# options TOOL: the long ones of its --help.
options() {
  $1 --help | sed -nE 's/^  (-.,)?(--[a-z0-9-]+).*/\2/p'
}

# completions TOOL WORDS...: what bash offers for the last word.
completions() {
  bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); "_hexpipe_$1"; printf "%s\n" "${COMPREPLY[@]}"' \
    - "$MANUAL/bash/$1" "$@"
}

@test "bash completes every option of every tool" {
  for tool in $TOOLS; do
    assert [ "$(options $tool | wc -l)" -gt 5 ]
    assert_equal "$(completions $tool --)" "$(options $tool)"
  done
}

@test "bash completes values and files" {
  assert_equal "$(completions findhex --cells p | tr '\n' ' ')" "prism pyramid "
  assert_equal "$(completions findhex --cells hex,py)" hex,pyramid
  assert_equal "$(completions findhex --format c)" cand
  assert_equal "$(completions assemble --format tar | tr '\n' ' ')" "tar tar.zst "
  assert_equal "$(completions assemble --solver ca)" calculix
  touch part.mesh
  assert_equal "$(completions findhex --mesh pa)" part.mesh
  assert_equal "$(completions findhex pa)" part.mesh
  assert_equal "$(completions lns --seed '')" ""
  # N is what the help calls its value, and false to CMake.
  assert_equal "$(completions lns --iterations '')" ""
  assert_equal "$(completions hexpipe --from ch)" choice
  mkdir kept
  assert_equal "$(completions hexpipe --keep ke)" kept
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then
    # [N]: a number, or the surface or the next option.
    assert_equal "$(completions tetmesh --layers pa)" part.mesh
    assert_equal "$(completions tetmesh --layers --gr)" --grading
    # Words or a file.
    assert_equal "$(completions tetmesh --points pa)" part.mesh
    assert_equal "$(completions tetmesh --points fr)" frame
    assert_equal "$(completions tetmesh --surface k)" keep
  fi
  if [[ -x "$HEXPIPE_BIN/viewmesh" ]]; then
    assert_equal "$(completions viewmesh --show so)" solution
  fi
  if [[ -x "$HEXPIPE_BIN/mesh-part" ]]; then
    mkdir parts
    assert_equal "$(completions mesh-part --output pa)" parts
    grep -q -- "--output.*:directory:_files -/" "$MANUAL/zsh/_mesh-part"
  fi
}

@test "zsh completes values" {
  grep -q -- "--format.*:value:(cand tar tar.zst)" "$MANUAL/zsh/_findhex"
  grep -q -- "--cells.*:values:_values -s , value hex prism pyramid" "$MANUAL/zsh/_findhex"
  if [[ -x "$HEXPIPE_BIN/tetmesh" ]]; then
    grep -q -- "--surface.*:value:(keep remesh)" "$MANUAL/zsh/_tetmesh"
    grep -q -- "--points.*:_hexpipe_tetmesh__points'" "$MANUAL/zsh/_tetmesh"
    grep -q "_alternative 'values:value:(best frame lattice none)' 'files:file:_files'" "$MANUAL/zsh/_tetmesh"
  fi
  if [[ -x "$HEXPIPE_BIN/viewmesh" ]]; then
    grep -q -- "--show.*:value:(candidates mesh result solution)" "$MANUAL/zsh/_viewmesh"
  fi
}

@test "zsh's completion names every option" {
  for tool in $TOOLS; do
    assert_equal "$(head -1 "$MANUAL/zsh/_$tool")" "#compdef $tool"
    for option in $(options $tool); do
      grep -qE -- "('|,)$option(\[|\})" "$MANUAL/zsh/_$tool"
    done
    # Every quote is closed: bash reads such words as zsh does.
    bash -n "$MANUAL/zsh/_$tool"
  done
}

@test "zsh's completion knows which options take a value, and says of each what it does" {
  for tool in $TOOLS; do
    for option in $($tool --help | sed -nE 's/^  (-.,)?(--[a-z0-9-]+) \[?[A-Z].*/\2/p'); do
      grep -qE -- "('|,)$option(\}')?\[[^]]+\]:" "$MANUAL/zsh/_$tool" || fail "$tool $option takes no value"
    done
    # Texts begin with a word, not with what the help says of the type.
    run grep -E "\[(\(|in \(|x [0-9]|REQUIRED|[=:. ])" "$MANUAL/zsh/_$tool"
    assert_output ""
  done
}

@test "packages have zsh's completion where Debian's zsh looks for it" {
  mkdir -p "staged files/hexpipe/usr/share/zsh/site-functions" "staged files/hexpipe-none/usr/share"
  touch "staged files/hexpipe/usr/share/zsh/site-functions/_findhex"
  cmake -DCPACK_TEMPORARY_DIRECTORY="$PWD/staged files" -P "$HEXPIPE_SOURCE/cmake/DebianFolders.cmake"
  assert_equal "$(find "staged files" -name '_*')" "staged files/hexpipe/usr/share/zsh/vendor-completions/_findhex"
  grep -q "CPACK_PRE_BUILD_SCRIPTS.*/DebianFolders.cmake" "$HEXPIPE_SOURCE/cmake/Packages.cmake"
}

@test "every tool has a man page with its options and examples" {
  if ! command -v help2man >/dev/null; then skip "help2man is not there"; fi
  for tool in $TOOLS; do
    run_apart env MANWIDTH=100 man --warnings -l "$MANUAL/man/$tool.1"
    assert_success
    assert_equal "$stderr" ""
    assert_output --regexp "$tool +- +[a-z]"
    # Where help2man does not find the end of an option, it runs the description into the heading.
    run grep -n '^\.HP' "$MANUAL/man/$tool.1"
    assert_output ""
    run_apart env MANWIDTH=100 man --warnings -l "$MANUAL/man/$tool.1"
    assert_output --partial "EXAMPLES"
    # As it is written, for lines are broken within words.
    for option in $(options $tool) "hexpipe-formats"; do tr -d '\\' <"$MANUAL/man/$tool.1" | grep -q -- "$option"; done
  done
}

@test "man hexpipe is an overview: the tools in their order, what they have in common, exit codes" {
  if ! command -v help2man >/dev/null; then skip "help2man is not there"; fi
  run_apart env MANWIDTH=100 man -l "$MANUAL/man/hexpipe.1"
  for tool in tessellate ${TOOLS#hexpipe }; do assert_output --partial "$tool(1)"; done
  assert_output --partial "HABITS OF ALL TOOLS"
  assert_output --partial "EXIT STATUS"
}

@test "man pages and completion are made where paths have blanks" {
  if ! command -v help2man >/dev/null; then skip "help2man is not there"; fi
  mkdir -p "a b/bin"
  ln -s "$HEXPIPE_SOURCE/cmake" "$HEXPIPE_SOURCE/docs" "a b"
  cp "$(command -v findhex)" "a b/bin"
  cat >"a b/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(hexpipe VERSION 0.1.0 LANGUAGES NONE)
set(CMAKE_INSTALL_DATADIR share)
set(CMAKE_INSTALL_MANDIR share/man)
include(cmake/Manual.cmake)
add_executable(findhex IMPORTED)
set_target_properties(findhex PROPERTIES IMPORTED_LOCATION "${PROJECT_SOURCE_DIR}/bin/findhex")
hexpipe_manual(findhex hexpipe)
CMAKE
  cmake -S "a b" -B "a b/build" -G Ninja >log
  cmake --build "a b/build" >>log || fail "$(cat log)"
  assert [ -s "a b/build/manual/man/findhex.1" ]
  assert [ -s "a b/build/manual/bash/findhex" ]
}

@test "the examples of the man pages are command lines that the tools take" {
  for page in "$HEXPIPE_SOURCE"/docs/man/*.h2m; do
    while read -r line; do
      IFS='|' read -ra stages <<<"$line"
      for stage in "${stages[@]}"; do
        read -r tool _ <<<"$stage"
        if [[ ! " $TOOLS " == *" $tool "* ]]; then continue; fi
        # Options are judged before inputs: those that do not exist end with 2.
        eval "run timeout 120 $stage </dev/null"
        assert [ "$status" -ne 2 ]
      done
    done < <(sed -n '/^\.RS/,/^\.RE/{/^\.R/d;p}' "$page")
  done
}

@test "the man page of viewmesh explains every key of --view, with the defaults" {
  if [[ ! -x "$HEXPIPE_BIN/viewmesh" ]]; then skip "viewmesh is not built"; fi
  local keys key page="$HEXPIPE_SOURCE/docs/man/viewmesh.h2m"
  keys=$(viewmesh --view none 2>&1 </dev/null | sed 's/.*a key of \(.*\), found.*/\1/; s/,//g')
  assert [ "$(wc -w <<<"$keys")" -ge 9 ]
  for key in $keys; do grep -qF "\fB$key=\fP" "$page" || fail "$key is missing"; done
  viewmesh "$DATA/thin.mesh" -o plain.html
  viewmesh "$DATA/thin.mesh" --view "$(sed -n '/^Defaults:/,/^\.fi/{//d;p}' "$page" | tr -d '\\\n')" -o defaults.html
  assert_same_bytes plain.html defaults.html
}

@test "the page of the formats is well formed" {
  run_apart env MANWIDTH=100 man --warnings -l "$HEXPIPE_SOURCE/docs/man/hexpipe-formats.5"
  assert_success
  assert_equal "$stderr" ""
  for ending in mesh msh vtk vtu node inp su2 bdf exo med cgns tar cand graph sol stl; do assert_output --partial ".$ending"; done
}

@test "the page of the formats names every member of a bundle that formats/README.md knows" {
  local members
  members=$(sed -nE '/^\| `(mesh|candidates|graph|solution|result)\//s/^\|([^|]*)\|.*/\1/p' "$HEXPIPE_SOURCE/formats/README.md" |
    grep -oE '[a-z_]+\.(npy|json)' | sort -u)
  assert [ "$(wc -l <<<"$members")" -gt 25 ]
  for member in $members; do
    grep -qw -- "${member%.npy}" "$HEXPIPE_SOURCE/docs/man/hexpipe-formats.5" || fail "$member is missing"
  done
}

# dead_links FOLDER PAGES...: links between pages there that lead nowhere.
dead_links() {
  $PYTHON - "$@" <<'PYTHON'
import pathlib, re, sys
root, pages = pathlib.Path(sys.argv[1]), 0

def anchors(page):
    """The names that GitHub gives to the headings of a page."""
    headings = re.findall(r"^#+ +(.*)$", page.read_text(), re.M)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}

for pattern in sys.argv[2:]:
    for page in root.glob(pattern):
        pages += 1
        for link, anchor in re.findall(r"\]\(([^)#]*)#?([^)]*)\)", page.read_text()):
            target = page.parent / link if link else page
            if re.match("[a-z]+:", link):
                continue
            if not target.exists() or anchor and target.suffix == ".md" and anchor not in anchors(target):
                print(f"{page.relative_to(root)}: {link}#{anchor}")
assert pages > 7, pages
PYTHON
}

@test "links between pages lead somewhere, in the repository and where it is installed" {
  run dead_links "$HEXPIPE_SOURCE" "*.md" "docs/**/*.md" "formats/**/*.md" "tests/**/*.md" "tools/**/*.md" "common/**/*.md"
  assert_success
  assert_output ""
  if [[ ! -e "$HEXPIPE_BIN/../cmake_install.cmake" ]]; then skip "not in a directory of cmake"; fi
  cmake --install "$HEXPIPE_BIN/.." --component hexpipe --prefix "$PWD/usr" >/dev/null
  run dead_links usr "**/*.md"
  assert_success
  assert_output ""
  assert [ -x "$(find usr -name submit.sh)" ]
}
