#!/usr/bin/env python3
"""Draws what `catena report` found, a picture for each part of the report: solver.png, integrators.png, forces.png, stability.png.

usage: report_plot.py REPORT.json FOLDER
Both axes of every panel are logarithmic.
"""

import json
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402

COLOURS = {"serial": "#0072B2", "segments": "#D55E00", "openmp": "#009E73", "cuda": "#CC79A7", "cuda-levels": "#E69F00",
           "rk4": "#0072B2", "velocity-verlet": "#D55E00", "rattle": "#009E73", "g-baoab": "#CC79A7",
           "dormand-prince": "#56B4E9", "staggered": "#E69F00", "baoab": "#999933", "implicit-baoab": "#332288", "implicit-g-baoab": "#882255",
           "oracle": "#666666", "simbody": "#56B4E9", "pinocchio, local": "#332288", "pinocchio, world": "#882255"}
SPARE_COLOURS = ["#44AA99", "#AA4499", "#117733", "#661100", "#6699CC"]  # of names that are not among them
MARKERS = {"projected": "o", "full": "s", "articulated": "^"}
LINE_MARKERS = ["o", "s", "^", "D", "v", "P", "X"]  # with the colours no two lines look alike
NARROWEST = 6.4  # inches: a legend of two columns fits in
FLOOR = 1e-17  # an error of zero still has a place


def colour(name):
    if name not in COLOURS:
        COLOURS[name] = SPARE_COLOURS[len(COLOURS) % len(SPARE_COLOURS)]
    return COLOURS[name]


def decades(values):
    """The powers of ten around all values that there are."""
    values = [value for value in values if value is not None and value > 0] or [1.0]
    return 10.0 ** math.floor(math.log10(min(values)) - 0.05), 10.0 ** math.ceil(math.log10(max(values)) + 0.05)


def shown(error):
    """A place for every error; what was not finite is null in the report, and has none."""
    return math.nan if error is None else max(error, FLOOR)


