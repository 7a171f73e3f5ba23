"""A DNA-like rod (2,000 equal rods on spherical joints, 50 nm of persistence in bending, 100 nm in twist) under implicit-g-baoab at a step
20 times the explicit limit: <R^2> of stretches, the bending cosine and the variance of twist are those of the ensemble of rigid joints with
the springs' rotors, exp(-U / kT) over the joints' rotations, weighed by the root of det(M + B), within 3 standard errors. Long waves hardly
move while a run lasts, and only other chains tell how far off they may be: errors are those of the mean over independent chains.

Then what a result costs: rods of 34 nm, short enough to forget their start many times over, under either scheme with the same friction, the
explicit one at a third of its limit, where its springs turn as far in a step as the implicit ones do: the time to 1 % of statistical error
of the twist's variance and of <R^2>, by blocks. A quarter of an hour, too long for a test. Usage: dna_rod.py [--quick]"""
import os
import sys
import time

import h5py
import numpy as np
from catena import Runs, arguments, blocked_error, columns, verdict

options = arguments(__doc__, bodies=2000, chains=16, steps=1200, times=20.0, friction=0.02, seed=1, cost_bodies=100, cost_time=100.0)
bodies, steps, cost_time = (300, 400, 10.0) if options.quick else (options.bodies, options.steps, options.cost_time)
EVERY = 20   # implicit steps between frames, half the time that a twist's memory takes
LENGTH, BEND, TWIST, MASS, RADIUS, KT = 0.34, 50.0, 100.0, 650.0, 1.0, 300 * 0.00831446261815324
ROTOR = 2.0   # B = ROTOR h^2 K of implicit-g-baoab
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


def half_log_det(turn, rotor):
    """1/2 log det(M + B) of chains with relative rotations turn (chains x joints x 3 x 3), B = rotor K, by articulated bodies from tip to
    base: what each joint's pivots contribute, and the base's. Moments about a rod's inboard end, angular first."""
    arm, inertia = 0.5 * LENGTH, np.diag([0.5 * RADIUS**2] + [(3 * RADIUS**2 + LENGTH**2) / 12] * 2)
    shift = hat(np.array([arm, 0.0, 0.0]))
    rod = MASS * np.block([[inertia - shift @ shift, shift], [-shift, np.eye(3)]])
    lever = np.block([[np.eye(3), hat(np.array([LENGTH, 0.0, 0.0]))], [np.zeros((3, 3)), np.eye(3)]])
    spring = np.diag(rotor * KT / LENGTH * np.array([TWIST, BEND, BEND]))
    whole, total = np.broadcast_to(rod, (len(turn), 6, 6)), 0.0
    for k in reversed(range(turn.shape[1])):
        pivot, across = whole[:, :3, :3] + spring, whole[:, :, :3]
        total = total + 0.5 * np.linalg.slogdet(pivot)[1]
        rest = whole - across @ np.linalg.solve(pivot, across.swapaxes(1, 2))
        rotated = np.empty_like(rest)
        for a in (slice(0, 3), slice(3, 6)):
            for b in (slice(0, 3), slice(3, 6)):
                rotated[:, a, b] = turn[:, k] @ rest[:, a, b] @ turn[:, k].swapaxes(1, 2)
        whole = lever @ rotated @ lever.T + rod
        whole = 0.5 * (whole + whole.swapaxes(1, 2))
    return total + 0.5 * np.linalg.slogdet(whole)[1]


def averages(turn, twist, stretches):
    """By name: one number a chain."""
    axis = np.empty(turn.shape[:1] + (turn.shape[1] + 1, 3))
    frame = np.broadcast_to(np.eye(3), (len(turn), 3, 3))
    axis[:, 0] = [1, 0, 0]
    for k in range(turn.shape[1]):
        frame = frame @ turn[:, k]
        axis[:, k + 1] = frame[:, :, 0]
    ends = np.concatenate([np.zeros_like(axis[:, :1]), LENGTH * np.cumsum(axis, axis=1)], axis=1)
    found = {"1 - <cos>": 1 - (axis[:, 1:] * axis[:, :-1]).sum(-1).mean(1), "twist": (twist**2).mean(1)}
    return found | {f"<R^2> of {s}": ((ends[:, s:] - ends[:, :-s]) ** 2).sum(-1).mean(1) for s in stretches}


