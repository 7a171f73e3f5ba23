"""Writes the seeds of the targets xml, system, bodies, dcd, domains, pae and settings into tests/fuzz/corpus, and scenes with the files that
they name into tests/fuzz/scenes. Needs OpenMM, h5py and numpy. Usage: make_corpus.py"""
import json
import math
import os
import shutil
import struct

import h5py
import numpy as np
import openmm
from openmm import unit

HERE = os.path.dirname(os.path.realpath(__file__))
CORPUS, SCENES = os.path.join(HERE, "corpus"), os.path.join(HERE, "scenes")


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


def record(content):
    """A record of Fortran: between two copies of its length."""
    return struct.pack("<i", len(content)) + content + struct.pack("<i", len(content))


def trajectory(file, box, fourth, sites=3):
    """Two frames of a straight chain, with a box or without, and with the fourth dimension that few programs write."""
    control = [2, 0, 1, 0, 0, 0, 0, 0, 0, 0, int(box), int(fourth), *[0] * 7, 24]
    data = record(b"CORD" + struct.pack("<20i", *control)) + record(struct.pack("<i", 1) + b" " * 80) + record(struct.pack("<i", sites))
    for frame in range(2):
        if box:
            data += record(struct.pack("<6d", 90, 90, 100, 90, 90, 110))
        for axis in range(4 if fourth else 3):
            data += record(struct.pack(f"<{sites}f", *(3.8 * site * (axis == 0) + axis + frame for site in range(sites))))
    with open(file, "wb") as to:
        to.write(data)


def predicted_error(file, key, listed, half=6):
    """Two parts of as many residues each that are known within themselves."""
    rows = [[0 if i == j else 2.5 if (i < half) == (j < half) else 25 for j in range(2 * half)] for i in range(2 * half)]
    found = {key: rows, "max_" + key: 31.75}
    with open(file, "w", encoding="ascii") as to:
        json.dump([found] if listed else found, to)


DOMAINS = """# residues count from 1
hnRNPA1S:
  - [11, 89]
  - [[105, 120], [125, 179]]
TIA1:
  - [2, 5]
  - [[8, 12], [18, 20]]
  - [14, 16]
"""
CONFIG = """sysname: TIA1
temp: 293.0
friction_coeff: 0.01
steps: 1e8
wfreq: 100000
random_number_seed: 7
slab_eq: true
steps_eq: 1000
runtime: 0
restart: checkpoint
frestart: restart.chk
---8<---
defaults: {molecule_type: protein, restraint: false, fdomains: domains.yaml}
system:
  TIA1: {nmol: 1, restraint: true}
"""


def text(file, content):
    with open(file, "w", encoding="ascii") as to:
        to.write(content)


def helix(chain, residues, x=0, y=0):
    """Glycines of a chain of a PDB file; neighbours stand 3.83 angstrom apart."""
    lines = ""
    for k in range(residues):
        turn = k * 1.745329
        at = x + 1.5 * k, y + 2.3 * math.cos(turn), 2.3 * math.sin(turn)
        lines += "ATOM  {:5}  CA  GLY {}{:4}    {:8.3f}{:8.3f}{:8.3f}  1.00 91.50           C\n".format(k + 1, chain, k + 1, *at)
    return lines + "TER\n"


BUILDER = """forces: {openmm: {builder: calvados2, ionic_strength: 0.15, ph: 7, platform: Reference}}
dynamics: {integrator: g-baoab, step: 0.01, steps: 2, temperature: 300, friction: 0.01, seed: 1}
output: {every: 1}
"""


