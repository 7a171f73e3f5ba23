"""A DNA-like rod (equal rods on spherical joints, 50 nm of persistence in bending, 100 nm in twist) under implicit-g-baoab at a step at least
20 times the explicit limit, beside g-baoab at a third of that limit, where its springs turn as far in a step as the implicit ones do: <R^2>
of stretches, the bending cosine and the variance of twist are those of exp(-U / kT) over the joints' rotations, weighed by the root of
det(M + B) (weight()), within 3 standard errors; and the time that either takes to 1 % of statistical error. Starts are drawn from
equilibrium without that weight, so that what is shown is that the integrators keep it. A few minutes, too long for a test. Usage:
dna_rod.py [--quick]"""
import os
import sys
import time

import h5py
import numpy as np
from catena import ROOT, Runs, arguments, blocked_error, columns, verdict

options = arguments(__doc__, bodies=2000, times=20.0, frames=150, every=20, friction=0.02, explicit_friction=0.02)
bodies, frames = (300, 160) if options.quick else (options.bodies, options.frames)
LENGTH, BEND, TWIST, MASS, RADIUS, KT = 0.34, 50.0, 100.0, 650.0, 1.0, 300 * 0.00831446261815324
ROTOR = 2.0   # B = ROTOR h^2 K of implicit-g-baoab
STRETCHES = [s for s in (10, 30, 100, 300) if 3 * s <= bodies]   # longer ones take longer to forget their start than runs last


def exact():
    """<cos> between successive rods and <x^2> of the twist: the density of a rotation vector is exp(-U / kT) (sin(a / 2) / (a / 2))^2."""
    x = np.linspace(-np.pi, np.pi, 4001)[:, None]
    r = np.linspace(0, np.pi, 2001)[None, :]
    angle = np.sqrt(x**2 + r**2)
    half = np.where(angle > 0, angle / 2, 1e-9)
    weight = np.exp(-(TWIST * x**2 + BEND * r**2) / (2 * LENGTH)) * (np.sin(half) / half) ** 2 * r * (angle < np.pi)
    along = np.cos(angle) + (1 - np.cos(angle)) * np.where(angle > 0, x / np.maximum(angle, 1e-9), 0) ** 2
    return (weight * along).sum() / weight.sum(), (weight * x**2).sum() / weight.sum()


def hat(v):
    zero = np.zeros(v.shape[:-1])
    rows = [[zero, -v[..., 2], v[..., 1]], [v[..., 2], zero, -v[..., 0]], [-v[..., 1], v[..., 0], zero]]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def rotation(v):
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    return np.eye(3) + np.sinc(angle / np.pi) * hat(v) + 0.5 * np.sinc(angle / 2 / np.pi) ** 2 * (hat(v) @ hat(v))


def weight(rotor, rods=16, samples=6000):
    """By what the weight sqrt(det(M + B)) multiplies 1 - <cos> and the variance of twist: independent rotations of a short chain's joints,
    weighed; B = rotor K. The joints in the middle third stand for those of a long chain."""
    rng = np.random.default_rng(1)
    v = rng.normal(size=(samples, rods - 1, 3)) * np.sqrt(LENGTH / np.array([TWIST, BEND, BEND]))
    turn, r = rotation(v), np.empty((samples, rods, 3, 3))
    r[:, 0] = np.eye(3)
    for k in range(1, rods):
        r[:, k] = r[:, k - 1] @ turn[:, k - 1]
    along = r[..., 0]
    joint = np.concatenate([np.zeros((samples, 1, 3)), LENGTH * np.cumsum(along[:, :-1], axis=1)], axis=1)
    center = joint + 0.5 * LENGTH * along
    inertia = np.diag([0.5 * RADIUS**2] + [(3 * RADIUS**2 + LENGTH**2) / 12] * 2) * MASS
    size = 6 + 3 * (rods - 1)
    m = np.zeros((samples, size, size)) + np.diag(np.concatenate([np.zeros(6), np.tile(rotor * KT / LENGTH * np.array([TWIST, BEND, BEND]), rods - 1)]))
    for k in range(rods):
        moving, turning = np.zeros((2, samples, 3, size))
        moving[:, :, :3] = turning[:, :, 3:6] = np.eye(3)
        moving[:, :, 3:6] = -hat(center[:, k])
        for j in range(1, k + 1):
            own = slice(3 + 3 * j, 6 + 3 * j)
            turning[:, :, own] = r[:, j]
            moving[:, :, own] = -hat(center[:, k] - joint[:, j]) @ r[:, j]
        m += MASS * moving.swapaxes(1, 2) @ moving + turning.swapaxes(1, 2) @ (r[:, k] @ inertia @ r[:, k].swapaxes(1, 2)) @ turning
    half = np.linalg.slogdet(m)[1] / 2
    even = np.prod(np.sinc(np.linalg.norm(v, axis=-1) / 2 / np.pi) ** 2, axis=1)   # rotations, of rotation vectors
    weighed = even * np.exp(half - half.mean())
    middle = slice(rods // 3, 2 * rods // 3)
    bend = 1 - (along[:, 1:] * along[:, :-1]).sum(-1)[:, middle].mean(1)
    twist = (v[..., 0] ** 2)[:, middle].mean(1)
    return [(weighed * x).sum() / weighed.sum() / ((even * x).sum() / even.sum()) for x in (bend, twist)]


def square_of(s, c):
    return LENGTH**2 * (s * (1 + c) / (1 - c) - 2 * c * (1 - c**s) / (1 - c) ** 2)


def observed(folder):
    """By name: one number a frame."""
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        q = file["catena/orientation/value"][1:]   # the start is drawn, no sample
    w, v = q[..., 0], q[..., 1:]
    axis = np.stack([1 - 2 * (v[..., 1] ** 2 + v[..., 2] ** 2), 2 * (v[..., 0] * v[..., 1] + w * v[..., 2]),
                     2 * (v[..., 0] * v[..., 2] - w * v[..., 1])], axis=-1)
    ends = np.concatenate([np.zeros_like(axis[:, :1]), LENGTH * np.cumsum(axis, axis=1)], axis=1)
    # conj(q_k) q_k+1
    scalar = w[:, :-1] * w[:, 1:] + (v[:, :-1] * v[:, 1:]).sum(-1)
    vector = w[:, :-1, None] * v[:, 1:] - w[:, 1:, None] * v[:, :-1] - np.cross(v[:, :-1], v[:, 1:])
    sine = np.linalg.norm(vector, axis=-1)
    angle = 2 * np.arctan2(sine, scalar)
    angle = np.where(angle > np.pi, angle - 2 * np.pi, angle)
    twist = vector[..., 0] * np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 2)
    found = {"<cos>": (axis[:, 1:] * axis[:, :-1]).sum(-1).mean(1), "twist": (twist**2).mean(1)}
    for s in STRETCHES:
        found[f"<R^2> of {s}"] = ((ends[:, s:] - ends[:, :-s]) ** 2).sum(-1).mean(1)
    return found


