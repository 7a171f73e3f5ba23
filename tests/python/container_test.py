#!/usr/bin/env python3
"""Recipes of containers without Apptainer: each has the sections that it needs, its %post is a shell script that starts jobs/container.sh,
and its PATH is where that builds. jobs/container.sh itself runs on a copy of jobs/, with stand-ins for cmake, Python and Debian's packages.

Exit status 0: all as it should be; 1: not."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
RECIPES = {"catena.def": ("cpu", "release"), "catena-cuda.def": ("cuda", "cuda")}
PYTHON = '#!/bin/sh\necho "python $*" >>"$LOG"\n[ "$2" != venv ] || { mkdir -p "$4/bin"; cp "$0" "$4/bin/python"; }\necho "Version: 8.6.1"\n'
CMAKE = ('#!/bin/sh\necho "cmake $*" >>"$LOG"\n[ "$1" != --build ] || { mkdir -p "build/$3"; touch "build/$3/x.o"; '
         'printf "#!/bin/sh\\necho built\\n" >"build/$3/catena"; chmod +x "build/$3/catena"; }\n')
STAND_INS = {"cmake": CMAKE, "python3": PYTHON, "dpkg-query": "#!/bin/sh\necho installed\n"}


def sections(recipe):
    """Text of each section by its name, that of the header under an empty one."""
    with open(os.path.join(ROOT, "jobs", recipe), encoding="utf-8") as file:
        parts = re.split(r"^%(\w+)\n", file.read(), flags=re.M)
    return dict(zip([""] + parts[1::2], [parts[0]] + parts[2::2]))


def faults_of_recipe(recipe, kind, preset):
    found = sections(recipe)
    if not re.fullmatch(r"Bootstrap: docker\nFrom: \S+:\S+\n\n", found[""]):
        yield f"{recipe}: its header names no image: {found['']}"
    for name in ("files", "post", "environment", "runscript", "test"):
        if name not in found:
            yield f"{recipe}: there is no section {name}"
    for name in ("post", "environment", "runscript", "test"):
        if subprocess.run(["sh", "-n"], input=found[name], text=True, check=False).returncode != 0:
            yield f"{recipe}: its {name} is no shell script"
    if f"bash catena/jobs/container.sh {kind}" not in found["post"]:
        yield f"{recipe}: it does not build {kind}"
    if f"PATH=/opt/catena/build/{preset}:" not in found["environment"] or f"build/{preset}/catena check" not in found["test"]:
        yield f"{recipe}: its program is not that of build/{preset}"


def build(folder, *words):
    """jobs/container.sh in a copy; its answer, and what was asked of the stand-ins."""
    copy, log = os.path.join(folder, "catena"), os.path.join(folder, "log")
    os.makedirs(os.path.join(folder, "bin"))
    shutil.copytree(os.path.join(ROOT, "jobs"), os.path.join(copy, "jobs"))
    for name, text in STAND_INS.items():
        path = os.path.join(folder, "bin", name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(path, 0o755)
    environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}", "LOG": log}
    done = subprocess.run(["bash", os.path.join(copy, "jobs", "container.sh"), *words], env=environment, capture_output=True, text=True, check=False)
    asked = open(log, encoding="utf-8").read() if os.path.exists(log) else ""
    objects = [name for _, _, names in os.walk(os.path.join(copy, "build")) for name in names if name.endswith(".o")]
    return done, asked, objects


def faults_of_build(parent):
    for words, preset, option in ((["cpu"], "release", "-DCATENA_WITH_CUDA=OFF"), (["cuda", "80"], "cuda", "-DCATENA_CUDA_ARCHITECTURES=80")):
        done, asked, objects = build(os.path.join(parent, preset), *words)
        if done.returncode != 0 or "built" not in done.stdout or f"cmake --preset {preset} {option}" not in asked or objects:
            yield f"{words}: status {done.returncode}, {objects}: {done.stdout}{done.stderr}{asked}"
    done, asked, _ = build(os.path.join(parent, "wrong"), "gpu")
    if done.returncode != 2 or asked:
        yield f"an unknown kind is not refused: {done.stdout}{done.stderr}"


with tempfile.TemporaryDirectory() as place:
    faults = [fault for recipe, what in RECIPES.items() for fault in faults_of_recipe(recipe, *what)] + list(faults_of_build(place))
print("\n".join(faults) if faults else "passed")
sys.exit(1 if faults else 0)
