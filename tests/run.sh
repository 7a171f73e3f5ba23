#!/usr/bin/env bash
# Builds and runs every test of Catena on a Debian 12 or Ubuntu 24.04 machine. See --help.
set -euo pipefail

usage() {
    cat <<'TEXT'
usage: tests/run.sh [--quick] [--long] [--cluster] [--slow-device-code] [--help]

Installs what is missing (as jobs/quickstart.sh does, and the test tools), then
  format      clang-format finds nothing to change, bash and shellcheck nothing wrong in the shell scripts
  release     build with warnings as errors, all tests (1, 2, 3 and 6 MPI ranks among them)
  cuda        the GPU's backend compiles with nvcc, where there is one (tests/cuda/run.sh runs it)
  fuzz        damaged files for the readers of scenes, tables, PDB, FASTA, System XML, HDF5 bodies, checkpoints, DCD, domains, predicted errors and
              other tools' settings, 5 seconds each (libFuzzer, where clang has it); a minute of changed scenes from outside the process
  asan-ubsan  build with the address and undefined-behaviour sanitizers, the tests of readers, writers, commands, dynamics and restarts
  minimal     build without any optional package, the tests of what differs there
  tidy        clang-tidy on the library's own sources, for a minute at most (what was left out is named)

  --quick  format and release alone
  --slow-device-code  the GPU's code is compiled in half the time, and runs some 200 times slower: for where nobody will run what is in build/release
  --long   also the long tests (statistics, drift; an hour or so), an hour of each damaged file's reader, two of changed scenes, most of those that sanitizers make slow,
           and a build without MPI alone
  --cluster  also what a cluster does to a run (half an hour or so; as root): 50 killed ranks, a Slurm of its own that stops and requeues a
           job, two hosts as network namespaces; installs slurmctld, slurmd, slurm-client and munge
On two cores a first run takes an hour, half of it compilers, whose work ccache keeps.
Logs: build/logs/. Exit status 0 if everything passed, 1 if not; the last line counts tests and checks.
TEXT
}

quick=no long=no cluster=no slow_device_code=OFF
for option in "$@"; do
    case $option in
        --quick) quick=yes ;;
        --long) long=yes ;;
        --cluster) cluster=yes ;;
        --slow-device-code) slow_device_code=ON ;;
        -h | --help) usage; exit 0 ;;
        *) echo "unknown option: $option (see tests/run.sh --help)" >&2; exit 2 ;;
    esac
done

# shellcheck source=jobs/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../jobs/common.sh"
passed=0 failed=0
summary=()

# check NAME COMMAND...: one check, timed and counted; the others go on if it fails.
check() {
    local name=$1 start=$SECONDS word=passed
    if step "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        word=FAILED
    fi
    summary+=("$(printf '%-22s %-8s %5d s' "$name" "$word" $((SECONDS - start)))")
    [ "$word" = passed ]
}

# ctests NAME ARGUMENTS...: counts the tests that CTest ran. A run without a summary counts as one failure.
ctests() {
    local name=$1 start=$SECONDS bad total
    shift
    step "$name" ctest --parallel "$(nproc)" "$@" || true
    read -r bad total < <(sed -nE 's/^[0-9]+% tests passed, ([0-9]+) tests failed out of ([0-9]+)$/\1 \2/p' "$logs/$name.log" | tail -n 1) || { bad=1; total=1; }
    passed=$((passed + total - bad))
    failed=$((failed + bad))
    summary+=("$(printf '%-22s %-8s %5d s  %d of %d tests passed' "$name" "$([ "$bad" -eq 0 ] && echo passed || echo FAILED)" \
        $((SECONDS - start)) $((total - bad)) "$total")")
}

# build PRESET: configured and built with warnings as errors, without the test programs in `unbuilt`, and with those in `only` alone if there are any.
unbuilt=() only=()
build() {
    say "$1"
    check "$1-configure" cmake --preset "$1" -DCATENA_WERROR=ON -DCATENA_SANITIZE_QUICKLY="$([ $long = yes ] && echo OFF || echo ON)" -DCATENA_TESTS_LEFT_OUT="$(IFS=';'; echo "${unbuilt[*]}")" \
        -DCATENA_TESTS_ONLY="$(IFS=';'; echo "${only[*]}")" \
        -DCATENA_SLOW_DEVICE_CODE=$slow_device_code "${python_package[@]}" || return 1
    sed -n '/^-- Catena /,/^$/p' "$logs/$1-configure.log"
    check "$1-build" cmake --build --preset "$1" --parallel "$(build_jobs)"
}

