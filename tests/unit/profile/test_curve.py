"""Profile curves: values, derivatives, ends, files."""

from __future__ import annotations

import json

import numpy as np
import pytest

from wheelrail.profile.curve import Piece, ProfileCurve
from wheelrail.profile.named_profiles import named_rail_profile, named_wheel_profile

ARC = Piece(-0.02, 0.0, (0.3,), centre=0.0, radius=0.3, bulge=-1)
CUBIC = Piece(0.0, 0.03, (0.0, 0.0, 2.0, -7.0), origin=0.0)
CURVE = ProfileCurve.from_pieces("arc and cubic", [ARC, CUBIC])
NAMED = [
    named_wheel_profile("s1002"),
    named_wheel_profile("cone", conicity=0.05),
    named_rail_profile("60e1"),
    named_rail_profile("bv50-like"),
    named_rail_profile("circular", radius=0.3),
]


def test_arc_and_polynomial():
    height, slope, second = CURVE.evaluate([-0.02, -0.01, 0.0, 0.01, 0.03])
    np.testing.assert_allclose(height, [*(0.3 - np.sqrt(0.09 - np.array([4e-4, 1e-4]))), 0.0, 1.93e-4, 1.611e-3])
    np.testing.assert_allclose(slope[2:], [0.0, 0.04 - 21e-4, 0.12 - 18.9e-3])
    np.testing.assert_allclose(second[2:], [4.0, 4.0 - 0.42, 4.0 - 1.26])
    np.testing.assert_allclose(CURVE.curvature([-0.02, -0.001]), 1.0 / 0.3, rtol=1e-13)


def test_no_extrapolation():
    for values in CURVE.evaluate([-0.0200001, 0.0300001, np.nan, np.inf]):
        assert np.all(np.isnan(values))


@pytest.mark.parametrize("curve", NAMED, ids=lambda curve: curve.name)
def test_derivatives_are_those_of_the_heights(curve):
    h = 1e-7
    y = np.linspace(curve.start + 1e-3, curve.end - 1e-3, 997)
    y = y[np.min(np.abs(y[:, None] - curve.breaks), axis=1) > 2 * h]
    height, slope, second = curve.evaluate(y)
    scale = 1.0 + np.abs(second)
    np.testing.assert_array_less(np.abs((curve.height(y + h) - curve.height(y - h)) / (2 * h) - slope) / scale, 1e-8)
    np.testing.assert_array_less(np.abs((curve.slope(y + h) - curve.slope(y - h)) / (2 * h) - second) / scale**2, 1e-6)
    # The same one by one.
    np.testing.assert_allclose(
        [curve.at(value) for value in y.tolist()], np.transpose([height, slope, second]), rtol=1e-13
    )


@pytest.mark.parametrize("curve", [CURVE, *NAMED], ids=lambda curve: curve.name)
def test_samples_follow_the_curve_and_hold_its_joints(curve):
    y, z = curve.samples
    assert np.isin(curve.breaks, y).all()
    assert np.all(np.diff(y) > 0.0)
    assert np.hypot(np.diff(y), np.diff(z)).max() < 1.06e-4
    np.testing.assert_array_equal(z, curve.height(y))


@pytest.mark.parametrize("curve", [CURVE, *NAMED], ids=lambda curve: curve.name)
def test_parts(curve):
    meta, arrays = curve.to_parts()
    again = ProfileCurve.from_parts(json.loads(json.dumps(meta)), arrays)
    y = np.linspace(curve.start, curve.end, 100)
    np.testing.assert_array_equal(again.evaluate(y), curve.evaluate(y))
    assert again.name == curve.name


def test_curves_can_not_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        CURVE.coefficients[0, 0] = 1.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"breaks": [0.0, 0.0]}, "increase"),
        ({"breaks": [0.0, np.nan]}, "finite"),
        ({"breaks": [0.0, 1.0, 2.0]}, "breaks"),
        ({"radii": [1.0, 1.0]}, "breaks"),
        ({"coefficients": [1.0]}, "shape"),
    ],
)
def test_refused(change, message):
    parts = {
        "name": "line",
        "breaks": [0.0, 1.0],
        "coefficients": [[0.0, 1.0]],
        "origins": [0.0],
        "centres": [0.0],
        "radii": [1.0],
        "bulges": [0.0],
    }
    ProfileCurve(**parts)
    with pytest.raises(ValueError, match=message):
        ProfileCurve(**{**parts, **change})


def test_pieces_must_follow_each_other():
    with pytest.raises(ValueError, match="follow"):
        ProfileCurve.from_pieces("gap", [ARC, CUBIC._replace(start=0.001)])
