#!/usr/bin/env bash
# Builds Catena in an image of a container; the recipes jobs/catena.def and jobs/catena-cuda.def run it as root. See --help.
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: jobs/container.sh [--help] cpu | cuda [ARCHITECTURES]

Installs the packages of jobs/quickstart.sh and builds the program:
  cpu    in build/release
  cuda   in build/cuda, for GPUs of these architectures (default: 90), with OpenMM's CUDA platform
and removes the objects of the compiler. Nothing is simulated.
TEXT
}

case ${1:-} in
    cpu | cuda) kind=$1 ;;
    -h | --help) usage; exit 0 ;;
    *) echo "unknown kind of image: ${1:-} (see jobs/container.sh --help)" >&2; exit 2 ;;
esac
architectures=${2:-90}

# shellcheck source=jobs/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

need_packages packages "${build_packages[@]}"
need_science
if [ "$kind" = cpu ]; then
    preset=release
    options=(-DCATENA_WITH_CUDA=OFF)
else
    preset=cuda
    options=("-DCATENA_CUDA_ARCHITECTURES=$architectures")
    need_openmm_cuda || fail "PyPI has no OpenMM for CUDA 13: take the CPU's recipe, or an image with another CUDA"
fi
step configure cmake --preset "$preset" "${options[@]}"
sed -n '/^-- Catena /,/^$/p' "$logs/configure.log"
step build cmake --build --preset "$preset" --target catena-cli --parallel "$(build_jobs)"
"build/$preset/catena" --version
find "build/$preset" -name '*.o' -delete
