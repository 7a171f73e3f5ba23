#!/usr/bin/env python3
"""`catena analyse` and `catena convert` on the synthetic slab against numpy and MDAnalysis.

usage: oracle.py FOLDER --catena PROGRAM
numpy takes the trajectory's float64 positions and agrees to 1e-9; MDAnalysis has float32 positions, and agrees to 1e-5.
Exit status 0: all as it should be; 1: not; 77: skipped, a package is missing."""
import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import warnings

try:
    import h5py
    import MDAnalysis
    import numpy as np
    from MDAnalysis.analysis import msd as mda_msd
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install h5py MDAnalysis numpy)")
    sys.exit(77)

CUTOFF, BINS, AMU = 0.9, 60, 1.66053906892
TIGHT, LOOSE = 1e-9, 1e-5
FIRST = 5
KINDS = ("chain", "chain (2)", "chain-7")  # 4 copies of 24, 2 of 13, a ring of 8
compared = 0


def check(condition, message):
    if not condition:
        raise SystemExit(f"FAILED: {message}")


def agree(name, found, right, tolerance=TIGHT):
    global compared
    found, right = np.asarray(found, dtype=float), np.asarray(right, dtype=float)
    check(found.shape == right.shape, f"{name}: shapes {found.shape} and {right.shape}")
    worst = np.max(np.abs(found - right)) / max(np.max(np.abs(right)), 1e-300)
    check(worst <= tolerance, f"{name}: differs by {worst:.2g} relative, {found.ravel()[:3]} and {right.ravel()[:3]}")
    compared += found.size


def run(catena, *words):
    done = subprocess.run([catena, *words], capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"{words}: {done.stderr}")
    return done.stdout


def read_table(path):
    """{kind: (x, value, error, between)}"""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))[1:]
    table = {}
    for row in rows:
        table.setdefault(row[0], []).append([float(cell) if cell else np.nan for cell in row[1:5]])
    return {kind: np.array(points).T for kind, points in table.items()}


class Trajectory:
    def __init__(self, folder):
        with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
            group = file["particles/trajectory"]
            self.x = group["position/value"][FIRST:]
            self.mass = group["mass"][:]
            self.box = group["box/edges/value"][0]
            first, count = file["catena/chains/first"][:], file["catena/chains/count"][:]
            self.ring = file["catena/chains/ring"][:]
        self.chains = [slice(f, f + n) for f, n in zip(first, count)]
        self.kinds = dict(zip(KINDS, (self.chains[:4], self.chains[4:6], self.chains[6:])))


def gyration(x, mass):
    """Tensors [frame][3][3], weighted by mass."""
    centre = np.einsum("k,fkd->fd", mass, x) / mass.sum()
    apart = x - centre[:, None]
    return np.einsum("k,fki,fkj->fij", mass, apart, apart) / mass.sum()


def check_sizes(t, numbers, maps):
    for kind, chains in t.kinds.items():
        tensors = [gyration(t.x[:, c], t.mass[c]) for c in chains]
        radius = np.array([np.sqrt(np.trace(s, axis1=1, axis2=2)) for s in tensors]).T
        eigenvalues = np.array([np.linalg.eigvalsh(s) for s in tensors])
        mean = eigenvalues.mean(axis=2, keepdims=True)
        asphericity = (1.5 * ((eigenvalues - mean) ** 2).sum(axis=2) / eigenvalues.sum(axis=2) ** 2).T
        agree(f"radii of {kind}", maps[f"series/radius_of_gyration/{kind}"][:], radius)
        agree(f"asphericities of {kind}", maps[f"series/asphericity/{kind}"][:], asphericity)
        one = numbers["radius_of_gyration", kind]
        agree("mean radius", one["value"], radius.mean())
        if len(chains) > 1:
            agree("between copies", one["error_between_copies"], radius.mean(axis=0).std(ddof=1) / np.sqrt(len(chains)))
        agree("mean asphericity", numbers["asphericity", kind]["value"], asphericity.mean())
        naive = radius.mean(axis=1).std(ddof=1) / np.sqrt(len(radius))
        check(0.99 * naive < one["error_by_blocking"] < 3 * naive, "the error by blocking is far from that of independent frames")
        if kind != KINDS[2]:
            ends = np.array([np.linalg.norm(t.x[:, c][:, -1] - t.x[:, c][:, 0], axis=1) for c in chains]).T
            agree("ends", maps[f"series/end_to_end_distance/{kind}"][:], ends)
            agree("mean of ends", numbers["end_to_end_distance", kind]["value"], ends.mean())
    check(("end_to_end_distance", KINDS[2]) not in numbers, "a ring has no ends")


