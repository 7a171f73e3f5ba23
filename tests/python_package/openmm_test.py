#!/usr/bin/env python3
"""Integrators for plain OpenMM scripts (catena.openmm): motions beside OpenMM's own, states, changes, refusals."""
import copy
import importlib.util
import io
import pickle
import subprocess
import sys
import unittest

import package  # first: it leaves where the package is not there
import numpy as np
from package import Case

if importlib.util.find_spec("catena._integrators") is None:
    print("LEFT OUT: catena was built without PyPI's OpenMM")
    raise SystemExit(77)

import openmm
from openmm import app, unit
from openmm_systems import (LENGTH, bend, chain_parents, constraint_error, constraints, context, energies, make_system, mean_and_error, positions,
                            pull, ring, tell_angles, tree_parents, velocities, velocity_error, walk)

import catena
from catena.openmm import ChainLangevinIntegrator, ChainVerletIntegrator, prepared

STEP = 0.01
BOLTZMANN = unit.MOLAR_GAS_CONSTANT_R.value_in_unit(unit.kilojoule_per_mole / unit.kelvin)


def langevin(kind=ChainLangevinIntegrator, seed=5, friction=1.0):
    integrator = kind(300 * unit.kelvin, friction / unit.picosecond, STEP * unit.picosecond)
    integrator.setRandomNumberSeed(seed)
    return integrator


def water():
    """A rigid water, a scalene triangle and a chain of four beads."""
    system = make_system([-1, -1, -1, -1, -1, -1, -1, 6, 7, 8], masses=[16, 1, 1, 5, 6, 7, 9, 9, 9, 9])
    x = np.zeros((10, 3))
    x[:3] = [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]
    x[3:6] = [[1, 0, 0], [1.3, 0, 0], [1, 0.4, 0]]
    x[6:] = [[2 + LENGTH * k, 0.1, 0] for k in range(4)]
    for triangle in ((0, 1, 2), (3, 4, 5)):
        for a, b in zip(triangle, triangle[1:] + triangle[:1]):
            system.addConstraint(a, b, float(np.linalg.norm(x[a] - x[b])))
    return pull(system), x


