"""Hertz (1882): contact of two elastic bodies; figures of Pieringer (2011), section 2.2, and independent quadrature."""

from __future__ import annotations

import csv
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from wheelrail.contact.hertz import HertzContact, hertz_contact

DATA = Path(__file__).parents[1] / "data"
STEEL = {"youngs_modulus": 210e9, "poisson_ratio": 0.3}
MODULUS = 210e9 / (2.0 * (1.0 - 0.3**2))  # E*


def solve(radius_x: float, radius_y: float, load: float = 65e3) -> HertzContact:
    return hertz_contact(curvature_x=1.0 / radius_x, curvature_y=1.0 / radius_y, load=load, **STEEL)


def surface_displacement(contact: HertzContact, x: float, y: float) -> float:
    """Sum of both surfaces' displacements at a point in or on the ellipse, by quadrature of Boussinesq's solution.

    u = integral of p(x', y') / (pi E* r): in polar coordinates round the point the kernel 1/r cancels, and along each
    ray the pressure is the square root of a quadratic, whose integral over the ray is known.
    """
    a, b = contact.semi_axis_x, contact.semi_axis_y
    angle = (np.arange(200_000) + 0.5) * (2.0 * np.pi / 200_000)
    # p / p0 = sqrt(c - 2 B r - A r^2) on the ray
    A = (np.cos(angle) / a) ** 2 + (np.sin(angle) / b) ** 2
    B = x * np.cos(angle) / a**2 + y * np.sin(angle) / b**2
    c = max(1.0 - (x / a) ** 2 - (y / b) ** 2, 0.0)
    # substitution s = r + B / A: integral of sqrt(D - A s^2) from s = B / A to its zero
    D = c + B**2 / A
    s0, s1 = B / A, np.sqrt(D / A)
    ratio = np.clip(s0 / s1, -1.0, 1.0)
    ray = 0.5 * (D / np.sqrt(A)) * (0.5 * np.pi - np.arcsin(ratio) - ratio * np.sqrt(1.0 - ratio**2))
    return contact.pressure_max * float(ray.mean()) * 2.0 / MODULUS


def test_figures_of_the_thesis():
    contact = solve(0.46, 0.30)
    assert contact.semi_axis_x == pytest.approx(6.2e-3, abs=0.05e-3)
    assert contact.semi_axis_y == pytest.approx(4.7e-3, abs=0.05e-3)
    assert contact.approach == pytest.approx(78e-6, abs=0.5e-6)
    assert contact.pressure_max == pytest.approx(1.1e9, abs=0.05e9)
    # The same, to the digits that the exact solution has.
    assert contact.semi_axis_x == pytest.approx(6.204e-3, abs=0.5e-6)
    assert contact.semi_axis_y == pytest.approx(4.667e-3, abs=0.5e-6)
    assert contact.approach == pytest.approx(78.13e-6, abs=5e-9)
    assert contact.pressure_max == pytest.approx(1.072e9, abs=0.5e6)
    assert contact.constant == pytest.approx(9.41e10, abs=0, rel=5e-4)


def test_an_independent_implementation():
    with (DATA / "hertz_half_space.csv").open() as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        expected = {row["quantity"]: float(row["value"]) for row in rows}
    contact = hertz_contact(
        curvature_x=1.0 / 0.39, curvature_y=1.0 / 0.30, youngs_modulus=207e9, poisson_ratio=0.3, load=65e3
    )
    # Achieved: 7e-16.
    assert contact.semi_axis_x == pytest.approx(expected["semi_axis_x_m"], abs=0, rel=1e-12)
    assert contact.semi_axis_y == pytest.approx(expected["semi_axis_y_m"], abs=0, rel=1e-12)
    assert contact.pressure_max == pytest.approx(expected["pressure_max_Pa"], abs=0, rel=1e-12)
    assert contact.approach == pytest.approx(expected["approach_m"], abs=0, rel=1e-12)
    assert contact.constant == pytest.approx(expected["constant_N_per_m1.5"], abs=0, rel=1e-12)
    area = math.pi * contact.semi_axis_x * contact.semi_axis_y
    assert area == pytest.approx(expected["area_m2"], abs=0, rel=1e-12)


