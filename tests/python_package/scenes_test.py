#!/usr/bin/env python3
"""Scenes of the Python package: dicts, texts, files and models chain by chain; their checks and solutions."""
import copy
import csv
import gc
import json
import pathlib
import pickle
import unittest
import warnings

import package  # first: it leaves where the package is not there
import catena
import numpy as np
from catena.text import value_text
from package import PENDULUM, Case, scene


class Scenes(Case):
    def test_dicts_texts_files_and_builders_are_the_same_scene(self):
        text = catena.Model(PENDULUM).text
        pathlib.Path("pendulum.yaml").write_text(text, encoding="utf-8")
        built = catena.Model(units="si").add("rods", base="fixed", bodies=PENDULUM["chains"][0]["bodies"])
        built.set("forces.gravity", (0, 0, -9.81)).set("dynamics", PENDULUM["dynamics"])
        first = catena.solve(PENDULUM)
        for other in (text, "pendulum.yaml", pathlib.Path("pendulum.yaml"), built, catena.Model(built)):
            self.assert_same(catena.solve(other).joint_accelerations, first.joint_accelerations)

    def test_values_become_text_without_loss(self):
        for number in (0.1 + 0.2, 1e-300, -0.0, 5e22, 1 / 3, 2**60 + 1, np.float64(1 / 7), np.float32(0.1)):
            text = value_text(number, "key")
            self.assertEqual(repr(type(number)(text)), repr(number))
        for text in ("it's \"quoted\": #1\n\t\u00e9", "yes", "0.01", "", "- a: b", "null"):
            self.assertEqual(json.loads(value_text(text, "key")), text)
        values = {"a": [True, False, None, []], "b c": {"d": (1, 2.5)}, "e": pathlib.Path("f/g"), "h": np.array([[1, 2], [3, 4]])}
        self.assertEqual("".join(value_text(values, "key").split()),
                         '{a:[true,false,null,[]],"bc":{d:[1,2.5]},e:"f/g",h:[[1,2],[3,4]]}')

    def test_arrays_and_numbers_of_numpy_are_values(self):
        bodies = [dict(body, com=np.array(body["com"]), mass=np.float32(2)) for body in PENDULUM["chains"][0]["bodies"]]
        changed = {**PENDULUM, "chains": [{**PENDULUM["chains"][0], "bodies": bodies}]}
        self.assert_same(catena.solve(changed).accelerations, catena.solve(PENDULUM).accelerations)

    def test_a_model_does_not_change_with_its_dict(self):
        mine = {**PENDULUM, "chains": list(PENDULUM["chains"])}
        model = catena.Model(mine)
        mine["chains"].append({"name": "wrong"})
        self.assertEqual(model.n_bodies, 2)

    def test_copies_of_models_have_changes_of_their_own(self):
        model = catena.Model(PENDULUM).set("dynamics.step", 0.002)
        self.assertEqual(model.n_bodies, 2)
        for other in (copy.copy(model), copy.deepcopy(model), pickle.loads(pickle.dumps(model)), catena.Model(model)):
            other.add("more", base="fixed", bodies=PENDULUM["chains"][0]["bodies"][:1]).set("dynamics.step", 0.003)
            self.assertEqual((other.n_bodies, model.n_bodies), (3, 2))
            self.assertEqual(catena.Simulation(other).step(1), 1)
        simulation = catena.Simulation(model)
        simulation.step()
        self.assertEqual(simulation.time, 0.002)

    def test_none_removes_a_key(self):
        self.assert_same(catena.solve(catena.load(PENDULUM).set("forces", None)).accelerations, np.zeros((2, 3)))

    def test_representations_name_the_origin(self):
        self.assertEqual(repr(catena.Model(PENDULUM).set("units", "si")), "<catena.Model: dict with 1 chain, 1 change>")
        self.assertIn("pendulum.yaml'>", repr(catena.Model(scene("pendulum.yaml"))))
        self.assertRegex(repr(catena.solve(PENDULUM)), "<catena.Solution: 2 bodies, valid, residual [0-9.e-]+>")

    def test_errors_have_the_words_of_the_program(self):
        wrong = {**PENDULUM, "forces": {"gravitation": [0, 0, 1]}}
        with self.assertRaisesRegex(catena.InputError, r"unknown key `gravitation` \(scene in memory: forces.gravitation, line \d+\): use one of"):
            catena.check(wrong)
        self.assertTrue(issubclass(catena.InputError, (catena.Error,)) and issubclass(catena.InputError, ValueError))
        with self.assertRaisesRegex(catena.InputError, "quot"):
            catena.check(catena.load(PENDULUM).set("dynamics.step", "0.01"))
        with self.assertRaisesRegex(catena.InputError, r"a set cannot be a value of a scene \(dynamics.step\)"):
            catena.Model(units="si").set("dynamics.step", {0.1})
        for use in (catena.Simulation, catena.solve, catena.check, catena.load):
            with self.assertRaisesRegex(catena.InputError, "None is not a scene"):
                use(None)
        with self.assertRaisesRegex(catena.InputError, r"the key 5 is not a string"):
            catena.Model(units="si").set(5, 1)
        with self.assertRaisesRegex(catena.InputError, r"the name .* is not a string"):
            catena.Model(units="si").add(PENDULUM["chains"][0]["bodies"])
        with self.assertRaisesRegex(catena.InputError, "no such file"):
            catena.load("nowhere.yaml")
        with self.assertRaisesRegex(catena.InputError, "cannot be added"):
            catena.load(scene("pendulum.yaml")).add("more")
        with self.assertRaisesRegex(catena.InputError, "no dynamics section"):
            catena.Simulation({key: value for key, value in PENDULUM.items() if key != "dynamics"})
        stiff = catena.Model(PENDULUM)
        for body in range(2):
            stiff.set(f"chains[0].bodies[{body}].joint.stiffness", 1e9)
        with self.assertRaisesRegex(catena.InputError, "dynamics.step"):
            catena.check(stiff)
        if self.program:
            pathlib.Path("wrong.yaml").write_text(catena.Model(wrong).text, encoding="utf-8")
            with self.assertRaises(catena.InputError) as caught:
                catena.check("wrong.yaml")
            done = self.run_program("check", "wrong.yaml")
            self.assertEqual((done.returncode, done.stderr.strip()), (2, f"catena: {caught.exception}"))

    def test_notes_are_returned_and_warned_of(self):
        beads = [{"mass": 1, "position": [0, 0, 0]}, {"mass": 1, "position": [1, 0, 0], "joint": {"type": "link", "length": 1.05}}]
        noted = catena.Model(units="si").add("far", bodies=beads)
        notes = catena.check(noted)
        self.assertEqual(len(notes), 1)
        self.assertIn("were moved so that links have their lengths", notes[0])
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            catena.solve(noted)
        self.assertEqual([str(each.message) for each in said if each.category is catena.Note], notes)
        self.assertEqual(said[0].filename, __file__)


