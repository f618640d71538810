"""Vermeulen and Johnson (1964): elliptical stick area, creepage without spin.

    |F| = mu N [1 - (1 - tau)^3]   for tau <= 1, mu N beyond,      tau = |F_linear| / (3 mu N)

in the direction of the linear force. The slope at zero creepage is Kalker's, as in Shen, Hedrick and Elkins (1983). The
original has its own: its stick ellipse touches the leading edge at one point only, and in the sickle between both
the tractions do not oppose the slip. For a circle it gives C11 = 16 / (4 - 3 nu) and C22 = 16 / (4 - nu), about a fifth
and a sixth above Kalker's.
"""

from __future__ import annotations

import math

from .creep_force import CreepForce, require_positive
from .linear import linear_creep_force

__all__ = ["saturated_fraction", "vermeulen_johnson"]


def saturated_fraction(linear_ratio: float) -> float:
    """Force over mu N for a linear force over mu N (both not negative): r - r^2/3 + r^3/27 up to r = 3, then 1."""
    tau = min(linear_ratio / 3.0, 1.0)
    return tau * (3.0 - tau * (3.0 - tau))  # 1 - (1 - tau)^3 without cancellation


def vermeulen_johnson(
    *,
    creepage_x: float,
    creepage_y: float,
    semi_axis_x: float,
    semi_axis_y: float,
    load: float,
    friction_coefficient: float,
    shear_modulus: float,
    poisson_ratio: float,
) -> CreepForce:
    """Force on the rail without spin.

    Parameters
    ----------
    creepage_x, creepage_y : float
        Rail relative to wheel over the speed.
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
        With a spin moment of 0: the theory has none.

    Raises
    ------
    ValueError
        For a load or friction coefficient that is not positive, and outside the range of Kalker's table.
    """
    require_positive(load=load, friction_coefficient=friction_coefficient)
    linear = linear_creep_force(
        creepage_x=creepage_x,
        creepage_y=creepage_y,
        spin=0.0,
        semi_axis_x=semi_axis_x,
        semi_axis_y=semi_axis_y,
        shear_modulus=shear_modulus,
        poisson_ratio=poisson_ratio,
    )
    ratio = math.hypot(linear.force_x, linear.force_y) / (friction_coefficient * load)
    factor = saturated_fraction(ratio) / ratio if ratio > 0.0 else 1.0
    return CreepForce(factor * linear.force_x, factor * linear.force_y, 0.0)
