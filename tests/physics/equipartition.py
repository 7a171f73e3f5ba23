"""Springs of cylindrical and planar3 joints under a thermostat in joint coordinates: K <q^2> = kT for every coordinate, whether it is a length
or an angle, with explicit and with implicit springs. Usage: equipartition.py [--quick] [--copies N] [--steps N]"""
import os
import sys

import h5py
import numpy as np
from catena import Runs, arguments, verdict

KT = 0.00831446261815324 * 300
PLANAR3, CYLINDRICAL = [500.0, 200.0, 300.0], [250.0, 400.0]


def scene(copies):
    plane = {"type": "planar3", "axes": [[1, 0, 0], [0, 0, 1]], "stiffness": PLANAR3}
    rod = {"type": "cylindrical", "axis": [1, 0, 0], "translation": [0.2, 0, 0], "stiffness": CYLINDRICAL}
    bodies = [{"mass": 100, "com": [0.05, 0.02, 0.1], "inertia": [20, 25, 30], "joint": plane},
              {"mass": 80, "com": [0, 0.1, 0], "inertia": [20, 25, 18], "joint": rod}]
    return {"chains": [{"name": "pair", "count": copies, "base": "fixed", "bodies": bodies}],
            "dynamics": {"step": 0.1, "temperature": 300, "friction": 1, "seed": 5}, "output": {"every": 20, "coordinates": True}}


def check(runs, name, options, steps):
    folder = runs.run(name, runs.write(name, scene(options.copies)), {"dynamics.integrator": name, "dynamics.steps": steps})
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        q = file["catena/joint_position/value"][20:]
    worst = 0
    for values, stiffness in [(q[:, 0::2, i], k) for i, k in enumerate(PLANAR3)] + [(q[:, 1::2, i], k) for i, k in enumerate(CYLINDRICAL)]:
        of_copy = stiffness * (values**2).mean(axis=0) / KT   # copies are independent of each other
        error = of_copy.std(ddof=1) / np.sqrt(len(of_copy))
        worst = max(worst, abs(of_copy.mean() - 1) / error)
        print(f"        {name}: K <q^2> / kT = {of_copy.mean():.4f} +- {error:.4f}")
    return verdict(name, worst <= 4, f"equipartition within {worst:.1f} standard errors (bound 4)")


options = arguments(__doc__, copies=400, steps=20000)
with Runs(options) as runs:
    good = [check(runs, name, options, 3000 if options.quick else options.steps) for name in ("baoab", "implicit-baoab")]
sys.exit(0 if all(good) else 1)
