# What the job scripts of jobs/ share. To be sourced by a batch script that was submitted from Catena's folder, or with CATENA_ROOT set to it.
# shellcheck shell=bash

# shellcheck source=jobs/common.sh
source "${CATENA_ROOT:-$PWD}/jobs/common.sh"
cd "${SLURM_SUBMIT_DIR:-$root}" || exit
catena=${CATENA_PROGRAM:-$root/build/release/catena}
[ -x "$catena" ] || fail "no such program ($catena): build it (jobs/quickstart.sh), or name it by CATENA_PROGRAM"
export OMPI_MCA_mpi_yield_when_idle=${OMPI_MCA_mpi_yield_when_idle:-0}  # a job's cores are its own: a rank that waits may keep its core
mpi_environment
threads=${SLURM_CPUS_PER_TASK:-1}
# Each rank has the cores that the job asked for; the words of mpirun about a rank that ended are wanted here.
mpirun=(mpirun --map-by "slot:PE=$threads")

stopped=3  # how catena says that a signal stopped it and that its checkpoint is good

# has_option NAME WORD...: whether it is among the words, as NAME or NAME=...
has_option() {
    local name=$1 word
    shift
    for word in "$@"; do [[ $word == "$name" || $word == "$name="* ]] && return 0; done
    return 1
}

# run_catena SCENE FOLDER OPTION...: `catena run` over the job's ranks, from the folder's checkpoint where there is one. SIGUSR1 and SIGTERM
# are handed on as SIGUSR1, at which catena writes a checkpoint. Returns catena's exit status.
run_catena() {
    local scene=$1 folder=$2 word words launcher='' status=0
    shift 2
    for word in --output --restart --overwrite; do
        if has_option "$word" "$@"; then fail "$word is the script's own: leave it out"; fi
    done
    trap '[ -z "$launcher" ] || kill -USR1 "$launcher" 2>/dev/null' USR1 TERM
    words=(run "$scene" --output "$folder")
    has_option --threads "$@" || words+=(--threads "$threads")
    if [ -e "$folder/checkpoint.h5" ]; then
        words+=(--restart "$folder/checkpoint.h5")
    elif [ -e "$folder/checkpoint.previous.h5" ]; then
        words+=(--restart "$folder/checkpoint.previous.h5")
    elif [ "${SLURM_RESTART_COUNT:-0}" -gt 0 ]; then
        words+=(--overwrite)  # the run before ended before its first checkpoint
    fi
    "${mpirun[@]}" "$catena" "${words[@]}" "$@" &
    launcher=$!
    while kill -0 "$launcher" 2>/dev/null; do wait "$launcher" || true; done  # a signal ends the waiting, not the run
    wait "$launcher" || status=$?
    trap - USR1 TERM
    if [ "$status" -gt 128 ]; then echo "catena was ended by signal $((status - 128)): its last checkpoint is in $folder" >&2; fi
    return "$status"
}

# run_to_the_end SCENE FOLDER OPTION...: run_catena in a job that goes back to the queue when its time is nearly up, and goes on from its
# checkpoint when its turn comes again.
run_to_the_end() {
    local status=0
    run_catena "$@" || status=$?
    [ "$status" -eq "$stopped" ] || return "$status"
    echo "time is nearly up: job $SLURM_JOB_ID goes back to the queue"
    scontrol requeue "$SLURM_JOB_ID"
    sleep 60  # Slurm ends this script
}

# choose_task SCENE|SCENES FOLDER NUMBER: sets scene, folder and seed of this task of an array, which are counted from 1.
choose_task() {
    local number=$3 scenes
    [ "$number" -ge 1 ] || fail "tasks of an array are counted from 1 (task $number): submit with --array=1-N"
    scene=$1 folder=$2-$number seed=$number
    [ -d "$scene" ] || return 0
    scenes=("$scene"/*.yaml)
    [ -e "${scenes[0]}" ] || fail "no scenes in this folder ($scene): it needs files *.yaml"
    seed=$(((number - 1) / ${#scenes[@]} + 1))
    scene=${scenes[(number - 1) % ${#scenes[@]}]}
    folder=$2/$(basename "$scene" .yaml)-$seed
    mkdir -p "$2"
}
