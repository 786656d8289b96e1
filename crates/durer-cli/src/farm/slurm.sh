#!/bin/bash
#SBATCH --job-name=@NAME@
#SBATCH --array=1-@SHARDS@
#SBATCH --output=@NAME@-%A_%a.log
#SBATCH --requeue
# One shard of @SHARDS@. A task that is done again goes on with what it saved.
# When all have ended:  durer merge shards/@NAME@/*.part -o @OUTPUT@ --hash
set -euo pipefail
mkdir -p shards/@NAME@
durer render @SCENE@ @OPTIONS@ \
    --shard "$SLURM_ARRAY_TASK_ID/@SHARDS@" --output "shards/@NAME@/$SLURM_ARRAY_TASK_ID.part" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --resume --quiet
