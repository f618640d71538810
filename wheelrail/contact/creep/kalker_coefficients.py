"""Kalker's creepage and spin coefficients for an ellipse: his table, interpolated.

The table: Kalker (1990), Three-Dimensional Elastic Bodies in Rolling Contact, table E.3. In the axis ratio: cubic
through the four nearest entries, ln C against ln(a/b), for C has powers of a/b as limits. In Poisson's ratio: parabola
through the three columns, of 1/C, which is close to linear (C11 = pi^2 / (4 (1 - nu)) for a/b -> 0). Only C33 of a long
ellipse (a > b) is itself closer to linear; between a/b = 1/2 and 2 both are blended.

Accuracy against a numerical no-slip solution: 0.8 % for axis ratios of 0.2 to 5, 1.2 % from 0.1 to 10, all of it in the
book's figures; the interpolation itself errs by 0.03 %, in C33 by 0.5 %
(tests/verification/test_kalker_linear_theory.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .creep_force import require_positive

__all__ = ["AXIS_RATIO", "POISSON_RATIO", "TABLE", "KalkerCoefficients", "interpolate", "kalker_coefficients"]


@dataclass(frozen=True)
class KalkerCoefficients:
    """Coefficients of the linear theory, all positive and dimensionless.

    Attributes
    ----------
    c11, c22 : float
        Longitudinal and lateral creepage.
    c23 : float
        Spin to lateral force, and lateral creepage to spin moment.
    c33 : float
        Spin to spin moment.
    """

    c11: float
    c22: float
    c23: float
    c33: float


POISSON_RATIO = np.array([0.0, 0.25, 0.5])
# a/b, a in rolling direction; the book gives a/b up to 1 and b/a from there.
AXIS_RATIO = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
AXIS_RATIO = np.concatenate([AXIS_RATIO, 1.0 / AXIS_RATIO[-2::-1]])

# One row per axis ratio: C11, C22, C23, C33, each for the three Poisson's ratios.
TABLE = np.array(
    [
        [2.51, 3.31, 4.85, 2.51, 2.52, 2.53, 0.334, 0.473, 0.731, 6.42, 8.28, 11.7],  # a/b = 0.1
        [2.59, 3.37, 4.81, 2.59, 2.63, 2.66, 0.483, 0.603, 0.809, 3.46, 4.27, 5.66],  # a/b = 0.2
        [2.68, 3.44, 4.8, 2.68, 2.75, 2.81, 0.607, 0.715, 0.889, 2.49, 2.96, 3.72],  # a/b = 0.3
        [2.78, 3.53, 4.82, 2.78, 2.88, 2.98, 0.72, 0.823, 0.977, 2.02, 2.32, 2.77],  # a/b = 0.4
        [2.88, 3.62, 4.83, 2.88, 3.01, 3.14, 0.827, 0.929, 1.07, 1.74, 1.93, 2.22],  # a/b = 0.5
        [2.98, 3.72, 4.91, 2.98, 3.14, 3.31, 0.93, 1.03, 1.18, 1.56, 1.68, 1.86],  # a/b = 0.6
        [3.09, 3.81, 4.97, 3.09, 3.28, 3.48, 1.03, 1.14, 1.29, 1.43, 1.5, 1.6],  # a/b = 0.7
        [3.19, 3.91, 5.05, 3.19, 3.41, 3.65, 1.13, 1.25, 1.4, 1.34, 1.37, 1.42],  # a/b = 0.8
        [3.29, 4.01, 5.12, 3.29, 3.54, 3.82, 1.23, 1.36, 1.51, 1.27, 1.27, 1.27],  # a/b = 0.9
        [3.4, 4.12, 5.2, 3.4, 3.67, 3.98, 1.33, 1.47, 1.63, 1.21, 1.19, 1.16],  # a/b = 1.0
        [3.51, 4.22, 5.3, 3.51, 3.81, 4.16, 1.44, 1.59, 1.77, 1.16, 1.11, 1.06],  # b/a = 0.9
        [3.65, 4.36, 5.42, 3.65, 3.99, 4.39, 1.58, 1.75, 1.94, 1.1, 1.04, 0.954],  # b/a = 0.8
        [3.82, 4.54, 5.58, 3.82, 4.21, 4.67, 1.76, 1.95, 2.18, 1.05, 0.965, 0.852],  # b/a = 0.7
        [4.06, 4.78, 5.8, 4.06, 4.5, 5.04, 2.01, 2.23, 2.5, 1.01, 0.892, 0.751],  # b/a = 0.6
        [4.37, 5.1, 6.11, 4.37, 4.9, 5.56, 2.35, 2.62, 2.96, 0.958, 0.819, 0.65],  # b/a = 0.5
        [4.84, 5.57, 6.57, 4.84, 5.48, 6.31, 2.88, 3.24, 3.7, 0.912, 0.747, 0.549],  # b/a = 0.4
        [5.57, 6.34, 7.34, 5.57, 6.4, 7.51, 3.79, 4.32, 5.01, 0.868, 0.674, 0.446],  # b/a = 0.3
        [6.96, 7.78, 8.82, 6.96, 8.14, 9.79, 5.72, 6.63, 7.89, 0.828, 0.601, 0.341],  # b/a = 0.2
        [10.7, 11.7, 12.9, 10.7, 12.8, 16.0, 12.2, 14.6, 18.0, 0.795, 0.526, 0.228],  # b/a = 0.1
    ]
).reshape(-1, 4, 3)


def kalker_coefficients(*, semi_axis_x: float, semi_axis_y: float, poisson_ratio: float) -> KalkerCoefficients:
    """Coefficients for one contact ellipse.

    Parameters
    ----------
    semi_axis_x, semi_axis_y : float
        Semi-axes in rolling and in lateral direction, m; their ratio between 0.1 and 10.
    poisson_ratio : float
        0 to 0.5.

    Raises
    ------
    ValueError
        Outside the range of the table.
    """
    require_positive(semi_axis_x=semi_axis_x, semi_axis_y=semi_axis_y)
    ratio = semi_axis_x / semi_axis_y
    if not 0.1 * (1.0 - 1e-12) <= ratio <= 10.0 * (1.0 + 1e-12):
        raise ValueError(
            f"Kalker's table has axis ratios semi_axis_x / semi_axis_y from 0.1 to 10, this ellipse has {ratio:g}"
        )
    if not 0.0 <= poisson_ratio <= 0.5:
        raise ValueError(f"poisson_ratio must lie between 0 and 0.5, it is {poisson_ratio:g}")
    c11, c22, c23, c33 = interpolate(math.log(ratio), poisson_ratio, np.log(AXIS_RATIO), TABLE)
    return KalkerCoefficients(float(c11), float(c22), float(c23), float(c33))


def interpolate(log_ratio: float, poisson_ratio: float, nodes: NDArray, table: NDArray) -> NDArray:
    """Interpolate a table of coefficients.

    Parameters
    ----------
    log_ratio : float
        ln(a/b).
    poisson_ratio : float
    nodes : ndarray, shape (n,)
        ln(a/b) of the entries, increasing.
    table : ndarray, shape (n, 4, 3)

    Returns
    -------
    ndarray, shape (4,)
        C11, C22, C23, C33.
    """
    first = min(max(int(np.searchsorted(nodes, log_ratio)) - 2, 0), len(nodes) - 4)
    near = slice(first, first + 4)
    columns = np.exp(np.tensordot(_lagrange(nodes[near], log_ratio), np.log(table[near]), axes=1))
    across = _lagrange(POISSON_RATIO, poisson_ratio)
    coefficients = 1.0 / ((1.0 / columns) @ across)
    long = min(max(0.5 + 0.5 * log_ratio / math.log(2.0), 0.0), 1.0)
    coefficients[3] = (1.0 - long) * coefficients[3] + long * (columns[3] @ across)
    return coefficients


def _lagrange(nodes: NDArray, at: float) -> NDArray:
    """Weights of the values at the nodes in the polynomial through them."""
    difference = nodes[:, None] - nodes[None, :]
    np.fill_diagonal(difference, 1.0)
    factor = np.broadcast_to(at - nodes, difference.shape).copy()
    np.fill_diagonal(factor, 1.0)
    return np.prod(factor / difference, axis=1)
