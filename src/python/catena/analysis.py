"""Sizes of chains with their errors, by the formulas of ``catena analyse``.

Positions are arrays of shape (n_frames, n_beads, 3) or MDAnalysis atom groups. Of an atom group the whole trajectory is
read, and lengths in angstrom become nm.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from catena import _core
from catena.errors import InputError


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
    """Returns the radius of gyration, weighted by mass.

    ``masses`` has shape (n_beads,). The default is the atom group's masses, or equal masses for an array. The result
    has the array's unit of length, or nm for an atom group.
    """
    frames = _frames_of(positions)
    if masses is None:
        masses = positions.masses if _is_group(positions) else np.ones(frames.shape[1])
    return _estimate_of(_core.radius_of_gyration(frames, _doubles(masses, 1, "masses")))


def end_to_end_distance(positions: Any) -> Estimate:
    """Returns the distance between the first and the last bead."""
    return _estimate_of(_core.end_to_end_distance(_frames_of(positions)))


def mean(values: Any) -> Estimate:
    """Returns the mean of a time series (n_frames,) with its standard error by blocking."""
    return _estimate_of(_doubles(values, 1, "values"))


def _estimate_of(values: np.ndarray) -> Estimate:
    found, error, plateau, _ = _core.estimate(values.reshape(-1, 1))
    return Estimate(found, error, plateau, values)


def _is_group(positions: Any) -> bool:
    return hasattr(positions, "universe") and hasattr(positions, "positions")


def _frames_of(positions: Any) -> np.ndarray:
    if not _is_group(positions):
        if np.ndim(positions) == 2:
            raise InputError("the positions have 2 dimensions (positions): give (n_frames, n_beads, 3); a frame x is x[None]")
        return _doubles(positions, 3, "positions")
    trajectory = positions.universe.trajectory
    frames = np.array([positions.positions for _ in trajectory], dtype=float) / 10
    return _doubles(frames, 3, "positions")


def _doubles(values: Any, dimensions: int, name: str) -> np.ndarray:
    array = np.ascontiguousarray(values, dtype=float)
    if array.ndim != dimensions:
        raise InputError(f"the {name} have {array.ndim} dimensions ({name}): give an array with {dimensions}")
    if not np.isfinite(array).all():
        raise InputError(f"a number is not finite ({name}): leave out such frames")
    return array
