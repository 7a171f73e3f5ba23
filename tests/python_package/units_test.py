#!/usr/bin/env python3
"""Quantities of openmm.unit and pint as values of scenes."""
import unittest

import package  # first: it leaves where the package is not there
import catena
import numpy as np
from catena import _units
from package import PENDULUM, Case

try:
    from openmm import unit
except ModuleNotFoundError:
    unit = None
try:
    import pint
except ModuleNotFoundError:
    pint = None


class Quantities(Case):
    def check(self, make):
        """`make(number, unit)` gives a quantity; units have the names that both packages share."""
        model = catena.Model(units="md")
        for key, value, text in (("dynamics.step", make(10, "femtosecond"), "0.01"), ("dynamics.temperature", make(293, "kelvin"), "293"),
                                 ("dynamics.friction", make(10, "1/nanosecond"), "0.01"), ("box.periodic", make([100, 100, 300], "angstrom"), "[10"),
                                 ("chains[0].bodies[1].mass", make(2, "dalton"), "2")):
            model.set(key, value)
            self.assertAlmostEqual(float(model._changes[-1][1].strip("[").split(",")[0]), float(text.strip("[")), delta=1e-12, msg=key)
        si = catena.load(catena.Model(PENDULUM).text).set("dynamics.step", make(500, "nanosecond"))
        self.assertAlmostEqual(float(si._changes[0][1]), 5e-7, delta=1e-20)
        bodies = [dict(body, mass=make(2000, "gram"), com=make(np.array(body["com"]) * 100, "centimeter")) for body in PENDULUM["chains"][0]["bodies"]]
        changed = {**PENDULUM, "chains": [{**PENDULUM["chains"][0], "bodies": bodies}]}
        np.testing.assert_allclose(catena.solve(changed).accelerations, catena.solve(PENDULUM).accelerations, rtol=1e-12)
        with self.assertRaisesRegex(catena.InputError, r"does not have the unit of the key, time \(dynamics.step\)"):
            model.set("dynamics.step", make(10, "kelvin"))
        with self.assertRaisesRegex(catena.InputError, r"takes no unit \(dynamics.steps\)"):
            model.set("dynamics.steps", make(10, "femtosecond"))
        with self.assertRaisesRegex(catena.InputError, r"depends on other keys, .* \(chains\[0\].bodies\[1\].joint.stiffness\): give a plain number"):
            model.set("chains[0].bodies[1].joint.stiffness", make(10, "kilojoule"))

    @unittest.skipIf(unit is None, "no openmm")
    def test_those_of_openmm_get_the_unit_of_the_key(self):
        self.check(lambda number, name: number / unit.nanosecond if name == "1/nanosecond" else unit.Quantity(number, getattr(unit, name)))

    @unittest.skipIf(pint is None, "no pint")
    def test_those_of_pint_get_the_unit_of_the_key(self):
        registry = pint.UnitRegistry()
        self.check(lambda number, name: registry.Quantity(number, name))

    def test_units_in_words_are_read(self):
        self.assertEqual(_units._powers("mass length^2 / time", True), [("kilogram", 1), ("meter", 2), ("second", -1)])
        self.assertEqual(_units._powers("energy / length", False), [("kilojoule", 1), ("mole", -1), ("nanometer", -1)])
        self.assertEqual(_units._powers("mol/l", False), [("mole", 1), ("liter", -1)])
        self.assertIsNone(_units._powers("as of a joint", False))

    def test_every_declared_unit_is_known_or_depends_on_other_keys(self):
        words = {each for units in _units._units_of_keys().values() for each in units}
        unknown = {each for each in words if _units._powers(each, False) is None}
        for each in unknown:
            self.assertRegex(each, r"^steps$|;| or |that of|as of")
        self.assertGreater(len(words - unknown), 12)
        for key in ("dynamics.step", "dynamics.temperature", "box.periodic", "forces.gravity", "chains[].bodies[].mass", "chains[].bodies[].position"):
            self.assertNotIn(_units._units_of_keys()[key][0], unknown, key)


if __name__ == "__main__":
    package.main()