def check_distribution(t, folder):
    table = read_table(os.path.join(folder, "radius_distribution.csv"))
    for kind, chains in t.kinds.items():
        radius = np.concatenate([np.sqrt(np.trace(gyration(t.x[:, c], t.mass[c]), axis1=1, axis2=2)) for c in chains])
        density, edges = np.histogram(radius, bins=40, density=True)
        agree("histogram", table[kind][1], density)
        agree("bins", table[kind][0], 0.5 * (edges[1:] + edges[:-1]))


def pairs_at(x, s, ring):
    other = np.roll(x, -s, axis=1)
    return (x, other) if ring else (x[:, :-s], other[:, :-s])


def check_internal(t, numbers, folder):
    distances, cosines = (read_table(os.path.join(folder, name + ".csv")) for name in ("internal_distances", "bond_correlation"))
    for kind, chains in t.kinds.items():
        ring = kind == KINDS[2]
        separations = distances[kind][0].astype(int)
        bonds, squares = [], []
        for c in chains:
            x = t.x[:, c]
            squares.append([((np.subtract(*pairs_at(x, s, ring))) ** 2).sum(axis=2).mean() for s in separations])
            bond = np.roll(x, -1, axis=1) - x
            bonds.append(bond if ring else bond[:, :-1])
        right = np.sqrt(np.mean(squares, axis=0))
        agree("internal distances", distances[kind][1], right)
        length = np.mean([np.linalg.norm(b, axis=2).mean() for b in bonds])
        agree("bond length", numbers["bond_length", kind]["value"], length)
        unit = [b / np.linalg.norm(b, axis=2, keepdims=True) for b in bonds]
        s_bonds = cosines[kind][0].astype(int)
        c_right = np.mean([[(np.prod(pairs_at(u, s, ring), axis=0)).sum(axis=2).mean() for s in s_bonds] for u in unit], axis=0)
        agree("bond correlation", cosines[kind][1], c_right)
        used = np.argmax(np.append(c_right, 0)[1:] < np.exp(-1)) + 1
        d = length * s_bonds[:used]
        agree("persistence length", numbers["persistence_length", kind]["value"], (d ** 2).sum() / -(np.log(c_right[:used]) * d).sum())
        if kind == KINDS[0]:
            fitted = (separations >= 3) & (separations <= 12)
            slope, _ = np.polyfit(np.log(separations[fitted]), np.log(right[fitted]), 1)
            agree("scaling exponent", numbers["scaling_exponent", kind]["value"], slope)
            slopes = [np.polyfit(np.log(separations[fitted]), 0.5 * np.log(np.array(s)[fitted]), 1)[0] for s in squares]
            agree("exponents of copies", numbers["scaling_exponent", kind]["error_between_copies"], np.std(slopes, ddof=1) / 2)


