#!/usr/bin/env python3
"""A user's whole way with cross-links: check, plan, solve, run, restart, topology, replicas, a constrained System, the scene of inputs/.

usage: open_crosslinks.py CATENA INPUTS [--openmm]. Exit status 0: all as it should be; 1: not; 77: skipped, a package is missing."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py
    import MDAnalysis
    import numpy as np
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install MDAnalysis h5py)")
    sys.exit(77)

SCENE = """
title: cross-linked chains
chains:
  - {{name: ring, generator: {{freely_jointed: {{beads: 30, length: 0.5, mass: 100}}}}, crosslinks: [[1, 30, 0.5], [5, 20, 0.6]]}}
  - {{name: star, generator: {{star: {{arms: 4, arm_length: 4, length: 0.5, mass: 100}}}}, crosslinks: {crosslinks}, count: 2}}
  - {{name: line, generator: {{freely_jointed: {{beads: 10, length: 0.5, mass: 100}}}}}}
dynamics: {{integrator: {integrator}, step: 0.01, steps: 200, temperature: 300, friction: 0.1, seed: 2}}
solver: {{backend: {backend}}}
output: {{every: 20, checkpoint_every: 100}}
"""
CROSSLINKS = {(0, 29): 0.5, (4, 19): 0.6, (34, 38): 0.7, (51, 55): 0.7}  # by sites from 0


def check(condition, message):
    if not condition:
        raise SystemExit(f"FAILED: {message}")


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True)


def catena(*arguments):
    done = run(*arguments)
    check(done.returncode == 0, f"{' '.join(arguments)}: {done.stdout}{done.stderr}")
    return done.stdout


def refused(text, *arguments):
    done = run(*arguments)
    check(done.returncode == 2 and text in done.stderr and done.stderr.count("\n") == 1, f"{text}: {done.returncode} {done.stderr}")


def write(folder, name, **words):
    scene = os.path.join(folder, name + ".yaml")
    with open(scene, "w") as file:
        file.write(SCENE.format(**({"integrator": "g-baoab", "backend": "segments", "crosslinks": "[[5, 9, 0.7]]"} | words)))
    return scene


def look_at_topology(folder):
    trajectory = os.path.join(folder, "trajectory.h5md")
    with h5py.File(trajectory) as file:
        position = file["particles/trajectory/position/value"][:]
        bonds = {tuple(sorted(pair)) for pair in file["connectivity/bonds"][:] - 1}
        check(list(file["catena/crosslinks"][:]) == [site for pair in CROSSLINKS for site in pair], "catena/crosslinks")
    check(len(bonds) == 29 + 2 * 16 + 9 + 4 and bonds >= set(CROSSLINKS), f"bonds of H5MD: {sorted(bonds)}")
    for (a, b), length in CROSSLINKS.items():
        off = np.abs(np.linalg.norm(position[:, a] - position[:, b], axis=1) - length).max()
        check(off < 1e-9, f"cross-link {a}-{b} deviates by {off}")
    for topology in ("topology.psf", "topology.pdb"):
        universe = MDAnalysis.Universe(os.path.join(folder, topology), trajectory)
        check({tuple(sorted(pair)) for pair in universe.bonds.indices} == bonds, f"{topology}: bonds differ")
    return position


def restarts_are_the_same(scene, whole, folder):
    part = os.path.join(folder, "part")
    catena("run", scene, "--output", part, "--steps", "100", "--quiet")
    other = write(folder, "other", crosslinks="[[5, 10, 0.7]]")
    refused("", "run", other, "--output", os.path.join(folder, "other"), "--restart", os.path.join(part, "checkpoint.h5"), "--quiet")
    catena("run", scene, "--output", part, "--restart", os.path.join(part, "checkpoint.h5"), "--quiet")
    with h5py.File(os.path.join(part, "trajectory.h5md")) as file:
        check(np.array_equal(file["particles/trajectory/position/value"][:], whole), "a restart changes positions")


def starts_from_a_frame(scene, frame, whole, folder):
    output = os.path.join(folder, "again")
    catena("run", scene, "--output", output, "--quiet", "--steps", "0", "--set", f"start={{from: {frame}}}")
    with h5py.File(os.path.join(output, "trajectory.h5md")) as file:
        check(np.abs(file["particles/trajectory/position/value"][0] - whole[-1]).max() < 1e-9, "a frame as start changes positions")
    starts_from_a_frame_without_its_crosslinks(frame, folder)
    reordered = write(folder, "reordered")  # the order of the list does not count
    with open(reordered) as file:
        text = file.read().replace("[[1, 30, 0.5], [5, 20, 0.6]]", "[[20, 5, 0.6], [30, 1, 0.5]]")
    with open(reordered, "w") as file:
        file.write(text)
    told = catena("check", reordered, "--set", f"start={{from: {frame}}}")
    check("to close cross-links" not in told, f"a note tells of the start that the frame replaces: {told}")


def starts_from_a_frame_without_its_crosslinks(frame, folder):
    """Lengths come from the scene, whose beads are pulled together; a length that the frame's run did not hold is not taken from it."""
    other = write(folder, "another", crosslinks="[[5, 10, 1.9], [5, 9]]")
    start = ("--set", f"start={{from: {frame}}}")
    output = os.path.join(folder, "pulled")
    told = catena("run", other, "--output", output, "--steps", "0", *start)
    check("2 of 4 chains have other cross-links in" in told and "`star-1`, has 1 there and 2 here" in told, told)
    with h5py.File(os.path.join(output, "trajectory.h5md")) as file:
        x = file["particles/trajectory/position/value"][0]
    for a, b, length in ((34, 38, 0.7), (34, 39, 1.9)):
        check(abs(np.linalg.norm(x[a] - x[b]) - length) < 1e-9, f"cross-link {a}-{b}: {np.linalg.norm(x[a] - x[b])}")
    missing = write(folder, "missing", crosslinks="[[5, 10]]")
    refused("the cross-link of beads 5 and 10 has no length, and `", "check", missing, *start)
    catena("check", write(folder, "fewer", crosslinks="[]"), *start)


