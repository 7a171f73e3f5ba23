#!/usr/bin/env bash
# Runs the fuzz targets that tests/fuzz/run.sh made. usage: campaign.sh [--minutes M a target, 15] [--seconds S] [--jobs PROCESSES a target, 1]
# [--targets FOLDER, this one] [--work FOLDER, ./work] [NAME of a target]... Targets run one after the other, each in so many processes,
# which share what they find in WORK/found-NAME. Exit status 0: no finding; 1: a finding, whose input is WORK/NAME-crash-... or the like.
set -euo pipefail
targets=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd) seconds=900 jobs=1 work=work names=()
while [ $# -gt 0 ]; do
    case $1 in
        --minutes) seconds=$((60 * $2)); shift ;;
        --seconds) seconds=$2; shift ;;
        --jobs) jobs=$2; shift ;;
        --targets) targets=$(cd "$2" && pwd); shift ;;
        --work) work=$2; shift ;;
        -*) echo "unknown option: $1 (see the head of campaign.sh)" >&2; exit 2 ;;
        *) names+=("$1") ;;
    esac
    shift
done
mkdir -p "$work"
if [ ${#names[@]} -eq 0 ]; then
    for name in "$targets"/corpus/*; do [ -x "$targets/$(basename "$name")" ] && names+=("$(basename "$name")"); done
fi
if [ -d "$targets/lib" ]; then export LD_LIBRARY_PATH="$targets/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"; fi
# HDF5 leaks a little where files are damaged, and asks for more memory than there is; it has to live with getting none.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:quarantine_size_mb=16:handle_abort=2:handle_segv=2:handle_sigbus=2:handle_sigfpe=2
fixed=() # the address sanitizer of clang 14 needs a kernel that spreads addresses less
if setarch "$(uname -m)" -R true 2>/dev/null; then fixed=(setarch "$(uname -m)" -R); fi

# one NAME NUMBER: a process of a target. Copies of the process that try HDF5 files end after 10 s of their own.
one() {
    local longest=10
    case $1 in bodies | checkpoint) longest=30 ;; esac
    "${fixed[@]}" "$targets/$1" -max_total_time="$seconds" -seed="$2" -rss_limit_mb=1024 -timeout="$longest" -max_len=100000 -print_final_stats=1 \
        -artifact_prefix="$work/$1-" "$work/found-$1" "$targets/corpus/$1" >"$work/$1.$2.log" 2>&1
}

# campaign NAME: all its processes; what they say in a line.
campaign() {
    local name=$1 number running=() bad=0 inputs
    mkdir -p "$work/found-$name"
    for ((number = 1; number <= jobs; ++number)); do
        one "$name" "$number" &
        running+=($!)
    done
    for number in "${!running[@]}"; do wait "${running[$number]}" || bad=$((number + 1)); done
    inputs=$(sed -n 's/^stat::number_of_executed_units: //p' "$work/$name".*.log | awk '{sum += $1} END {printf "%d", sum}')
    if [ $bad -eq 0 ]; then
        printf '%-10s %10d inputs in %d s on %d processes, no finding\n' "$name" "$inputs" "$seconds" "$jobs"
    else
        printf '%-10s %10d inputs, FAILED: %s (%s)\n' "$name" "$inputs" \
            "$(grep -hm 1 -E 'ERROR|runtime error|SUMMARY' "$work/$name.$bad.log" || tail -n 1 "$work/$name.$bad.log")" "$work/$name.$bad.log"
        status=1
    fi
}

status=0
rm -f "$work"/*.log
for name in "${names[@]}"; do campaign "$name"; done
rm -f /dev/shm/catena-fuzz-* # of processes that ended with a finding
exit $status
