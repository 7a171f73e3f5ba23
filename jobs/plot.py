#!/usr/bin/env python3
"""One picture of a run: the chain's last conformation and the observables against time.

Reads trajectory.h5md and observables.csv of the folder that `catena run` wrote."""
import argparse
import os
import sys

SURFACE, INK, SOFT, GRID, LINE = "#ffffff", "#1b2733", "#66778a", "#e7ecf1", "#0b6bcb"
CHAIN_COLOURS = ["#274b8f", "#2b8fb3", "#4fb286", "#f0c04c", "#e8743b", "#c0304f"]
MOST_PANELS = 6
MOST_POINTS = 2000
MOST_ROUND_BEADS = 4000
PREFERRED = ["potential_energy", "total_energy", "temperature", "radius_of_gyration", "end_to_end_distance", "constraint_error"]


class UserError(Exception):
    """What is wrong, where, and what to do."""


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="example:\n  build/venv/bin/python jobs/plot.py runs/alpha-synuclein --output picture.png")
    parser.add_argument("folder", metavar="FOLDER", help="folder of a run (catena run ... --output FOLDER)")
    parser.add_argument("--output", metavar="FILE.png", help="where the picture goes (default: FOLDER/picture.png)")
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
                "title": title_of(file["catena"].attrs.get("title", b"")),
            }
    except (OSError, KeyError) as error:
        raise UserError(f"not a trajectory of Catena ({path}): {error}") from None


def title_of(text):
    return text.decode("utf-8", "replace") if isinstance(text, bytes) else str(text)


def placed_chains(trajectory):
    """Positions [sites][3] of each chain, its middle moved into the box by whole edges."""
    import numpy as np
    placed = []
    for first, count, ring in trajectory["chains"]:
        chain = trajectory["positions"][first:first + count].astype(float)
        if trajectory["box"] is not None and count > 0:
            chain = chain - np.floor(chain.mean(axis=0) / trajectory["box"]) * trajectory["box"]
        if count > 0:
            placed.append(np.vstack([chain, chain[:1]]) if ring and count > 2 else chain)
    return placed


def view_axes(chains, box):
    """Rows: right, up, towards the eye. A box is seen from its corner, all else along its narrowest direction, turned to fill a square."""
    import numpy as np
    if box is not None and len(chains) > 1:
        eye = np.array([0.45, -0.8, 0.4])
        eye /= np.linalg.norm(eye)
        right = np.cross([0, 0, 1], eye)
        right /= np.linalg.norm(right)
        return np.array([right, np.cross(eye, right), eye])
    points = np.vstack(chains)
    points = points - points.mean(axis=0)
    axes = np.linalg.svd(points, full_matrices=True)[2] if len(points) < 100000 else np.linalg.eigh(points.T @ points)[1].T[::-1]
    flat = points[::max(1, len(points) // 5000)] @ axes[:2].T
    turns = [np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]]) for a in np.linspace(0, np.pi, 61)]
    axes[:2] = min(turns, key=lambda turn: np.ptp(flat @ turn.T, axis=0).max()) @ axes[:2]
    if axes[0] @ (points[-1] - points[0]) < 0:  # the last site is right of the first
        axes[0] *= -1
    axes[2] = np.cross(axes[0], axes[1])
    return axes


def colour_map():
    from matplotlib.colors import LinearSegmentedColormap
    return LinearSegmentedColormap.from_list("chain", CHAIN_COLOURS)


def faded(colours, depth):
    """Towards the surface's colour with the distance from the eye (`depth`: 1 nearest, 0 farthest)."""
    import numpy as np
    amount = 0.5 * (1 - depth)[:, None]
    return (1 - amount) * colours[:, :3] + amount * np.array([1.0, 1.0, 1.0])


def bead_polygons(points, radius):
    import numpy as np
    angle = np.linspace(0, 2 * np.pi, 28, endpoint=False)
    return points[:, None, :2] + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)[None]


def link_polygons(points, width, radius):
    """Each link from the surface of one bead to that of the next."""
    import numpy as np
    direction = np.diff(points, axis=0)
    direction *= 0.85 * radius / np.maximum(np.linalg.norm(direction, axis=1), 1e-300)[:, None]
    a, b = (points[:-1] + direction)[:, :2], (points[1:] - direction)[:, :2]
    along = b - a
    side = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    side *= 0.5 * width / np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
    return np.stack([a + side, b + side, b - side, a - side], axis=1)


