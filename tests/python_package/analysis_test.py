#!/usr/bin/env python3
"""catena.analysis: sizes, curves and errors against NumPy and the program, on arrays, records and trajectories of MDAnalysis."""
import json
import math
import pathlib
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


def chains_of(model, copies=3):
    """A scene of equal chains of beads in a box, that move under Langevin dynamics."""
    beads = [{"mass": 1 + 0.1 * (k % 2), "position": [0.38 * k, 0, 0], **({"joint": {"type": "link"}} if k else {})} for k in range(12)]
    for number in range(copies):
        moved = [dict(bead, position=[bead["position"][0], 0.9 * number, 0]) for bead in beads]
        model.add(f"peptide-{number + 1}", bodies=moved)
    model.set("box", {"periodic": [12, 12, 40]})
    model.set("dynamics", {"integrator": "g-baoab", "step": 0.01, "temperature": 300, "friction": 1, "seed": 3, "steps": 400})
    return model.set("output", {"every": 10, "observables": ["temperature"]})


class Analyses(Case):
    def test_curves_are_those_of_their_definitions(self):
        x = chains(64, 20)
        curve = catena.analysis.internal_distances(x)
        for s, value in zip(curve.x.astype(int), curve.values):
            squares = ((x[:, s:] - x[:, :-s]) ** 2).sum(axis=2)
            self.assertAlmostEqual(value / np.sqrt(squares.mean()), 1, delta=1e-12)
        bonds = np.diff(x, axis=1)
        bonds /= np.linalg.norm(bonds, axis=2)[..., None]
        found = catena.analysis.analyse(x, cutoff=0)
        cosines = found.curve("bond_correlation")
        self.assertAlmostEqual(cosines.values[1], (bonds[:, 2:] * bonds[:, :-2]).sum(axis=2).mean(), delta=1e-12)
        self.assertAlmostEqual(found["radius_of_gyration"].mean, catena.analysis.radius_of_gyration(x).mean, delta=1e-12)
        self.assertEqual(found.series("radius_of_gyration").shape, (64, 1))

    def test_random_walks_have_the_exponent_one_half(self):
        x = np.random.default_rng(2).normal(size=(400, 200, 3)).cumsum(axis=1)
        exponent = catena.analysis.scaling_exponent(x, fit=(2, 40))
        self.assertAlmostEqual(exponent.mean, 0.5, delta=4 * exponent.error)
        self.assertEqual(exponent.fit, (2, 40))
        self.assertAlmostEqual(exponent.prefactor, 3**0.5, delta=0.1)
        self.assertRegex(str(exponent), r"^0\.[45]\d* \+- (at least )?0\.0")

    def test_stiff_chains_have_their_persistence_length(self):
        turns = np.random.default_rng(5).normal(scale=0.2, size=(300, 60)).cumsum(axis=1)
        x = 0.5 * np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=2).cumsum(axis=1)
        found = catena.analysis.persistence_length(x)  # cosine = exp(-s 0.2^2 / 2)
        self.assertAlmostEqual(found.mean / (0.5 / 0.02), 1, delta=0.1)

    def test_contacts_are_counted_within_and_between_chains(self):
        two = np.zeros((1, 8, 3))
        two[0, :4, 0] = two[0, 4:, 0] = np.arange(4) * 0.5
        two[0, 4:, 1] = 0.6
        found = catena.analysis.analyse(np.repeat(two, 4, axis=0), [4, 4], cutoff=0.7)
        self.assertEqual(found["contacts_between"].mean, 4)
        np.testing.assert_array_equal(found.contact_map(within=False).mean, np.eye(4))
        self.assertEqual(found.contact_map().mean[0, 1], 1)
        self.assertEqual(found.contact_map().mean[0, 2], 0)
        self.assertEqual(found.kinds, [("chain", 4, 2)])

    def test_the_density_of_a_slab_is_mass_over_volume(self):
        generator = np.random.default_rng(1)
        z = np.concatenate([generator.uniform(-4, 4, (50, 300)), generator.uniform(-20, 20, (50, 20))], axis=1)
        x = np.stack([generator.uniform(0, 10, z.shape), generator.uniform(0, 10, z.shape), z], axis=2)
        curve = catena.analysis.density_profile(x, 1, slab="z", masses=np.full(320, 100.0), box=[10, 10, 40], bins=80)
        width = curve.x[1] - curve.x[0]
        self.assertAlmostEqual(curve.values.sum() * width * 100 / (320 * 100 * 1.66053906660), 1, delta=1e-6)
        self.assertGreater(curve.values[35:45].mean(), 20 * curve.values[:10].mean())
        self.assertEqual((curve.unit, curve.variable_unit), ("mg/ml", "nm"))

    def test_numbers_are_named_by_kind(self):
        x = chains(40, 12)
        found = catena.analysis.analyse(x, [5, 7], cutoff=0)
        with self.assertRaisesRegex(catena.InputError, "each kind of chains"):
            found["radius_of_gyration"]
        self.assertGreater(found["radius_of_gyration", "chain-2"].mean, 0)
        with self.assertRaisesRegex(catena.InputError, "there are .*asphericity"):
            found["size"]
        self.assertIn("radius_of_gyration", str(found))

    def test_what_cannot_be_known_is_left_out_and_noted(self):
        x = chains(40, 12)
        found = catena.analysis.analyse(x, cutoff=0)
        self.assertEqual(found.notes, ["displacements and diffusion are left out: give times, ps"])
        self.assertNotIn("diffusion", [each.name for each in found.quantities])
        timed = catena.analysis.analyse(x, cutoff=0, times=np.arange(40) * 2.0)
        self.assertEqual(timed["diffusion"].unit, "nm^2/ps")
        jumping = np.zeros((40, 4, 3)) + np.arange(4)[:, None] * [0.3, 0, 0]
        jumping[::2, :, 2] += 7
        found = catena.analysis.analyse(jumping, box=[10, 10, 10], times=np.arange(40), cutoff=0)
        self.assertIn("jump by more than half of the box", " ".join(found.notes))

    def test_wrong_arguments_are_refused(self):
        x = chains(10, 12)
        for arguments, words in (({"chains": [5, 6]}, "11 beads and the positions 12"), ({"chains": 5}, "no whole number"), ({"masses": np.ones(3)}, "3 masses"),
                                 ({"residues": ["GLY"]}, "1 residues"), ({"slab": "w"}, "axis of the slab"), ({"slab": "z"}, r"slab='z'\): leave slab out"),
                                 ({"discard": 1}, "discard"), ({"bins": 3}, "even"), ({"cutoff": -1}, "cutoff"), ({"box": [1, 2]}, "three positive edges"),
                                 ({"times": [1]}, "1 times"), ({"box": [9, 9, 9], "cutoff": 5}, r"exceeds half .*\(cutoff\)")):
            with self.assertRaisesRegex(catena.InputError, words):
                catena.analysis.analyse(x * 0.1, **arguments)
        cut = chains(3, 12) * 0.1
        cut[1, 6:] += [8, 0, 0]
        with self.assertRaisesRegex(catena.InputError, "cut at a face of the box in frame 1"):
            catena.analysis.analyse(cut, box=[9, 9, 9])

    def test_records_have_the_numbers_of_the_program(self):
        if not self.program:
            self.skipTest("no program")
        model = chains_of(catena.Model())
        pathlib.Path("chains.yaml").write_text(model.text + "".join(f"{key}: {value}\n" for key, value in model._changes), encoding="utf-8")
        done = self.run_program("run", "chains.yaml", "--output", "run", "--backend", "serial")
        if "without HDF5" in done.stderr:
            self.skipTest("no HDF5")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.run_program("analyse", "run", "--first", "1", "--slab", "z", "--json", "found.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        theirs = json.loads(pathlib.Path("found.json").read_text(encoding="utf-8"))
        simulation = catena.Simulation(catena.Model("chains.yaml").set("solver.backend", "serial"))
        record = catena.Record(simulation, every=10)
        simulation.step(400)
        ours = catena.analysis.analyse(record, slab="z")
        self.assertEqual([each.name for each in ours.quantities], [each["name"] for each in theirs["quantities"]])
        for each, other in zip(ours.quantities, theirs["quantities"]):
            if other["value"] is not None:
                self.assertAlmostEqual(each.mean, other["value"], delta=2e-6 * abs(other["value"]) + 1e-9, msg=each.name)
        self.assertEqual([curve.name for curve in ours.curves], [curve["name"] for curve in theirs["curves"]])
        for curve, other in zip(ours.curves, theirs["curves"]):
            np.testing.assert_allclose(curve.values, np.array(other["value"], dtype=float), rtol=1e-4, atol=1e-6)

    @unittest.skipIf(MDAnalysis is None, "no MDAnalysis")
    def test_atom_groups_have_chains_masses_box_and_times(self):
        x = np.concatenate([chains(20, 6) * 0.1 + 3, chains(20, 6) * 0.1 + 6], axis=1)
        universe = MDAnalysis.Universe.empty(12, n_residues=12, atom_resindex=range(12), residue_segindex=[0] * 6 + [1] * 6, n_segments=2, trajectory=True)
        universe.load_new((10 * x).astype(np.float32), order="fac", dt=2.0, dimensions=np.array([90, 90, 90, 90, 90, 90]))
        universe.add_TopologyAttr("masses", np.linspace(1, 2, 12))
        found = catena.analysis.analyse(universe.atoms, cutoff=1.0)
        self.assertEqual([kind[1:] for kind in found.kinds], [(6, 1), (6, 1)])
        direct = catena.analysis.analyse(x, [6, 6], masses=np.linspace(1, 2, 12), box=[9, 9, 9], times=2.0 * np.arange(20), cutoff=1.0)
        for each, other in zip(found.quantities, direct.quantities):
            np.testing.assert_allclose(each.mean, other.mean, rtol=1e-4, atol=1e-6, err_msg=each.name)
        universe.add_TopologyAttr("bonds", [(k, k + 1) for k in range(11) if k not in (2, 5)])
        self.assertIn("each of 2 segments is taken as a chain, but bonds make 3 molecules", " ".join(catena.analysis.analyse(universe.atoms, cutoff=0).notes))
        self.assertEqual(len(catena.analysis.analyse(universe.atoms, [3, 3, 6], cutoff=0).kinds), 3)
        with self.assertRaisesRegex(catena.InputError, "do not follow each other"):
            catena.analysis.analyse(universe.atoms[[0, 6, 1]])


if __name__ == "__main__":
    package.main()
