#!/bin/bash
#SBATCH --job-name=@NAME@
#SBATCH --array=1-@TASKS@
#SBATCH --output=@NAME@-%A_%a.log
#SBATCH --requeue
@still # One shard of @SHARDS@. A repeated task continues its saved work.
@still # When all tasks have finished:  durer merge shards/@NAME@/*.part -o @OUTPUT@ --hash
@frames # One shard of @SHARDS@ of one frame of @FIRST@-@LAST@:@STEP@. A repeated task continues its saved work.
@frames # When all tasks have finished:
@frames #   for frame in $(seq @FIRST@ @STEP@ @LAST@); do
@frames #       durer merge shards/@NAME@/"$frame".*.part -o @OUTPUT_OF_FRAME@
@frames #   done
set -euo pipefail
mkdir -p shards/@NAME@
@still shard=$SLURM_ARRAY_TASK_ID
@still durer render @SCENE@ @OPTIONS@ \
@still     --shard "$shard/@SHARDS@" --output "shards/@NAME@/$shard.part" \
@frames frame=$((@FIRST@ + @STEP@ * ((SLURM_ARRAY_TASK_ID - 1) / @SHARDS@)))
@frames shard=$(((SLURM_ARRAY_TASK_ID - 1) % @SHARDS@ + 1))
@frames durer render @SCENE@ @OPTIONS@ --frames "$frame" @MOVING@\
@frames     --shard "$shard/@SHARDS@" --output "shards/@NAME@/%d.$shard.part" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --resume --quiet
