"""Scenes that move in time, step by step, in memory."""

from __future__ import annotations

import contextlib
import operator
import os
import threading
from collections.abc import Callable
from typing import Any

import numpy as np

from catena import _core
from catena._progress import shown
from catena._ranks import note_ranks
from catena.errors import ComputationError, InputError
from catena.model import Scene, model_of, say

#: Largest number of steps that one call of the C++ part takes.
_MOST_STEPS = 2**62


class State:
    """State of a simulation at one step.

    Its arrays are read-only and do not change when the simulation goes on. They are views of the state's own memory,
    which lives as long as they do.
    """

    def __init__(self, found: _core.State) -> None:
        self._found = found

    def __repr__(self) -> str:
        return f"<catena.State: {len(self.positions)} bodies, step {self.steps}, time {self.time:.6g}>"

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
        """Coordinates of inboard joints (n_bodies, 4), padded with zeros; of a free joint only its quaternion.

        All are zero if the integrator works in absolute coordinates.
        """
        return self._found.joint_positions

    @property
    def joint_rates(self) -> np.ndarray:
        """Rates of inboard joints (n_bodies, 3), padded with zeros; of a free joint only its angular velocity."""
        return self._found.joint_rates

    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy of all bodies, kJ/mol (J in SI)."""
        return self._found.kinetic_energy

    @property
    def potential_energies(self) -> dict[str, float]:
        """Potential energy by term, kJ/mol (J in SI): gravity, springs, OpenMM's forces and ``own force``."""
        terms: dict[str, float] = {}
        for name, value in self._found.potential_energies:
            terms[name] = terms.get(name, 0.0) + value
        return terms

    @property
    def potential_energy(self) -> float:
        """Sum of ``potential_energies``, without forces of your own that return no energy."""
        return sum(value for _, value in self._found.potential_energies)

    @property
    def total_energy(self) -> float:
        """Sum of kinetic and potential energies."""
        return self._found.total_energy

    @property
    def temperature(self) -> float | None:
        """Temperature of the kinetic energy, K.

        It is None if motions are prescribed, for implicit integrators, and in SI units without a thermostat.
        """
        return self._found.temperature

    @property
    def constraint_error(self) -> float:
        """Largest relative violation of a joint or link."""
        return self._found.constraint_error