class BesideOpenMM(Case):
    """Motions equal those of OpenMM's integrators, whose tolerance is tight, from the same start and noise."""

    def compare(self, system, x, platform, steps=20, tolerance=1e-9):
        kinds = ((ChainVerletIntegrator, openmm.VerletIntegrator, lambda kind: kind(STEP)),
                 (ChainLangevinIntegrator, openmm.LangevinMiddleIntegrator, langevin))
        for own, theirs, make in kinds:
            ends = []
            for kind in (own, theirs):
                integrator = make(kind)
                integrator.setConstraintTolerance(1e-12)
                here = context(system, integrator, x, platform)
                integrator.step(steps)
                ends.append((positions(here), velocities(here), *energies(here)))
                if kind is own:
                    self.assertLess(constraint_error(system, ends[0][0]), 1.0001e-12)
                del here
            for mine, other, scale in zip(*ends, (1, 100, 1e4, 1e4)):
                self.assertLess(np.max(np.abs(np.subtract(mine, other))), scale * tolerance, (own.__name__, platform))

    def test_chains(self):
        for platform in ("Reference", "CPU"):
            parents = chain_parents(30) + [-1] + list(range(30, 40)) + [-1]  # two chains and a single bead
            self.compare(bend(pull(make_system(parents)), 30), walk(parents), platform)

    def test_trees(self):
        for platform in ("Reference", "CPU"):
            parents = tree_parents(20)
            x = walk(parents)
            self.compare(tell_angles(pull(make_system(parents)), x), x, platform)

    def test_rings(self):
        for platform in ("Reference", "CPU"):
            system, x = ring(6)
            self.compare(tell_angles(pull(system), x), x, platform)

    def test_loops_with_branches_and_cross_links(self):
        for platform in ("Reference", "CPU"):
            system, x = ring(8)
            for k, on in ((8, 2), (9, 8), (10, 5)):
                system.addParticle(80 + k)
                system.addConstraint(on, k, LENGTH)
                x = np.vstack([x, x[on] + [0, 0.6 * LENGTH, 0.8 * LENGTH]])
            system.addConstraint(1, 5, float(np.linalg.norm(x[1] - x[5])))
            self.compare(tell_angles(pull(system), x), x, platform)

    def test_rigid_water_stays_with_settle_and_other_triangles_are_solved(self):
        system, x = water()
        for platform in ("Reference", "CPU"):
            for kind in (ChainVerletIntegrator, openmm.VerletIntegrator):
                integrator = kind(0.002)
                integrator.setConstraintTolerance(1e-12)
                here = context(system, integrator, x, platform)
                integrator.step(50)
                if kind is ChainVerletIntegrator:
                    mine = positions(here)
                    self.assertLess(constraint_error(system, mine), 1e-6)  # SETTLE has lengths in single precision
                    for a, b, d in constraints(system):
                        if a > 2:
                            self.assertLess(abs(np.linalg.norm(mine[a] - mine[b]) - d), 1e-12)
                else:
                    self.assertLess(np.abs(mine - positions(here)).max(), 1e-8)
                del here

    def test_a_system_without_constraints_moves_as_with_openmm(self):
        system, x = pull(make_system([-1] * 5)), walk([-1] * 5)
        ends = []
        for kind in (ChainLangevinIntegrator, openmm.LangevinMiddleIntegrator):
            integrator = langevin(kind)
            here = context(system, integrator, x)
            integrator.step(100)
            ends.append(positions(here))
            del here
        self.assert_same(*ends)

    def test_averages_and_temperature(self):
        count, steps, every = 6, 60000, 3
        parents = chain_parents(count)
        found = []
        for kind, seed in ((ChainLangevinIntegrator, 11), (openmm.LangevinMiddleIntegrator, 12)):
            system = bend(pull(make_system(parents)), count)
            integrator = langevin(kind, seed, friction=5.0)
            integrator.setConstraintTolerance(1e-8)
            here = context(system, integrator, walk(parents))
            integrator.step(2000)
            rows = []
            for _ in range(steps // every):
                integrator.step(every)
                x = positions(here)
                kinetic, potential = energies(here)
                rows.append((kinetic, potential, np.linalg.norm(x[-1] - x[0]), np.mean(np.sum((x - x.mean(0)) ** 2, 1))))
            found.append([mean_and_error(column) for column in zip(*rows)])
            del here
        for mine, theirs in zip(*found):
            self.assertLess(abs(mine[0] - theirs[0]), 3 * np.hypot(mine[1], theirs[1]))
        freedom = 3 * count - (count - 1)
        kinetic, error = found[0][0]
        self.assertLess(abs(kinetic - 0.5 * freedom * BOLTZMANN * 300), 3 * error)

    def test_threads_change_no_bit(self):
        parents = chain_parents(20000)
        system, x, ends = pull(make_system(parents)), walk(parents), []
        for threads in (1, 2):
            integrator = ChainVerletIntegrator(STEP)
            with prepared(system, integrator):
                here = context(system, integrator, x, "CPU", threads)
            integrator.step(3)
            ends.append(positions(here))
            self.assertLess(constraint_error(system, ends[-1]), 1e-11)
            del here
        self.assert_same(*ends)


class OpenMMsOwnTests(Case):
    """The tests of constraints in OpenMM's TestLangevinMiddleIntegrator.h and TestVerletIntegrator.h, with these integrators."""

    def eight(self, masses):
        system, force = openmm.System(), openmm.NonbondedForce()
        for k in range(8):
            system.addParticle(masses[k % 2])
            force.addParticle(0.2 if k % 2 == 0 else -0.2, 0.5, 5.0)
        for a, b in ((0, 1), (1, 2), (2, 3), (4, 5), (6, 7)):
            system.addConstraint(a, b, 1.0)
        system.addForce(force)
        return system, [openmm.Vec3(k // 2, (k + 1) // 2, 0) for k in range(8)]

    def test_constraints(self):
        cases = ((ChainLangevinIntegrator(100, 2.0, 0.01), (10.0, 10.0)), (ChainVerletIntegrator(0.001), (5.0, 10.0)))
        for platform in ("Reference", "CPU"):
            for integrator, masses in cases:
                integrator = copy.copy(integrator)
                integrator.setConstraintTolerance(1e-5)
                system, x = self.eight(masses)
                here = context(system, integrator, x, platform)
                here.setVelocities(np.random.default_rng(0).random((8, 3)) - 0.5)
                first = None
                for step in range(1000):
                    self.assertLess(constraint_error(system, positions(here)), 1e-12)
                    if isinstance(integrator, ChainVerletIntegrator) and step > 0:
                        total = sum(energies(here))
                        first = total if first is None else first
                        self.assertLess(abs(total - first), 0.01 * max(abs(first), 1))
                    integrator.step(1)
                del here

    def test_constrained_chains(self):
        random = np.random.default_rng(0)
        for count in (2, 10, 100):
            system, x = openmm.System(), [np.zeros(3)]
            for k in range(count):
                system.addParticle(1.0)
                if k > 0:
                    system.addConstraint(k - 1, k, 1.0)
                    delta = random.random(3) - 0.5
                    x.append(x[-1] + delta / np.linalg.norm(delta))
            integrator = ChainVerletIntegrator(0.001)
            here = context(system, integrator, x)
            integrator.step(1)
            first = sum(energies(here))
            for _ in range(200):
                integrator.step(5)
                self.assertLess(constraint_error(system, positions(here)), 1.0001e-12)
                self.assertLess(abs(sum(energies(here)) - first), 0.01 * first)
            del here

    def test_constrained_clusters(self):
        root = float(np.sqrt(2))
        table = ((0, 1, 1), (0, 2, 1), (0, 3, 1), (0, 4, 1), (1, 5, 1), (1, 6, 1), (2, 3, root), (2, 4, root), (3, 4, root), (5, 6, root))
        x = [[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 0, 1], [2, 0, 0], [1, 1, 0]]
        for platform in ("Reference", "CPU"):
            system, force = openmm.System(), openmm.NonbondedForce()
            for k in range(7):
                system.addParticle(1.0 if k > 1 else 10.0)
                force.addParticle(0.2 if k % 2 == 0 else -0.2, 0.5, 5.0)
            for a, b, d in table:
                system.addConstraint(a, b, d)
            system.addForce(force)
            integrator = ChainVerletIntegrator(0.001)
            here = context(system, integrator, x, platform)
            here.setVelocities(np.random.default_rng(0).random((7, 3)) - 0.5)
            integrator.step(1)
            first = sum(energies(here))
            for _ in range(200):
                integrator.step(5)
                self.assertLess(constraint_error(system, positions(here)), 1.0001e-12)
                self.assertLess(abs(sum(energies(here)) - first), 0.01 * abs(first))
            del here

    def test_massless_particles(self):
        for make in (lambda: ChainVerletIntegrator(0.01), lambda: ChainLangevinIntegrator(300, 2.0, 0.01)):
            system = openmm.System()
            system.addParticle(0)
            system.addParticle(1)
            system.addConstraint(0, 1, 1.5)
            with self.assertRaisesRegex(openmm.OpenMMException, "massless"):
                openmm.Context(system, make(), openmm.Platform.getPlatform("Reference"))
            system.setParticleMass(1, 0)
            integrator = make()
            here = context(system, integrator, [[-1, 0, 0], [1, 0, 0]])
            integrator.step(1)
            self.assertEqual(velocities(here)[0][0], 0)

    def test_random_seed(self):
        parents, ends = chain_parents(8), []
        system, x = pull(make_system(parents)), walk(parents)
        integrator = langevin(seed=5)
        here = context(system, integrator, x)
        for seed in (5, 5, 10, 10):
            integrator.setRandomNumberSeed(seed)
            here.reinitialize()
            here.setPositions(x)
            integrator.step(10)
            ends.append(positions(here))
        self.assert_same(ends[0], ends[1])
        self.assert_same(ends[2], ends[3])
        self.assertGreater(np.abs(ends[0] - ends[2]).max(), 0)

    def test_force_groups(self):
        for integrator in (ChainVerletIntegrator(0.01), ChainLangevinIntegrator(0, 1.0, 0.01)):
            integrator.setIntegrationForceGroups({1})
            system = make_system([-1, 0])
            for group, text in ((1, "x"), (2, "y")):
                force = openmm.CustomExternalForce(text)
                force.setForceGroup(group)
                for k in range(2):
                    force.addParticle(k)
                system.addForce(force)
            here = openmm.Context(system, integrator, openmm.Platform.getPlatform("Reference"))
            here.setPositions([[0, 0, 0], [0, 0, LENGTH]])
            integrator.step(1)
            x = positions(here)
            self.assertLess(x[0][0], 0)
            self.assertEqual(x[0][1], 0)
            del here


class States(Case):
    def setUp(self):
        super().setUp()
        parents = tree_parents(12)
        self.system, self.x = pull(make_system(parents)), walk(parents)

    def test_a_checkpoint_goes_on_with_the_same_bits(self):
        for make in (langevin, lambda: ChainVerletIntegrator(STEP)):
            integrator = make()
            here = context(self.system, integrator, self.x)
            integrator.step(7)
            kept = here.createCheckpoint()
            integrator.step(20)
            expected = positions(here), velocities(here)
            here.loadCheckpoint(kept)
            integrator.step(20)
            self.assert_same(positions(here), expected[0])
            self.assert_same(velocities(here), expected[1])
            other = make()
            there = context(self.system, other, self.x)
            there.loadCheckpoint(kept)
            other.step(20)
            self.assert_same(positions(there), expected[0])
            del here, there

    def test_a_state_in_xml_goes_on_with_the_same_bits(self):
        integrator = ChainVerletIntegrator(STEP)
        here = context(self.system, integrator, self.x)
        integrator.step(7)
        state = here.getState(positions=True, velocities=True, parameters=True)
        text = openmm.XmlSerializer.serialize(state)
        integrator.step(20)
        other = ChainVerletIntegrator(STEP)
        there = context(self.system, other, self.x)
        there.setState(openmm.XmlSerializer.deserialize(text))
        other.step(20)
        self.assert_same(positions(there), positions(here))
        self.assert_same(velocities(there), velocities(here))

    def test_integrators_go_through_xml_copies_and_pickles(self):
        integrator = ChainLangevinIntegrator(310.25, 0.1, 0.0123)
        integrator.setConstraintTolerance(3e-7)
        integrator.setRandomNumberSeed(77)
        integrator.setIntegrationForceGroups({0, 3})
        again = openmm.XmlSerializer.deserialize(openmm.XmlSerializer.serialize(integrator))
        for other in (again, copy.copy(integrator), copy.deepcopy(integrator), pickle.loads(pickle.dumps(integrator))):
            self.assertIsInstance(other, openmm.LangevinMiddleIntegrator)
            self.assertEqual(other.getTemperature(), 310.25 * unit.kelvin)
            self.assertEqual(other.getFriction(), 0.1 / unit.picosecond)
            self.assertEqual(other.getStepSize(), 0.0123 * unit.picosecond)
            self.assertEqual(other.getConstraintTolerance(), 3e-7)
            self.assertEqual(other.getRandomNumberSeed(), 77)
            self.assertEqual(other.getIntegrationForceGroups(), 0b1001)
            self.assertEqual(openmm.XmlSerializer.serialize(other), openmm.XmlSerializer.serialize(integrator))
        verlet = pickle.loads(pickle.dumps(ChainVerletIntegrator(0.007)))
        self.assertIsInstance(verlet, ChainVerletIntegrator)
        self.assertEqual(verlet.getStepSize(), 0.007 * unit.picosecond)
        # What comes back solves constraints too.
        here = context(self.system, again, self.x)
        again.setIntegrationForceGroups(-1)
        again.step(10)
        self.assertLess(constraint_error(self.system, positions(here)), 1.0001e-12)

    def test_a_compound_integrator(self):
        compound = openmm.CompoundIntegrator()
        compound.addIntegrator(ChainLangevinIntegrator(300, 1.0, STEP))
        compound.addIntegrator(ChainVerletIntegrator(STEP))
        here = context(self.system, compound, self.x)
        for index in (0, 1, 0):
            compound.setCurrentIntegrator(index)
            compound.step(5)
            self.assertLess(constraint_error(self.system, positions(here)), 1.0001e-12)
        text = openmm.XmlSerializer.serialize(compound)
        self.assertIn("ChainLangevinIntegrator", text)
        self.assertEqual(openmm.XmlSerializer.serialize(openmm.XmlSerializer.deserialize(text)), text)

    def test_a_thousand_changes_between_steps(self):
        random = np.random.default_rng(7)
        own, theirs = langevin(friction=0.0), langevin(openmm.LangevinMiddleIntegrator, friction=0.0)
        theirs.setConstraintTolerance(1e-12)
        parents = chain_parents(12)
        self.system, self.x = pull(make_system(parents)), walk(parents)
        here, there = (context(self.system, each, self.x) for each in (own, theirs))
        for change in range(1000):
            kind, number, v = random.integers(6), random.random(), random.normal(size=self.x.shape)
            turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
            if kind == 0:
                here.setPositions(positions(here) @ turn + number)
            elif kind == 1:
                here.setVelocities(v)
            elif kind == 2:
                for each in (here, there):
                    each.setParameter("pull", 5 * number)
            elif kind == 3:
                for integrator in (own, theirs):
                    integrator.setStepSize(0.002 + 0.01 * number)
            elif kind == 4:
                here.setVelocitiesToTemperature(100 + 300 * number, change + 1)
            else:
                here.setPositions(positions(here) + 1e-2 * v)
                here.applyConstraints(1e-10)
                self.assertLess(constraint_error(self.system, positions(here)), 1.0001e-12)
            there.setPositions(positions(here))
            there.setVelocities(velocities(here))
            for integrator in (own, theirs):
                integrator.step(1)
            self.assertLess(constraint_error(self.system, positions(here)), 1.0001e-12)
            self.assertLess(np.abs(positions(here) - positions(there)).max(), 1e-8, kind)

    def test_reinitialising_a_changed_system(self):
        integrator = ChainVerletIntegrator(STEP)
        here = context(self.system, integrator, self.x)
        integrator.step(5)
        before = positions(here)
        self.system.removeConstraint(self.system.getNumConstraints() - 1)
        here.reinitialize(preserveState=True)
        self.assert_same(positions(here), before)
        integrator.step(50)
        self.assertLess(constraint_error(self.system, positions(here)), 1.0001e-12)
        self.assertGreater(abs(np.linalg.norm(np.subtract(*positions(here)[[-1, tree_parents(12)[-1]]])) - LENGTH), 1e-4)

    def test_zero_steps_change_nothing(self):
        integrator = langevin()
        here = context(self.system, integrator, self.x)
        integrator.step(0)
        self.assertEqual(here.getStepCount(), 0)
        self.assert_same(positions(here), self.x)


class WithOpenMM(Case):
    """What else applies constraints in a Context."""

    def test_the_contexts_own_functions(self):
        parents = tree_parents(20)
        system, x = pull(make_system(parents)), walk(parents)
        here = context(system, langevin(), x)
        far = 2 * x + np.random.default_rng(2).normal(scale=0.1, size=x.shape)
        here.setPositions(far)
        here.applyConstraints(1e-8)
        self.assertLess(constraint_error(system, positions(here)), 1.0001e-12)
        here.setVelocities(np.random.default_rng(3).normal(size=x.shape))
        here.applyVelocityConstraints(1e-8)
        self.assertLess(velocity_error(system, positions(here), velocities(here)), 1e-13)
        before = energies(here)[1]
        openmm.LocalEnergyMinimizer.minimize(here, 1.0)
        self.assertLess(energies(here)[1], before)
        self.assertLess(constraint_error(system, positions(here)), 1.0001e-12)

    def test_virtual_sites_and_a_barostat(self):
        parents = chain_parents(10)
        system, x = make_system(parents), walk(parents)
        system.addParticle(0)
        system.setVirtualSite(10, openmm.TwoParticleAverageSite(0, 1, 0.5, 0.5))
        system.setDefaultPeriodicBoxVectors([20, 0, 0], [0, 20, 0], [0, 0, 20])
        force = openmm.NonbondedForce()
        force.setNonbondedMethod(openmm.NonbondedForce.CutoffPeriodic)
        for k in range(11):
            force.addParticle(0, 0.2, 0.5 if k < 10 else 0)
        force.createExceptionsFromBonds([(k, k + 1) for k in range(9)], 0, 0)
        system.addForce(force)
        system.addForce(openmm.MonteCarloBarostat(1, 300, 5))
        integrator = langevin()
        here = context(system, integrator, np.vstack([x, x[:2].mean(0)]))
        integrator.step(200)
        found = positions(here)
        self.assertLess(constraint_error(system, found), 1.0001e-12)
        self.assertLess(np.abs(found[10] - 0.5 * (found[0] + found[1])).max(), 1e-12)
        self.assertNotEqual(here.getState().getPeriodicBoxVolume(), 8000 * unit.nanometer**3)

    def test_a_simulation_with_reporters(self):
        parents = chain_parents(5)
        topology = app.Topology()
        residue = topology.addResidue("CHN", topology.addChain())
        for k in range(5):
            topology.addAtom(f"C{k}", app.Element.getBySymbol("C"), residue)
        simulation = app.Simulation(topology, pull(make_system(parents)), langevin(), openmm.Platform.getPlatform("CPU"))
        simulation.context.setPositions(walk(parents))
        simulation.minimizeEnergy()
        said = io.StringIO()
        simulation.reporters.append(app.StateDataReporter(said, 10, step=True, temperature=True, totalEnergy=True))
        simulation.step(50)
        self.assertEqual(len(said.getvalue().splitlines()), 6)
        self.assertIs(simulation.context.getIntegrator(), simulation.integrator)

    def test_lengths_that_cannot_be_kept_stop_the_step(self):
        parents = chain_parents(4)
        system, x = pull(make_system(parents)), walk(parents)
        integrator = ChainVerletIntegrator(STEP)
        here = context(system, integrator, x)
        here.setVelocities(np.array([[0, 0, 0], [0, 1e3, 0], [0, -1e3, 0], [1e3, 0, 0]]))
        with self.assertRaisesRegex(openmm.OpenMMException, "ChainVerletIntegrator: constraints stay open .*take a smaller step"):
            integrator.step(1)
        here.setVelocities(np.full((4, 3), np.nan))
        with self.assertRaisesRegex(openmm.OpenMMException, r"no longer finite \(particle 0\): .*take a smaller step"):
            integrator.step(1)

    def test_lengths_are_exact_whatever_the_tolerance(self):
        system = make_system(chain_parents(5), masses=[10.0] * 5)
        integrator = ChainLangevinIntegrator(300, 1, 0.1)  # Sweeps converge slowly.
        integrator.setRandomNumberSeed(2)
        integrator.setConstraintTolerance(1e-3)
        here = context(system, integrator, walk(chain_parents(5)))
        worst = 0.0
        for _ in range(200):
            integrator.step(1)
            worst = max(worst, constraint_error(system, positions(here)))
        self.assertLess(worst, 1.0001e-12)

    def test_positions_without_matrices_are_named(self):
        straight, _ = ring(4)
        straight.setConstraintParameters(3, *straight.getConstraintParameters(3)[:2], 3 * LENGTH)
        line = LENGTH * np.arange(4.0)[:, None] * [1, 0, 0]
        chain = make_system(chain_parents(4))
        for system, x, pattern in ((chain, np.zeros((4, 3)), "particles [01] and [12], which a constraint joins, coincide: set other positions"),
                                   (chain, line + [np.nan, 0, 0], r"positions are no longer finite \(particle 0\): call applyConstraints"),
                                   (straight, line, "depend on each other at these positions, .*stretched straight: set other positions")):
            here = openmm.Context(system, ChainVerletIntegrator(STEP), openmm.Platform.getPlatform("Reference"))
            here.setPositions(x)
            with self.assertRaisesRegex(openmm.OpenMMException, f"ChainVerletIntegrator: .*{pattern}"):
                here.getIntegrator().step(1)


class Refused(Case):
    def refuse(self, system, pattern, kind=ChainVerletIntegrator, make=None):
        with self.assertRaisesRegex(openmm.OpenMMException, pattern) as caught:
            openmm.Context(system, make or kind(STEP), openmm.Platform.getPlatform("Reference"))
        self.assertEqual(len(str(caught.exception).splitlines()), 1)

    def test_distances_that_are_none(self):
        system = make_system([-1, 0])
        for distance in (0.0, -0.1, float("inf")):
            system.setConstraintParameters(0, 0, 1, distance)
            self.refuse(system, f"distance {distance:g} nm .*positive, finite")

    def test_numbers_that_openmm_refuses(self):
        with self.assertRaisesRegex(openmm.OpenMMException, "Temperature cannot be negative"):
            ChainLangevinIntegrator(-1, 1, 0.01)
        with self.assertRaises(TypeError):
            ChainLangevinIntegrator(300 * unit.nanometer, 1, 0.01)
        for numbers in (("300", 1, 0.01), (float("nan"), 1, 0.01), (300, float("inf"), 0.01), (300, 1, float("nan") * unit.picosecond)):
            with self.assertRaisesRegex(catena.InputError, r"\(catena.openmm\): give a finite number, or a quantity"):
                ChainLangevinIntegrator(*numbers)


class OnDevices(Case):
    """The platforms CUDA, HIP and OpenCL, as far as there are some here."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        names = [openmm.Platform.getPlatform(k).getName() for k in range(openmm.Platform.getNumPlatforms())]
        cls.platforms = [name for name in names if name not in ("Reference", "CPU")]
        if not cls.platforms:
            raise unittest.SkipTest("no GPU platform here")

    def cases(self):
        for platform in self.platforms:
            for precision in ("mixed", "double", "single"):
                yield platform, precision, {"mixed": 1e-6, "double": 1e-9, "single": 1e-4}[precision]

    def several_chains(self, *counts):
        parents = []
        for count in counts:
            parents += [-1] + list(range(len(parents), len(parents) + count - 1))
        x = walk(parents)
        x[:, 1] -= np.repeat([2.0 * sum(counts[:i]) for i in range(len(counts))], counts)  # Large coordinates round more.
        return pull(make_system(parents)), x

    def test_steps_equal_those_of_the_reference_platform(self):
        v = 0.1 * np.random.default_rng(1).normal(size=(1700, 3))
        for counts in ((2, 1, 37), (1500, 1, 3, 196)):
            system, x = self.several_chains(*counts)
            for make in (lambda: langevin(friction=0.0), lambda: ChainVerletIntegrator(STEP)):
                ends = {}
                for platform, precision, tolerance in [("Reference", "double", 1e-12), *self.cases()]:
                    integrator = make()
                    here = context(system, integrator, x, platform, precision=precision)
                    here.setVelocities(v[: len(x)])
                    integrator.step(10)
                    ends[precision if platform != "Reference" else "reference"] = positions(here)
                    self.assertLess(constraint_error(system, positions(here)), 1.0001 * tolerance, (platform, precision))
                    if platform == "Reference":
                        kinetic = energies(here)[0]
                    else:
                        self.assertLess(np.abs(positions(here) - ends["reference"]).max(), {"single": 1e-2, "mixed": 1e-5, "double": 1e-8}[precision])
                        self.assertLess(abs(energies(here)[0] / kinetic - 1), 1e-2 if precision == "single" else 1e-4)
                    del here

    def test_temperature(self):
        for platform, precision, _ in self.cases():
            if precision != "mixed":
                continue
            system, x = self.several_chains(*[6] * 60)
            integrator = langevin(friction=1.0)
            here = context(system, integrator, x, platform)
            integrator.step(200)
            rows = []
            for _ in range(200):
                integrator.step(10)
                rows.append(energies(here)[0])
            mean, error = mean_and_error(rows)
            self.assertLess(abs(mean - 0.5 * 60 * 13 * BOLTZMANN * 300), 3 * error)
            del here

    def test_sorted_particles_in_a_box_and_rigid_water(self):
        parents = chain_parents(30)
        for platform, precision, tolerance in self.cases():
            system, x = make_system(parents), walk(parents)
            for k in range(20):
                first = system.getNumParticles()
                for mass in (16, 1, 1):
                    system.addParticle(mass)
                for a, b, d in ((0, 1, 0.1), (0, 2, 0.1), (1, 2, 0.15)):
                    system.addConstraint(first + a, first + b, d)
                place = np.array([4.0 + k % 5, 1 + k // 5, 5])
                x = np.vstack([x, place, place + [0.1, 0, 0], place + [0.1 * (1 - 1.125), 0.1 * np.sqrt(1 - 0.125**2), 0]])
            system.setDefaultPeriodicBoxVectors([6, 0, 0], [0, 6, 0], [0, 0, 6])
            force = openmm.NonbondedForce()
            force.setNonbondedMethod(openmm.NonbondedForce.CutoffPeriodic)
            for k in range(system.getNumParticles()):
                force.addParticle(0, 0.1, 0.1)
            force.createExceptionsFromBonds([(a, b) for a, b, _ in constraints(system)], 0, 0)
            system.addForce(force)
            integrator = langevin()
            integrator.setStepSize(0.002)
            here = context(system, integrator, x, platform, precision=precision)
            for _ in range(6):
                integrator.step(100)
                self.assertLess(constraint_error(system, positions(here)), 10 * max(tolerance, 1e-6), (platform, precision))
            del here

    def test_checkpoints_compound_integrators_and_a_far_start(self):
        for platform, precision, tolerance in self.cases():
            system, x = self.several_chains(12, 5)
            compound = openmm.CompoundIntegrator()
            compound.addIntegrator(langevin())
            compound.addIntegrator(ChainVerletIntegrator(STEP))
            here = context(system, compound, x, platform, precision=precision)
            here.setPositions(x * (1 + 1e-2 * np.sin(np.arange(len(x))))[:, None])
            for index in (0, 1):
                compound.setCurrentIntegrator(index)
                compound.step(3)
                self.assertLess(constraint_error(system, positions(here)), tolerance)
            kept = here.createCheckpoint()
            compound.step(5)
            expected = positions(here)
            here.loadCheckpoint(kept)
            compound.step(5)
            self.assertLess(np.abs(positions(here) - expected).max(), 10 * tolerance)
            del here

    def test_prepared_contexts(self):
        for platform, precision, tolerance in self.cases():
            for make in (lambda: langevin(friction=0.0), lambda: ChainVerletIntegrator(STEP)):
                ends = []
                for with_it in (False, True):
                    system, x = self.several_chains(12, 5, 1)
                    integrator = make()
                    if with_it:
                        with prepared(system, integrator):
                            here = context(system, integrator, x, platform, precision=precision)
                    else:
                        here = context(system, integrator, x, platform, precision=precision)
                    self.assertEqual(len(here.getMolecules()), 3)
                    v = velocities(here)
                    self.assertLess(velocity_error(system, x, v), tolerance if with_it else 1e-4)
                    integrator.step(10)
                    ends.append((positions(here), velocities(here), v, *energies(here)))
                    self.assertLess(constraint_error(system, ends[-1][0]), tolerance)
                    here.setPositions(x * (1 + 1e-2 * np.sin(np.arange(len(x))))[:, None])
                    here.applyConstraints(1e-6)
                    self.assertLess(constraint_error(system, positions(here)), tolerance if with_it else 1e-4)  # OpenMM's own
                    openmm.LocalEnergyMinimizer.minimize(here, 10.0)
                    self.assertLess(constraint_error(system, positions(here)), max(1e-4, tolerance))
                    del here
                for mine, theirs in zip(*ends):
                    self.assertLess(np.max(np.abs(np.subtract(mine, theirs)) / np.maximum(1, np.abs(theirs))), 100 * max(tolerance, 1e-6))

    def test_what_is_refused(self):
        triangle, _ = ring(3)
        for number, length in enumerate((0.3, 0.4, 0.5)):
            triangle.setConstraintParameters(number, *triangle.getConstraintParameters(number)[:2], length)
        net = ring(6)[0]
        net.addConstraint(0, 3, 2 * LENGTH)
        for platform in self.platforms:
            there = openmm.Platform.getPlatform(platform)
            for system, shape in ((ring(6)[0], "ring"), (make_system(tree_parents(9)), "tree"), (triangle, "ring"), (net, "net")):
                with self.assertRaisesRegex(openmm.OpenMMException, f"form a {shape} on the platform {platform} .*take the platform CPU"):
                    openmm.Context(system, ChainVerletIntegrator(STEP), there)
            system, x = self.several_chains(4)
            integrator = ChainVerletIntegrator(STEP)
            here = context(system, integrator, x, platform)
            here.setVelocities(np.array([[0, 0, 0], [0, 1e3, 0], [0, -1e3, 0], [1e3, 0, 0]]))
            with self.assertRaisesRegex(openmm.OpenMMException, "ChainVerletIntegrator: (constraints stay open .*smaller step|positions are no longer)"):
                integrator.step(2)
            del here


class WithoutOpenMM(Case):
    def test_the_import_says_what_is_missing(self):
        program = "import sys; sys.modules['openmm'] = None\nimport catena.openmm"
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr.splitlines()[-1], r"ImportError: catena.openmm needs OpenMM \(.*\): pip install openmm")


class Prepared(Case):
    def test_same_bits_and_the_same_system(self):
        system, x = water()
        parents = tree_parents(30)
        for k, parent in enumerate(parents):
            system.addParticle(50 + k)
            system.getForce(0).addParticle(10 + k, [])
            if parent >= 0:
                system.addConstraint(10 + parent, 10 + k, LENGTH)
        x = np.vstack([x, walk(parents) + 5])
        before, ends = openmm.XmlSerializer.serialize(system), []
        for with_it in (False, True):
            integrator = ChainVerletIntegrator(0.002)
            if with_it:
                with prepared(system, integrator):
                    self.assertEqual(system.getNumConstraints(), 3)  # the water
                    here = context(system, integrator, x)
            else:
                here = context(system, integrator, x)
            self.assertEqual(openmm.XmlSerializer.serialize(system), before)
            integrator.step(10)
            ends.append((positions(here), velocities(here), here.getMolecules()))
            del here
        self.assert_same(ends[0][0], ends[1][0])
        self.assert_same(ends[0][1], ends[1][1])
        self.assertEqual(ends[0][2], ends[1][2])

    def test_the_constraints_come_back_after_an_error(self):
        system = make_system(chain_parents(5))
        before = openmm.XmlSerializer.serialize(system)
        with self.assertRaises(ZeroDivisionError):
            with prepared(system, ChainVerletIntegrator(STEP)):
                self.assertEqual(system.getNumConstraints(), 0)
                raise ZeroDivisionError
        self.assertEqual(openmm.XmlSerializer.serialize(system), before)

    def refuse(self, system, integrator, pattern):
        before = openmm.XmlSerializer.serialize(system)
        with self.assertRaisesRegex(catena.InputError, pattern):
            with prepared(system, integrator):
                self.fail("entered")
        self.assertEqual(openmm.XmlSerializer.serialize(system), before)

    def test_what_it_refuses(self):
        system = make_system(chain_parents(5))
        self.refuse(system, openmm.VerletIntegrator(STEP), "not Catena's")
        system.setParticleMass(2, 0)
        self.refuse(system, ChainVerletIntegrator(STEP), r"massless particle \(System, particles 1 and 2\)")
        system.setParticleMass(2, 1)
        system.addConstraint(1, 0, LENGTH)
        self.refuse(system, ChainVerletIntegrator(STEP), r"two constraints .*particles 1 and 0")
        system.removeConstraint(4)
        integrator = ChainVerletIntegrator(STEP)
        with prepared(system, integrator):
            with self.assertRaisesRegex(catena.InputError, "held already"):
                with prepared(system, integrator):
                    pass
            context(system, integrator, walk(chain_parents(5)))
        with self.assertRaisesRegex(catena.InputError, "no Context was created"):
            with prepared(system, integrator):
                openmm.Context(system, openmm.VerletIntegrator(STEP), openmm.Platform.getPlatform("Reference"))
        with self.assertRaisesRegex(catena.InputError, "constraints have changed"):
            with prepared(system, integrator):
                system.addConstraint(0, 4, 1.0)
        self.assertEqual(system.getNumConstraints(), 5)
        system.addForce(openmm.AndersenThermostat(300, 1))
        self.refuse(system, integrator, "AndersenThermostat")


if __name__ == "__main__":
    package.main()