class Solutions(Case):
    def test_joint_forces_obey_newtons_law(self):
        found = catena.solve(PENDULUM)
        force = sum(2 * (a[2] + 9.81) for a in found.accelerations)
        self.assertAlmostEqual(found.joint_forces[0][2], force, delta=1e-11)
        self.assertTrue(found.valid)
        self.assertLessEqual(found.residual, found.residual_bound)
        self.assertLessEqual(found.error, found.error_bound)
        self.assertEqual(found.of_joint(1).shape, (1,))
        with self.assertRaises(IndexError):
            found.of_joint(2)

    def test_solutions_have_the_bits_of_the_program(self):
        if not self.program:
            self.skipTest("no program")
        for name in ("mixed-joints.yaml", "pendulum.yaml", "ring.yaml"):
            done = self.run_program("solve", scene(name), "--accelerations", "program.csv", "--set", "solver.backend=segments")
            self.assertEqual(done.returncode, 0, done.stderr)
            found = catena.solve(catena.load(scene(name)).set("solver.backend", "segments"))
            with open("program.csv", encoding="utf-8", newline="") as file:
                rows = [row for row in csv.DictReader(file) if row["joint"] != "tip"]
            for body, row in enumerate(rows[:len(found.accelerations)]):
                numbers = [float(row[f"acceleration_{i}"]) for i in range(1, 7) if row[f"acceleration_{i}"]]
                self.assert_same(found.of_joint(body), numbers)
                wrench = [float(row[f"joint_force_{i}"]) for i in range(1, 7)]
                self.assert_same(np.concatenate([found.joint_torques[body], found.joint_forces[body]]), wrench)

    def test_arrays_outlive_their_solution_and_are_read_only(self):
        kept = catena.solve(PENDULUM).joint_forces
        copy = kept.copy()
        gc.collect()
        for _ in range(20):
            catena.solve(PENDULUM)
        self.assert_same(kept, copy)
        with self.assertRaises(ValueError):
            kept[0] = 0

    def test_an_own_force_enters(self):
        still = {key: value for key, value in PENDULUM.items() if key != "forces"}
        weight = catena.solve(still, lambda x, q: (None, np.tile([0, 0, -2 * 9.81], (2, 1))))
        np.testing.assert_allclose(weight.accelerations, catena.solve(PENDULUM).accelerations, rtol=1e-12, atol=1e-12)


if __name__ == "__main__":
    package.main()
