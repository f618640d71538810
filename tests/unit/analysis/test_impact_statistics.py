"""Impacts, losses of contact, exceedance and wheel turns of made-up forces and of a run over a flat."""

import math

import numpy as np
import pytest

from wheelrail.analysis.impact_statistics import exceedance, impact_statistics, turns
from wheelrail.errors import ParameterError

DT, SPEED, LOAD = 1e-4, 20.0, 50e3


def half_sines(centres, peak, width, *, duration=1.0):
    t = DT * np.arange(round(duration / DT))
    force = np.full_like(t, LOAD)
    for centre in centres:
        near = np.abs(t - centre) < 0.5 * width
        force[near] += (peak - LOAD) * np.cos(np.pi * (t[near] - centre) / width)
    return force


def test_half_sines():
    width, peak = 20e-3, 150e3
    force = half_sines([0.25, 0.7], peak, width)
    found = impact_statistics(force, dt=DT, speed=SPEED, static_load=LOAD, factor=1.2)
    assert [impact.time for impact in found.impacts] == pytest.approx([0.25, 0.7], abs=DT)
    # Above 60 kN: 100 kN cos(pi t / width) > 10 kN.
    half = width / np.pi * np.arccos(0.1)
    impulse = (peak - LOAD) * 2.0 * width / np.pi * np.sin(np.pi * half / width)
    for impact in found.impacts:
        assert impact.peak == pytest.approx(peak, rel=1e-6)
        assert impact.position == pytest.approx(SPEED * impact.time)
        assert impact.duration == pytest.approx(2.0 * half, abs=2.0 * DT)
        assert impact.impulse == pytest.approx(impulse, rel=2e-3)  # achieved: 4e-4
    assert found.dynamic_load_factor == pytest.approx(3.0, rel=1e-6)
    assert found.losses == ()
    assert found.percentiles[50.0] == LOAD


def test_loss_of_contact():
    force = np.full(1000, LOAD)
    force[100:150] = 0.0
    force[400] = 0.0
    found = impact_statistics(force, dt=DT, speed=SPEED, static_load=LOAD, start_time=2.0)
    assert [loss.time for loss in found.losses] == pytest.approx([2.01, 2.04])
    assert [loss.duration for loss in found.losses] == pytest.approx([50 * DT, DT])
    assert [loss.distance for loss in found.losses] == pytest.approx([50 * DT * SPEED, DT * SPEED])
    assert found.lost_share == pytest.approx(0.051)
    assert found.smallest == 0.0
    assert found.impacts == ()


def test_stretches_at_the_ends_count():
    force = np.full(100, LOAD)
    force[:10] = 3.0 * LOAD
    force[-20:] = 0.0
    found = impact_statistics(force, dt=DT, speed=SPEED, static_load=LOAD)
    assert [impact.duration for impact in found.impacts] == pytest.approx([10 * DT])
    assert [loss.duration for loss in found.losses] == pytest.approx([20 * DT])


def test_exceedance_of_a_sinusoid():
    phase = 2.0 * np.pi * (np.arange(100000) + 0.5) / 100000
    levels = np.array([-1.5, -0.5, 0.0, 0.8, 1.0])
    expected = np.arccos(np.clip(levels, -1.0, 1.0)) / np.pi
    np.testing.assert_allclose(exceedance(np.sin(phase), levels), expected, atol=2e-5)


def test_a_flat_comes_once_a_turn():
    radius = 0.45
    period = 2.0 * math.pi * radius / SPEED
    strikes = 0.3 * period + period * np.arange(7)
    force = half_sines(strikes, 200e3, 4e-3)
    found = turns(force, dt=DT, speed=SPEED, radius=radius)
    assert len(found) == math.floor(1.0 / period)
    assert [turn.number for turn in found] == list(range(len(found)))
    np.testing.assert_allclose([turn.time for turn in found], strikes[: len(found)], atol=DT)
    np.testing.assert_allclose([turn.angle for turn in found], 0.6 * math.pi, atol=DT * SPEED / radius)
    # A history that begins later lacks the first turn.
    later = turns(force[500:], dt=DT, speed=SPEED, radius=radius, start_time=500 * DT)
    assert [turn.number for turn in later] == [turn.number for turn in found[1:]]
    np.testing.assert_allclose([turn.time for turn in later], [turn.time for turn in found[1:]])
    assert turns(force[:100], dt=DT, speed=SPEED, radius=radius) == ()


def test_every_step_is_in_one_turn():
    radius = 0.31
    force = np.random.default_rng(1).normal(LOAD, 1e3, 5000)
    found = turns(force, dt=DT, speed=SPEED, radius=radius)
    used = math.ceil(len(found) * 2.0 * math.pi * radius / SPEED / DT)
    assert max(turn.largest for turn in found) == force[:used].max()
    assert min(turn.smallest for turn in found) == force[:used].min()


@pytest.mark.parametrize(
    "changes",
    [{"static_load": 0.0}, {"factor": 1.0}, {"dt": -1.0}, {"speed": math.nan}, {"percentiles": (101.0,)}],
)
def test_refused(changes):
    with pytest.raises(ParameterError, match=next(iter(changes))):
        impact_statistics(np.ones(10), **{"dt": DT, "speed": SPEED, "static_load": LOAD, **changes})


def test_refused_forces():
    for force in ([], [[1.0]], [math.nan]):
        with pytest.raises(ValueError, match="force"):
            impact_statistics(force, dt=DT, speed=SPEED, static_load=LOAD)
    with pytest.raises(ParameterError, match="radius"):
        turns(np.ones(10), dt=DT, speed=SPEED, radius=0.0)
