"""Energy under RATTLE: its error within short windows falls by 4 when the step is halved (second order), and its drift over a long
run is reported. Two chains: alpha-synuclein with CALVADOS 2 on OpenMM's Reference platform, pair terms switched off smoothly; and
100 bodies on spherical joints without OpenMM. Usage: energy.py [--quick] [--chain alpha-synuclein|spherical|both] [--steps N]"""
import sys

import numpy as np
from catena import ROOT, Runs, arguments, columns, verdict

CHAINS = {
    "alpha-synuclein": (ROOT + "/inputs/alpha-synuclein.yaml",
                        {"forces.openmm.platform": "Reference", "forces.openmm.switch_width": 0.2, "box": "none"}, 0.01, 10.0),
    "spherical": (ROOT + "/inputs/spherical-chain.yaml", {}, 0.01, 10.0),
}


def windows(folder, width):
    """Root mean square of the energy about its mean, over windows of `width` ps; and the slope over the whole run."""
    table = columns(folder)
    time, energy = table["time"], table["total_energy"]
    index = np.floor((time - time[0]) / width + 1e-9).astype(int)
    squares = [np.var(energy[index == i]) for i in range(index[-1])]   # the last, unfinished window is left out
    kinetic = table["kinetic_energy"].mean()
    return np.sqrt(np.mean(squares)), np.polyfit(time, energy, 1)[0], kinetic


def check(runs, name, steps):
    scene, settings, step, width = CHAINS[name]
    rms = {}
    for factor in (1, 2):
        h = step / factor
        folder = runs.run(f"{name}-{h:g}", scene, settings | {"dynamics.integrator": "rattle", "dynamics.step": h, "dynamics.steps": steps,
                                                              "output.every": max(1, round(0.1 / h)), "output.observables": "[energy, constraint_error]"})
        rms[factor], slope, kinetic = windows(folder, width)
        print(f"        {name}: step {1e3 * h:g} fs, {steps} steps: rms within {width:g} ps {rms[factor]:.5f} kJ/mol, "
              f"drift {1e3 * slope:+.4f} kJ/mol/ns of {kinetic:.0f} kJ/mol kinetic energy", flush=True)
    ratio = rms[1] / rms[2]
    return verdict(name, 3.5 <= ratio <= 4.5, f"rms falls by {ratio:.2f} when the step is halved (4 +- 0.5)")


options = arguments(__doc__, chain="both", steps=100000)
names = list(CHAINS) if options.chain == "both" else [options.chain]
with Runs(options) as runs:
    good = [check(runs, name, 6000 if options.quick else options.steps) for name in names]
sys.exit(0 if all(good) else 1)
