"""Energy under RATTLE: its error falls by 4 when the step is halved (second order), over short runs from the same starts, which chaos
has not parted yet; and within windows of long runs, with the scatter that different trajectories bring, and the drift. Three chains: alpha-synuclein, and three rigid domains with linkers, with
CALVADOS 2 on OpenMM's Reference platform, pair terms switched off smoothly; and 100 bodies on spherical joints without OpenMM.
Usage: energy.py [--quick] [--chain alpha-synuclein|three-domains|spherical|all] [--starts N] [--steps N]; --quick leaves the long runs out"""
import sys

import numpy as np
from catena import ROOT, Runs, arguments, columns, verdict

SMOOTH = {"forces.openmm.platform": "Reference", "forces.openmm.switch_width": 0.2, "box": "none"}
CHAINS = {
    "alpha-synuclein": (ROOT + "/inputs/alpha-synuclein.yaml", SMOOTH, 0.01, 2.0),
    "three-domains": (ROOT + "/inputs/three-domains.yaml", SMOOTH, 0.01, 2.0),
    "spherical": (ROOT + "/inputs/spherical-chain.yaml", {}, 0.01, 2.0),
}


def energies(runs, name, step, time, seed):
    """Time, total and kinetic energy."""
    scene, settings, _, _ = CHAINS[name]
    folder = runs.run(f"{name}-{step:g}", scene, settings | {"dynamics.integrator": "rattle", "dynamics.step": step, "dynamics.steps": round(time / step),
                                                             "dynamics.seed": seed, "output.every": max(1, round(0.02 / step)),
                                                             "output.observables": "[energy, constraint_error]"})
    table = columns(folder)
    return table["time"], table["total_energy"], table["kinetic_energy"]


def windows(time, energy, width=10.0):
    """Mean square of the energy about its mean in each window of `width` ps, and its standard error."""
    index = np.floor((time - time[0]) / width + 1e-9).astype(int)
    squares = np.array([np.var(energy[index == i]) for i in range(index[-1])])   # the last, unfinished window is left out
    return squares.mean(), squares.std(ddof=1) / np.sqrt(len(squares))


def long_runs(runs, name, step, steps):
    """Of the same time at the step and at half of it."""
    found = []
    for factor in (1, 2):
        h = step / factor
        t, energy, kinetic = energies(runs, name, h, steps * step, 1)
        square, error = windows(t, energy)
        found.append((square, error / square))
        print(f"        {name}: step {1e3 * h:g} fs, {factor * steps} steps: rms within 10 ps {np.sqrt(square):.5f} kJ/mol, "
              f"drift {1e3 * np.polyfit(t, energy, 1)[0]:+.4f} kJ/mol/ns of {kinetic.mean():.0f} kJ/mol kinetic energy", flush=True)
    ratio = np.sqrt(found[0][0] / found[1][0])
    error = 0.5 * ratio * np.hypot(found[0][1], found[1][1])
    return verdict(f"{name}, long", abs(ratio - 4) <= 0.5 + 2 * error, f"rms within windows falls by {ratio:.2f} +- {error:.2f} when the step is halved (4 +- 0.5)")


def check(runs, name, starts, steps):
    _, _, step, time = CHAINS[name]
    rms = {}
    for factor in (1, 2):
        h = step / factor
        rms[factor] = np.sqrt(np.mean([np.var(energies(runs, name, h, time, seed)[1]) for seed in range(1, starts + 1)]))
        print(f"        {name}: step {1e3 * h:g} fs, {starts} starts: rms within {time:g} ps {rms[factor]:.5f} kJ/mol", flush=True)
    ratio = rms[1] / rms[2]
    good = verdict(name, 3.5 <= ratio <= 4.5, f"rms falls by {ratio:.2f} when the step is halved (4 +- 0.5)")
    return good & (steps == 0 or long_runs(runs, name, step, steps))


options = arguments(__doc__, chain="all", starts=8, steps=100000)
names = list(CHAINS) if options.chain == "all" else [options.chain]
with Runs(options) as runs:
    good = [check(runs, name, options.starts, 0 if options.quick else options.steps) for name in names]
sys.exit(0 if all(good) else 1)
