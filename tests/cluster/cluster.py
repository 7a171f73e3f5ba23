"""Runs of the program that are disturbed on purpose, and the comparison with one that was not: shared by the checks of this folder."""
import argparse
import glob
import os
import shutil
import subprocess
import sys
import tempfile
import time

try:
    import h5py
    import numpy as np
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install h5py numpy)")
    sys.exit(77)

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
# Beads and bodies, each chain in pieces on several ranks; noise, projections and a table.
SCENE = """\
title: beads and bodies, to be disturbed
chains:
  - {name: beads, velocities: thermal, generator: {freely_jointed: {beads: 600, length: 0.38}}}
  - {name: bodies, base: free, velocities: thermal, generator: {random: {bodies: 120, joint: spherical, seed: 1}}}
dynamics: {integrator: g-baoab, step: 0.002, steps: 1000, friction: 1, seed: 5}
output: {every: 7, checkpoint_every: 10, velocities: true}
"""


def arguments(description, **defaults):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--catena", default=os.path.join(ROOT, "build", "release", "catena"), help="the program")
    parser.add_argument("--hdf5", default="", help="CATENA_HDF5 of the runs: root or collective")
    parser.add_argument("--mpirun", default="mpirun,--oversubscribe,--bind-to,none", help="the launcher and its options, parted by commas")
    for name, value in defaults.items():
        parser.add_argument("--" + name.replace("_", "-"), type=type(value), default=value)
    return parser.parse_args()


def verdict(name, good, text):
    print(f"{'passed' if good else 'FAILED'}  {name}: {text}", flush=True)
    return good


class Runs:
    """A folder with a scene and its runs, removed at the end."""

    def __init__(self, options, scene=SCENE, settings=(), folder=""):
        self.program = options.catena
        self.launcher = [word for word in options.mpirun.split(",") if word and word != "-q"]  # its own words are looked for
        self.environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                            "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
                            "OMPI_MCA_odls_base_sigkill_timeout": "3",  # as jobs/common.sh does
                            "OMPI_MCA_mpi_yield_when_idle": "1"}  # more ranks than cores
        if options.hdf5:
            self.environment["CATENA_HDF5"] = options.hdf5
        self.settings = [word for setting in settings for word in ("--set", setting)]
        self.scene_text = scene
        self.within = folder or None

    def __enter__(self):
        self.folder = tempfile.mkdtemp(prefix="catena-cluster-", dir=self.within)
        self.scene = os.path.join(self.folder, "scene.yaml")
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(self.scene_text)
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder, ignore_errors=True)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def words(self, ranks, name, more=()):
        words = [self.program, "run", self.scene, "--quiet", *self.settings, "--output", self.path(name), *more]
        return ([*self.launcher, "-n", str(ranks)] if ranks > 1 else []) + words

    def start(self, ranks, name, more=()):
        return subprocess.Popen(self.words(ranks, name, more), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                env=self.environment)

    def run(self, ranks, name, more=()):
        """To its end; what it says and its status."""
        started = self.start(ranks, name, more)
        said = started.communicate()[0]
        return said, started.returncode

    def complete(self, ranks, name, more=()):
        said, status = self.run(ranks, name, more)
        if status != 0:
            sys.exit(f"FAILED: {' '.join(self.words(ranks, name, more))}\nended with status {status}: {said}")

    def wait_for_steps(self, started, name):
        """Until a run that was just started takes steps, or is over."""
        table, before = self.path(name, "observables.csv"), time.time()
        wait_for(lambda: started.poll() is not None or os.path.exists(table) and os.path.getmtime(table) > before, 120, "the first steps")

    def resume(self, ranks, name):
        """From the last checkpoint to the end; from the start where there was none yet."""
        checkpoint = self.path(name, "checkpoint.h5")
        self.complete(ranks, name, ["--restart", checkpoint] if os.path.exists(checkpoint) else ["--overwrite"])
        left = glob.glob(self.path(name, "*.writing"))
        if left:
            sys.exit(f"FAILED: drafts are left: {left}")

    def remove(self, name):
        shutil.rmtree(self.path(name), ignore_errors=True)

    def step_of(self, name):
        """Of the last checkpoint; None where there is none."""
        if not os.path.exists(self.path(name, "checkpoint.h5")):
            return None
        with h5py.File(self.path(name, "checkpoint.h5"), "r") as file:
            return int(file.attrs["step"])

    def difference(self, name, other):
        return difference_of_runs(self.path(name), self.path(other))


def datasets(file):
    found = {}
    file.visititems(lambda name, item: found.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None)
    return found


def difference_of_files(first, second):
    with h5py.File(first, "r") as one, h5py.File(second, "r") as two:
        left, right = datasets(one), datasets(two)
    if left.keys() != right.keys():
        return f"datasets {sorted(left.keys() ^ right.keys())}"
    for name, values in left.items():
        if np.asarray(values).tobytes() != np.asarray(right[name]).tobytes() and not same_objects(values, right[name]):
            return name
    return ""


def difference_of_runs(first, second):
    """The first thing in which two runs' states, trajectories or tables differ in a bit; empty where they are the same."""
    for file in ("trajectory.h5md", "checkpoint.h5"):
        found = difference_of_files(os.path.join(first, file), os.path.join(second, file))
        if found:
            return f"{file}: {found}"
    tables = []
    for folder in (first, second):
        with open(os.path.join(folder, "observables.csv"), "rb") as file:
            tables.append(file.read())
    return "" if tables[0] == tables[1] else "observables.csv"


def same_objects(left, right):
    """Texts of variable length are pointers in an array's bytes."""
    return np.asarray(left).dtype == object and np.array_equal(left, right)


def ranks_of(launcher, program):
    """Process ids of the program's ranks, in their order."""
    found = {}
    for folder in glob.glob("/proc/[0-9]*"):
        try:
            with open(folder + "/stat", encoding="utf-8") as file:
                parent = int(file.read().rsplit(")", 1)[1].split()[1])
            if parent != launcher or os.path.realpath(folder + "/exe") != os.path.realpath(program):
                continue
            with open(folder + "/environ", "rb") as file:
                variables = dict(entry.split(b"=", 1) for entry in file.read().split(b"\0") if b"=" in entry)
            found[int(variables[b"OMPI_COMM_WORLD_RANK"])] = int(os.path.basename(folder))
        except (OSError, KeyError, IndexError):
            continue  # it ended meanwhile, or is not a rank yet
    return [found[rank] for rank in sorted(found)]


def wait_for(condition, seconds, what):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            sys.exit(f"FAILED: {what} did not come within {seconds} s")
        time.sleep(0.01)
