#!/usr/bin/env python3
"""Counts the sources that name what varies (force terms, integrators) outside its home, and fails above the bound reached.

What varies has one home: src/terms has force terms, src/integrate/joint_programs.cpp and src/scene/integrator.hpp have integrators.
Other code asks all of them for their properties. The oracles are independent and count nowhere.
usage: homes.py [ROOT]
"""
import os
import re
import subprocess
import sys

HOMES = ("src/terms/", "src/oracle/", "src/keys/", "src/scene/scene.hpp", "src/scene/integrator.hpp",
         "src/foreign/", "src/systems/")  # These two read force fields of others, whose bonds are no joints.
# What names it, and the most files that may.
NAMES = {
    "gravity": (r"forces\.gravity|given_?\.gravity|Gravity\b", 18),
    "joint springs": (r"\.stiffness\b|\.springs\b|JointSpring\b", 16),
    "joint dampers": (r"\.damping\b|\.dampers\b|JointDamper\b", 8),
    "wrenches": (r"\.wrench\b|wrench_force\b|wrench_torque\b|\.wrenches\b", 17),
    "drag": (r"\.drag\b|(linear|angular)_drag\b|\.dragged\b|Drag\b", 1),
    "constant forces": (r"\bConstantForce\b|constant_forces?\b", 0),
    "Fixman potential": (r"\.fixman\b|FixmanTerm\b", 10),
    "integrators": (r"Integrator::[a-z]", 12),
    "integrators in the dynamics": (r"Integrator::[a-z]|runge_kutta|verlet|dormand|leapfrog|baoab", 0),
}
# Functions of interfaces, and the most there may be.
FUNCTIONS = {
    ("virtual functions of JointDynamics", "src/dynamics/joint/joint_dynamics.hpp"): (r"^    virtual ", 28),
}


def sources(root):
    listed = subprocess.run(["git", "-C", root, "ls-files", "src", "cuda", "mpi"], capture_output=True, text=True, check=True).stdout.split()
    return [path for path in listed if re.search(r"\.(cpp|hpp|cu|cuh)$", path) and not path.startswith(HOMES)]


def counts(root):
    texts = {}
    for path in sources(root):
        with open(os.path.join(root, path), encoding="utf-8") as file:
            texts[path] = re.sub(r"//.*", "", file.read())
    for name, (pattern, most) in NAMES.items():
        among = {path: text for path, text in texts.items() if "dynamics" not in name or path.startswith("src/dynamics/")}
        yield name, most, sorted(path for path, text in among.items() if re.search(pattern, text))
    for (name, path), (pattern, most) in FUNCTIONS.items():
        yield name, most, re.findall(pattern, texts.get(path, ""), re.M)


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    bad = False
    for name, most, found in counts(root):
        print(f"{name}: {len(found)} of at most {most}")
        if len(found) > most:
            bad = True
            print("    " + ", ".join(found))
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
