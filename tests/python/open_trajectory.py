#!/usr/bin/env python3
"""Opens a run's trajectory as other people's tools do and checks what they see.

Through h5py: the H5MD 1.1 layout, shapes, steps, times, units, links of `--link` to 1e-8 of the scene's unit in float64.
Through MDAnalysis (not for `units: si`, which it cannot read): the same sites, frames and times, links to 1e-5 nm in float32.
Exit status 0: all as it should be; 1: not; 77: skipped, a package is missing."""
import argparse
import os
import sys
import warnings

try:
    import h5py
    import MDAnalysis
    import numpy as np
except ImportError as error:
    print(f"SKIPPED: the Python package {error.name} is missing (pip install h5py MDAnalysis numpy)")
    sys.exit(77)

ANGSTROM_PER_NM = 10
MD_UNITS = {"position": "nm", "time": "ps", "velocity": "nm ps-1", "joint_force": "kJ mol-1 nm-1", "joint_torque": "kJ mol-1"}
SI_UNITS = {"position": "m", "time": "s", "velocity": "m s-1", "joint_force": "N", "joint_torque": "N m"}


def check(condition, message):
    if not condition:
        raise SystemExit(f"FAILED: {message}")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--sites", type=int)
    parser.add_argument("--frames", type=int)
    parser.add_argument("--every", type=int, help="steps from one frame to the next")
    parser.add_argument("--time-step", type=float, help="time = step * time step, to 1e-12")
    parser.add_argument("--link", type=float, help="distance of neighbours in every chain")
    return parser.parse_args()


def unit_of(item):
    kind = item.attrs.get_id("unit").get_type()
    check(isinstance(kind, h5py.h5t.TypeStringID) and kind.is_variable_str(), f"the unit of {item.name} is not of variable length")
    return item.attrs["unit"]


def check_header(file):
    check(list(file["h5md"].attrs["version"]) == [1, 1], "h5md/version is not [1, 1]")
    for group, names in (("author", ["name"]), ("creator", ["name", "version"])):
        for name in names:
            kind = file[f"h5md/{group}"].attrs.get_id(name).get_type()
            check(isinstance(kind, h5py.h5t.TypeStringID) and not kind.is_variable_str(), f"h5md/{group}/{name} is not of fixed length")
    check("units" in file["h5md/modules"], "the units module is not named")
    check(list(file["particles"]) == ["trajectory"], "MDAnalysis wants one group of particles named trajectory")


def check_elements(file, arguments):
    """Every element has the steps, times and number of frames of `position`."""
    sites = file["particles/trajectory"]
    frames, count = sites["position/value"].shape[:2]
    si = unit_of(sites["position/value"]) == "m"
    units = SI_UNITS if si else MD_UNITS
    steps, times = sites["position/step"][:], sites["position/time"][:]
    check(steps.shape == times.shape == (frames,), "as many steps and times as frames")
    check(np.all(np.diff(steps) > 0), "steps rise")
    check(steps.dtype.kind == "i" and times.dtype == np.float64, "steps are integers and times float64")
    if arguments.every:
        check(np.all(np.diff(steps) == arguments.every), f"a frame every {arguments.every} steps: no gap, no double frame")
    if arguments.time_step:
        check(np.allclose(times, steps * arguments.time_step, rtol=1e-12, atol=1e-12 * arguments.time_step), "time = step * time step")
    bodies = int(np.sum(file["catena/chains/count"][:] * (1 - file["catena/chains/beads"][:])))
    shapes = {"particles/trajectory/position": (count, 3), "particles/trajectory/velocity": (count, 3), "particles/trajectory/box/edges": (3,),
              "catena/orientation": (bodies, 4), "catena/joint_force": (count, 3), "catena/joint_torque": (count, 3)}
    for name, row in shapes.items():
        if name not in file:
            continue
        element = file[name]
        check(element["value"].shape == (frames, *row), f"{name} has shape {element['value'].shape}")
        check(element["value"].dtype == np.float64, f"{name} is not float64")
        check(np.all(np.isfinite(element["value"][:])), f"{name} holds numbers that are not finite")
        check(element["step"] == sites["position/step"] and element["time"] == sites["position/time"], f"{name} has steps of its own")
        quantity = "position" if name.endswith("edges") else name.split("/")[-1]
        check(quantity == "orientation" or unit_of(element["value"]) == units[quantity], f"the unit of {name}")
    check(unit_of(sites["position/time"]) == units["time"], "the unit of time")
    check(bodies == 0 or np.allclose(np.linalg.norm(file["catena/orientation/value"][:], axis=2), 1, atol=1e-9), "quaternions are of length 1")
    check(sites["mass"].shape == sites["id"].shape == (count,) and np.all(sites["mass"][:] > 0), "a mass and an id for each site")
    check(sites["box"].attrs["dimension"] == 3 and len(sites["box"].attrs["boundary"]) == 3, "the box has three dimensions")
    return si


