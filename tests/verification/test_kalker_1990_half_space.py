"""Kalker (1990), table E.3: the creepage coefficients by the discretised half-space under small creepages.

Averages over positions of the contact on the grid, referred to the area of the elements in contact. The error is of the
first order in dx, so that two grids extrapolate.
"""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from thesis_contact import (
    FRICTION,
    LOAD,
    POISSON_RATIO,
    RAIL_RADIUS,
    SHEAR_MODULUS,
    WHEEL_RADIUS,
    distance,
    grid,
    loaded,
)

from wheelrail.contact.creep.kalker_coefficients import kalker_coefficients
from wheelrail.contact.hertz import hertz_contact
from wheelrail.contact.rolling import steady_rolling

SMALL = 1e-7
NAMES = ("c11", "c22", "c23 of the force", "c23 of the moment", "c33")


@functools.cache
def ratio_to_table(dx: float, positions: int) -> np.ndarray:
    """Coefficients over Kalker's, in the order of NAMES."""
    hertz = hertz_contact(
        curvature_x=1 / WHEEL_RADIUS,
        curvature_y=1 / RAIL_RADIUS,
        youngs_modulus=207e9,
        poisson_ratio=POISSON_RATIO,
        load=LOAD,
    )
    a, b = hertz.semi_axis_x, hertz.semi_axis_y
    table = kalker_coefficients(semi_axis_x=a, semi_axis_y=b, poisson_ratio=POISSON_RATIO)
    half_space = grid(dx, 2 * math.ceil(8e-3 / dx) + 1)
    found = []
    offsets = ((np.arange(positions) + 0.5) / positions - 0.5) * dx
    for x in offsets:
        for y in offsets:
            normal = loaded(half_space, distance(half_space, x=x, y=y))
            area = len(normal.contact) * dx**2 / math.pi  # a b
            spin = SMALL / 5e-3
            along, across, turning = (
                steady_rolling(
                    half_space,
                    normal,
                    friction=FRICTION,
                    creepage_x=case[0],
                    creepage_y=case[1],
                    creepage_spin=case[2],
                )
                # spin about the contact's centre
                for case in ((SMALL, 0.0, 0.0), (0.0, SMALL, 0.0), (y * spin, -x * spin, spin))
            )
            assert not np.any([state.slipping for state in (along, across, turning)])
            force = -SHEAR_MODULUS * area * SMALL
            c = math.sqrt(area)
            found.append(
                [
                    along.force_x / force / table.c11,
                    across.force_y / force / table.c22,
                    turning.force_y / (force * c / 5e-3) / table.c23,
                    -(across.moment_spin - x * across.force_y + y * across.force_x) / (force * c) / table.c23,
                    (turning.moment_spin - x * turning.force_y + y * turning.force_x)
                    / (force * area / 5e-3)
                    / table.c33,
                ]
            )
    return np.mean(found, axis=0)


def test_extrapolates_to_the_table_from_2_and_1_mm():
    coarse, fine = ratio_to_table(2e-3, 8), ratio_to_table(1e-3, 6)
    # at 1 mm +2.0, +2.4, -6.8, -6.8, +17.2 %; extrapolated -0.3, -0.6, -1.4, -1.4, +1.1 %
    assert (np.abs(fine - 1.0) < (0.03, 0.04, 0.08, 0.08, 0.2)).all()
    assert (np.abs(2.0 * fine - coarse - 1.0) < (0.015, 0.015, 0.03, 0.03, 0.03)).all()


@pytest.mark.slow
def test_extrapolates_to_the_table_from_1_and_half_a_mm():
    coarse, fine = ratio_to_table(1e-3, 6), ratio_to_table(0.5e-3, 5)
    # at 0.5 mm +1.1, +1.4, -3.1, -3.1, +8.6 %; extrapolated +0.3, +0.4, +0.5, +0.5, +0.04 %; the table has 3 digits
    assert (np.abs(fine - 1.0) < (0.015, 0.02, 0.04, 0.04, 0.1)).all()
    assert (np.abs(2.0 * fine - coarse - 1.0) < (0.01, 0.01, 0.02, 0.02, 0.02)).all()


def test_spin_force_and_creepage_moment_are_reciprocal():
    """The same coefficient C23 (Betti)."""
    ratio = ratio_to_table(1e-3, 6)
    assert ratio[2] == pytest.approx(ratio[3], rel=1e-8)
