"""The Green's functions of a wheel as recursions of its modes (Pieringer 2011, eqs. 3.8 and 3.10), never cut off.

Each mode has two states. With the modal force f = sum of shape times force,

    displacement = sum of shape (c q + first f),    q <- Phi q + beta f,

which is exact for a force that is linear between the steps. All modes advance at once; a step costs some ten products
of the length of the state, whatever the memory of the wheel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .protocol import FreeBodyError

__all__ = ["ModalRecursion"]

_FREE = 1e-14  # determinant of 1 - Phi, about the square of frequency times time step, below which nothing holds a mode


@dataclass(frozen=True)
class ModalRecursion:
    """Recursions of n modes in d directions.

    The state is the first states of all modes, then the second ones.

    Parameters
    ----------
    own, cross : ndarray, shape (2, n)
        Rows of the transition over one step: q_i <- own_i q_i + cross_i q_(1 - i).
    drive, output : ndarray, shape (d, 2 n)
        What a force adds to the state, per N, and the displacement per state, in m.
    first : ndarray, shape (d, d)
        First sample, m/N.
    """

    own: NDArray
    cross: NDArray
    drive: NDArray
    output: NDArray
    first: NDArray

    @property
    def directions(self) -> int:
        """Number of directions."""
        return len(self.first)

    @property
    def size(self) -> int:
        """Numbers in its state: two for each mode."""
        return self.drive.shape[1]

    def known(self, state: NDArray) -> NDArray:
        """Return the displacement from all past forces, shape (d,), m."""
        return self.output @ state

    def advance(self, state: NDArray, force: NDArray) -> None:
        """Go on to the next step under a force (N), shape (d,)."""
        pair = state.reshape(2, -1)
        crossed = self.cross * pair[::-1]
        pair *= self.own
        pair += crossed
        state += force @ self.drive

    def values(self, n: int) -> NDArray:
        """Discretised Green's functions g(1) ... g(n), m/N; shape (n, d, d), [sample, displacement, force]."""
        result = np.empty((n, self.directions, self.directions))
        states = self.drive.copy()
        for i in range(n):
            result[i] = self.output @ states.T if i else self.first
            if i:
                pairs = states.reshape(self.directions, 2, -1)
                states = (self.own * pairs + self.cross * pairs[:, ::-1]).reshape(states.shape)
        return result

    def static_compliance(self) -> NDArray:
        """Sum of all samples, shape (d, d), m/N; infinite where a free body moves."""
        settled, free = self._settled(self.drive)
        result = self.first + self.output @ settled.T
        moved = np.abs(self.output) @ free
        return np.where(np.multiply.outer(moved, moved) > 0.0, np.inf, result)

    def steady(self, force: NDArray) -> NDArray:
        """Return the state after a force (N), shape (d,), that has acted for ever.

        Raises
        ------
        FreeBodyError
            If it moves a body which nothing holds.
        """
        drive = force @ self.drive
        settled, free = self._settled(drive[None])
        if np.any(drive[free]):
            raise FreeBodyError("a constant force moves a body that nothing holds")
        return settled[0]

    def _settled(self, drive: NDArray) -> tuple[NDArray, NDArray]:
        """Return fixed points q = Phi q + drive of each row, 0 for free modes, and which states are of free modes."""
        pairs = drive.reshape(len(drive), 2, -1)
        remaining = 1.0 - self.own
        determinant = remaining[0] * remaining[1] - self.cross[0] * self.cross[1]
        free = determinant < _FREE
        solution = (remaining[::-1] * pairs + self.cross * pairs[:, ::-1]) / np.where(free, 1.0, determinant)
        return np.where(free, 0.0, solution).reshape(drive.shape), np.tile(free, 2)
