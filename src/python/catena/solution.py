"""Accelerations and joint forces of a scene at its start."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from catena import _core
from catena._ranks import note_ranks
from catena.model import Scene, model_of, say


class Solution:
    """Result of ``solve``. Bodies and beads are numbered through all chains.

    The arrays are read-only views of the result's own memory, which lives as long as they do.
    """

    def __init__(self, found: _core.Solution, notes: list[str]) -> None:
        self._found = found
        #: One sentence each on what the reader assumed, changed or left out.
        self.notes = notes

    def __repr__(self) -> str:
        validity = "valid" if self.valid else "not valid"
        return f"<catena.Solution: {len(self.accelerations)} bodies, {validity}, residual {self.residual:.3g}>"

    @property
    def joint_accelerations(self) -> np.ndarray:
        """Accelerations of all joint coordinates, body after body; ``of_joint`` picks those of one body."""
        return self._found.joint_accelerations

    @property
    def accelerations(self) -> np.ndarray:
        """Accelerations of centres of mass and beads in ground axes (n_bodies, 3), nm/ps^2 (m/s^2 in SI)."""
        return self._found.accelerations

    @property
    def angular_accelerations(self) -> np.ndarray:
        """Angular accelerations in ground axes (n_bodies, 3), 1/ps^2 (1/s^2 in SI); zero for beads."""
        return self._found.angular_accelerations

    @property
    def joint_forces(self) -> np.ndarray:
        """Constraint force on each body at its inboard joint or link, ground axes (n_bodies, 3), kJ/mol/nm (N in SI)."""
        return self._found.joint_forces

    @property
    def joint_torques(self) -> np.ndarray:
        """Constraint torque on each body about its inboard joint, ground axes (n_bodies, 3), kJ/mol (N m in SI)."""
        return self._found.joint_torques

    @property
    def tip_forces(self) -> np.ndarray:
        """Constraint forces of jointed tips and rings on their last bodies (n_tips, 3)."""
        return self._found.tip_forces

    @property
    def tip_torques(self) -> np.ndarray:
        """Constraint torques of jointed tips and rings on their last bodies (n_tips, 3)."""
        return self._found.tip_torques

    @property
    def loop_forces(self) -> np.ndarray:
        """Constraint forces of loops on the first of their two bodies, ground axes (n_loops, 3)."""
        return self._found.loop_forces

    @property
    def loop_torques(self) -> np.ndarray:
        """Constraint torques of loops on the first of their two bodies, ground axes (n_loops, 3)."""
        return self._found.loop_torques

    @property
    def residual(self) -> float:
        """Largest local residual of the equations of motion; at most ``residual_bound`` in a valid solution."""
        return self._found.residual

    @property
    def residual_bound(self) -> float:
        """Largest residual that rounding explains."""
        return self._found.residual_bound

    @property
    def error(self) -> float | None:
        """Estimated error relative to the largest acceleration; None for beads and bodies on links."""
        return self._found.error

    @property
    def error_bound(self) -> float:
        """Largest error of a valid solution."""
        return self._found.error_bound

    @property
    def valid(self) -> bool:
        """True if the residual and the estimated error are within their bounds."""
        return self._found.valid

    def of_joint(self, body: int) -> np.ndarray:
        """Returns a view of the accelerations of one body's joint coordinates.

        They are 1 number for a revolute joint, 3 for a spherical joint (body axes), 6 for a free joint (angular, then
        those of the origin) and 3 for a bead.
        """
        first = self._found.first
        if not 0 <= body < len(first) - 1:
            raise IndexError(f"there is no body {body} (Solution.of_joint): give 0 to {len(first) - 2}")
        return self.joint_accelerations[first[body] : first[body + 1]]


def solve(scene: Scene, force: Callable[..., Any] | None = None) -> Solution:
    """Computes accelerations and joint forces of a scene at its start, by the divide-and-conquer algorithm.

    ``force`` is a force of your own, see ``Simulation``. The reader's notes become warnings. The GIL is released.
    Raises InputError if the scene is wrong, and ComputationError if a joint's matrix is singular.
    """
    note_ranks()
    model = model_of(scene)
    notes = model.notes
    say(notes)
    return Solution(_core.solve(model._core(), force), notes)
