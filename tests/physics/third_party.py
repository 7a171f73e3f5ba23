"""Accelerations against Pinocchio on random chains made here: every joint kind that both have, fixed and free bases, loads on bodies and
joints. Its joint-space inertia and inverse dynamics, solved densely, are the reference: in double its articulated-body algorithm loses up
to ten digits on long chains of spherical joints, which is printed beside. Skipped (status 77) without the Python module `pinocchio` (PyPI: pin).
Usage: third_party.py [--chains N] [--bodies N] [--write FILE]
`--write` writes the chains with cylindrical and planar3 joints and Pinocchio's accelerations (tests/data/reference/README.md), and ends."""
import json
import sys

import numpy as np
from catena import Runs, arguments, verdict

try:
    import pinocchio as pin
except ImportError as error:
    print(f"SKIPPED: not compared with Pinocchio: {error} (python3 -m pip install pin)")
    sys.exit(77)

GRAVITY = np.array([1.0, -2.0, -9.81])


def direction(random):
    v = random.normal(size=3)
    return v / np.linalg.norm(v)


def quaternion(random):
    return direction_of(random.normal(size=4))


def direction_of(v):
    return v / np.linalg.norm(v)


def rotation(random):
    w, x, y, z = quaternion(random)
    return pin.Quaternion(w, x, y, z).toRotationMatrix()


def joint(random, kind):
    """The scene's entry; Pinocchio's joint; q and q' as Pinocchio has them."""
    axis, q, v = direction(random), random.uniform(-1, 1), random.uniform(-1, 1)
    if kind == "free":
        position, turn, omega, velocity = random.uniform(-1, 1, 3), quaternion(random), random.uniform(-1, 1, 3), random.uniform(-1, 1, 3)
        entry = {"q": {"position": position.tolist(), "quaternion": turn.tolist()}, "qd": {"omega": omega.tolist(), "velocity": velocity.tolist()}}
        body = pin.Quaternion(*turn).toRotationMatrix().T @ velocity
        return entry, pin.JointModelFreeFlyer(), np.concatenate([position, turn[[1, 2, 3, 0]]]), np.concatenate([body, omega])
    if kind == "spherical":
        turn, omega = quaternion(random), random.uniform(-1, 1, 3)
        return {"q": turn.tolist(), "qd": omega.tolist()}, pin.JointModelSpherical(), turn[[1, 2, 3, 0]], omega
    if kind == "universal":
        second = direction_of(np.cross(axis, direction(random)))   # Pinocchio wants a right angle
        angles, rates = random.uniform(-1, 1, 2), random.uniform(-1, 1, 2)
        return {"axes": [axis.tolist(), second.tolist()], "q": angles.tolist(), "qd": rates.tolist()}, pin.JointModelUniversal(axis, second), angles, rates
    if kind == "cylindrical":
        q, v = random.uniform(-1, 1, 2), random.uniform(-1, 1, 2)
        return {"axis": axis.tolist(), "q": q.tolist(), "qd": v.tolist()}, composite([pin.JointModelRevoluteUnaligned(axis), pin.JointModelPrismaticUnaligned(axis)]), q, v
    if kind == "planar3":
        first = direction_of(np.cross(axis, direction(random)))
        q, v = random.uniform(-1, 1, 3), random.uniform(-1, 1, 3)
        if random.uniform() < 0.5:   # Pinocchio's own planar joint, in the plane of the joint frame's x and y, with velocities along the body's axes
            turn = turn_by(q[2])
            return {"axes": [[1, 0, 0], [0, 0, 1]], "q": q.tolist(), "qd": v.tolist()}, pin.JointModelPlanar(), [q[0], q[1], turn[0, 0], turn[1, 0]], np.append(turn.T @ v[:2], v[2])
        slides = [pin.JointModelPrismaticUnaligned(first), pin.JointModelPrismaticUnaligned(np.cross(axis, first))]
        return {"axes": [first.tolist(), axis.tolist()], "q": q.tolist(), "qd": v.tolist()}, composite(slides + [pin.JointModelRevoluteUnaligned(axis)]), q, v
    entry = {"axis": axis.tolist(), "q": q, "qd": v}
    if kind == "helical":
        pitch = random.uniform(0.05, 0.3)
        return entry | {"pitch": pitch}, pin.JointModelHelicalUnaligned(axis, pitch), [q], [v]
    model = pin.JointModelRevoluteUnaligned if kind == "revolute" else pin.JointModelPrismaticUnaligned
    return entry, model(axis), [q], [v]


