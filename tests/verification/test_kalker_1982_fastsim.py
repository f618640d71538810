"""Kalker (1982): FASTSIM against the exact theory, the linear theory and its own limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from exact_creep_forces import ELASTIC, ELLIPSE, FRICTION, LIMIT, exact_cases, worst_by_kind

from wheelrail.contact.creep.fastsim import FastsimSolution, fastsim
from wheelrail.contact.creep.kalker_coefficients import kalker_coefficients
from wheelrail.contact.creep.linear import linear_creep_force


def law(creepage: dict[str, float], **settings) -> FastsimSolution:
    return fastsim(**creepage, **ELASTIC, **FRICTION, **settings)


def creepage(x: float, y: float, spin: float) -> dict[str, float]:
    return {"creepage_x": x, "creepage_y": y, "spin": spin}


def test_exact_theory():
    worst = worst_by_kind(law)
    # Achieved, of mu N: pure 4.6 %, combined 3.4 %, with spin 5.2 %, spin alone (up to 1 / m) 8.2 %.
    assert worst["pure"] < 0.05
    assert worst["combined"] < 0.04
    assert worst["combined with spin"] < 0.06
    assert worst["spin"] < 0.09


def test_spin_moment():
    cases = exact_cases(0.5e-3)
    largest = max(abs(case.force.moment_spin) for case in cases)
    worst = max(abs(law(case.creepage).moment_spin - case.force.moment_spin) for case in cases)
    # Achieved 21 % of the largest moment, 38 N m: the flexibilities fit the forces, the moment is what comes of them.
    assert worst < 0.22 * largest


@pytest.mark.parametrize("kind", [(1e-9, 0.0, 0.0), (0.0, 1e-9, 0.0), (0.0, 0.0, 1e-7), (1e-9, -2e-9, 1e-7)])
def test_small_creepage_is_the_linear_theory(kind):
    # Achieved: 1e-15 without spin (Gauss points across, midpoints along); with it 0.5 / steps^2, here 9e-4 to 5e-5.
    linear = linear_creep_force(**creepage(*kind), **ELASTIC)
    size = math.hypot(linear.force_x, linear.force_y)
    error = []
    for steps in (24, 48, 96):
        found = law(creepage(*kind), steps=steps)
        error.append(math.hypot(found.force_x - linear.force_x, found.force_y - linear.force_y) / size)
    assert max(error) < (1e-3 if kind[2] else 1e-14)
    assert kind[2] == 0.0 or error[2] < 0.26 * error[1] < 0.07 * error[0]


def test_spin_moment_of_small_creepage():
    """Closed form of u = L p with L2 and L3: not the linear theory's, which would need a flexibility of its own."""
    a, b, shear = ELLIPSE["semi_axis_x"], ELLIPSE["semi_axis_y"], ELASTIC["shear_modulus"]
    k = kalker_coefficients(**ELLIPSE, poisson_ratio=0.3)
    lateral = 3.0 * math.pi / 32.0 * shear * a**2 * b * k.c22 * 1e-9
    spin = -32.0 / (15.0 * math.pi) * shear * a * b**3 * math.sqrt(b / a) * k.c23 * 1e-7
    assert law(creepage(0.0, 1e-9, 0.0)).moment_spin == pytest.approx(lateral, rel=5e-4)
    assert law(creepage(0.0, 0.0, 1e-7)).moment_spin == pytest.approx(spin, rel=5e-4)
    # Against C23 and C33: 25 % and 15 % too small.
    assert lateral / linear_creep_force(**creepage(0.0, 1e-9, 0.0), **ELASTIC).moment_spin == pytest.approx(
        0.745, abs=0.02
    )
    assert spin / linear_creep_force(**creepage(0.0, 0.0, 1e-7), **ELASTIC).moment_spin == pytest.approx(
        0.851, abs=2e-3
    )


