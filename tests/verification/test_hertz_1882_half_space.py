"""Hertz (1882): the discretised half-space converges to the exact ellipse.

Averages over positions of the contact on the grid, because a circle of elements grows by jumps.
"""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from thesis_contact import LOAD, POISSON_RATIO, RAIL_RADIUS, WHEEL_RADIUS, distance, grid

from wheelrail.contact.hertz import hertz_contact
from wheelrail.contact.normal import NormalProblem, solve_normal

HERTZ = hertz_contact(
    curvature_x=1 / WHEEL_RADIUS,
    curvature_y=1 / RAIL_RADIUS,
    youngs_modulus=207e9,
    poisson_ratio=POISSON_RATIO,
    load=LOAD,
)
AREA = math.pi * HERTZ.semi_axis_x * HERTZ.semi_axis_y
POSITIONS = {2e-3: 8, 1e-3: 8, 0.5e-3: 8, 0.25e-3: 3}
QUANTITIES = ("force", "approach", "pressure", "area", "stiffness")


@functools.cache
def deviations(dx: float) -> np.ndarray:
    """Relative deviations for each position; force at the exact approach, the others at the exact force."""
    half_space = grid(dx, 2 * math.ceil(8e-3 / dx) + 1)
    found, contact = [], None
    steps = (np.arange(POSITIONS[dx]) + 0.5) / POSITIONS[dx] - 0.5
    for x in steps * dx:
        for y in steps * dx:
            h = distance(half_space, x=x, y=y)
            given_approach = solve_normal(NormalProblem(half_space, h, 1.0, 0.0, HERTZ.approach), contact)
            given_force = solve_normal(NormalProblem(half_space, h, 0.0, 1.0, LOAD), given_approach.contact)
            contact = given_force.contact
            found.append(
                [
                    given_approach.force / LOAD,
                    given_force.approach / HERTZ.approach,
                    given_force.pressure.max() / HERTZ.pressure_max,
                    len(contact) * dx**2 / AREA,
                    given_force.stiffness / HERTZ.stiffness,
                ]
            )
    return np.array(found) - 1.0


def test_deviations_at_every_position():
    # observed: force 1.4e-2, 2.7e-3, 7.0e-4, 1.7e-4; approach 9.0e-3, 1.8e-3, 4.7e-4, 1.1e-4;
    # pressure 1.6e-2, 5.6e-3, 1.2e-3, 1.5e-4; area 19, 7, 3.5, 1.9 %; stiffness 4.1, 1.9, 0.7, 0.4 %
    limits = {
        2e-3: (2e-2, 1.2e-2, 2e-2, 0.22, 5e-2),
        1e-3: (3.5e-3, 2.5e-3, 7e-3, 0.08, 2.2e-2),
        0.5e-3: (9e-4, 6e-4, 1.5e-3, 0.04, 9e-3),
        0.25e-3: (2.2e-4, 1.4e-4, 3e-4, 0.022, 5e-3),
    }
    for dx, limit in limits.items():
        worst = np.abs(deviations(dx)).max(axis=0)
        assert (worst < limit).all(), (dx, dict(zip(QUANTITIES, worst, strict=True)))


@pytest.mark.parametrize(
    ("quantity", "low", "high"),
    [
        ("force", 1.6, 2.1),  # 1.69, 1.85, 1.89
        ("approach", 1.6, 2.1),  # 1.68, 1.84, 1.89
        ("pressure", 1.5, 2.4),  # 1.71, 1.77, 2.20
        ("area", 0.8, 1.3),  # 1.05, 1.11, 0.89: edge elements count as a whole
    ],
)
def test_order_of_convergence_of_the_average(quantity, low, high):
    column = QUANTITIES.index(quantity)
    mean = {dx: abs(deviations(dx)[:, column].mean()) for dx in POSITIONS}
    for coarse, fine in ((2e-3, 1e-3), (1e-3, 0.5e-3), (0.5e-3, 0.25e-3)):
        assert low < math.log2(mean[coarse] / mean[fine]) < high


def test_pressure_is_the_ellipsoid():
    for dx, limit in ((1e-3, 3e-2), (0.5e-3, 1.2e-2)):
        half_space = grid(dx, 2 * math.ceil(8e-3 / dx) + 1)
        normal = solve_normal(NormalProblem(half_space, distance(half_space), 0.0, 1.0, LOAD))
        inside = 1.0 - (half_space.x / HERTZ.semi_axis_x) ** 2 - (half_space.y / HERTZ.semi_axis_y) ** 2
        error = normal.pressure / HERTZ.pressure_max - np.sqrt(np.maximum(inside, 0.0))
        assert math.sqrt(float((error**2).sum()) * dx**2 / AREA) < limit
