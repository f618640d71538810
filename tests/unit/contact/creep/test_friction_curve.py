"""The friction curve: limits, derivatives, energy."""

from __future__ import annotations

import math

import numpy as np
import pytest

from wheelrail.contact.creep.friction_curve import creep_force, creep_stiffness, reduction, steady_creep_force
from wheelrail.contact.creep.linear import linear_creep_force
from wheelrail.contact.creep.shen_hedrick_elkins import shen_hedrick_elkins
from wheelrail.contact.creep.vermeulen_johnson import saturated_fraction, vermeulen_johnson
from wheelrail.contact.friction.laws import ConstantLaw, ExponentialLaw, KraftLaw, PolachLaw

ELASTIC = {"semi_axis_x": 6e-3, "semi_axis_y": 4.5e-3, "shear_modulus": 80e9, "poisson_ratio": 0.3}
STIFFNESS = creep_stiffness(**ELASTIC)
LOAD, STATIC, SPEED = 65e3, 0.3, 14.0
LAWS = [ConstantLaw(), KraftLaw(normalise=False), ExponentialLaw(0.4, 0.1), PolachLaw(0.3, 20.0)]


def random_creepages(number: int) -> list[tuple[float, float, float]]:
    """Creepages of 1e-5 to 0.1 with any spin; every third without."""
    rng = np.random.default_rng(5)
    size = 10.0 ** rng.uniform(-5.0, -1.0, number)
    angle = rng.uniform(-math.pi, math.pi, number)
    spin = rng.normal(size=number) * (np.arange(number) % 3 > 0)
    return list(zip(size * np.cos(angle), size * np.sin(angle), spin, strict=True))


def steady(law, x, y, spin, static=STATIC):
    return steady_creep_force(
        STIFFNESS, creepage_x=x, creepage_y=y, spin=spin, load=LOAD, law=law, static=static, speed=SPEED
    )


def test_stiffness_is_that_of_the_linear_theory():
    force = linear_creep_force(creepage_x=1e-3, creepage_y=-2e-3, spin=0.3, **ELASTIC)
    s = STIFFNESS
    assert force.force_x == pytest.approx(-s.x * 1e-3, rel=1e-15)
    assert force.force_y == pytest.approx(s.y * 2e-3 - s.spin * 0.3, rel=1e-14)
    assert force.moment_spin == pytest.approx(-s.spin * 2e-3 - s.moment * 0.3, rel=1e-14)


@pytest.mark.parametrize("ratio", [0.0, 1e-12, 0.5, 2.0, 3.0 - 1e-9, 3.0, 3.0 + 1e-9, 40.0])
def test_reduction(ratio):
    factor, bend = reduction(ratio)
    assert factor * ratio == pytest.approx(saturated_fraction(ratio), rel=1e-15, abs=0.0)
    h = 1e-6 * max(ratio, 1.0)
    below = max(ratio - h, 0.0)
    slope = (reduction(ratio + h)[0] - reduction(below)[0]) / (ratio + h - below)
    assert bend == pytest.approx(slope, rel=2e-7)  # 1.1e-7 at 0, one-sided; 1e-10


def test_constant_law_is_vermeulen_and_johnson():
    for x, y, spin in random_creepages(200):
        point = steady(ConstantLaw(), x, y, spin)
        arguments = {
            "creepage_x": x,
            "creepage_y": y,
            **ELASTIC,
            "load": LOAD,
            "friction_coefficient": STATIC,
        }
        force = shen_hedrick_elkins(spin=spin, **arguments) if spin != 0.0 else vermeulen_johnson(**arguments)
        # 5e-16 of the force
        size = math.hypot(force.force_x, force.force_y)
        assert math.hypot(point.force[0] - force.force_x, point.force[1] - force.force_y) < 2e-15 * size
        if spin != 0.0:
            assert point.moment_spin == pytest.approx(force.moment_spin, rel=1e-14)


