"""Draws the last conformation of a run: beads and links, or thin lines for many sites, to one scale."""
INK, SOFT = "#1b2733", "#66778a"
CHAIN_COLOURS = ["#274b8f", "#2b8fb3", "#4fb286", "#f0c04c", "#e8743b", "#c0304f"]
MOST_ROUND_BEADS = 4000


def placed_chains(trajectory):
    """Positions [sites][3] of each chain, its middle moved into the box by whole edges."""
    import numpy as np
    placed = []
    for first, count, _ in trajectory["chains"]:
        chain = trajectory["positions"][first:first + count].astype(float)
        if trajectory["box"] is not None and count > 0:
            chain = chain - np.floor(chain.mean(axis=0) / trajectory["box"]) * trajectory["box"]
        if count > 0:
            placed.append(chain)
    return placed


def bonds_of_chains(trajectory):
    """Pairs of bonded sites of each chain, counted from 0 in the chain: along it, around a ring, or to the site on which each hangs."""
    import numpy as np
    bonds = []
    for first, count, ring in trajectory["chains"]:
        if count == 0:
            continue
        parent = trajectory["parent"]
        inboard = np.arange(count) - 1 if parent is None else parent[first:first + count]
        pairs = np.stack([inboard, np.arange(count)], axis=1)[1:]
        bonds.append(np.vstack([pairs, [[count - 1, 0]]]) if ring and count > 2 else pairs)
    return bonds


def upright_axes(points, up):
    """Rows: right, up, towards the eye. Ground axis `up` (x, y or z) points up, the widest direction across it to the right."""
    import numpy as np
    above = np.eye(3)["xyz".index(up)]
    across = points - points.mean(axis=0)
    across -= np.outer(across @ above, above)
    right = np.linalg.eigh(across.T @ across)[1][:, -1] if across.any() else np.roll(above, 1)
    if right @ (points[-1] - points[0]) < 0:  # the last site is right of the first
        right = -right
    return np.array([right, above, np.cross(right, above)])


def view_axes(chains, box, up):
    """Rows: right, up, towards the eye. A box is seen from its corner, all else along its narrowest direction, turned to fill a square."""
    import numpy as np
    if up:
        return upright_axes(np.vstack(chains), up)
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


def link_polygons(begin, end, width, radius):
    """Each link from the surface of one bead to that of the other."""
    import numpy as np
    direction = end - begin
    direction *= 0.85 * radius / np.maximum(np.linalg.norm(direction, axis=1), 1e-300)[:, None]
    a, b = (begin + direction)[:, :2], (end - direction)[:, :2]
    along = b - a
    side = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    side *= 0.5 * width / np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
    return np.stack([a + side, b + side, b - side, a - side], axis=1)


def draw_beads(axes, chains, bonds, colours):
    """Beads and links as polygons in one collection, the farthest first."""
    import numpy as np
    from matplotlib.collections import PolyCollection
    link = np.median(np.concatenate([np.linalg.norm(c[pairs[:, 1]] - c[pairs[:, 0]], axis=1) for c, pairs in zip(chains, bonds) if len(pairs)]
                                    or [[1.0]]))
    radius = 0.36 * link
    everything = np.vstack(chains)
    low, high = everything[:, 2].min(), everything[:, 2].max()
    polygons, faces, edges, order = [], [], [], []
    for chain, pairs, colour in zip(chains, bonds, colours):
        from_, to = pairs[:, 0], pairs[:, 1]
        depth = (chain[:, 2] - low) / max(high - low, 1e-300)
        beads = faded(colour, depth)
        shine = faded(np.clip(colour[:, :3] + 0.42 * (1 - colour[:, :3]), 0, 1), depth)
        middle = 0.5 * (chain[to, 2] + chain[from_, 2])
        links = 0.5 * (beads[to] + beads[from_]) * 0.92
        parts = [(link_polygons(chain[from_], chain[to], 0.30 * link, radius), links, 0.62 * links, middle),
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


def draw_lines(axes, chains, bonds, colours):
    """For many sites: thin lines, a chain without branches thinned to what can be seen."""
    import numpy as np
    from matplotlib.collections import LineCollection
    for chain, pairs, colour in zip(chains, bonds, colours):
        step = max(1, len(chain) // 20000)
        if (pairs[:, 1] == pairs[:, 0] + 1).all():
            points = chain[::step, :2]
            segments, colour = np.stack([points[:-1], points[1:]], axis=1), colour[::step]
        else:
            segments, colour = chain[pairs, :2], colour[pairs[:, 0]]
        axes.add_collection(LineCollection(segments, colors=colour[:len(segments)], linewidths=0.9, capstyle="round"))
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


def draw_conformation(axes, trajectory, up=None):
    """Draws the conformation in orthographic projection, both axes to one scale, with ground axis `up` upwards if it is given."""
    import numpy as np
    chains = placed_chains(trajectory)
    view = view_axes(chains, trajectory["box"], up)
    middle = np.vstack(chains).mean(axis=0)
    box = trajectory["box"] if len(chains) > 1 else None
    flat = [(chain - middle) @ view.T for chain in chains]
    if len(chains) == 1:
        colours = [colour_map()(np.linspace(0, 1, len(flat[0])))]
    else:
        colours = [np.tile(colour_map()(k / (len(chains) - 1)), (len(chain), 1)) for k, chain in enumerate(flat)]
    seen = np.vstack(flat + ([draw_box(axes, box, view, middle)] if box is not None else []))
    draw = draw_beads if sum(map(len, chains)) <= MOST_ROUND_BEADS else draw_lines
    radius = draw(axes, flat, bonds_of_chains(trajectory), colours)
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
    if len(chains) == 1 and trajectory["parent"] is None:
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
