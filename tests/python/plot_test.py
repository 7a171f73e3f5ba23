#!/usr/bin/env python3
"""jobs/plot.py on the synthetic runs below FOLDER: pictures where there is something to see, one line where there is not.

Exit status 0: all as it should be; 1: not; 77: skipped, a package is missing."""
import os
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py
    import matplotlib.image
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install h5py matplotlib numpy)")
    sys.exit(77)

PLOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "jobs", "plot.py")


def check(condition, message):
    if not condition:
        raise SystemExit(f"FAILED: {message}")


def plot(*arguments):
    return subprocess.run([sys.executable, PLOT, *arguments], capture_output=True, text=True, check=False)


def check_picture(run, output):
    done = plot(run, "--output", output)
    check(done.returncode == 0 and done.stdout == output + "\n", f"{run}: {done.stdout}{done.stderr}")
    picture = matplotlib.image.imread(output)
    check(picture.shape[0] > 800 and picture.shape[1] > 1500, f"{run}: the picture has {picture.shape}")
    half = picture.shape[1] // 2
    for name, part in (("conformation", picture[150:, :half - 80]), ("observables", picture[150:, half + 80:])):
        check((part[..., :3].std(axis=2) > 0.05).mean() > 0.002, f"{run}: nothing coloured where the {name} should be")


def check_refusal(message, *arguments):
    done = plot(*arguments)
    check(done.returncode == 2 and done.stdout == "", f"{arguments}: status {done.returncode}")
    check(done.stderr.startswith("plot.py: ") and done.stderr.count("\n") == 1, f"not one line: {done.stderr}")
    check(message in done.stderr, f"'{message}' is not in: {done.stderr}")


def check_refusals(runs, scratch):
    check_refusal("no such folder (nowhere)", "nowhere")
    broken = os.path.join(scratch, "broken")
    os.makedirs(broken)
    table, trajectory = os.path.join(broken, "observables.csv"), os.path.join(broken, "trajectory.h5md")
    check_refusal(f"no such file ({table})", broken)
    with open(table, "w", encoding="utf-8") as file:
        file.write("step,time [ps],a [nm]\n")
    check_refusal(f"no records ({table})", broken)
    with open(table, "a", encoding="utf-8") as file:
        file.write("0,0,1\n1,0.1\n")
    check_refusal(f"not a table of observables ({table})", broken)
    shutil.copy(os.path.join(runs, "synthetic-beads", "observables.csv"), table)
    check_refusal(f"no such file ({trajectory})", broken)
    with open(trajectory, "w", encoding="utf-8") as file:
        file.write("no HDF5 at all")
    check_refusal(f"not a trajectory of Catena ({trajectory})", broken)
    shutil.copy(os.path.join(runs, "synthetic-beads", "trajectory.h5md"), trajectory)
    check_refusal("the picture cannot be written (", broken, "--output", os.path.join(scratch, "missing", "picture.png"))
    with h5py.File(trajectory, "r+") as file:
        file["particles/trajectory/position/value"].resize(0, axis=0)
    check_refusal(f"no frames ({trajectory})", broken)


def main():
    runs = sys.argv[1]
    check("example:" in plot("--help").stdout, "--help without an example")
    with tempfile.TemporaryDirectory() as scratch:
        for kind in ("beads", "bodies", "si"):
            check_picture(os.path.join(runs, f"synthetic-{kind}"), os.path.join(scratch, f"{kind}.png"))
        check_refusals(runs, scratch)
    print("three pictures and eight refusals are as they should be")


if __name__ == "__main__":
    main()
