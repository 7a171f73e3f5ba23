#!/usr/bin/env bash
# One scene many times, or a folder of scenes, as an array: each task has a seed and a folder of its own.
# Submit from Catena's folder: sbatch --array=1-N jobs/slurm-array.sh SCENE|SCENES FOLDER [options of catena run but --output, --restart and --overwrite]
# SCENE: FOLDER-1, FOLDER-2, ... A folder SCENES of S scenes: tasks 1 to S run them with seed 1 into FOLDER/NAME-1, the next S with seed 2, ...
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
source "${CATENA_ROOT:-${SLURM_SUBMIT_DIR:?is set by sbatch: submit this script, or set CATENA_ROOT}}/jobs/cluster.sh"
[ $# -ge 2 ] || fail "usage: sbatch --array=1-N jobs/slurm-array.sh SCENE|SCENES FOLDER [options]"
choose_task "$1" "$2" "$SLURM_ARRAY_TASK_ID"
shift 2
run_to_the_end "$scene" "$folder" --set "dynamics.seed=$seed" "$@"