format() {
    local status=0 scripts script
    if [ $tools = yes ]; then
        find src mpi cuda tests \( -name '*.hpp' -o -name '*.cpp' -o -name '*.cu' -o -name '*.cuh' \) -print0 | xargs -0 "$VIRTUAL_ENV/bin/clang-format" --dry-run --Werror || status=1
    fi
    mapfile -t scripts < <(find jobs tests -name '*.sh' | sort)
    scripts+=(.ci/run)
    for script in "${scripts[@]}"; do bash -n "$script" || status=1; done
    if command -v shellcheck >/dev/null; then shellcheck -x "${scripts[@]}" || status=1; else echo "LEFT OUT: no shellcheck"; fi
    return $status
}

tidy() {
    local until=$(($(date +%s) + 60)) sources folder=build/tidy
    # Each source by itself, without precompiled headers, which clang cannot read.
    cmake -B $folder -G Ninja -DCMAKE_BUILD_TYPE=Release -DCATENA_PRECOMPILE=OFF -DCATENA_WITH_CUDA=OFF >/dev/null || return 1
    # Sources changed since the last commit come first. Clang does not compile what mmcif_file.cpp includes of gemmi 0.5.7.
    sources=$({ git diff --name-only HEAD 2>/dev/null | sed "s|^|$root/|"; sed -nE 's/^ *"file": "(.*)",?$/\1/p' $folder/compile_commands.json; } |
        grep -E "^$root/(src|mpi)/.*\.cpp$" | grep -v /mmcif_file.cpp | awk '!seen[$0]++' | while read -r f; do grep -qF "\"$f\"" $folder/compile_commands.json && echo "$f"; done)
    # shellcheck disable=SC2016
    folder=$folder until=$until xargs -P "$(nproc)" -I{} bash -c \
        'if [ "$(date +%s)" -ge "$until" ]; then echo "left out, time is up: {}"; else "$VIRTUAL_ENV/bin/clang-tidy" -p "$folder" --quiet --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-deprecated-declarations "{}" 2>/dev/null; fi' \
        <<<"$sources"
}

# What the scripts of tests/cluster find is shown: each line is a finding with its figure.
cluster_tests() {
    local name
    say "cluster"
    need_packages cluster-packages slurmctld slurmd slurm-client munge iproute2 procps || true
    check killed-ranks "$python" tests/cluster/killed_rank.py --times 50 --steps 3000 || true
    check killed-at-writes "$python" tests/cluster/killed_at_write.py --stride 1 || true
    check killed-with-openmm "$python" tests/cluster/killed_rank.py --times 30 --steps 200 --ranks 1,2,3,4 --all 0.3 --openmm 1 --folder /dev/shm || true
    check rank-without-room "$python" tests/cluster/rank_without_room.py --hdf5 collective || true
    for script in stopped_run full_disk many_ranks one_folder; do check "${script//_/-}" "$python" "tests/cluster/$script.py" || true; done
    check two-hosts as_root "$python" tests/cluster/two_hosts.py || true
    check slurm as_root tests/cluster/slurm.sh || true
    for name in killed-ranks killed-with-openmm killed-at-writes one-folder two-hosts slurm; do grep -hE '^(passed|FAILED|NOT RUN)' "$logs/$name.log" || true; done
}

finish() {
    say "Summary, $((SECONDS / 60)) min $((SECONDS % 60)) s"
    printf '%s\n' "${summary[@]}"
    printf '\n%d passed, %d failed\n' "$passed" "$failed"
    [ "$failed" -eq 0 ]
}

say "Packages"
need_packages test-packages "${build_packages[@]}" libhdf5-dev libgtest-dev ccache git shellcheck python3-dev
need_science
tools=yes
need_python "$root/tests/requirements.txt" || tools=no
need_openmm_cuda || echo "   LEFT OUT: OpenMM on the GPU is not compiled (PyPI cannot be reached)"
mpi_environment
# Python does not load what sanitizers instrument: the package is built once, in the release build.
python_package=(-DCATENA_WITH_PYTHON=OFF)

say "format"
[ $tools = yes ] || echo "   LEFT OUT: no clang-format (PyPI cannot be reached), only the shell scripts are checked"
check format format || true

