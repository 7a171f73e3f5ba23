"""Pictures of records and analyses, drawn by matplotlib (``pip install matplotlib``).

Each function draws into ``axes``, or into a new figure, and returns the axes. ``axes.figure.savefig("rg.png")`` writes
the picture.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from catena import analysis
from catena._results import Analysis, Curve
from catena.analysis import Estimate, mean
from catena.errors import InputError
from catena.record import Record

_COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"]
_MEAN = "#1b2733"


def radius_of_gyration(source: Any, kind: str | None = None, *, times: Any = None, discard: float = 0.0, axes: Any = None) -> Any:
    """Draws the radius of gyration against time, with its mean and standard error.

    ``source`` is a ``Record``, an ``Analysis``, positions (n_frames, n_beads, 3) of one chain, or an atom group. Of
    several copies the mean over copies is drawn. ``discard`` is the part of the frames that the mean leaves out.
    """
    if isinstance(source, Record):
        source = analysis.analyse(source, cutoff=0.0, slab=None)
    elif not isinstance(source, (Analysis, Estimate)):
        source = analysis.radius_of_gyration(source)
    if isinstance(source, Estimate):
        return _series(source.values, times, "radius of gyration [nm]", "ps", discard, axes)
    values = source.series("radius_of_gyration", kind).mean(axis=1)
    return _series(values, source.times if times is None else times, f"radius of gyration [{source.length_unit}]", source.time_unit, discard, axes)


def temperature(record: Record, *, discard: float = 0.0, axes: Any = None) -> Any:
    """Draws the temperature of a ``Record`` against time, with its mean and standard error."""
    values = _record(record, "temperature").temperatures
    if np.isnan(values).any():
        raise InputError("the simulation has no temperature (record): see State.temperature")
    return _series(values, record.times, "temperature [K]", _time_unit(record), discard, axes)


def energy(record: Record, *, axes: Any = None) -> Any:
    """Draws total, kinetic and potential energy of a ``Record`` against time."""
    _record(record, "energy")
    axes = _axes(axes)
    for name, colour in zip(("total", "kinetic", "potential"), [_MEAN, *_COLOURS]):
        axes.plot(record.times, getattr(record, "total_energies" if name == "total" else f"{name}_energies"), color=colour, linewidth=1.1, label=name)
    axes.set_xlabel(f"time [{_time_unit(record)}]")
    axes.set_ylabel(f"energy [{'J' if record.topology.si else 'kJ/mol'}]")
    axes.legend(frameon=False, fontsize="small")
    return axes


def distribution(source: Any, kind: str | None = None, *, axes: Any = None) -> Any:
    """Draws the distribution of the radius of gyration with its errors. ``source`` is an ``Analysis`` or what ``analyse`` takes."""
    curve = _analysis(source).curve("radius_distribution", kind)
    axes = _curve(curve, axes, drawstyle="steps-mid")
    axes.set_xlabel(f"radius of gyration [{curve.variable_unit}]")
    axes.set_ylabel("probability density")
    return axes


def internal_distances(source: Any, kind: str | None = None, *, axes: Any = None) -> Any:
    """Draws R(s) against the separation s, and the fit R = R_0 s^nu with its exponent.

    ``source`` is an ``Analysis`` or what ``analyse`` takes.
    """
    found = _analysis(source)
    curve = found.curve("internal_distances", kind)
    exponent = found["scaling_exponent", curve.kind]
    axes = _curve(curve, axes)
    if np.isfinite(exponent.mean):
        s = np.geomspace(*exponent.fit, 50)
        error = f" ± {'' if exponent.plateau else 'at least '}{exponent.error:.2g}" if np.isfinite(exponent.error) else ""
        label = f"$\\nu$ = {exponent.mean:.3f}{error}"
        axes.plot(s, exponent.prefactor * s**exponent.mean, color=_COLOURS[1], linestyle="--", linewidth=1.3, label=label)
        axes.legend(frameon=False, fontsize="small")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("separation [sites]")
    axes.set_ylabel(f"R(s) [{curve.unit}]")
    return axes


def density(source: Any, *, axes: Any = None) -> Any:
    """Draws the density across a slab with its errors, by kind of chains. ``source`` is an ``Analysis`` or what ``analyse`` takes."""
    curves = [curve for curve in _analysis(source).curves if curve.name == "density"]
    if not curves:
        raise InputError("the analysis has no density profile (slab): give analyse(..., slab='z') and a box")
    axes = _axes(axes)
    for number, curve in enumerate(curves[: len(_COLOURS)]):
        _curve(curve, axes, colour=_COLOURS[number], label=curve.kind if len(curves) > 1 else None)
    if len(curves) > 1:
        axes.legend(frameon=False, fontsize="small")
    axes.set_xlabel(f"distance from the middle [{curves[0].variable_unit}]")
    axes.set_ylabel(f"density [{curves[0].unit}]")
    return axes


def contact_map(source: Any, within: bool = True, kinds: tuple[str, str] | None = None, *, axes: Any = None) -> Any:
    """Draws the probabilities of contacts within chains, or between them. ``source`` is an ``Analysis`` or what ``analyse`` takes."""
    from matplotlib.colors import LogNorm

    found = _analysis(source, contacts=True).contact_map(within, kinds)
    axes = _axes(axes)
    shown = np.where(found.mean > 0, found.mean, np.nan)
    norm = LogNorm(max(float(np.nanmin(shown)), 1e-5), float(np.nanmax(shown))) if np.isfinite(shown).any() else None
    edge = found.sites_a_row
    extent = (0.5, edge * shown.shape[1] + 0.5, 0.5, edge * shown.shape[0] + 0.5)
    image = axes.imshow(shown, origin="lower", norm=norm, extent=extent)
    axes.figure.colorbar(image, ax=axes, label="probability of contact")
    axes.set_xlabel(f"site{'' if within else f' of {found.kinds[1]}'}")
    axes.set_ylabel(f"site{'' if within else f' of {found.kinds[0]}'}")
    return axes


def _analysis(source: Any, contacts: bool = False) -> Analysis:
    if isinstance(source, Analysis):
        return source
    return analysis.analyse(source) if contacts else analysis.analyse(source, cutoff=0.0)


def _record(record: Any, what: str) -> Record:
    if not isinstance(record, Record):
        raise InputError(f"a {type(record).__name__} has no {what} over time (record): give a catena.Record of a simulation")
    if not len(record):
        raise InputError("the record has no frames (record): take steps of its simulation first")
    return record


def _axes(axes: Any) -> Any:
    try:
        from matplotlib import pyplot
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != "matplotlib":
            raise
        raise ImportError("pictures need matplotlib (catena.plot): pip install matplotlib") from None
    return pyplot.subplots(figsize=(5, 3.4), layout="constrained")[1] if axes is None else axes


def _time_unit(record: Record) -> str:
    return "s" if record.topology.si else "ps"


def _series(values: np.ndarray, times: Any, label: str, time_unit: str, discard: float, axes: Any) -> Any:
    """Draws a time series, and mean and error of what ``discard`` leaves."""
    if not 0 <= discard < 1:
        raise InputError(f"the part to leave out is {discard} (discard): give 0 or more, and less than 1")
    axes = _axes(axes)
    x = np.arange(len(values)) if times is None else np.asarray(times, dtype=float)
    if len(x) != len(values):
        raise InputError(f"there are {len(x)} times and {len(values)} frames (times): give a time for each frame")
    axes.plot(x, values, color=_COLOURS[0], linewidth=0.9)
    first = int(discard * len(values))
    found = mean(values[first:])
    text = f"{found.mean:.4g}"
    if np.isfinite(found.error):
        text += f" ± {'' if found.plateau else 'at least '}{found.error:.2g}"
        axes.fill_between(x[first:], found.mean - found.error, found.mean + found.error, color=_MEAN, alpha=0.25, linewidth=0)
    axes.plot(x[first:], np.full(len(x) - first, found.mean), color=_MEAN, linewidth=1.3, label=text)
    axes.set_xlabel("frame" if times is None else f"time [{time_unit}]")
    axes.set_ylabel(label)
    axes.legend(frameon=False, fontsize="small")
    return axes


def _curve(curve: Curve, axes: Any, *, colour: str = _COLOURS[0], label: str | None = None, drawstyle: str = "default") -> Any:
    axes = _axes(axes)
    axes.plot(curve.x, curve.values, color=colour, linewidth=1.3, label=label, drawstyle=drawstyle)
    known = np.isfinite(curve.errors)
    low, high = curve.values - curve.errors, curve.values + curve.errors
    step = "mid" if drawstyle == "steps-mid" else None
    axes.fill_between(curve.x[known], low[known], high[known], color=colour, alpha=0.25, linewidth=0, step=step)
    return axes
