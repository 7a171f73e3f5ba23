#!/usr/bin/env bash
# Feeds readers with damaged files: libFuzzer with the address and undefined-behaviour sanitizers, 1 GB at most for a file of 100 kB, 10 s an
# input. usage: tests/fuzz/run.sh [SECONDS a target, 60]
# Prints the inputs that each target took. Exit status 0: no crash, no report, no hang; 1: a finding, whose input stays in build/fuzz; 77: no
# clang with libFuzzer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seconds=${1:-60}
work=build/fuzz
mkdir -p "$work"

compiler=$(command -v clang++ || command -v clang++-14 || true)
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' >"$work/probe.cpp"
if [ -z "$compiler" ] || ! "$compiler" -fsanitize=fuzzer,address "$work/probe.cpp" -o "$work/probe" 2>/dev/null; then
    echo "SKIPPED: no clang with libFuzzer (apt-get install clang libclang-rt-14-dev)"
    exit 77
fi

# The table of residues that the build embeds.
parameters=$(find build -name calvados2_parameters.inc -print -quit)
[ -n "$parameters" ] || { echo "SKIPPED: configure a build first"; exit 77; }

# object SOURCE: compiles it where it is newer than what was made of it.
object() {
    local made=$work/${1//\//_}.o
    if [ "$1" -nt "$made" ]; then
        "$compiler" -std=c++20 -O1 -g1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -ffp-contract=off -DFMT_SHARED \
            -Isrc -I. -I"$(dirname "$parameters")" -c "$1" -o "$made" >&2
    fi
    echo "$made"
}

# target NAME SOURCE...: the reader with what it needs.
target() {
    local name=$1 objects=() source
    shift
    for source in "$@"; do objects+=("$(object "$source")"); done
    "$compiler" -std=c++20 -O1 -g1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined -DFMT_SHARED "-DFUZZ_${name^^}" -Isrc -I. \
        tests/fuzz/readers.cpp "${objects[@]}" -lfmt -lyaml-cpp -o "$work/$name"
    mkdir -p "$work/found-$name"
    if "$work/$name" -max_total_time="$seconds" -rss_limit_mb=1024 -timeout=10 -max_len=100000 -print_final_stats=1 \
        -artifact_prefix="$work/$name-" "$work/found-$name" "tests/fuzz/corpus/$name" >"$work/$name.log" 2>&1; then
        printf '%-8s %10d inputs in %d s, no finding\n' "$name" "$(sed -n 's/^stat::number_of_executed_units: //p' "$work/$name.log")" "$seconds"
    else
        printf '%-8s FAILED: %s\n' "$name" "$(grep -m 1 -E 'ERROR|runtime error|SUMMARY' "$work/$name.log")"
        status=1
    fi
}

status=0
tree=(src/scene/node.cpp src/scene/printable.cpp)
files=("${tree[@]}" src/scene/files.cpp src/scene/fields.cpp)
target scene "${tree[@]}"
target table "${files[@]}"
target pdb "${files[@]}" src/scene/pdb_file.cpp src/scene/pdb_sites.cpp src/scene/residue_names.cpp
target fasta "${files[@]}" src/scene/fasta.cpp src/scene/residue_names.cpp src/force/calvados2.cpp
exit $status
