"""Stick/slip of made-up histories, and of a mass on a belt by its exact cycle."""

import math

import numpy as np
import pytest

from wheelrail.analysis.stick_slip import STATES, slip_states, stick_slip
from wheelrail.errors import ParameterError

DT = 1e-4


def squares(periods, *, slipping=0.5):
    """Slip shares: each period, in steps, begins with full slip; then a part of the area sticks."""
    parts = []
    for period in periods:
        cut = round(slipping * period)
        parts += [np.ones(cut), np.full(period - cut, 0.3)]
    return np.concatenate(parts)


def test_states():
    slip = [0.0, 0.0, 0.4, 1.0, 1.0 - 1e-12, 0.0]
    states = slip_states(slip, in_contact=[0.0, 5.0, 5.0, 5.0, 5.0, 0.0])
    assert [STATES[state] for state in states] == [
        "no contact",
        "stick",
        "partial slip",
        "full slip",
        "full slip",
        "no contact",
    ]


def test_regular_cycles():
    slip = squares([50] * 20, slipping=0.3)
    force = np.sin(2.0 * np.pi * np.arange(1000) / 50)
    found = stick_slip(slip_fraction=slip, in_contact=np.ones(1000), force=force, dt=DT)
    assert found.shares["full slip"] == pytest.approx(0.3)
    assert found.shares["partial slip"] == pytest.approx(0.7)
    assert sum(found.shares.values()) == pytest.approx(1.0)
    assert found.episodes == {"no contact": 0, "stick": 0, "partial slip": 20, "full slip": 20}
    # The first phase of full slip has no beginning in the record.
    assert found.cycles == 18
    assert found.frequency == pytest.approx(1.0 / (50 * DT))
    assert found.spread == pytest.approx(0.0, abs=1e-12)
    assert found.periodicity == pytest.approx(1.0, abs=1e-9)
    assert found.occurs
    assert found.regular()


def test_irregular_cycles():
    rng = np.random.default_rng(4)
    periods = rng.integers(20, 120, 40)
    slip = squares(periods)
    found = stick_slip(slip_fraction=slip, in_contact=np.ones(len(slip)), force=rng.normal(size=len(slip)), dt=DT)
    inner = periods[1:-1] * DT
    # An onset to the next is one period, from the second to the last but one.
    assert found.cycles == 38
    median = np.median(inner)
    assert found.frequency == pytest.approx(1.0 / inner[(inner > median / 1.5) & (inner < 1.5 * median)].mean())
    assert found.spread == pytest.approx(inner.std() / inner.mean())
    assert found.periodicity < 0.3
    assert found.occurs
    assert not found.regular()


@pytest.mark.parametrize("share", [1.0, 0.4, 0.0])
def test_no_cycle(share):
    found = stick_slip(slip_fraction=np.full(100, share), in_contact=np.ones(100), force=np.arange(100.0), dt=DT)
    assert found.cycles == 0
    assert not found.occurs
    assert not found.regular()
    assert math.isnan(found.frequency)
    assert math.isnan(found.periodicity)


def test_lost_contact_is_not_stick():
    slip = np.ones(100)
    slip[40:60] = 0.0  # a wheel off the rail has nothing that slips
    touching = slip > 0.0
    found = stick_slip(slip_fraction=slip, in_contact=touching, force=slip, dt=DT)
    assert found.cycles == 0
    assert found.shares == pytest.approx({"no contact": 0.2, "stick": 0.0, "partial slip": 0.0, "full slip": 0.8})


def test_mass_on_a_belt():
    """Coulomb friction with a lower sliding value: the period of the cycle in closed form (den Hartog 1930).

    A mass on a spring k is dragged by a belt of speed V; friction is F_s in stick, F_k < F_s in slip. Slip is half a
    sinusoid beyond: with D = (F_s - F_k) / k and e = D omega / V the phases last 2 D / V and
    2 (pi - arctan e) / omega.
    """
    omega, speed, drop, dt = 2.0 * np.pi * 100.0, 0.5, 5e-4, 1e-6
    ratio = drop * omega / speed
    sticking, slipping = 2.0 * drop / speed, 2.0 * (np.pi - np.arctan(ratio)) / omega
    x, v, stuck = drop, speed, False
    slip, force = [], []
    for _ in range(100_000):
        if stuck:
            x += speed * dt
            stuck = x < drop
        else:
            v -= omega**2 * x * dt
            x += v * dt
            if v >= speed and x < 0.0:
                stuck, v = True, speed
        slip.append(0.0 if stuck else 1.0)
        force.append(x)
    found = stick_slip(slip_fraction=slip, in_contact=np.ones(len(slip)), force=force, dt=dt)
    assert found.frequency == pytest.approx(1.0 / (sticking + slipping), rel=1e-4)  # achieved: 9e-6
    assert found.regular()
    cycle = round(1.0 / (found.frequency * dt))
    assert np.mean(slip[cycle : 4 * cycle]) == pytest.approx(slipping / (sticking + slipping), rel=5e-4)  # 7e-5


def test_refused():
    good = {"slip_fraction": np.ones(4), "in_contact": np.ones(4), "force": np.ones(4), "dt": DT}
    with pytest.raises(ParameterError, match="dt"):
        stick_slip(**{**good, "dt": 0.0})
    for name, value in (("slip_fraction", np.full(4, 1.5)), ("in_contact", np.ones(3)), ("force", np.ones(5))):
        with pytest.raises(ValueError, match=name):
            stick_slip(**{**good, name: value})


@pytest.mark.parametrize("period", [4.43, 7.31])
def test_a_period_of_few_steps(period):
    """A squeal of 3 kHz has some four steps to a period, which is no whole number of them."""
    n = np.arange(4000)
    phase = 2.0 * np.pi * n / period
    slip = np.where(np.sin(phase) > 0.2, 0.5, 1.0)
    found = stick_slip(slip_fraction=slip, in_contact=np.ones(len(n)), force=np.cos(phase), dt=DT)
    assert found.frequency == pytest.approx(1.0 / (period * DT), rel=1e-3)  # 3e-4: a step in the whole record
    assert found.steps == pytest.approx(period, rel=1e-3)
    assert found.regular()
