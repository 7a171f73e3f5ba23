#!/usr/bin/env python3
"""What a build says where something is missing: all needed packages, a line each, and after a failed `pip install` what to install.

usage: build_test.py CMAKE"""
import os
import subprocess
import sys
import tempfile
import unittest

try:
    import tomllib
except ModuleNotFoundError:  # before Python 3.11
    tomllib = None

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CMAKE = "cmake"


class Builds(unittest.TestCase):
    def test_missing_packages_are_named_together(self):
        with tempfile.TemporaryDirectory(prefix=f"catena-build-{os.getpid()}-") as folder:
            absent = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ("Eigen3", "fmt")]
            done = subprocess.run([CMAKE, "-S", ROOT, "-B", folder, *absent], capture_output=True, text=True, check=False)
        self.assertNotEqual(done.returncode, 0)
        lines = [line.strip() for line in done.stderr.splitlines() if "was not found and is needed" in line]
        self.assertEqual([line.split(" (")[0] for line in lines],
                         ["Eigen3 was not found and is needed: install it", "fmt was not found and is needed: install it"])
        self.assertIn("apt-get install libeigen3-dev) or name its folder in CMAKE_PREFIX_PATH", lines[0])

    @unittest.skipIf(tomllib is None, "no tomllib")
    def test_a_failed_installation_names_what_it_needs(self):
        with open(os.path.join(ROOT, "src", "python", "pyproject.toml"), "rb") as file:
            said = tomllib.load(file)["tool"]["scikit-build"]["messages"]["after-failure"]
        with open(os.path.join(ROOT, "src", "cmake", "CatenaPackages.cmake"), encoding="utf-8") as file:
            needed = [line.split("(")[1].split()[1].rstrip(")") for line in file if line.startswith("catena_needed_package(")]
        self.assertEqual(len(needed), 4)
        for package in ["g++", "python3-dev", *needed]:
            self.assertIn(package, said)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        CMAKE = sys.argv.pop(1)
    unittest.main()
