"""The angles of a star of three arms under g-BAOAB are those of the constrained ensemble, weight sqrt(det T), with equal and unequal
masses; with the Fixman potential the arms are independent. Moments agree within three and a half standard errors with
tests/data/reference/star-statistics.json, and a chi-square test accepts the distribution of the first angle. Usage: star.py [--quick]"""
import json
import os
import sys

import h5py
import numpy as np
from catena import ROOT, Runs, arguments, verdict
from scipy.stats import chi2

KT_OF_ONE = 1 / 0.00831446261815324  # K: kT is 1 kJ/mol, so that masses, links and times are about 1
SAMPLE_TIME = 15.0  # time between samples
options = arguments(__doc__, chains=1000, frames=100)
chains, frames = (options.chains, 12) if options.quick else (options.chains, options.frames)
with open(os.path.join(ROOT, "tests", "data", "reference", "star-statistics.json")) as file:
    STARS = json.load(file)["star"]


def scene_of(masses, step, fixman):
    arms, every = masses["arms"], round(SAMPLE_TIME / step)
    bodies = [{"mass": masses["centre"], "position": [0, 0, 0]}]
    for mass, position in zip(arms, ([1, 0, 0], [0, 1, 0], [0, 0, 1])):
        bodies.append({"mass": mass, "position": position, "parent": 1, "joint": {"type": "link", "length": 1}})
    return {"chains": [{"name": "star", "count": chains, "bodies": bodies}],
            "dynamics": {"integrator": "g-baoab", "step": step, "steps": every * frames, "temperature": KT_OF_ONE, "friction": 1.0, "seed": 3,
                         "fixman": fixman},
            "output": {"every": every, "observables": ["temperature", "constraint_error"]}}


def cosines(folder):
    """cos 12, cos 13, cos 23 of each star and frame."""
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        x = file["particles/trajectory/position/value"][1:]  # the start is no sample
    x = x.reshape(x.shape[0], -1, 4, 3)
    u = x[:, :, 1:] - x[:, :, :1]
    u /= np.linalg.norm(u, axis=-1, keepdims=True)
    return np.stack([(u[:, :, i] * u[:, :, j]).sum(-1) for i, j in ((0, 1), (0, 2), (1, 2))], axis=-1)


def p_value(samples, probabilities):
    observed, _ = np.histogram(samples, STARS["cos_bin_edges"])
    expected = np.array(probabilities) * samples.size
    return chi2.sf(((observed - expected) ** 2 / expected).sum(), len(expected) - 1)


def check(runs, name, masses, step, theory, fixman):
    folder = runs.run(name, runs.write(name, scene_of(masses, step, fixman)), {})
    c = cosines(folder)
    correlation = np.mean([np.corrcoef(c[i, :, 0], c[i + 1, :, 0])[0, 1] for i in range(len(c) - 1)])
    c = c.reshape(-1, 3)
    good = verdict(f"{name}, decorrelated", abs(correlation) < 0.05, f"{correlation:+.4f}, {len(c)} stars")
    for what, values in (("cos12_squared", c[:, 0] ** 2), ("cos13_squared", c[:, 1] ** 2), ("cos23_squared", c[:, 2] ** 2),
                         ("cos12_fourth", c[:, 0] ** 4), ("cos12_cos13_cos23", c.prod(axis=1))):
        if what not in theory:
            continue
        off = (values.mean() - theory[what]) / (values.std() / np.sqrt(len(values)))
        good &= verdict(f"{name}, {what}", abs(off) < 3.5, f"{values.mean():.4f}, theory {theory[what]:.4f}, {off:+.1f} standard errors")
    if "cos12_bin_probabilities" in theory:
        p = p_value(c[:, 0], theory["cos12_bin_probabilities"])
        good &= verdict(f"{name}, distribution", p > 1e-3, f"p = {p:.3g}, accepted above 1e-3")
    return good


with Runs(options) as runs:
    good = True
    for name, step in (("equal_masses", 0.05), ("light_centre", 0.02), ("unequal_arms", 0.05)):
        good &= check(runs, name, STARS["cases"][name]["masses"], step, STARS["cases"][name], False)
    good &= check(runs, "with_fixman", STARS["cases"]["light_centre"]["masses"], 0.02, STARS["with_fixman"], True)
sys.exit(0 if good else 1)
