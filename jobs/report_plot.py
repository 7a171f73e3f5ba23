#!/usr/bin/env python3
"""Draws the solver error against run time that `catena report` found.

usage: report_plot.py REPORT.json PICTURE.png
One panel a scene: forward error (filled) and backward residual (open) against the median time of one evaluation, both axes logarithmic.
"""

import json
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import NullFormatter  # noqa: E402

COLOURS = {"serial": "#0072B2", "segments": "#D55E00", "openmp": "#009E73", "oracle": "#666666"}
MARKERS = {"projected": "o", "full": "s"}
FLOOR = 1e-17  # an error of zero still has a place


def decades(values):
    """The powers of ten around all values."""
    return 10.0 ** math.floor(math.log10(min(values)) - 0.05), 10.0 ** math.ceil(math.log10(max(values)) + 0.05)


def errors_of(study):
    errors = [study["oracle"]["forward_error"]]
    for point in study["points"]:
        errors += [point["forward_error"], point["residual"]]
    return [max(error, FLOOR) for error in errors if error is not None]


def draw_study(axes, study, limits):
    for point in study["points"]:
        time = point["seconds"]["median"]
        style = {"color": COLOURS[point["backend"]], "marker": MARKERS[point["handles"]], "markersize": 7, "linestyle": ""}
        if point["forward_error"] is not None:
            axes.plot(time, max(point["forward_error"], FLOOR), **style)
        if point["residual"] is not None:
            axes.plot(time, max(point["residual"], FLOOR), fillstyle="none", **style)
    oracle = study["oracle"]
    axes.plot(oracle["seconds"]["median"], max(oracle["forward_error"], FLOOR), "*", color=COLOURS["oracle"], markersize=9)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(decades([point["seconds"]["median"] for point in study["points"]] + [oracle["seconds"]["median"]]))
    axes.set_ylim(limits)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_formatter(NullFormatter())
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    condition = study["condition"]
    note = f", condition {condition:.0e}" if condition else ""
    axes.set_title(f"{study['kind']}, {study['bodies']:,} bodies{note}", fontsize=9)


def legend_entries():
    entries = [Line2D([], [], color=COLOURS[name], marker="o", linestyle="", label=name) for name in ("serial", "segments", "openmp")]
    entries += [Line2D([], [], color="black", marker=MARKERS[kind], linestyle="", label=f"{kind} handles") for kind in MARKERS]
    entries.append(Line2D([], [], color=COLOURS["oracle"], marker="*", linestyle="", label="articulated bodies (oracle)"))
    entries.append(Line2D([], [], color="black", marker="o", linestyle="", label="forward error"))
    entries.append(Line2D([], [], color="black", marker="o", fillstyle="none", linestyle="", label="backward residual"))
    return entries


def main(report_file, picture):
    with open(report_file, encoding="utf-8") as file:
        report = json.load(file)
    studies = report["studies"]
    columns = min(3, len(studies))
    rows = -(-len(studies) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(4.2 * columns, 3.2 * rows + 1.0), squeeze=False, layout="constrained")
    limits = decades([error for study in studies for error in errors_of(study)])
    for axes, study in zip(grid.flat, studies):
        draw_study(axes, study, limits)
    for axes in grid.flat[len(studies) :]:
        axes.set_visible(False)
    for axes in grid[-1]:
        axes.set_xlabel("median time of one evaluation / s", fontsize=9)
    for axes in grid[:, 0]:
        axes.set_ylabel("relative error", fontsize=9)
    hardware = report["hardware"]
    figure.suptitle(f"Solver error against run time\n{hardware['processor']}, {report['ranks']} rank(s)", fontsize=11)
    figure.legend(handles=legend_entries(), loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    figure.savefig(picture, dpi=150)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
