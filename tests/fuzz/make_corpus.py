"""Writes the seeds of the targets xml, system and bodies into tests/fuzz/corpus. Needs OpenMM, h5py and numpy. Usage: make_corpus.py"""
import os
import shutil

import h5py
import numpy as np
import openmm
from openmm import unit

CORPUS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "corpus")


def system():
    """Three beads, with a force of each kind whose elements differ."""
    made = openmm.System()
    for mass in (100, 101, 102):
        made.addParticle(mass)
    made.addConstraint(0, 1, 0.38)
    made.setDefaultPeriodicBoxVectors(*(np.eye(3) * 5 * unit.nanometer))
    bonds = openmm.HarmonicBondForce()
    bonds.addBond(1, 2, 0.38, 8033)
    charges = openmm.NonbondedForce()
    for charge in (1, 0, -1):
        charges.addParticle(charge, 0.3, 0.5)
    charges.addException(0, 1, 0, 1, 0)
    own = openmm.CustomNonbondedForce("e*(s/r)^12; s=0.5*(s1+s2)")
    own.addGlobalParameter("e", 1)
    own.addPerParticleParameter("s")
    for _ in range(3):
        own.addParticle([0.4])
    own.addExclusion(0, 1)
    within = openmm.CustomCVForce("x")
    within.addCollectiveVariable("x", openmm.CustomBondForce("r"))
    for force in (bonds, charges, own, within, openmm.CMMotionRemover(100)):
        made.addForce(force)
    return made


def bodies(file, **options):
    """Three bodies on a fixed base, with every dataset, one of them compressed."""
    with h5py.File(file, "w", **options) as to:
        for name, value in {"mass": 1.0, "com": [0, 0, 0.5], "inertia": np.eye(3), "axis": [0, 0, 1.0], "first_axis": [1.0, 0, 0],
                            "pitch": 0.1, "q": np.zeros(4), "qd": np.zeros(3), "drag": [0.1, 0.1]}.items():
            to[name] = np.array([value] * 3)
        to["joint_type"] = np.array([4, 7, 3], "i4")
        to.create_dataset("translation", data=np.zeros((3, 3)), chunks=(2, 3), compression="gzip")


def texts(file):
    """Two bodies whose joints are named by texts of variable length."""
    with h5py.File(file, "w") as to:
        to["mass"], to["inertia"], to["axis"] = np.ones(2), np.ones((2, 6)) * [1, 0, 1, 0, 0, 1], np.ones((2, 3))
        to.create_dataset("joint_type", data=["revolute", "spherical"], dtype=h5py.string_dtype())


for target in ("xml", "system", "bodies"):
    os.makedirs(os.path.join(CORPUS, target), exist_ok=True)
with open(os.path.join(CORPUS, "system", "forces.xml"), "w", encoding="ascii") as xml:
    xml.write(openmm.XmlSerializer.serialize(system()))
shutil.copy(os.path.join(CORPUS, "system", "forces.xml"), os.path.join(CORPUS, "xml", "forces.xml"))
bodies(os.path.join(CORPUS, "bodies", "early.h5"))
bodies(os.path.join(CORPUS, "bodies", "latest.h5"), libver="latest")
texts(os.path.join(CORPUS, "bodies", "texts.h5"))
