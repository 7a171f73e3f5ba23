#!/usr/bin/env python3
"""A slab of 100 chains by Catena on rigid links beside plain OpenMM with harmonic bonds: density profiles of runs of the same length.

Runs `catena run` on inputs/hnrnpa1-slab.yaml, builds the same system in OpenMM from the published model (CALVADOS 2) without Catena's code, runs it
with LangevinMiddleIntegrator from the same start, and analyses both trajectories by `catena analyse`. The first half is left out. Does so for several
seeds, each with a start of its own. A slab relaxes in tens of nanoseconds: blocks of one run underestimate the error of its profile, so that errors
are those of the mean difference between the pairs of runs. VALID: energies of all starts agree to 1e-4, and the mean over the bins of the squared mean
difference over its squared error is no larger than for all but 1 % of the ways to exchange the two programs within pairs.
Needs OpenMM; the comparison needs h5py, numpy and matplotlib. --only splits the work between machines, --jobs runs seeds beside each other."""
import argparse
import concurrent.futures
import csv
import itertools
import json
import math
import os
import shutil
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENE = os.path.join(ROOT, "inputs", "hnrnpa1-slab.yaml")
TABLE = os.path.join(ROOT, "inputs", "residues_CALVADOS2.csv")
TEMPERATURE, IONIC, PH, FRICTION, STEP = 293.0, 0.15, 7.0, 0.01, 0.01  # of the scene: K, mol/l, -, 1/ps, ps
STIFFNESS, LENGTH = 8033.0, 0.38  # of a bond: kJ/mol/nm^2, nm
EPSILON, SHORT_CUTOFF, LONG_CUTOFF = 0.8368, 2.0, 4.0  # kJ/mol, nm, nm
BOX = (15.0, 15.0, 100.0)
BINS = 100
LEAST = 1.0  # mg/ml in both programs together: bins with less are not compared
QUANTITIES = ("dense_concentration", "slab_thickness", "radius_of_gyration")


def folder_of(asked, seed):
    """Folder of the pair of runs of a seed."""
    return os.path.join(asked.output, f"seed-{seed}")


