"""Three rigid domains of residues with flexible linkers and CALVADOS 2 (inputs/three-domains.yaml) under g-BAOAB and under RATTLE: the
distances within each domain stay as at the start to 1e-12, and under RATTLE the energy stays: its drift is below 1e-4 of the kinetic
energy a nanosecond (energy.py tells how its error falls with the step). Usage: domains.py [--quick]; --quick reports the drift alone"""
import os
import sys

import h5py
import numpy as np
from catena import ROOT, Runs, arguments, columns, verdict

options = arguments(__doc__, steps=100000)
SCENE = ROOT + "/inputs/three-domains.yaml"
DOMAINS = ((0, 34), (46, 80), (92, 126))
steps = 6000 if options.quick else options.steps


def largest_change(folder):
    """Of a distance within a domain, in nm and over all frames, against the first."""
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        x = file["particles/trajectory/position/value"][:]
    worst = 0.0
    for begin, end in DOMAINS:
        first = np.linalg.norm(x[0, begin:end, None] - x[0, None, begin:end], axis=-1)
        for frame in x[1:, begin:end]:
            worst = max(worst, np.abs(np.linalg.norm(frame[:, None] - frame[None], axis=-1) - first).max())
    return worst, len(x), np.linalg.norm(x[-1].mean(0) - x[0].mean(0))


def drift(folder):
    """Of the total energy, a nanosecond, over the mean kinetic energy; both."""
    table = columns(folder)
    kinetic = table["kinetic_energy"].mean()
    return 1e3 * np.polyfit(table["time"], table["total_energy"], 1)[0] / kinetic, kinetic


good = True
with Runs(options) as runs:
    smooth = {"forces.openmm.platform": "Reference", "forces.openmm.switch_width": 0.2, "box": "none"}
    for name, integrator, step, settings in (("langevin", "g-baoab", 0.01, {}), ("rattle-10fs", "rattle", 0.01, smooth), ("rattle-5fs", "rattle", 0.005, smooth)):
        folder = runs.run(name, SCENE, settings | {"dynamics.integrator": integrator, "dynamics.step": step, "dynamics.steps": round(steps * 0.01 / step),
                                                   "output.every": round(0.1 / step), "output.observables": "[energy, constraint_error]"})
        worst, frames, moved = largest_change(folder)
        good &= verdict(f"rigid domains, {name}", worst <= 1e-12, f"largest change of a distance {worst:.2e} nm over {1e-2 * steps:g} ps, {frames} frames")
        if integrator == "rattle":
            relative, kinetic = drift(folder)
            good &= verdict(f"energy, {name}", options.quick or abs(relative) <= 1e-4, f"drift {relative:+.1e} of {kinetic:.0f} kJ/mol kinetic energy a nanosecond")
sys.exit(0 if good else 1)
