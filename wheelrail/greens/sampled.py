"""Green's functions of a wheel as samples of finite length, where nothing shorter is known about them.

The displacement from all past forces is one product of the samples with the forces that they remember. These lie in a
ring of twice that length, in which every force is written twice, so that they are always one contiguous stretch in the
order of time: a step costs this one product and moves nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

__all__ = ["SampledGreens"]

_HEAD = 0  # place in the state: where the next force goes in the ring; the known displacements follow, then the ring


@dataclass(frozen=True, eq=False)
class SampledGreens:
    """Discretised Green's functions g(1) ... g(n) in d directions, zero beyond.

    Parameters
    ----------
    values : ndarray, shape (n, d, d)
        [sample, displacement, force], m/N.
    """

    values: NDArray

    @cached_property
    def directions(self) -> int:
        """Number of directions."""
        return self.values.shape[1]

    @cached_property
    def memory(self) -> int:
        """Number of past forces that matter."""
        return max(len(self.values) - 1, 1)

    @cached_property
    def size(self) -> int:
        """Numbers in its state."""
        return 1 + self.directions + 2 * self.memory * self.directions

    @cached_property
    def first(self) -> NDArray:
        """First sample, shape (d, d), m/N."""
        return np.array(self.values[0], dtype=float)

    @cached_property
    def _weights(self) -> NDArray:
        """Samples after the first one, the last one first; shape (d, memory * d)."""
        past = self.values[:0:-1] if len(self.values) > 1 else np.zeros((1, self.directions, self.directions))
        return np.ascontiguousarray(np.swapaxes(past, 0, 1).reshape(self.directions, -1), dtype=float)

    def known(self, state: NDArray) -> NDArray:
        """Return the displacement from all past forces, shape (d,), m: a view of the state."""
        return state[1 : 1 + self.directions]

    def advance(self, state: NDArray, force: NDArray) -> None:
        """Go on to the next step under a force (N), shape (d,)."""
        d, memory = self.directions, self.memory
        head = int(state[_HEAD])
        start = 1 + d + head * d
        state[start : start + d] = force
        state[start + memory * d : start + (memory + 1) * d] = force
        head = head + 1 if head + 1 < memory else 0
        state[_HEAD] = head
        start = 1 + d + head * d
        np.dot(self._weights, state[start : start + memory * d], out=state[1 : 1 + d])

    def static_compliance(self) -> NDArray:
        """Sum of all samples, shape (d, d), m/N."""
        return self.values.sum(axis=0)

    def steady(self, force: NDArray) -> NDArray:
        """Return the state after a force (N), shape (d,), that has acted for ever."""
        state = np.empty(self.size)
        d = self.directions
        state[_HEAD] = 0
        state[1 + d :].reshape(-1, d)[:] = force
        state[1 : 1 + d] = self._weights @ state[1 + d : 1 + d + self.memory * d]
        return state
