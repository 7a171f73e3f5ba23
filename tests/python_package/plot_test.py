#!/usr/bin/env python3
"""catena.Record, catena.plot and the display of progress."""
import contextlib
import io
import os
import signal
import sys
import threading
import time
import unittest
from unittest import mock

import package  # first: it leaves where the package is not there
import catena
import numpy as np
from package import PENDULUM, Case, beads, scene

os.environ["MPLBACKEND"] = "Agg"
try:
    from matplotlib import pyplot
except ModuleNotFoundError:
    pyplot = None
try:
    import tqdm
except ModuleNotFoundError:
    tqdm = None


class Records(Case):
    def test_they_hold_what_the_simulation_had(self):
        simulation = catena.Simulation(beads())
        record = catena.Record(simulation, every=5)
        seen = []
        simulation.observe(lambda s: seen.append((s.steps, s.time, s.positions, s.total_energy)), every=5)
        simulation.step(17)
        record.stop()
        simulation.step(10)
        self.assertEqual(len(record), 3)
        self.assertEqual(record.steps.tolist(), [5, 10, 15])
        for number, (_, moment, positions, energy) in enumerate(seen[:3]):
            self.assert_same(record.positions[number], positions)
            self.assertEqual(record.times[number], moment)
            self.assertEqual(record.total_energies[number], energy)
        np.testing.assert_allclose(record.masses, 1 + 0.1 * np.arange(12))
        self.assertEqual(record.topology.chains, [("beads", 0, 12, False)])
        self.assertTrue(np.isnan(record.temperatures).all())  # SI units without a thermostat
        with self.assertRaisesRegex(catena.InputError, "a record knows its chains"):
            catena.analysis.analyse(record, [12])

    def test_their_sites_are_the_beads_of_bodies(self):
        model = catena.load(scene("three-domains.yaml")).set("forces", None)
        simulation = catena.Simulation(model)
        record = catena.Record(simulation)
        simulation.step(2)
        self.assertGreater(record.positions.shape[1], simulation.n_bodies)
        self.assertEqual(record.positions.shape[1], len(record.masses))
        bonds = np.linalg.norm(np.diff(record.positions[-1], axis=0), axis=1)
        self.assertTrue((bonds > 0.2).all() and (bonds < 1).all())

    def test_a_later_change_of_the_model_does_not_matter(self):
        model = catena.Model(PENDULUM)
        simulation = catena.Simulation(model)
        model.add("more", base="fixed", bodies=PENDULUM["chains"][0]["bodies"])
        record = catena.Record(simulation)
        simulation.step(1)
        self.assertEqual(record.positions.shape, (1, 2, 3))


