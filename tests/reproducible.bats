# The same bytes however the pipeline is run: tests/reproducible/results.sh, here over two small parts.
# bats file_tags=both

load helpers

@test "one and two threads, files and pipes, two runs and two builds make the same bytes" {
  [[ -x $HEXPIPE_BIN/tetmesh ]] || skip "built without TetGen"
  # tests/run.sh names the optimized build to the sanitized one.
  local parts=("$DATA/notch.stl")
  if ! sanitized; then parts+=("$DATA/cube.stl"); fi
  SIZE=20% run "$HEXPIPE_SOURCE/tests/reproducible/results.sh" ${HEXPIPE_OTHER_BIN:+--with "$HEXPIPE_OTHER_BIN"} "${parts[@]}"
  assert_success
  assert_output --regexp "(28|42|56) files compared, 0 differ"
}

# bats test_tags=optimized
@test "results.sh tells when a stage differs" {
  [[ -x $HEXPIPE_BIN/tetmesh ]] || skip "built without TetGen"
  mkdir other
  ln -s "$HEXPIPE_BIN"/{tetmesh,findhex,buildgraph,initsol,certify,assemble} other
  printf '#!/bin/sh\nexec "%s" --seed 2 --no-reductions "$@"\n' "$HEXPIPE_BIN/lns" >other/lns
  chmod +x other/lns
  SIZE=20% run -1 "$HEXPIPE_SOURCE/tests/reproducible/results.sh" --with other "$DATA/cube.stl"
  assert_output --partial "lns differs: other-build"
}