def residues():
    """Mass, stickiness, diameter and charge of each residue, by its three letters."""
    with open(TABLE, encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {row["three"]: tuple(float(row[key]) for key in ("MW", "lambdas", "sigmas", "q")) for row in rows}


def beads_of(topology):
    """Chain (index), residue and position in nm of each bead of Catena's topology.pdb. Chains end where numbers begin again."""
    beads, chain, before = [], -1, 10**9
    with open(topology, encoding="utf-8") as file:
        for line in file:
            if line.startswith(("ATOM", "HETATM")):
                number = int(line[22:26])
                if number <= before:
                    chain += 1
                before = number
                beads.append((chain, line[17:20], [0.1 * float(line[k : k + 8]) for k in (30, 38, 46)]))
    return beads


def screening():
    """Prefactor of the Yukawa force in kJ nm/mol and inverse Debye length in 1/nm."""
    t = TEMPERATURE
    permittivity = 5321 / t + 233.76 - 0.9297 * t + 0.1417e-2 * t**2 - 0.8292e-6 * t**3
    prefactor = 1.6021766**2 / (4 * math.pi * 8.854188 * permittivity) * 6.02214076 * 1000
    bjerrum = prefactor / (8.3145e-3 * t)
    return prefactor, math.sqrt(8 * math.pi * bjerrum * IONIC * 6.02214076 / 10)


def make_system(openmm, beads):
    """Masses, bonds and pair forces of CALVADOS 2."""
    table, (prefactor, kappa) = residues(), screening()
    system = openmm.System()
    system.setDefaultPeriodicBoxVectors((BOX[0], 0, 0), (0, BOX[1], 0), (0, 0, BOX[2]))
    bonds = openmm.HarmonicBondForce()
    sticky = openmm.CustomNonbondedForce(
        "select(step(r-2^(1/6)*s), l*(w-edge), w-l*edge+eps*(1-l)); w=4*eps*((s/r)^12-(s/r)^6);"
        "edge=4*eps*((s/r_short)^12-(s/r_short)^6); s=0.5*(s1+s2); l=0.5*(l1+l2)")
    charged = openmm.CustomNonbondedForce("q1*q2*a*(exp(-kappa*r)/r-exp(-kappa*r_long)/r_long)")
    for force, cutoff, constants, names in ((sticky, SHORT_CUTOFF, {"eps": EPSILON, "r_short": SHORT_CUTOFF}, "sl"), (charged, LONG_CUTOFF, {"a": prefactor, "kappa": kappa, "r_long": LONG_CUTOFF}, "q")):
        for name, value in constants.items():
            force.addGlobalParameter(name, value)
        for name in names:
            force.addPerParticleParameter(name)
        force.setNonbondedMethod(force.CutoffPeriodic)
        force.setCutoffDistance(cutoff)
    bonds.setUsesPeriodicBoundaryConditions(True)
    last = len(beads) - 1
    for k, (chain, residue, _) in enumerate(beads):
        mass, stickiness, diameter, charge = table[residue]
        first_of_chain, last_of_chain = k == 0 or beads[k - 1][0] != chain, k == last or beads[k + 1][0] != chain
        if residue == "HIS":
            charge = 1 / (1 + 10 ** (PH - 6))
        system.addParticle(mass + 2 * first_of_chain + 16 * last_of_chain)
        sticky.addParticle([diameter, stickiness])
        charged.addParticle([charge + first_of_chain - last_of_chain])
        if not first_of_chain:
            bonds.addBond(k - 1, k, LENGTH, STIFFNESS)
            sticky.addExclusion(k - 1, k)
            charged.addExclusion(k - 1, k)
    for group, force in enumerate((bonds, sticky, charged)):
        force.setForceGroup(group)
        system.addForce(force)
    return system


def run_catena(asked, seed):
    """The run of the scene; returns the potential energy of its start, its speed and whether it is VALID."""
    folder = os.path.join(folder_of(asked, seed), "catena")
    if not os.path.exists(os.path.join(folder, "summary.json")):
        words = [asked.catena, "run", SCENE, "--output", folder, "--steps", str(asked.steps), "--quiet", "--set", f"output.every={asked.every}",
                 "--set", f"output.checkpoint_every={asked.steps}", "--set", f"dynamics.seed={seed}"]
        status = subprocess.run(words + (["--backend", asked.backend] if asked.backend else []), check=False).returncode
        if status not in (0, 1):  # 1: INVALID, which the comparison says
            sys.exit(f"the run of Catena ended with status {status}")
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    if summary["run"]["last_step"] != asked.steps:
        sys.exit(f"the run in {folder} has {summary['run']['last_step']} steps, not {asked.steps}: name another --output")
    return summary["start"]["potential_energy"], summary["speed"], summary["valid"]


def run_openmm(asked, seed):
    """The same by OpenMM alone. Writes frames as 32-bit floats, and the non-bonded energy of the start."""
    import openmm
    folder = folder_of(asked, seed)
    if os.path.exists(os.path.join(folder, "openmm.json")):
        return
    beads = beads_of(os.path.join(folder, "catena", "topology.pdb"))
    system = make_system(openmm, beads)
    integrator = openmm.LangevinMiddleIntegrator(TEMPERATURE, FRICTION, STEP)
    integrator.setRandomNumberSeed(seed)
    # Processes that compile kernels beside each other must not share OpenMM's folders for them.
    os.environ["OPENMM_CACHE_DIR"] = os.path.abspath(folder)
    properties = {"TempDirectory": os.path.abspath(folder)} if asked.platform == "CUDA" else {}
    context = openmm.Context(system, integrator, openmm.Platform.getPlatformByName(asked.platform), properties)
    context.setPositions([openmm.Vec3(*at) for _, _, at in beads])
    energy = context.getState(getEnergy=True, groups={1, 2}).getPotentialEnergy()._value
    context.setVelocitiesToTemperature(TEMPERATURE, seed)
    begun, frames = time.monotonic(), []
    with open(os.path.join(folder, "openmm.f32"), "wb") as to:
        for step in range(0, asked.steps + 1, asked.every):
            if step:
                integrator.step(asked.every)
            state = context.getState(getPositions=True)
            state.getPositions(asNumpy=True)._value.astype("float32").tofile(to)
            frames.append(step)
            if len(frames) % 50 == 0:
                print(f"OpenMM, step {step} of {asked.steps}, {time.monotonic() - begun:.0f} s", file=sys.stderr, flush=True)
    found = {"energy": energy, "seconds": time.monotonic() - begun, "platform": asked.platform, "openmm": openmm.version.version, "frames": len(frames)}
    with open(os.path.join(folder, "openmm.json"), "w", encoding="utf-8") as to:
        json.dump(found, to)


def as_run(place):
    """A copy of Catena's run in `place` whose positions are OpenMM's frames."""
    import h5py
    import numpy
    source, folder = (os.path.join(place, name) for name in ("catena", "openmm-run"))
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(source, folder, ignore=shutil.ignore_patterns("analysis", "checkpoint.h5"))
    with h5py.File(os.path.join(folder, "trajectory.h5md"), "r+") as file:
        positions = file["particles/trajectory/position/value"]
        frames = numpy.fromfile(os.path.join(place, "openmm.f32"), dtype=numpy.float32).reshape(positions.shape)
        positions[...] = frames
    return folder


def profile(asked, folder):
    """Density profile of a run's second half as z and values, and concentrations."""
    where, words = os.path.join(folder, "analysis"), ["--slab", "z", "--bins", str(BINS), "--cutoff", "0", "--discard", "0.5", "--quiet"]
    subprocess.run([asked.catena, "analyse", folder, *words, "--output", where, "--json", os.path.join(folder, "analysis.json")], check=True)
    with open(os.path.join(where, "density.csv"), encoding="utf-8") as file:
        rows = [(float(row["z [nm]"]), float(row["value [mg/ml]"])) for row in csv.DictReader(file)]
    with open(os.path.join(folder, "analysis.json"), encoding="utf-8") as file:
        quantities = {each["name"]: each["value"] for each in json.load(file)["quantities"]}
    return [z for z, _ in rows], [value for _, value in rows], quantities


def mean_of(values):
    """Mean and standard error."""
    mean = sum(values) / len(values)
    return mean, (sum((value - mean) ** 2 for value in values) / (len(values) - 1) / len(values)) ** 0.5


def draw(curves, path):
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "catena"
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(6, 3.5), layout="constrained")
    for (name, rows), colour in zip(curves.items(), ("#0b6bcb", "#d9822b")):
        z, value, error = zip(*rows)
        axes.plot(z, value, color=colour, linewidth=1.2, label=name)
        axes.fill_between(z, [v - e for v, e in zip(value, error)], [v + e for v, e in zip(value, error)], color=colour, alpha=0.25, linewidth=0)
    axes.set(xlabel="z (nm)", ylabel="protein (mg/ml)", xlim=(-25, 25), ylim=(0, None))
    axes.legend(frameon=False)
    figure.savefig(path, dpi=110, metadata={"Date": None} if path.endswith(".svg") else None)