class Simulation:
    """A scene that moves in time by the integrator that its key ``dynamics`` names.

    ``scene`` is a path, the text of a scene file, a dict or a ``Model``.

    ``force(positions, orientations)`` is a force of your own. It returns ``(energy, forces)`` or
    ``(energy, forces, torques)``: arrays of shape (n_bodies, 3) in ground axes, and a potential energy or None. The
    arguments are copies of the centres of mass and beads (n_bodies, 3) and of the quaternions (n_bodies, 4). The
    force is called at every evaluation, up to several times in a step, and must depend on its arguments alone.

    A new simulation prepares its start: it relaxes the scene if asked, draws thermal velocities and closes joints.
    Notes become warnings. Raises InputError if the scene is wrong or has no ``dynamics``.

    States have the bits of ``catena run`` with the same backend and without ``output.checkpoint_every``.

    One thread at a time computes. Other threads may read ``steps``, ``time`` and ``notes`` meanwhile.
    """

    def __init__(self, scene: Scene, force: Callable[..., Any] | None = None) -> None:
        note_ranks()
        #: The scene as it is now; the model may change.
        self._scene = model_of(scene)._core()
        self._live = _core.Simulation(self._scene, force)
        self._n_bodies = self._scene.bodies
        self._kept: tuple[int, State] | None = None
        self._observers: list[tuple[Callable[[Simulation], Any], int]] = []
        self._turn = threading.Lock()
        self._stepping_thread: int | None = None
        say(self._live.notes)

    def __repr__(self) -> str:
        return f"<catena.Simulation: {self.n_bodies} bodies, step {self.steps}, time {self.time:.6g}>"

    def step(self, n: int = 1, *, progress: bool = False) -> int:
        """Takes ``n`` steps, whatever ``dynamics.steps`` says, and returns their number.

        ``progress=True`` shows the number of steps, their rate and the time left, in notebooks and on terminals, by
        the package tqdm.

        The GIL is released while steps are computed. Ctrl-C stops after a step, whose observers are still called, and
        raises KeyboardInterrupt. The simulation can go on, also after an exception in an observer. After a failed
        step, or an exception in your own force, only ``restore`` helps.
        """
        n = _count(n, "the number of steps", "Simulation.step", least=0)
        if self._stepping_thread == threading.get_ident():
            raise InputError("an observer takes steps of its simulation (Simulation.step): let step() return first")
        if not self._turn.acquire(blocking=False):
            raise ComputationError("another thread takes steps (Simulation.step): wait until its step() returns")
        try:
            self._stepping_thread = threading.get_ident()
            last = self.steps + n
            with shown(self.steps, last, lambda: self.steps) if progress else contextlib.nullcontext():
                self._step_to(last)
        finally:
            self._stepping_thread = None
            self._turn.release()
        return n

    def observe(self, observer: Callable[[Simulation], Any], every: int = 1) -> None:
        """Calls ``observer(simulation)`` after each step whose number is a multiple of ``every``."""
        if not callable(observer):
            raise InputError(f"the observer {observer!r} is not callable (Simulation.observe): give a function")
        self._observers.append((observer, _count(every, "every", "Simulation.observe", least=1)))

    def stop_observing(self, observer: Callable[[Simulation], Any]) -> None:
        """Removes an observer. Raises InputError if ``observe`` was not called with it."""
        kept = [each for each in self._observers if each[0] != observer]
        if len(kept) == len(self._observers):
            raise InputError("this function is not an observer (Simulation.stop_observing): give one that observes")
        self._observers = kept

    @property
    def n_bodies(self) -> int:
        """Number of bodies and beads."""
        return self._n_bodies

    @property
    def state(self) -> State:
        """The present state. It is computed once a step, which costs an evaluation in joint coordinates."""
        changes, kept = self._live.changes, self._kept
        if kept is None or kept[0] != changes:
            kept = self._kept = (changes, State(self._live.state()))
        return kept[1]

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
        """Returns the present state as bytes, from which ``restore`` continues with the same bits.

        The exceptions are forces on OpenMM's platforms CPU and CUDA. Their neighbour lists are not part of a
        checkpoint, so that the first steps round differently.
        """
        return self._live.checkpoint()

    def restore(self, checkpoint: bytes) -> None:
        """Returns to the state of a checkpoint of the same scene, also after a failed step.

        Raises InputError, and changes nothing, if the bytes are damaged or belong to another scene.
        """
        if isinstance(checkpoint, (str, os.PathLike)):
            raise InputError("the checkpoint is not bytes (Simulation.restore): read files with load(path)")
        self._kept = None
        try:
            self._live.restore(checkpoint if isinstance(checkpoint, bytes) else bytes(memoryview(checkpoint)))
        except InputError as error:
            raise InputError(_in_python(str(error))) from None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes ``checkpoint()`` to a file, which is replaced as a whole."""
        part = f"{os.fspath(path)}.part"
        with open(part, "wb") as file:
            file.write(self.checkpoint())
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)

    def load(self, path: str | os.PathLike[str]) -> None:
        """Restores the checkpoint in a file that ``save`` wrote."""
        with open(path, "rb") as file:
            self.restore(file.read())

    def _step_to(self, last: int) -> None:
        """Takes steps up to number ``last`` and calls the observers, also after the step at which a signal arrives."""
        while self.steps < last:
            self._kept = None
            interrupt = self._live.run(min(self._next_stop(last) - self.steps, _MOST_STEPS))
            try:
                self._look()
            finally:
                if interrupt is not None:
                    raise interrupt

    def _next_stop(self, last: int) -> int:
        """Returns the number of the next step at which an observer is called, at most ``last``."""
        return min([last, *(self.steps - self.steps % every + every for _, every in self._observers)])

    def _look(self) -> None:
        for observer, every in list(self._observers):
            if self.steps % every == 0:
                observer(self)


def _in_python(message: str) -> str:
    """Returns a message on a checkpoint in the words of the package."""
    begin, branch, _ = message.partition(", or branch off with --branch")
    begin = begin.replace("restart with its own scene", "restore it with its own scene") if branch else begin
    return begin.replace("Simulation::", "Simulation.")


def _count(value: Any, what: str, where: str, least: int) -> int:
    """Returns a whole number, also of a float such as 1e6. Raises InputError if it is none or less than ``least``."""
    if isinstance(value, float) and value.is_integer():
        return _count(int(value), what, where, least)
    try:
        number = operator.index(value)
    except TypeError:
        raise InputError(f"{what} is {value!r} ({where}): give a whole number") from None
    if number < least:
        raise InputError(f"{what} is {number} ({where}): give {least} or more")
    return number
