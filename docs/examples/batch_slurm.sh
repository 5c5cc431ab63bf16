#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#SBATCH --job-name=phonomime
#SBATCH --array=1-16
#SBATCH --cpus-per-task=4
#SBATCH --mem=4G
#SBATCH --time=02:00:00
#SBATCH --requeue
#SBATCH --output=phonomime-%A_%a.log
#
# A Slurm job array that runs a batch, one shard a task (docs/batch.md).
#
#   sbatch [--array=1-N] batch_slurm.sh MANIFEST DB [option of phonomime batch]...
#
# The shards are as many as the array's last number, or $SHARDS: say that where only some of the tasks
# are to run again. $PHONOMIME is the program, where it is not on PATH.
set -euo pipefail

if [[ $# -lt 2 ]]; then
  echo "usage: sbatch [--array=1-N] batch_slurm.sh MANIFEST DB [option]..." >&2
  exit 2
fi
manifest=$1
database=$2
shift 2
task=${SLURM_ARRAY_TASK_ID:?is not set: submit this with sbatch --array=1-N}
shards=${SHARDS:-${SLURM_ARRAY_TASK_MAX:?is not set: submit this with sbatch --array=1-N}}

# In place of this shell, so that Slurm's SIGTERM reaches the program, which then stops cleanly.
exec "${PHONOMIME:-phonomime}" batch "$manifest" --db "$database" --shard "$task/$shards" \
  --threads "${SLURM_CPUS_PER_TASK:-1}" "$@"
