#!/usr/bin/env bash
# Feeds readers with damaged files: libFuzzer with the address and undefined-behaviour sanitizers, 1 GB at most for a file of 100 kB, 10 s an
# input. usage: tests/fuzz/run.sh [SECONDS a target, 60] [--minutes M a target] [--jobs PROCESSES a target] [--only NAME[,NAME]...] [--pack FOLDER]
# --pack: puts the targets, their corpora and libraries into FOLDER, for any Linux with glibc 2.36 or later: FOLDER/campaign.sh runs them.
# Prints the inputs that each target took. Exit status 0: no crash, no report, no hang; 1: a finding, whose input stays in build/fuzz/work;
# 77: no clang with libFuzzer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seconds=60 jobs=1 only='' pack=''
while [ $# -gt 0 ]; do
    case $1 in
        --minutes) seconds=$((60 * $2)); shift ;;
        --jobs) jobs=$2; shift ;;
        --only) only=$2; shift ;;
        --pack) pack=$2; shift ;;
        *[!0-9]* | '') echo "unknown option: $1 (see the head of tests/fuzz/run.sh)" >&2; exit 2 ;;
        *) seconds=$1 ;;
    esac
    shift
done
made=build/fuzz
mkdir -p "$made"

compiler=$(command -v clang++ || command -v clang++-14 || true)
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' >"$made/probe.cpp"
if [ -z "$compiler" ] || ! "$compiler" -fsanitize=fuzzer,address "$made/probe.cpp" -o "$made/probe" 2>/dev/null; then
    echo "SKIPPED: no clang with libFuzzer (apt-get install clang libclang-rt-14-dev)"
    exit 77
fi

# The tables of residues that the build embeds.
parameters=$(find build -name residue_tables.inc -print -quit)
[ -n "$parameters" ] || { echo "SKIPPED: configure a build first"; exit 77; }
hdf5=/usr/include/hdf5/serial
openmm=$(find -L build/venv/lib -maxdepth 4 -name OpenMM.libs -print -quit 2>/dev/null || true)
flags=(-std=c++20 -O1 -g1 -ffp-contract=off -DFMT_SHARED -Isrc -I. "-I$(dirname "$parameters")" -isystem /usr/include/eigen3 -isystem "$hdf5"
    ${openmm:+-isystem "$openmm/include"} "-fsanitize=address,undefined" -fno-sanitize-recover=undefined
    "-fno-sanitize=null,alignment,object-size,vptr,nonnull-attribute,returns-nonnull-attribute")

# is_fresh FILE: whether FILE is newer than this script and all that it was made of.
is_fresh() {
    local source sources
    [ -f "$1" ] && [ -f "$1.d" ] && [ "$1" -nt tests/fuzz/run.sh ] || return 1
    read -r -a sources < <(sed 's/^[^:]*://; s/\\$//' "$1.d" | tr '\n' ' ')
    for source in "${sources[@]}"; do [ ! "$source" -nt "$1" ] && [ -e "$source" ] || return 1; done
}

# compile FILE ARGUMENTS...: makes FILE, where it is not fresh.
compile() {
    local file=$1
    shift
    is_fresh "$file" || "$compiler" "${flags[@]}" -fsanitize=fuzzer-no-link -MD -MF "$file.d" "$@" -o "$file"
}

# target NAME LIBRARIES SOURCE...: the reader with what it needs. Two compilers at a time.
target() {
    local name=$1 libraries=$2 objects=() source
    shift 2
    case ,${only:-$name}, in *",$name,"*) ;; *) return ;; esac
    for source in tests/fuzz/entry.cpp "tests/fuzz/$name.cpp" "$@"; do
        objects+=("$made/${source//\//_}.o")
        while [ "$(jobs -rp | wc -l)" -ge 2 ]; do wait -n; done
        compile "${objects[-1]}" -include-pch "$made/precompiled.pch" -c "$source" &
    done
    wait
    # shellcheck disable=SC2086
    "$compiler" "${flags[@]}" -fsanitize=fuzzer "${objects[@]}" $libraries -lfmt -o "$made/targets/$name"
    rm -rf "$made/targets/corpus/$name"
    cp -r "tests/fuzz/corpus/$name" "$made/targets/corpus/"
}