def panels(count, title, x_label, y_label):
    columns = min(3, count)
    rows = -(-count // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(max(NARROWEST, 4.2 * columns), 3.2 * rows + 1.4), squeeze=False, layout="constrained")
    for axes in grid.flat[count:]:
        axes.set_visible(False)
    for axes in grid.flat[:count]:
        axes.set_xscale("log")
        axes.set_yscale("log")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_minor_formatter(NullFormatter())
        axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
        axes.set_axisbelow(True)
    for axes in grid[-1]:
        axes.set_xlabel(x_label, fontsize=9)
    for axes in grid[:, 0]:
        axes.set_ylabel(y_label, fontsize=9)
    figure.suptitle(title, fontsize=11)
    return figure, list(grid.flat[:count])


def label_times(axes, times):
    """Limits at powers of ten around the times, with labels between them where there are few powers."""
    low, high = decades(times)
    axes.set_xlim(low, high)
    if high / low <= 100:
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def add_legend(figure, entries):
    """Below the panels, in as many columns as the figure is wide."""
    columns = max(2, int(figure.get_figwidth() / 3.0))
    figure.legend(handles=entries, loc="outside lower center", ncols=columns, fontsize=8, frameon=False)


def entry(name, marker="o", **style):
    return Line2D([], [], color=style.pop("color", COLOURS.get(name, "black")), marker=marker, linestyle=style.pop("linestyle", ""), label=name, **style)


def solver(report, hardware):
    """Forward error (filled) and backward residual (open) against the median time of one evaluation."""
    studies = report["studies"]
    figure, all_axes = panels(len(studies), f"Solver error against run time\n{hardware}", "median time of one evaluation / s", "relative error")
    used = []
    errors = [point[key] for study in studies for point in study["points"] + [study["oracle"]] for key in ("forward_error", "residual")
              if point.get(key) is not None]
    for axes, study in zip(all_axes, studies):
        for point in study["points"]:
            style = {"color": colour(point["backend"]), "marker": MARKERS[point["handles"]], "markersize": 7, "linestyle": ""}
            used += [point["backend"]] if point["backend"] not in used else []
            for key, fill in (("forward_error", "full"), ("residual", "none")):
                axes.plot(point["seconds"]["median"], shown(point[key]), fillstyle=fill, **style)
        oracle = study["oracle"]
        axes.plot(oracle["seconds"]["median"], shown(oracle["forward_error"]), "*", color=COLOURS["oracle"], markersize=9)
        label_times(axes, [point["seconds"]["median"] for point in study["points"]] + [oracle["seconds"]["median"]])
        axes.set_ylim(decades([shown(error) for error in errors]))
        note = f", condition {study['condition']:.0e}" if study["condition"] else ""
        axes.set_title(f"{study['title']}{note}", fontsize=9)
    entries = [entry(name) for name in used] + [entry(f"{kind} handles", MARKERS[kind]) for kind in MARKERS]
    entries += [entry("articulated bodies (oracle)", "*", color=COLOURS["oracle"]), entry("forward error"),
                entry("backward residual", fillstyle="none")]
    add_legend(figure, entries)
    return figure


def marker_of(name):
    return LINE_MARKERS[list(COLOURS).index(name) % len(LINE_MARKERS)]


def over_steps(axes, scene):
    """Errors at the end over the step; grey where no explicit integrator of fixed steps has one."""
    curves = [curve for curve in scene["curves"] if curve["scheme"] != "adaptive"]
    for curve in curves:
        known = [point for point in curve["points"] if not point["no_error"]]
        axes.plot([point["step"] for point in known], [shown(point["error"]) for point in known], color=colour(curve["integrator"]),
                  marker=marker_of(curve["integrator"]), markersize=4)
    limits = [curve["unstable_from"] for curve in curves if curve["scheme"] == "explicit"]
    if limits and min(limits) > 0:
        axes.set_xlim(axes.get_xlim())
        axes.axvspan(max(limits), axes.get_xlim()[1], color="#eeeeee", zorder=0)
        axes.text(max(limits), axes.get_ylim()[0], " explicit ones unstable", fontsize=7, va="bottom")
    axes.set_xlabel("step", fontsize=9)
    axes.set_title(f"{scene['title']}, over the step", fontsize=9)


def integrators(report, hardware):
    """Error at the end (solid) and of the energy (dotted) against the median time of the run; with implicit springs also over the step."""
    scenes = report["integrators"]["scenes"]
    stiff = [scene for scene in scenes if any(curve["scheme"] == "implicit springs" for curve in scene["curves"])]
    figure, all_axes = panels(len(scenes) + len(stiff), f"Integrator error against run time\n{hardware}", "median time of the run / s", "relative error")
    used = []
    for axes, scene in zip(all_axes, scenes):
        for curve in scene["curves"]:
            name = curve["integrator"]
            known = [point for point in curve["points"] if not point["no_error"]]
            used += [name] if name not in used else []
            times = [point["seconds"]["median"] for point in known]
            for key, line in (("error", "-"), ("energy_error", ":")):
                axes.plot(times, [shown(point[key]) for point in known], line, color=colour(name), marker=marker_of(name), markersize=4)
        axes.set_title(scene["title"], fontsize=9)
    for axes, scene in zip(all_axes[len(scenes):], stiff):
        over_steps(axes, scene)
    entries = [entry(name, marker_of(name)) for name in used] + [entry("error at the end", "", linestyle="-"), entry("error of the energy", "", linestyle=":")]
    add_legend(figure, entries)
    return figure


def forces(report, hardware):
    """Differences from the Reference platform, which itself has none: a line at its time."""
    studies = report["forces"]
    figure, all_axes = panels(len(studies), f"OpenMM's forces\n{hardware}", "median time of an evaluation / s", "relative error (rms)")
    for axes, study in zip(all_axes, studies):
        for number, point in enumerate(study["points"]):
            name, seconds = f"{point['platform']}, {point['precision']}", point["seconds"]["median"]
            if point["error"] == 0:
                axes.axvline(seconds, color=COLOURS["oracle"], linestyle="--", linewidth=1, label=f"{name}: what the others differ from")
            else:
                axes.plot(seconds, shown(point["error"]), LINE_MARKERS[number % len(LINE_MARKERS)], label=name)
        label_times(axes, [point["seconds"]["median"] for point in study["points"]])
        axes.set_ylim(decades([point["error"] for point in study["points"]]))
        axes.set_title(f"{study['title']}, {study['beads']:,} beads", fontsize=9)
        axes.legend(fontsize=8, frameon=False)
    return figure


def stability(report, hardware):
    """Forward error over growth, a dot a case, triangles by articulated handles, open ones refined repeatedly, crosses by other programs."""
    figure, (axes,) = panels(1, f"Stability suite: forward error over growth\n{hardware}", "growth of roundings", "forward error")
    figure.set_size_inches(8, 5.5)
    backends, peers = {}, {}
    studies = [study for study in report["stability"] if study["growth"] is not None]
    for study in studies:
        axes.plot(study["growth"], shown(study["oracle"]["forward_error"]), "*", color=COLOURS["oracle"], markersize=6)
        for peer in study["peers"]:
            if not peer["why_not"]:
                peers[peer["name"]] = True
                axes.plot(study["growth"], shown(peer["forward_error"]), "x", color=colour(peer["name"]), markersize=4)
        for point in study["points"]:
            if point["handles"] != "full" and not point["refused"]:
                backends[point["backend"]] = True
                style = {"marker": MARKERS[point["handles"]], "color": colour(point["backend"]), "markersize": 4}
                axes.plot(study["growth"], shown(point["forward_error"]), **style)
                if point["settled"]:
                    axes.plot(study["growth"], shown(point["settled"]["forward_error"]), fillstyle="none", **style)
    growths = decades([study["growth"] for study in studies])
    axes.plot(growths, [2.0**-53 * growth for growth in growths], "--", color="black", linewidth=0.8)
    entries = [entry(name) for name in backends] + [entry("articulated bodies (oracle)", "*", color=COLOURS["oracle"]),
                                                    entry("2^-53 growth", "", linestyle="--"),
                                                    entry("articulated handles", "^"),
                                                    entry("refined", fillstyle="none")] + [entry(name, "x") for name in peers]
    add_legend(figure, entries)
    return figure


def main(report_file, folder):
    with open(report_file, encoding="utf-8") as file:
        report = json.load(file)
    hardware = f"{report['hardware']['processor']}, {report['ranks']} rank(s)"
    for key, draw in (("studies", solver), ("integrators", integrators), ("forces", forces), ("stability", stability)):
        if report.get(key):
            draw(report, hardware).savefig(os.path.join(folder, draw.__name__ + ".png"), dpi=150)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
