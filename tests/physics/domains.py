"""Three rigid domains of residues with flexible linkers and CALVADOS 2 (inputs/three-domains.yaml) under g-BAOAB and under RATTLE: the
distances within each domain stay as at the start to 1e-12, and under RATTLE the energy's error within short windows falls by 4 when
the step is halved. Usage: domains.py [--quick]"""
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


def energy_error(folder, width):
    table = columns(folder)
    index = np.floor((table["time"] - table["time"][0]) / width + 1e-9).astype(int)
    energy = table["total_energy"]
    squares = [np.var(energy[index == i]) for i in range(index[-1])]   # the last, unfinished window is left out
    return np.sqrt(np.mean(squares)), np.polyfit(table["time"], energy, 1)[0], table["kinetic_energy"].mean()


good = True
with Runs(options) as runs:
    rms = []
    smooth = {"forces.openmm.platform": "Reference", "forces.openmm.switch_width": 0.2, "box": "none"}
    for name, integrator, step, settings in (("langevin", "g-baoab", 0.01, {}), ("rattle-10fs", "rattle", 0.01, smooth), ("rattle-5fs", "rattle", 0.005, smooth)):
        folder = runs.run(name, SCENE, settings | {"dynamics.integrator": integrator, "dynamics.step": step, "dynamics.steps": round(steps * 0.01 / step),
                                                   "output.every": round(0.1 / step), "output.observables": "[energy, constraint_error]"})
        worst, frames, moved = largest_change(folder)
        good &= verdict(f"rigid domains, {name}", worst <= 1e-12, f"largest change of a distance {worst:.2e} nm over {1e-2 * steps:g} ps, {frames} frames")
        if integrator == "rattle":
            error, slope, kinetic = energy_error(folder, 10.0)
            rms.append(error)
            print(f"        {name}: energy rms within 10 ps {error:.5f} kJ/mol, drift {1e3 * slope:+.4f} kJ/mol/ns of {kinetic:.0f} kJ/mol kinetic energy", flush=True)
    ratio = rms[0] / rms[1]
    good &= verdict("energy", 3.5 <= ratio <= 4.5, f"rms falls by {ratio:.2f} when the step is halved (4 +- 0.5)")
sys.exit(0 if good else 1)
