"""Systems with constraints for the tests and measurements of catena.openmm, and what is measured on them."""
import numpy as np
import openmm
from openmm import unit

LENGTH = 0.38  # nm


def chain_parents(count):
    return [k - 1 for k in range(count)]


def tree_parents(count):
    """Every third bead hangs on the third before it, so that chains branch."""
    return [-1] + [k - 1 if k % 3 else max(0, k - 3) for k in range(1, count)]


def make_system(parents, masses=None):
    """A System of beads, each constrained to its parent (-1: none)."""
    system = openmm.System()
    for k in range(len(parents)):
        system.addParticle(100 + 30 * np.sin(k) if masses is None else masses[k])
    for k, parent in enumerate(parents):
        if parent >= 0:
            system.addConstraint(parent, k, LENGTH)
    return system


def walk(parents, seed=1):
    """Positions of beads at their distances, in a persistent random walk."""
    random, x = np.random.default_rng(seed), np.zeros((len(parents), 3))
    forward = np.array([1.0, 0, 0])
    for k, parent in enumerate(parents):
        forward = forward + 0.5 * random.normal(size=3)
        forward /= np.linalg.norm(forward)
        x[k] = x[parent] + LENGTH * forward if parent >= 0 else [0, 2.0 * k, 0]
    return x


def ring(count):
    """A System of a ring, and its positions."""
    system = make_system(chain_parents(count))
    system.addConstraint(count - 1, 0, LENGTH)
    turn, radius = 2 * np.pi * np.arange(count) / count, LENGTH / (2 * np.sin(np.pi / count))
    return system, np.stack([radius * np.cos(turn), radius * np.sin(turn), 0 * turn], axis=1)


def pull(system, strength="pull"):
    """Adds a trap that has the parameter `pull`, and is not the same along all axes."""
    force = openmm.CustomExternalForce(f"{strength}*(0.5*(x*x+y*y+2*z*z)+x*y)")
    force.addGlobalParameter("pull", 1.0)
    for k in range(system.getNumParticles()):
        force.addParticle(k, [])
    system.addForce(force)
    return system


def bend(system, count, angle=2.0, stiffness=10.0):
    """Adds angles as a CustomAngleForce: with a HarmonicAngleForce, OpenMM's CCMA takes angles for fixed and can diverge."""
    force = openmm.CustomAngleForce("0.5*stiffness*(theta-rest)^2")
    force.addGlobalParameter("stiffness", stiffness)
    force.addGlobalParameter("rest", angle)
    for k in range(1, count - 1):
        force.addAngle(k - 1, k, k + 1, [])
    system.addForce(force)
    return system


def tell_angles(system, x):
    """Adds angles without stiffness at their present values: OpenMM's CCMA reads them, and diverges on trees without them."""
    force, table = openmm.HarmonicAngleForce(), constraints(system)
    for i, (a, b, _) in enumerate(table):
        for c, d, _ in table[:i]:
            for end, shared, other in ((a, b, c + d - b), (b, a, c + d - a)):
                if shared in (c, d):
                    u, v = x[end] - x[shared], x[other] - x[shared]
                    force.addAngle(end, shared, other, float(np.arccos(u @ v / np.sqrt(u @ u * (v @ v)))), 0)
    system.addForce(force)
    return system


def context(system, integrator, x, platform="Reference", threads=2, temperature=300, precision="mixed"):
    properties = {"CPU": {"Threads": str(threads)}, "Reference": {}}.get(platform, {"Precision": precision})
    made = openmm.Context(system, integrator, openmm.Platform.getPlatform(platform), properties)
    made.setPositions(x)
    made.setVelocitiesToTemperature(temperature, 3)
    return made


def positions(of):
    return of.getState(positions=True).getPositions(asNumpy=True).value_in_unit(unit.nanometer)


def velocities(of):
    return of.getState(velocities=True).getVelocities(asNumpy=True).value_in_unit(unit.nanometer / unit.picosecond)


def energies(of):
    state = of.getState(energy=True)
    return tuple(e.value_in_unit(unit.kilojoule_per_mole) for e in (state.getKineticEnergy(), state.getPotentialEnergy()))


def constraints(system):
    found = [system.getConstraintParameters(i) for i in range(system.getNumConstraints())]
    return [(a, b, d.value_in_unit(unit.nanometer)) for a, b, d in found]


def constraint_error(system, x):
    """Largest relative deviation of a constrained distance."""
    table = constraints(system)
    a, b, d = (np.array(column) for column in zip(*table))
    return np.max(np.abs(np.linalg.norm(x[a] - x[b], axis=1) - d) / d)


def velocity_error(system, x, v):
    """Largest velocity along a constraint."""
    a, b, d = (np.array(column) for column in zip(*constraints(system)))
    return np.max(np.abs(np.einsum("ij,ij->i", x[a] - x[b], v[a] - v[b])) / d)


def mean_and_error(series, blocks=20):
    parts = np.array_split(np.asarray(series, dtype=float), blocks)
    means = np.array([part.mean() for part in parts])
    return means.mean(), means.std(ddof=1) / np.sqrt(blocks)
