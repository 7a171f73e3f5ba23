"""The order of g-BAOAB in an average: the mean kinetic temperature at whole steps of elastic rods (stiff springs in spherical joints) misses
the thermostat's by a multiple of h^2, of a harmonic mode by (omega h)^2 / 4 of it (Leimkuhler & Matthews, J. Chem. Phys. 138, 174102, 2013),
while its positions hardly miss theirs. Steps are halved twice; the slope of the first halving, where the
scatter is small, is 2 within 0.1. Usage:
order.py [--quick]"""
import sys

import numpy as np
from catena import Runs, arguments, blocked_error, columns, verdict

options = arguments(__doc__, bodies=100, chains=4, steps=40000, longest=0.32, friction=1.0)
steps = 4000 if options.quick else options.steps
TEMPERATURE = 300.0


def miss(runs, step):
    """By what part of it the temperature misses the thermostat's, and its standard error."""
    rod = {"bodies": options.bodies, "mass": 650, "length": 0.34, "radius": 1, "bend": 50, "twist": 100}
    scene = {"units": "md",
             "chains": [{"velocities": "thermal", "generator": {"elastic_rod": rod | {"seed": 1 + k}}} for k in range(options.chains)],
             "dynamics": {"integrator": "g-baoab", "step": step, "steps": steps, "temperature": TEMPERATURE, "friction": options.friction,
                          "seed": 1},
             "output": {"every": 2, "observables": ["temperature"]}, "solver": {"backend": "segments"}}
    found = columns(runs.run(f"step-{step}", runs.write(f"step-{step}", scene), {}))["temperature"]
    found = found[len(found) // 20:] / TEMPERATURE
    return found.mean() - 1, blocked_error(found)


with Runs(options) as runs:
    misses = []
    for halvings in range(3):
        step = options.longest / 2**halvings
        misses.append(miss(runs, step))
        print(f"        step {step:.3g} ps: temperature off by {misses[-1][0]:+.5f} +- {misses[-1][1]:.5f} of it")
    (coarse, coarse_error), (fine, fine_error) = misses[:2]
    slope = np.log2(abs(coarse / fine))
    error = np.hypot(coarse_error / coarse, fine_error / fine) / np.log(2)
    allowed = max(0.1, 3 * error) if options.quick else 0.1
    good = verdict("order of g-BAOAB in the kinetic temperature", abs(slope - 2) <= allowed, f"{slope:.3f} +- {error:.3f}, 2 within {allowed:.2f}")
sys.exit(0 if good else 1)
