#!/usr/bin/env bash
# One run over several nodes, a few ranks with many threads on each; goes back to the queue before its time is up and goes on.
# Submit from Catena's folder: sbatch jobs/slurm-nodes.sh SCENE FOLDER [options of catena run but --output, --restart and --overwrite]
#SBATCH --job-name=catena
#SBATCH --nodes=4
#SBATCH --ntasks-per-node=2
#SBATCH --cpus-per-task=16
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
# shellcheck source=jobs/cluster.sh
source "${CATENA_ROOT:-${SLURM_SUBMIT_DIR:?is set by sbatch: submit this script, or set CATENA_ROOT}}/jobs/cluster.sh"
has_option --backend "$@" || set -- "$@" --backend openmp
run_to_the_end "$@"
