"""Motion of very long articulated chains: proteins, polymers, mechanisms, cables.

A scene is a path, a text, a dict or a ``Model`` that is built chain by chain; all functions take any of these.
``solve`` computes accelerations and joint forces at its start, ``Simulation`` moves it in time, ``check`` only checks
it. Units are nm, ps, amu and kJ/mol, or SI with ``units: si``. Arrays number bodies and beads from 0 through all
chains.
"""

from __future__ import annotations

from catena._library import load as _load_library

_load_library()

from catena import _core, analysis, plot
from catena.errors import ComputationError, Error, InputError, Note
from catena.model import Model, check, load
from catena.record import Record
from catena.simulation import Simulation, State
from catena.solution import Solution, solve

__version__: str = _core.version
has_openmm: bool = _core.has_openmm

__all__ = [
    "ComputationError",
    "Error",
    "InputError",
    "Model",
    "Note",
    "Record",
    "Simulation",
    "Solution",
    "State",
    "analysis",
    "check",
    "has_openmm",
    "load",
    "plot",
    "solve",
]
