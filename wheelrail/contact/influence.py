"""Influence coefficients of the elastic half-space for rectangular elements (Kalker 1990; Pieringer 2011, Appendix B).

A traction, constant over an element of dx by dy, displaces the surface at the centre of another element. Wheel and rail
are of one material, so the displacement difference of the two is twice that of one body and normal and tangential
directions do not couple.

    A33 = (1 - nu) J3 / (pi G),         A11 = (J3 - nu J2) / (pi G),
    A22 = (J3 - nu J1) / (pi G),        A12 = A21 = nu J4 / (pi G)

J1 integrates x^2/r^3, J2 y^2/r^3, J3 1/r and J4 x y/r^3 over the loaded element, seen from the receiving point.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["InfluenceCoefficients", "influence_coefficients"]


class InfluenceCoefficients(NamedTuple):
    """Displacement difference per traction, m/Pa; arrays of one shape.

    Attributes
    ----------
    a33 : ndarray
        Normal displacement by normal traction.
    a11, a22, a12 : ndarray
        Tangential displacements by tangential tractions; a12 = a21.
    """

    a33: NDArray
    a11: NDArray
    a22: NDArray
    a12: NDArray


def influence_coefficients(
    x: ArrayLike, y: ArrayLike, *, dx: float, dy: float, shear_modulus: float, poisson_ratio: float
) -> InfluenceCoefficients:
    """Evaluate the coefficients at given distances.

    Parameters
    ----------
    x, y : array_like
        Receiving point minus centre of the loaded element, m; broadcast against each other. They need not be
        multiples of dx and dy, so that x + dx gives the functions that carry the tractions of the previous step.
    dx, dy : float
        Element sides in m.
    shear_modulus : float
        G in Pa.
    poisson_ratio : float

    Returns
    -------
    InfluenceCoefficients
    """
    x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    a, b = x - 0.5 * dx, x + 0.5 * dx
    c, d = y - 0.5 * dy, y + 0.5 * dy
    j1 = _g(d, b) - _g(d, a) - _g(c, b) + _g(c, a)
    j2 = _g(b, d) - _g(a, d) - _g(b, c) + _g(a, c)
    j3 = j1 + j2
    j4 = -np.hypot(b, d) + np.hypot(a, d) + np.hypot(b, c) - np.hypot(a, c)
    scale = 1.0 / (np.pi * shear_modulus)
    nu = poisson_ratio
    return InfluenceCoefficients(
        a33=(1.0 - nu) * j3 * scale, a11=(j3 - nu * j2) * scale, a22=(j3 - nu * j1) * scale, a12=nu * j4 * scale
    )


def _g(x: NDArray, y: NDArray) -> NDArray:
    """Evaluate x ln(y + hypot(x, y)), for y < 0 by its reflection, since the sum would cancel; 0 at x = 0."""
    r = np.hypot(x, y)
    far = np.maximum(np.abs(y) + r, np.finfo(float).tiny)
    # ln(y + r) = ln(x^2) - ln(r - y)
    with np.errstate(divide="ignore", invalid="ignore"):
        log = np.where(y >= 0.0, np.log(far), 2.0 * np.log(np.abs(x)) - np.log(far))
    return np.where(x == 0.0, 0.0, x * log)
