"""Kinetic temperature of alpha-synuclein (CALVADOS 2) under g-BAOAB at friction 1/ps: within three blocked standard errors of 300 K,
these below 0.5 % (dof = 3 N - links). Usage: temperature.py [--quick] [--steps N]"""
import sys

from catena import ROOT, Runs, arguments, blocked_error, columns, verdict

options = arguments(__doc__, steps=120000)
steps = 12000 if options.quick else options.steps
with Runs(options) as runs:
    folder = runs.run("temperature", ROOT + "/inputs/alpha-synuclein.yaml",
                      {"dynamics.integrator": "g-baoab", "dynamics.friction": 1.0, "dynamics.steps": steps, "output.every": 10,
                       "output.observables": "[temperature, constraint_error]"})
    table = columns(folder)
temperature = table["temperature"][table["time"] > 10.0]
mean, error = temperature.mean(), blocked_error(temperature)
limit = 0.02 if options.quick else 0.005
text = f"{mean:.2f} +- {error:.2f} K over {steps * 1e-5:g} ns (300 K asked, standard error {100 * error / 300:.2f} %, limit {100 * limit:g} %)"
sys.exit(0 if verdict("temperature", abs(mean - 300) <= 3 * error and error <= limit * 300, text) else 1)
