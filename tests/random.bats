# Random meshes, graphs and surfaces through whole pipelines, by the checkers: a few cases here, thousands by hand
# (tests/random/random_pipelines.py --cases 2000 --seed new).
# bats file_tags=both

load helpers

@test "random meshes, graphs and surfaces of every kind pass the independent checkers" {
  local cases=36
  if sanitized; then cases=18; fi
  run "$PYTHON" "$HEXPIPE_SOURCE/tests/random/random_pipelines.py" --cases $cases
  assert_success
  assert_output --partial "0 failed"
}
