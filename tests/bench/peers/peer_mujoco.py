"""MuJoCo's forward dynamics for `catena bench peers`. Usage: peer_mujoco.py CHAIN ACCELERATIONS"""
import mujoco
import numpy as np
from peer import BALL, REVOLUTE, SLIDE, serve

OFF = mujoco.mjtDisableBit
AXES = np.eye(3)


def quaternion(rotation):
    q = np.zeros(4)
    mujoco.mju_mat2Quat(q, rotation.ravel())
    return q


def add_joints(to, body):
    turn, slide = mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE
    if body.kind == REVOLUTE:
        to.add_joint(type=turn, axis=body.axis)
    elif body.kind == BALL:
        to.add_joint(type=mujoco.mjtJoint.mjJNT_BALL)
    else:
        for axis in AXES[:body.dof]:
            to.add_joint(type=slide if body.kind == SLIDE else turn, axis=axis)


def build(chain):
    spec = mujoco.MjSpec()
    spec.option.gravity = chain.gravity
    spec.option.disableflags = OFF.mjDSBL_CONTACT | OFF.mjDSBL_CONSTRAINT | OFF.mjDSBL_ACTUATION | OFF.mjDSBL_SENSOR
    inboard = spec.worldbody
    for body in chain.bodies:
        inboard = inboard.add_body(pos=body.translation, quat=quaternion(body.rotation), mass=body.mass, ipos=body.com,
                                   fullinertia=body.moments, explicitinertial=True)
        add_joints(inboard, body)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = np.concatenate([{REVOLUTE: b.q[:1], BALL: b.q}.get(b.kind, np.zeros(b.dof)) for b in chain.bodies])
    data.qvel[:] = np.concatenate([b.qd for b in chain.bodies])
    data.qfrc_applied[:] = np.concatenate([b.torque for b in chain.bodies])
    data.xfrc_applied[1:] = [np.concatenate([b.wrench_force, b.wrench_torque]) for b in chain.bodies]

    def evaluate():
        mujoco.mj_forward(model, data)
        return data.qacc
    return evaluate


serve("mujoco", mujoco.__version__, "mj_forward without contacts, constraints, actuators and sensors, by its Python module", build)