def turn_by(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def composite(parts):
    model = pin.JointModelComposite()
    for part in parts:
        model.addJoint(part)
    return model


def inertia(random, mass):
    """About the centre of mass, of random second moments about random axes."""
    s, r = mass * random.uniform(0.05, 0.15, 3), rotation(random)
    return r @ np.diag([s[1] + s[2], s[2] + s[0], s[0] + s[1]]) @ r.T


class Chain:
    """One random chain: the entry of a scene, and its accelerations by Pinocchio in the same order."""

    def __init__(self, seed, bodies):
        random = np.random.default_rng(seed)
        free = seed % 2 == 1
        every = ["revolute", "spherical", "universal", "prismatic", "helical", "cylindrical", "planar3"]
        kinds = ([[kind] for kind in every] + [every])[seed // 2 % 8]
        model, q, v, tau, wrenches, entries = pin.Model(), [], [], [], [], []
        model.gravity.linear = GRAVITY
        self.planar = []   # per body the turn of Pinocchio's planar joint, whose components are along the body's axes
        self.kinds = ["free" if free and k == 0 else str(random.choice(kinds)) for k in range(bodies)]
        for k, kind in enumerate(self.kinds):
            entry, model_of_joint, q_k, v_k = joint(random, kind)
            turn, shift = (np.eye(3), np.zeros(3)) if kind == "free" else (rotation(random), random.uniform(-0.5, 0.5, 3))
            torque = np.zeros(6) if kind == "free" else random.uniform(-1, 1, len(v_k))
            planar = isinstance(model_of_joint, pin.JointModelPlanar)
            mass, com = random.uniform(0.5, 2), random.uniform(-0.3, 0.3, 3)
            j, wrench = inertia(random, mass), random.uniform(-1, 1, 6)
            added = model.addJoint(k, model_of_joint, pin.SE3(turn, shift), f"joint {k}")
            model.appendBodyToJoint(added, pin.Inertia(mass, com, j), pin.SE3.Identity())
            q.append(q_k), v.append(v_k), wrenches.append(wrench)
            tau.append(np.append(turn_by(entry["q"][2]).T @ torque[:2], torque[2]) if planar else torque)
            self.planar.append(turn_by(entry["q"][2]) if planar else None)
            if kind != "free":
                entry |= {"rotation": turn.tolist(), "translation": shift.tolist(), "torque": torque.tolist() if len(torque) > 1 else float(torque[0])}
            entries.append({"mass": mass, "com": com.tolist(), "inertia": j.tolist(), "joint": {"type": kind} | entry,
                            "wrench": {"torque": wrench[3:].tolist(), "force": wrench[:3].tolist()}})
        self.scene = {"name": f"seed {seed}", "base": "free" if free else "fixed", "bodies": entries}
        self.expected = self.accelerations(model, np.concatenate(q), np.concatenate(v), np.concatenate(tau), wrenches)

    def accelerations(self, model, q, v, tau, wrenches):
        data = model.createData()
        pin.forwardKinematics(model, data, q, v)
        external = pin.StdVec_Force()
        external.append(pin.Force.Zero())
        for k, wrench in enumerate(wrenches):   # given at the centre of mass in ground axes, wanted at the joint in its axes
            at = pin.SE3(np.eye(3), data.oMi[k + 1].rotation @ model.inertias[k + 1].lever)
            at_joint = at.act(pin.Force(wrench))
            external.append(pin.Force(data.oMi[k + 1].rotation.T @ at_joint.linear, data.oMi[k + 1].rotation.T @ at_joint.angular))
        upper = np.triu(pin.crba(model, data, q))
        inertia_matrix = upper + np.triu(upper, 1).T
        needed = pin.rnea(model, model.createData(), q, v, np.zeros(model.nv), external)
        a = np.linalg.solve(inertia_matrix, tau - needed)
        self.condition = np.linalg.cond(inertia_matrix)
        self.of_aba = np.abs(pin.aba(model, model.createData(), q, v, tau, external) - a).max() / np.abs(a).max()
        found = []
        for k, kind in enumerate(self.kinds):
            first = model.joints[k + 1].idx_v
            own = a[first:first + model.joints[k + 1].nv]
            if kind == "free":   # the origin's acceleration in ground axes from the derivative of the velocity's components
                own = np.concatenate([own[3:], data.oMi[1].rotation @ (own[:3] + np.cross(v[3:6], v[:3]))])
            if self.planar[k] is not None:
                rates = v[first:first + 3]
                own = np.append(self.planar[k] @ (own[:2] + rates[2] * np.array([-rates[1], rates[0]])), own[2])
            found.append(own)
        return found


def flat(entry):
    if isinstance(entry, dict):
        return np.concatenate([entry["alpha"], entry["acceleration"]])
    return np.atleast_1d(np.asarray(entry, dtype=float))


def write(path, chains):
    """Chains that have the joints which Pinocchio composes of others, as scenes, with its accelerations and the condition of its matrix."""
    kept = [c for c in chains if {"cylindrical", "planar3"} & set(c.kinds)]
    with open(path, "w") as file:
        json.dump({"source": f"Pinocchio {pin.__version__}: crba and rnea, solved densely in double", "units": "si", "gravity": GRAVITY.tolist(),
                   "chains": [{"chain": c.scene, "accelerations": [a.tolist() for a in c.expected], "condition": c.condition} for c in kept]}, file)


options = arguments(__doc__, chains=200, bodies=40, write="")
chains = [Chain(seed, 1 + (7 * seed) % options.bodies) for seed in range(options.chains)]
if options.write:
    write(options.write, chains)
    sys.exit(0)
with Runs(options) as runs:
    solved = runs.solve("pinocchio", {"units": "si", "forces": {"gravity": GRAVITY.tolist()}, "chains": [c.scene for c in chains]})
found = iter(solved["joint_accelerations"])
worst, over_bound = {}, 0
for chain in chains:
    pairs = [(flat(next(found)), expected) for expected in chain.expected]
    error = max(np.abs(a - b).max() for a, b in pairs) / max(np.abs(b).max() for _, b in pairs)
    name = "+".join(sorted(set(chain.kinds) - {"free"})) if len(set(chain.kinds)) < 4 else "every kind"
    before = worst.get(name, (0, 0))
    worst[name] = (max(before[0], error), max(before[1], chain.of_aba))
    over_bound = max(over_bound, error / max(1e-11, chain.condition * 2.0**-53))   # of the dense solution
for name, (error, of_aba) in worst.items():
    print(f"        {name or 'free body'}: {error:.1e} (Pinocchio's articulated bodies {of_aba:.1e})")
error = max(e for e, _ in worst.values())
sys.exit(0 if verdict("pinocchio", over_bound <= 1, f"{len(chains)} random chains within {error:.1e} of Pinocchio {pin.__version__}, {over_bound:.2f} of the bound: 1e-11 or condition x eps") else 1)
