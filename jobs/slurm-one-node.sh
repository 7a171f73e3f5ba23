#!/usr/bin/env bash
# One run on the cores of one node; goes back to the queue before its time is up and goes on from its checkpoint.
# Submit from Catena's folder: sbatch jobs/slurm-one-node.sh SCENE FOLDER [options of catena run but --output, --restart and --overwrite]
#SBATCH --job-name=catena
#SBATCH --nodes=1
#SBATCH --ntasks=8
#SBATCH --cpus-per-task=1
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
# shellcheck source=jobs/cluster.sh
source "${CATENA_ROOT:-${SLURM_SUBMIT_DIR:?is set by sbatch: submit this script, or set CATENA_ROOT}}/jobs/cluster.sh"
run_to_the_end "$@"
