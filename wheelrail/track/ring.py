"""A continuous rail closed to a long ring: its waves become modes, and its motion their sum.

On a ring of length L the wavenumbers are k = 2 pi p / L. Each wave of each wavenumber is an oscillator with its own
frequency and damping, so the Green's functions are causal and passive by construction. The ring stands for the infinite
rail as long as waves die out before they come round.

A constant loss factor has no causal response in time. Each wave gets the viscous damping zeta = loss factor / 2 in its
place: the same at the wave's own frequency, where damping matters.

Waves above the highest frequency are left out, as the modes of a wheel are. What they would add is the local
deformation around a point force, which the contact model's half-space holds already (and which is infinite for a point
force on an elastic body).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .reduced_section import ReducedSection

__all__ = ["Ring", "close_ring"]

_CHUNK = 1 << 21  # values of one intermediate array


@dataclass(frozen=True)
class Ring:
    """Waves of a ring; each with k > 0 stands for itself and its mirror image -k.

    Parameters
    ----------
    length : float
        m.
    wavenumber, omega, damping_ratio : ndarray, shape (n,)
        rad/m, rad/s and 1.
    outputs : ndarray, shape (n, rows)
        Displacements at the points of interest, scaled to unit mass per length; rows 0, 1, 2 are the contact's
        (x', y', z'), the axial one being -i times the true displacement.
    """

    length: float
    wavenumber: NDArray
    omega: NDArray
    damping_ratio: NDArray
    outputs: NDArray

    @property
    def head(self) -> NDArray:
        """Displacements of the waves at the contact, shape (n, 3)."""
        return self.outputs[:, :3]

    @cached_property
    def weight(self) -> NDArray:
        """Share of each wave with its mirror image in a sum over the ring, 1/m; shape (n,)."""
        return np.where(self.wavenumber == 0.0, 1.0, 2.0) / self.length

    def receptance(self, frequency: ArrayLike, x: ArrayLike = 0.0) -> NDArray:
        """Receptance at the contact between a force at 0 and the displacement at x.

        Parameters
        ----------
        frequency : array_like, shape (m,)
            Hz; complex values ask for the response to exp(i 2 pi f t) off the real axis.
        x : array_like, shape (k,) or float
            m.

        Returns
        -------
        ndarray of complex, shape (m, k, 3, 3)
            [frequency, distance, displacement, force] in m/N, time factor exp(+i omega t); x = 0 alone when a float.
        """
        omega = 2.0 * np.pi * np.atleast_1d(np.asarray(frequency))
        distance = np.atleast_1d(np.asarray(x, dtype=float))
        if np.any(distance):
            # For the pairs of the longitudinal with another direction the mirror images give a sine.
            phase = self.wavenumber[:, None] * distance
            terms = np.where(_MIXED[None, None, :], np.sin(phase)[:, :, None], np.cos(phase)[:, :, None])
            terms = (terms * self._products[:, None, :]).reshape(len(self.omega), -1)
        else:
            terms = np.tile(self._direct, len(distance))
        result = np.empty((len(omega), terms.shape[1]), dtype=complex)
        stride = max(1, _CHUNK // len(self.omega))
        damping = 2.0 * self.damping_ratio * self.omega
        for first in range(0, len(omega), stride):
            w = omega[first : first + stride, None]
            result[first : first + stride] = (1.0 / (self.omega**2 - w**2 + 1j * w * damping)) @ terms
        return result.reshape(len(omega), len(distance), 3, 3)

    def static_compliance(self) -> NDArray:
        """Return the static compliance at the contact, shape (3, 3), m/N; infinite for a free rail."""
        if self.omega.min() <= 1e-3:
            return np.full((3, 3), np.inf)
        return ((1.0 / self.omega**2) @ self._direct).reshape(3, 3)

    @cached_property
    def _products(self) -> NDArray:
        """Products displacement times force times weight of each wave, signs of the sines included; shape (n, 9)."""
        head = self.head
        products = head[:, :, None] * head[:, None, :]
        # True displacement u_x = i u~_x: (x from z) has 2 Re[i e^(-ikx)] = 2 sin(kx), (z from x) the opposite.
        products[:, 1:, 0] *= -1.0
        return self.weight[:, None] * products.reshape(len(head), 9)

    @cached_property
    def _direct(self) -> NDArray:
        """The same for no distance."""
        return np.where(_MIXED, 0.0, self._products)


_MIXED = np.array([[False, True, True], [True, False, False], [True, False, False]]).ravel()
"""Pairs of the longitudinal with another direction."""


def close_ring(section: ReducedSection, *, length: float, max_frequency: float) -> Ring:
    """Close a rail to a ring and find all its waves up to a frequency.

    Parameters
    ----------
    section : ReducedSection
    length : float
        m.
    max_frequency : float
        Hz.

    Returns
    -------
    Ring
    """
    found: list[tuple[NDArray, NDArray, NDArray, NDArray]] = []
    number = 0
    while True:
        wavenumber = 2.0 * np.pi * number / length
        waves = section.waves(wavenumber, max_frequency)
        if len(waves.omega) == 0:
            break
        found.append((np.full(len(waves.omega), wavenumber), waves.omega, waves.loss_factor, waves.outputs.T))
        number += 1
    wavenumbers, omega, loss, outputs = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return Ring(length, wavenumbers, omega, 0.5 * loss, outputs)
