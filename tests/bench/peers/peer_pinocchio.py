"""Pinocchio's articulated-body algorithm for `catena bench peers`. Usage: peer_pinocchio.py CHAIN ACCELERATIONS local|world"""
import sys

import numpy as np
import pinocchio as pin
from peer import BALL, REVOLUTE, SLIDE, serve

CONVENTIONS = {"local": pin.Convention.LOCAL, "world": pin.Convention.WORLD}


def joint_of(body):
    """Pinocchio's joint and its q."""
    if body.kind == REVOLUTE:
        return pin.JointModelRevoluteUnaligned(body.axis), body.q[:1]
    if body.kind == BALL:
        return pin.JointModelSpherical(), body.q[[1, 2, 3, 0]]
    if body.kind == SLIDE:
        return pin.JointModelTranslation(), np.zeros(3)
    return pin.JointModelUniversal(np.array([1.0, 0, 0]), np.array([0, 1.0, 0])), np.zeros(2)


def at_joint(placement, inertia, body):
    """A wrench at the centre of mass in ground axes, as Pinocchio wants it: at the joint, in its axes."""
    force = placement.rotation.T @ body.wrench_force
    return pin.Force(force, placement.rotation.T @ body.wrench_torque + np.cross(inertia.lever, force))


def build(chain):
    model, q = pin.Model(), []
    model.gravity.linear = chain.gravity
    for k, body in enumerate(chain.bodies):
        joint, q_k = joint_of(body)
        added = model.addJoint(k, joint, pin.SE3(body.rotation, body.translation), f"joint {k}")
        model.inertias[added] = pin.Inertia(body.mass, body.com, body.inertia)   # what appends takes masses below 2^-52 for none
        q.append(q_k)
    data = model.createData()
    q, v, tau = (np.concatenate(parts) for parts in (q, [b.qd for b in chain.bodies], [b.torque for b in chain.bodies]))
    pin.forwardKinematics(model, data, q)
    convention = CONVENTIONS[sys.argv[3]]
    if not any(np.any(b.wrench_force) or np.any(b.wrench_torque) for b in chain.bodies):
        return lambda: pin.aba(model, data, q, v, tau, convention)
    external = pin.StdVec_Force()
    external.append(pin.Force.Zero())
    for k, body in enumerate(chain.bodies, start=1):
        external.append(at_joint(data.oMi[k], model.inertias[k], body))
    return lambda: pin.aba(model, data, q, v, tau, external, convention)


serve(f"pinocchio, {sys.argv[3]}", pin.__version__, f"aba, {sys.argv[3]} convention, by its Python module", build)
