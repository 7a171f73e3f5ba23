#!/usr/bin/env python3
"""Installs a wheel of the Python package into fresh virtual environments of the CPython that runs this, on a PATH without compilers, and uses it.

usage: wheel_trial.py --wheels FOLDER --openmm VERSION

Without openmm the solver works. With the version of the build, and another one of its series, alpha-synuclein takes 1,000 steps and its radius of
gyration is drawn. An older series is named in a warning, and nothing crashes. It needs PyPI. Exit status 1 if anything fails."""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile

INPUTS = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "inputs")
COMPILERS = ("cc", "c++", "gcc", "g++", "clang", "clang++", "cmake", "ninja", "make")
SOLVER = """
import numpy, catena
arm = {"units": "si", "chains": [{"base": "fixed", "bodies": [{"mass": 2, "com": [0.5, 0, 0], "inertia": [0.1, 0.5, 0.5],
       "joint": {"type": "revolute", "axis": [0, 1, 0]}}]}], "forces": {"gravity": [0, 0, -10]}, "dynamics": {"integrator": "rk4", "step": 1e-3}}
assert numpy.allclose(catena.solve(arm).joint_accelerations, [10.0])
simulation = catena.Simulation(arm)
simulation.step(100)
assert simulation.state.constraint_error < 1e-12
"""
WITHOUT = SOLVER + """
assert not catena.has_openmm
try:
    catena.Simulation(SCENE)
except catena.InputError as error:
    assert "OpenMM SERIES was not found" in str(error) and "pip install" in str(error), error
    print("says:", error)
else:
    raise AssertionError("forces of OpenMM without OpenMM")
"""
WITH = SOLVER + """
import openmm, os, time
assert catena.has_openmm
simulation = catena.Simulation(SCENE)
record = catena.Record(simulation, every=20)
begun = time.perf_counter()
simulation.step(1000)
size = catena.analysis.radius_of_gyration(record)
assert 1 < size.mean < 10 and len(record) == 50
catena.plot.radius_of_gyration(record).figure.savefig("rg.png")
assert os.path.getsize("rg.png") > 5000
print(f"alpha-synuclein, openmm {openmm.version.short_version}: 1,000 steps in {time.perf_counter() - begun:.1f} s, radius of gyration {size.mean:.2f} nm")
"""


class Environment:
    """A virtual environment whose programs see no compiler."""

    def __init__(self, folder):
        self.folder = folder
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        self.variables = {name: value for name, value in os.environ.items() if name.startswith(("PIP_", "SSL_", "OPENBLAS_", "OMP_"))}
        self.variables.update(PATH=os.path.join(folder, "bin"), HOME=folder, MPLBACKEND="Agg")
        for program in COMPILERS:
            assert shutil.which(program, path=self.variables["PATH"]) is None, program

    def install(self, *packages):
        self.call("-m", "pip", "install", "-q", "--disable-pip-version-check", "--only-binary", ":all:", *packages)

    def run(self, program):
        return self.call("-W", "always", "-c", program)

    def call(self, *words):
        python = os.path.join(self.folder, "bin", "python")
        done = subprocess.run([python, *words], capture_output=True, text=True, check=False, env=self.variables, cwd=self.folder)
        if done.returncode != 0:
            raise SystemExit(f"status {done.returncode}: {words[-1]}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr


def wheel_for(environment, wheels):
    """The wheel in `wheels` that pip chooses; PyPI is not asked, where another project may have the name."""
    chosen = os.path.join(environment.folder, "chosen")
    environment.call("-m", "pip", "download", "-q", "--disable-pip-version-check", "--no-index", "--no-deps", "--find-links", wheels, "-d", chosen, "catena")
    [name] = os.listdir(chosen)
    return os.path.join(chosen, name)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheels", required=True, metavar="FOLDER")
    parser.add_argument("--openmm", required=True, metavar="VERSION", help="OpenMM of the build, and the one beside it")
    parser.add_argument("--older", default="8.5.2", metavar="VERSION", help="one of an older series")
    options = parser.parse_args()
    older = options.older
    series = ".".join(options.openmm.split(".")[:2])
    scene = repr(os.path.join(INPUTS, "alpha-synuclein.yaml"))
    with tempfile.TemporaryDirectory(prefix=f"catena-wheel-{os.getpid()}-") as folder:
        environment = Environment(os.path.join(folder, "environment"))
        wheel = wheel_for(environment, os.path.abspath(options.wheels))
        environment.install(wheel, "matplotlib")
        python = f"CPython {sys.version_info.major}.{sys.version_info.minor}"
        print(f"wheel: {python} takes {os.path.basename(wheel)}, {os.path.getsize(wheel) / 2**20:.1f} MiB")
        print(f"wheel: {python} without openmm", environment.run(WITHOUT.replace("SCENE", scene).replace("SERIES", series)).strip())
        for version in dict.fromkeys((options.openmm, f"{series}.0")):
            environment.install(f"openmm=={version}")
            print(f"wheel: {python}", environment.run(WITH.replace("SCENE", scene)).strip())
        environment.install(f"openmm=={older}")
        said = environment.run(WITHOUT.replace("SCENE", scene).replace("SERIES", series))
        assert f"built with OpenMM {options.openmm}" in said and f"install openmm {series}" in said, said
        print(f"wheel: {python} with openmm {older}", said.strip())


if __name__ == "__main__":
    main()
