#!/usr/bin/env bash
# Fills a folder with the peers of `catena bench peers` for an x86-64 machine without a network (Ubuntu 24.04, its Python 3.12): Pinocchio,
# MuJoCo and numpy from PyPI, less what the peers do not load, and peer-simbody with its libraries from this build.
# usage: tests/bench/peers/carry.sh [--without-numpy] FOLDER [BUILD [PYTHON_VERSION]]     then there, where catena stands in its build folder:
#   mkdir -p tests/bench && cp FOLDER/simbody/peer-simbody tests/bench/
#   export LD_LIBRARY_PATH=FOLDER/simbody PYTHONPATH=FOLDER/python:FOLDER/python/cmeel.prefix/lib/python3.12/site-packages
set -euo pipefail
numpy=yes
if [ "${1:-}" = --without-numpy ]; then numpy=no; shift; fi
[ $# -ge 1 ] || { sed -n '2,6s/^# //p' "$0"; exit 2; }
folder=$1
build=${2:-build/release}
version_of_python=${3:-3.12}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=$folder/python
mkdir -p "$python" "$folder/simbody"

platforms=()
for version in _2_28 _2_27 _2_17 2014; do platforms+=(--platform "manylinux${version}_x86_64"); done
grep -E '^(pin|mujoco)==' "$here/requirements.txt" >"$folder/requirements.txt"
python3 -m pip install -q --disable-pip-version-check --no-compile --upgrade --target "$python" --only-binary=:all: \
    --python-version "$version_of_python" --implementation cp "${platforms[@]}" -r "$folder/requirements.txt"

if [ $numpy = no ]; then rm -rf "$python"/numpy "$python"/numpy.libs "$python"/numpy-*; fi

# Libraries that neither Python modules nor libraries kept ask for, headers, documents and tests stay behind.
python3 - "$python" <<'P'
import os
import re
import shutil
import subprocess
import sys

root = sys.argv[1]
library = os.path.join(root, "cmeel.prefix", "lib")
for name in os.listdir(os.path.join(root, "cmeel.prefix")):
    if name != "lib":
        shutil.rmtree(os.path.join(root, "cmeel.prefix", name))
for folder, names, files in os.walk(root):
    for name in [n for n in names if n in ("tests", "include", "cmake", "pkgconfig", "static", "f2py", "doc", "studio", "OpenGL", "websockets") or n.startswith("bin")]:
        shutil.rmtree(os.path.join(folder, name))
        names.remove(name)
    for name in files:
        if name.endswith((".a", ".pyi", ".h", ".hpp")):
            os.remove(os.path.join(folder, name))


def needed(file):
    text = subprocess.run(["readelf", "-d", file], capture_output=True, text=True).stdout
    return re.findall(r"\(NEEDED\).*\[(.*)\]", text)


modules = [os.path.join(f, n) for f, _, names in os.walk(root) for n in names if f != library and ".so" in n and os.path.isfile(os.path.join(f, n))]
modules = [m for m in modules if not re.search(r"pinocchio_pywrap_(?!default)", m)]
kept, asked = set(), modules
while asked:
    asked = {n for file in asked for n in needed(file)} - kept
    kept |= asked
    asked = [os.path.join(library, n) for n in asked if os.path.exists(os.path.join(library, n))]
for folder, _, names in os.walk(root):
    for name in names:
        path = os.path.join(folder, name)
        if (folder == library and name not in kept) or re.search(r"pinocchio_pywrap_(?!default)", name):
            os.remove(path)
P

cp "$build/tests/bench/peer-simbody" "$folder/simbody/"
ldd "$build/tests/bench/peer-simbody" | awk '/SimTK|blas|lapack|gfortran|quadmath/ {print $3}' | xargs cp -L -t "$folder/simbody"
du -sh "$folder"
tar -C "$folder" -c . | xz -T0 | wc -c | awk '{printf "%.1f MiB packed by xz\n", $1 / 1048576}'
