#!/usr/bin/env python3
"""Which extension module the package loads: with the OpenMM of the build, another one, none; on a processor of another kind; under mpirun."""
import inspect
import os
import pathlib
import re
import subprocess
import sys
import typing
import unittest

import package  # first: it leaves where the package is not there
import catena
from catena import _built, _library
from package import PENDULUM, Case

USE = f"""
import catena
simulation = catena.Simulation({PENDULUM!r})
simulation.step(5)
print(catena.has_openmm, simulation.steps)
"""
FORCES = """
import catena
peptide = {"chains": [{"sequence": "GSGS", "model": "calvados2"}], "forces": {"openmm": {"builder": "calvados2"}},
           "dynamics": {"integrator": "g-baoab", "step": 0.01}}
try:
    catena.Simulation(peptide).step(2)
    print("computed")
except catena.InputError as error:
    print(error)
"""


def fake_openmm(version, library=None):
    """A package openmm in the working folder, whose library is another file; returns its folder."""
    folder = pathlib.Path(f"fake-{version}")
    (folder / "openmm").mkdir(parents=True)
    (folder / "openmm" / "__init__.py").write_text("raise RuntimeError('not to be imported')", encoding="utf-8")
    (folder / "openmm" / "version.py").write_text(f"openmm_library_path = {str(library or folder.absolute())!r}\n", encoding="utf-8")
    return folder


class Libraries(Case):
    def run_python(self, program, first=None, **variables):
        path = os.pathsep.join(([str(first.absolute())] if first else []) + [os.environ.get("PYTHONPATH", "")])
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMI", "SLURM_", "MV2_"))}
        environment.update({"PYTHONPATH": path, **variables})
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False, env=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip(), done.stderr

    @unittest.skipUnless(_built.OPENMM, "built without OpenMM")
    def test_without_openmm_the_solver_works_and_forces_are_refused(self):
        program = "import importlib.util as u\nfound = u.find_spec\nu.find_spec = lambda name, *rest: None if name == 'openmm' else found(name, *rest)\n"
        if _built.OPENMM_FOLDER:
            self.skipTest("OpenMM is the system's")
        said, warned = self.run_python(program + USE)
        self.assertEqual((said, warned), ("False 5", ""))
        said, _ = self.run_python(program + FORCES)
        series = _library._series(_built.OPENMM)
        self.assertTrue(said.startswith(f"OpenMM {series} was not found (scene in memory: forces.openmm): install it "), said)
        self.assertIn(f"pip install 'openmm=={series}.*'", said)

    @unittest.skipUnless(_built.OPENMM, "built without OpenMM")
    def test_with_the_openmm_of_the_build_its_forces_are_there(self):
        self.assertTrue(catena.has_openmm)
        said, warned = self.run_python(FORCES)
        self.assertEqual((said, warned), ("computed", ""))

    @unittest.skipUnless(_built.OPENMM, "built without OpenMM")
    def test_another_openmm_is_named_and_left_out(self):
        source = pathlib.Path("old.c")
        source.write_text('char const* OpenMM_Platform_getOpenMMVersion(void) { return "7.7"; }\n', encoding="utf-8")
        folder = fake_openmm("7.7")
        made = subprocess.run(["cc", "-shared", "-fPIC", "-o", str(folder / "libOpenMM.so"), str(source)], check=False)
        if made.returncode != 0:
            self.skipTest("no C compiler")
        said, warned = self.run_python(USE, folder)
        self.assertEqual(said, "False 5")
        self.assertRegex(warned, rf"Note: catena was built with OpenMM {re.escape(_built.OPENMM)}, and 7.7 is installed \(.*\): OpenMM's forces are left out")

    @unittest.skipUnless(_built.OPENMM, "built without OpenMM")
    def test_a_library_that_cannot_be_loaded_is_named(self):
        for version, content in (("none", None), ("damaged", b"no library")):
            folder = fake_openmm(version)
            if content:
                (folder / "libOpenMM.so").write_bytes(content)
            said, warned = self.run_python(USE, folder)
            self.assertEqual(said, "False 5")
            self.assertRegex(warned, r"OpenMM's library cannot be loaded \(.*libOpenMM.so.*\): OpenMM's forces are left out; install openmm \d")

    @unittest.skipUnless(_built.ARCHITECTURE == "x86-64-v3", "another instruction set")
    def test_a_processor_without_the_instructions_is_refused(self):
        pathlib.Path("old").write_text("processor : 0\nflags : fpu sse2 avx\n", encoding="utf-8")
        with self.assertRaisesRegex(ImportError, r"lacks instructions .*\(avx2, bmi1, bmi2, f16c, fma, movbe\): compile catena on this machine"):
            _library._require_processor("old")
        _library._require_processor()
        _library._require_processor("no such file")

    def test_ranks_of_mpirun_are_noted_once(self):
        twice = USE + f"catena.solve({PENDULUM!r}); catena.Simulation({PENDULUM!r})\n"
        _, warned = self.run_python(twice, OMPI_COMM_WORLD_RANK="0", OMPI_COMM_WORLD_SIZE="4")
        self.assertEqual(warned.count("4 processes were started (OMPI_COMM_WORLD_SIZE=4)"), 1)
        for variables in ({"OMPI_COMM_WORLD_RANK": "1", "OMPI_COMM_WORLD_SIZE": "4"}, {"OMPI_COMM_WORLD_RANK": "0", "OMPI_COMM_WORLD_SIZE": "1"}, {}):
            self.assertEqual(self.run_python(twice, **variables)[1], "")


