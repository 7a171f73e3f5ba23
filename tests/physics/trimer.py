"""The angle of a freely-jointed trimer under g-BAOAB is that of the constrained ensemble, sqrt(det T) sin(theta) with
det T = (1/m1 + 1/m2)(1/m2 + 1/m3) - cos^2(theta) / m2^2: a chi-square test on decorrelated samples accepts it and rejects the
flexible chain's sin(theta) and the squared weight (1 - cos^2/4) sin(theta). With the Fixman potential it is the flexible chain's, and the
others are rejected. Usage: trimer.py [--quick]"""
import os
import sys

import h5py
import numpy as np
from catena import ROOT, Runs, arguments, verdict
from scipy.stats import chi2

options = arguments(__doc__, chains=1000, frames=100)
chains, frames = (options.chains, 12) if options.quick else (options.chains, options.frames)
BINS = 20


def cosines(folder):
    """theta is the angle between successive links."""
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        group = next(iter(file["particles"].values()))
        x = group["position/value"][1:]   # the start is no sample
    x = x.reshape(x.shape[0], -1, 3, 3)
    u, v = x[:, :, 1] - x[:, :, 0], x[:, :, 2] - x[:, :, 1]
    return ((u * v).sum(-1) / np.linalg.norm(u, axis=-1) / np.linalg.norm(v, axis=-1))


def p_value(samples, density):
    """Of the samples' cosines under a density in cos(theta)."""
    edges = np.linspace(-1, 1, BINS + 1)
    observed, _ = np.histogram(samples, edges)
    fine = np.linspace(-1, 1, 200 * BINS + 1)
    mass = density(0.5 * (fine[1:] + fine[:-1])).reshape(BINS, -1).sum(1)
    expected = mass / mass.sum() * samples.size
    return chi2.sf(((observed - expected) ** 2 / expected).sum(), BINS - 1)


ENSEMBLES = {"constrained ensemble": lambda c: np.sqrt(1 - c**2 / 4), "sin(theta)": lambda c: np.ones_like(c), "(1 - cos^2/4) sin(theta)": lambda c: 1 - c**2 / 4}


def check(runs, name, expected, theory, settings):
    """`theory`: the mean of cos^2 in the expected ensemble."""
    folder = runs.run(name, ROOT + "/inputs/freely-jointed-trimer.yaml",
                      {"chains[0].count": chains, "dynamics.steps": 600 * frames, "output.every": 600, "dynamics.friction": 1.0,
                       "output.observables": "[temperature, constraint_error]", **settings})
    cosine = cosines(folder)
    correlation = np.mean([np.corrcoef(cosine[i], cosine[i + 1])[0, 1] for i in range(len(cosine) - 1)])
    samples = cosine.ravel()
    p = {ensemble: p_value(samples, density) for ensemble, density in ENSEMBLES.items()}
    square = (samples**2).mean()
    print(f"        {name}: {samples.size} samples, correlation of successive frames {correlation:+.4f}, "
          f"<cos^2> = {square:.4f} +- {np.std(samples**2) / np.sqrt(samples.size):.4f} (theory {theory:.4f})")
    good = verdict("decorrelated", abs(correlation) < 0.03, f"{correlation:+.4f}")
    good &= verdict(expected, p[expected] > 1e-3, f"p = {p[expected]:.3g}, accepted above 1e-3")
    for other in ENSEMBLES:
        if other == expected:
            continue
        if options.quick:
            print(f"        {other}: p = {p[other]:.3g} (too few samples to ask for a rejection)")
        else:
            good &= verdict(other, p[other] < 1e-3, f"p = {p[other]:.3g}, rejected below 1e-3")
    return good


with Runs(options) as runs:
    good = check(runs, "rigid links", "constrained ensemble", 0.3210, {})
    good &= check(runs, "with the Fixman potential", "sin(theta)", 1 / 3, {"dynamics.fixman": "true"})
sys.exit(0 if good else 1)
