"""Moving Green's functions of a rail on equal supports from its Bloch waves (Nordborg 2002; Pieringer 2011, eq. 3.14).

As in `wheelrail.greens.travelling_waves` every mode is an exponential in the frame of the moving contact, here one for
each wavenumber kappa + 2 pi m / L_s in it. Force and displacement may have different m; the function depends on the
position x0 of the force through exp(-i 2 pi (m - m') x0 / L_s). These Fourier coefficients are summed over all modes,
and the functions for all positions follow from them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .travelling_waves import moving_hat_weights

__all__ = ["BlochModes", "bloch_greens"]

_TERMS = 2048  # exponentials treated at a time
_BLOCK = 64  # samples within which powers are tabulated
_DECAYED = 20.0  # an exponential is dropped when it has fallen to exp(-20), 2e-9


class BlochModes(Protocol):
    """Modes of a rail on supports; see `wheelrail.track.supported_ring.SupportedRing`."""

    @property
    def spacing(self) -> float: ...  # noqa: D102

    @property
    def kappa(self) -> NDArray: ...  # noqa: D102

    @property
    def pole(self) -> NDArray: ...  # noqa: D102

    @property
    def weight(self) -> NDArray: ...  # noqa: D102

    @property
    def orders(self) -> NDArray: ...  # noqa: D102

    @property
    def shape(self) -> NDArray: ...  # noqa: D102

    @property
    def participation(self) -> NDArray: ...  # noqa: D102


def bloch_greens(
    modes: BlochModes, *, speed: float, dx: float, samples: int, progress: Callable[[float], None] | None = None
) -> NDArray:
    """Sum the discretised moving Green's functions of all modes.

    Parameters
    ----------
    modes : BlochModes
    speed, dx : float
        m/s and m; the spacing of the supports must be a multiple of dx.
    samples : int
        Length of the functions.
    progress : callable, optional
        Called with the share done, 0 to 1.

    Returns
    -------
    ndarray, shape (positions, 3, 3, samples)
        [position, force direction, displacement direction, sample], m/N, for forces at 0, dx, ... from a support; the
        last sample is not halved.
    """
    dt = dx / speed
    positions = round(modes.spacing / dx)
    orders = modes.orders
    blocks = -(-samples // _BLOCK)
    power = np.arange(_BLOCK)
    axial = np.array([1j, 1.0, 1.0])
    # Slowly decaying modes first, so that those which have died out are a tail.
    slow = np.argsort(-np.real(modes.pole))
    # For the mode and its conjugate; the mirror image at -kappa makes the sum real.
    pole = np.concatenate([modes.pole[slow], modes.pole[slow].conj()])
    weight = np.tile(modes.weight[slow], 2)
    kappa = np.tile(modes.kappa[slow], 2)
    out = np.concatenate([modes.shape[slow], modes.shape[slow].conj()]) * axial
    inp = np.concatenate([modes.participation[slow], modes.participation[slow].conj()]) * axial.conj()
    interleaved = np.argsort(np.tile(np.arange(len(slow)), 2), kind="stable")
    pole, weight, kappa, out, inp = (array[interleaved] for array in (pole, weight, kappa, out, inp))
    wavenumber = kappa[:, None] + 2.0 * np.pi * orders / modes.spacing
    # Orders of the force from the largest down: next to each other, the differences of the orders then rise.
    inp = (inp * weight[:, None, None])[:, ::-1]
    coefficients = np.zeros((2 * len(orders) - 1, blocks, 9, _BLOCK), dtype=complex)
    first = np.zeros((2 * len(orders) - 1, 9), dtype=complex)
    done = 0
    for begin in range(0, len(pole), _TERMS):
        part = slice(begin, begin + _TERMS)
        present, later = moving_hat_weights(pole[part, None] - 1j * wavenumber[part, ::-1] * speed, dt)
        alive = np.minimum(blocks, 1 + (_DECAYED / np.maximum(-np.real(pole[part]), 1e-9) / (_BLOCK * dt)).astype(int))
        for m in range(len(orders)):
            # [mode, force order, force direction, displacement direction]
            product = inp[part, :, :, None] * out[part, m, None, None, :]
            rows = slice(m, m + len(orders))  # of the differences, order of the displacement less that of the force
            now = (product * present[:, :, None, None]).sum(axis=0).reshape(len(orders), 9)
            first[rows] += now
            current = (product * later[:, :, None, None]).reshape(len(product), -1).T.copy()
            rate = pole[part] - 1j * wavenumber[part, m] * speed
            table = np.exp(np.multiply.outer(rate * dt, power))
            advance = np.exp(rate * (_BLOCK * dt))
            for block in range(blocks):
                living = int(np.count_nonzero(alive > block))
                if living == 0:
                    break
                summed = current[:, :living] @ table[:living]
                coefficients[rows, block] += summed.reshape(len(orders), 9, _BLOCK)
                current[:, :living] *= advance[:living]
            done += 1
            if progress:
                progress(min(1.0, done / len(orders) / -(-len(pole) // _TERMS)))
    values = coefficients.transpose(0, 2, 1, 3).reshape(2 * len(orders) - 1, 9, -1)[:, :, :samples]
    values[:, :, 0] = first
    difference = np.arange(-(len(orders) - 1), len(orders))
    x0 = np.arange(positions) * dx
    phase = np.exp(-2j * np.pi * np.multiply.outer(x0, difference) / modes.spacing)
    flat = values.reshape(len(difference), -1)
    result = np.real(phase) @ np.real(flat) - np.imag(phase) @ np.imag(flat)
    return result.reshape(positions, 3, 3, samples)