class Documentation(Case):
    def test_everything_public_has_a_docstring_and_types(self):
        seen = 0
        for module in (catena, catena.analysis, catena.plot):
            for name in getattr(module, "__all__", [each for each in vars(module) if not each.startswith("_")]):
                thing = getattr(module, name)
                if not getattr(thing, "__module__", "").startswith("catena"):
                    continue
                self.assertTrue(inspect.getdoc(thing), name)
                for member, value in vars(thing).items() if inspect.isclass(thing) else [(name, thing)]:
                    function = value.fget if isinstance(value, property) else value
                    if member.startswith("_") or not inspect.isfunction(function):
                        continue
                    seen += 1
                    self.assertTrue(inspect.getdoc(function), f"{name}.{member}")
                    self.assertIn("return", function.__annotations__, f"{name}.{member}")
        self.assertGreater(seen, 60)

    def test_arrays_have_the_shapes_of_their_docstrings(self):
        simulation = catena.Simulation(PENDULUM)
        record = catena.Record(simulation)
        simulation.step(3)
        sizes = {"n_bodies": 2, "n_frames": 3, "n_sites": 2}
        seen = 0
        for thing in (simulation.state, record):
            for name, value in vars(type(thing)).items():
                shape = re.search(r"\((n_\w+,[^)]*)\)", inspect.getdoc(value) or "") if isinstance(value, property) else None
                if shape:
                    seen += 1
                    wanted = tuple(sizes.get(part, None) or int(part) for part in shape.group(1).replace(" ", "").split(",") if part)
                    self.assertEqual(getattr(thing, name).shape, wanted, name)
        self.assertGreaterEqual(seen, 14)

    def test_the_stub_names_what_the_module_has(self):
        folder = pathlib.Path(catena.__file__).parent
        self.assertTrue((folder / "py.typed").is_file())
        stub = (folder / "_core.pyi").read_text(encoding="utf-8")
        for name in vars(catena._core):
            if not name.startswith("_"):
                self.assertRegex(stub, rf"(?m)^(class|def) {name}\b|^{name}: ", name)
        self.assertTrue(typing.get_type_hints(catena.Record.stop))


if __name__ == "__main__":
    package.main()
