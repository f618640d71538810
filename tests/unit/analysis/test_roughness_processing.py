"""Spikes and pits of a record: EN 15610:2009, 7.2 and 7.3."""

import numpy as np
import pytest

from wheelrail.analysis.roughness_processing import WHEEL_RADIUS, remove_spikes, rolling_envelope

DX = 1e-3
X = np.arange(400) * DX
WAVES = 5e-6 * np.sin(2.0 * np.pi * X / 0.08)


def parabola(width, height, at=0.2, x=X):
    return np.maximum(height * (1.0 - (2.0 * (x - at) / width) ** 2), 0.0)


def test_a_spike_becomes_a_straight_line_between_its_feet():
    line = WAVES.copy()
    line[100] += 60e-6
    cleaned, count = remove_spikes(line, spacing=DX)
    assert count == 1
    changed = np.flatnonzero(cleaned != line)
    assert changed.min() >= 98
    assert changed.max() <= 102
    np.testing.assert_allclose(cleaned[98:103], np.linspace(line[98], line[102], 5), rtol=1e-12)
    np.testing.assert_allclose(cleaned, WAVES, atol=0.2e-6)  # achieved 0.06 um: the wave's own bend over 4 mm
    assert line[100] == WAVES[100] + 60e-6  # the record itself stays as it is


def test_pits_and_smooth_waves_are_no_spikes():
    line = WAVES.copy()
    line[100] -= 60e-6
    # The rims of the pit are no higher than the line.
    assert remove_spikes(WAVES, spacing=DX)[1] == 0
    cleaned, _ = remove_spikes(line, spacing=DX)
    assert cleaned[100] < -50e-6


@pytest.mark.parametrize(("share", "removed"), [(0.9, 0), (1.1, 1)])
@pytest.mark.parametrize("half_width", [8, 12])
def test_height_and_width_decide(share, removed, half_width):
    # A triangle between feet of zero slope: h against w^2 / 3 m.
    width = 2 * (half_width + 1) * DX  # the slope dies out one point beyond the corner
    height = share * width**2 / 3.0
    line = np.maximum(height * (1.0 - np.abs(np.arange(400) - 200) / half_width), 0.0)
    assert height / half_width / (2.0 * DX) >= 5e-3  # slope at the corner: not yet a foot
    cleaned, count = remove_spikes(line, spacing=DX)
    assert count == removed
    assert np.max(cleaned) == (0.0 if removed else pytest.approx(height))


def test_blunt_crests_stay():
    # Second derivative of -9 and -11 1/m at the crest of a narrow parabola.
    for curvature, removed in ((9.0, 0), (11.0, 1)):
        width = 6e-3
        line = parabola(width, curvature * width**2 / 8.0)
        assert remove_spikes(line, spacing=DX)[1] == removed


@pytest.mark.parametrize("at", [1, 398])
def test_a_spike_next_to_an_end(at):
    line = np.zeros(400)
    line[at] = 50e-6
    cleaned, count = remove_spikes(line, spacing=DX)
    assert count == 1
    np.testing.assert_array_equal(cleaned, 0.0)


def test_what_is_left_holds_no_spike():
    for amplitude in (5e-6, 50e-6):
        line = amplitude * np.random.default_rng(3).standard_normal(3000)
        cleaned, count = remove_spikes(line, spacing=DX)
        assert count > 50
        assert remove_spikes(cleaned, spacing=DX)[1] == 0


def test_spikes_by_other_arithmetic():
    # The rule of 7.2 on its own, point by point, for a record whose spikes don't touch each other.
    line = WAVES.copy()
    places = {60: 20e-6, 130: 8e-6, 200: 3e-6, 270: 100e-6, 330: -40e-6}
    for at, height in places.items():
        line[at] += height
    expected = 0
    for i in range(2, 398):
        slope = (line[2:] - line[:-2]) / (2.0 * DX)  # at i - 1
        if line[i - 1] - 2.0 * line[i] + line[i + 1] >= -10.0 * DX**2 or line[i] < max(line[i - 1], line[i + 1]):
            continue
        left = next(j for j in range(i - 1, -1, -1) if abs(slope[j - 1]) < 5e-3)
        right = next(j for j in range(i + 1, 400) if abs(slope[j - 1]) < 5e-3)
        chord = line[left] + (line[right] - line[left]) * (i - left) / (right - left)
        expected += line[i] - chord > ((right - left) * DX) ** 2 / 3.0
    assert remove_spikes(line, spacing=DX)[1] == expected
    assert expected >= 2


def test_a_pit_is_bridged_by_the_wheel():
    # A circle on the two rims of a slot of width w sinks in by w^2 / 8R in the middle.
    line = np.zeros(400)
    line[190:211] = -1e-3
    rolled = rolling_envelope(line, spacing=DX)
    width = 22 * DX  # between the last points at full height
    sagitta = WHEEL_RADIUS - np.sqrt(WHEEL_RADIUS**2 - (0.5 * width) ** 2)
    assert rolled[200] == pytest.approx(-sagitta, rel=1e-12)
    np.testing.assert_array_equal(rolled[:190], 0.0)
    # Everywhere in the slot it is a circle about one of the rims.
    to_rim = np.minimum(np.arange(190, 211) - 189, 211 - np.arange(190, 211)) * DX
    np.testing.assert_allclose(rolled[190:211], -(WHEEL_RADIUS - np.sqrt(WHEEL_RADIUS**2 - to_rim**2)), rtol=1e-12)


@pytest.mark.parametrize("periodic", [False, True])
def test_envelope_by_definition(periodic):
    line = 2e-4 * np.random.default_rng(5).standard_normal(120)
    n = np.arange(120)
    distance = np.abs(n[:, None] - n[None, :])
    if periodic:
        distance = np.minimum(distance, 120 - distance)
    circle = WHEEL_RADIUS - np.sqrt(WHEEL_RADIUS**2 - (distance * DX) ** 2)
    expected = np.max(line[None, :] - circle, axis=1)
    np.testing.assert_allclose(rolling_envelope(line, spacing=DX, periodic=periodic), expected, rtol=0, atol=1e-18)


@pytest.mark.parametrize(("share", "reached"), [(0.9, True), (1.1, False)])
def test_the_wheel_reaches_the_bottom_of_waves_that_are_blunter_than_itself(share, reached):
    # At the bottom the radius of the wave is wavelength^2 / (4 pi^2 A).
    line = share / WHEEL_RADIUS * (0.1 / (2.0 * np.pi)) ** 2 * np.cos(2.0 * np.pi * X / 0.1)
    rise = rolling_envelope(line, spacing=DX, periodic=True) - line
    assert (rise[50] < 1e-15) == reached
    assert rise[0] < 1e-15
    assert np.min(rise) >= 0.0


def test_on_a_slope_the_wheel_touches_ahead():
    # Its lowest point is R (1 / cos - 1) above the slope.
    inclined = 0.02 * X
    rise = rolling_envelope(inclined, spacing=DX) - inclined
    assert np.max(rise) == pytest.approx(WHEEL_RADIUS * (np.sqrt(1.0 + 0.02**2) - 1.0), rel=0.02)  # achieved 0.5 %
