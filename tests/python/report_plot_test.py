#!/usr/bin/env python3
"""jobs/report_plot.py on a report in which numbers were not finite, which are null in JSON: every picture is drawn.

Exit status 0: all as it should be; 1: not; 77: skipped, a package is missing."""
import importlib.util
import json
import os
import subprocess
import sys
import tempfile

try:
    import matplotlib  # noqa: F401
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install matplotlib)")
    sys.exit(77)

PLOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "jobs", "report_plot.py")
SECONDS = {"median": 1e-3}


def report(number):
    point = {"backend": "segments", "handles": "projected", "residual": number, "forward_error": number, "seconds": SECONDS}
    oracle = {"forward_error": number, "seconds": SECONDS}
    step = {"step": 0.1, "error": number, "energy_error": number, "seconds": SECONDS, "no_error": ""}
    curves = [{"integrator": "rk4", "scheme": "explicit", "unstable_from": 0.2, "points": [step, {**step, "step": 0.2, "error": None, "no_error": "unstable"}]},
              {"integrator": "dormand-prince", "scheme": "adaptive", "unstable_from": 0, "points": [step]},
              {"integrator": "staggered", "scheme": "implicit springs", "unstable_from": 0, "points": [step]}]
    case = {"backend": "segments", "handles": "projected", "refused": "", "forward_error": number, "settled": {"forward_error": number}}
    held = {**case, "handles": "articulated", "settled": None}
    peer = {"name": "simbody", "forward_error": number, "why_not": "" if number else "its answer is not finite"}
    return {"hardware": {"processor": "any"}, "ranks": 1,
            "studies": [{"title": "a", "condition": number, "points": [point, {**point, "handles": "articulated"}], "oracle": oracle}],
            "integrators": {"scenes": [{"title": "a", "curves": curves}, {"title": "b", "curves": []}]},
            "forces": [{"title": "a", "beads": 1, "points": [{"platform": "CPU", "precision": "single", "error": number, "seconds": SECONDS}]}],
            "stability": [{"growth": number, "oracle": oracle, "points": [case, held], "peers": [peer]}]}


def whole_legend():
    """Of one panel: the legend is no wider or higher than the picture; an error of zero is no point."""
    spec = importlib.util.spec_from_file_location("report_plot", PLOT)
    plot = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(plot)
    told = report(1e-9)
    points = [{"backend": backend, "handles": "projected", "residual": 1e-16, "forward_error": 1e-12, "seconds": SECONDS}
              for backend in ("serial", "segments", "openmp", "cuda", "cuda-levels")]
    told["studies"][0]["points"] += points
    told["forces"][0]["points"].append({"platform": "Reference", "precision": "double", "error": 0, "seconds": SECONDS})
    for draw in (plot.solver, plot.integrators, plot.forces, plot.stability):
        figure = draw(told, "any")
        figure.canvas.draw()
        for legend in figure.legends:
            inside, whole = legend.get_window_extent(), figure.bbox
            if inside.x0 < whole.x0 or inside.x1 > whole.x1 or inside.y0 < whole.y0 or inside.y1 > whole.y1:
                sys.exit(f"FAILED: the legend of {draw.__name__} is cut: {inside} of {whole}")
    lines = plot.forces(told, "any").axes[0].get_lines()
    if any(value == plot.FLOOR for line in lines for value in line.get_ydata()):
        sys.exit("FAILED: the platform that the others are compared with is drawn as measured")
    if not any(label.get_text() for label in plot.forces(told, "any").axes[0].get_xticklabels()):
        sys.exit("FAILED: no time has a label")


whole_legend()
for number in (1e-9, None):
    with tempfile.TemporaryDirectory() as folder:
        source = os.path.join(folder, "report.json")
        with open(source, "w", encoding="utf-8") as file:
            json.dump(report(number), file)
        done = subprocess.run([sys.executable, PLOT, source, folder], capture_output=True, text=True, check=False)
        drawn = sorted(name for name in os.listdir(folder) if name.endswith(".png"))
        if done.returncode != 0 or drawn != ["forces.png", "integrators.png", "solver.png", "stability.png"]:
            sys.exit(f"FAILED: with {number}: {drawn}, status {done.returncode}: {done.stderr}")
print("passed")