def scenes():
    """Small scenes with a complex, domains, a prediction, a slab with a concentration, a frame; and the folder of a script."""
    folder = {name: os.path.join(SCENES, name) for name in ("complex", "domains", "pae", "slab", "frame", "script")}
    for path in folder.values():
        os.makedirs(path, exist_ok=True)

    def scene(name, chain, more=""):
        text(os.path.join(folder[name], "scene.yaml"), f"chains:\n  - {chain}\n{more}{BUILDER}")

    text(os.path.join(folder["complex"], "pair.pdb"), helix("A", 12) + helix("B", 10, y=12) + "END\n")
    scene("complex", "{pdb: pair.pdb, model: calvados2, chain: all, rigid: [['A:5-12', 'B:1-6']]}")
    text(os.path.join(folder["domains"], "one.pdb"), helix("A", 24) + "END\n")
    text(os.path.join(folder["domains"], "domains.yaml"), DOMAINS)
    scene("domains", "{name: TIA1, pdb: one.pdb, model: calvados2, rigid: {domains: domains.yaml, longest_loop: 5}}")
    text(os.path.join(folder["pae"], "one.pdb"), helix("A", 24) + "END\n")
    predicted_error(os.path.join(folder["pae"], "pae.json"), "predicted_aligned_error", True, 12)
    scene("pae", "{pdb: one.pdb, model: calvados2, rigid: {pae: pae.json, min_length: 8, plddt: 70, max_pae: 5}}")
    scene("slab", "{name: client, concentration: 2 mmol/l, sequence: GSEEEEGS, model: calvados2, "
          "place: {region: {from: [0, 0, 0], to: [8, 8, 20]}}}\n  - {count: 4, sequence: GGSSGGSS, model: calvados2}",
          "box: {periodic: [8, 8, 60]}\nplace: {slab: {axis: z, thickness: 15}}\n")
    trajectory(os.path.join(folder["frame"], "run.dcd"), True, False, 8)
    scene("frame", "{sequence: GSEEEEGS, model: calvados2}", "box: {periodic: [9, 10, 11]}\nstart: {from: run.dcd, frame: 1}\n")
    script(folder["script"])


def script(folder):
    """What a user's own script of OpenMM leaves: a System, a State and an Integrator."""
    made, start, bonds = openmm.System(), [], openmm.HarmonicBondForce()
    for k in range(5):
        made.addParticle(100)
        start.append(openmm.Vec3(0.38 * k, 0.1234567 * (k % 2), 0))
    for k in range(1, 5):
        bonds.addBond(k - 1, k, 0.3995537, 8033)
    made.addForce(bonds)
    integrator = openmm.LangevinMiddleIntegrator(300, 0.01, 0.01)
    context = openmm.Context(made, integrator, openmm.Platform.getPlatformByName("Reference"))
    context.setPositions(start)
    state = context.getState(getPositions=True, getVelocities=True)
    for name, what in {"system": made, "state": state, "integrator": integrator}.items():
        text(os.path.join(folder, name + ".xml"), openmm.XmlSerializer.serialize(what))


for target in ("xml", "system", "bodies", "dcd", "domains", "pae", "settings"):
    os.makedirs(os.path.join(CORPUS, target), exist_ok=True)
with open(os.path.join(CORPUS, "system", "forces.xml"), "w", encoding="ascii") as xml:
    xml.write(openmm.XmlSerializer.serialize(system()))
shutil.copy(os.path.join(CORPUS, "system", "forces.xml"), os.path.join(CORPUS, "xml", "forces.xml"))
bodies(os.path.join(CORPUS, "bodies", "early.h5"))
bodies(os.path.join(CORPUS, "bodies", "latest.h5"), libver="latest")
texts(os.path.join(CORPUS, "bodies", "texts.h5"))
trajectory(os.path.join(CORPUS, "dcd", "box.dcd"), True, False)
trajectory(os.path.join(CORPUS, "dcd", "fourth.dcd"), False, True)
predicted_error(os.path.join(CORPUS, "pae", "alphafold.json"), "predicted_aligned_error", True)
predicted_error(os.path.join(CORPUS, "pae", "colabfold.json"), "pae", False)
text(os.path.join(CORPUS, "domains", "domains.yaml"), DOMAINS)
text(os.path.join(CORPUS, "settings", "config.yaml"), CONFIG)
text(os.path.join(CORPUS, "settings", "integrator.xml"), openmm.XmlSerializer.serialize(openmm.LangevinMiddleIntegrator(300, 0.01, 0.01)))
scenes()
