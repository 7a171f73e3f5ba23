#!/usr/bin/env python3
"""One picture of a run: the chain's last conformation and the observables, or joint coordinates, against time.

Reads trajectory.h5md and observables.csv of the folder that `catena run` wrote. If its summary.json has means of observables with their
standard errors, the picture says them."""
import argparse
import json
import os
import sys

from conformation import INK, SOFT, draw_conformation

SURFACE, GRID = "#ffffff", "#e7ecf1"
LINES = ["#0b6bcb", "#e8743b", "#2b8f6b", "#8a4fbf"]
MOST_PANELS = 6
MOST_POINTS = 2000
PREFERRED = ["potential_energy", "total_energy", "temperature", "radius_of_gyration", "end_to_end_distance", "constraint_error"]


class UserError(Exception):
    """What is wrong, where, and what to do."""


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="examples:\n  build/venv/bin/python jobs/plot.py runs/alpha-synuclein --output picture.png\n"
               "  build/venv/bin/python jobs/plot.py crane --joints 1,4 --up z")
    parser.add_argument("folder", metavar="FOLDER", help="folder of a run (catena run ... --output FOLDER)")
    parser.add_argument("--output", metavar="FILE.png", help="where the picture goes (default: FOLDER/picture.png)")
    parser.add_argument("--joints", metavar="K,...", help="draw the coordinates of these joints, counted from 1 in the order of the scene's rigid "
                        "bodies, instead of the observables; the run needs `output: {coordinates: true}`")
    parser.add_argument("--up", choices="xyz", help="the ground axis that points up in the picture (default: the view that fills it best)")
    return parser.parse_args()


def import_packages():
    try:
        import h5py  # noqa: F401
        import matplotlib
        import numpy  # noqa: F401
    except ImportError as error:
        raise UserError(f"a Python package is missing ({error.name}): pip install h5py matplotlib numpy") from None
    matplotlib.use("Agg")


def require_file(folder, name):
    path = os.path.join(folder, name)
    if not os.path.isfile(path):
        raise UserError(f"no such file ({path}): name the folder of a run that has written it")
    return path


def read_observables(path):
    """Column names, and an array [records][columns]."""
    import numpy as np
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    names = lines[0].split(",")
    records = [line.split(",") for line in lines[1:-1]]  # what follows the last line end was cut short
    if names[0] != "step" or any(len(record) != len(names) for record in records):
        raise UserError(f"not a table of observables ({path}): every line needs the {len(names)} columns of the header")
    if not records:
        raise UserError(f"no records ({path}): let the run reach its first output")
    try:
        return names, np.array(records, dtype=float)
    except ValueError as error:
        raise UserError(f"not a number ({path}): {error}") from None


def read_trajectory(path):
    """The last frame and what the chains are."""
    import h5py
    try:
        with h5py.File(path, "r") as file:
            group = file["particles/trajectory"]
            position = group["position/value"]
            if position.shape[0] == 0:
                raise UserError(f"no frames ({path}): let the run reach its first output")
            chains = file["catena/chains"]
            return {
                "positions": position[-1],
                "time": float(group["position/time"][-1]),
                "time_unit": group["position/time"].attrs["unit"],
                "unit": position.attrs["unit"],
                "box": group["box/edges/value"][-1] if "edges" in group["box"] else None,
                "chains": list(zip(chains["first"][:], chains["count"][:], chains["ring"][:])),
                "parent": file["catena/parent"][:] if "catena/parent" in file else None,
                "title": title_of(file["catena"].attrs.get("title", b"")),
            }
    except (OSError, KeyError) as error:
        raise UserError(f"not a trajectory of Catena ({path}): {error}") from None


def read_joints(path):
    """Times, and joint coordinates [frame][joint][4] as q of the scene."""
    import h5py
    with h5py.File(path, "r") as file:
        if "catena/joint_position" not in file:
            raise UserError(f"no joint coordinates ({path}): run the scene with output.coordinates: true and an integrator in joint coordinates")
        return file["particles/trajectory/position/time"][:], file["catena/joint_position/value"][:]


def title_of(text):
    return text.decode("utf-8", "replace") if isinstance(text, bytes) else str(text)


def name_and_unit(column):
    name, _, unit = column.partition(" [")
    return name, unit.rstrip("]")


def chosen_columns(names, records):
    """Indices of the columns to draw: of those that change the preferred ones first, then others, in the order of the table."""
    columns = {name_and_unit(name)[0]: k for k, name in enumerate(names) if k >= 2}
    columns = {name: k for name, k in columns.items() if (records[:, k] != records[0, k]).any()} or columns
    wanted = [name for name in PREFERRED if name in columns] + [name for name in columns if name not in PREFERRED]
    return sorted(columns[name] for name in wanted[:MOST_PANELS])


def mean_text(of):
    """Mean and standard error as the terminal shows them: an error that may still grow is a lower limit."""
    least = "" if of.get("converged", True) else "at least "
    return f"{of['mean']:.4g} \u00b1 {least}{of['standard_error']:.2g}"


def read_means(folder):
    """(mean, text of mean and standard error) of each observable, as far as the run's summary has them."""
    try:
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            found = json.load(file).get("observables", {})
        return {name: (of["mean"], mean_text(of)) for name, of in found.items() if of["mean"] is not None and of["standard_error"]}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}  # of a run that has not ended, or of an earlier version


