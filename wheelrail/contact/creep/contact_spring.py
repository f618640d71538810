"""The spring of a contact that neither rolls nor slips, against tangential motion (Mindlin 1949)."""

from __future__ import annotations

import math

from .creep_force import require_positive

__all__ = ["tangential_compliance"]


def tangential_compliance(
    *, semi_axis_x: float, semi_axis_y: float, shear_modulus: float, poisson_ratio: float
) -> tuple[float, float]:
    """Displacement of two bodies of one material against each other per tangential force, neither rolling nor slipping.

    Both are half-spaces under the traction F / (2 pi a b) (1 - x^2/a^2 - y^2/b^2)^(-1/2), which displaces the whole
    ellipse alike (Mindlin 1949, J. Appl. Mech. 16, 259-268). From Cerruti's solution in its middle

        C_x = 1 / (pi G) integral over 0..pi/2 of (1 - nu sin^2 t) / sqrt(b^2 cos^2 t + a^2 sin^2 t) dt,

    C_y with cos^2 in the numerator; for a circle both are (2 - nu) / (4 G a), twice that of one body. There is no cross
    term, also for nu > 0.

    Parameters
    ----------
    semi_axis_x, semi_axis_y : float
        a and b in m.
    shear_modulus : float
        Pa, of both bodies.
    poisson_ratio : float

    Returns
    -------
    tuple of float
        C_x and C_y, m/N.
    """
    require_positive(semi_axis_x=semi_axis_x, semi_axis_y=semi_axis_y, shear_modulus=shear_modulus)
    # Both elliptic integrals from one arithmetic-geometric mean: that with sin^2 over that without is
    # 1/2 + sum of 2^(n-1) d_n, d_n = c_n^2 / (b^2 - a^2), c_n half the difference of the pair before.
    scale = max(semi_axis_x, semi_axis_y)
    mean, root = semi_axis_y / scale, semi_axis_x / scale
    first = mean * mean - root * root
    d, weight, with_sine = 0.25 * (mean - root) / (mean + root), 1.0, 0.5
    mean, root = 0.5 * (mean + root), math.sqrt(mean * root)
    while abs(weight * d) > 1e-17:
        with_sine += weight * d
        mean, root = 0.5 * (mean + root), math.sqrt(mean * root)
        d, weight = d * d * first / (16.0 * mean * mean), 2.0 * weight
    alike = 1.0 / (2.0 * shear_modulus * scale * mean)
    return alike * (1.0 - poisson_ratio * with_sine), alike * (1.0 - poisson_ratio * (1.0 - with_sine))
