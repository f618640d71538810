"""Carter (1926): steady rolling of a cylinder, plane strain, longitudinal creepage (Johnson 1985, section 8.3).

A line contact of half-length a with Hertz pressure p0 sqrt(1 - x^2/a^2) sticks over a strip of half-length s that
touches the leading edge x = +a. The traction is the difference of two ellipses,

    |p| = (mu p0 / a) [sqrt(a^2 - x^2) - sqrt(s^2 - (x - a + s)^2)],     s / a = 1 - |xi| / xi_s,

with full sliding from xi_s = 2 (1 - nu) mu p0 / G on, and the force per width F = mu P [1 - (s/a)^2], P = pi a p0 / 2.
It is Pieringer (2011), eq. 2.28, with k = 2 / xi_s; for a wheel of radius R on a plane, p0 = G a / (2 (1 - nu) R) and
k = 2 R / (mu a). (The 4 R / (mu a) printed there would saturate at half the creepage, against Kalker's limit of an
infinitely wide ellipse, C11 = pi^2 / (4 (1 - nu)), which this law gives.)
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .creep_force import require_positive

__all__ = ["CarterSolution", "carter"]


@dataclass(frozen=True)
class CarterSolution:
    """Line contact under longitudinal creepage.

    Attributes
    ----------
    force_x : float
        On the rail, per width, N/m.
    half_length : float
        Of the contact, m.
    stick_half_length : float
        Of the stick area, m; it ends at the leading edge. 0 when the contact slides.
    traction_bound : float
        mu p0, Pa.
    direction : float
        Sign of the traction on the rail: -1, 0 or 1.
    """

    force_x: float
    half_length: float
    stick_half_length: float
    traction_bound: float
    direction: float

    @property
    def stick_fraction(self) -> float:
        """Length that sticks over the length of the contact."""
        return self.stick_half_length / self.half_length

    def traction(self, x: ArrayLike) -> NDArray:
        """Traction on the rail in Pa at x in m (any shape), rolling towards +x; zero outside the contact."""
        x = np.asarray(x, dtype=float)
        a, s = self.half_length, self.stick_half_length
        whole = np.sqrt(np.maximum((a - x) * (a + x), 0.0))
        stick = np.sqrt(np.maximum((a - x) * (x - a + 2.0 * s), 0.0))
        return self.direction * self.traction_bound / a * (whole - stick)


def carter(
    *,
    creepage_x: float,
    half_length: float,
    pressure_max: float,
    friction_coefficient: float,
    shear_modulus: float,
    poisson_ratio: float,
) -> CarterSolution:
    """Solve Carter's problem for two bodies of one material.

    Parameters
    ----------
    creepage_x : float
        Rail relative to wheel over the speed.
    half_length : float
        Of the line contact, m.
    pressure_max : float
        p0, Pa.
    friction_coefficient : float
    shear_modulus : float
        Pa.
    poisson_ratio : float

    Returns
    -------
    CarterSolution

    Raises
    ------
    ValueError
        If a length, pressure, modulus or the friction coefficient is not positive.
    """
    require_positive(
        half_length=half_length,
        pressure_max=pressure_max,
        friction_coefficient=friction_coefficient,
        shear_modulus=shear_modulus,
    )
    bound = friction_coefficient * pressure_max
    saturation = 2.0 * (1.0 - poisson_ratio) * bound / shear_modulus
    used = min(abs(creepage_x) / saturation, 1.0)
    direction = -math.copysign(1.0, creepage_x) if creepage_x != 0.0 else 0.0
    return CarterSolution(
        force_x=direction * 0.5 * math.pi * half_length * bound * used * (2.0 - used),
        half_length=half_length,
        stick_half_length=half_length * (1.0 - used),
        traction_bound=bound,
        direction=direction,
    )