def open_lengths_are_those_of_the_frame(folder):
    """A cross-link without a length takes the distance of the frame, not that of the written positions, which the frame replaces."""
    def bent(name, fold, crosslinks):
        scene = os.path.join(folder, name + ".yaml")
        places = [[0, 0, 0], [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, fold]]
        bodies = ", ".join(f"{{mass: 100, position: {p}{', joint: {type: link, length: 0.5}' if k else ''}}}" for k, p in enumerate(places))
        with open(scene, "w") as file:
            file.write(f"chains: [{{name: bent, bodies: [{bodies}], crosslinks: {crosslinks}}}]\n"
                       "dynamics: {integrator: g-baoab, step: 0.01, steps: 50, temperature: 300, friction: 0.1, seed: 2}\noutput: {every: 50}\n")
        return scene

    first, again = os.path.join(folder, "bent"), os.path.join(folder, "bent-again")
    catena("run", bent("bent", 0.1, "[[1, 4], [2, 4]]"), "--output", first, "--quiet")
    other = bent("other-bend", 0.2, "[[4, 2], [1, 4]]")
    catena("run", other, "--output", again, "--quiet", "--steps", "0", "--set", f"start={{from: {first}/trajectory.h5md}}")
    ends = []
    for folder_of, frame in ((first, -1), (again, 0)):
        with h5py.File(os.path.join(folder_of, "trajectory.h5md")) as file:
            ends.append(file["particles/trajectory/position/value"][frame])
    check(np.abs(ends[0] - ends[1]).max() < 1e-9, f"an open length moves the frame's beads: {ends}")


def damaged_crosslinks_are_refused(output, folder):
    damaged = shutil.copytree(output, os.path.join(folder, "damaged"))
    with h5py.File(os.path.join(damaged, "trajectory.h5md"), "r+") as file:
        file["catena/crosslinks"][1] = 31
    refused("its cross-links do not fit its chains", "analyse", damaged)


def analyses_name_cross_linked_chains(output, folder):
    told = catena("analyse", output, "--output", os.path.join(folder, "analysis"))
    check("ring is cross-linked: internal distances and bonds follow the chain" in told and told.count("is cross-linked") == 1, told)


