#!/usr/bin/env python3
"""One picture of what `catena analyse` found: curves with their errors, and contact maps.

Reads the tables and maps.h5 of the folder that `catena analyse` wrote, and draws analysis.png there."""
import argparse
import csv
import os
import sys

INK, SOFT, GRID = "#1b2733", "#66778a", "#e7ecf1"
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#332288", "#882255"]
CURVES = {  # table: title, logarithmic axes
    "radius_distribution": ("Radius of gyration", False, False),
    "internal_distances": ("Internal distances", True, True),
    "bond_correlation": ("Bond correlation", False, False),
    "displacement": ("Mean squared displacement", True, True),
    "density": ("Density profile", False, False),
}
MOST_KINDS, MOST_MAPS = 8, 4


class UserError(Exception):
    """What is wrong, where, and what to do."""


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="example:\n  build/venv/bin/python jobs/plot_analysis.py asyn/analysis --output asyn.png")
    parser.add_argument("folder", metavar="FOLDER", help="folder of tables (catena analyse RUN --output FOLDER)")
    parser.add_argument("--output", metavar="FILE.png", help="where the picture goes (default: FOLDER/analysis.png)")
    return parser.parse_args()


def read_table(path):
    """Labels of both axes, and {kind of chains: (x, value, error)}; empty cells are NaN."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    curves = {}
    for row in rows[1:]:
        x, value, error = (float(cell) if cell else float("nan") for cell in row[1:4])
        curves.setdefault(row[0], []).append((x, value, error))
    return rows[0][1], rows[0][2], {kind: list(zip(*points)) for kind, points in curves.items()}


def read_maps(path):
    """(title, cutoff label, probabilities, sites a row) of the first maps in the file."""
    import h5py
    maps = []
    with h5py.File(path, "r") as file:
        if "contacts" not in file:
            return maps
        contacts = file["contacts"]
        label = f"{contacts['cutoff'][0]:g} {contacts.attrs['unit']}"
        for part in ("within", "between"):
            for name, group in contacts[part].items():
                if group["mean"].size > 1:
                    maps.append((f"Contacts {part} {name}", label, group["mean"][:], int(file.attrs["sites_a_row"])))
    return maps[:MOST_MAPS]


def draw_curves(axes, name, table):
    import numpy as np
    title, log_x, log_y = CURVES[name]
    x_label, y_label, curves = table
    for number, (kind, points) in enumerate(list(curves.items())[:MOST_KINDS]):
        x, value, error = (np.array(part) for part in points)
        colour = COLOURS[number % len(COLOURS)]
        axes.plot(x, value, drawstyle="steps-mid" if name == "radius_distribution" else "default", color=colour, linewidth=1.3, label=kind)
        known = np.isfinite(error)
        axes.fill_between(x[known], (value - error)[known], (value + error)[known], color=colour, alpha=0.25, linewidth=0)
    if log_x and any(max(points[0]) > 0 for points in curves.values()):
        axes.set_xscale("log")
    if log_y and any(max(points[1]) > 0 for points in curves.values()):
        axes.set_yscale("log")
    axes.set_title(title, fontsize=11, color=INK)
    axes.set_xlabel(x_label.replace("_", " "), fontsize=9, color=SOFT)
    axes.set_ylabel(y_label.replace("value [", "").rstrip("]").replace("value", "cosine"), fontsize=9, color=SOFT)
    axes.grid(True, color=GRID)
    axes.set_axisbelow(True)
    axes.tick_params(colors=SOFT, labelsize=8)
    if len(curves) > 1:
        axes.legend(fontsize=7, frameon=False)


def draw_map(figure, axes, title, label, probability, sites):
    import numpy as np
    from matplotlib.colors import LogNorm
    shown = np.where(probability > 0, probability, np.nan)
    norm = LogNorm(vmin=max(np.nanmin(shown), 1e-5), vmax=np.nanmax(shown)) if np.isfinite(shown).any() else None
    image = axes.imshow(shown, origin="lower", cmap="viridis", norm=norm, aspect="auto",
                        extent=[0.5, sites * probability.shape[1] + 0.5, 0.5, sites * probability.shape[0] + 0.5])
    figure.colorbar(image, ax=axes, fraction=0.05)
    axes.set_title(f"{title}, {label}", fontsize=10, color=INK)
    axes.set_xlabel("site", fontsize=9, color=SOFT)
    axes.tick_params(colors=SOFT, labelsize=8)


def draw_picture(folder, output):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    tables = {name: read_table(os.path.join(folder, name + ".csv")) for name in CURVES if os.path.isfile(os.path.join(folder, name + ".csv"))}
    maps_file = os.path.join(folder, "maps.h5")
    maps = read_maps(maps_file) if os.path.isfile(maps_file) else []
    if not tables and not maps:
        raise UserError(f"no tables ({folder}): name a folder that catena analyse wrote")
    count = len(tables) + len(maps)
    columns = min(3, count)
    rows = -(-count // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(4.4 * columns, 3.4 * rows), squeeze=False, layout="constrained")
    panels = iter(grid.flat)
    for name, table in tables.items():
        draw_curves(next(panels), name, table)
    for one in maps:
        draw_map(figure, next(panels), *one)
    for axes in panels:
        axes.set_visible(False)
    try:
        figure.savefig(output, dpi=130)
    except (OSError, ValueError) as error:
        raise UserError(f"the picture cannot be written ({output}): {error}") from None


def main():
    arguments = parse_arguments()
    output = arguments.output or os.path.join(arguments.folder, "analysis.png")
    try:
        if not os.path.isdir(arguments.folder):
            raise UserError(f"no such folder ({arguments.folder}): name one that catena analyse wrote")
        draw_picture(arguments.folder, output)
    except ImportError as error:
        print(f"plot_analysis.py: a Python package is missing ({error.name}): pip install h5py matplotlib numpy", file=sys.stderr)
        return 2
    except UserError as error:
        print(f"plot_analysis.py: {error}", file=sys.stderr)
        return 2
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