def expected(rotor):
    c, twist = exact()
    of_bend, of_twist = weight(rotor)
    c, twist = 1 - (1 - c) * of_bend, twist * of_twist
    return {"<cos>": c, "twist": twist} | {f"<R^2> of {s}": square_of(s, c) for s in STRETCHES}


def settings(integrator, step, steps, every, friction):
    return {"chains[0].generator.elastic_rod.bodies": bodies, "dynamics.integrator": integrator, "dynamics.step": step,
            "dynamics.steps": steps, "dynamics.friction": friction, "output.every": every, "output.observables": "[energy]",
            "solver.backend": "segments"}


SCENE = ROOT + "/inputs/dna-rod.yaml"


def is_stable(runs, step):
    """RATTLE over some hundred periods of the stiffest mode: beyond the limit it grows by orders of magnitude."""
    try:
        folder = runs.run("limit", SCENE, settings("rattle", step, 400, 50, 0) | {"output.observables": "[energy]"})
    except SystemExit:
        return False
    energy = columns(folder)["total_energy"]
    return bool(np.all(np.isfinite(energy)) and energy[-1] < 1.5 * energy[0])


def explicit_limit(runs):
    low, high = 0.1, 4.0
    while high / low > 1.05:
        middle = np.sqrt(low * high)
        low, high = (middle, high) if is_stable(runs, middle) else (low, middle)
    return low


def measure(runs, name, integrator, step, friction, every, rotor):
    begin = time.perf_counter()
    folder = runs.run(name, SCENE, settings(integrator, step, frames * every, every, friction))
    seconds = time.perf_counter() - begin
    good, theory = True, expected(rotor)
    print(f"        {name}: {frames * every} steps of {step:.4g} ps, friction {friction}/ps, {seconds:.1f} s")
    for key, values in observed(folder).items():
        mean, error = values.mean(), blocked_error(values)
        needed = seconds * (error / (0.01 * mean if key != "<cos>" else 0.01 * (1 - mean))) ** 2
        away = (mean - theory[key]) / error
        text = f"{mean:.5g} +- {error:.2g}, expected {theory[key]:.5g}: {away:+.1f} standard errors; {needed:.3g} s to 1 %"
        good &= verdict(f"{name}: {key}", abs(away) <= 3, text)
    return good


if __name__ == "__main__":
    with Runs(options) as runs:
        limit = explicit_limit(runs)
        print(f"        explicit limit: {limit:.3g} ps")
        good = measure(runs, "implicit", "implicit-g-baoab", options.times * limit, options.friction, options.every, ROTOR * (options.times * limit) ** 2)
        good &= measure(runs, "explicit", "g-baoab", 0.35 * limit, options.explicit_friction, options.every, 0)
    sys.exit(0 if good else 1)
