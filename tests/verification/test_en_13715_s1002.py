"""Wheel profile S1002: its points, the figures on its drawing, and how its zones meet."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from wheelrail.profile.named_profiles import named_wheel_profile

POINTS = Path(__file__).parents[1] / "data" / "profiles" / "s1002_points.csv"
S1002 = named_wheel_profile("s1002")


def test_points():
    lines = [line for line in POINTS.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    y, z = np.loadtxt(lines[1:], delimiter=",").T
    assert len(y) == 261
    np.testing.assert_allclose(1e3 * S1002.height(1e-3 * y), z, rtol=0.0, atol=2e-6)  # achieved: 5.0e-7 mm


def test_flange_and_tape_circle():
    height, slope, _ = S1002.at(-55e-3)
    assert height == pytest.approx(28e-3, abs=1e-12)
    assert slope == pytest.approx(0.0, abs=1e-12)
    # 32.5 mm thick, from its back 70 mm beside the tape circle, where it is 10 mm high.
    flank = brentq(lambda y: S1002.at(y)[0] - 10e-3, -39e-3, -36e-3)
    assert flank == pytest.approx(-70e-3 + 32.5e-3, abs=1e-6)  # achieved: 1.4e-7 m
    # 70 degrees at its steepest.
    assert np.degrees(np.arctan(-S1002.at(-39e-3)[1])) == pytest.approx(70.0, abs=1e-4)
    assert S1002.at(0.0)[0] == 0.0


def test_zones_meet():
    assert len(S1002.breaks) == 9
    for y in S1002.breaks[1:-1]:
        before, after = S1002.evaluate(y - 1e-13), S1002.evaluate(y)
        # As printed. Achieved: 1.2e-7 m and 7.7e-6, both where C meets D.
        assert abs(after[0] - before[0]) < 1.3e-7
        assert abs(after[1] - before[1]) < 8e-6


def test_radii_of_the_arcs():
    for y, radius in ((-66e-3, -20.5e-3), (-55e-3, -12e-3), (-45e-3, -20e-3), (-37e-3, 13e-3)):
        assert 1.0 / S1002.curvature(y) == pytest.approx(radius, rel=1e-12)
    for y in (-39e-3, 50e-3):
        assert S1002.curvature(y) == 0.0
