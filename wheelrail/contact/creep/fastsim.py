"""FASTSIM, Kalker's simplified theory (Kalker 1982): surface displacement proportional to the traction, u = L p.

Along each strip y = const, from the leading edge, where p = 0, to the trailing edge,

    dp_x/dx = xi / L1 - y phi / L3,    dp_y/dx = eta / L2 + x phi / L3      while |p| <= mu p_n,
    L1 = 8 a / (3 G C11),    L2 = 8 a / (3 G C22),    L3 = pi a sqrt(a/b) / (4 G C23),

and p is cut back to the bound in its own direction where it would pass it. The flexibilities give the forces of the
linear theory for small creepages; the spin moment has no flexibility of its own and is what comes of them. Sliding
takes the direction of the linear force, some degrees off the slip's when C11 and C22 differ. (Kalker also gives one
weighted L for all terms: nearer in direction, but under combined creepages the forces miss the exact ones by up to 16 %
of mu N, against 5 %.) The bound is parabolic, like the pressure of such a bedding:

    p_n = 2 N / (pi a b) (1 - x^2/a^2 - y^2/b^2).

Strips lie at Gauss-Legendre points across the width, each with the same number of cells along its own length. For
small creepages the sum over the strips is then exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .creep_force import CreepForce, require_positive
from .kalker_coefficients import kalker_coefficients

__all__ = ["FastsimSolution", "fastsim"]


@dataclass(frozen=True)
class FastsimSolution:
    """Forces and traction field on the rail; arrays have the shape (steps, strips), the leading edge first.

    Attributes
    ----------
    force : CreepForce
        N and N m.
    x, y : ndarray
        Centres of the cells, m.
    cell_area : ndarray
        m2.
    traction_x, traction_y : ndarray
        Pa.
    traction_bound : ndarray
        Friction coefficient times parabolic pressure, Pa.
    slip : ndarray of bool
        Cells whose traction has reached the bound.
    """

    force: CreepForce
    x: NDArray
    y: NDArray
    cell_area: NDArray
    traction_x: NDArray
    traction_y: NDArray
    traction_bound: NDArray
    slip: NDArray

    @property
    def force_x(self) -> float:
        """Longitudinal force in N."""
        return self.force.force_x

    @property
    def force_y(self) -> float:
        """Lateral force in N."""
        return self.force.force_y

    @property
    def moment_spin(self) -> float:
        """Spin moment in N m."""
        return self.force.moment_spin

    @property
    def slip_fraction(self) -> float:
        """Area that slips over the area of the contact."""
        return float(self.cell_area[self.slip].sum() / self.cell_area.sum())


def fastsim(
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
    strips: int = 24,
    steps: int = 48,
) -> FastsimSolution:
    """Load on the rail and tractions.

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
    strips, steps : int
        Strips across the width and cells along each of them.

    Returns
    -------
    FastsimSolution

    Raises
    ------
    ValueError
        For a load or friction coefficient that is not positive, fewer than one strip or step, and outside the range of
        Kalker's table.
    """
    require_positive(
        load=load, friction_coefficient=friction_coefficient, shear_modulus=shear_modulus, strips=strips, steps=steps
    )
    a, b = semi_axis_x, semi_axis_y
    k = kalker_coefficients(semi_axis_x=a, semi_axis_y=b, poisson_ratio=poisson_ratio)
    flexibility = np.array(
        [8.0 * a / (3.0 * k.c11), 8.0 * a / (3.0 * k.c22), 0.25 * math.pi * a * math.sqrt(a / b) / k.c23]
    )
    flexibility /= shear_modulus

    across, width = np.polynomial.legendre.leggauss(strips)
    y_strip = b * across
    half = a * np.sqrt(1.0 - across**2)
    # Centres of the cells, as fractions of the strip's half-length, the leading edge first.
    centre = 1.0 - (2.0 * np.arange(steps) + 1.0) / steps
    x = centre[:, None] * half
    y = np.broadcast_to(y_strip, x.shape)
    area = np.broadcast_to(2.0 / steps * half * (b * width), x.shape)
    pressure = (1.0 - centre[:, None] ** 2) * (1.0 - across**2)
    # Scaled so that the cells carry the load: sliding then gives exactly mu N.
    bound = friction_coefficient * load / float((pressure * area).sum()) * pressure

    p_x, p_y = np.empty_like(x), np.empty_like(x)
    slip = np.empty(x.shape, dtype=bool)
    previous_x = previous_y = np.zeros(strips)
    slope_x = creepage_x / flexibility[0] - y_strip * spin / flexibility[2]
    for i in range(steps):
        # From centre to centre; the first step starts at the edge. Spin grows linearly along the strip, so that the
        # slope in the middle of the step is exact.
        came_from = x[i - 1] if i else half
        step = came_from - x[i]
        slope_y = creepage_y / flexibility[1] + 0.5 * (came_from + x[i]) * spin / flexibility[2]
        trial_x = previous_x - step * slope_x
        trial_y = previous_y - step * slope_y
        size = np.hypot(trial_x, trial_y)
        slip[i] = size > bound[i]
        cut = np.where(slip[i], bound[i] / np.maximum(size, bound[i]), 1.0)
        p_x[i] = previous_x = cut * trial_x
        p_y[i] = previous_y = cut * trial_y
    force = CreepForce(
        force_x=float((p_x * area).sum()),
        force_y=float((p_y * area).sum()),
        moment_spin=float(((x * p_y - y * p_x) * area).sum()),
    )
    return FastsimSolution(force, x, y, area, p_x, p_y, bound, slip)
