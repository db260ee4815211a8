# mesh-part, findhex and buildgraph on parts, merge-parts: what is put together is what a single run makes.

load helpers

setup_file() {
  if [[ ! -x "$HEXPIPE_BIN/mesh-part" ]]; then skip "mesh-part is not built"; fi
}

bar() { $PYTHON "$DATA/bar.py" "$@"; }

# run_parts BUNDLE K DIR OPTIONS...: parts, their candidates and their graphs, in DIR.
run_parts() {
  local whole=$1 parts=$2 dir=$3 part
  shift 3
  mkdir "$dir"
  mesh-part -q "$whole" --parts "$parts" -o "$dir"
  for part in "$dir"/part-*.tar; do findhex -q "$part" "$@" -o "${part/part-/candidates-}"; done
  for part in "$dir"/candidates-*.tar; do
    buildgraph -q "$part" --neighbours "$dir"/candidates-*.tar -o "${part/candidates-/graph-}"
  done
}

# parts_equal_whole NAME "K..." OPTIONS...: of the mesh NAME.mesh.
parts_equal_whole() {
  local name=$1 counts=$2 k
  shift 2
  findhex -q --mesh "$name.mesh" "$@" -o "$name.candidates.tar"
  buildgraph -q "$name.candidates.tar" -o "$name.graph.tar"
  for k in $counts; do
    run_parts "$name.mesh" "$k" "$name.$k" "$@"
    merge-parts "$name.$k"/candidates-*.tar -o merged.tar
    assert_same_bytes merged.tar "$name.candidates.tar"
    merge-parts "$name.$k"/graph-*.tar -o merged.tar
    assert_same_bytes merged.tar "$name.graph.tar"
  done
}

ALL="--cells hex,prism,pyramid --min-quality 0.1"

@test "parts of a bar of Delaunay tets give the candidates and the graph of a single run" {
  bar >bar.mesh
  parts_equal_whole bar "1 2 3 7 16" $ALL
}

@test "so do those of a lattice" {
  bar --kuhn >kuhn.mesh
  parts_equal_whole kuhn "3 16" $ALL
}

@test "so do those of two regions with tags, of pieces that do not touch, and of tets turned inside out" {
  bar --regions >regions.mesh
  parts_equal_whole regions "7" $ALL
  bar --length 10 --apart >apart.mesh
  parts_equal_whole apart "3" $ALL
  bar --folded >folded.mesh
  parts_equal_whole folded "7" $ALL
}

@test "so do parts as small as a tet, and a mesh that is one" {
  bar --length 1 --kuhn >small.mesh
  parts_equal_whole small 54 $ALL
  # More parts than files that a process may have open at first.
  (ulimit -Sn 20 && merge-parts small.54/graph-*.tar -o few.tar)
  assert_same_bytes few.tar small.graph.tar
  printf 'MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n9 9 9 0\nTetrahedra\n1\n1 2 3 4 7\nEnd\n' >tet.mesh
  parts_equal_whole tet "1" $ALL
}

