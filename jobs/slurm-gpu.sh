#!/usr/bin/env bash
# One rank a GPU: catena gives the ranks of a node its GPUs in turn, each rank has cores of its own beside them.
# Submit from Catena's folder: sbatch jobs/slurm-gpu.sh SCENE FOLDER [options of catena run but --output, --restart and --overwrite]
#SBATCH --job-name=catena-gpu
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=4
#SBATCH --gpus-per-node=4
#SBATCH --cpus-per-task=8
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
# shellcheck source=jobs/cluster.sh
source "${CATENA_ROOT:-${SLURM_SUBMIT_DIR:?is set by sbatch: submit this script, or set CATENA_ROOT}}/jobs/cluster.sh"
has_option --backend "$@" || set -- "$@" --backend cuda
run_to_the_end "$@"
