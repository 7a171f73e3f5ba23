#!/usr/bin/env python3
"""The programs of the package's page (src/python/README.md) run, one after the other, and print what they should."""
import contextlib
import importlib.util
import io
import os
import re
import unittest

import package  # first: it leaves where the package is not there
import catena
from package import INPUTS, Case

ROOT = os.path.dirname(INPUTS)


class Page(Case):
    def test_its_programs_run(self):
        with open(os.path.join(ROOT, "src", "python", "README.md"), encoding="utf-8") as file:
            programs = re.findall(r"```python\n(.*?)```", file.read(), re.S)
        self.assertGreaterEqual(len(programs), 4)
        names, said = {}, io.StringIO()
        os.symlink(INPUTS, "inputs")  # pictures are written beside it
        for program in programs:
            if "alpha-synuclein" in program and not (catena.has_openmm and importlib.util.find_spec("matplotlib")):
                continue
            with contextlib.redirect_stdout(said):
                exec(compile(program, "README.md", "exec"), names)
        self.assertIn("[ 10. -10.] [ 0.  0. 10.] True", said.getvalue())
        self.assertAlmostEqual(names["pulled"].total_energy, 5, delta=1e-6)

    def test_the_programs_of_the_page_on_openmm_run(self):
        if importlib.util.find_spec("catena._integrators") is None:
            self.skipTest("catena was built without PyPI's OpenMM")
        with open(os.path.join(ROOT, "src", "python", "openmm.md"), encoding="utf-8") as file:
            programs = re.findall(r"```python\n(.*?)```", file.read(), re.S)
        self.assertEqual(len(programs), 2)
        names, said = {}, io.StringIO()
        for program in programs:
            with contextlib.redirect_stdout(said):
                exec(compile(program, "openmm.md", "exec"), names)
        kinetic = float(said.getvalue().split()[0])
        self.assertAlmostEqual(kinetic / (0.5 * 2001 * 0.0083145 * 300), 1, delta=0.2)
        self.assertEqual(names["system"].getNumConstraints(), 999)


if __name__ == "__main__":
    package.main()
