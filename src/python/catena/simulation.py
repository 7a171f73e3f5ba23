"""Scenes that move in time, step by step, in memory."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import numpy as np

from catena import _core
from catena.errors import InputError
from catena.model import Scene, model_of, say


class State:
    """State of a simulation at one step.

    Every state has memory of its own: its arrays are read-only views of it, without further copies. They do not
    change when the simulation goes on, and stay valid as long as they are used.
    """

    def __init__(self, found: _core.State) -> None:
        self._found = found

    @property
    def steps(self) -> int:
        """Number of steps so far."""
        return self._found.steps

    @property
    def time(self) -> float:
        """Simulated time, ps (s in SI)."""
        return self._found.time

    @property
    def positions(self) -> np.ndarray:
        """Positions of centres of mass and beads in ground axes, unwrapped (n_bodies, 3), nm (m in SI)."""
        return self._found.positions

    @property
    def velocities(self) -> np.ndarray:
        """Velocities of centres of mass and beads in ground axes (n_bodies, 3), nm/ps (m/s in SI)."""
        return self._found.velocities

    @property
    def orientations(self) -> np.ndarray:
        """Unit quaternions w, x, y, z that take body axes to ground axes (n_bodies, 4); the identity for beads."""
        return self._found.orientations

    @property
    def angular_velocities(self) -> np.ndarray:
        """Angular velocities in body axes (n_bodies, 3), 1/ps (1/s in SI)."""
        return self._found.angular_velocities

    @property
    def joint_forces(self) -> np.ndarray:
        """Constraint force on each body at its inboard joint or link, ground axes (n_bodies, 3), kJ/mol/nm (N in SI)."""
        return self._found.joint_forces

    @property
    def joint_torques(self) -> np.ndarray:
        """Constraint torque on each body about its inboard joint, ground axes (n_bodies, 3), kJ/mol (N m in SI)."""
        return self._found.joint_torques

    @property
    def joint_positions(self) -> np.ndarray:
        """Coordinates of inboard joints (n_bodies, 4): unused numbers are zero, of a free joint only its quaternion.

        All are zero if the integrator works in absolute coordinates.
        """
        return self._found.joint_positions

    @property
    def joint_rates(self) -> np.ndarray:
        """Rates of inboard joints (n_bodies, 3): unused numbers are zero, of a free joint only its angular velocity."""
        return self._found.joint_rates

    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy of all bodies, kJ/mol (J in SI)."""
        return self._found.kinetic_energy

    @property
    def potential_energies(self) -> dict[str, float]:
        """Potential energy by term, kJ/mol (J in SI): gravity, springs, those of OpenMM, ``own force``."""
        terms: dict[str, float] = {}
        for name, value in self._found.potential_energies:
            terms[name] = terms.get(name, 0.0) + value
        return terms

    @property
    def potential_energy(self) -> float:
        """Sum of ``potential_energies``. An own force that returns no energy is not in it."""
        return sum(value for _, value in self._found.potential_energies)

    @property
    def total_energy(self) -> float:
        """Sum of kinetic and potential energies."""
        return self._found.total_energy

    @property
    def temperature(self) -> float | None:
        """Temperature of the kinetic energy, K.

        None with prescribed motions, for implicit integrators, and in SI units without a thermostat.
        """
        return self._found.temperature

    @property
    def constraint_error(self) -> float:
        """Largest relative violation of a joint or link."""
        return self._found.constraint_error


