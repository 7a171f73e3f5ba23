#!/usr/bin/env bash
# The job scripts of jobs/ on a real Slurm, made on this machine for the test alone: a job reaches its time limit's signal, writes a
# checkpoint, goes back to the queue, goes on when its turn comes (after the 120 s that Slurm makes it wait) and ends in the bits of an
# uninterrupted run; a job of threads and one of GPUs, which Slurm counts and this machine may lack, are the run alone; a job array gives
# each element its own run. Needs root and the packages slurmctld, slurmd, slurm-client, munge.
# Usage: tests/cluster/slurm.sh [PROGRAM]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
export CATENA_ROOT=$root CATENA_PROGRAM=${1:-$root/build/release/catena}
python=${CATENA_PYTHON:-$root/build/venv/bin/python}
[ -x "$python" ] || python=python3
[ "$(id -u)" -eq 0 ] || { echo "NOT RUN: the daemons of Slurm need root"; exit 77; }

work=$(mktemp -d /tmp/catena-slurm-XXXXXX)
daemons=()
finish() {
    local status=$?
    scancel --quiet --user root 2>/dev/null || true
    kill "${daemons[@]}" 2>/dev/null || true
    wait "${daemons[@]}" 2>/dev/null || true
    if [ $status -ne 0 ]; then tail -n 30 "$work"/*.log "$work"/*.out 2>/dev/null; fi
    rm -rf "$work"
    exit $status
}
trap finish EXIT

start_slurm() {
    local name
    name=$(hostname -s)
    chmod 755 "$work"
    mkdir -p "$work/state" "$work/spool"
    dd if=/dev/urandom of="$work/munge.key" bs=1024 count=1 status=none
    chmod 600 "$work/munge.key"
    munged --foreground --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munge.pid" \
        --log-file="$work/munge.log" --seed-file="$work/munge.seed" >"$work/munged.log" 2>&1 &
    daemons+=($!)
    export SLURM_CONF=$work/slurm.conf
    cat >"$SLURM_CONF" <<TEXT
ClusterName=test
SlurmctldHost=$name(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
CredType=cred/munge
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
GresTypes=gpu
NodeName=$name NodeAddr=127.0.0.1 CPUs=2 Gres=gpu:2 State=UNKNOWN
PartitionName=all Nodes=$name Default=YES State=UP MaxTime=INFINITE
TEXT
    # Slurm counts these as GPUs; what Catena finds is what there is.
    printf 'Name=gpu File=%s\n' /dev/null /dev/zero >"$work/gres.conf"
    slurmctld -D >"$work/slurmctld.out.log" 2>&1 &
    daemons+=($!)
    slurmd -D >"$work/slurmd.out.log" 2>&1 &
    daemons+=($!)
    wait_for 30 "an idle node" eval "sinfo --noheader --format=%T 2>/dev/null | grep -q idle"
}

# wait_for SECONDS WHAT COMMAND...
wait_for() {
    local seconds=$1 end=$((SECONDS + $1)) what=$2
    shift 2
    until "$@"; do
        [ $SECONDS -lt $end ] || { echo "FAILED: no sign of $what after $seconds s"; exit 1; }
        sleep 1
    done
}

job() { scontrol --oneliner show job "$1" 2>/dev/null | grep -oE "$2=[^ ]*" | head -n 1 | cut -d= -f2; }
is() { [ "$(job "$1" "$2")" = "$3" ]; }

cat >"$work/scene.yaml" <<'TEXT'
title: a run that outlasts its time limit
chains:
  - {name: beads, velocities: thermal, generator: {freely_jointed: {beads: 2000, length: 0.38}}}
dynamics: {integrator: g-baoab, step: 0.002, steps: 20000, friction: 1, seed: 5}
output: {every: 1000}
TEXT

start_slurm
cd "$work"
# So many steps that it takes some 200 s here: more than the job's minute on two ranks as well, and less than what is waited for.
"$CATENA_PROGRAM" run scene.yaml --output pace --quiet
steps=$("$python" -c 'import json
print(int(json.load(open("pace/summary.json"))["speed"]["steps_per_second_of_second_half"] / 5) * 1000)')
sed -i "s/steps: 20000,/steps: $steps,/" scene.yaml
grep -q "steps: $steps," scene.yaml
echo "-- $steps steps"
echo "-- a job of one minute, told 50 s before its end at the latest"
number=$(sbatch --parsable --nodes=1 --ntasks=2 --time=1 --signal=B:USR1@50 --output="$work/long.out" "$root/jobs/slurm-one-node.sh" scene.yaml long)
wait_for 90 "the requeued job" is "$number" Restarts 1
grep -h 'catena: stopped by SIGUSR1\|goes back to the queue' long.out
scontrol update JobId="$number" TimeLimit=60
echo "-- waits for its turn since $(date +%T)"
wait_for 300 "its second start" is "$number" JobState RUNNING
echo "-- goes on at $(date +%T)"
wait_for 900 "its end" is "$number" JobState COMPLETED
"$CATENA_PROGRAM" run scene.yaml --output whole --quiet
"$python" "$root/tests/cluster/compare_runs.py" whole long

echo "-- several threads per rank"
sbatch --wait --quiet --nodes=1 --ntasks-per-node=1 --cpus-per-task=2 --time=10 --output="$work/threads.out" "$root/jobs/slurm-nodes.sh" \
    scene.yaml threads --steps 500 --backend=openmp --threads 2
"$CATENA_PROGRAM" run scene.yaml --output threads-alone --steps 500 --backend openmp --threads 2 --quiet
"$python" "$root/tests/cluster/compare_runs.py" threads-alone threads

echo "-- a rank a GPU: Slurm gives the job two, and Catena takes those there are"
status=0
sbatch --wait --quiet --nodes=1 --ntasks-per-node=2 --gpus-per-node=2 --cpus-per-task=1 --time=10 --output="$work/gpu.out" \
    "$root/jobs/slurm-gpu.sh" scene.yaml gpu --steps 500 || status=$?
if [ "$status" -eq 0 ]; then
    "$CATENA_PROGRAM" run scene.yaml --output gpu-alone --steps 500 --backend cuda --quiet
    "$python" "$root/tests/cluster/compare_runs.py" gpu-alone gpu
else
    grep -h '^catena: .*cuda' gpu.out
    [ "$status" -eq 2 ] || { echo "FAILED: status $status where there is no GPU"; exit 1; }
    sbatch --wait --quiet --nodes=1 --ntasks-per-node=2 --gpus-per-node=2 --cpus-per-task=1 --time=10 --output="$work/host.out" \
        "$root/jobs/slurm-gpu.sh" scene.yaml host --steps 500 --backend segments
    "$CATENA_PROGRAM" run scene.yaml --output host-alone --steps 500 --backend segments --quiet
    "$python" "$root/tests/cluster/compare_runs.py" host-alone host
fi

echo "-- an array of two"
array=$(sbatch --parsable --array=1-2 --ntasks=1 --time=10 --output="$work/array-%a.out" "$root/jobs/slurm-array.sh" scene.yaml each --steps 500)
wait_for 120 "the array's end" eval "is ${array}_1 JobState COMPLETED && is ${array}_2 JobState COMPLETED"
"$CATENA_PROGRAM" run scene.yaml --output alone --steps 500 --set dynamics.seed=2 --quiet
"$python" "$root/tests/cluster/compare_runs.py" alone each-2
if "$python" "$root/tests/cluster/compare_runs.py" each-1 each-2 >different.log; then cat different.log; echo "FAILED: two seeds, one run"; exit 1; fi
echo "passed: Slurm's requeued job and array are the uninterrupted runs"
