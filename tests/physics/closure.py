"""Chains that end on the ground, and rings, stay closed: the largest constraint error of long runs, joint coordinates (a planar linkage, a
chain of every joint kind, a ring of rods) and absolute coordinates (a rope, rings of rods and of beads). Usage: closure.py [--quick]
[--steps N]"""
import sys

from catena import ROOT, Runs, arguments, columns, verdict

MIXED = {"units": "si", "forces": {"gravity": [0, 0, -9.81]},
         "chains": [{"name": "chain", "base": "fixed", "generator": {"random": {"bodies": 12, "joint": "mixed", "seed": 2, "loads": False}},
                     "tip": {"joint": {"type": "spherical"}}}],
         "dynamics": {"integrator": "rk4", "step": 1e-4}}


def sliding(joint, tip):
    """A chain of one kind of joints whose tip slides."""
    return {**MIXED, "chains": [{"name": "chain", "base": "fixed", "generator": {"random": {"bodies": 12, "joint": joint, "seed": 2, "loads": False}},
                                 "tip": {"joint": tip | {"translation": [0.3, 0.1, 0]}}}]}


CYLINDRICAL, PLANAR3 = {"type": "cylindrical", "axis": [0.6, 0, 0.8]}, {"type": "planar3", "axes": [[0.8, 0, -0.6], [0.6, 0, 0.8]]}
BEADS = {"units": "si", "chains": [{"name": "ring", "velocities": "thermal", "generator": {"polygon": {"bodies": 20, "joint": "link"}}, "tip": "ring"}],
         "dynamics": {"integrator": "rattle", "step": 1e-3, "temperature": 1e22}}
EPS = 2.0**-53
# Scene, settings beside its own, bound. Joints are closed to rounding after every step: some ten bodies, each a few roundings of the chain's
# length. RATTLE's sweeps stop at the scene's tolerance. The linkage stands still under its own gravity.
CHAINS = {"four-bar": (ROOT + "/inputs/four-bar.yaml", {"forces.gravity": "[5, -9.81, 0]"}, 64 * EPS),
          "mixed": (MIXED, {}, 12 * 64 * EPS),
          "planar3, cylindrical tip": (sliding("planar3", CYLINDRICAL), {}, 12 * 64 * EPS),
          "cylindrical, planar3 tip": (sliding("cylindrical", PLANAR3), {}, 12 * 64 * EPS),
          "ring": (ROOT + "/inputs/ring.yaml", {}, 12 * 64 * EPS),
          "ring under RATTLE": (ROOT + "/inputs/ring.yaml", {"dynamics.integrator": "rattle", "dynamics.constraint_tolerance": 1e-14}, 1e-14),
          "ring of beads": (BEADS, {"dynamics.constraint_tolerance": 1e-14}, 1e-14),
          "rope": (ROOT + "/inputs/rope.yaml", {"dynamics.constraint_tolerance": 1e-14}, 1e-14)}


def check(runs, name, steps):
    scene, settings, bound = CHAINS[name]
    scene = scene if isinstance(scene, str) else runs.write(name, scene)
    table = columns(runs.run(name, scene, settings | {"dynamics.steps": steps, "output.every": max(1, steps // 1000), "output.observables": "[energy, constraint_error]"}))
    worst, energy = table["constraint_error"].max(), table["total_energy"]
    print(f"        {name}: energy moved by {abs(energy - energy[0]).max():.1e} J of {table['kinetic_energy'].max():.3g} J kinetic")
    return verdict(name, worst <= bound, f"closed to {worst:.1e} (bound {bound:g}) over {steps} steps")


options = arguments(__doc__, steps=10000)
with Runs(options) as runs:
    good = [check(runs, name, 1000 if options.quick else options.steps) for name in CHAINS]
sys.exit(0 if all(good) else 1)