def draw_beads(axes, chains, colours):
    """Beads and links as polygons in one collection, the farthest first."""
    import numpy as np
    from matplotlib.collections import PolyCollection
    link = np.median(np.concatenate([np.linalg.norm(np.diff(c, axis=0), axis=1) for c in chains if len(c) > 1] or [[1.0]]))
    radius = 0.36 * link
    everything = np.vstack(chains)
    low, high = everything[:, 2].min(), everything[:, 2].max()
    polygons, faces, edges, order = [], [], [], []
    for chain, colour in zip(chains, colours):
        depth = (chain[:, 2] - low) / max(high - low, 1e-300)
        beads = faded(colour, depth)
        shine = faded(np.clip(colour[:, :3] + 0.42 * (1 - colour[:, :3]), 0, 1), depth)
        middle = 0.5 * (chain[1:, 2] + chain[:-1, 2])
        links = 0.5 * (beads[1:] + beads[:-1]) * 0.92
        parts = [(link_polygons(chain, 0.30 * link, radius), links, 0.62 * links, middle),
                 (bead_polygons(chain, radius), beads, 0.62 * beads, chain[:, 2]),
                 (bead_polygons(chain + [-0.3 * radius, 0.32 * radius, 0], 0.36 * radius), shine, shine, chain[:, 2] + 1e-6 * link)]
        for polygon, face, edge, z in parts:
            polygons += list(polygon)
            faces.append(face)
            edges.append(edge)
            order.append(z)
    sorted_by_depth = np.argsort(np.concatenate(order), kind="stable")
    axes.add_collection(PolyCollection([polygons[k] for k in sorted_by_depth], facecolors=np.vstack(faces)[sorted_by_depth],
                                       edgecolors=np.vstack(edges)[sorted_by_depth], linewidths=0.5))
    return radius