@unittest.skipIf(pyplot is None, "no matplotlib")
class Pictures(Case):
    @classmethod
    def setUpClass(cls):
        simulation = catena.Simulation(beads(16).set("dynamics", {"integrator": "g-baoab", "step": 0.001, "temperature": 300, "friction": 1, "seed": 1}))
        cls.record = catena.Record(simulation, every=2)
        simulation.step(200)

    def tearDown(self):
        pyplot.close("all")

    def test_series_show_values_mean_and_error(self):
        record = self.record
        size = catena.analysis.radius_of_gyration(record)
        axes = catena.plot.radius_of_gyration(record)
        self.assert_same(axes.lines[0].get_ydata(), size.values)
        self.assert_same(axes.lines[0].get_xdata(), record.times)
        self.assertIn(f"{size.mean:.4g} ±", axes.get_legend().get_texts()[0].get_text())
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("time [s]", "radius of gyration [m]"))
        half = catena.plot.radius_of_gyration(record, discard=0.5)
        self.assertEqual(half.lines[1].get_ydata()[0], catena.analysis.mean(size.values[50:]).mean)
        warm = catena.plot.temperature(record)
        self.assert_same(warm.lines[0].get_ydata(), record.temperatures)
        self.assertEqual([line.get_label() for line in catena.plot.energy(record).lines], ["total", "kinetic", "potential"])

    def test_curves_show_the_analysis(self):
        found = catena.analysis.analyse(self.record, fit=(1, 8), cutoff=2.0)
        axes = catena.plot.internal_distances(found)
        self.assert_same(axes.lines[0].get_ydata(), found.curve("internal_distances").values)
        exponent = found["scaling_exponent"]
        self.assertIn(f"{exponent.mean:.3f}", axes.get_legend().get_texts()[0].get_text())
        line = axes.lines[1].get_ydata()
        self.assertAlmostEqual(np.log(line[-1] / line[0]) / np.log(8), exponent.mean, delta=1e-9)
        self.assert_same(catena.plot.distribution(found).lines[0].get_ydata(), found.curve("radius_distribution").values)
        shown = catena.plot.contact_map(found).images[0].get_array()
        self.assertEqual(shown.shape, (16, 16))

    def test_density_shows_each_kind(self):
        x = np.random.default_rng(1).uniform(-1, 1, (10, 12, 3))
        found = catena.analysis.analyse(x, [1] * 12, residues=["A", "B"] * 6, box=[5, 5, 10], slab="z", cutoff=0)
        axes = catena.plot.density(found)
        self.assertEqual(len(axes.lines), 3)
        with self.assertRaisesRegex(catena.InputError, "no density profile"):
            catena.plot.density(catena.analysis.analyse(x, cutoff=0))

    def test_axes_may_be_given_and_files_written(self):
        figure, given = pyplot.subplots()
        self.assertIs(catena.plot.energy(self.record, axes=given), given)
        figure.savefig("energy.png")
        self.assertGreater(os.path.getsize("energy.png"), 1000)

    def test_what_cannot_be_drawn_is_said(self):
        with self.assertRaisesRegex(catena.InputError, "give a catena.Record"):
            catena.plot.energy(np.zeros(3))
        with self.assertRaisesRegex(catena.InputError, "no frames"):
            catena.plot.energy(catena.Record(catena.Simulation(PENDULUM)))
        with self.assertRaisesRegex(catena.InputError, "2 times and 3 frames"):
            catena.plot.radius_of_gyration(np.random.default_rng(1).normal(size=(3, 4, 3)), times=[1, 2])
        with mock.patch.dict(sys.modules, {"matplotlib": None}), self.assertRaisesRegex(ImportError, "pip install matplotlib"):
            catena.plot.energy(self.record)


@unittest.skipIf(tqdm is None, "no tqdm")
class Progress(Case):
    def shown(self, simulation, steps):
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            simulation.step(steps, progress=True)
        return said.getvalue()

    def test_it_shows_steps_and_rate_and_changes_no_bits(self):
        simulation, other = catena.Simulation(PENDULUM), catena.Simulation(PENDULUM)
        last = self.shown(simulation, 30000).split("\r")[-1]
        self.assertRegex(last, r"100%.*30000/30000 \[.*steps/s\]")
        other.step(30000)
        self.assert_same(simulation.positions, other.positions)
        self.assertNotIn("catena-progress", [thread.name for thread in threading.enumerate()])

    def test_ctrl_c_leaves_the_number_of_steps(self):
        simulation = catena.Simulation(PENDULUM)
        timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
        said = io.StringIO()
        timer.start()
        with contextlib.redirect_stderr(said), self.assertRaises(KeyboardInterrupt):
            simulation.step(10**9, progress=True)
        timer.join()
        self.assertNotIn("catena-progress", [thread.name for thread in threading.enumerate()])
        self.assertGreater(simulation.steps, 0)
        self.assertEqual(simulation.step(2), 2)

    def test_without_tqdm_it_says_what_to_install(self):
        simulation = catena.Simulation(PENDULUM)
        with mock.patch.dict(sys.modules, {"tqdm": None, "tqdm.auto": None}), self.assertRaisesRegex(ImportError, "pip install tqdm"):
            simulation.step(1, progress=True)
        self.assertEqual((simulation.steps, simulation.step(1)), (0, 1))


if __name__ == "__main__":
    package.main()
