"""Moving Green's functions of a continuous rail from its waves (Nordborg 2002; Pieringer 2011, eq. 3.14).

Seen from a contact that moves away at speed v, every wave is a pair of exponentials exp((s +- i k v) t), with s the
damped eigenvalue of its oscillation. A piecewise linear force is integrated against them exactly, as in
`wheelrail.greens.ordinary`, and the functions are the sums over all waves. They depend on the distance only: one
position is enough.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .ordinary import HIGHEST

__all__ = ["hat_weights", "moving_hat_weights", "wave_greens"]

_TERMS = 4096  # exponentials treated at a time
_BLOCK = 64  # samples within which powers are tabulated


class Waves(Protocol):
    """Waves of a rail, scaled to unit mass per length; see `wheelrail.track.ring.Ring`."""

    @property
    def wavenumber(self) -> NDArray: ...

    @property
    def omega(self) -> NDArray: ...

    @property
    def damping_ratio(self) -> NDArray: ...

    @property
    def weight(self) -> NDArray: ...

    @property
    def head(self) -> NDArray: ...


def hat_weights(rate: NDArray, dt: float) -> tuple[NDArray, NDArray]:
    """Integrals of exp(rate t) against a force that rises from 0 to 1 within dt and falls back within the next.

    Parameters
    ----------
    rate : ndarray of complex
        1/s; real part <= 0.
    dt : float
        s.

    Returns
    -------
    present : ndarray of complex
        In the step of the force itself, when it has just risen; s.
    later : ndarray of complex
        In the n-th step after, divided by exp(rate n dt); s.
    """
    z = rate * dt
    small = np.abs(z) < 0.1
    safe = np.where(small, 1.0, z)
    present = (np.exp(safe) - 1.0 - safe) / safe**2
    later = 4.0 * (np.sinh(0.5 * safe) / safe) ** 2
    # Series, since the closed forms cancel: sum z^n / (n + 2)! and (1 + z^2/24 + z^4/1920 + ...)^2.
    series = np.zeros_like(z)
    for order in range(9, -1, -1):
        series = series * z + 1.0 / _factorial(order + 2)
    half = 1.0 + z**2 / 24.0 + z**4 / 1920.0 + z**6 / 322560.0
    return dt * np.where(small, series, present), dt * np.where(small, half**2, later)


def moving_hat_weights(rate: NDArray, dt: float) -> tuple[NDArray, NDArray]:
    """Weights as `hat_weights`, but exponentials above `HIGHEST` times half the sampling frequency only yield.

    Their static response, -1 / rate, comes with the present force.
    """
    present, later = hat_weights(rate, dt)
    fast = np.abs(np.imag(rate)) * dt > HIGHEST * np.pi
    return np.where(fast, -1.0 / np.where(fast, rate, 1.0), present), np.where(fast, 0.0, later)


def _factorial(n: int) -> float:
    return float(np.prod(np.arange(1.0, n + 1.0)))


def wave_greens(
    waves: Waves, *, speed: float, dx: float, samples: int, progress: Callable[[float], None] | None = None
) -> NDArray:
    """Sum the discretised moving Green's functions of all waves.

    Parameters
    ----------
    waves : Waves
        All with omega > 0 and a damping ratio below 1.
    speed, dx : float
        m/s and m.
    samples : int
        Length of the functions.
    progress : callable, optional
        Called with the share done, 0 to 1.

    Returns
    -------
    ndarray, shape (3, 3, samples)
        [force direction, displacement direction, sample], m/N; the last sample is not halved.
    """
    dt = dx / speed
    head, weight = waves.head, waves.weight
    products = (weight[:, None, None] * head[:, :, None] * head[:, None, :]).reshape(
        len(head), 9
    )  # [force, displacement]
    damped = waves.omega * np.sqrt(1.0 - waves.damping_ratio**2)
    own = -waves.damping_ratio * waves.omega + 1j * damped
    drift = 1j * waves.wavenumber * speed
    products /= damped[:, None]
    # Response to a unit impulse: cos(k v t) or +- sin(k v t) times Im exp(s t), each a sum of two exponentials.
    same = np.array([[1, 0, 0], [0, 1, 1], [0, 1, 1]]).ravel()
    mixed = np.array([[0, -1, -1], [1, 0, 0], [1, 0, 0]]).ravel()  # [force z, displacement x]: + sin
    rates = np.concatenate([own - drift, own + drift])
    amplitudes = np.concatenate([0.5 * products * (-1j * same + mixed), 0.5 * products * (-1j * same - mixed)])
    blocks = -(-samples // _BLOCK)
    result = np.zeros((blocks, 9, _BLOCK))
    first = np.zeros(9)
    power = np.arange(_BLOCK)
    for begin in range(0, len(rates), _TERMS):
        rate = rates[begin : begin + _TERMS]
        present, later = moving_hat_weights(rate, dt)
        amplitude = amplitudes[begin : begin + _TERMS].T
        first += (amplitude @ present).real
        table = np.exp(np.multiply.outer(rate * dt, power)) * later[:, None]
        advance = np.exp(rate * (_BLOCK * dt))
        # Real part of a product of complex matrices as one real product.
        real_table = np.vstack([np.real(table), -np.imag(table)])
        current = amplitude.copy()
        for block in range(blocks):
            result[block] += np.hstack([np.real(current), np.imag(current)]) @ real_table
            current *= advance
        if progress:
            progress(min(1.0, (begin + _TERMS) / len(rates)))
    values = result.transpose(1, 0, 2).reshape(9, -1)[:, :samples]
    values[:, 0] = first
    return values.reshape(3, 3, samples).copy()
