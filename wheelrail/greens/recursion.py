"""A Green's function as a recursion: the exact convolution of a system with few states, of any length.

With the known part y(a) of the displacement at step a and the force u(a),

    displacement(a) = c q + first u(a),    q <- Phi q + beta u(a),

the displacement is the sum over all past forces of the discretised Green's function (`values`), which is never cut off.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .protocol import FreeBodyError

__all__ = ["Recursion"]


@dataclass(frozen=True)
class Recursion:
    """Discretised Green's function of a system with m states.

    Parameters
    ----------
    phi : ndarray, shape (m, m)
        State transition over one step.
    beta : ndarray, shape (m,)
        Input vector, per N.
    c : ndarray, shape (m,)
        Output vector, in m.
    first : float
        First sample, the displacement in the step in which the force acts, m/N.
    """

    phi: NDArray
    beta: NDArray
    c: NDArray
    first: float

    @property
    def directions(self) -> int:
        """Number of directions: the vertical one."""
        return 1

    @property
    def size(self) -> int:
        """Numbers in its state."""
        return len(self.beta)

    def known(self, state: NDArray) -> tuple[float]:
        """Return the displacement from all past forces, m."""
        return (float(self.c @ state),)

    def advance(self, state: NDArray, force: NDArray) -> None:
        """Go on to the next step under a force (N), shape (1,)."""
        state[:] = self.phi @ state + self.beta * force[0]

    def steady(self, force: NDArray) -> NDArray:
        """Return the state after a force (N), shape (1,), that has acted for ever.

        Raises
        ------
        FreeBodyError
            If it moves a body which nothing holds.
        """
        if not np.any(force):
            return np.zeros(self.size)
        if not np.isfinite(self.static_compliance()):
            raise FreeBodyError("a constant force moves a body that nothing holds")
        return np.linalg.solve(np.eye(self.size) - self.phi, self.beta) * force[0]

    def values(self, n: int) -> NDArray:
        """Discretised Green's function g(1) ... g(n) of Pieringer (2011), eq. 3.6, in m/N; shape (n,)."""
        result = np.empty(n)
        state = self.beta
        for i in range(n):
            result[i] = self.first if i == 0 else self.c @ state
            if i:
                state = self.phi @ state
        return result

    def static_compliance(self) -> float:
        """Sum of the whole Green's function in m/N; infinite for a free body."""
        remaining = np.eye(len(self.c)) - self.phi
        # A free mass has a double eigenvalue 1 that rounding splits by about the root of the machine precision.
        if np.linalg.cond(remaining) > 1e12:
            return float("inf")
        return float(self.first + self.c @ np.linalg.solve(remaining, self.beta))
