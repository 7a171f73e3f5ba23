"""Chains of beads on rigid links that resist bending, under g-BAOAB. The mean cosine between successive links is that of the
constrained ensemble (density prod sin(theta) exp(-kappa (1 - cos theta)) sqrt(det T), T the links' tridiagonal matrix), not that of
the flexible one, coth(kappa) - 1/kappa; and the mean square end-to-end distance is the discrete worm-like chain's for it.
Usage: bending.py [--quick]"""
import os
import sys

import h5py
import numpy as np
import openmm
from catena import Runs, arguments, blocked_error, verdict
from openmm import app

options = arguments(__doc__, beads=12, chains=100, kappa=2.0, steps=400000)
BEADS, CHAINS, KAPPA = options.beads, options.chains, options.kappa
steps = 40000 if options.quick else options.steps
LENGTH, MASS, KT = 0.38, 100.0, 0.00831446261815324 * 300
EVERY = 400


def constrained_cosine(angles, kappa):
    """Mean of cos(theta_k), averaged over the chain, with the weight sqrt(det T): det T = prod d_k, d_k = 2 - c_k^2 / d_(k-1), so that
    d carries what comes before and a grid on d in [1, 2] is a transfer matrix."""
    c, w = np.polynomial.legendre.leggauss(96)
    grid = np.linspace(1, 2, 401)
    boltzmann = w * np.exp(kappa * (c - 1))
    # partition[k](d): sum over what follows when the last pivot is d
    after = [np.sqrt(grid)]
    moved = 2 - c[None, :] ** 2 / grid[:, None]
    for _ in range(angles):
        after.append(np.sqrt(grid) * (np.interp(moved, grid, after[-1]) @ boltzmann))
    before = np.zeros_like(grid)      # weight of arriving at pivot d; starts at d = 2
    before[-1] = 1.0
    mean = 0.0
    for k in range(angles):
        follow = np.interp(moved, grid, after[angles - k - 1])
        weight = before * np.sqrt(grid)
        mean += (weight @ (follow @ (boltzmann * c))) / (weight @ (follow @ boltzmann))
        spread = weight[:, None] * boltzmann[None, :]
        arrived = np.zeros_like(grid)
        at = (moved - 1) * (len(grid) - 1)
        low = np.clip(at.astype(int), 0, len(grid) - 2)
        np.add.at(arrived, low, spread * (low + 1 - at))
        np.add.at(arrived, low + 1, spread * (at - low))
        before = arrived / arrived.sum()
    return mean / angles


def write_system(folder):
    """The bending force as an OpenMM System, and a topology for it."""
    system = openmm.System()
    force = openmm.CustomAngleForce("stiffness * (1 + cos(theta))")   # theta is pi where links go straight on
    force.addGlobalParameter("stiffness", KAPPA * KT)
    topology = app.Topology()
    for chain in range(CHAINS):
        own = topology.addChain()
        first = chain * BEADS
        for bead in range(BEADS):
            system.addParticle(MASS)
            topology.addAtom("CA", app.element.carbon, topology.addResidue("GLY", own))
            if 0 < bead < BEADS - 1:
                force.addAngle(first + bead - 1, first + bead, first + bead + 1)
    system.addForce(force)
    with open(os.path.join(folder, "system.xml"), "w") as file:
        file.write(openmm.XmlSerializer.serialize(system))
    start = np.zeros((CHAINS * BEADS, 3)) * openmm.unit.nanometer
    with open(os.path.join(folder, "topology.pdb"), "w") as file:
        app.PDBFile.writeFile(topology, start, file)


def write_scene(folder, mean):
    persistence = -LENGTH / np.log(mean)
    scene = os.path.join(folder, "bending.yaml")
    with open(scene, "w") as file:
        file.write(f"""title: chains that resist bending
units: md
chains:
  - count: {CHAINS}
    name: chain
    generator: {{worm_like: {{bodies: {BEADS}, persistence: {persistence}, length: {LENGTH}, mass: {MASS}, seed: 3}}}}
forces: {{openmm: {{system: system.xml, topology: topology.pdb, platform: Reference}}}}
dynamics: {{integrator: g-baoab, step: 0.02, steps: {steps}, temperature: 300, friction: 0.5, seed: 11}}
output: {{every: {EVERY}, observables: [temperature, constraint_error]}}
""")
    return scene


def worm_like_square(links, cosine):
    """Discrete worm-like chain: <R^2> / l^2."""
    return links * (1 + cosine) / (1 - cosine) - 2 * cosine * (1 - cosine**links) / (1 - cosine) ** 2


with Runs(options) as runs:
    theory = constrained_cosine(BEADS - 2, KAPPA)
    write_system(runs.folder)
    folder = runs.run("bending", write_scene(runs.folder, theory), {})
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        x = file["particles/trajectory/position/value"][1:]
x = x.reshape(x.shape[0], CHAINS, BEADS, 3)
links = np.diff(x, axis=2) / LENGTH
cosine = np.einsum("fcki,fcki->fck", links[:, :, :-1], links[:, :, 1:]).mean(axis=(1, 2))
square = ((x[:, :, -1] - x[:, :, 0]) ** 2).sum(-1).mean(1) / LENGTH**2
flexible = 1 / np.tanh(KAPPA) - 1 / KAPPA
mean, error = cosine.mean(), blocked_error(cosine)
expected = worm_like_square(BEADS - 1, mean)
print(f"        {len(cosine)} frames of {CHAINS} chains of {BEADS} beads, kappa = {KAPPA} kT")
good = verdict("constrained ensemble", abs(mean - theory) <= 3 * error,
               f"<cos theta> = {mean:.5f} +- {error:.5f}, theory {theory:.5f} ({(mean - theory) / error:+.1f} standard errors)")
far = abs(mean - flexible) > 3 * error
text = f"flexible ensemble {flexible:.5f} is {abs(mean - flexible) / error:.1f} standard errors away"
if options.quick:
    print("        " + text)
else:
    good &= verdict("not the flexible ensemble", far, text)
square_error = blocked_error(square - (worm_like_square(BEADS - 1, mean + 1e-4) - expected) / 1e-4 * (cosine - mean))
good &= verdict("worm-like chain", abs(square.mean() - expected) <= 3 * square_error,
                f"<R^2> = {square.mean():.3f} +- {square_error:.3f} l^2, worm-like formula for the measured cosine {expected:.3f} "
                f"({(square.mean() - expected) / square_error:+.1f} standard errors)")
sys.exit(0 if good else 1)
