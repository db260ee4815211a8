#!/usr/bin/env bash
# submit.sh MESH PARTS DIR - the pipeline by parts as Slurm jobs that wait for each other; prints the number of the last one.
#
#   docs/slurm/submit.sh engine.msh 64 /scratch/engine
#
# One job splits the mesh, an array finds the candidates of each part, an array their conflicts, lns-mpi searches with a
# rank a part, arrays assemble the parts in rounds, and the last job checks that the pieces fit and writes DIR/mesh.pvtu.
# No job but the first needs the memory for the whole. DIR has to be seen from every node.
# Options for sbatch, such as a partition or an account, come from SBATCH_PARTITION, SBATCH_ACCOUNT and so on.
set -euo pipefail

if (($# != 3)); then
  sed -n '2,4s/^# //p' "$0" >&2
  exit 2
fi
mesh=$(realpath "$1") parts=$2
mkdir -p "$3"
cd "$3"
mkdir -p candidates graphs logs

# What a part needs, by its number of tets: docs/definitions.md 5 and formats/README.md.
seconds=${SEARCH_SECONDS:-3600}
# Two are enough where no cell at a seam goes back to its tets; five are the most that a mesh has needed so far. A round
# after all are settled changes nothing; the last job says when more are needed.
rounds=${ROUNDS:-6}
memory_to_split=${MEMORY_TO_SPLIT:-64G} memory_a_part=${MEMORY_A_PART:-8G}
number='$(printf %04d "$SLURM_ARRAY_TASK_ID")'
array="0-$((parts - 1))"

# submit AFTER OPTIONS... COMMAND: a job that begins when AFTER (a job, or nothing) has succeeded.
submit() {
  local after=$1 command=${*: -1}
  local -a options=("${@:2:$#-2}")
  if [[ -n "$after" ]]; then options+=("--dependency=afterok:$after"); fi
  sbatch --parsable --output=logs/%x-%A_%a.txt --kill-on-invalid-dep=yes "${options[@]}" --wrap "set -e; $command"
}

split=$(submit "" --job-name=mesh-part --mem="$memory_to_split" \
  "mesh-part '$mesh' --parts $parts -o parts")
find=$(submit "$split" --job-name=findhex --array="$array" --mem="$memory_a_part" \
  "findhex parts/part-$number.tar -o candidates/part-$number.tar")
link=$(submit "$find" --job-name=buildgraph --array="$array" --mem="$memory_a_part" \
  "buildgraph candidates/part-$number.tar --neighbours candidates/part-*.tar -o graphs/part-$number.tar")
# Slurm warns by SIGUSR1 two minutes before the time is over: the search writes the best so far. A job that is started
# again goes on from the checkpoints.
search=$(submit "$link" --job-name=lns-mpi --ntasks="$parts" --mem-per-cpu="$memory_a_part" --signal=USR1@120 --requeue \
  --time="$((seconds / 60 + 10))" \
  "srun lns-mpi --parts graphs/part-*.tar --time-limit $seconds --checkpoint checkpoints -o solved")
last=$search before=
for round in $(seq "$rounds"); do
  last=$(submit "$last" --job-name=assemble --array="$array" --mem="$memory_a_part" \
    "mkdir -p pieces-$round && assemble solved/part-$number.tar --neighbours solved/part-*.tar $before -o pieces-$round/part-$number.tar")
  before="--before pieces-$round/part-*.tar"
done
submit "$last" --job-name=merge-parts --mem="$memory_a_part" "merge-parts pieces-$rounds/part-*.tar -o mesh.pvtu"