@test "parts have a part of the mesh, and the option changes how many there are" {
  bar >bar.mesh
  mesh-part bar.mesh --parts 5 -o five
  mesh-part bar.mesh --parts 5 -o again
  assert_equal "$(ls five | tr '\n' ' ')" "part-0000.tar part-0001.tar part-0002.tar part-0003.tar part-0004.tar "
  for part in five/*; do assert_same_bytes $part again/$(basename $part); done
  run $PYTHON - five <<'PYTHON'
import glob, io, json, sys, tarfile
import numpy as np
own = []
for i, path in enumerate(sorted(glob.glob(sys.argv[1] + "/*"))):
    tar = tarfile.open(path)
    array = lambda name: np.load(io.BytesIO(tar.extractfile(f"mesh/{name}.npy").read()))
    about = json.load(tar.extractfile("mesh/part.json"))
    assert about["part"] == i and about["parts"] == 5, about
    assert about["neighbours"] and i not in about["neighbours"]
    numbers, owners = array("tet_number"), array("tet_part")
    assert (np.diff(numbers) > 0).all() and len(numbers) < about["mesh"]["tets"]
    own.append(numbers[owners == i])
    assert 0.8 < len(own[-1]) / about["mesh"]["tets"] * 5 < 1.2
together = np.concatenate(own)
assert (np.sort(together) == np.arange(about["mesh"]["tets"])).all()
print("good")
PYTHON
  assert_output good
  mesh-part bar.mesh --parts 5 --compress -o packed
  zstd -qd packed/part-0003.tar.zst -o unpacked.tar
  assert_same_bytes unpacked.tar five/part-0003.tar
  mesh-part bar.mesh --parts 5 --seed 9 -o other
  assert_different_bytes five/part-0000.tar other/part-0000.tar
  assert_fails_with 1 "five: expected no parts but the 4 to be written, found part-0004.tar" mesh-part bar.mesh --parts 4 -o five
}

@test "mesh-part says what is wrong in a line" {
  bar --length 1 --kuhn >small.mesh
  assert_fails_with 1 "small.mesh: mesh: expected at least one tet for each of the 55 parts, found 54" mesh-part small.mesh --parts 55 -o out
  assert_fails_with 2 "parts" mesh-part small.mesh -o out
  assert_fails_with 2 "parts" mesh-part small.mesh --parts 0 -o out
  assert_fails_with 2 "output" mesh-part small.mesh --parts 2
  assert_fails_with 1 "/dev/null/x: cannot make the directory" mesh-part small.mesh --parts 2 -o /dev/null/x
  assert_fails_with 1 "expected.*mesh" mesh-part /dev/null --parts 2 -o out
}

@test "parts that do not belong together are refused" {
  bar --length 12 >bar.mesh
  run_parts bar.mesh 4 four
  run_parts bar.mesh 3 three
  bar --length 12 --folded >other.mesh
  run_parts other.mesh 4 other
  findhex -q four/part-0001.tar --min-quality 0.5 -o strict.tar
  findhex -q --mesh bar.mesh -o whole.tar
  local merged="merge-parts four/graph-0000.tar four/graph-0001.tar four/graph-0002.tar"
  assert_fails_with 1 "merge-parts: expected all 4 parts, found no part 3" $merged -o out.tar
  assert_fails_with 1 "other/graph-0003.tar: expected a part of the same mesh as four/graph-0000.tar, found one of another" $merged other/graph-0003.tar -o out.tar
  assert_fails_with 1 "three/graph-0001.tar: expected one of 4 parts as four/graph-0000.tar, found part 1 of 3" $merged three/graph-0001.tar -o out.tar
  assert_fails_with 1 "four/graph-0001.tar: expected each part once, found part 1 of 4 as in four/graph-0001.tar" $merged four/graph-0001.tar -o out.tar
  assert_fails_with 1 "four/candidates-0003.tar: expected" $merged four/candidates-0003.tar -o out.tar
  assert_fails_with 1 "whole.tar: expected a part of a mesh as four/graph-0000.tar, found a whole" $merged whole.tar -o out.tar
  assert_fails_with 1 "bar.mesh: expected a bundle" $merged bar.mesh -o out.tar
  head -c 20000 four/graph-0003.tar >cut.tar
  assert_fails_with 1 "cut.tar: .*(found: |expected)" $merged cut.tar -o out.tar
  assert_fails_with 1 "strict.tar: history/.*: expected a run with the same version and options" \
    merge-parts four/candidates-0000.tar strict.tar four/candidates-000[23].tar -o out.tar
  local build="buildgraph four/candidates-0001.tar"
  assert_fails_with 1 "four/candidates-0001.tar.*: expected the neighbours of part 1 of 4 with --neighbours, found no part" $build -o out.tar
  assert_fails_with 1 "other/candidates-0002.tar: expected a part of the same mesh" $build --neighbours four/candidates-0000.tar other/candidates-0002.tar -o out.tar
  assert_fails_with 1 "three/candidates-0002.tar: expected one of 4 parts" $build --neighbours three/candidates-0002.tar -o out.tar
  assert_fails_with 1 "expected each part once, found part 0 of 4" $build --neighbours four/candidates-0000.tar four/candidates-0000.tar -o out.tar
  findhex -q four/part-0000.tar --min-quality 0.5 -o strict.tar
  assert_fails_with 1 "strict.tar: expected candidates found with the version and options of" $build --neighbours strict.tar four/candidates-000[23].tar -o out.tar
  assert_fails_with 1 "whole.tar: expected a part of a mesh, as mesh-part makes them, found a whole" $build --neighbours whole.tar -o out.tar
  assert_fails_with 2 "--neighbours goes with the candidates of a part" buildgraph whole.tar --neighbours four/candidates-0000.tar -o out.tar
  for option in --reduce --cover "--part 1/2"; do
    assert_fails_with 2 "buildgraph: --part, --reduce and --cover need the whole graph" $build --neighbours four/candidates-*.tar $option -o out.tar
  done
  assert_fails_with 2 "findhex: --part does not go with a mesh that is part 1 of 4 already" findhex four/part-0001.tar --part 1/2 -o out.tar
  assert [ ! -e out.tar ]
}

@test "merge-parts writes to a pipe, in any order of parts, and compresses" {
  bar --length 12 >bar.mesh
  run_parts bar.mesh 3 three
  merge-parts three/graph-*.tar -o whole.tar
  merge-parts three/graph-0002.tar three/graph-0000.tar three/graph-0001.tar | cat >piped.tar
  assert_same_bytes whole.tar piped.tar
  merge-parts three/graph-*.tar --compress | zstd -d >unpacked.tar
  assert_same_bytes whole.tar unpacked.tar
}

@test "a solution in parts is put together by what owners say" {
  bar --length 12 >bar.mesh
  run_parts bar.mesh 3 three
  merge-parts three/graph-*.tar -o whole.tar
  initsol -q whole.tar --iterations 2000 -o solved.tar
  $PYTHON - <<'PYTHON'
import glob, io, tarfile
import numpy as np

def arrays(path):
    with tarfile.open(path) as tar:
        return {m.name: np.load(io.BytesIO(tar.extractfile(m).read())) for m in tar if m.name.endswith(".npy")}

parts = [arrays(path) for path in sorted(glob.glob("three/graph-*.tar"))]
own = [p["candidates/part.npy"] == i for i, p in enumerate(parts)]
keys = np.sort(np.concatenate([p["candidates/key.npy"][o] for p, o in zip(parts, own)]))
chosen = set(keys[arrays("solved.tar")["solution/chosen.npy"]])
with tarfile.open("solved.tar") as tar:
    entry = [m for m in tar if m.name.endswith("initsol.json")][0]
    history = tar.extractfile(entry).read()
for i, (p, o) in enumerate(zip(parts, own)):
    # Of others' candidates it says the contrary of what is so, which must not count.
    says = np.array([(key in chosen) == mine for key, mine in zip(p["candidates/key.npy"], o)])
    data = io.BytesIO()
    np.save(data, np.flatnonzero(says).astype("<i4"))
    with tarfile.open(f"three/graph-{i:04}.tar") as old, tarfile.open(f"solution-{i}.tar", "w", format=tarfile.PAX_FORMAT) as new:
        for member in old:
            new.addfile(member, old.extractfile(member))
        for name, content in (("solution/chosen.npy", data.getvalue()), ("history/05-initsol.json", history)):
            member = tarfile.TarInfo(name)
            member.size = len(content)
            new.addfile(member, io.BytesIO(content))
PYTHON
  merge-parts solution-*.tar -o merged.tar
  assert_same_bytes solved.tar merged.tar
}

@test "the Slurm script's jobs run the pipeline, each when those before it have succeeded" {
  bar >bar.mesh
  mkdir bin
  # Runs a job at once, all numbers of its array, and prints its number: the searching ranks and assemble are others' tests.
  cat >bin/sbatch <<'SBATCH'
#!/usr/bin/env bash
set -e
array= after= command=
while (($#)); do
  case $1 in
    --array=*) array=${1#--array=} ;;
    --dependency=afterok:*) after=${1#--dependency=afterok:} ;;
    --wrap) command=$2; shift ;;
  esac
  shift
done
job=$(($(cat jobs 2>/dev/null || echo 0) + 1))
[[ "$after" == "${job/#1/}" || "$after" == "$((job - 1))" ]]
if [[ -n "$array" ]]; then
  for i in $(seq "${array%-*}" "${array#*-}"); do SLURM_ARRAY_TASK_ID=$i sh -c "$command" >&2; done
else
  sh -c "$command" >&2
fi
echo $job | tee jobs
SBATCH
  printf '#!/bin/sh\nexec "$@"\n' >bin/srun
  printf '#!/bin/sh\nmkdir solved && cp graphs/* solved/ && echo "$@" >searched\n' >bin/lns-mpi
  printf '#!/bin/sh\ncat >assembled.tar\n' >bin/assemble
  chmod +x bin/*
  run_apart env PATH="$PWD/bin:$PATH" "$HEXPIPE_SOURCE/docs/slurm/submit.sh" bar.mesh 5 scratch
  assert_success
  assert_equal "$output" 5
  findhex -q --mesh bar.mesh | buildgraph -q -o whole.tar
  assert_same_bytes scratch/assembled.tar whole.tar
  assert_equal "$(cat scratch/searched | cut -d ' ' -f 1-7)" "--parts graphs/part-0000.tar graphs/part-0001.tar graphs/part-0002.tar graphs/part-0003.tar graphs/part-0004.tar --time-limit"
  run_apart "$HEXPIPE_SOURCE/docs/slurm/submit.sh" bar.mesh
  assert_equal "$status" 2
}
