# docs/tutorial.md: its commands work, and print what the page shows.
# bats file_tags=optimized

load helpers

run_page() {
  "$PYTHON" "$HEXPIPE_SOURCE/docs/tutorial/run.py" "$@"
}

@test "the commands of the tutorial work and print what the page shows, numbers aside" {
  $PYTHON -c "import getfem, meshio" 2>/dev/null || skip "python3-getfem is not installed"
  run run_page "$HEXPIPE_SOURCE/docs/tutorial.md" "$PWD"
  assert_success
  assert_conforming bracket.msh
}

@test "a page that shows something else, a command that fails and a missing picture are errors" {
  mkdir work
  page() {
    printf '```console\n$ echo 1 hex\n%s\n$ %s\n```\n%s' "$1" "$2" "$3" >page.md
    run run_page page.md work
  }
  page "17 hex" "true" ""
  assert_success
  page "1 tet" "true" ""
  assert_failure 1
  assert_output --partial "expected:"
  page "1 hex" "false" ""
  assert_failure 1
  assert_output --partial "exit code 1"
  page "1 hex" "true" "![](page/none.png)"
  assert_failure 1
  assert_output --partial "no command makes none.png"
}
