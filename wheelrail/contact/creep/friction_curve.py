"""Creep force with a falling friction curve, as engineering models of curve squeal have it.

The law of Vermeulen and Johnson (1964) on Kalker's slopes, with a friction coefficient that depends on the slip
velocity s = v |e|, e = (e_x, e_y) the creepage (de Beer, Janssens and Kooijman 2003, J. Sound Vib. 267, 497-507; Huang
2007; the simple law for falling friction that Pieringer 2011, section 6.2, asks for):

    F = -mu(s) N f(r) w / |w|,     w = (c_x e_x, c_y e_y + c_s phi),     r = |w| / (mu(s) N),
    f(r) = r - r^2/3 + r^3/27 up to r = 3, then 1,     c_x = G a b C11,  c_y = G a b C22,  c_s = G (a b)^1.5 C23

Spin phi enters as in Shen, Hedrick and Elkins (1983). The spin moment is the linear one, reduced by the same factor
f / r: then the C23 terms drop out of the work of the contact,

    -(F e + M phi) = (f / r) (c_x e_x^2 + c_y e_y^2 + c_m phi^2) >= 0,     c_m = G (a b)^2 C33,

while the force alone could seem to do work where creepage and spin pull against each other. Spin does not add to s: its
slip vanishes in the middle of the contact.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..friction.laws import FrictionLaw
from .creep_force import require_positive
from .kalker_coefficients import kalker_coefficients

__all__ = [
    "NO_FRICTION",
    "CreepStiffness",
    "CurvePoint",
    "creep_force",
    "creep_stiffness",
    "reduction",
    "steady_creep_force",
]

NO_FRICTION = 1e-100  # mu N over the linear force: friction may vanish at high slip velocity


class CreepStiffness(NamedTuple):
    """Linear theory on one contact ellipse: what its force and moment have per creepage and spin, all positive.

    Attributes
    ----------
    x, y : float
        c_x and c_y, force per creepage, N.
    spin : float
        c_s, lateral force per spin, and spin moment per lateral creepage, N m.
    moment : float
        c_m, spin moment per spin, N m2.
    """

    x: float
    y: float
    spin: float
    moment: float


class CurvePoint(NamedTuple):
    """Creep force at one creepage, and how it changes.

    Attributes
    ----------
    force : ndarray, shape (2,)
        On the rail, N.
    moment_spin : float
        N m.
    jacobian : ndarray, shape (2, 2)
        dF / de in N, row by force, column by creepage; the friction coefficient moves with e as its slope says.
    by_coefficient : ndarray, shape (2,)
        dF / d mu at constant e, N.
    coefficient : float
        mu.
    ratio : float
        r, linear force over mu N; from 3 on the whole contact slides.
    factor : float
        f(r) / r, force over linear force.
    work_per_length : float
        Work of friction per rolled length, -(F e + M phi), N.
    """

    force: NDArray
    moment_spin: float
    jacobian: NDArray
    by_coefficient: NDArray
    coefficient: float
    ratio: float
    factor: float
    work_per_length: float


def creep_stiffness(
    *, semi_axis_x: float, semi_axis_y: float, shear_modulus: float, poisson_ratio: float
) -> CreepStiffness:
    """Kalker's linear theory on one ellipse.

    Parameters
    ----------
    semi_axis_x, semi_axis_y : float
        Of the contact ellipse, in rolling and in lateral direction, m.
    shear_modulus : float
        Pa, of both bodies.
    poisson_ratio : float

    Returns
    -------
    CreepStiffness

    Raises
    ------
    ValueError
        Outside the range of Kalker's table (see `kalker_coefficients`).
    """
    require_positive(shear_modulus=shear_modulus)
    k = kalker_coefficients(semi_axis_x=semi_axis_x, semi_axis_y=semi_axis_y, poisson_ratio=poisson_ratio)
    area = semi_axis_x * semi_axis_y
    scale = shear_modulus * area
    return CreepStiffness(scale * k.c11, scale * k.c22, scale * math.sqrt(area) * k.c23, scale * area * k.c33)


def reduction(ratio: float) -> tuple[float, float]:
    """Return f(r) / r and its slope over r; at r = 0 they are 1 and -1/3."""
    if ratio < 3.0:
        return 1.0 - ratio * (9.0 - ratio) / 27.0, (2.0 * ratio - 9.0) / 27.0
    return 1.0 / ratio, -1.0 / (ratio * ratio)


def creep_force(
    stiffness: CreepStiffness,
    *,
    creepage_x: float,
    creepage_y: float,
    spin: float,
    load: float,
    coefficient: float,
    slope: float = 0.0,
    speed: float = 0.0,
) -> CurvePoint:
    """Force on the rail for a friction coefficient, and its derivatives.

    Parameters
    ----------
    stiffness : CreepStiffness
    creepage_x, creepage_y : float
        Rail relative to wheel over the speed.
    spin : float
        1/m.
    load : float
        Normal force, N, > 0.
    coefficient : float
        mu >= 0 at this creepage.
    slope : float
        d mu / ds in s/m, s = v |e|; 0: the coefficient is held.
    speed : float
        v in m/s; without effect if ``slope`` is 0.

    Returns
    -------
    CurvePoint
        Where e = 0, |e| has no derivative, and the coefficient is held there. That matters only with spin: without,
        the friction coefficient has no effect on the force to first order.
    """
    w_x, w_y = stiffness.x * creepage_x, stiffness.y * creepage_y + stiffness.spin * spin
    size, bound = math.hypot(w_x, w_y), coefficient * load
    n_x, n_y, ratio = 0.0, 0.0, 0.0
    if size > 0.0:
        n_x, n_y = w_x / size, w_y / size
        ratio = size / bound if bound > NO_FRICTION * size else math.inf
    factor, bend = reduction(ratio)
    # d(f/r w) = f/r dw + (f/r)' r n (n dw), and over mu: -N n (f - r f') with f - r f' = -r^2 (f/r)'
    along = ratio * bend if ratio < math.inf else 0.0
    by_x, by_y = (load * ratio * along * n for n in (n_x, n_y)) if ratio < math.inf else (-load * n_x, -load * n_y)
    total = math.hypot(creepage_x, creepage_y)
    gradient = slope * speed / total if slope != 0.0 and total > 0.0 else 0.0
    mu_x, mu_y = gradient * creepage_x, gradient * creepage_y
    jacobian = [
        [by_x * mu_x - stiffness.x * (factor + along * n_x * n_x), by_x * mu_y - stiffness.y * along * n_x * n_y],
        [by_y * mu_x - stiffness.x * along * n_x * n_y, by_y * mu_y - stiffness.y * (factor + along * n_y * n_y)],
    ]
    squares = stiffness.x * creepage_x**2 + stiffness.y * creepage_y**2 + stiffness.moment * spin**2
    return CurvePoint(
        force=np.array([-factor * w_x, -factor * w_y]),
        moment_spin=factor * (stiffness.spin * creepage_y - stiffness.moment * spin),
        jacobian=np.array(jacobian),
        by_coefficient=np.array([by_x, by_y]),
        coefficient=coefficient,
        ratio=ratio,
        factor=factor,
        work_per_length=factor * squares,
    )


def steady_creep_force(
    stiffness: CreepStiffness,
    *,
    creepage_x: float,
    creepage_y: float,
    spin: float,
    load: float,
    law: FrictionLaw,
    static: float,
    speed: float,
) -> CurvePoint:
    """Force on the rail in steady rolling: the friction coefficient is that of the law at s = v |e|.

    Parameters
    ----------
    stiffness : CreepStiffness
    creepage_x, creepage_y, spin, load : float
        As for `creep_force`.
    law : FrictionLaw
    static : float
        mu_s.
    speed : float
        v in m/s.

    Returns
    -------
    CurvePoint
        Its Jacobian is the slope of the whole curve, the fall of friction included.
    """
    ratio, slope = law.evaluate(np.array([speed * math.hypot(creepage_x, creepage_y)]))
    return creep_force(
        stiffness,
        creepage_x=creepage_x,
        creepage_y=creepage_y,
        spin=spin,
        load=load,
        coefficient=static * float(ratio[0]),
        slope=static * float(slope[0]),
        speed=speed,
    )