def draw_lines(axes, chains, colours):
    """For many sites: thin lines, the chain thinned to what can be seen."""
    import numpy as np
    from matplotlib.collections import LineCollection
    for chain, colour in zip(chains, colours):
        step = max(1, len(chain) // 20000)
        points = chain[::step, :2]
        segments = np.stack([points[:-1], points[1:]], axis=1)
        axes.add_collection(LineCollection(segments, colors=colour[::step][:len(segments)], linewidths=0.9, capstyle="round"))
    return 0.0


def draw_box(axes, box, view, middle):
    import itertools
    import numpy as np
    corners = np.array(list(itertools.product([0, 1], repeat=3)))
    flat = (corners * box - middle) @ view.T
    for i, j in itertools.combinations(range(8), 2):
        if np.abs(corners[i] - corners[j]).sum() == 1:
            axes.plot(*zip(flat[i, :2], flat[j, :2]), color=SOFT, linewidth=0.8, zorder=0)
    return flat


def round_length(largest):
    import math
    power = 10 ** math.floor(math.log10(largest))
    return next(factor * power for factor in (5, 2, 1) if factor * power <= largest * 1.0000001)


def draw_scale(axes, extent, unit):
    length = round_length(0.22 * (extent[1] - extent[0]))
    x = extent[0] + 0.03 * (extent[1] - extent[0])
    y = extent[2] + 0.035 * (extent[3] - extent[2])
    axes.plot([x, x + length], [y, y], color=INK, linewidth=2.2, solid_capstyle="butt")
    axes.annotate(f"{length:g} {unit}", (x + 0.5 * length, y), xytext=(0, 6), textcoords="offset points", ha="center", color=INK, fontsize=10)


def draw_conformation(axes, trajectory):
    """Orthographic, both axes to one scale."""
    import numpy as np
    chains = placed_chains(trajectory)
    view = view_axes(chains, trajectory["box"])
    middle = np.vstack(chains).mean(axis=0)
    box = trajectory["box"] if len(chains) > 1 else None
    flat = [(chain - middle) @ view.T for chain in chains]
    if len(chains) == 1:
        colours = [colour_map()(np.linspace(0, 1, len(flat[0])))]
    else:
        colours = [np.tile(colour_map()(k / (len(chains) - 1)), (len(chain), 1)) for k, chain in enumerate(flat)]
    seen = np.vstack(flat + ([draw_box(axes, box, view, middle)] if box is not None else []))
    draw = draw_beads if sum(map(len, chains)) <= MOST_ROUND_BEADS else draw_lines
    radius = draw(axes, flat, colours)
    low, high = seen[:, :2].min(axis=0) - 1.5 * radius, seen[:, :2].max(axis=0) + 1.5 * radius
    half = 0.53 * np.maximum((high - low), 0.45 * (high - low).max() + 1e-9)
    centre = 0.5 * (low + high)
    half[1] *= 1.06  # room for the scale
    centre[1] -= 0.06 * half[1]
    extent = [centre[0] - half[0], centre[0] + half[0], centre[1] - half[1], centre[1] + half[1]]
    axes.set(xlim=extent[:2], ylim=extent[2:], aspect="equal")
    axes.set_anchor("C")
    axes.axis("off")
    draw_scale(axes, extent, trajectory["unit"])
    if len(chains) == 1:
        mark_ends(axes, flat[0], trajectory["chains"][0][1], radius + 0.032 * (extent[1] - extent[0]))


def mark_ends(axes, chain, count, distance):
    """The numbers of the first and last site, where the chain leaves most room beside them."""
    import numpy as np
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    for site, number in ((0, 1), (-1, count)):
        places = chain[site, :2] + distance * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        room = np.linalg.norm(places[:, None] - chain[None, ::max(1, len(chain) // 5000), :2], axis=-1).min(axis=1)
        axes.annotate(str(number), places[np.argmax(np.round(room / distance, 2))], ha="center", va="center", color=INK, fontsize=10,
                      fontweight="bold")


def name_and_unit(column):
    name, _, unit = column.partition(" [")
    return name, unit.rstrip("]")


def chosen_columns(names, records):
    """Indices of the columns to draw: of those that change the preferred ones first, then others, in the order of the table."""
    columns = {name_and_unit(name)[0]: k for k, name in enumerate(names) if k >= 2}
    columns = {name: k for name, k in columns.items() if (records[:, k] != records[0, k]).any()} or columns
    wanted = [name for name in PREFERRED if name in columns] + [name for name in columns if name not in PREFERRED]
    return sorted(columns[name] for name in wanted[:MOST_PANELS])


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


def draw_observable(axes, time, values, column, is_last, time_label):
    import numpy as np
    from matplotlib.ticker import MaxNLocator
    name, unit = name_and_unit(column)
    finite = values[np.isfinite(values)]
    axes.plot(*thinned(time, values), color=LINE, linewidth=1.1)
    if finite.size > 1:
        if finite.min() > 0 and finite.max() > 1e3 * finite.min():
            axes.set_yscale("log")
        else:
            axes.axhline(finite.mean(), color=SOFT, linewidth=0.9, linestyle=(0, (2, 3)))
            axes.yaxis.set_major_locator(MaxNLocator(4))
            axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 5), useMathText=True)
            axes.yaxis.get_offset_text().set(size=8.5, color=SOFT)
    readable = name.replace("_", " ").capitalize() + (f"  [{unit}]" if unit not in ("", "1") else "")
    axes.annotate(readable, (1, 1), xytext=(0, 5), xycoords="axes fraction", textcoords="offset points", ha="right", color=INK, fontsize=10.5)
    axes.grid(axis="y", color=GRID, linewidth=0.9)
    axes.set_axisbelow(True)
    axes.tick_params(colors=SOFT, labelsize=9, length=3, labelbottom=is_last)
    axes.margins(x=0)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.spines["bottom"].set_color(GRID if not is_last else SOFT)
    if is_last:
        axes.set_xlabel(time_label, color=SOFT, fontsize=10)


def draw_picture(names, records, trajectory, output):
    import matplotlib.pyplot as plt
    columns = chosen_columns(names, records)
    if not columns:
        raise UserError("the table holds no observables (observables.csv): ask for some under output.observables")
    plt.rcParams.update({"font.family": "DejaVu Sans", "axes.facecolor": SURFACE, "figure.facecolor": SURFACE})
    figure = plt.figure(figsize=(13, max(6.4, 0.6 + 1.2 * len(columns))))
    grid = figure.add_gridspec(len(columns), 2, width_ratios=[1.12, 1], hspace=0.42, wspace=0.1, left=0.02, right=0.985, top=0.86, bottom=0.075)
    draw_conformation(figure.add_subplot(grid[:, 0]), trajectory)
    time_unit = name_and_unit(names[1])[1]
    first = None
    for row, column in enumerate(columns):
        axes = figure.add_subplot(grid[row, 1], sharex=first)
        first = first or axes
        draw_observable(axes, records[:, 1], records[:, column], names[column], row == len(columns) - 1, f"time [{time_unit}]")
    figure.text(0.028, 0.945, trajectory["title"] or "A run of Catena", fontsize=17, fontweight="bold", color=INK)
    sites, chains = len(trajectory["positions"]), len(trajectory["chains"])
    told = f"{chains} chains, " if chains > 1 else ""
    figure.text(0.028, 0.908, f"{told}{sites:,} sites, at {trajectory['time']:g} {trajectory['time_unit']}", fontsize=11, color=SOFT)
    try:
        figure.savefig(output, dpi=150)
    except (OSError, ValueError) as error:
        raise UserError(f"the picture cannot be written ({output}): {error}") from None


def main():
    arguments = parse_arguments()
    try:
        import_packages()
        if not os.path.isdir(arguments.folder):
            raise UserError(f"no such folder ({arguments.folder}): name the folder of a run")
        names, records = read_observables(require_file(arguments.folder, "observables.csv"))
        trajectory = read_trajectory(require_file(arguments.folder, "trajectory.h5md"))
        output = arguments.output or os.path.join(arguments.folder, "picture.png")
        draw_picture(names, records, trajectory, output)
    except UserError as error:
        print(f"plot.py: {error}", file=sys.stderr)
        return 2
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