mkdir -p "$made/targets/corpus"
compile "$made/precompiled.pch" -x c++-header tests/fuzz/precompiled.hpp
tree=(src/scene/node.cpp src/io/printable.cpp)
files=("${tree[@]}" src/scene/files.cpp src/scene/fields.cpp)
read_hdf5=(src/io/hdf5_handle.cpp src/io/output_file.cpp)
target scene -lyaml-cpp "${tree[@]}"
target table -lyaml-cpp "${files[@]}"
structures=(src/structure/{pdb_file,pdb_sites,structure_file,structure_residues,atom_masses,residue_names,no_gemmi}.cpp)
target pdb -lyaml-cpp "${files[@]}" "${structures[@]}"
target fasta -lyaml-cpp "${files[@]}" src/structure/fasta.cpp src/structure/residue_names.cpp src/structure/residue_table.cpp
target residues -lyaml-cpp "${files[@]}" src/structure/residue_table.cpp
target xml -lyaml-cpp "${tree[@]}" src/systems/xml_scan.cpp
domains=(src/domains/{assembly,confident_domains,domain_file,predicted_error,range_forms,residue_numbers,rigid_entry}.cpp src/keys/chain_keys.cpp)
target dcd -lyaml-cpp "${tree[@]}" src/frames/dcd_file.cpp
target domains -lyaml-cpp "${files[@]}" "${domains[@]}"
target pae -lyaml-cpp "${files[@]}" "${domains[@]}"
target settings -lyaml-cpp "${files[@]}" "${structures[@]}" src/systems/{pdb_topology,xml_scan}.cpp src/io/output_file.cpp \
    src/foreign/{calvados_charges,calvados_checks,calvados_components,calvados_folder,calvados_forces,calvados_keys,calvados_networks,calvados_pull,calvados_tables,contents,no_polychrom_arguments,package_file,scene_text,settings,system_text}.cpp \
    src/structure/{calvados2,fasta,residue_table}.cpp src/scene/scene.cpp
if [ -d "$hdf5" ]; then
    target bodies '-lyaml-cpp -lhdf5_serial' "${files[@]}" "${read_hdf5[@]}" src/bodies/{body_datasets,hdf5_bodies,hdf5_table,hdf5_texts,physics,joint_entry}.cpp src/keys/*_keys.cpp src/scene/{branches,freedom,loop_motions,loops,pose}.cpp \
        src/io/{memory_limit,trial}.cpp
    target checkpoint -lhdf5_serial "${read_hdf5[@]}" src/io/{checkpoint,checkpoint_file,file_seal,hdf5_data,trial}.cpp
else
    echo "LEFT OUT: bodies and checkpoint, no serial HDF5 (apt-get install libhdf5-dev)"
fi
if [ -n "$openmm" ]; then
    target system "-lyaml-cpp -L$openmm/lib -lOpenMM -Wl,-rpath,$PWD/$openmm/lib" "${tree[@]}" src/systems/{xml_scan,read_xml}.cpp src/io/memory_limit.cpp
else
    echo "LEFT OUT: system, no OpenMM in build/venv"
fi

# pack FOLDER: the system's C library stays the system's.
pack() {
    local name
    mkdir -p "$1/lib"
    cp -r "$made/targets/." tests/fuzz/campaign.sh "$1/"
    for name in "$made"/targets/*; do
        [ -f "$name" ] || continue
        strip -g "$1/$(basename "$name")"
        ldd "$name" | sed -n 's/.*=> \(\/[^ ]*\) .*/\1/p' | grep -vE '/lib(c|m|dl|pthread|rt|resolv|nss_[a-z]*)\.so|/ld-linux' | xargs -I{} cp -L -n {} "$1/lib/"
    done
    du -sh "$1"
}

if [ -n "$pack" ]; then pack "$pack"; exit; fi
read -r -a names <<<"${only//,/ }"
exec tests/fuzz/campaign.sh --targets "$made/targets" --work "$made/work" --seconds "$seconds" --jobs "$jobs" "${names[@]}"