def link_lengths(positions, chains):
    """All distances of neighbours, no image taken: positions are unwrapped."""
    return np.concatenate([np.linalg.norm(np.diff(positions[first:first + count].astype(float), axis=0), axis=1) for first, count in chains])


def check_with_h5py(path, arguments):
    with h5py.File(path, "r") as file:
        check_header(file)
        si = check_elements(file, arguments)
        position = file["particles/trajectory/position/value"][:]
        check(arguments.sites in (None, position.shape[1]), f"{position.shape[1]} sites")
        check(arguments.frames in (None, position.shape[0]), f"{position.shape[0]} frames")
        chains = list(zip(file["catena/chains/first"][:], file["catena/chains/count"][:]))
        check(sum(count for _, count in chains) == position.shape[1], "the chains hold all sites")
        worst = 0.0
        if arguments.link:
            worst = max(np.abs(link_lengths(frame, chains) - arguments.link).max() for frame in position)
            check(worst < 1e-8, f"a link deviates by {worst:.3g} in float64")
        box = file["particles/trajectory/box/edges/value"][0] if "edges" in file["particles/trajectory/box"] else None
        return {"si": si, "positions": position, "times": file["particles/trajectory/position/time"][:], "chains": chains, "worst": worst,
                "box": box, "velocities": "velocity" in file["particles/trajectory"]}


def check_with_mdanalysis(topology, trajectory, seen, arguments):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", category=DeprecationWarning)
        universe = MDAnalysis.Universe(topology, trajectory)
    frames, count = seen["positions"].shape[:2]
    check(len(universe.atoms) == count and len(universe.trajectory) == frames, "MDAnalysis sees other sites or frames")
    check(len(universe.residues) == count, f"MDAnalysis sees {len(universe.residues)} residues for {count} sites")
    check(set(universe.atoms.names) == {"CA"} and np.all(universe.atoms.masses > 0), "names or masses are wrong")
    if count < 100000:
        check(len(universe.bonds) >= sum(max(0, n - 1) for _, n in seen["chains"]), "bonds are missing")
    worst = 0.0
    for frame, step in enumerate(universe.trajectory):
        check(np.isclose(step.time, seen["times"][frame], rtol=1e-6), f"frame {frame} is at {step.time} ps")
        nm = step.positions / ANGSTROM_PER_NM
        check(np.allclose(nm, seen["positions"][frame], rtol=1e-6, atol=1e-6), f"positions of frame {frame} differ")
        check(step.has_velocities == seen["velocities"], "velocities")
        if seen["box"] is None:
            check(step.dimensions is None, "a box where there is none")
        else:
            check(np.allclose(step.dimensions, [*(ANGSTROM_PER_NM * seen["box"]), 90, 90, 90]), "the box differs")
        if arguments.link:
            worst = max(worst, np.abs(link_lengths(nm, seen["chains"]) - arguments.link).max())
    check(worst < 1e-5, f"a link deviates by {worst:.3g} nm through MDAnalysis")
    bonded = os.path.join(arguments.folder, "topology.psf")
    if os.path.isfile(bonded):
        with h5py.File(trajectory, "r") as file:
            masses = file["particles/trajectory/mass"][:]
        check(np.allclose(MDAnalysis.Universe(bonded, trajectory).atoms.masses, masses, rtol=1e-9), "the masses differ")
    alone = MDAnalysis.Universe(topology)
    check(np.allclose(alone.atoms.positions, ANGSTROM_PER_NM * seen["positions"][0], atol=1e-3), "the topology shows another first frame")
    return worst


def main():
    arguments = parse_arguments()
    topology, trajectory = (os.path.join(arguments.folder, name) for name in ("topology.pdb", "trajectory.h5md"))
    for path in (topology, trajectory):
        check(os.path.isfile(path), f"no file {path}")
    seen = check_with_h5py(trajectory, arguments)
    line = f"{seen['positions'].shape[0]} frames of {seen['positions'].shape[1]} sites; largest deviation of a link {seen['worst']:.2g} (float64)"
    if seen["si"]:
        print(f"{line}; in metres, which MDAnalysis does not read")
        check(len(MDAnalysis.Universe(topology).atoms) == seen["positions"].shape[1], "MDAnalysis sees other sites in the topology")
    else:
        print(f"{line}, {check_with_mdanalysis(topology, trajectory, seen, arguments):.2g} nm (MDAnalysis, float32)")


if __name__ == "__main__":
    main()