def weight(rotor, rods, stretches, chains=4000):
    """By what the weight sqrt(det(M + B)) multiplies 1 - <cos>, the variance of twist and <R^2>, and the standard errors: chains with
    independent rotations of their joints, weighed."""
    rng, some = np.random.default_rng(1), []
    for _ in range(0, chains, 500):
        v = rng.normal(size=(500, rods - 1, 3)) * np.sqrt(LENGTH / np.array([TWIST, BEND, BEND]))
        turn = rotation(v)
        even = 2 * np.log(np.abs(np.sinc(np.linalg.norm(v, axis=-1) / 2 / np.pi))).sum(1)   # rotations, of rotation vectors
        some.append((half_log_det(turn, rotor), even, averages(turn, v[..., 0], stretches)))
    half, even = (np.concatenate([each[i] for each in some]) for i in (0, 1))
    even = np.exp(even - even.max())
    both = even * np.exp(half - half.max())
    factors = {}
    for name in some[0][2]:
        x = np.concatenate([each[2][name] for each in some])
        weighed, plain = (both * x).sum() / both.sum(), (even * x).sum() / even.sum()
        scatter = both / both.sum() * (x - weighed) / weighed - even / even.sum() * (x - plain) / plain
        factors[name] = (weighed / plain, np.sqrt((scatter**2).sum()))
    return factors


def square_of(s, c):
    return LENGTH**2 * (s * (1 + c) / (1 - c) - 2 * c * (1 - c**s) / (1 - c) ** 2)


def rotation_vectors(q):
    """Of successive rods against each other, in their axes: frames x joints x 3."""
    w, v = q[..., 0], q[..., 1:]
    scalar = w[:, :-1] * w[:, 1:] + (v[:, :-1] * v[:, 1:]).sum(-1)   # conj(q_k) q_k+1
    vector = w[:, :-1, None] * v[:, 1:] - w[:, 1:, None] * v[:, :-1] - np.cross(v[:, :-1], v[:, 1:])
    sine = np.linalg.norm(vector, axis=-1)
    angle = 2 * np.arctan2(sine, scalar)
    angle = np.where(angle > np.pi, angle - 2 * np.pi, angle)
    return vector * np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 2)[..., None]


def observed(folder, chains, stretches, rotor):
    """By name: frames x chains. And 1/2 log det(M + B) of each chain's start, which is drawn without that weight and no sample."""
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        of_chain = np.split(file["catena/orientation/value"][:], chains, axis=1)
    found, starts = [], []
    for q in of_chain:
        v = rotation_vectors(q)
        found.append(averages(rotation(v[1:]), v[1:, :, 0], stretches))
        starts.append(half_log_det(rotation(v[:1]), rotor)[0])
    return {name: np.stack([each[name] for each in found], axis=1) for name in found[0]}, np.array(starts)


def expected(rotor, rods, stretches):
    """By name: the mean and how well it is known."""
    c, twist = exact()
    factors = weight(rotor, rods, stretches)
    even = {"1 - <cos>": 1 - c, "twist": twist} | {f"<R^2> of {s}": square_of(s, c) for s in stretches}
    return {name: (even[name] * factor, even[name] * error) for name, (factor, error) in factors.items()}


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
    if not is_stable(runs, low):
        sys.exit(f"RATTLE does not run at {low} ps, far below the limit")
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
    """`wanted`: a mean and its error."""
    error = np.hypot(error, wanted[1])
    away = (mean - wanted[0]) / error
    return verdict(name, abs(away) <= 3, f"{mean:.5g} +- {error:.2g}, expected {wanted[0]:.5g}: {away:+.1f} standard errors")


def statistics(runs, step):
    """What chains drawn without the weight come to is weighed by it: each then is in equilibrium from its start on, however little it moves."""
    rotor = ROTOR * step**2
    folder, seconds = run(runs, "implicit", options.chains, bodies, "implicit-g-baoab", step, steps, EVERY, "openmp")
    print(f"        {options.chains} chains of {bodies} rods, {steps} steps of {step:.3g} ps, friction {options.friction}/ps: {seconds:.0f} s")
    theory = expected(rotor, bodies, STRETCHES)
    found, starts = observed(folder, options.chains, STRETCHES, rotor)
    share = np.exp(starts - starts.max())
    share /= share.sum()
    print(f"        the chains' weights count as {1 / (share**2).sum():.1f} equal ones")
    good = True
    for key, values in found.items():
        chains = values.mean(axis=0)
        mean = (share * chains).sum()
        error = np.sqrt((share**2 * (chains - mean) ** 2).sum() * len(share) / (len(share) - 1))
        good &= check(f"implicit: {key}", mean, error, theory[key])
    return good


def cost(runs, name, integrator, step, picoseconds, rotor):
    """Seconds on one core to 1 % of each."""
    rods = options.cost_bodies
    stretches = [rods // 10, rods]
    steps, every = round(picoseconds / step), max(1, round(EVERY * options.times * limit / step))
    folder, seconds = run(runs, name, 1, rods, integrator, step, steps, every, "segments")
    print(f"        {name}: {rods} rods, {steps} steps of {step:.3g} ps: {seconds:.0f} s")
    theory, good, needed = expected(rotor, rods, stretches), True, {}
    for key, values in observed(folder, 1, stretches, rotor)[0].items():
        mean, error = values[:, 0].mean(), blocked_error(values[:, 0])
        needed[key] = seconds * (error / (0.01 * mean)) ** 2
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
