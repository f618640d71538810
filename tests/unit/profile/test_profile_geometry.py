"""Geometry with profiles as a run uses it."""

from __future__ import annotations

import json

import numpy as np
import pytest

from wheelrail.errors import ParameterError
from wheelrail.profile.named_profiles import named_rail_profile, named_wheel_profile
from wheelrail.profile.profile_geometry import ProfileGeometry

X, Y = (np.arange(31) - 15) * 1e-3, (np.arange(25) - 12) * 0.5e-3
CENTRE = (12, 15)


def geometry(**changes) -> ProfileGeometry:
    given = {
        "wheel": named_wheel_profile("s1002"),
        "rail": named_rail_profile("60e1"),
        "nominal_radius": 0.46,
        "inclination": 0.025,
        "yaw": 0.0,
        "reference_shift": -3e-3,
    }
    return ProfileGeometry(**{**given, **changes})


@pytest.mark.parametrize("yaw", [0.0, 0.015])
@pytest.mark.parametrize("shift", [-9e-3, -3.5e-3, 0.0, 2e-3, 4.5e-3])
def test_no_gap_at_the_reference(shift, yaw):
    distance = geometry(reference_shift=shift, yaw=yaw).distance(shift, X, Y)
    assert distance.shape == (25, 31)
    assert distance[CENTRE] == 0.0
    # Nowhere do the bodies overlap. Achieved: 0.
    assert distance.min() > -1e-12


def test_a_shift_lifts_the_wheel():
    pair = geometry()
    reference = pair.place(-3e-3)
    for shift in (-10e-3, 0.0, 4e-3):
        place = pair.place(shift)
        lifted = place.ride_height - reference.ride_height
        assert pair.distance(shift, X, Y)[CENTRE] == pytest.approx(-lifted, abs=1e-15)
    assert pair.place(4e-3).ride_height - reference.ride_height > 1e-3


@pytest.mark.parametrize("shift", [-9e-3, 0.0])
@pytest.mark.parametrize("yaw", [0.0, 0.02])
def test_radii_are_those_of_the_distance(shift, yaw):
    pair = geometry(yaw=yaw)
    place = pair.place(shift)
    step = 5e-5
    near = pair.distance(shift, np.array([-step, 0.0, step]), np.array([-step, 0.0, step]))
    xx = (near[1, 0] - 2.0 * near[1, 1] + near[1, 2]) / step**2
    yy = (near[0, 1] - 2.0 * near[1, 1] + near[2, 1]) / step**2
    xy = (near[0, 0] + near[2, 2] - near[0, 2] - near[2, 0]) / (4.0 * step**2)
    values = np.linalg.eigvalsh([[xx, xy], [xy, yy]])
    # Achieved: 1.5e-6.
    np.testing.assert_allclose(sorted([place.curvature_x, place.curvature_y]), values, rtol=5e-6)
    # Along is the axis nearer to the rail's.
    assert abs(place.curvature_x - xx) < abs(place.curvature_x - yy)


def test_further_points_come_with_the_place():
    place = geometry().place(2.5e-3)
    (other,) = place.others
    assert other.y_wheel > place.y_wheel
    assert 0.0 < other.gap < 1e-4
    assert geometry().place(-9e-3).others == ()


@pytest.mark.parametrize("yaw", [0.0, 0.01])
def test_file_and_back(yaw):
    pair = geometry(yaw=yaw)
    meta, arrays = pair.to_parts()
    assert meta["kind"] == "profiles"
    again = ProfileGeometry.from_parts(json.loads(json.dumps(meta)), arrays)
    for shift in (-4e-3, 1e-3):
        assert again.place(shift) == pair.place(shift)
        np.testing.assert_array_equal(again.distance(shift, X, Y), pair.distance(shift, X, Y))


def test_description_and_shape():
    assert geometry().description == "wheel s1002 on rail 60e1, inclined by 0.025 rad"
    assert geometry().shaped


def test_a_reference_without_contact_is_refused_at_once():
    with pytest.raises(ParameterError, match="lateral_shift"):
        geometry(reference_shift=0.3)