if [ $tools = yes ]; then python_package=(-DCATENA_WITH_PYTHON=ON "-DPython_EXECUTABLE=$python"); else echo "   LEFT OUT: no nanobind (PyPI cannot be reached), no Python package"; fi
if build release; then
    ctests release-tests --preset release
    if [ $long = yes ]; then ctests long-tests --test-dir build/release --output-on-failure -L long; fi
fi
python_package=(-DCATENA_WITH_PYTHON=OFF)
if [ $cluster = yes ]; then cluster_tests; fi
if [ $quick = yes ]; then finish; exit; fi

if grep -q '^CATENA_NVCC:FILEPATH=/' build/release/CMakeCache.txt; then
    check cuda cmake --build --preset release --target catena_cuda || true
else
    printf '\n   LEFT OUT: no nvcc here, so nothing shows that the backend for GPUs still compiles\n'
    summary+=("cuda                   left out, no nvcc")
fi
fuzz() { tests/fuzz/run.sh "$1" || [ $? -eq 77 ]; }
say "fuzz"
check fuzz fuzz "$([ $long = yes ] && echo 3600 || echo 5)" || true
changed_scenes() { "$python" tests/fuzz/mutate_scenes.py "$1" || [ $? -eq 77 ]; }
check changed-scenes changed_scenes "$([ $long = yes ] && echo 7200 || echo 60)" || true
cat "$logs/fuzz.log" "$logs/changed-scenes.log"
# What the sanitizers and other builds leave to the release build: mathematics and whole runs, which take most of their time. Readers, writers,
# the command line, dynamics and restarts stay. Vectors' kernels have no sanitizers.
mathematics=(dca dca_stage_kernels dca_branched_stages dca_levels dca_articulated dca_campaign dca_campaign_long oracle kinematics)
runs=(force_ranks force_ranks_mpi openmm_runs fixman implicit adaptive at_once simd balance carried_beads command_same_bits command_third_party
      trajectory bench_sampling_copies cases_accuracy cases_slab cases_verdict cases_pictures cases_runs cases_starts cases_steps cases_structures_generator)
# What neither build can run, and what reads no input.
without_input=(gpu gpu_quick gpu_run gpu_exchange bench measure math physics outcome generate)
unbuilt=("${mathematics[@]}" "${runs[@]}" "${without_input[@]}")
if [ $long = yes ]; then unbuilt=(); fi
if build asan-ubsan; then
    slow='^gpu'
    slow+='|Report.(Quick|TheStability)|AThousandRandom|ChainsOf2000|OnLinks.*/(openmp|serial|segments_full)'
    slow+='|RandomChainsAgree.*/(serial_full|openmp_projected|segments_projected)'
    slow+='|Staggered.(Samples|IsStable|IsOfSecondOrder)|HaveTheirOrder|ErrorsAreInProportion|Sampling.TheTemperatures'  # many steps of the same
    slow+='|BranchedChains.SampleStars|CrossLinks.(OfManyBeads|LeaveTheirDegrees)|WholePackage.NumbersAndTruths'
    if [ $long = yes ]; then slow='^gpu|ranks_[56]$|stage_kernels.ranks_2'; fi
    ctests asan-ubsan-tests --preset asan-ubsan -L fast -E "$slow"
fi
# What can differ without packages: reading, files, messages, one rank, one thread.
unbuilt=()
only=(public_headers no_mpi communicator launcher io_text_test io_no_hdf5_test io_failure_test bodies_no_hdf5 scene_no_gemmi_test scene_test scene_files_test
      scene_refusals_test force_without_openmm command_program command_files command_without_hdf5 command_without_mpi command_without_openmm command_units
      integrate at_once plan plan_free_memory analysis_program frames)
presets=(minimal)
without_scripts=(-LE 'python|long')
if [ $long = yes ]; then only=() without_scripts=(-LE long) presets=(no-mpi minimal); fi
for preset in "${presets[@]}"; do
    # A preset would leave out long tests alone, whatever labels are named beside it.
    if build "$preset"; then ctests "$preset-tests" --test-dir "build/$preset" --output-on-failure --no-tests=error "${without_scripts[@]}"; fi
done

say "tidy"
if [ $tools = yes ]; then
    check tidy tidy || true
    grep 'left out' "$logs/tidy.log" || true
else
    echo "   LEFT OUT: no clang-tidy (PyPI cannot be reached)"
fi
finish
