"""Draws what `catena bench peers --json FILE` measured: time a body over the number of bodies, a panel for each kind of joint.
Usage: draw.py FILE PICTURE.png"""
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

source, picture = sys.argv[1:3]
with open(source) as file:
    bench = json.load(file)
joints = list(dict.fromkeys(r["joint"] for r in bench["results"]))
names = list(dict.fromkeys(r.get("backend") or r["peer"] for r in bench["results"]))
own = {r["backend"] for r in bench["results"] if "backend" in r}
colours = dict(zip(names, plt.get_cmap("tab20").colors))

figure, panels = plt.subplots(1, len(joints), figsize=(5.2 * len(joints), 4.6), sharey=True, squeeze=False)
for panel, joint in zip(panels[0], joints):
    for name in names:
        rows = [r for r in bench["results"] if r["joint"] == joint and (r.get("backend") or r["peer"]) == name]
        if not rows:
            continue
        threads = rows[0]["threads"]
        x, y = [r["bodies"] for r in rows], [r["ns_per_body"]["evaluation"]["median"] for r in rows]
        label = ("Catena, " if name in own else "") + name + (f", {threads} threads" if threads > 1 else "")
        panel.loglog(x, y, "-" if name in own else "--", color=colours[name], label=label)
        for filled in (True, False):   # open marks: INVALID
            marked = [(a, b) for a, b, r in zip(x, y, rows) if r["valid"] == filled]
            panel.loglog(*zip(*marked) if marked else ([], []), "o", color=colours[name], fillstyle="full" if filled else "none")
    panel.set_title(joint)
    panel.set_xlabel("bodies")
    panel.grid(True, which="both", alpha=0.2)
panels[0][0].set_ylabel("ns a body, one evaluation")
handles = {label: handle for panel in panels[0] for handle, label in zip(*panel.get_legend_handles_labels())}
figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=5, fontsize=8, frameon=False)
build, hardware = bench["build"], bench["hardware"]
figure.suptitle(f"Forward dynamics: {hardware['processor']}; Catena {build['compiler']}, {build['instruction_set']}; open marks: INVALID", fontsize=10)
figure.tight_layout(rect=(0, 0.12, 1, 1))
figure.savefig(picture, dpi=130)
