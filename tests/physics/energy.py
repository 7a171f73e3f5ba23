"""Energy under RATTLE: its error falls by 4 when the step is halved (second order), over short runs from the same starts, which chaos
has not parted yet; and its drift over a long run is reported. Two chains: alpha-synuclein with CALVADOS 2 on OpenMM's Reference
platform, pair terms switched off smoothly; and 100 bodies on spherical joints without OpenMM.
Usage: energy.py [--quick] [--chain alpha-synuclein|spherical|both] [--starts N] [--steps N]; --quick leaves the long run out"""
import sys

import numpy as np
from catena import ROOT, Runs, arguments, columns, verdict

CHAINS = {
    "alpha-synuclein": (ROOT + "/inputs/alpha-synuclein.yaml",
                        {"forces.openmm.platform": "Reference", "forces.openmm.switch_width": 0.2, "box": "none"}, 0.01, 2.0),
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


def check(runs, name, starts, steps):
    _, _, step, time = CHAINS[name]
    rms = {}
    for factor in (1, 2):
        h = step / factor
        rms[factor] = np.sqrt(np.mean([np.var(energies(runs, name, h, time, seed)[1]) for seed in range(1, starts + 1)]))
        print(f"        {name}: step {1e3 * h:g} fs, {starts} starts: rms within {time:g} ps {rms[factor]:.5f} kJ/mol", flush=True)
    if steps > 0:
        t, energy, kinetic = energies(runs, name, step / 2, steps * step / 2, 1)
        print(f"        {name}: step {500 * step:g} fs, {steps} steps: drift {1e3 * np.polyfit(t, energy, 1)[0]:+.4f} kJ/mol/ns of {kinetic.mean():.0f} kJ/mol kinetic energy", flush=True)
    ratio = rms[1] / rms[2]
    return verdict(name, 3.5 <= ratio <= 4.5, f"rms falls by {ratio:.2f} when the step is halved (4 +- 0.5)")


options = arguments(__doc__, chain="both", starts=8, steps=50000)
names = list(CHAINS) if options.chain == "both" else [options.chain]
with Runs(options) as runs:
    good = [check(runs, name, options.starts, 0 if options.quick else options.steps) for name in names]
sys.exit(0 if all(good) else 1)
