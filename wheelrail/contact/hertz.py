"""Hertz contact of two bodies with constant curvatures: the exact ellipse (Hertz 1882).

Equations and notation: Johnson (1985), Contact Mechanics, section 4.2; they give what Pieringer (2011),
eqs. 2.12 to 2.20, takes from tables.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq
from scipy.special import elliprd, elliprf

__all__ = ["HertzContact", "hertz_contact"]


@dataclass(frozen=True)
class HertzContact:
    """Contact ellipse and approach under one load, with the constants that give them for any other.

    Attributes
    ----------
    load : float
        N.
    semi_axis_x, semi_axis_y : float
        Semi-axes in rolling and in lateral direction, m.
    approach : float
        Approach of distant points, m.
    pressure_max : float
        Pa.
    constant : float
        C_H of F = C_H d^1.5 in N/m^1.5 (Pieringer 2011, eq. 2.19).
    """

    load: float
    semi_axis_x: float
    semi_axis_y: float
    approach: float
    pressure_max: float
    constant: float

    @property
    def area(self) -> float:
        """Area of the contact ellipse in m2."""
        return math.pi * self.semi_axis_x * self.semi_axis_y

    @property
    def stiffness(self) -> float:
        """Tangent stiffness 3 P / (2 d) in N/m (Pieringer 2011, eq. 2.20)."""
        return 1.5 * self.load / self.approach


def hertz_contact(
    *, curvature_x: float, curvature_y: float, youngs_modulus: float, poisson_ratio: float, load: float
) -> HertzContact:
    """Solve Hertz contact of two bodies of one material.

    Parameters
    ----------
    curvature_x, curvature_y : float
        Sums of both bodies' curvatures in rolling and in lateral direction, 1/m; both positive.
    youngs_modulus : float
        Pa.
    poisson_ratio : float
    load : float
        N, positive.

    Returns
    -------
    HertzContact

    Raises
    ------
    ValueError
        If a curvature or the load is not positive.
    """
    if curvature_x <= 0.0 or curvature_y <= 0.0 or load <= 0.0:
        raise ValueError("Hertz contact needs positive curvatures and a positive load")
    modulus = youngs_modulus / (2.0 * (1.0 - poisson_ratio**2))  # E* of Johnson, both bodies of one material
    flat, sharp = sorted((0.5 * curvature_x, 0.5 * curvature_y))  # A, B of h = A x^2 + B y^2
    k2 = _squared_axis_ratio(sharp / flat)
    k = math.sqrt(k2)
    # A = (p0 / E*) (b / (e^2 a^2)) (K - E) with p0 = 3 P / (2 pi a b), solved for the long semi-axis a.
    a = (1.5 * load / (math.pi * modulus) * float(elliprd(0.0, k2, 1.0)) / (3.0 * flat)) ** (1.0 / 3.0)
    b = k * a
    approach = 1.5 * load / (math.pi * a * modulus) * float(elliprf(0.0, k2, 1.0))
    pressure = 1.5 * load / (math.pi * a * b)
    along = curvature_x <= curvature_y
    return HertzContact(
        load=load,
        semi_axis_x=a if along else b,
        semi_axis_y=b if along else a,
        approach=approach,
        pressure_max=pressure,
        constant=load / approach**1.5,
    )


def _squared_axis_ratio(ratio: float) -> float:
    """(b/a)^2 <= 1 of the ellipse for B/A = ``ratio`` >= 1 (Johnson 1985, eq. 4.26).

    With Carlson's integrals, (K - E) / e^2 = R_D(0, k2, 1) / 3 and (E / k2 - K) / e^2 = R_D(0, 1, k2) / 3, nothing
    cancels as the ellipse becomes a circle.
    """

    def mismatch(log_k2: float) -> float:
        k2 = math.exp(log_k2)
        return math.log(elliprd(0.0, 1.0, k2) / elliprd(0.0, k2, 1.0)) - math.log(ratio)

    if mismatch(0.0) >= 0.0:
        return 1.0
    root = brentq(mismatch, -100.0, 0.0, xtol=1e-15)
    assert isinstance(root, float)
    return math.exp(root)
