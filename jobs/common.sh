# What the scripts of jobs/ and tests/run.sh share. To be sourced; sets `root`, the repository, and goes there.
# shellcheck shell=bash disable=SC2034  # the scripts that source this use its variables

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root" || exit
logs=$root/build/logs
mkdir -p "$logs"
# Another checkout of the same sources finds what this one compiled.
export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1

say() { printf '\n== %s\n' "$*"; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

# step NAME COMMAND...: runs the command with its output in build/logs/NAME.log; where it fails, says so and shows the log's end.
step() {
    local name=$1 start=$SECONDS status=0
    shift
    "$@" >"$logs/$name.log" 2>&1 || status=$?
    if [ "$status" -ne 0 ]; then
        printf '\nStep "%s" failed with status %s: %s\nIts log is %s and ends so:\n' "$name" "$status" "$*" "$logs/$name.log" >&2
        tail -n 25 "$logs/$name.log" >&2
        return "$status"
    fi
    printf '   %-28s %4d s\n' "$name" $((SECONDS - start))
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo -E "$@"
    else
        echo "not root, and there is no sudo: run as root: $*" >&2
        return 1
    fi
}

installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# What the build needs (Debian 12 and Ubuntu 24.04).
build_packages=(cmake ninja-build g++ python3 python3-venv ca-certificates libeigen3-dev libyaml-cpp-dev libfmt-dev libspdlog-dev libcli11-dev
                nlohmann-json3-dev libopenmpi-dev openmpi-bin libhdf5-openmpi-dev gemmi-dev tao-pegtl-dev zlib1g-dev)

# need_packages NAME PACKAGE...: installs those that are missing, and touches nothing if none is.
need_packages() {
    local name=$1 missing=() p
    shift
    command -v dpkg-query >/dev/null || { echo "   (no Debian packages on this system: taking what is installed)"; return 0; }
    for p in "$@"; do installed "$p" || missing+=("$p"); done
    [ ${#missing[@]} -eq 0 ] && return 0
    echo "   installing ${missing[*]}"
    export DEBIAN_FRONTEND=noninteractive
    step "$name-list" as_root apt-get -o DPkg::Lock::Timeout=300 update -q &&
        step "$name" as_root apt-get -o DPkg::Lock::Timeout=300 install -q -y --no-install-recommends "${missing[@]}"
}

# need_python FILE: the packages of a requirements file in build/venv, from PyPI. Status 1 where PyPI cannot give them.
need_python() {
    local file=$1 name
    name=python-$(basename "$(dirname "$file")")
    local stamp=$root/build/venv/.installed-$name
    export VIRTUAL_ENV=$root/build/venv
    python=$VIRTUAL_ENV/bin/python
    if ! "$python" -m pip --version >/dev/null 2>&1; then
        step virtual-environment python3 -m venv --clear "$VIRTUAL_ENV" || return 1
    fi
    cmp -s "$file" "$stamp" && return 0
    step "$name" "$python" -m pip install -q --no-input --disable-pip-version-check --retries 2 -r "$file" || return 1
    cp "$file" "$stamp"
}

# The headers and library of OpenMM's CUDA platform beside build/venv's OpenMM, for path `device`; the CUDA libraries that it would bring
# are the machine's own. Status 1 where PyPI cannot give them.
need_openmm_cuda() {
    local version
    version=$("$python" -m pip show openmm 2>/dev/null | sed -n 's/^Version: //p')
    [ -n "$version" ] || return 1
    "$python" -m pip show openmm-cuda-13 2>/dev/null | grep -qx "Version: $version" && return 0
    step openmm-cuda "$python" -m pip install -q --no-input --disable-pip-version-check --retries 2 --no-deps "openmm-cuda-13==$version"
}

# OpenMM, MDAnalysis, h5py and matplotlib from PyPI; where that cannot be reached, what Debian has of them.
need_science() {
    need_python "$root/jobs/requirements.txt" && return 0
    if "$python" -c 'import openmm, h5py, matplotlib' 2>/dev/null; then
        say "PyPI cannot be reached: taking what is in build/venv"
        return 0
    fi
    say "PyPI cannot be reached: taking Debian's OpenMM, h5py and matplotlib; without MDAnalysis"
    need_packages packages-instead-of-pypi libopenmm-dev python3-h5py python3-matplotlib || return 1
    step virtual-environment python3 -m venv --clear --without-pip --system-site-packages "$VIRTUAL_ENV"
}

# Compilers of this code take up to 1.5 GB each.
build_jobs() {
    local cores memory
    cores=$(nproc)
    memory=$(awk '/MemAvailable/ {print int($2 / 1572864)}' /proc/meminfo)
    if [ "$memory" -lt 1 ]; then memory=1; fi
    echo $((cores < memory ? cores : memory))
}

# Open MPI refuses root, more ranks than cores, and names each rank's core; a rank that is cut off must not hang for ever.
mpi_environment() {
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    export OMPI_MCA_btl_vader_single_copy_mechanism=none   # containers forbid it, with a banner a rank
    export OMPI_MCA_oob_tcp_keepalive_time=5 OMPI_MCA_oob_tcp_keepalive_intvl=2 OMPI_MCA_oob_tcp_keepalive_probes=3
    export OMPI_MCA_odls_base_sigkill_timeout=3            # seconds between SIGTERM and SIGKILL: a last checkpoint fits in
    # Ranks that wait give their core to others: with more ranks than free cores a step else lasts as long as the system lets one of them wait.
    export OMPI_MCA_mpi_yield_when_idle=${OMPI_MCA_mpi_yield_when_idle:-1}
    mpirun=(mpirun --bind-to none --oversubscribe -q)
}