@pytest.mark.parametrize("kind", [(2e-3, 0.0, 0.0), (0.0, 0.0, 0.5), (1e-3, -1e-3, 0.2)])
def test_convergence(kind):
    fine = law(creepage(*kind), strips=200, steps=1600)
    errors = []
    for strips, steps in ((12, 24), (24, 48), (48, 96)):
        found = law(creepage(*kind), strips=strips, steps=steps)
        errors.append(math.hypot(found.force_x - fine.force_x, found.force_y - fine.force_y) / LIMIT)
    # Achieved with 24 x 48: 0.008 %, 0.18 %, 0.07 %; first order where tractions turn while they slip.
    assert errors[1] < 2e-3
    assert errors[2] < 0.65 * errors[1] < 0.45 * errors[0]


def test_sliding():
    assert law(creepage(0.1, 0.0, 0.0)).force_x == pytest.approx(-LIMIT, rel=1e-13)
    assert law(creepage(0.0, -0.1, 0.0)).force_y == pytest.approx(LIMIT, rel=1e-13)
    full = law(creepage(0.06, -0.08, 0.0))
    assert full.slip_fraction == 1.0
    assert math.hypot(full.force_x, full.force_y) == pytest.approx(LIMIT, rel=1e-13)
    # With a flexibility for each direction the force keeps that of the linear force, here 3.4 degrees off the slip.
    k = kalker_coefficients(**ELLIPSE, poisson_ratio=0.3)
    assert full.force_x / full.force_y == pytest.approx(-0.75 * k.c11 / k.c22, rel=1e-12)


@pytest.mark.parametrize("kind", [(1e-4, 2e-4, 0.02), (1e-3, -1e-3, 0.2), (0.0, 5e-3, -2.0), (0.02, 0.01, 1.0)])
def test_tractions(kind):
    found = law(creepage(*kind))
    size = np.hypot(found.traction_x, found.traction_y)
    assert np.all(size <= found.traction_bound * (1.0 + 1e-14))
    np.testing.assert_allclose(size[found.slip], found.traction_bound[found.slip], rtol=1e-13)
    assert found.cell_area.sum() == pytest.approx(math.pi * ELLIPSE["semi_axis_x"] * ELLIPSE["semi_axis_y"], rel=1e-4)
    assert (found.traction_bound * found.cell_area).sum() == pytest.approx(LIMIT, rel=1e-14)
    assert found.force_x == pytest.approx((found.traction_x * found.cell_area).sum(), abs=1e-9)
    moment = (found.x * found.traction_y - found.y * found.traction_x) * found.cell_area
    assert found.moment_spin == pytest.approx(moment.sum(), abs=1e-12)
    assert np.all(found.x[0] > found.x[-1])  # the leading edge comes first


def test_mirror_image():
    """Left-hand wheel: y, lateral and spin creepage, F2 and M3 change sign."""
    right, left = law(creepage(1e-3, -2e-3, 0.3)), law(creepage(1e-3, 2e-3, -0.3))
    assert left.force_x == pytest.approx(right.force_x, rel=1e-12)
    assert left.force_y == pytest.approx(-right.force_y, rel=1e-12)
    assert left.moment_spin == pytest.approx(-right.moment_spin, rel=1e-12)
    np.testing.assert_allclose(left.traction_x, right.traction_x[:, ::-1], rtol=1e-9, atol=1e-3)


def test_scaling():
    """Lengths times k, load times k^2, spin over k: tractions stay, forces k^2, moment k^3. mu and creepages alike."""
    one = law(creepage(1e-3, -2e-3, 0.3))
    k = 3.0
    large = fastsim(
        **creepage(1e-3, -2e-3, 0.3 / k),
        semi_axis_x=k * ELLIPSE["semi_axis_x"],
        semi_axis_y=k * ELLIPSE["semi_axis_y"],
        shear_modulus=ELASTIC["shear_modulus"],
        poisson_ratio=0.3,
        load=k**2 * FRICTION["load"],
        friction_coefficient=FRICTION["friction_coefficient"],
    )
    np.testing.assert_allclose(large.traction_x, one.traction_x, rtol=1e-9)
    assert large.force_y == pytest.approx(k**2 * one.force_y, rel=1e-12)
    assert large.moment_spin == pytest.approx(k**3 * one.moment_spin, rel=1e-12)
    slippery = fastsim(**creepage(0.5e-3, -1e-3, 0.15), **ELASTIC, load=FRICTION["load"], friction_coefficient=0.15)
    assert slippery.force_x == pytest.approx(0.5 * one.force_x, rel=1e-12)
