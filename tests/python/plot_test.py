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


def check_picture(run, output, *options):
    done = plot(run, "--output", output, *options)
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


def check_means(runs, scratch):
    """A summary's means and standard errors stand in the labels; without a summary the unit alone does."""
    sys.path.insert(0, os.path.dirname(PLOT))
    import plot as module
    folder = os.path.join(scratch, "means")
    shutil.copytree(os.path.join(runs, "synthetic-beads"), folder)
    names, records = module.read_observables(os.path.join(folder, "observables.csv"))
    column = module.chosen_columns(names, records)[0]
    name, unit = module.name_and_unit(names[column])
    summary = os.path.join(folder, "summary.json")
    for text, said in (("{}", f"[{unit}]"), ("no JSON", f"[{unit}]"),
                       (f'{{"observables": {{"{name}": {{"mean": 2.71828, "standard_error": 0.0123}}}}}}', f"2.718 \u00b1 0.012 {unit}"),
                       (f'{{"observables": {{"{name}": {{"mean": 2.71828, "standard_error": 0.0123, "converged": false}}}}}}',
                        f"2.718 \u00b1 at least 0.012 {unit}"),
                       (f'{{"observables": {{"{name}": {{"mean": null, "standard_error": null}}}}}}', f"[{unit}]")):
        with open(summary, "w", encoding="utf-8") as file:
            file.write(text)
        panels = module.observable_panels(names, records, module.read_means(folder))
        labels = [label for label, _, _ in panels]
        check([mean for _, _, mean in panels if mean is not None] == ([2.71828] if "2.718" in said else []), f"the line is not at the mean of the label: {panels}")
        check(any(label.lower().startswith(name.replace("_", " ").lower()) and label.endswith(said) for label in labels), f"{said} is not in {labels}")


def check_joints(runs, scratch):
    """Joint coordinates are drawn where the trajectory has them, in the order asked for."""
    folder = os.path.join(scratch, "joints")
    shutil.copytree(os.path.join(runs, "synthetic-bodies"), folder)
    check_refusal("no joint coordinates (", folder, "--joints", "1")
    with h5py.File(os.path.join(folder, "trajectory.h5md"), "r+") as file:
        frames = file["particles/trajectory/position/value"].shape[0]
        angles = [[[0.1 * frame * joint, 0, 0, 0] for joint in range(3)] for frame in range(frames)]
        file.require_group("catena/joint_position")["value"] = angles
    check_picture(folder, os.path.join(scratch, "joints.png"), "--joints", "3,2", "--up", "z")
    check_refusal("no such joint (--joints 4): the run has joints 1 to 3", folder, "--joints", "1,4")
    import plot as module
    _, joints = module.read_joints(os.path.join(folder, "trajectory.h5md"))
    panels = module.joint_panels(joints, "3,1")
    check([label for label, *_ in panels] == ["q of joint 3", "q of joint 1"] and panels[0][1][-1] == 0.2 * (frames - 1), f"wrong panels: {panels}")


def main():
    runs = sys.argv[1]
    check("examples:" in plot("--help").stdout, "--help without an example")
    with tempfile.TemporaryDirectory() as scratch:
        for kind in ("beads", "bodies", "si"):
            check_picture(os.path.join(runs, f"synthetic-{kind}"), os.path.join(scratch, f"{kind}.png"))
        check_refusals(runs, scratch)
        check_means(runs, scratch)
        check_joints(runs, scratch)
    print("four pictures, ten refusals and the labels are as they should be")


if __name__ == "__main__":
    main()
