"""Frames of a simulation, collected while it runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from catena import _core
from catena.errors import InputError

if TYPE_CHECKING:
    from catena.simulation import Simulation


class Record:
    """Positions, energies and temperatures of a simulation, after each step whose number is a multiple of ``every``.

    ``Record(simulation, every=100)`` observes the simulation until ``stop``. ``catena.analysis`` and ``catena.plot``
    take records. The sites are those of a trajectory: beads, beads that bodies carry, and centres of mass of bodies
    without beads.
    """

    def __init__(self, simulation: Simulation, every: int = 1) -> None:
        if not hasattr(simulation, "_scene") or not hasattr(simulation, "observe"):
            raise InputError(f"the type {type(simulation).__name__} is no simulation (Record): give a catena.Simulation")
        self._simulation = simulation
        self._sites = _core.Sites.of_model(simulation._scene)
        #: Chains, masses and residues of the sites.
        self.topology: _core.Topology = self._sites.topology
        self._frames: list[np.ndarray] = []
        self._rows: list[tuple[int, float, float, float, float]] = []
        simulation.observe(self._take, every)

    def __len__(self) -> int:
        return len(self._rows)

    def __repr__(self) -> str:
        return f"<catena.Record: {len(self)} frames of {len(self.masses)} sites>"

    def stop(self) -> None:
        """Stops observing the simulation. The frames stay."""
        self._simulation.stop_observing(self._take)

    @property
    def positions(self) -> np.ndarray:
        """Positions of the sites in ground axes, unwrapped (n_frames, n_sites, 3), nm (m in SI)."""
        return np.array(self._frames, dtype=float).reshape(len(self), len(self.masses), 3)

    @property
    def masses(self) -> np.ndarray:
        """Masses of the sites (n_sites,), amu (kg in SI)."""
        return np.array(self.topology.masses)

    @property
    def steps(self) -> np.ndarray:
        """Number of the step of each frame (n_frames,)."""
        return np.array([row[0] for row in self._rows], dtype=np.int64)

    @property
    def times(self) -> np.ndarray:
        """Time of each frame (n_frames,), ps (s in SI)."""
        return self._column(1)

    @property
    def kinetic_energies(self) -> np.ndarray:
        """Kinetic energy of each frame (n_frames,), kJ/mol (J in SI)."""
        return self._column(2)

    @property
    def potential_energies(self) -> np.ndarray:
        """Potential energy of each frame (n_frames,), kJ/mol (J in SI)."""
        return self._column(3)

    @property
    def total_energies(self) -> np.ndarray:
        """Total energy of each frame (n_frames,), kJ/mol (J in SI)."""
        return self.kinetic_energies + self.potential_energies

    @property
    def temperatures(self) -> np.ndarray:
        """Temperature of each frame (n_frames,), K; NaN where the simulation has none."""
        return self._column(4)

    def _column(self, number: int) -> np.ndarray:
        return np.array([row[number] for row in self._rows], dtype=float)

    def _take(self, simulation: Simulation) -> None:
        state = simulation.state
        self._frames.append(np.asarray(self._sites.positions(state.positions, state.orientations)))
        temperature = np.nan if state.temperature is None else state.temperature
        self._rows.append((state.steps, state.time, state.kinetic_energy, state.potential_energy, temperature))