@pytest.mark.parametrize("law", LAWS)
def test_jacobian_over_creepage(law):
    worst = 0.0
    for x, y, spin in random_creepages(300):
        point = steady(law, x, y, spin)
        if abs(point.ratio - 3.0) < 0.01:
            continue  # the second derivative jumps
        h = 1e-5 * math.hypot(x, y)
        columns = [
            (steady(law, x + h * i, y + h * j, spin).force - steady(law, x - h * i, y - h * j, spin).force) / (2.0 * h)
            for i, j in ((1, 0), (0, 1))
        ]
        error = np.abs(point.jacobian - np.transpose(columns)).max()
        worst = max(worst, error / (STIFFNESS.x * point.factor))
    assert worst < 1e-8  # 6e-9 of the secant c_x f / r: rounding of the differences


def test_slope_over_the_coefficient():
    worst = 0.0
    for x, y, spin in random_creepages(300):
        arguments = {"creepage_x": x, "creepage_y": y, "spin": spin, "load": LOAD}
        for mu in (0.05, 0.3):
            point = creep_force(STIFFNESS, coefficient=mu, **arguments)
            if abs(point.ratio - 3.0) < 0.01:
                continue
            h = 1e-5 * mu
            above, below = (creep_force(STIFFNESS, coefficient=mu + step, **arguments) for step in (h, -h))
            worst = max(worst, np.abs(point.by_coefficient - (above.force - below.force) / (2.0 * h)).max() / LOAD)
    assert worst < 1e-9  # 1e-10


def test_held_coefficient_at_no_creepage():
    """Without creepage the Jacobian is Kalker's, whatever the law."""
    for law in LAWS:
        point = steady(law, 0.0, 0.0, 0.0)
        assert np.array_equal(point.jacobian, -np.diag([STIFFNESS.x, STIFFNESS.y]))
        assert not point.force.any()
        assert not point.by_coefficient.any()


@pytest.mark.parametrize("law", LAWS)
def test_full_sliding(law):
    for angle in (0.0, 0.5 * math.pi, 2.1, -1.0):
        x, y = 0.05 * math.cos(angle), 0.05 * math.sin(angle)
        point = steady(law, x, y, 0.0)
        mu = STATIC * float(law.evaluate(np.array([SPEED * 0.05]))[0][0])
        assert point.ratio > 3.0
        assert np.hypot(*point.force) == pytest.approx(mu * LOAD, rel=1e-14)
        # against the linear force
        assert point.force[0] * STIFFNESS.y * y == pytest.approx(point.force[1] * STIFFNESS.x * x, rel=1e-12, abs=1e-9)


def test_falling_curve_has_a_maximum():
    forces = [-steady(ExponentialLaw(0.4, 0.1), 0.0, y, 0.0).force[1] for y in np.geomspace(1e-5, 0.1, 200)]
    peak = int(np.argmax(forces))
    assert 0 < peak < 199
    assert np.all(np.diff(forces[: peak + 1]) > 0.0)
    assert np.all(np.diff(forces[peak:]) < 0.0)


def test_work_is_force_times_creepage_and_never_negative():
    for law in LAWS:
        for x, y, spin in random_creepages(300):
            point = steady(law, x, y, spin)
            work = -(point.force[0] * x + point.force[1] * y + point.moment_spin * spin)
            scale = abs(point.force[1] * y) + abs(point.moment_spin * spin) + abs(point.force[0] * x)
            assert abs(point.work_per_length - work) <= 1e-15 * scale  # 4e-16
            assert point.work_per_length >= 0.0


def test_force_alone_can_seem_to_do_work():
    """Why the spin moment is not left out: creepage against spin."""
    point = steady(ConstantLaw(), 0.0, -1e-4, 0.5)
    assert -point.force[1] * -1e-4 < 0.0 < point.work_per_length


def test_no_friction():
    point = creep_force(STIFFNESS, creepage_x=0.01, creepage_y=0.0, spin=0.0, load=LOAD, coefficient=0.0)
    assert not point.force.any()
    assert not point.jacobian.any()
    assert point.by_coefficient == pytest.approx([-LOAD, 0.0])
    assert point.ratio == math.inf


def test_refuses_what_kalker_s_table_has_not():
    with pytest.raises(ValueError, match="axis ratios"):
        creep_stiffness(semi_axis_x=1e-2, semi_axis_y=1e-4, shear_modulus=80e9, poisson_ratio=0.3)
    with pytest.raises(ValueError, match="shear_modulus"):
        creep_stiffness(semi_axis_x=1e-2, semi_axis_y=1e-2, shear_modulus=0.0, poisson_ratio=0.3)