def compare_pair(asked, seed):
    """Both profiles and concentrations of a seed, and the difference of its energies."""
    place = folder_of(asked, seed)
    start, speed, valid = run_catena(asked, seed)
    with open(os.path.join(place, "openmm.json"), encoding="utf-8") as file:
        other = json.load(file)
    if other["frames"] != asked.steps // asked.every + 1:
        sys.exit(f"the run of OpenMM in {place} has {other['frames']} frames, not {asked.steps // asked.every + 1}: name another --output")
    z, ours, quantities = profile(asked, os.path.join(place, "catena"))
    _, theirs, their_quantities = profile(asked, as_run(place))
    shutil.rmtree(os.path.join(place, "openmm-run"))
    return {"seed": seed, "z": z, "catena": {"profile": ours, "quantities": quantities, "speed": speed, "energy_of_start": start, "valid": valid},
            "openmm": {"profile": theirs, "quantities": their_quantities, **other}, "energies_apart": abs(other["energy"] / start - 1)}


def paired(pairs, read):
    """Means and standard errors of both programs and of their difference, of a number that `read` finds in a pair's program."""
    ours, theirs = ([read(pair[name]) for pair in pairs] for name in ("catena", "openmm"))
    return {"catena": mean_of(ours), "openmm": mean_of(theirs), "difference": mean_of([a - b for a, b in zip(ours, theirs)])}


def mean_square(differences):
    """Mean over the bins of the squared mean over its squared error; `differences` has a list of bins of each pair."""
    means = [mean_of(values) for values in zip(*differences)]
    squares = [(mean / error) ** 2 for mean, error in means if error > 0]
    return sum(squares) / len(squares)


def chance(differences):
    """Share of all ways to exchange the two programs within pairs, the real one among them, whose mean square is at least the real one's."""
    real = mean_square(differences)
    ways = list(itertools.product((1, -1), repeat=len(differences) - 1))  # an exchange in all pairs changes no square
    found = [mean_square([[sign * value for value in pair] for sign, pair in zip((1, *signs), differences)]) for signs in ways]
    return sum(value >= real * (1 - 1e-12) for value in found) / len(ways)


