"""The dihedral angle of two triangles on a common edge, three links and two cross-links, under g-BAOAB is that of the constrained
ensemble, weight sqrt(det T), for equal masses and a light edge; with the Fixman potential it is uniform. <cos f> and <cos^2 f> agree
within three and a half standard errors with tests/data/reference/star-statistics.json, and a chi-square test accepts the distribution.
Usage: butterfly.py [--quick]"""
import json
import os
import sys

import h5py
import numpy as np
from catena import ROOT, Runs, arguments, verdict
from scipy.stats import chi2

KT_OF_ONE = 1 / 0.00831446261815324  # K: kT is 1 kJ/mol, so that masses, links and times are about 1
SAMPLE_TIME = 15.0  # time between samples
FREEDOM = 7
options = arguments(__doc__, chains=1000, frames=100)
chains, frames = (options.chains, 12) if options.quick else (options.chains, options.frames)
with open(os.path.join(ROOT, "tests", "data", "reference", "star-statistics.json")) as file:
    BUTTERFLY = json.load(file)["butterfly"]


def scene_of(masses, step, fixman):
    every, high = round(SAMPLE_TIME / step), np.sqrt(3) / 2
    link = {"joint": {"type": "link", "length": 1}, "parent": 1}
    places = ([0, 0, 0], [1, 0, 0], [0.5, high, 0], [0.5, 0, high])
    bodies = [{"mass": mass, "position": [float(x) for x in place]} | (link if k > 0 else {})
              for k, (mass, place) in enumerate(zip(masses, places))]
    return {"chains": [{"name": "butterfly", "count": chains, "bodies": bodies, "crosslinks": [[2, 3, 1], [2, 4, 1]]}],
            "dynamics": {"integrator": "g-baoab", "step": step, "steps": every * frames, "temperature": KT_OF_ONE, "friction": 1.0, "seed": 3,
                         "fixman": fixman},
            "output": {"every": every, "observables": ["temperature", "constraint_error"]}}


def dihedrals(folder):
    """Angle between the triangles of each chain and frame."""
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        x = file["particles/trajectory/position/value"][1:]  # the start is no sample
    x = x.reshape(x.shape[0], -1, 4, 3).astype(float)
    edge = x[:, :, 1] - x[:, :, 0]
    edge /= np.linalg.norm(edge, axis=-1, keepdims=True)
    across = []
    for k in (2, 3):
        wing = x[:, :, k] - x[:, :, 0]
        wing -= (wing * edge).sum(-1, keepdims=True) * edge
        across.append(wing / np.linalg.norm(wing, axis=-1, keepdims=True))
    return np.arccos(np.clip((across[0] * across[1]).sum(-1), -1, 1))


def kinetic_temperature(folder):
    """Mean temperature over kT, and its standard error over the lines of the table."""
    table = np.genfromtxt(os.path.join(folder, "observables.csv"), delimiter=",", names=True)
    t = table["temperature_K"][1:] / KT_OF_ONE
    return t.mean(), t.std() / np.sqrt(len(t))


def check(runs, name, masses, step, theory, fixman):
    folder = runs.run(name, runs.write(name, scene_of(masses, step, fixman)), {})
    f = dihedrals(folder)
    correlation = np.mean([np.corrcoef(np.cos(f[i]), np.cos(f[i + 1]))[0, 1] for i in range(len(f) - 1)])
    f = f.reshape(-1)
    good = verdict(f"{name}, decorrelated", abs(correlation) < 0.06, f"{correlation:+.4f}, {len(f)} angles")
    for what, values in (("cos", np.cos(f)), ("cos_squared", np.cos(f) ** 2)):
        off = (values.mean() - theory[what]) / (values.std() / np.sqrt(len(values)))
        good &= verdict(f"{name}, {what}", abs(off) < 3.5, f"{values.mean():.4f}, theory {theory[what]:.4f}, {off:+.1f} standard errors")
    t, error = kinetic_temperature(folder)
    good &= verdict(f"{name}, temperature with {FREEDOM} degrees of freedom", abs(t - 1) < 4 * error + 0.002, f"{t:.4f}({error:.4f}) kT")
    probabilities = theory.get("dihedral_bin_probabilities", [1 / 12] * 12)
    observed, _ = np.histogram(f, np.linspace(0, np.pi, 13))
    expected = np.array(probabilities) * f.size
    p = chi2.sf(((observed - expected) ** 2 / expected).sum(), len(expected) - 1)
    return good & verdict(f"{name}, distribution", p > 1e-3, f"p = {p:.3g}, accepted above 1e-3")


with Runs(options) as runs:
    good = True
    for name, step in (("equal_masses", 0.05), ("light_edge", 0.02)):
        good &= check(runs, name, BUTTERFLY["cases"][name]["masses"], step, BUTTERFLY["cases"][name], False)
    good &= check(runs, "with_fixman", BUTTERFLY["cases"]["light_edge"]["masses"], 0.02, BUTTERFLY["with_fixman"], True)
sys.exit(0 if good else 1)
