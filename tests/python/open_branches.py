#!/usr/bin/env python3
"""A user's whole way with branched chains: check, run, restart, topology, analysis, picture.

usage: open_branches.py CATENA PLOT. MDAnalysis and h5py must see the bonds that the scene says. Exit status 0: all as it should be; 1: not;
77: skipped, a package is missing."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py
    import matplotlib
    import MDAnalysis
    import numpy as np
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install MDAnalysis h5py matplotlib)")
    sys.exit(77)

SCENE = """
title: branched chains
chains:
  - {{name: star, generator: {{star: {{arms: 5, arm_length: 3, length: 0.5, mass: 100}}}}}}
  - {{name: brush, generator: {{brush: {{backbone: 8, side_length: 2, every: 2, length: 0.5, mass: 100}}}}, count: 2}}
  - {{name: dendrimer, generator: {{dendrimer: {{generations: 2, spacer: 1, length: 0.5, mass: 100}}}}}}
  - {{name: tree, generator: {{random_tree: {{beads: 30, length: 0.5, mass: 100, seed: 3}}}}}}
  - {{name: line, generator: {{freely_jointed: {{beads: 10, length: 0.5, mass: 100}}}}}}
dynamics: {{integrator: {integrator}, step: 0.01, steps: 200, temperature: 300, friction: 0.1, seed: 2}}
solver: {{backend: {backend}}}
output: {{every: 20, checkpoint_every: 100}}
"""
LINK = 0.5


def check(condition, message):
    if not condition:
        raise SystemExit(f"FAILED: {message}")


def catena(*arguments):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True)
    check(done.returncode == 0, f"{' '.join(arguments)}: {done.stdout}{done.stderr}")
    return done.stdout


def star(arms, length):
    inboard = [-1]
    for _ in range(arms):
        for j in range(length):
            inboard.append(0 if j == 0 else len(inboard) - 1)
    return inboard


def brush(backbone, side, every):
    inboard = list(range(-1, backbone - 1))
    for k in range(0, backbone, every):
        for j in range(side):
            inboard.append(k if j == 0 else len(inboard) - 1)
    return inboard


def expected(trees):
    """Bonds of the scene, by sites from 0. `trees`: the random tree's inboard beads."""
    bonds, first = set(), 0
    dendrimer = [-1, 0, 1, 0, 3, 0, 5, 2, 7, 2, 9, 4, 11, 4, 13, 6, 15, 6, 17]
    for inboard in (star(5, 3), brush(8, 2, 2), brush(8, 2, 2), dendrimer, trees, list(range(-1, 9))):
        bonds |= {(first + on, first + k) for k, on in enumerate(inboard) if on >= 0}
        first += len(inboard)
    return bonds, first


def look_at_topology(folder):
    trajectory = os.path.join(folder, "trajectory.h5md")
    with h5py.File(trajectory) as file:
        parent, chains = file["catena/parent"][:], file["catena/chains"]
        begin = chains["first"][4]
        bonds, sites = expected(list(parent[begin:begin + 30]))
        connected = file["connectivity/bonds"]
        check({tuple(pair) for pair in connected[:] - 1} == bonds, "bonds of H5MD")
        check(file[connected.attrs["particles_group"]] == file["particles/trajectory"], "the group that the bonds refer to")
        position = file["particles/trajectory/position/value"][:]
        pairs = np.array(sorted(bonds))
        lengths = np.linalg.norm(position[:, pairs[:, 1]] - position[:, pairs[:, 0]], axis=2)
        check(np.abs(lengths - LINK).max() < 1e-9, f"links deviate by {np.abs(lengths - LINK).max()}")
    for topology in ("topology.psf", "topology.pdb"):
        universe = MDAnalysis.Universe(os.path.join(folder, topology), trajectory)
        check(len(universe.atoms) == sites, f"{topology}: {len(universe.atoms)} sites")
        check({tuple(sorted(pair)) for pair in universe.bonds.indices} == bonds, f"{topology}: bonds differ")
    check(len(universe.atoms.fragments) == 6, f"{len(universe.atoms.fragments)} fragments")
    return position


def look_at_numbers(folder):
    with open(os.path.join(folder, "observables.csv")) as file:
        columns = file.readline()
    check("radius_of_gyration_star" in columns and "end_to_end_distance_line" in columns, columns)
    check("end_to_end_distance_star" not in columns, columns)
    report = os.path.join(folder, "analysis.json")
    told = catena("analyse", folder, "--json", report)
    check("star is branched" in told, told)
    with open(report) as file:
        quantities = {(q["name"], q["chains"]) for q in json.load(file)["quantities"]}
    check(("radius_of_gyration", "star") in quantities and ("scaling_exponent", "line") in quantities, f"{quantities}")
    check(not any(name in ("scaling_exponent", "end_to_end_distance", "bond_length") and kind != "line" for name, kind in quantities),
          f"{quantities}")


def restart_is_the_same(scene, whole, folder):
    part = os.path.join(folder, "part")
    catena("run", scene, "--output", part, "--steps", "100", "--quiet")
    catena("run", scene, "--output", part, "--restart", os.path.join(part, "checkpoint.h5"), "--quiet")
    with h5py.File(os.path.join(part, "trajectory.h5md")) as file:
        check(np.array_equal(file["particles/trajectory/position/value"][:], whole), "a restart changes positions")


def starts_from_a_frame(scene, frame, whole, folder):
    """A run that starts from the last frame of another one has its positions, with links fitted along the branches."""
    output = os.path.join(folder, "again")
    catena("run", scene, "--output", output, "--quiet", "--steps", "0", "--set", f"start={{from: {frame}}}")
    with h5py.File(os.path.join(output, "trajectory.h5md")) as file:
        check(np.abs(file["particles/trajectory/position/value"][0] - whole[-1]).max() < 1e-9, "a frame as start changes positions")


def damaged_branches_are_refused(output, folder):
    damaged = shutil.copytree(output, os.path.join(folder, "damaged"))
    with h5py.File(os.path.join(damaged, "trajectory.h5md"), "r+") as file:
        file["catena/parent"][5] = 9
    done = subprocess.run([PROGRAM, "analyse", damaged], capture_output=True, text=True)
    check(done.returncode == 2 and "the branches of its chains do not fit its sites" in done.stderr, f"{done.returncode}: {done.stderr}")


def main():
    with tempfile.TemporaryDirectory(prefix=f"catena-branches-{os.getpid()}-") as folder:
        for integrator, backend in (("g-baoab", "segments"), ("rattle", "serial"), ("g-baoab", "openmp")):
            scene = os.path.join(folder, f"{integrator}-{backend}.yaml")
            with open(scene, "w") as file:
                file.write(SCENE.format(integrator=integrator, backend=backend))
            check("branched" in catena("check", scene), "check does not tell branched chains")
            output = os.path.join(folder, f"out-{integrator}-{backend}")
            catena("run", scene, "--output", output, "--quiet")
            positions = look_at_topology(output)
            if backend == "segments":
                restart_is_the_same(scene, positions, folder)
                starts_from_a_frame(scene, output, positions, folder)
                look_at_numbers(output)
                subprocess.run([sys.executable, PLOT, output], check=True, capture_output=True)
                check(os.path.getsize(os.path.join(output, "picture.png")) > 10000, "the picture is empty")
                damaged_branches_are_refused(output, folder)
    print("check, run, restart, topologies, analysis and picture of branched chains are as they should be")


PROGRAM, PLOT = sys.argv[1:3]
main()