def observable_panels(names, records, means):
    """(label, values [record][1], mean) of each observable to draw; the mean is that of the label, without equilibration, or None."""
    columns = chosen_columns(names, records)
    if not columns:
        raise UserError("the table holds no observables (observables.csv): ask for some under output.observables")
    panels = []
    for column in columns:
        name, unit = name_and_unit(names[column])
        mean, text_of_mean = means.get(name, (None, ""))
        text = f"{text_of_mean} {unit}" if name in means else f"[{unit}]" if unit not in ("", "1") else ""
        panels.append((name.replace("_", " ").capitalize() + f"  {text}", records[:, column:column + 1], mean))
    return panels


def joint_panels(joints, asked):
    """(label, values [frame][coordinates that change], no mean) of each joint asked for."""
    panels = []
    for word in asked.split(",")[:MOST_PANELS]:
        if not word.isdigit() or not 1 <= int(word) <= joints.shape[1]:
            raise UserError(f"no such joint (--joints {word}): the run has joints 1 to {joints.shape[1]}")
        values = joints[:, int(word) - 1]
        changing = (values != values[0]).any(axis=0)
        panels.append((f"q of joint {word}", values[:, changing] if changing.any() else values[:, :1], None))
    return panels


def thinned(x, y):
    """At most MOST_POINTS points: of each run of points the lowest and the highest, so that no spike is lost."""
    import numpy as np
    if len(x) <= MOST_POINTS:
        return x, y
    kept = []
    for run in np.array_split(np.arange(len(x)), MOST_POINTS // 2):
        values = np.nan_to_num(y[run], nan=0.0)
        kept += sorted({run[np.argmin(values)], run[np.argmax(values)]})
    return x[kept], y[kept]


def draw_panel(axes, time, values, mean, label, time_label):
    """Draws the columns of `values` over time, and a line at `mean` or, without one, at the mean of all values; `time_label` is empty for all panels but the last."""
    import numpy as np
    from matplotlib.ticker import MaxNLocator
    finite = values[np.isfinite(values)]
    for column, colour in zip(values.T, LINES):
        axes.plot(*thinned(time, column), color=colour, linewidth=1.1)
    if finite.size > 1:
        if finite.min() > 0 and finite.max() > 1e3 * finite.min():
            axes.set_yscale("log")
        else:
            axes.yaxis.set_major_locator(MaxNLocator(4))
            axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 5), useMathText=True)
            axes.yaxis.get_offset_text().set(size=8.5, color=SOFT)
            if values.shape[1] == 1:
                axes.axhline(finite.mean() if mean is None else mean, color=SOFT, linewidth=0.9, linestyle=(0, (2, 3)))
    axes.annotate(label, (1, 1), xytext=(0, 5), xycoords="axes fraction", textcoords="offset points", ha="right", color=INK, fontsize=10.5)
    axes.grid(axis="y", color=GRID, linewidth=0.9)
    axes.set_axisbelow(True)
    axes.tick_params(colors=SOFT, labelsize=9, length=3, labelbottom=bool(time_label))
    axes.margins(x=0)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.spines["bottom"].set_color(SOFT if time_label else GRID)
    axes.set_xlabel(time_label, color=SOFT, fontsize=10)


def draw_picture(time, panels, trajectory, up):
    """Draws the figure; `time`: one number per record of the panels."""
    import matplotlib.pyplot as plt
    plt.rcParams.update({"font.family": "DejaVu Sans", "axes.facecolor": SURFACE, "figure.facecolor": SURFACE})
    figure = plt.figure(figsize=(13, max(6.4, 0.6 + 1.2 * len(panels))))
    grid = figure.add_gridspec(len(panels), 2, width_ratios=[1.12, 1], hspace=0.42, wspace=0.1, left=0.02, right=0.985, top=0.86, bottom=0.09)
    draw_conformation(figure.add_subplot(grid[:, 0]), trajectory, up)
    first = None
    for row, (label, values, mean) in enumerate(panels):
        axes = figure.add_subplot(grid[row, 1], sharex=first)
        first = first or axes
        draw_panel(axes, time, values, mean, label, f"time [{trajectory['time_unit']}]" if row == len(panels) - 1 else "")
    figure.text(0.028, 0.945, trajectory["title"] or "A run of Catena", fontsize=17, fontweight="bold", color=INK)
    sites, chains = len(trajectory["positions"]), len(trajectory["chains"])
    told = f"{chains} chains, " if chains > 1 else ""
    figure.text(0.028, 0.908, f"{told}{sites:,} sites, at {trajectory['time']:g} {trajectory['time_unit']}", fontsize=11, color=SOFT)
    return figure


def picture_of(arguments):
    """Reads the folder and draws its figure."""
    if not os.path.isdir(arguments.folder):
        raise UserError(f"no such folder ({arguments.folder}): name the folder of a run")
    names, records = read_observables(require_file(arguments.folder, "observables.csv"))
    path = require_file(arguments.folder, "trajectory.h5md")
    trajectory = read_trajectory(path)
    if arguments.joints:
        time, joints = read_joints(path)
        return draw_picture(time, joint_panels(joints, arguments.joints), trajectory, arguments.up)
    return draw_picture(records[:, 1], observable_panels(names, records, read_means(arguments.folder)), trajectory, arguments.up)


def save(figure, output):
    try:
        figure.savefig(output, dpi=150)
    except (OSError, ValueError) as error:
        raise UserError(f"the picture cannot be written ({output}): {error}") from None


def main():
    arguments = parse_arguments()
    try:
        import_packages()
        output = arguments.output or os.path.join(arguments.folder, "picture.png")
        save(picture_of(arguments), output)
    except UserError as error:
        print(f"plot.py: {error}", file=sys.stderr)
        return 2
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
