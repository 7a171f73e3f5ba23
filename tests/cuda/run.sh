#!/usr/bin/env bash
# Every test of the GPU backends, and NVIDIA's checkers on a part of them. Usage: tests/cuda/run.sh [BUILD-FOLDER]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${1:-$root/build/gpu}
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export CATENA_NEEDS_GPU=1  # a test that finds no GPU fails

nvidia-smi -L
mkdir -p "$build"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCATENA_WITH_CUDA=ON >"$build.configure.log" 2>&1 || { cat "$build.configure.log"; exit 1; }
targets=(gpu gpu_quick dca command_program catena-cli)
for optional in "gpu_exchange exchanges between GPUs (the build has no MPI)" "gpu_run whole runs (the build has no HDF5)" "gpu_openmm OpenMM on the GPU (the build has no headers of its CUDA platform: OPENMM_DIR)" "gpu_openmm_direct OpenMM on GPUs that write to each other (as gpu_openmm_ranks)" "gpu_openmm_ranks OpenMM on GPUs of several ranks (the build has no MPI, or no headers of OpenMM's CUDA platform: OPENMM_DIR)"; do
    read -r target what <<<"$optional"
    if cmake --build "$build" --target help | grep -q "^$target:"; then
        targets+=("$target")
    else
        echo "LEFT OUT: $what"
    fi
done
cmake --build "$build" --parallel "$(nproc)" --target "${targets[@]}"
failed=0
ctest --test-dir "$build" --output-on-failure --no-tests=error -R '^gpu|cuda|FiguresStandBeside' || failed=1
# racecheck also warns of a barrier's own word in shared memory, which its opener writes before the cluster meets and others ask after.
for tool in memcheck "racecheck --racecheck-detect-level error" synccheck initcheck; do
    echo "== compute-sanitizer $tool"
    # shellcheck disable=SC2086 # the tool and its options
    compute-sanitizer --tool $tool --error-exitcode 1 "$build/tests/cuda/gpu" --gtest_filter='*ManyChains*:*InARow*:*ShortTurns*:*Absolute*:*Sliding*:*CarriedBeads*' | tail -n 3 || failed=1
done
exit $failed
