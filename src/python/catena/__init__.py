"""Motion of very long articulated chains: proteins, polymers, mechanisms, cables.

A scene is a file, a text, a dict or a ``Model`` that is built chain by chain. ``solve`` computes accelerations and
joint forces at its start, ``Simulation`` moves it in time, ``check`` only reads it. Units are nm, ps, amu and kJ/mol,
or SI with ``units: si``. Bodies and beads are numbered through all chains, from 0, in all arrays.
"""

from __future__ import annotations

try:
    from catena import _core
except ImportError as error:
    if "OpenMM" not in str(error):
        raise
    raise ImportError(
        f"the library of OpenMM with which catena was built cannot be loaded ({error}): install openmm in this "
        "environment, in the version that was there when catena was installed, or install catena again"
    ) from error

from catena import analysis
from catena.errors import ComputationError, Error, InputError, Note
from catena.model import Model, check, load
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
    "Simulation",
    "Solution",
    "State",
    "analysis",
    "check",
    "has_openmm",
    "load",
    "solve",
]
