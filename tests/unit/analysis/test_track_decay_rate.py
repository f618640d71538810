"""Decay rates from made-up responses, the grid of EN 15461, the limits of ISO 3095, and resolved resonances."""

import math
from dataclasses import replace

import numpy as np
import pytest

from wheelrail.analysis.track_decay_rate import (
    GRID,
    DecayRate,
    decay_rate,
    decay_rate_limit,
    grid_positions,
    track_decay_rate,
)
from wheelrail.errors import ParameterError

NEPER = 20.0 * math.log10(math.e)


def test_grid():
    # EN 15461, figure 2: quarter bays to 2.5, half ones to 4, whole ones to 8, then wider.
    assert len(GRID) == 29
    steps = np.diff(GRID)
    assert np.all(steps[:10] == 0.25)
    assert np.all(steps[10:13] == 0.5)
    assert np.all(steps[13:17] == 1.0)
    assert GRID[18:] == (10, 12, 16, 20, 24, 30, 36, 42, 48, 54, 66)
    assert grid_positions(0.65)[-1] == pytest.approx(42.9)
    assert grid_positions(None)[-1] == pytest.approx(39.6)


def test_uniform_grid_is_a_geometric_series():
    beta, dx, count = 0.3, 0.25, 80
    x = dx * np.arange(count + 1)
    q = math.exp(-2.0 * beta * dx)
    series = dx * (0.5 + sum(q**n for n in range(1, count + 1)))
    expected = 10.0 / math.log(10.0) / series
    assert decay_rate(np.exp(-2.0 * beta * x), x) == pytest.approx(expected, rel=1e-12)


def test_dense_grid_gives_the_rate_of_the_wave():
    x = np.arange(0.0, 150.0, 1e-3)
    beta = np.array([0.1, 0.23])
    found = decay_rate(np.exp(-2.0 * np.outer(x, beta)), x)
    np.testing.assert_allclose(found, NEPER * beta, rtol=1e-6)


def test_lengths_of_the_places():
    # 0, 0.5 m and 1.4 m stand for 0.25 m, 0.7 m and 0.9 m.
    lengths = [10.0 / math.log(10.0) / decay_rate(np.eye(3)[n] + [1.0, 0.0, 0.0], [0.0, 0.5, 1.4]) for n in range(3)]
    np.testing.assert_allclose([lengths[0], lengths[1] - 0.25, lengths[2] - 0.25], [0.25, 0.7, 0.9])


def test_what_the_grid_can_tell():
    x = grid_positions(None)
    rate = np.array([0.15, 0.21, 0.23, 2.0])
    found = DecayRate(np.ones(4), rate, np.array([20.0, 20.0, 9.9, 60.0]), x)
    assert found.lowest == pytest.approx(4.343 / 39.6, rel=1e-4)
    np.testing.assert_array_equal(found.measurable, [False, False, False, True])
    assert DecayRate(np.ones(1), np.array([0.23]), np.array([10.1]), x).measurable[0]


def test_limits():
    centres, vertical = decay_rate_limit("vertical")
    _, lateral = decay_rate_limit("lateral")
    assert (round(centres[0]), round(centres[-1]), len(centres)) == (251, 5012, 14)
    assert (vertical[2], vertical[5], vertical[-1]) == (6.0, 2.19, 0.8)
    assert (lateral[0], lateral[6], lateral[-1]) == (2.04, 0.2, 0.5)


def test_a_resonance_without_loss_is_resolved(thesis_track):
    """The pinned-pinned resonance of a lossless rail is very narrow: the band must not depend on where lines fall."""
    track = thesis_track()
    coarse, fine = (
        track_decay_rate(track, lowest=890.0, highest=1125.0, lines=lines)["vertical"].rates for lines in (12, 31)
    )
    np.testing.assert_allclose(coarse, fine, rtol=5e-3)  # achieved: 1e-3


def test_the_length_of_the_track_does_not_count(thesis_track):
    found, longer = (
        track_decay_rate(thesis_track(bays=bays), lowest=280.0, highest=900.0)["vertical"].rates for bays in (4, 800)
    )
    np.testing.assert_allclose(found, longer, rtol=1e-6)  # achieved: 2.7e-10


def test_stiffer_pads_carry_vibration_less_far(thesis_track):
    track = thesis_track()
    soft = track_decay_rate(replace(track, pad_stiffness=60e6), lowest=280.0, highest=900.0)["vertical"].rates
    stiff = track_decay_rate(replace(track, pad_stiffness=600e6), lowest=280.0, highest=900.0)["vertical"].rates
    assert np.all(stiff > soft)


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"directions": ["lateral"]}, "directions"),
        ({"positions": [0.0]}, "positions"),
        ({"positions": [0.1, 0.2]}, "positions"),
        ({"positions": [0.0, 0.2, 0.2]}, "positions"),
        ({"lowest": 0.0}, "lowest"),
        ({"lowest": 1000.0, "highest": 1001.0}, "highest"),
    ],
)
def test_refused(thesis_track, changes, name):
    with pytest.raises(ParameterError, match=name):
        track_decay_rate(thesis_track(), **{"lowest": 400.0, "highest": 700.0, **changes})


def test_refused_responses():
    with pytest.raises(ValueError, match="each position"):
        decay_rate([1.0, 0.5, 0.2], [0.0, 1.0])
    with pytest.raises(ValueError, match="must not be 0"):
        decay_rate([0.0, 0.5], [0.0, 1.0])
    with pytest.raises(ParameterError, match="vertical, lateral"):
        decay_rate_limit("z")
