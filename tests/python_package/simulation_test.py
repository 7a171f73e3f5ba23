#!/usr/bin/env python3
"""Simulations of the Python package: bits of the program, arrays, own forces, observers, interruption, threads, checkpoints."""
import csv
import gc
import os
import pathlib
import signal
import threading
import time
import unittest
import weakref

import package  # first: it leaves where the package is not there
import catena
import numpy as np
from package import PENDULUM, Case, beads, scene


class Bits(Case):
    def test_steps_have_the_bits_of_the_program(self):
        if not self.program:
            self.skipTest("no program")
        names = ["spherical-chain.yaml"] + (["alpha-synuclein.yaml"] if catena.has_openmm else [])
        for name in names:
            changes = {"solver.backend": "segments", "output.every": 50, "output.checkpoint_every": 0}
            if name.startswith("alpha"):
                changes["forces.openmm.platform"] = "Reference"
            words = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
            done = self.run_program("run", scene(name), "--steps", "100", "--output", name + "-run", *words)
            self.assertEqual(done.returncode, 0, done.stderr)
            model = catena.load(scene(name))
            for key, value in changes.items():
                model.set(key, value)
            simulation = catena.Simulation(model)
            with open(os.path.join(name + "-run", "observables.csv"), encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(len(rows), 3)
            for row in rows:
                simulation.step(int(row["step"]) - simulation.steps)
                self.assertEqual(simulation.kinetic_energy, float(row["kinetic_energy [kJ/mol]"]))
                self.assertEqual(simulation.potential_energy, float(row["potential_energy [kJ/mol]"]))
                if "temperature [K]" in row:
                    self.assertEqual(simulation.temperature, float(row["temperature [K]"]))

    def test_steps_do_not_depend_on_how_they_are_asked_for(self):
        whole, parts = catena.Simulation(beads()), catena.Simulation(beads())
        whole.step(60)
        parts.observe(lambda s: s.positions, every=7)
        for n in (1, 20, 39):
            self.assertEqual(parts.step(n), n)
        self.assert_same(parts.positions, whole.positions)
        self.assert_same(parts.velocities, whole.velocities)
        self.assertEqual((parts.steps, parts.time), (60, 0.6))

    def test_whole_numbers_of_all_types_are_steps(self):
        simulation = catena.Simulation(PENDULUM)
        for n in (2, np.int64(2), 2.0, np.float64(2)):
            self.assertEqual(simulation.step(n), 2)
        self.assertEqual(simulation.steps, 8)
        for n in (2.5, "2", None, float("nan")):
            with self.assertRaisesRegex(catena.InputError, r"whole number"):
                simulation.step(n)

    def test_scenes_are_taken_in_every_form(self):
        first = catena.Simulation(scene("pendulum.yaml"))
        for form in (pathlib.Path(scene("pendulum.yaml")), catena.load(scene("pendulum.yaml"))):
            self.assert_same(catena.Simulation(form).positions, first.positions)
        with self.assertRaisesRegex(catena.InputError, "a list is not a scene"):
            catena.Simulation([1])

    def test_representations_name_size_and_step(self):
        simulation = catena.Simulation(PENDULUM)
        simulation.step(20)
        self.assertEqual(repr(simulation), "<catena.Simulation: 2 bodies, step 20, time 0.02>")
        self.assertEqual(repr(simulation.state), "<catena.State: 2 bodies, step 20, time 0.02>")


class Arrays(Case):
    def test_states_keep_their_numbers(self):
        simulation = catena.Simulation(PENDULUM)
        before = simulation.positions
        copy = before.copy()
        self.assertIs(simulation.state, simulation.state)
        simulation.step(50)
        self.assert_same(before, copy)
        self.assertFalse(np.array_equal(simulation.positions, copy))
        after = simulation.positions
        copy = after.copy()
        del simulation
        gc.collect()
        self.assert_same(after, copy)
        self.assertFalse(after.flags.writeable or after.flags.owndata)

    def test_shapes_are_those_of_the_documentation(self):
        state = catena.Simulation(PENDULUM).state
        shapes = {"positions": 3, "velocities": 3, "orientations": 4, "angular_velocities": 3, "joint_forces": 3, "joint_torques": 3,
                  "joint_positions": 4, "joint_rates": 3}
        for name, width in shapes.items():
            self.assertEqual(getattr(state, name).shape, (2, width), name)
        self.assertEqual(state.joint_positions[0][0], 0.3)
        self.assertEqual(state.total_energy, state.kinetic_energy + state.potential_energy)
        self.assertIn("gravity", state.potential_energies)
        self.assertIsNone(state.temperature)
        self.assertIn("(n_bodies, 3), nm", type(state).positions.__doc__)


def weight(x, q):
    return 2 * 9.81 * float(x[:, 2].sum()), np.tile([0.0, 0.0, -2 * 9.81], (len(x), 1))


class OwnForces(Case):
    still = {key: value for key, value in PENDULUM.items() if key != "forces"}

    def test_a_weight_moves_as_gravity_does(self):
        own, built_in = catena.Simulation(self.still, weight), catena.Simulation(PENDULUM)
        own.step(300)
        built_in.step(300)
        np.testing.assert_allclose(own.positions, built_in.positions, rtol=0, atol=1e-11)
        self.assertAlmostEqual(own.total_energy, built_in.total_energy, delta=1e-10)
        self.assertIn("own force", own.state.potential_energies)

    def test_its_arguments_are_its_own(self):
        kept = []
        simulation = catena.Simulation(self.still, lambda x, q: (kept.append(x), weight(x, q))[1])
        start = simulation.positions
        simulation.step(20)
        np.testing.assert_allclose(kept[0], start, rtol=0, atol=1e-14)
        self.assertFalse(np.array_equal(kept[0], kept[-1]))

    def test_wrong_results_are_refused(self):
        zero = np.zeros((2, 3))
        for result, words in ((zero, "tuple of 2 or 3"), ((0.0, np.zeros((3, 3))), r"shape \(3, 3\)"), ((0.0, "text"), "not a two-dimensional array"), (("much", zero), "not a number"),
                              ((0.0, zero, np.zeros(3)), "torques"), ((0.0, zero, zero, zero), "tuple of 2 or 3")):
            with self.assertRaisesRegex(catena.InputError, words):
                catena.Simulation(self.still, lambda x, q, result=result: result).step()
        with self.assertRaisesRegex(catena.InputError, "not callable"):
            catena.Simulation(self.still, 5)
        with self.assertRaisesRegex(catena.ComputationError, "not finite"):
            catena.Simulation(self.still, lambda x, q: (0, zero + np.nan)).step()
        with self.assertRaisesRegex(catena.InputError, "a bead takes no torque"):
            catena.Simulation(beads(3), lambda x, q: (0, np.zeros((3, 3)), np.ones((3, 3)))).step()

    def test_its_exceptions_pass_and_the_simulation_says_so_after(self):
        fails = False

        def force(x, q):
            if fails:
                raise KeyError("mine")
            return weight(x, q)

        simulation = catena.Simulation(self.still, force)
        simulation.step(5)
        kept = simulation.checkpoint()
        fails = True
        with self.assertRaisesRegex(KeyError, "mine"):
            simulation.step(5)
        fails = False
        with self.assertRaisesRegex(catena.ComputationError, "failed after step 5"):
            simulation.step(1)
        simulation.restore(kept)
        self.assertEqual(simulation.step(5), 5)
        self.assertEqual(simulation.steps, 10)

    def test_it_cannot_ask_its_simulation(self):
        holder = []
        simulation = catena.Simulation(self.still, lambda x, q: (holder[0].state if holder else None, weight(x, q))[1])
        holder.append(simulation)
        with self.assertRaisesRegex(catena.ComputationError, "is computing"):
            simulation.step(1)

    def test_a_circle_through_the_force_is_collected(self):
        class Owner:
            def __init__(self):
                self.simulation = catena.Simulation(OwnForces.still, self.force)

            def force(self, x, q):
                return weight(x, q)

        owner = Owner()
        owner.simulation.step(2)
        gone = weakref.ref(owner)
        del owner
        gc.collect()
        self.assertIsNone(gone())


class Observers(Case):
    def test_they_are_called_at_multiples(self):
        simulation = catena.Simulation(PENDULUM)
        simulation.step(3)
        seen = []
        observer = lambda s: seen.append((s.steps, float(s.positions[1][0])))
        simulation.observe(observer, every=10)
        simulation.step(28)
        self.assertEqual([n for n, _ in seen], [10, 20, 30])
        simulation.stop_observing(observer)
        simulation.step(20)
        self.assertEqual(len(seen), 3)
        with self.assertRaises(catena.InputError):
            simulation.stop_observing(observer)
        with self.assertRaises(catena.InputError):
            simulation.observe(observer, every=0)
        with self.assertRaisesRegex(catena.InputError, "not callable"):
            simulation.observe(None)

    def test_methods_can_stop_observing(self):
        class Counter:
            seen = 0

            def look(self, simulation):
                self.seen += 1

        simulation, counter = catena.Simulation(PENDULUM), Counter()
        simulation.observe(counter.look)
        simulation.step(3)
        simulation.stop_observing(counter.look)
        simulation.step(3)
        self.assertEqual(counter.seen, 3)

    def test_their_exceptions_leave_a_usable_simulation(self):
        simulation = catena.Simulation(PENDULUM)

        def observer(s):
            raise ZeroDivisionError

        simulation.observe(observer, every=4)
        with self.assertRaises(ZeroDivisionError):
            simulation.step(10)
        self.assertEqual(simulation.steps, 4)
        simulation.stop_observing(observer)
        whole = catena.Simulation(PENDULUM)
        whole.step(10)
        simulation.step(6)
        self.assert_same(simulation.positions, whole.positions)

    def test_they_take_no_steps_themselves(self):
        simulation = catena.Simulation(PENDULUM)
        simulation.observe(lambda s: s.step(1))
        with self.assertRaisesRegex(catena.InputError, "observer"):
            simulation.step(1)


class Interruption(Case):
    def interrupted(self, simulation, steps):
        """Takes steps until Ctrl-C arrives after a tenth of a second."""
        timer = threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        begun = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            simulation.step(steps)
        timer.join()
        return time.monotonic() - begun

    def test_ctrl_c_stops_after_a_step_and_the_simulation_goes_on(self):
        for force in (None, weight):
            scene_ = PENDULUM if force is None else OwnForces.still
            simulation = catena.Simulation(scene_, force)
            self.assertLess(self.interrupted(simulation, 10**9), 5)
            reached = simulation.steps
            self.assertGreater(reached, 0)
            self.assertLess(reached, 10**9)
            positions = simulation.positions
            again = catena.Simulation(scene_, force)
            again.step(reached)
            self.assert_same(again.positions, positions)
            self.assertEqual(simulation.step(3), 3)

    def test_the_largest_number_of_steps_is_taken_after_others(self):
        for n in (2**63 - 1, 10**30):
            simulation = catena.Simulation(PENDULUM)
            simulation.step(2)
            self.interrupted(simulation, n)
            self.assertGreater(simulation.steps, 2)

    def test_an_interrupted_step_is_observed(self):
        force = InterruptedForce()
        simulation = catena.Simulation(OwnForces.still, force)
        seen = []
        simulation.observe(lambda s: seen.append(s.steps), every=4)
        force.interrupts = True
        with self.assertRaises(KeyboardInterrupt):
            simulation.step(10)
        stopped = simulation.steps
        self.assertEqual((stopped, seen), (1, []))
        simulation.step(2)
        force.interrupts = True
        with self.assertRaises(KeyboardInterrupt):
            simulation.step(10)
        self.assertEqual((simulation.steps, seen), (4, [4]))
        simulation.step(4)
        self.assertEqual(seen, [4, 8])

    def test_short_runs_between_observations_are_observed_too(self):
        simulation = catena.Simulation(beads(1000))
        observed = 0
        for _ in range(5):
            seen = []
            observer = lambda s: seen.append(s.steps)
            simulation.observe(observer)
            self.interrupted(simulation, 10**9)
            simulation.stop_observing(observer)
            observed += seen[-1] == simulation.steps
        self.assertGreaterEqual(observed, 3)  # Ctrl-C may also arrive in an observer

    def test_a_restored_state_is_there_after_ctrl_c(self):
        force = InterruptedForce()
        simulation = catena.Simulation(beads(), force)
        kept, positions = simulation.checkpoint(), simulation.positions
        simulation.step(50)
        self.assertFalse(np.array_equal(simulation.positions, positions))
        force.interrupts = True
        with self.assertRaises(KeyboardInterrupt):
            simulation.restore(kept)
        self.assertEqual(simulation.steps, 0)
        self.assert_same(simulation.positions, positions)

    def test_ctrl_c_in_the_force_ends_the_construction(self):
        force = InterruptedForce()
        force.interrupts = True
        with self.assertRaises(KeyboardInterrupt):
            catena.Simulation(beads(), force)

    def test_a_failure_after_ctrl_c_is_the_only_exception(self):
        force = InterruptedForce()
        simulation = catena.Simulation(OwnForces.still, force)
        kept = simulation.checkpoint()
        force.interrupts = force.fails = True
        with self.assertRaises(ZeroDivisionError):
            simulation.step()
        force.fails = False
        simulation.restore(kept)
        self.assertEqual(simulation.step(3), 3)


class InterruptedForce:
    """The weight, with Ctrl-C during its next call if ``interrupts``; it fails after that if ``fails``."""

    interrupts = fails = False

    def __call__(self, x, q):
        if self.interrupts:
            self.interrupts = False
            raise KeyboardInterrupt
        if self.fails:
            raise ZeroDivisionError
        return weight(x, q)


class Threads(Case):
    def test_other_threads_run_while_steps_are_computed(self):
        simulation = catena.Simulation(PENDULUM)
        thread = threading.Thread(target=simulation.step, args=(20000,))
        thread.start()
        turns = 0
        while thread.is_alive():
            turns += 1
            time.sleep(0.0005)
        thread.join()
        self.assertGreater(turns, 10)
        self.assertEqual(simulation.steps, 20000)

    def test_other_threads_read_progress(self):
        simulation = catena.Simulation(PENDULUM)
        kept = simulation.checkpoint()

        def work():
            for _ in range(40):
                simulation.step(500)
                simulation.restore(kept)

        thread = threading.Thread(target=work)
        thread.start()
        seen = set()
        while thread.is_alive():
            seen.add((simulation.steps, bool(simulation.time >= 0), len(simulation.notes)))
        thread.join()
        between = [steps for steps, _, _ in seen if 0 < steps < 500]
        self.assertGreater(len(between), 3)
        self.assertEqual({(valid, notes) for _, valid, notes in seen}, {(True, 0)})

    def test_progress_is_read_inside_the_force(self):
        seen = []

        def force(x, q):
            if holder:
                seen.append((holder[0].steps, holder[0].time, len(holder[0].notes)))
            return weight(x, q)

        holder = []
        holder.append(catena.Simulation(beads(), force))
        holder[0].step(3)
        self.assertEqual(sorted(set(seen)), [(0, 0.0, 0), (1, 0.01, 0), (2, 0.02, 0)])  # of steps that are complete

    def test_steps_of_a_second_thread_are_refused_by_their_reason(self):
        simulation = catena.Simulation(PENDULUM)
        inside, goes_on = threading.Event(), threading.Event()
        simulation.observe(lambda s: (inside.set(), goes_on.wait(30)))
        thread = threading.Thread(target=simulation.step)
        thread.start()
        self.assertTrue(inside.wait(30))
        try:
            with self.assertRaisesRegex(catena.ComputationError, "another thread"):
                simulation.step()
        finally:
            goes_on.set()
            thread.join()
        simulation.observe(lambda s: None)
        self.assertEqual(simulation.step(), 1)

    def test_a_state_of_before_another_threads_steps_is_not_kept(self):
        simulation = catena.Simulation(PENDULUM)

        class Late:
            """The C++ part; another thread takes steps between the computation of a state and its return."""

            def __getattr__(self, name):
                return getattr(live, name)

            def state(self):
                found = live.state()
                simulation._live = live
                thread = threading.Thread(target=simulation.step, args=(10,))
                thread.start()
                thread.join()
                return found

        live, simulation._live = simulation._live, Late()
        self.assertEqual(simulation.state.steps, 0)
        self.assertEqual(simulation.state.steps, 10)

    def test_a_second_thread_is_refused(self):
        simulation = catena.Simulation(PENDULUM)
        thread = threading.Thread(target=simulation.step, args=(30000,))
        thread.start()
        refused = 0
        while thread.is_alive():
            try:
                simulation._live.state()
            except catena.ComputationError:
                refused += 1
            time.sleep(0.001)
        thread.join()
        self.assertGreater(refused, 0)


class Checkpoints(Case):
    def test_they_continue_with_the_same_bits(self):
        for model in (catena.Model(PENDULUM), beads()):
            simulation = catena.Simulation(model)
            simulation.step(40)
            simulation.save("here.checkpoint")
            kept = simulation.checkpoint()
            self.assertIsInstance(kept, bytes)
            simulation.step(50)
            other = catena.Simulation(model)
            other.load("here.checkpoint")
            self.assertEqual(other.steps, 40)
            other.step(50)
            self.assertEqual(other.time, simulation.time)
            self.assert_same(other.positions, simulation.positions)
            self.assert_same(other.velocities, simulation.velocities)
            self.assertEqual(os.path.getsize("here.checkpoint"), len(kept))

    def test_others_and_damaged_ones_are_refused(self):
        simulation = catena.Simulation(PENDULUM)
        kept = simulation.checkpoint()
        with self.assertRaisesRegex(catena.InputError, "another scene"):
            catena.Simulation(beads()).restore(kept)
        with self.assertRaisesRegex(catena.InputError, "damaged"):
            simulation.restore(kept[:-1] + bytes([kept[-1] ^ 1]))
        with self.assertRaisesRegex(catena.InputError, r"load\(path\)"):
            simulation.restore("here.checkpoint")
        simulation.restore(bytearray(kept))
        with self.assertRaisesRegex(catena.InputError, "-3"):
            simulation.step(-3)


if __name__ == "__main__":
    package.main()
