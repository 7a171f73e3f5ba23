"""Positions of frames, with their chains: arrays, atom groups of MDAnalysis, records of simulations."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from catena import _core
from catena.errors import InputError


@dataclasses.dataclass
class Frames:
    """Frames to be analysed."""

    topology: _core.Topology
    positions: np.ndarray
    edges: np.ndarray | None
    times: np.ndarray | None
    #: What was assumed or left out.
    notes: list[str]


def frames_of(
    positions: Any, chains: Any, *, masses: Any, residues: Any, box: Any, times: Any, ring: bool
) -> Frames:
    """Returns frames of an array, an atom group or a ``Record``. Raises InputError for what does not fit."""
    positions = atoms_of(positions)
    if is_record(positions):
        given = [name for name, value in (("chains", chains), ("masses", masses), ("residues", residues), ("box", box), ("times", times)) if value is not None]
        if given or ring:
            raise InputError(f"a record knows its chains, masses and box ({(given or ['ring'])[0]}): leave this argument out")
        edges = None if positions.topology.box is None else np.array([positions.topology.box])
        return Frames(positions.topology, positions_of(positions), edges, doubles(positions.times, 1, "times"), [])
    x = positions_of(positions)
    n_frames, n_beads = x.shape[:2]
    notes: list[str] = []
    if is_group(positions):
        if chains is None:
            chains = _segments_of(positions, notes)
        masses, residues, box, times = _of_group(positions, masses, residues, box, times)
    masses = np.ones(n_beads) if masses is None else _row(masses, n_beads, "masses", "beads")
    if not (masses > 0).all():
        raise InputError("a mass is not positive (masses): leave out sites without mass")
    names = ["UNK"] * n_beads if residues is None else [str(name) for name in residues]
    if len(names) != n_beads:
        raise InputError(f"there are {len(names)} residues and {n_beads} beads (residues): give a name for each bead")
    edges = None if box is None else _edges_of(box, n_frames)
    counts = _counts_of(chains, n_beads)
    parents = _parents_of(positions, counts, notes) if is_group(positions) else []
    if times is not None:
        times = _row(times, n_frames, "times", "frames")
    _require_whole(x, counts, edges)
    topology = _core.Topology.of(
        [(f"chain-{number + 1}", count) for number, count in enumerate(counts)], ring, masses.tolist(), names, None if edges is None else tuple(edges[0]), False, parents
    )
    return Frames(topology, x, edges, _unless_wrapped(x, counts, edges, times, notes), notes)


def is_record(positions: Any) -> bool:
    """True for a ``Record``."""
    return hasattr(positions, "topology") and isinstance(positions.topology, _core.Topology)


def atoms_of(positions: Any) -> Any:
    """Returns the atoms of a universe of MDAnalysis, and anything else as it is."""
    return positions.atoms if hasattr(positions, "atoms") and hasattr(positions, "trajectory") else positions


def require_one_chain(positions: Any, name: str) -> None:
    """Raises InputError for records and atom groups of several chains, of which ``name`` is no number."""
    positions = atoms_of(positions)
    chains = len(positions.topology.chains) if is_record(positions) else len(positions.segments) if is_group(positions) else 1
    if chains > 1:
        raise InputError(f"the positions are those of {chains} chains ({name}): take analyse(...)[{name!r}], or the positions of one chain")


def is_group(positions: Any) -> bool:
    """True for an atom group of MDAnalysis."""
    return hasattr(positions, "universe") and hasattr(positions, "positions")


def positions_of(positions: Any) -> np.ndarray:
    """Returns positions (n_frames, n_beads, 3) in nm. Raises InputError for other shapes and numbers that are not finite."""
    positions = atoms_of(positions)
    if is_group(positions):
        if not len(positions):
            raise InputError("the atom group is empty (positions): select atoms")
        trajectory = positions.universe.trajectory
        return doubles(np.array([positions.positions for _ in trajectory], dtype=float) / 10, 3, "positions")
    if is_record(positions):
        if not len(positions):
            raise InputError("the record has no frames (record): take steps of its simulation first")
        positions = positions.positions
    if isinstance(positions, np.ndarray) and positions.ndim == 2:
        raise InputError("the positions have 2 dimensions (positions): give (n_frames, n_beads, 3); a frame x is x[None]")
    return doubles(positions, 3, "positions")


def doubles(values: Any, dimensions: int, name: str) -> np.ndarray:
    """Returns an array of doubles. Raises InputError for other dimensions and numbers that are not finite."""
    try:
        array = np.ascontiguousarray(values, dtype=float)
    except (TypeError, ValueError):
        kind = "an array of numbers, an atom group or a Record" if name == "positions" else "an array of numbers"
        raise InputError(f"the {name} are of the type {type(values).__name__} ({name}): give {kind}") from None
    if array.ndim != dimensions:
        raise InputError(f"the {name} have {array.ndim} dimensions ({name}): give an array with {dimensions}")
    if not np.isfinite(array).all():
        raise InputError(f"a number is not finite ({name}): leave out such frames")
    return array


def _segments_of(group: Any, notes: list[str]) -> list[int]:
    """Returns the number of atoms of each segment. Notes bonded molecules that are no segments."""
    changes = np.flatnonzero(np.diff(group.segindices)) + 1
    counts = np.diff([0, *changes, len(group)]).tolist()
    if len(counts) != len(group.segments):
        raise InputError("the atoms of a segment do not follow each other (positions): sort the atom group, or give chains")
    molecules = len(np.unique(group.fragindices)) if hasattr(group, "bonds") and len(group.bonds) else len(counts)
    if molecules != len(counts):
        notes.append(f"each of {len(counts)} segments is taken as a chain, but bonds make {molecules} molecules: give chains if those are meant")
    return counts


def _of_group(group: Any, masses: Any, residues: Any, box: Any, times: Any) -> tuple[Any, ...]:
    """Completes what is not given from an atom group: masses, residue names, box, times."""
    if masses is None and hasattr(group, "masses"):
        masses = group.masses
    if residues is None and hasattr(group, "resnames"):
        residues = group.resnames
    cells = [(frame.time, frame.dimensions) for frame in group.universe.trajectory]
    if box is None and all(cell is not None and cell[:3].all() for _, cell in cells):
        if any(not np.allclose(cell[3:], 90, atol=1e-3) for _, cell in cells):
            raise InputError("the box is not rectangular (positions): such boxes are not supported; give box=None after removing the dimensions")
        box = np.array([cell[:3] for _, cell in cells], dtype=float) / 10
    if times is None:
        times = [time for time, _ in cells]
    return masses, residues, box, times


def _parents_of(group: Any, counts: list[int], notes: list[str]) -> list[list[int]]:
    """Returns the bead on which each bead of a branched chain hangs, by the bonds of an atom group; nothing for other chains.

    Notes chains whose bonds do not tell.
    """
    bonds = getattr(group, "bonds", None) if hasattr(group.universe, "bonds") else None
    if bonds is None or not len(bonds):
        return []
    place = {int(index): number for number, index in enumerate(group.indices)}
    chain_of = np.repeat(np.arange(len(counts)), counts)
    lower: list[list[int]] = [[] for _ in chain_of]
    for a, b in bonds.indices:
        first, last = sorted((place.get(int(a), -1), place.get(int(b), -1)))
        if first >= 0 and chain_of[first] == chain_of[last]:
            lower[last].append(first)
    parents: list[list[int]] = []
    for number, (begin, count) in enumerate(zip(np.cumsum([0, *counts]).tolist(), counts)):
        on = [max(each) - begin if each else -1 for each in lower[begin : begin + count]]
        is_tree = -1 not in on[1:]
        parents.append(on if is_tree and on[1:] != list(range(count - 1)) else [])
        if not is_tree and any(each >= 0 for each in on) and len(notes) < 10:
            notes.append(f"the bonds of chain {number + 1} do not join its atoms one after the other: separations and bonds follow the order of the atoms")
    return parents


def _row(values: Any, count: int, name: str, of: str) -> np.ndarray:
    array = doubles(values, 1, name)
    if len(array) != count:
        raise InputError(f"there are {len(array)} {name} and {count} {of} ({name}): give one for each")
    return array


def _edges_of(box: Any, n_frames: int) -> np.ndarray:
    edges = np.atleast_2d(np.asarray(box, dtype=float))
    if edges.ndim != 2 or edges.shape not in ((1, 3), (n_frames, 3)) or not (edges > 0).all() or not np.isfinite(edges).all():
        raise InputError("the box is not three positive edges (box): give (3,) or (n_frames, 3), nm")
    return np.ascontiguousarray(edges)


def _counts_of(chains: Any, n_beads: int) -> list[int]:
    """Returns the number of beads of each chain."""
    if chains is None:
        return [n_beads]
    if np.ndim(chains) == 0:
        count = int(chains)
        if count < 1 or count != chains or n_beads % count:
            raise InputError(f"{n_beads} beads are no whole number of chains of {chains} (chains): give the number of beads of each chain")
        return [count] * (n_beads // count)
    counts = [int(count) for count in chains]
    if min(counts, default=0) < 1 or sum(counts) != n_beads:
        raise InputError(f"the chains have {sum(counts)} beads and the positions {n_beads} (chains): give the number of beads of each chain")
    return counts


def _require_whole(x: np.ndarray, counts: list[int], edges: np.ndarray | None) -> None:
    """Raises InputError if chains are cut at the faces of the box."""
    if edges is None:
        return
    joined = np.delete(np.arange(x.shape[1] - 1), np.cumsum(counts)[:-1] - 1)
    for number, frame in enumerate(x):
        if (np.abs(frame[joined + 1] - frame[joined]) > edges[number if len(edges) > 1 else 0] / 2).any():
            raise InputError(f"a chain is cut at a face of the box in frame {number} (positions): unwrap the trajectory first")


def _unless_wrapped(x: np.ndarray, counts: list[int], edges: np.ndarray | None, times: np.ndarray | None, notes: list[str]) -> np.ndarray | None:
    """Returns the times, or None with a note if there are none or chains jump by more than half the box: no diffusion then."""
    if times is None:
        notes.append("displacements and diffusion are left out: give times, ps")
        return None
    firsts = x[:, np.concatenate(([0], np.cumsum(counts)[:-1])).astype(int)]
    if edges is not None and len(x) > 1 and (np.abs(np.diff(firsts, axis=0)) > edges.min(axis=0) / 2).any():
        notes.append("displacements and diffusion are left out: chains jump by more than half of the box between frames, as wrapped ones do")
        return None
    return times
