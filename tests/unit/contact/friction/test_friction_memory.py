"""Friction memory: its differential equation, its derivatives, its limits."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.contact.friction.laws import KraftLaw
from wheelrail.contact.friction.memory import FrictionMemory

MEMORY = FrictionMemory(distance=5e-6, speed=1e-3)


def after(speed: float, law: float, start: float, *, time: float, steps: int, memory: FrictionMemory = MEMORY) -> float:
    """Coefficient after some steps at constant slip velocity."""
    mu = np.array([start])
    for _ in range(steps):
        mu, _, _ = memory.follow(np.array([law]), np.zeros(1), np.array([speed]), previous=mu, dt=time / steps)
    return float(mu[0])


@pytest.mark.parametrize("speed", [0.0, 4e-4, 0.02, 3.0])
def test_constant_slip_gives_the_exponential_of_first_order(speed):
    rate = max(speed, 1e-3) / 5e-6
    time = 1.5 / rate
    exact = 0.2 + (0.35 - 0.2) * np.exp(-1.5)
    errors = np.array([after(speed, 0.2, 0.35, time=time, steps=n) - exact for n in (50, 100, 200, 400, 800)])
    np.testing.assert_allclose(errors[:-1] / errors[1:], 2.0, rtol=1e-2)  # 0.4 %, then half of it at each
    # Euler's own error: h / 2 of the rate squared
    assert errors[-1] == pytest.approx(0.15 * np.exp(-1.5) * 1.5**2 / 2.0 / 800, rel=2e-3)  # 5e-4


def test_the_distance_counts_and_not_the_time():
    """Above the least speed a particle forgets over the distance that it slips."""
    for speed in (0.01, 0.1, 1.0):
        assert after(speed, 0.2, 0.3, time=5e-6 / speed, steps=1000) == pytest.approx(
            after(0.05, 0.2, 0.3, time=5e-6 / 0.05, steps=1000), rel=1e-12
        )


def test_below_the_least_speed_the_rate_is_that_speed():
    at_rest = after(0.0, 0.3, 0.1, time=1e-3, steps=7)
    assert at_rest > 0.1
    for speed in (1e-9, 5e-4, 1e-3):
        assert after(speed, 0.3, 0.1, time=1e-3, steps=7) == at_rest
    assert after(1.01e-3, 0.3, 0.1, time=1e-3, steps=7) > at_rest


def test_backward_euler_stays_between_the_old_coefficient_and_the_law():
    generator = np.random.default_rng(2)
    speed, dt = 10.0 ** generator.uniform(-8, 2, 500), 1e-4
    law, previous = generator.uniform(0.0, 1.0, (2, 500))
    mu, _, theta = MEMORY.follow(law, np.zeros(500), speed, previous=previous, dt=dt)
    rounding = 1e-15
    assert (mu >= np.minimum(law, previous) - rounding).all()
    assert (mu <= np.maximum(law, previous) + rounding).all()
    assert (theta > 0.0).all()
    assert (theta < 1.0).all()
    # the implicit equation itself
    np.testing.assert_allclose((mu - previous) / dt, -np.maximum(speed, 1e-3) / 5e-6 * (mu - law), rtol=1e-9, atol=1e-9)


def test_no_distance_left_is_the_law_and_a_long_one_keeps_the_coefficient():
    law, previous, speed = np.array([0.2]), np.array([0.35]), np.array([0.3])
    for distance, expected in ((1e-15, 0.2), (1e6, 0.35)):
        mu = FrictionMemory(distance, 1e-3).follow(law, np.zeros(1), speed, previous=previous, dt=1e-4)[0]
        assert mu[0] == pytest.approx(expected, rel=1e-9)


def test_slope_and_theta_are_the_derivatives():
    law = KraftLaw(normalise=True)

    def coefficient(speed, previous):
        ratio, slope = law.evaluate(np.array([speed]))
        return MEMORY.follow(0.3 * ratio, 0.3 * slope, np.array([speed]), previous=np.array([previous]), dt=7e-5)

    for speed in (2e-4, 8e-4, 1.5e-3, 0.02, 0.4, 6.0):
        for previous in (0.05, 0.25, 0.3):
            _, slope, theta = coefficient(speed, previous)
            h = 1e-5 * speed
            change = coefficient(speed + h, previous)[0] - coefficient(speed - h, previous)[0]
            assert slope[0] == pytest.approx(change[0] / (2 * h), rel=1e-6, abs=1e-12 / h)  # 1e-9 beyond rounding
            change = coefficient(speed, previous + 1e-3)[0] - coefficient(speed, previous - 1e-3)[0]
            assert theta[0] == pytest.approx(change[0] / 2e-3, rel=1e-11)  # linear: rounding
