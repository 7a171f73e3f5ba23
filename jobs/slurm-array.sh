#!/usr/bin/env bash
# The same scene many times, each with a seed and a folder of its own: FOLDER-1, FOLDER-2, ...
# Submit from Catena's folder: sbatch jobs/slurm-array.sh SCENE FOLDER [options of catena run but --output, --restart and --overwrite]
#SBATCH --job-name=catena-array
#SBATCH --array=1-10
#SBATCH --nodes=1
#SBATCH --ntasks=2
#SBATCH --cpus-per-task=1
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
# shellcheck source=jobs/cluster.sh
source "${CATENA_ROOT:-$SLURM_SUBMIT_DIR}/jobs/cluster.sh"
scene=$1 folder=$2
shift 2
run_to_the_end "$scene" "$folder-$SLURM_ARRAY_TASK_ID" --set "dynamics.seed=$SLURM_ARRAY_TASK_ID" "$@"
