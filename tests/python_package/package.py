"""What the tests of the Python package share: the scenes of inputs, and a main program.

Every test program takes --catena PROGRAM, with which it compares results of the package bit for bit. It has exit status 77 (skipped) where
the package or NumPy cannot be imported, 0 if all is as it should be, 1 if not."""
import argparse
import os
import subprocess
import sys
import tempfile
import unittest
import warnings

try:
    import numpy as np

    import catena
except ModuleNotFoundError as missing:
    print(f"LEFT OUT: {missing}")
    sys.exit(77)

INPUTS = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "inputs")
PENDULUM = {
    "units": "si",
    "chains": [{"name": "rods", "base": "fixed", "bodies": [
        {"mass": 2, "com": [0.5, 0, 0], "inertia": [0.1, 0.5, 0.6], "joint": {"type": "revolute", "axis": [0, 1, 0], "q": 0.3}},
        {"mass": 2, "com": [0.5, 0, 0], "inertia": [0.1, 0.5, 0.6],
         "joint": {"type": "revolute", "axis": [0, 1, 0], "q": 0.3, "translation": [1, 0, 0]}}]}],
    "forces": {"gravity": [0, 0, -9.81]},
    "dynamics": {"integrator": "rk4", "step": 0.001},
}


def scene(name):
    return os.path.join(INPUTS, name)


def beads(count=12):
    """A bent chain of beads on links, without forces."""
    model = catena.Model(units="si")
    chain = [{"mass": 1 + 0.1 * k, "position": [0.8 * k, 0.6 * (k % 2), 0], "velocity": [0, 0, 0.1 if k % 3 == 0 else -0.1],
              **({"joint": {"type": "link"}} if k else {})} for k in range(count)]
    return model.add("beads", bodies=chain).set("dynamics", {"integrator": "rattle", "step": 0.01})


class Case(unittest.TestCase):
    program = None  # path of the program catena, if there is one

    def run_program(self, *words):
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        done = subprocess.run([self.program, *words], capture_output=True, text=True, check=False, env=environment)
        return done

    def assert_same(self, first, second):
        """Equal bit for bit."""
        first, second = np.asarray(first), np.asarray(second)
        self.assertEqual(first.shape, second.shape)
        self.assertTrue(np.array_equal(first, second), f"largest difference {np.max(np.abs(first - second)) if first.size else 0}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--catena", help="the program, for comparisons")
    options, rest = parser.parse_known_args()
    Case.program = options.catena
    warnings.simplefilter("ignore", catena.Note)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        unittest.main(module="__main__", argv=[sys.argv[0], *rest], warnings="ignore")