def run_pair(asked, seed):
    """Carries out what is asked for of a seed; returns the comparison of its two runs, if that is."""
    os.makedirs(folder_of(asked, seed), exist_ok=True)
    if asked.only in (None, "catena"):
        run_catena(asked, seed)
    if asked.only in (None, "openmm"):
        run_openmm(asked, seed)
    return compare_pair(asked, seed) if asked.only in (None, "compare") else None


def compare(asked, pairs):
    """Compares the pairs of runs, writes the comparison, and returns whether it is VALID."""
    bins = [paired(pairs, lambda run, k=k: run["profile"][k]) for k in range(len(pairs[0]["z"]))]
    compared = [k for k, each in enumerate(bins) if each["catena"][0] + each["openmm"][0] > LEAST]
    differences = [[pair["catena"]["profile"][k] - pair["openmm"]["profile"][k] for k in compared] for pair in pairs]
    square, likely = mean_square(differences), chance(differences)
    apart = max(pair["energies_apart"] for pair in pairs)
    numbers = {name: paired(pairs, lambda run, name=name: run["quantities"][name]) for name in QUANTITIES}
    found = {"bench": "slab beside OpenMM", "scene": "inputs/hnrnpa1-slab.yaml", "steps": asked.steps, "step_ps": STEP, "pairs_at_a_time": asked.jobs, "frames_every": asked.every,
             "command": " ".join(["python3", "tests/bench/slab_openmm.py", *sys.argv[1:]]), "pairs": pairs, "profiles": bins, "quantities": numbers,
             "bins_compared": len(compared), "mean_square": square, "chance": likely,
             "valid": bool(all(pair["catena"]["valid"] for pair in pairs) and apart < 1e-4 and likely > 0.01)}
    if asked.json:
        with open(asked.json, "w", encoding="utf-8") as to:
            json.dump(found, to)
    if asked.picture:
        draw({label: [(z, *each[name]) for z, each in zip(pairs[0]["z"], bins)]
              for label, name in (("Catena, rigid links", "catena"), ("OpenMM, harmonic bonds", "openmm"))}, asked.picture)
    print(f"energies of the {len(pairs)} starts: at most {apart:.1e} apart\nprofiles: {len(compared)} bins, mean square {square:.2f}, "
          f"chance {likely:.3f}")
    for name, each in numbers.items():
        print(name.replace("_", " ") + ": " + ", ".join(f"{which} {value:.4g} +- {error:.2g}" for which, (value, error) in each.items()))
    print("VALID" if found["valid"] else "INVALID")
    return found["valid"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--catena", default=os.path.join(ROOT, "build", "release", "catena"), help="the program (default: build/release/catena)")
    parser.add_argument("--seeds", type=int, default=8, metavar="N", help="pairs of runs, 8 at least: seeds 1 to N (default: 8)")
    parser.add_argument("--steps", type=int, default=400000, help="steps of 10 fs of each run (default: 400000)")
    parser.add_argument("--every", type=int, default=1000, help="steps between frames (default: 1000)")
    parser.add_argument("--backend", default="", help="of Catena (default: auto)")
    parser.add_argument("--platform", default="CUDA", help="of OpenMM (default: CUDA)")
    parser.add_argument("--output", default="slab-beside-openmm", help="folder of both runs")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="pairs at a time; speeds are then those of runs beside each other (default: 1)")
    parser.add_argument("--only", choices=("catena", "openmm", "compare"), help="only one of the three parts")
    parser.add_argument("--json", help="file for the comparison")
    parser.add_argument("--picture", help="file for the profiles")
    asked = parser.parse_args()
    if not 8 <= asked.seeds <= 12:
        parser.error("--seeds is 8 to 12: fewer pairs cannot show a difference at 1 %, more have too many ways to be exchanged")
    asked.steps -= asked.steps % asked.every
    asked.seeds = range(1, asked.seeds + 1)
    with concurrent.futures.ProcessPoolExecutor(max_workers=asked.jobs) as pool:
        pairs = list(pool.map(run_pair, itertools.repeat(asked), asked.seeds))
    if asked.only in (None, "compare"):
        sys.exit(0 if compare(asked, pairs) else 1)


if __name__ == "__main__":
    main()
