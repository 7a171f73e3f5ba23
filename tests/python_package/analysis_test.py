#!/usr/bin/env python3
"""catena.analysis: sizes of chains and errors of means against NumPy, and on trajectories of MDAnalysis."""
import math
import unittest

import package  # first: it leaves where the package is not there
import catena
import numpy as np
from package import Case

try:
    import MDAnalysis
except ModuleNotFoundError:
    MDAnalysis = None


def chains(frames=200, sites=30):
    return np.random.default_rng(7).normal(size=(frames, sites, 3)).cumsum(axis=1)


def radii(x, mass):
    """Radii of gyration by their definition."""
    centre = (mass[:, None] * x).sum(axis=1) / mass.sum()
    return np.sqrt((mass * ((x - centre[:, None]) ** 2).sum(axis=2)).sum(axis=1) / mass.sum())


class Sizes(Case):
    def test_radii_are_those_of_their_definition(self):
        x, mass = chains(), np.linspace(1, 3, 30)
        found = catena.analysis.radius_of_gyration(x, mass)
        np.testing.assert_allclose(found.values, radii(x, mass), rtol=1e-12)
        self.assertAlmostEqual(found.mean, found.values.mean(), delta=1e-12)
        equal = catena.analysis.radius_of_gyration(x.astype(np.float32)[:, ::-1])
        np.testing.assert_allclose(equal.values, radii(x, np.ones(30)), rtol=1e-5)

    def test_distances_are_those_of_the_ends(self):
        x = chains()
        found = catena.analysis.end_to_end_distance(x)
        np.testing.assert_allclose(found.values, np.linalg.norm(x[:, -1] - x[:, 0], axis=1), rtol=1e-13)

    def test_errors_are_those_of_independent_and_correlated_values(self):
        noise = np.random.default_rng(3).normal(size=4096)
        found = catena.analysis.mean(noise)
        self.assertAlmostEqual(found.error / (noise.std() / 64), 1, delta=0.25)
        self.assertTrue(found.plateau)
        slow = catena.analysis.mean(np.repeat(noise, 16))
        self.assertAlmostEqual(slow.error / found.error, 1, delta=0.25)  # a naive error is four times smaller
        self.assertTrue(math.isnan(catena.analysis.mean([1.0]).error))

    def test_wrong_arrays_are_refused(self):
        for x, mass, words in ((np.zeros((3, 3)), None, "2 dimensions"), (np.zeros((3, 4, 2)), None, "wrong shape"), (np.zeros(3), None, "1 dimensions"),
                               (np.full((2, 4, 3), np.nan), None, "not finite"), (chains(2, 5), np.ones(4), "number of masses"),
                               (chains(2, 5), np.zeros(5), "not positive"), (np.zeros((0, 5, 3)), None, "no values")):
            with self.assertRaisesRegex(catena.InputError, words):
                catena.analysis.radius_of_gyration(x, mass)
        with self.assertRaisesRegex(catena.InputError, "wrong shape"):
            catena.analysis.end_to_end_distance(np.zeros((4, 1, 3)))

    @unittest.skipIf(MDAnalysis is None, "no MDAnalysis")
    def test_atom_groups_are_read_frame_by_frame(self):
        x, mass = chains(20, 12), np.linspace(1, 2, 12)
        universe = MDAnalysis.Universe.empty(12, trajectory=True)
        universe.load_new((10 * x).astype(np.float32), order="fac")
        universe.add_TopologyAttr("masses", mass)
        group = universe.select_atoms("index 2:11")
        found = catena.analysis.radius_of_gyration(group)
        np.testing.assert_allclose(found.values, radii(x[:, 2:], mass[2:]), rtol=1e-5)
        np.testing.assert_allclose(catena.analysis.end_to_end_distance(group).values, np.linalg.norm(x[:, -1] - x[:, 2], axis=1), rtol=1e-5)


if __name__ == "__main__":
    package.main()