class Simulation:
    """A scene that moves in time by the integrator that its key ``dynamics`` names.

    ``force(positions, orientations)`` is a force of your own. It returns ``(energy, forces)`` or
    ``(energy, forces, torques)``: arrays of shape (n_bodies, 3) in ground axes, and a potential energy or None. The
    arguments are copies of the centres of mass and beads (n_bodies, 3) and of the quaternions (n_bodies, 4). The
    force is called at every evaluation, up to several times in a step, and must depend on its arguments alone.

    Making a simulation prepares the start: it relaxes the scene if asked, draws thermal velocities and closes joints.
    Notes become warnings. Raises InputError if the scene is wrong or has no ``dynamics``.

    States have the bits of ``catena run`` with the same backend and without ``output.checkpoint_every``.
    """

    def __init__(self, scene: Scene, force: Callable[..., Any] | None = None) -> None:
        self._live = _core.Simulation(model_of(scene)._core(), force)
        self._state: State | None = None
        self._observers: list[tuple[Callable[[Simulation], Any], int]] = []
        self._steps_inside = False
        say(self._live.notes)

    def step(self, n: int = 1) -> int:
        """Takes ``n`` steps, whatever ``dynamics.steps`` says, and returns their number.

        The interpreter's lock is released while steps are computed. Ctrl-C stops after a step and raises
        KeyboardInterrupt; the simulation can go on. Exceptions of observers pass alike. After a failed step, or an
        exception of the own force, only ``restore`` helps.
        """
        if n < 0:
            raise InputError(f"the number of steps is {n} (Simulation.step): give 0 or more")
        if self._steps_inside:
            raise InputError("an observer takes steps of its simulation (Simulation.step): let step() return first")
        last = self.steps + n
        self._steps_inside = True
        try:
            while self.steps < last:
                self._state = None
                self._live.run(min([last, *self._next_looks()]) - self.steps)
                self._look()
        finally:
            self._steps_inside = False
        return n

    def observe(self, observer: Callable[[Simulation], Any], every: int = 1) -> None:
        """Calls ``observer(simulation)`` after each step whose number is a multiple of ``every``."""
        if every < 1:
            raise InputError(f"every is {every} (Simulation.observe): give 1 or more steps")
        self._observers.append((observer, every))

    def stop_observing(self, observer: Callable[[Simulation], Any]) -> None:
        """Removes an observer. Raises InputError if it is none."""
        kept = [each for each in self._observers if each[0] is not observer]
        if len(kept) == len(self._observers):
            raise InputError("this function observes nothing (Simulation.stop_observing): name one that observes")
        self._observers = kept

    @property
    def state(self) -> State:
        """The present state. It is computed once a step, which costs an evaluation in joint coordinates."""
        if self._state is None:
            self._state = State(self._live.state())
        return self._state

    @property
    def steps(self) -> int:
        """Number of steps so far."""
        return self._live.steps

    @property
    def time(self) -> float:
        """Simulated time, ps (s in SI)."""
        return self._live.time

    @property
    def positions(self) -> np.ndarray:
        """Positions of ``state``."""
        return self.state.positions

    @property
    def velocities(self) -> np.ndarray:
        """Velocities of ``state``."""
        return self.state.velocities

    @property
    def orientations(self) -> np.ndarray:
        """Orientations of ``state``."""
        return self.state.orientations

    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy of ``state``."""
        return self.state.kinetic_energy

    @property
    def potential_energy(self) -> float:
        """Potential energy of ``state``."""
        return self.state.potential_energy

    @property
    def total_energy(self) -> float:
        """Total energy of ``state``."""
        return self.state.total_energy

    @property
    def temperature(self) -> float | None:
        """Temperature of ``state``."""
        return self.state.temperature

    @property
    def notes(self) -> list[str]:
        """One sentence each on what was assumed, changed or left out, and on steps that were repeated."""
        return self._live.notes

    def checkpoint(self) -> bytes:
        """Returns the present state as bytes, from which ``restore`` continues.

        It does so with the same bits, but for forces of OpenMM's platforms CPU and CUDA, which remember their
        neighbour lists: those round differently at first.
        """
        return self._live.checkpoint()

    def restore(self, checkpoint: bytes) -> None:
        """Returns to the state of a checkpoint of the same scene, also after a failed step.

        Raises InputError, and changes nothing, if the bytes are damaged or belong to another scene.
        """
        self._live.restore(checkpoint)
        self._state = None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes ``checkpoint()`` to a file, which is replaced as a whole."""
        part = f"{os.fspath(path)}.part"
        with open(part, "wb") as file:
            file.write(self.checkpoint())
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)

    def load(self, path: str | os.PathLike[str]) -> None:
        """Restores the checkpoint of a file that ``save`` wrote."""
        with open(path, "rb") as file:
            self.restore(file.read())

    def _next_looks(self) -> list[int]:
        """Returns the number of the next step that each observer wants."""
        return [self.steps - self.steps % every + every for _, every in self._observers]

    def _look(self) -> None:
        for observer, every in list(self._observers):
            if self.steps % every == 0:
                observer(self)
