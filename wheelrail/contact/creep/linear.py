"""Kalker's linear theory: no slip anywhere, forces without bound (Kalker 1967, 1990; Pieringer 2011, eqs. 2.29, 2.30).

    F1 = -G a b C11 xi
    F2 = -G a b (C22 eta + c C23 phi),       c = sqrt(a b)
    M3 = -G a b (-c C23 eta + c^2 C33 phi)

The signs of the C23 terms: tractions grow from the leading edge (x = +a) to the trailing edge. Under lateral creepage,
p_y < 0 is thus largest at x < 0, and M3 = integral of x p_y > 0. Under spin, slip is x phi and p_y ~ -(a^2 - x^2) phi:
F2 < 0. Betti's reciprocity makes both coefficients the same.
"""

from __future__ import annotations

import math

from .creep_force import CreepForce, require_positive
from .kalker_coefficients import kalker_coefficients

__all__ = ["linear_creep_force"]


def linear_creep_force(
    *,
    creepage_x: float,
    creepage_y: float,
    spin: float,
    semi_axis_x: float,
    semi_axis_y: float,
    shear_modulus: float,
    poisson_ratio: float,
) -> CreepForce:
    """Load on the rail for creepages that tend to zero.

    Parameters
    ----------
    creepage_x, creepage_y : float
        Rail relative to wheel over the speed.
    spin : float
        1/m.
    semi_axis_x, semi_axis_y : float
        Of the contact ellipse, in rolling and in lateral direction, m.
    shear_modulus : float
        Pa, of both bodies.
    poisson_ratio : float

    Returns
    -------
    CreepForce

    Raises
    ------
    ValueError
        Outside the range of Kalker's table (see `kalker_coefficients`).
    """
    require_positive(shear_modulus=shear_modulus)
    k = kalker_coefficients(semi_axis_x=semi_axis_x, semi_axis_y=semi_axis_y, poisson_ratio=poisson_ratio)
    area = semi_axis_x * semi_axis_y
    c = math.sqrt(area)
    scale = -shear_modulus * area
    return CreepForce(
        force_x=scale * k.c11 * creepage_x,
        force_y=scale * (k.c22 * creepage_y + c * k.c23 * spin),
        moment_spin=scale * (-c * k.c23 * creepage_y + area * k.c33 * spin),
    )