def check_contacts(t, numbers, maps):
    kinds = list(t.kinds)
    maps_right = {}
    within, between = {k: 0.0 for k in kinds}, {k: 0.0 for k in kinds}
    owner = [(k, c) for k in kinds for c in t.kinds[k]]
    for a, (kind, chain) in enumerate(owner):
        for b, (other_kind, other) in enumerate(owner):
            apart = t.x[:, chain, None] - t.x[:, None, other]
            if a != b:
                apart -= t.box * np.rint(apart / t.box)
            near = np.linalg.norm(apart, axis=3) <= CUTOFF
            if a == b:
                near &= ~np.eye(near.shape[1], dtype=bool)
                far = np.abs(np.subtract.outer(*[np.arange(near.shape[1])] * 2)) >= 3
                within[kind] += (near & far).sum() / 2 / len(t.x) / len(t.kinds[kind])
            else:
                between[kind] += near.sum() / len(t.x) / len(t.kinds[kind])
            name = ("within", kind) if a == b else ("between", f"{kind} -- {other_kind}")
            maps_right.setdefault(name, []).append(near.mean(axis=0))
    for (part, name), right in maps_right.items():
        if f"contacts/{part}/{name}" in maps:
            agree(f"contacts {part} {name}", maps[f"contacts/{part}/{name}/mean"][:], np.mean(right, axis=0))
    agree("maps", sum(len(group) for group in maps["contacts"].values() if isinstance(group, h5py.Group)), 3 + 5)
    for kind in kinds:
        agree("contacts within", numbers["contacts_within", kind]["value"], within[kind])
        agree("contacts between", numbers["contacts_between", kind]["value"], between[kind])


def check_density(t, folder):
    table = read_table(os.path.join(folder, "density.csv"))
    turn = 2 * np.pi / t.box[2]
    z = t.x[:, :, 2]
    middle = np.arctan2((t.mass * np.sin(turn * z)).sum(axis=1), (t.mass * np.cos(turn * z)).sum(axis=1)) / turn
    z = z - middle[:, None]
    z -= t.box[2] * np.rint(z / t.box[2])
    edges = np.linspace(-0.5, 0.5, BINS + 1) * t.box[2]
    scale = AMU * BINS / np.prod(t.box) / len(t.x)
    for kind, chains in [*t.kinds.items(), ("all", t.chains)]:
        sites = np.concatenate([np.arange(c.start, c.stop) for c in chains])
        right, _ = np.histogram(z[:, sites], bins=edges, weights=np.broadcast_to(t.mass[sites], (len(z), len(sites))))
        agree(f"density of {kind}", table[kind][1], scale * right)


def check_displacement(t, numbers, folder):
    table = read_table(os.path.join(folder, "displacement.csv"))
    for kind, chains in t.kinds.items():
        centre = np.array([np.einsum("k,fkd->fd", t.mass[c], t.x[:-1, c]) / t.mass[c].sum() for c in chains])  # the last frame is uneven
        lags = np.rint(table[kind][0]).astype(int)  # 1 ps apart
        right = np.array([((centre[:, n:] - centre[:, :-n]) ** 2).sum(axis=2).mean() for n in lags])
        agree(f"displacement of {kind}", table[kind][1], right)
        whole = centre.shape[1] - 1
        fitted = (lags >= 0.05 * whole) & (lags <= 0.25 * whole)
        agree("diffusion", numbers["diffusion", kind]["value"], np.polyfit(lags[fitted], right[fitted], 1)[0] / 6)


def check_with_mdanalysis(t, folder, maps, tables):
    universe = MDAnalysis.Universe(os.path.join(folder, "topology.psf"), os.path.join(folder, "trajectory.h5md"))
    groups = [universe.atoms[c] for c in t.kinds[KINDS[0]]]
    radius, asphericity = [], []
    for _ in universe.trajectory[FIRST:]:
        radius.append([g.radius_of_gyration() / 10 for g in groups])
        asphericity.append([g.asphericity() for g in groups])
    agree("radii by MDAnalysis", maps[f"series/radius_of_gyration/{KINDS[0]}"][:], radius, LOOSE)
    agree("asphericities by MDAnalysis", maps[f"series/asphericity/{KINDS[0]}"][:], asphericity, LOOSE)
    centres = np.stack([np.einsum("k,fkd->fd", t.mass[c], t.x[:-1, c]) / t.mass[c].sum() for c in t.kinds[KINDS[0]]], axis=1)
    points = MDAnalysis.Universe.empty(centres.shape[1], trajectory=True)
    points.load_new(10 * centres.astype(np.float32), order="fac")
    found = mda_msd.EinsteinMSD(points, fft=False).run().results.timeseries / 100
    lags = np.rint(tables[KINDS[0]][0]).astype(int)
    agree("displacement by MDAnalysis", tables[KINDS[0]][1], found[lags], LOOSE)


