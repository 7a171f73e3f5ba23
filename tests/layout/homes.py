#!/usr/bin/env python3
"""Counts the sources that name what varies (force terms, integrators) outside its home, and fails above the bound reached.
Measures every class and fails if one is too large.

What varies has one home: src/terms has force terms, src/integrate/joint_programs.cpp and src/scene/integrator.hpp have integrators.
Other code asks all of them for their properties. The oracles are independent and count nowhere, nor does what other tools name (src/foreign).
usage: homes.py [ROOT]
"""
import os
import re
import subprocess
import sys

HOMES = ("src/terms/", "src/oracle/", "src/keys/", "src/scene/scene.hpp", "src/scene/integrator.hpp",
         "src/foreign/", "src/systems/", "src/plugin/")  # These have force fields and integrators of others.
# What names it, and the most files that may.
NAMES = {
    "gravity": (r"forces\.gravity|given_?\.gravity|Gravity\b", 19),
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
    ("virtual functions of JointDynamics", "src/dynamics/joint/joint_dynamics.hpp"): (r"^    virtual ", 12),
}
# The most lines and data members of a class outside tests.
LINES, MEMBERS = 250, 20
HEAD = re.compile(r"\b(?:class|struct)\s+([A-Za-z_]\w*)(?:<[^;{}()]*>)?\s*(?:final\s*)?(?::[^;{}]*)?\{")
NO_MEMBER = re.compile(r"(using|typedef|friend|static|template|enum|class|struct|union|constexpr|requires|virtual|explicit|CATENA_HD)\b")


def sources(root):
    listed = subprocess.run(["git", "-C", root, "ls-files", "src", "cuda", "mpi"], capture_output=True, text=True, check=True).stdout.split()
    paths = [path for path in listed if re.search(r"\.(cpp|hpp|cu|cuh)$", path)]
    return {path: open(os.path.join(root, path), encoding="utf-8").read() for path in paths}


def blank(text):
    """The text without comments, literals and preprocessor lines; its line breaks stay."""
    def spaces(match):
        return re.sub(r"[^\n]", " ", match.group())
    text = re.sub(r"//[^\n]*|/\*.*?\*/", spaces, text, flags=re.S)
    text = re.sub(r'"(\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(\\.|[^\'\\\n])+\'', "0", text)
    return re.sub(r"^[ \t]*#[^\n]*", spaces, text, flags=re.M)


def body_at(text, brace):
    """What stands between the brace at this place and its partner, and the same without what stands in inner braces."""
    depth, flat = 0, []
    for at in range(brace, len(text)):
        depth += (text[at] == "{") - (text[at] == "}")
        if depth == 0:
            return text[brace + 1:at], "".join(flat)
        if depth == 1 and at > brace or depth == 2 and text[at] == "{":
            flat.append(text[at])
    return text[brace + 1:], "".join(flat)


def innermost_removed(text, pattern):
    while re.search(pattern, text):
        text = re.sub(pattern, "", text)
    return text


def members_of(flat):
    """The number of data members in the outer level of a class."""
    count = 0
    for part in re.sub(r"\b(public|private|protected)\s*:", "", flat).split(";"):
        part = innermost_removed(part, r"<[^<>]*>")
        part = re.split(r"\{\}(?=\s*[^\s,={])", part)[-1].strip()  # What precedes are definitions of functions.
        declared = re.sub(r"\{\}", "", part)
        if NO_MEMBER.match(declared) or "(" in declared.split("=")[0] or len(declared.split()) < 2:
            continue
        count += len(innermost_removed(declared, r"\([^()]*\)").split(","))
    return count


def classes(texts):
    """File, name, lines and data members of every class."""
    for path, text in texts.items():
        text = blank(text)
        for head in HEAD.finditer(text):
            if not re.search(r"enum\s*$", text[:head.start()]):
                body, flat = body_at(text, head.end() - 1)
                yield path, head.group(1), head.group().count("\n") + body.count("\n") + 1, members_of(flat)


def too_large(texts):
    """One line per class above its bounds."""
    for path, name, lines, members in classes(texts):
        if lines > LINES or members > MEMBERS:
            yield f"{path}: class {name} has {lines} lines and {members} data members; split it"


def counts(texts):
    texts = {path: re.sub(r"//.*", "", text) for path, text in texts.items() if not path.startswith(HOMES)}
    for name, (pattern, most) in NAMES.items():
        among = {path: text for path, text in texts.items() if "dynamics" not in name or path.startswith("src/dynamics/")}
        yield name, most, sorted(path for path, text in among.items() if re.search(pattern, text))
    for (name, path), (pattern, most) in FUNCTIONS.items():
        yield name, most, re.findall(pattern, texts.get(path, ""), re.M)


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    texts = sources(root)
    bad = False
    for name, most, found in counts(texts):
        print(f"{name}: {len(found)} of at most {most}")
        if len(found) > most:
            bad = True
            print("    " + ", ".join(found))
    large = list(too_large(texts))
    print(f"classes above {LINES} lines or {MEMBERS} data members: {len(large)}")
    for line in large:
        bad = True
        print("    " + line)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
