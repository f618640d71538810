"""Shen, Hedrick and Elkins (1983): the linear theory with spin, limited by the law of Vermeulen and Johnson.

The resultant of Kalker's linear F1 and F2, spin included, is reduced to [r - r^2/3 + r^3/27] mu N with
r = |F_linear| / (mu N), up to r = 3. Meant for moderate spin: for spin alone the law lets F2 rise to mu N, while the
exact force passes a maximum well below that.
"""

from __future__ import annotations

import math

from .creep_force import CreepForce, require_positive
from .linear import linear_creep_force
from .vermeulen_johnson import saturated_fraction

__all__ = ["shen_hedrick_elkins"]


def shen_hedrick_elkins(
    *,
    creepage_x: float,
    creepage_y: float,
    spin: float,
    semi_axis_x: float,
    semi_axis_y: float,
    load: float,
    friction_coefficient: float,
    shear_modulus: float,
    poisson_ratio: float,
) -> CreepForce:
    """Load on the rail for moderate spin.

    Parameters
    ----------
    creepage_x, creepage_y : float
        Rail relative to wheel over the speed.
    spin : float
        1/m.
    semi_axis_x, semi_axis_y : float
        Of the contact ellipse, in rolling and in lateral direction, m.
    load : float
        Normal force, N.
    friction_coefficient : float
    shear_modulus : float
        Pa, of both bodies.
    poisson_ratio : float

    Returns
    -------
    CreepForce
        The spin moment is the linear one, reduced by the same factor as the forces (common practice; the paper
        leaves the moment out).

    Raises
    ------
    ValueError
        For a load or friction coefficient that is not positive, and outside the range of Kalker's table.
    """
    require_positive(load=load, friction_coefficient=friction_coefficient)
    linear = linear_creep_force(
        creepage_x=creepage_x,
        creepage_y=creepage_y,
        spin=spin,
        semi_axis_x=semi_axis_x,
        semi_axis_y=semi_axis_y,
        shear_modulus=shear_modulus,
        poisson_ratio=poisson_ratio,
    )
    ratio = math.hypot(linear.force_x, linear.force_y) / (friction_coefficient * load)
    factor = saturated_fraction(ratio) / ratio if ratio > 0.0 else 1.0
    return CreepForce(factor * linear.force_x, factor * linear.force_y, factor * linear.moment_spin)