def read_dcd(topology, dcd):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        universe = MDAnalysis.Universe(topology, dcd)
        frames = [(ts.time, ts.dimensions.copy(), ts.positions.copy()) for ts in universe.trajectory]
        return universe.trajectory.dt, frames


def check_with_mdtraj(folder, dcd, right, box):
    """mdtraj reads DCD files by VMD's plugin."""
    try:
        import mdtraj
    except ImportError:
        print("mdtraj is missing (pip install mdtraj): DCD and XTC files were read by MDAnalysis alone")
        return
    found = mdtraj.load(dcd, top=os.path.join(folder, "topology.pdb"))
    agree("positions by mdtraj", found.xyz, right, 1e-6)
    agree("boxes by mdtraj", found.unitcell_lengths, [box] * len(right), 1e-6)
    agree("angles by mdtraj", found.unitcell_angles, np.full((len(right), 3), 90.0), 1e-6)


def check_dcd(catena, folder, scratch):
    topology = os.path.join(folder, "topology.psf")
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        x, time = file["particles/trajectory/position/value"][:-1], file["particles/trajectory/position/time"][:-1]
        box = file["particles/trajectory/box/edges/value"][0]
        chains = list(zip(file["catena/chains/first"][:], file["catena/chains/count"][:]))
    wrapped = {"none": x, "sites": x - box * np.floor(x / box), "chains": x.copy()}
    for first, count in chains:
        part = wrapped["chains"][:, first:first + count]
        part -= box * np.floor(part.mean(axis=1, keepdims=True) / box)
    for how, right in wrapped.items():
        dcd = os.path.join(scratch, how + ".dcd")
        said = run(catena, "convert", folder, dcd, "--wrap", how)
        check("1 frame was left out: a DCD file holds one interval, here 100 steps" in said, said)
        dt, frames = read_dcd(topology, dcd)
        check(len(frames) == len(right), f"{len(frames)} frames")
        agree("time step", dt, 1, 1e-6)
        agree("times", [f[0] for f in frames], time, 1e-6)
        agree("boxes", [f[1] for f in frames], [[*(10 * box), 90, 90, 90]] * len(frames), 1e-12)
        agree("positions", [f[2] for f in frames], (10 * right).astype(np.float32), 0)
        check_with_mdtraj(folder, dcd, right, box)
    part = os.path.join(scratch, "part.dcd")
    run(catena, "convert", folder, part, "--first", "10", "--last", "19", "--quiet")
    dt, frames = read_dcd(topology, part)
    agree("times of a part", [f[0] for f in frames], time[10:20], 1e-6)
    agree("positions of a part", [f[2] for f in frames], (10 * x[10:20]).astype(np.float32), 0)


