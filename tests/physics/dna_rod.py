"""A DNA-like rod (2,000 equal rods on spherical joints, 50 nm of persistence in bending, 100 nm in twist) under implicit-g-baoab at a step
20 times the explicit limit: <R^2> of stretches, the bending cosine and the variance of twist are those of exp(-U / kT) over the joints'
rotations, weighed by the root of det(M + B) (weight()), within 3 standard errors. Starts are drawn from equilibrium without that weight, so
that what is shown is that the integrator keeps it. Long waves hardly move while a run lasts: what a chain began with is in all its frames,
and only other chains tell how far off that may be. Errors are therefore those of the mean over independent chains.

Then what a result costs: rods of 34 nm, short enough to forget their start many times over, under either scheme, the explicit one at a third
of its limit, where its springs turn as far in a step as the implicit ones do: the time to 1 % of statistical error of the twist's variance
and of <R^2>, by blocks. A quarter of an hour, too long for a test. Usage: dna_rod.py [--quick]"""
import os
import sys
import time

import h5py
import numpy as np
from catena import ROOT, Runs, arguments, blocked_error, columns, verdict

options = arguments(__doc__, bodies=2000, chains=16, steps=1200, times=20.0, friction=0.02, seed=1, cost_bodies=100, cost_time=100.0)
bodies, steps, cost_time = (300, 400, 10.0) if options.quick else (options.bodies, options.steps, options.cost_time)
EVERY = 20   # implicit steps between frames, half the time that a twist's memory takes
LENGTH, BEND, TWIST, MASS, RADIUS, KT = 0.34, 50.0, 100.0, 650.0, 1.0, 300 * 0.00831446261815324
ROTOR = 8.0   # B = ROTOR h^2 K of implicit-g-baoab
STRETCHES = [s for s in (10, 30, 100, 300) if 3 * s <= bodies]


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


def observed(folder, chains, stretches):
    """By name: frames x chains."""
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        q = file["catena/orientation/value"][1:]   # the start is drawn, no sample
    found = {name: [] for name in ["<cos>", "twist"] + [f"<R^2> of {s}" for s in stretches]}
    for chain in np.split(q, chains, axis=1):
        w, v = chain[..., 0], chain[..., 1:]
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
        found["<cos>"].append((axis[:, 1:] * axis[:, :-1]).sum(-1).mean(1))
        found["twist"].append((twist**2).mean(1))
        for s in stretches:
            found[f"<R^2> of {s}"].append(((ends[:, s:] - ends[:, :-s]) ** 2).sum(-1).mean(1))
    return {name: np.stack(values, axis=1) for name, values in found.items()}


def expected(rotor, stretches):
    c, twist = exact()
    of_bend, of_twist = weight(rotor)
    c, twist = 1 - (1 - c) * of_bend, twist * of_twist
    return {"<cos>": c, "twist": twist} | {f"<R^2> of {s}": square_of(s, c) for s in stretches}


def scene(chains, bodies, integrator, step, steps, every, backend):
    rod = {"bodies": bodies, "mass": MASS, "length": LENGTH, "radius": RADIUS, "bend": BEND, "twist": TWIST}
    return {"units": "md",
            "chains": [{"velocities": "thermal", "generator": {"elastic_rod": rod | {"seed": options.seed + k}}} for k in range(chains)],
            "dynamics": {"integrator": integrator, "step": step, "steps": steps, "temperature": 300, "friction": options.friction,
                         "seed": options.seed, "constraint_tolerance": 1e-8},
            "output": {"every": every, "observables": ["energy"]}, "solver": {"backend": backend}}


def is_stable(runs, step):
    """RATTLE over some hundred periods of the stiffest mode: beyond the limit it grows by orders of magnitude."""
    try:
        folder, _ = run(runs, "limit", 1, bodies, "rattle", step, 400, 50, "segments")
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


def run(runs, name, chains, bodies, integrator, step, steps, every, backend):
    """The run's folder, and how many seconds it took."""
    begin = time.perf_counter()
    folder = runs.run(name, runs.write(name, scene(chains, bodies, integrator, float(step), int(steps), int(every), backend)), {})
    return folder, time.perf_counter() - begin


def check(name, mean, error, wanted):
    away = (mean - wanted) / error
    return verdict(name, abs(away) <= 3, f"{mean:.5g} +- {error:.2g}, expected {wanted:.5g}: {away:+.1f} standard errors")


def statistics(runs, step):
    folder, seconds = run(runs, "implicit", options.chains, bodies, "implicit-g-baoab", step, steps, EVERY, "openmp")
    print(f"        {options.chains} chains of {bodies} rods, {steps} steps of {step:.3g} ps, friction {options.friction}/ps: {seconds:.0f} s")
    good, theory = True, expected(ROTOR * step**2, STRETCHES)
    for key, values in observed(folder, options.chains, STRETCHES).items():
        chains = values.mean(axis=0)
        good &= check(f"implicit: {key}", chains.mean(), chains.std(ddof=1) / np.sqrt(len(chains)), theory[key])
    return good


def cost(runs, name, integrator, step, picoseconds, rotor):
    """Seconds on one core to 1 % of each."""
    rods = options.cost_bodies
    steps, every = round(picoseconds / step), max(1, round(EVERY * options.times * limit / step))
    folder, seconds = run(runs, name, 1, rods, integrator, step, steps, every, "segments")
    print(f"        {name}: {rods} rods, {steps} steps of {step:.3g} ps: {seconds:.0f} s")
    theory, good, needed = expected(rotor, [rods // 10, rods]), True, {}
    for key, values in observed(folder, 1, [rods // 10, rods]).items():
        mean, error = values[:, 0].mean(), blocked_error(values[:, 0])
        needed[key] = seconds * (error / (0.01 * (1 - mean if key == "<cos>" else mean))) ** 2
        good &= check(f"{name}: {key}", mean, error, theory[key])
    return good, needed


if __name__ == "__main__":
    with Runs(options) as runs:
        limit = explicit_limit(runs)
        step = options.times * limit
        print(f"        explicit limit: {limit:.3g} ps")
        good = statistics(runs, step)
        held, implicit = cost(runs, "short, implicit", "implicit-g-baoab", step, 4000 * cost_time, ROTOR * step**2)
        kept, explicit = cost(runs, "short, explicit", "g-baoab", 0.35 * limit, 1000 * cost_time, 0)
        for key in implicit:
            print(f"        seconds to 1 % of {key}: implicit {implicit[key]:.3g}, explicit {explicit[key]:.3g}, {explicit[key] / implicit[key]:.2g} times")
    sys.exit(0 if good and held and kept else 1)
