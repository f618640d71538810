import math

import numpy as np
import pytest

from wheelrail.contact.newton import TOLERANCE, solve_approach


def hertz_law(constant: float, touch: float):
    def law(d: float) -> tuple[float, float]:
        depth = max(d - touch, 0.0)
        return constant * depth**1.5, 1.5 * constant * math.sqrt(depth)

    return law


def problems(count: int, seed: int):
    """Problems of any kind: stiff and soft, deep, barely touching, out of contact, good and absurd guesses."""
    rng = np.random.default_rng(seed)
    for number in range(count):
        constant = 10.0 ** rng.uniform(7, 13)
        touch = rng.normal() * 10.0 ** rng.uniform(-9, -2)
        guess = touch + rng.normal() * 10.0 ** rng.uniform(-9, 0)
        weight = [0.0, 1.0, 1.0, 10.0 ** rng.uniform(-3, 3)][number % 4]
        compliance = 0.0 if number % 8 == 1 else 10.0 ** rng.uniform(-14, 2)
        if weight == 0.0:
            compliance, rhs = 1.0, rng.normal() * 10.0 ** rng.uniform(-6, 7)
        else:
            rhs = weight * touch + rng.choice([-1.0, 1.0, 1.0]) * 10.0 ** rng.uniform(-12, 0)
        yield constant, touch, weight, compliance, rhs, guess


def test_random_problems_are_solved():
    worst = most = 0.0
    contacts = 0
    for constant, touch, weight, compliance, rhs, guess in problems(8000, 1):
        law = hertz_law(constant, touch)
        d, force, stiffness, iterations, residual = solve_approach(law, touch, 1e-4, weight, compliance, rhs, guess)
        assert force == law(d)[0]
        most = max(most, iterations)
        if rhs <= weight * touch:
            assert force == stiffness == 0.0
            assert d == (rhs / weight if weight > 0.0 else touch)
            continue
        contacts += 1
        assert stiffness == law(d)[1]
        largest = abs(rhs) + abs(weight * touch) + weight * 1e-12
        error = abs(weight * d + compliance * force - rhs) / largest
        assert residual == pytest.approx(error, abs=1e-15)
        # No number next to d may solve the equation any better where the law is steep beyond what is physical.
        rounding = 4.0 * np.finfo(float).eps * abs(d) * (weight + compliance * stiffness) / largest
        worst = max(worst, error / max(1e-12, rounding))
    assert contacts > 4000
    assert worst <= 1.0  # achieved: 0.3
    assert most <= 80  # achieved: 71, from guesses wrong by decades


def test_physical_problems_reach_the_tolerance():
    rng = np.random.default_rng(4)
    most = 0
    for _ in range(5000):
        constant, touch = 10.0 ** rng.uniform(10, 11.5), rng.normal() * 50e-6
        weight, compliance = 1.0, 10.0 ** rng.uniform(-12, -7)
        rhs = touch + rng.uniform(-1e-4, 3e-4)
        law = hertz_law(constant, touch)
        *_, iterations, residual = solve_approach(law, touch, 1e-4, weight, compliance, rhs, touch + 8e-5)
        assert residual <= 1e-12
        most = max(most, iterations)
    assert most <= 12  # achieved: 8


def test_a_good_guess_needs_few_steps():
    law = hertz_law(9.4e10, 0.0)
    for change in (1e-9, 1e-7, 5e-6):
        d, *_, iterations, residual = solve_approach(law, 0.0, 1e-4, 1.0, 1e-9, 1.45e-4, 7.9e-5 + change)
        assert d + 1e-9 * law(d)[0] == pytest.approx(1.45e-4, abs=0, rel=1e-13)
        assert iterations <= 5
        assert residual <= TOLERANCE


def test_out_of_contact_the_bodies_separate():
    assert solve_approach(hertz_law(1e11, 3e-6), 3e-6, 1e-4, 2.0, 1e-9, 5e-6, 0.0)[:3] == (2.5e-6, 0.0, 0.0)


def test_no_compliance_takes_the_approach_from_the_right_hand_side():
    d, force, *_ = solve_approach(hertz_law(1e11, 0.0), 0.0, 1e-4, 2.0, 0.0, 1.6e-4, 1e-5)
    assert d == pytest.approx(8e-5, abs=0, rel=1e-12)
    assert force == pytest.approx(1e11 * 8e-5**1.5, abs=0, rel=1e-12)


def test_no_compliance_needs_no_search():
    # The quasi-static case of coupling by displacement: d = rhs / weight, known beforehand.
    *_, iterations, residual = solve_approach(hertz_law(1e11, 0.0), 0.0, 1e-4, 1.0, 0.0, 8e-5, 7.9e-5)
    assert residual <= TOLERANCE
    assert iterations <= 3


@pytest.mark.parametrize("load", [1.0, 65e3, 1e7])
def test_given_force(load):
    d, force, *_ = solve_approach(hertz_law(9.4e10, -2e-5), -2e-5, 1e-4, 0.0, 1.0, load, 1e-4)
    assert force == pytest.approx(load, abs=0, rel=1e-12)
    assert d == pytest.approx((load / 9.4e10) ** (2.0 / 3.0) - 2e-5, abs=0, rel=1e-11)
