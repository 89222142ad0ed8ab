#!/bin/bash
# A bundle by many machines: an array of jobs, one shard each, and a job that merges them.
#
#     sbatch --array=1-16 docs/guide/slurm-array.sh shaders/lamplight.toml /shared/bundle
#
# The manifest, the program and the output folder must be visible to every node. Nothing is
# shared while the jobs run, so that one that failed can be submitted again by itself
# (`--array=7`), and order does not matter. With a store (`LAMPLIGHT_STORE=redis://host:6379`)
# jobs use each other's results, and those of earlier runs.
#SBATCH --job-name=lamplight
#SBATCH --cpus-per-task=2
#SBATCH --mem=1G
#SBATCH --time=00:30:00
set -euo pipefail

manifest=$1
out=$2
shards=$out.shards

# Said by an argument: a job inherits the variables of the one that submits it.
if [ "${3:-}" = merge ]; then
    exec lamplight merge "$out" "$shards"/* --manifest "$manifest"
fi

# The first task also submits the merge, which starts once every shard is there.
if [ "$SLURM_ARRAY_TASK_ID" = "$SLURM_ARRAY_TASK_MIN" ] && [ "$SLURM_ARRAY_TASK_COUNT" -gt 1 ]; then
    sbatch --dependency="afterok:$SLURM_ARRAY_JOB_ID" --job-name=lamplight-merge "$0" "$manifest" "$out" merge
fi

export RAYON_NUM_THREADS=${SLURM_CPUS_PER_TASK:-1}
store=${LAMPLIGHT_STORE:+--store=$LAMPLIGHT_STORE}
exec lamplight gen --manifest "$manifest" --out "$shards/$SLURM_ARRAY_TASK_ID" \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_MAX" ${store:---no-cache}