def check_xtc(catena, folder, scratch):
    """XTC files: every frame with its time and box, positions to half the precision, by MDAnalysis and mdtraj."""
    with h5py.File(os.path.join(folder, "trajectory.h5md")) as file:
        x, time = file["particles/trajectory/position/value"][:], file["particles/trajectory/position/time"][:]
        step, box = file["particles/trajectory/position/step"][:], file["particles/trajectory/box/edges/value"][0]
    for how, precision in (("none", 1000), ("none", 20), ("sites", 1000000)):
        right = x if how == "none" else x - box * np.floor(x / box)
        xtc = os.path.join(scratch, f"{how}-{precision}.xtc")
        run(catena, "convert", folder, xtc, "--wrap", how, "--precision", str(precision))
        universe = MDAnalysis.Universe(os.path.join(folder, "topology.psf"), xtc)
        frames = [(ts.time, ts.frame, ts.data["step"], ts.dimensions.copy(), ts.positions.copy()) for ts in universe.trajectory]
        check(len(frames) == len(right), f"{len(frames)} frames of XTC")
        agree("times of XTC", [f[0] for f in frames], time, 1e-6)
        agree("steps of XTC", [f[2] for f in frames], step, 0)
        agree("boxes of XTC", [f[3] for f in frames], [[*(10 * box), 90, 90, 90]] * len(frames), 1e-6)
        check_half(precision, np.array([f[4] for f in frames]) / 10, right)
        check_xtc_with_mdtraj(os.path.join(folder, "topology.pdb"), xtc, right, (time, box, precision))


def check_half(precision, found, right):
    """Positions agree to half the precision and to single precision."""
    global compared
    worst = np.max(np.abs(found - right) - 1e-6 * np.abs(right))
    check(worst <= 0.5001 / precision, f"positions of an XTC file of precision {precision} differ by {worst} nm")
    compared += right.size


def check_xtc_with_mdtraj(pdb, xtc, right, expected):
    time, box, precision = expected
    try:
        import mdtraj
    except ImportError:
        return
    found = mdtraj.load(xtc, top=pdb)
    check_half(precision, found.xyz, right)
    agree("times by mdtraj", found.time, time, 1e-6)
    agree("boxes by mdtraj", found.unitcell_lengths, [box] * len(right), 1e-6)


def check_damage(catena, folder, scratch):
    """A list that claims more than its file can hold is refused before memory is taken for it."""
    damaged = os.path.join(scratch, "damaged.h5md")
    shutil.copy(os.path.join(folder, "trajectory.h5md"), damaged)
    with h5py.File(damaged, "r+") as file:
        del file["catena/chains/beads"]
        file.create_dataset("catena/chains/beads", shape=(10 ** 10,), chunks=(1024,), dtype="i8")
    done = subprocess.run([catena, "analyse", damaged], capture_output=True, text=True, check=False)
    check(done.returncode == 2 and done.stderr.count("\n") == 1, f"damage: {done.returncode} {done.stderr}")
    check("its catena/chains/beads claims more than it holds" in done.stderr, done.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--catena", required=True)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        found = json.loads(run(arguments.catena, "analyse", arguments.folder, "--first", str(FIRST), "--cutoff", str(CUTOFF), "--slab", "z",
                               "--bins", str(BINS), "--fit", "3,12", "--output", scratch, "--json", "-"))
        numbers = {(q["name"], q["chains"]): q for q in found["quantities"]}
        t = Trajectory(arguments.folder)
        check([k["copies"] for k in found["chains"]] == [4, 2, 1], f"kinds {found['chains']}")
        check(any("displacements leave out 1 of the frames" in note for note in found["notes"]), f"notes {found['notes']}")
        with h5py.File(os.path.join(scratch, "maps.h5")) as maps:
            check_sizes(t, numbers, maps)
            check_contacts(t, numbers, maps)
            check_with_mdanalysis(t, arguments.folder, maps, read_table(os.path.join(scratch, "displacement.csv")))
        check_distribution(t, scratch)
        check_internal(t, numbers, scratch)
        check_density(t, scratch)
        check_displacement(t, numbers, scratch)
        check_dcd(arguments.catena, arguments.folder, scratch)
        check_xtc(arguments.catena, arguments.folder, scratch)
        check_damage(arguments.catena, arguments.folder, scratch)
    print(f"{compared} numbers agree with numpy and MDAnalysis")


if __name__ == "__main__":
    main()
