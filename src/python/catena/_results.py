"""What an analysis found: numbers, curves and contact maps."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from catena._frames import Frames
from catena.errors import InputError


@dataclasses.dataclass(frozen=True)
class Quantity:
    """A number of one kind of chains, or of the whole system."""

    name: str
    #: Kind of chains; empty for the whole system.
    kind: str
    unit: str
    mean: float
    #: Standard error by blocking; NaN if there are too few frames.
    error: float
    #: False if longer blocks might give a larger error: sample longer.
    plateau: bool
    #: Error from the scatter of copies, which it takes as independent; NaN for one copy.
    between: float
    #: What the number was computed from, or why there is none.
    basis: str
    #: Range of separations and prefactor R_0 of a scaling exponent's fit R = R_0 s^nu.
    fit: tuple[float, float]
    prefactor: float

    def __str__(self) -> str:
        if not np.isfinite(self.mean):
            return f"- ({self.basis})"
        error = f" +- {'' if self.plateau else 'at least '}{self.error:.2g}" if np.isfinite(self.error) else ""
        return f"{self.mean:.5g}{error} {self.unit}".rstrip()


@dataclasses.dataclass(frozen=True)
class Curve:
    """A function of one variable, of one kind of chains or of the whole system."""

    name: str
    kind: str
    variable: str
    variable_unit: str
    unit: str
    #: The variable (n_points,).
    x: np.ndarray
    #: Means over frames and copies (n_points,).
    values: np.ndarray
    #: Standard errors by blocking (n_points,).
    errors: np.ndarray
    #: Errors from the scatter of copies (n_points,).
    between: np.ndarray


@dataclasses.dataclass(frozen=True)
class ContactMap:
    """Probabilities that beads of two parts of chains are in contact."""

    #: True for beads of one chain, False for those of two chains.
    within: bool
    #: Kinds of rows and columns.
    kinds: tuple[str, str]
    #: Probabilities and their errors (n_rows, n_columns).
    mean: np.ndarray
    error: np.ndarray
    #: Number of consecutive beads that share a row.
    sites_a_row: int


class Analysis:
    """Numbers, curves and contact maps of frames.

    ``found["radius_of_gyration"]`` is a number of the only kind of chains, ``found["radius_of_gyration", "asyn"]`` that
    of a named kind. ``str(found)`` is a table.
    """

    def __init__(
        self,
        quantities: list[Quantity],
        curves: list[Curve],
        maps: list[ContactMap],
        found: dict[str, Any],
        times: np.ndarray | None,
        notes: list[str],
    ) -> None:
        self.quantities = quantities
        self.curves = curves
        self.maps = maps
        #: Name, number of beads and number of copies of each kind of chains.
        self.kinds: list[tuple[str, int, int]] = found["kinds"]
        #: Number of frames analysed, and their times (n_frames,), ps (s in SI); None if there are none.
        self.n_frames: int = found["frames"]
        self.times = None if times is None else times[len(times) - self.n_frames :]
        self.length_unit: str = found["length_unit"]
        self.time_unit: str = found["time_unit"]
        #: Longest distance of a contact; 0 if there are no maps.
        self.cutoff: float = found["cutoff"]
        #: What was assumed or left out.
        self.notes = notes
        self._series = found["series"]

    def __getitem__(self, key: str | tuple[str, str]) -> Quantity:
        name, kind = (key, None) if isinstance(key, str) else key
        return _only(self.quantities, "number", name, kind)

    def __repr__(self) -> str:
        return f"<catena.Analysis: {self.n_frames} frames, {len(self.quantities)} numbers, {len(self.curves)} curves, {len(self.maps)} maps>"

    def __str__(self) -> str:
        rows = [(each.name, each.kind, str(each)) for each in self.quantities]
        widths = [max((len(row[k]) for row in rows), default=0) for k in range(2)]
        lines = [f"{name:{widths[0]}}  {kind:{widths[1]}}  {text}" for name, kind, text in rows]
        return "\n".join(lines + [f"note: {note}" for note in self.notes])

    def curve(self, name: str, kind: str | None = None) -> Curve:
        """Returns a curve by its name, such as ``internal_distances``. Raises InputError if there is none, or several."""
        return _only(self.curves, "curve", name, kind)

    def series(self, name: str, kind: str | None = None) -> np.ndarray:
        """Returns a number such as ``radius_of_gyration`` in each frame, of each copy (n_frames, n_copies)."""
        found = [each for each in self._series if each["name"] == name and kind in (None, each["kind"])]
        if len(found) != 1:
            names = ", ".join(f"{each['name']} of {each['kind']}" for each in self._series) or "none"
            raise InputError(f"there are {len(found)} time series of {name!r} (Analysis.series): there are {names}")
        return np.array(found[0]["values"]).reshape(self.n_frames, found[0]["copies"])

    def contact_map(self, within: bool = True, kinds: tuple[str, str] | None = None) -> ContactMap:
        """Returns a contact map within chains or between them. Raises InputError if there is none, or several."""
        found = [each for each in self.maps if each.within == within and kinds in (None, each.kinds)]
        if len(found) != 1:
            names = ", ".join(sorted({" and ".join(each.kinds) for each in self.maps if each.within == within})) or "none"
            where = "within chains" if within else "between chains"
            what = f"there are {len(found)} contact maps {where}" if found else f"there is no contact map {where}"
            raise InputError(f"{what} (contact_map): {'name two kinds of ' + names if names != 'none' else 'analyse several chains, with a cutoff' if not within else 'analyse with a cutoff'}")
        return found[0]


def analysis_of(found: dict[str, Any], frames: Frames, in_python: Callable[[str], str]) -> Analysis:
    """Returns what the C++ part found, without displacements if the frames have no times."""
    moves = ("displacement", "diffusion")
    quantities = [
        Quantity(**{**each, "basis": in_python(each["basis"])})
        for each in found["quantities"]
        if frames.times is not None or each["name"] not in moves
    ]
    curves = [_curve_of(each) for each in found["curves"] if frames.times is not None or each["name"] not in moves]
    maps = [_map_of(each, found["sites_a_row"]) for each in found["maps"]]
    notes = [in_python(note).replace("; see density.csv", "; see the curve `density`") for note in found["notes"]]
    if frames.times is None:
        notes = [note for note in notes if not note.startswith("displacements")]
    return Analysis(quantities, curves, maps, found, frames.times, notes + frames.notes)


def _curve_of(found: dict[str, Any]) -> Curve:
    arrays = {name: np.array(found[name]) for name in ("x", "values", "errors", "between")}
    return Curve(**{**found, **arrays})


def _map_of(found: dict[str, Any], sites_a_row: int) -> ContactMap:
    shape = found["rows"], found["columns"]
    mean, error = (np.array(found[name]).reshape(shape) for name in ("mean", "error"))
    return ContactMap(found["within"], (found["first"], found["second"]), mean, error, sites_a_row)


def _only(all_: list[Any], what: str, name: str, kind: str | None) -> Any:
    found = [each for each in all_ if each.name == name and kind in (None, each.kind)]
    if len(found) == 1:
        return found[0]
    if not found:
        kinds = sorted({each.kind for each in all_ if each.name == name})
        if kinds:
            raise InputError(f"there is no {what} {name!r} of {kind} (Analysis): there are those of {', '.join(each or 'all' for each in kinds)}")
        known = ", ".join(sorted({each.name for each in all_ if kind in (None, each.kind)})) or "none"
        raise InputError(f"there is no {what} {name!r}{f' of {kind}' if kind else ''} (Analysis): there are {known}")
    raise InputError(f"there is a {what} {name!r} for each kind of chains (Analysis): name one of {', '.join(each.kind or 'all' for each in found)}")
