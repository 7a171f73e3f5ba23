"""Mechanisms of the IFToMM library of computational benchmark problems over their 10 s: A02 (N = 1), which passes singular places, and A04
(Bricard's), which is held more often than counting allows. A six-bar linkage of two loops, held six times more than it needs in space. Energy drift against a bound, opening of the loop, time.
Usage: mechanisms.py [--quick]"""
import sys
import time

from catena import ROOT, Runs, arguments, columns, verdict

SPAN = 10.0
EPS = 2.0**-53
# Scene, largest drift of energy in J at the longest step, steps in s (the last: --quick).
MECHANISMS = {"A02": ("four-bar-a02", 1e-4, [0.001, 0.005, 0.01]), "A04": ("bricard", 1e-6, [0.001, 0.005, 0.01]),
              "six-bar": ("six-bar", 5e-4, [0.0005, 0.001])}


def check(runs, name, step):
    scene, bound, _ = MECHANISMS[name]
    steps = round(SPAN / step)
    start = time.perf_counter()
    folder = runs.run(f"{name}-{step}", f"{ROOT}/inputs/{scene}.yaml", {"dynamics.step": step, "dynamics.steps": steps, "output.every": max(1, steps // 500)})
    seconds = time.perf_counter() - start
    table = columns(folder)
    energy = table["total_energy"]
    drift, moving, opening = abs(energy - energy[0]).max(), table["kinetic_energy"].max(), table["constraint_error"].max()
    found = f"energy moved by {drift:.1e} J of {moving:.3g} J kinetic (bound {bound:g} J), loop open by {opening:.1e}, {seconds:.2f} s"
    # The loop is projected to rounding after every step.
    return verdict(f"{name}, step {step * 1e3:g} ms", drift <= bound and opening <= 256 * EPS and moving > 1, found)


options = arguments(__doc__)
with Runs(options) as runs:
    good = [check(runs, name, step) for name in MECHANISMS for step in (MECHANISMS[name][2][-1:] if options.quick else MECHANISMS[name][2])]
sys.exit(0 if all(good) else 1)