@pytest.mark.parametrize("radii", [(0.46, 0.30), (0.30, 0.46), (0.46, 0.45999), (0.46, 0.02), (0.46, 80.0)])
def test_pressure_deforms_the_surfaces_to_fit(radii):
    """u(0) = approach, u = approach - gap everywhere else in the ellipse: the pressure solves the contact problem."""
    contact = solve(*radii)
    a, b = contact.semi_axis_x, contact.semi_axis_y
    for x, y in ((0.0, 0.0), (a, 0.0), (0.0, b), (0.5 * a, 0.6 * b)):
        gap = 0.5 * x**2 / radii[0] + 0.5 * y**2 / radii[1]
        fit = (surface_displacement(contact, x, y) - contact.approach + gap) / contact.approach
        # Achieved: 1e-15.
        assert abs(fit) < 1e-13
    assert contact.pressure_max * math.pi * a * b * 2.0 / 3.0 == pytest.approx(65e3, abs=0, rel=1e-13)


def test_circle():
    """Sphere on plane, in closed form (Johnson 1985, section 4.2)."""
    contact = solve(0.3, 0.3)
    a = (3.0 * 65e3 * 0.3 / (4.0 * MODULUS)) ** (1.0 / 3.0)
    # Achieved: 2e-16.
    assert contact.semi_axis_x == pytest.approx(a, abs=0, rel=1e-14)
    assert contact.semi_axis_y == pytest.approx(a, abs=0, rel=1e-14)
    assert contact.approach == pytest.approx(a**2 / 0.3, abs=0, rel=1e-14)
    assert contact.constant == pytest.approx(4.0 / 3.0 * MODULUS * math.sqrt(0.3), abs=0, rel=1e-13)


@pytest.mark.parametrize("excess", [1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
def test_nearly_circular(excess):
    """A/B = 1 + e gives a/b = 1 + 2 e / 3 to first order (expansion of Johnson's eq. 4.28): no digits are lost."""
    contact = solve(0.3 * (1.0 + excess), 0.3)
    # Achieved: e^2 / 9, the next order, and 3e-16.
    assert contact.semi_axis_x / contact.semi_axis_y == pytest.approx(
        1.0 + 2.0 / 3.0 * excess, abs=0.2 * excess**2 + 1e-15
    )


def test_long_ellipse_tends_to_a_line_contact():
    """In the middle of a very long ellipse the pressure and width are those of a line load p' = 3 P / (4 a)."""
    errors = []
    for ratio in (1e2, 1e4, 1e6, 1e8):
        contact = solve(0.3 * ratio, 0.3)
        line_load = 0.75 * 65e3 / contact.semi_axis_x
        half_width = math.sqrt(4.0 * line_load * 0.3 / (math.pi * MODULUS))
        errors.append(abs(contact.semi_axis_y / half_width - 1.0))
    # Achieved: 2.1e-3, 2.3e-5, 2.4e-7, 2.4e-9.
    assert errors[-1] < 1e-8
    assert all(fine < 0.05 * coarse for coarse, fine in pairwise(errors))


def test_axes_swap_with_the_radii():
    one, other = solve(0.46, 0.30), solve(0.30, 0.46)
    assert (one.semi_axis_x, one.semi_axis_y) == (other.semi_axis_y, other.semi_axis_x)
    assert one.approach == other.approach
    assert one.semi_axis_x > one.semi_axis_y  # the ellipse is long where the bodies are flat


def test_scaling_with_the_load():
    one, eight = solve(0.46, 0.30, 65e3), solve(0.46, 0.30, 8 * 65e3)
    assert eight.semi_axis_x == pytest.approx(2.0 * one.semi_axis_x, abs=0, rel=1e-14)
    assert eight.approach == pytest.approx(4.0 * one.approach, abs=0, rel=1e-14)
    assert eight.pressure_max == pytest.approx(2.0 * one.pressure_max, abs=0, rel=1e-14)
    assert eight.constant == pytest.approx(one.constant, abs=0, rel=1e-14)
    # eq. 2.20: the stiffness is the slope of eq. 2.19, here by central differences (achieved 2e-9)
    d, h = one.approach, 1e-4 * one.approach
    slope = one.constant * ((d + h) ** 1.5 - (d - h) ** 1.5) / (2.0 * h)
    assert one.stiffness == pytest.approx(slope, abs=0, rel=1e-8)


@pytest.mark.parametrize("bad", [{"curvature_x": 0.0}, {"curvature_y": -1.0}, {"load": 0.0}])
def test_what_is_no_hertz_contact_is_refused(bad):
    with pytest.raises(ValueError, match="positive"):
        hertz_contact(**{"curvature_x": 2.0, "curvature_y": 3.0, "load": 1e3, **STEEL, **bad})
