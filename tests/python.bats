# docs/python.md: its examples run, and print what the page shows.
# bats file_tags=optimized

load helpers

@test "the examples of the page about Python work and print what it shows, numbers aside" {
  $PYTHON -c "import matplotlib" 2>/dev/null || skip "python3-matplotlib is not installed"
  export MPLCONFIGDIR="$PWD"
  run "$PYTHON" "$HEXPIPE_SOURCE/docs/tutorial/run.py" "$HEXPIPE_SOURCE/docs/python.md" "$PWD"
  assert_success
  assert_conforming own.vtu
  grep -aq '2 .* "top"' named.msh
}
