"""From the modes of a wheel to their recursions, for a force that is linear between the time steps."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .modal import ModalRecursion
from .ordinary import HIGHEST, discretise

__all__ = ["discretise_modes"]


def discretise_modes(
    *, mass: ArrayLike, stiffness: ArrayLike, damping: ArrayLike, shapes: ArrayLike, dt: float
) -> ModalRecursion:
    """Discretise modes m x'' + c x' + k x = shape . force, displacement = sum of shape x.

    Each mode goes through the same exponential of a matrix as any other system, so that it may be undamped, damped
    beyond its critical damping, or a free body. Modes above `HIGHEST` times half the sampling frequency only yield, by
    their static compliance in the first sample.

    Parameters
    ----------
    mass, stiffness, damping : array_like, shape (n,)
        kg, N/m and N s/m.
    shapes : array_like, shape (n, d)
        Displacement of each mode in the d directions.
    dt : float
        Time step in s.

    Returns
    -------
    ModalRecursion
        Without states for modes that don't move in any of the directions or only yield.
    """
    shapes = np.asarray(shapes, dtype=float)
    moving = np.any(shapes != 0.0, axis=1)
    shapes = shapes[moving]
    m, k, c = (np.asarray(values, dtype=float)[moving] for values in (mass, stiffness, damping))
    n, d = shapes.shape
    transition, drive, output = np.empty((n, 2, 2)), np.empty((n, 2)), np.empty((n, 2))
    firsts = np.empty(n)
    rings = k <= (HIGHEST * np.pi / dt) ** 2 * m
    for i in np.flatnonzero(rings):
        A = np.array([[0.0, 1.0], [-k[i] / m[i], -c[i] / m[i]]])
        mode = discretise(A, np.array([0.0, 1.0 / m[i]]), np.array([1.0, 0.0]), dt=dt)
        transition[i], drive[i], output[i], firsts[i] = mode.phi, mode.beta, mode.c, mode.first
    firsts[~rings] = 1.0 / k[~rings]
    transition, drive, output, ringing = transition[rings], drive[rings], output[rings], shapes[rings]
    return ModalRecursion(
        own=np.ascontiguousarray(transition[:, [0, 1], [0, 1]].T),
        cross=np.ascontiguousarray(transition[:, [0, 1], [1, 0]].T),
        drive=_spread(ringing, drive),
        output=_spread(ringing, output),
        first=np.einsum("ni,n,nj->ij", shapes, firsts, shapes).reshape(d, d),
    )


def _spread(shapes: NDArray, states: NDArray) -> NDArray:
    """Products of shapes (n, d) and values of the two states (n, 2), shape (d, 2 n)."""
    return np.ascontiguousarray(np.einsum("nd,ns->dsn", shapes, states).reshape(shapes.shape[1], -1))
