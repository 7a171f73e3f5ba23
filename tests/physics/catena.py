"""Runs the program and reads what it writes: shared by the physics checks of this folder."""
import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))


def arguments(description, **defaults):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--catena", default=os.path.join(ROOT, "build", "release", "catena"), help="the program")
    parser.add_argument("--keep", metavar="DIR", help="keep the runs' folders here")
    parser.add_argument("--quick", action="store_true", help="a short version with looser statistics, for every test run")
    for name, value in defaults.items():
        parser.add_argument("--" + name.replace("_", "-"), type=type(value), default=value)
    return parser.parse_args()


class Runs:
    """Folders of runs, removed at the end unless they are to be kept."""

    def __init__(self, options):
        self.program = options.catena
        self.kept = options.keep
        self.folder = options.keep or tempfile.mkdtemp(prefix="catena-physics-")
        os.makedirs(self.folder, exist_ok=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if not self.kept:
            shutil.rmtree(self.folder, ignore_errors=True)

    def run(self, name, scene, settings):
        """Runs a scene with `key=value` settings; returns the run's folder."""
        folder = os.path.join(self.folder, name)
        command = ["run", scene, "--output", folder, "--overwrite", "--quiet"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        self.call(command)
        return folder

    def write(self, name, scene):
        """A scene as a file: JSON is YAML."""
        path = os.path.join(self.folder, name + ".yaml")
        with open(path, "w") as file:
            json.dump(scene, file)
        return path

    def solve(self, name, scene):
        """What `catena solve` writes of a scene given as a dictionary."""
        return json.loads(self.call(["solve", self.write(name, scene), "--repeat", "1", "--json", "-"]))

    def call(self, words):
        done = subprocess.run([self.program] + words, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join([self.program] + words)}\nended with status {done.returncode}: {done.stderr.strip() or done.stdout.strip()}")
        return done.stdout


def columns(folder):
    """observables.csv as {name without unit: array}."""
    with open(os.path.join(folder, "observables.csv")) as file:
        rows = list(csv.reader(file))
    names = [name.split(" [")[0] for name in rows[0]]
    values = np.array(rows[1:], dtype=float)
    return dict(zip(names, values.T))


def blocked_error(values):
    """Standard error of the mean of correlated numbers: blocks doubled until it stops growing (Flyvbjerg & Petersen 1989)."""
    values = np.asarray(values, dtype=float)
    worst = 0.0
    while len(values) >= 32:
        worst = max(worst, values.std(ddof=1) / np.sqrt(len(values)))
        even = len(values) // 2 * 2
        values = 0.5 * (values[0:even:2] + values[1:even:2])
    return worst


def verdict(name, good, text):
    print(f"{'passed' if good else 'FAILED'}  {name}: {text}", flush=True)
    return good
