#!/usr/bin/env python3
"""The notebooks of inputs/notebooks: their cells run, find what they should, and the files hold no outputs."""
import contextlib
import glob
import io
import json
import os
import re
import unittest

import package  # first: it leaves where the package is not there
import catena
import numpy as np
from package import INPUTS, Case

FOLDER = os.path.join(INPUTS, "notebooks")
os.environ["MPLBACKEND"] = "Agg"
try:
    import matplotlib.pyplot
    import tqdm

    DRAWS = bool(matplotlib and tqdm)
except ModuleNotFoundError:
    DRAWS = False


def cells(name):
    with open(os.path.join(FOLDER, name + ".ipynb"), encoding="utf-8") as file:
        return json.load(file)["cells"]


@unittest.skipUnless(DRAWS, "no matplotlib or tqdm")
class Notebooks(Case):
    def run_notebook(self, name):
        """Runs the cells one after the other; returns what they printed, and their names."""
        names, said = {"__name__": "__main__"}, io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()):
            for number, cell in enumerate(cells(name)):
                if cell["cell_type"] == "code":
                    exec(compile("".join(cell["source"]), f"{name}.ipynb, cell {number + 1}", "exec"), names)
        matplotlib.pyplot.close("all")
        return said.getvalue(), names

    @unittest.skipUnless(catena.has_openmm, "no OpenMM")
    def test_the_disordered_protein_has_its_size(self):
        said, names = self.run_notebook("disordered-protein")
        self.assertIn("24 residues", said)
        size = names["size"]
        self.assertLess(abs(size.mean - 1.38), 4 * size.error + 0.1)
        self.assertEqual(len(size.values), 900)
        self.assertTrue(0.3 < names["found"]["scaling_exponent"].mean < 0.9)

    @unittest.skipUnless(catena.has_openmm, "no OpenMM")
    def test_the_condensate_is_dense_in_the_middle(self):
        said, names = self.run_notebook("condensate")
        profile = names["profile"]
        mass = np.trapezoid(profile.values, profile.x) if hasattr(np, "trapezoid") else np.trapz(profile.values, profile.x)
        self.assertAlmostEqual(mass / (12 * 13098 / 100 * 1.66054), 1, delta=0.02)  # mg/ml nm, of a cross-section of 100 nm^2
        self.assertTrue(200 < names["found"]["dense_concentration"].mean < 700)
        self.assertLess(names["found"]["dilute_concentration"].mean, 5)
        self.assertGreater(names["found"]["contacts_between"].mean, 1)

    def test_the_pendulum_is_solved_and_keeps_its_energy(self):
        said, names = self.run_notebook("pendulum")
        self.assertTrue(names["start"].valid)
        self.assertEqual(names["start"].joint_accelerations.shape, (100000,))
        self.assertLess(names["drift"], 1e-6)
        self.assertEqual(len(re.findall("links: ", said)), 3)

    def test_the_script_of_openmm_keeps_its_temperature(self):
        try:
            import catena.openmm  # noqa: F401
        except ImportError as missing:
            self.skipTest(str(missing))
        _, names = self.run_notebook("openmm-script")
        # 2,001 degrees of freedom: a standard deviation of 9.5 K of one value; values of a run are correlated.
        for _, temperature, error in (names["before"], names["after"]):
            self.assertLess(abs(temperature - 300), 4 * 9.5)
            self.assertLess(error, 2e-5)
        self.assertLess(names["after"][2], 1e-11)

    def test_they_are_plain_notebooks_without_outputs(self):
        names = sorted(os.path.basename(path)[:-6] for path in glob.glob(os.path.join(FOLDER, "*.ipynb")))
        self.assertEqual(len(names), 4)
        with open(os.path.join(INPUTS, "README.md"), encoding="utf-8") as file:
            page = file.read()
        for name in names:
            self.assertIn(f"notebooks/{name}.ipynb", page)
            for cell in cells(name):
                self.assertFalse(cell.get("outputs"), name)
                self.assertIsNone(cell.get("execution_count"), name)
                for link in re.findall(r"\]\(([^)]+)\)", "".join(cell["source"]) if cell["cell_type"] == "markdown" else ""):
                    self.assertTrue(link.startswith("https://") or os.path.isfile(os.path.join(FOLDER, link)), link)


if __name__ == "__main__":
    package.main()
