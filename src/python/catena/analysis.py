"""Numbers from conformations with their errors, computed by ``catena analyse``'s own code.

Positions are arrays of shape (n_frames, n_beads, 3), MDAnalysis atom groups or a ``Record`` of a simulation. Of an atom
group the whole trajectory is read; lengths in angstrom become nm.
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import numpy as np

from catena import _core
from catena._frames import Frames, atoms_of, doubles, frames_of, require_one_chain
from catena._frames import positions_of as _positions_of
from catena._results import Analysis, ContactMap, Curve, Quantity, analysis_of
from catena.errors import InputError

__all__ = [
    "Analysis",
    "ContactMap",
    "Curve",
    "Estimate",
    "Quantity",
    "analyse",
    "density_profile",
    "end_to_end_distance",
    "internal_distances",
    "mean",
    "persistence_length",
    "radius_of_gyration",
    "scaling_exponent",
]


class Estimate(NamedTuple):
    """Mean of a quantity over frames, with its standard error by blocking."""

    mean: float
    #: Standard error by blocking; NaN if there are too few frames.
    error: float
    #: False if longer blocks might give a larger error: sample longer.
    plateau: bool
    #: The quantity in each frame (n_frames,).
    values: np.ndarray


def radius_of_gyration(positions: Any, masses: Any = None) -> Estimate:
    """Returns the radius of gyration of one chain, weighted by mass.

    ``masses`` has shape (n_beads,). The default is the masses of the atom group or ``Record``, or equal masses for an
    array. The result has the array's unit of length, or nm for an atom group. Records and atom groups of several
    chains are refused: ``analyse`` has their numbers.
    """
    positions = atoms_of(positions)
    require_one_chain(positions, "radius_of_gyration")
    frames = _positions_of(positions)
    if masses is None:
        masses = positions.masses if hasattr(positions, "masses") else np.ones(frames.shape[1])
    return _estimate_of(_core.radius_of_gyration(frames, doubles(masses, 1, "masses")))


def end_to_end_distance(positions: Any) -> Estimate:
    """Returns the distance between the first and the last bead of one chain, as ``radius_of_gyration`` does."""
    require_one_chain(positions, "end_to_end_distance")
    return _estimate_of(_core.end_to_end_distance(_positions_of(positions)))


def mean(values: Any) -> Estimate:
    """Returns the mean of a time series (n_frames,) with its standard error by blocking."""
    return _estimate_of(doubles(values, 1, "values"))


def analyse(
    positions: Any,
    chains: Any = None,
    *,
    masses: Any = None,
    residues: Any = None,
    box: Any = None,
    times: Any = None,
    ring: bool = False,
    discard: float = 0.0,
    cutoff: float | None = None,
    fit: tuple[float, float] | None = None,
    slab: str | None = "auto",
    bins: int = 200,
) -> Analysis:
    """Computes what ``catena analyse`` does: sizes, internal distances, bonds, contacts, densities and diffusion.

    ``positions`` (n_frames, n_beads, 3) in nm, unwrapped, an atom group, or a ``Record``, which knows its chains,
    masses and box. For the others:

    - ``chains`` is the number of beads of each chain, as a list, or of all, as a number. By default an array is one
      chain, and each segment of an atom group is one. Equal chains are copies of one kind.
    - ``masses`` (n_beads,) in amu; an atom group has its own; equal for an array.
    - ``residues`` (n_beads,) are names that tell chains apart.
    - ``box`` (3,) or (n_frames, 3) are the edges of a rectangular periodic box, nm; an atom group has its own.
    - ``times`` (n_frames,) in ps. Without them an array has no diffusion.
    - ``ring``: every chain is closed.

    ``discard`` is the part of the frames to leave out at the start. ``cutoff`` is the longest distance of a contact,
    1 nm by default, 0 for none. ``fit`` is the range of separations of the scaling exponent. ``slab`` is the axis of
    the density profile, ``"x"``, ``"y"`` or ``"z"``; ``"auto"`` takes the box's longest edge if it is 1.5 times the
    others, and None leaves the profile out.
    """
    frames = frames_of(positions, chains, masses=masses, residues=residues, box=box, times=times, ring=ring)
    return _analysis_of_frames(frames, discard=discard, cutoff=cutoff, fit=fit, slab=slab, bins=bins)


def internal_distances(positions: Any, chains: Any = None, **options: Any) -> Curve:
    """Returns R(s) = sqrt(mean r^2) of beads s places apart, with errors. Options are those of ``analyse``."""
    return _chain_analysis(positions, chains, options).curve("internal_distances")


def scaling_exponent(positions: Any, chains: Any = None, **options: Any) -> Quantity:
    """Returns nu of R = R_0 s^nu, fitted to the internal distances, with its error, range and R_0.

    Options are those of ``analyse``; ``fit=(least, most)`` chooses the separations.
    """
    return _chain_analysis(positions, chains, options)["scaling_exponent"]


def persistence_length(positions: Any, chains: Any = None, **options: Any) -> Quantity:
    """Returns the persistence length, fitted to the correlation of bonds. Options are those of ``analyse``."""
    return _chain_analysis(positions, chains, options)["persistence_length"]


def density_profile(positions: Any, chains: Any = None, *, slab: str = "z", **options: Any) -> Curve:
    """Returns the density of all beads across a slab, mg/ml, with its middle moved to 0.

    Options are those of ``analyse``. ``analyse(...)["dense_concentration"]`` and ``["dilute_concentration"]`` are the
    densities of the two phases.
    """
    found = analyse(positions, chains, **{"cutoff": 0.0, **options, "slab": slab})
    kinds = [curve.kind for curve in found.curves if curve.name == "density"]
    return found.curve("density", "all" if "all" in kinds else None)


def _chain_analysis(positions: Any, chains: Any, options: dict[str, Any]) -> Analysis:
    return analyse(positions, chains, **{"cutoff": 0.0, "slab": None, **options})


def _analysis_of_frames(
    frames: Frames, *, discard: float, cutoff: float | None, fit: tuple[float, float] | None, slab: str | None, bins: int
) -> Analysis:
    axes = {None: None, "auto": None, "x": 0, "y": 1, "z": 2}
    if slab not in axes:
        raise InputError(f"the axis of the slab is {slab!r} (slab): give 'x', 'y', 'z', 'auto' or None")
    if not 0 <= discard < 1:
        raise InputError(f"the part to leave out is {discard} (discard): give 0 or more, and less than 1")
    if bins < 2 or bins % 2:
        raise InputError(f"the number of bins is {bins} (bins): give an even number")
    if cutoff is not None and not 0 <= cutoff < np.inf:
        raise InputError(f"the cutoff is {cutoff} (cutoff): give a distance, or 0 for no contacts")
    steps = list(range(len(frames.positions)))
    times = steps if frames.times is None else frames.times.tolist()
    try:
        found = _core.analyse(
            frames.topology, frames.positions, frames.edges, steps, times, discard, cutoff, fit, axes[slab], slab == "auto", bins
        )
    except InputError as error:
        raise InputError(_in_python(str(error))) from None
    return analysis_of(found, frames, _in_python)


def _in_python(message: str) -> str:
    """Returns a message of the program with its options as the arguments that they are here."""
    return re.sub(r"--slab ([xyz])", r"slab='\1'", message).replace("--fit MIN,MAX", "fit=(least, most)").replace("leave --slab out", "give a box, or leave slab out").replace("--", "")


def _estimate_of(values: np.ndarray) -> Estimate:
    found, error, plateau, _ = _core.estimate(values.reshape(-1, 1))
    return Estimate(found, error, plateau, values)
