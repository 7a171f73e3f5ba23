#!/usr/bin/env bash
# From a bare Debian 12 or Ubuntu 24.04 to a first trajectory: installs what is missing, builds Catena in build/release and
# simulates alpha-synuclein on 2 MPI ranks with OpenMM's forces. See --help.
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: jobs/quickstart.sh [--help]

Does, without asking anything, as root or with sudo:
  1. installs missing Debian packages (compiler, CMake, Eigen, yaml-cpp, Open MPI, HDF5, ...);
  2. makes a virtual environment in build/venv with OpenMM, MDAnalysis, h5py and matplotlib from PyPI
     (without a network: Debian's OpenMM, h5py and matplotlib);
  3. builds Catena in build/release;
  4. simulates inputs/alpha-synuclein.yaml on 2 MPI ranks into build/alpha-synuclein (written anew each time);
  5. draws the observables and the last conformation.
It ends by naming the trajectory, the report and the picture. Logs of the steps: build/logs/. Run it again at any time.
TEXT
}

case ${1:-} in
    "") ;;
    -h | --help) usage; exit 0 ;;
    *) echo "unknown option: $1 (see jobs/quickstart.sh --help)" >&2; exit 2 ;;
esac

# shellcheck source=jobs/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
stage="start"
trap 'status=$?; [ $status -eq 0 ] || echo "jobs/quickstart.sh stopped at: $stage (status $status; logs in $logs)" >&2' EXIT

out=$root/build/alpha-synuclein

stage="Debian packages"; say "$stage"
need_packages packages "${build_packages[@]}"

stage="Python packages"; say "$stage"
need_science

stage="build"; say "Building in build/release with $(build_jobs) compilers"
step configure cmake --preset release
sed -n '/^-- Catena /,/^$/p' "$logs/configure.log"
step build cmake --build --preset release --target catena-cli --parallel "$(build_jobs)"

stage="simulation"; say "Simulating alpha-synuclein on 2 ranks"
mpi_environment
"${mpirun[@]}" -np 2 build/release/catena run inputs/alpha-synuclein.yaml --output "$out" --overwrite

stage="pictures"; say "Drawing"
step plot "$python" jobs/plot.py "$out"
cat "$logs/plot.log"

stage="results"
for file in trajectory.h5md topology.pdb report.html; do [ -s "$out/$file" ] || fail "$out/$file was not written"; done
pictures=("$out"/*.png)
[ -s "${pictures[0]}" ] || fail "no picture was drawn in $out"

cat <<TEXT

Done in $SECONDS s.
  trajectory  $out/trajectory.h5md  (topology: $out/topology.pdb)
  report      $out/report.html
  picture     $(printf '%s  ' "${pictures[@]}")

Open the trajectory in MDAnalysis ($python):
  import MDAnalysis
  u = MDAnalysis.Universe("$out/topology.psf", "$out/trajectory.h5md")  # the PDB has no masses
  for frame in u.trajectory: print(frame.time, u.atoms.radius_of_gyration())
TEXT