def numbers_are_told(scene, folder):
    check("beads with 2 cross-links" in catena("check", scene), "check does not tell cross-links")
    plan = catena("plan", scene)
    check("cross-linked chains of" in plan and "up to 2 a chain" in plan, plan)
    launch = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "3", PROGRAM]
    if shutil.which("mpirun") and "MPI " in catena("--version"):  # rank 0 has one of the three chains
        on_ranks = subprocess.run([*launch, "plan", scene], capture_output=True, text=True).stdout
        check("cross-linked chains of" in on_ranks and "4, up to 2 a chain" in on_ranks, on_ranks)
    told = os.path.join(folder, "solution.json")
    catena("solve", scene, "--json", told)
    with open(told) as file:
        solution = json.load(file)
    check([each["beads"] for each in solution["crosslink_tensions"]] == [[1, 30], [5, 20], [5, 9], [5, 9]], "crosslink_tensions")
    check(solution["dof"] == 3 * (30 + 34 + 10) - (29 + 32 + 9) - 4, f"{solution['dof']} degrees of freedom")
    check(solution["residual"] < solution["residual_bound"], "residual")
    table = os.path.join(folder, "a.csv")
    catena("solve", scene, "--accelerations", table)
    with open(table) as file:
        rows = [line.split(",")[:3] for line in file if ",crosslink," in line]
    check(rows[0] == ["ring", "1-30", "crosslink"] and len(rows) == 4, f"{rows}")
    refused("cross-linked chains have projected handles only", "solve", scene, "--handles", "full")


def a_constrained_system_runs(folder):
    """A ring of constraints in a System becomes links and a cross-link."""
    import openmm
    from openmm import unit
    beads = 12
    system = openmm.System()
    angles = 2 * np.pi * np.arange(beads) / beads
    radius = 0.38 / (2 * np.sin(np.pi / beads))
    places = np.stack([radius * np.cos(angles), radius * np.sin(angles), 0.05 * (-1.0) ** np.arange(beads)], axis=1)
    length = float(np.linalg.norm(places[1] - places[0]))
    for k in range(beads):
        system.addParticle(57.05 * unit.dalton)
        system.addConstraint(k, (k + 1) % beads, length)
    pairs = openmm.CustomNonbondedForce("0.5*(0.4/r)^12")
    for k in range(beads):
        pairs.addParticle([])
        pairs.addExclusion(k, (k + 1) % beads)
    system.addForce(pairs)
    with open(os.path.join(folder, "ring.xml"), "w") as file:
        file.write(openmm.XmlSerializer.serialize(system))
    with open(os.path.join(folder, "ring.pdb"), "w") as file:
        for k, (x, y, z) in enumerate(10 * places):
            file.write(f"ATOM  {k + 1:5} CA   GLY A{k + 1:4}    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00\n")
        file.write("END\n")
    scene = os.path.join(folder, "ring.yaml")
    with open(scene, "w") as file:
        file.write("forces: {openmm: {system: ring.xml, topology: ring.pdb, platform: Reference}}\n"
                   "dynamics: {integrator: g-baoab, step: 0.01, steps: 500, temperature: 300, friction: 0.1, seed: 2}\noutput: {every: 50}\n")
    output = os.path.join(folder, "ring-run")
    told = catena("run", scene, "--output", output)
    check("1 constraint of chain A closes a cycle of links and becomes a cross-link" in told and "VALID" in told, told)
    with h5py.File(os.path.join(output, "trajectory.h5md")) as file:
        x = file["particles/trajectory/position/value"][:]
    check(np.abs(np.linalg.norm(x[:, 0] - x[:, -1], axis=1) - length).max() < 1e-9, "the ring opens")


