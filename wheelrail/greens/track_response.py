"""Convolution of the contact force with the moving Green's functions of the track (Pieringer 2011, eq. 3.15).

Push instead of pull: once the force of a step is known, its Green's function times the force is added to the rail's
future displacements. Each force so uses the function of its own position, and a step touches one stretch of memory.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

__all__ = ["TrackResponse"]


@dataclass(frozen=True)
class TrackResponse:
    """Moving Green's functions in d directions, d = 3 for (x', y', z') or 1 for z' alone.

    Future displacements lie in a buffer of twice the functions' length, shape (d, 2 samples), through which a window
    slides; ``head`` is the place of the present step in it.

    Parameters
    ----------
    values : ndarray, shape (positions, d, d, samples)
        [position of the force, its direction, direction of the displacement, sample], m/N.
    """

    values: NDArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", np.ascontiguousarray(self.values, dtype=float))

    @property
    def positions(self) -> int:
        """Number of positions in a bay; 1 for a rail on continuous support."""
        return self.values.shape[0]

    @property
    def directions(self) -> int:
        """Number of directions."""
        return self.values.shape[1]

    @property
    def samples(self) -> int:
        """Length of the functions."""
        return self.values.shape[3]

    @cached_property
    def _rows(self) -> list[NDArray]:
        """For each position a matrix (d, d samples), or the one function if d = 1."""
        d = self.directions
        return list(self.values.reshape((self.positions, -1) if d == 1 else (self.positions, d, -1)))

    @cached_property
    def _firsts(self) -> list[float]:
        return [float(value) for value in self.values[:, -1, -1, 0]]

    @cached_property
    def _tangential_firsts(self) -> list[NDArray]:
        return [np.ascontiguousarray(first.T) for first in self.values[:, :-1, :-1, 0]]

    def first(self, index: int) -> float:
        """Return the first vertical sample of the function at a grid index, m/N."""
        return self._firsts[index % len(self._firsts)]

    def tangential_first(self, index: int) -> NDArray:
        """Return the first samples of the other directions at a grid index, shape (d - 1, d - 1), m/N.

        [displacement, force]; those that couple the vertical with another direction are zero in use.
        """
        return self._tangential_firsts[index % len(self._tangential_firsts)]

    def push(self, future: NDArray, head: int, index: int, force: NDArray, work: NDArray) -> int:
        """Let a force act on the future displacements and go on to the next step.

        Parameters
        ----------
        future : ndarray, shape (d, 2 samples)
            Changed in place.
        head : int
            Place of the present step.
        index : int
            Grid index of the force's position.
        force : ndarray, shape (d,)
            N.
        work : ndarray, shape (d samples,)
            Is overwritten.

        Returns
        -------
        int
            Place of the next step.
        """
        samples = self.samples
        functions = self._rows[index % len(self._rows)]
        if len(force) == 1:
            np.multiply(functions, force[0], out=work)
            stretch = future[0, head : head + samples]
            np.add(stretch, work, out=stretch)
        else:
            np.dot(force, functions, out=work)
            stretch = future[:, head : head + samples]
            np.add(stretch, work.reshape(-1, samples), out=stretch)
        head += 1
        if head == samples:
            future[:, :samples] = future[:, samples:]
            future[:, samples:] = 0.0
            head = 0
        return head

    def history(self, index: int) -> NDArray:
        """Displacements at a step and after, per N of a force that rolled there for ever and ends before that step.

        Parameters
        ----------
        index : int
            Grid index of that step.

        Returns
        -------
        ndarray, shape (d, d, samples)
            [force, displacement, step], m/N.
        """
        samples, values = self.samples, self.values
        history = np.zeros(values.shape[1:])
        if self.positions == 1:
            # The sum of all samples beyond each.
            history[:, :, :-1] = np.cumsum(values[0, :, :, :0:-1], axis=-1)[:, :, ::-1]
            return history
        for age in range(1, samples):
            history[:, :, : samples - age] += values[(index - age) % self.positions, :, :, age:]
        return history

    def compliance(self, index: int) -> NDArray:
        """Displacement per N of a force that has rolled to a grid index for ever, shape (d, d), [displacement, force].

        The moving static compliance: the present force counts with its first sample.
        """
        ages = np.arange(self.samples)
        passed = self.values[(index - ages) % self.positions, :, :, ages]  # [age, force, displacement]
        return passed.sum(axis=0).T
