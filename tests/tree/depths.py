#!/usr/bin/env python3
"""Prints the depth of the solver's trees for branched chains of many shapes and sizes, as `catena plan` states it.

usage: depths.py --catena PROGRAM [--sizes EXPONENT ...] [--check]

Chains have about 2^EXPONENT beads. The rows are those of src/dca/README.md, "Branched chains".
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "src", "dca", "README.md")
SIZES = [10, 13, 16, 17]
SHAPES = {
    "dendrimer": lambda e: f"dendrimer: {{generations: {e - 1}",
    "dendrimer, spacers of 8": lambda e: f"dendrimer: {{generations: {e - 4}, spacer: 8",
    "random tree": lambda e: f"random_tree: {{beads: {2**e}, seed: 1",
    "star of arms as long as they are many": lambda e: f"star: {{arms: {2**(e // 2)}, arm_length: {2**(e - e // 2)}",
    "star of single beads": lambda e: f"star: {{arms: {2**e}, arm_length: 1",
    "brush, side chains of 5": lambda e: f"brush: {{backbone: {2**e // 6}, side_length: 5",
    "brush, single beads (RNA)": lambda e: f"brush: {{backbone: {2**e // 2}, side_length: 1",
}


def depth(catena, generator, folder):
    """Depth in the solver's plan for one chain that a generator makes."""
    scene = os.path.join(folder, "scene.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(f"chains: [{{generator: {{{generator}, length: 0.4, excluded: 0}}}}}}]\n")
    answer = subprocess.run([catena, "plan", scene, "--backend", "segments", "--json", "-"], capture_output=True, text=True, check=False)
    if answer.returncode != 0:
        sys.exit(f"depths.py: {answer.stderr.strip() or answer.stdout.strip()}")
    return json.loads(answer.stdout)["groups"][0]["depth"]


def print_table(catena, sizes, folder):
    """The table of the page."""
    print("| chain | " + " | ".join(f"2^{e}" for e in sizes) + " |")
    print("| --- |" + " ---: |" * len(sizes))
    for name, generator in SHAPES.items():
        print(f"| {name} | " + " | ".join(str(depth(catena, generator(e), folder)) for e in sizes) + " |", flush=True)


def check(catena, folder):
    """Whether the page has the depths of the smallest chains."""
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    wrong = 0
    for name, generator in SHAPES.items():
        row = f"| {name} | {depth(catena, generator(SIZES[0]), folder)} |"
        if row not in page:
            print(f"{PAGE}: no row begins with '{row}'")
            wrong += 1
    return 1 if wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--catena", required=True, help="the program")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES, metavar="EXPONENT", help="sizes as powers of two (default: 10 13 16 17)")
    parser.add_argument("--check", action="store_true", help="compare the first column with the page instead")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix=f"catena-depths-{os.getpid()}-") as folder:
        if options.check:
            return check(options.catena, folder)
        print_table(options.catena, options.sizes, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