def redundant_links_of_alike_chains_are_noted_once(folder):
    """Two chains of five beads with all ten constraints each, of which one is redundant."""
    import openmm
    from openmm import unit
    shape = np.array([[0, 0, 0], [0.3, 0.1, 0], [0.4, 0.4, 0.1], [0.1, 0.5, 0.3], [0.2, 0.2, 0.5]])
    system = openmm.System()
    lines = []
    for chain in "AB":
        first = system.getNumParticles()
        for k, place in enumerate(shape + (3 if chain == "B" else 0)):
            system.addParticle(57.05 * unit.dalton)
            lines.append(f"ATOM  {first + k + 1:5} CA   GLY {chain}{k + 1:4}    {10 * place[0]:8.3f}{10 * place[1]:8.3f}{10 * place[2]:8.3f}  1.00  0.00")
        lines.append("TER")
        for a in range(5):
            for b in range(a + 1, 5):
                system.addConstraint(first + a, first + b, float(np.linalg.norm(shape[a] - shape[b])))
    with open(os.path.join(folder, "rigid.xml"), "w") as file:
        file.write(openmm.XmlSerializer.serialize(system))
    with open(os.path.join(folder, "rigid.pdb"), "w") as file:
        file.write("\n".join([*lines, "END\n"]))
    scene = os.path.join(folder, "rigid.yaml")
    with open(scene, "w") as file:
        file.write("forces: {openmm: {system: rigid.xml, topology: rigid.pdb, platform: Reference}}\n")
    told = catena("check", scene)
    check(told.count("1 of the 10 links of chain `A` is redundant") == 1 and "chain `B`" not in told, told)


def a_frame_without_crosslinks_is_relaxed(folder):
    """Beads with forces that a frame has far apart are pulled together if the scene asks for it."""
    scene = os.path.join(folder, "bridge.yaml")
    with open(scene, "w") as file:
        file.write("chains: [{name: p, sequence: GSCEELRKGSKEELRCGS, model: calvados2}]\n"
                   "forces: {openmm: {builder: calvados2, ionic_strength: 0.15, ph: 7, platform: Reference}}\n"
                   "dynamics: {integrator: g-baoab, step: 0.01, steps: 100, temperature: 300, friction: 0.1, seed: 2}\noutput: {every: 50}\n")
    output = os.path.join(folder, "bridge-run")
    catena("run", scene, "--output", output, "--quiet")
    with open(scene) as file:
        bridged = file.read().replace("calvados2}]", "calvados2, crosslinks: [[3, 16, 0.55]]}]")
    scene = os.path.join(folder, "bridged.yaml")
    with open(scene, "w") as file:
        file.write(f"{bridged}start: {{from: {output}}}\n")
    refused("write `relax: true`, or give a frame that fits", "check", scene)
    told = catena("run", scene, "--output", os.path.join(folder, "bridged"), "--set", "relax=true")
    check("1 of 1 chains has other cross-links in" in told and "INVALID" not in told, told)


def the_protein_is_valid(inputs, folder):
    scene = os.path.join(inputs, "cross-linked.yaml")
    told = catena("check", scene)
    check("139 links replace the model's harmonic bonds of 0.38 nm, 3 more close loops" in told, told)
    told = catena("run", scene, "--steps", "500", "--output", os.path.join(folder, "protein"))
    check("INVALID" not in told and "VALID" in told, told)


def main():
    inputs, openmm = sys.argv[2], "--openmm" in sys.argv
    with tempfile.TemporaryDirectory(prefix=f"catena-crosslinks-{os.getpid()}-") as folder:
        for integrator, backend in (("g-baoab", "segments"), ("rattle", "serial"), ("g-baoab", "openmp")):
            scene = write(folder, f"{integrator}-{backend}", integrator=integrator, backend=backend)
            output = os.path.join(folder, f"out-{integrator}-{backend}")
            check("INVALID" not in catena("run", scene, "--output", output, "--quiet"), "a run is invalid")
            positions = look_at_topology(output)
            if backend == "segments":
                numbers_are_told(scene, folder)
                restarts_are_the_same(scene, positions, folder)
                starts_from_a_frame(scene, output, positions, folder)
                open_lengths_are_those_of_the_frame(folder)
                damaged_crosslinks_are_refused(output, folder)
                analyses_name_cross_linked_chains(output, folder)
                catena("run", scene, "--output", os.path.join(folder, "replicas"), "--quiet", "--set", "replicas=2")
        if openmm:
            a_constrained_system_runs(folder)
            redundant_links_of_alike_chains_are_noted_once(folder)
            a_frame_without_crosslinks_is_relaxed(folder)
            the_protein_is_valid(inputs, folder)
    print("check, plan, solve, run, restart, topologies and Systems of cross-linked chains are as they should be")


PROGRAM = sys.argv[1]
main()
