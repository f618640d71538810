"""Wheelset on a track: gauge, symmetry, equivalent conicity."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.errors import ParameterError
from wheelrail.profile.named_profiles import named_rail_profile, named_wheel_profile
from wheelrail.profile.profile_geometry import ProfileGeometry
from wheelrail.profile.wheelset import GAUGE_DEPTH, equivalent_conicity, rail_axis_position, wheelset_contact

TRACK = {"gauge": 1.435, "flange_back_spacing": 1.36, "flange_back_position": -0.07}


def geometry(wheel=None, rail=None, **changes) -> ProfileGeometry:
    numbers = {"nominal_radius": 0.46, "inclination": 0.025, "yaw": 0.0, "reference_shift": 0.0, **changes}
    return ProfileGeometry(
        wheel=wheel or named_wheel_profile("s1002"), rail=rail or named_rail_profile("60e1"), **numbers
    )


@pytest.fixture(scope="module")
def s1002_on_60e1():
    return wheelset_contact(geometry(), lateral=np.linspace(-10e-3, 10e-3, 401), **TRACK)


def test_gauge_is_measured_14_mm_below_the_highest_point():
    upright = geometry(inclination=0.0)
    # At 14 mm the arc of 13 mm, whose middle lies 14.949189 mm deep, is that far out.
    side = 23.0162196 + np.sqrt(13.0**2 - (14.949189 - 14.0) ** 2)
    assert 1e3 * rail_axis_position(upright.search, gauge=1.435) == pytest.approx(717.5 + side, abs=2e-4)
    inclined = geometry()
    axis = rail_axis_position(inclined.search, gauge=1.435)
    y, depth = inclined.search.tilted_rail
    within = depth <= depth.min() + GAUGE_DEPTH
    assert axis + y[within].min() == pytest.approx(0.7175, abs=5e-6)


def test_both_wheels_are_images(s1002_on_60e1):
    contact = s1002_on_60e1
    assert len(contact.right) == len(contact.left) == 401
    np.testing.assert_allclose(contact.radius_difference, -contact.radius_difference[::-1], atol=1e-9)
    np.testing.assert_allclose(
        contact.values("ride_height"), contact.values("ride_height", left=True)[::-1], atol=1e-12
    )
    # To the right, the right flange approaches its rail.
    assert contact.right[-1].angle > 1.0
    assert contact.left[-1].angle < 0.05


def test_yaw_turns_the_left_wheel_the_other_way():
    # Turned about one axis, the wheels are images only if the wheelset is: displaced and turned the other way.
    one = wheelset_contact(geometry(yaw=0.01), lateral=[2e-3], **TRACK)
    other = wheelset_contact(geometry(yaw=-0.01), lateral=[-2e-3], **TRACK)
    assert one.right[0] == other.left[0]
    assert one.left[0] == other.right[0]


def test_cones_have_their_own_conicity():
    cone = geometry(named_wheel_profile("cone", conicity=0.05), named_rail_profile("circular", radius=0.3))
    # The gauge isn't reached by this rail; a difference of radii needs none.
    with pytest.raises(ParameterError, match=r"ends 3\.16 mm below its top; the gauge is measured down to 14 mm"):
        wheelset_contact(cone, lateral=[0.0], **TRACK)
    y = np.linspace(-5e-3, 5e-3, 11)
    radii = np.array([cone.place(value).rolling_radius for value in y.tolist()])
    difference = radii - radii[::-1]
    np.testing.assert_allclose(difference, 0.1 * y, atol=1e-14)
    for amplitude in (1e-3, 4.7e-3):
        found = equivalent_conicity(lateral=y, radius_difference=difference, amplitude=amplitude)
        assert found == pytest.approx(0.05, rel=1e-5)  # achieved: 1.3e-6


def test_conicity_of_a_cubic_difference():
    """dr = c y^3: a wave of the length K(m = 1/2) gives it in closed form."""
    from scipy.special import ellipk

    amplitude, c = 3e-3, 4e3
    y = np.linspace(-5e-3, 5e-3, 2001)
    # y'' = -c y^3 has the quarter period K(1/2) / (a sqrt(c)); y'' = -2 gamma y has (pi / 2) / sqrt(2 gamma).
    exact = 0.5 * (0.5 * np.pi * amplitude * np.sqrt(c) / ellipk(0.5)) ** 2
    found = equivalent_conicity(lateral=y, radius_difference=c * y**3, amplitude=amplitude)
    assert found == pytest.approx(exact, rel=1e-5)  # achieved: 4e-6


def test_conicity_of_s1002_on_60e1(s1002_on_60e1):
    found = [
        equivalent_conicity(
            lateral=s1002_on_60e1.lateral, radius_difference=s1002_on_60e1.radius_difference, amplitude=amplitude
        )
        for amplitude in (3e-3, 5e-3)
    ]
    # A plausibility check: new profiles, 1435 mm and 1:40 are said to have 0.17 to 0.2 for 3 mm. Achieved: 0.174.
    assert 0.165 < found[0] < 0.19
    assert found[1] < found[0]


@pytest.mark.parametrize("amplitude", [0.0, 6e-3, np.nan])
def test_amplitudes_that_are_refused(amplitude):
    y = np.linspace(-5e-3, 5e-3, 11)
    with pytest.raises(ParameterError, match="amplitude"):
        equivalent_conicity(lateral=y, radius_difference=0.1 * y, amplitude=amplitude)


def test_radii_that_lead_outwards_are_refused():
    y = np.linspace(-5e-3, 5e-3, 11)
    with pytest.raises(ParameterError, match="does not lead the wheelset back"):
        equivalent_conicity(lateral=y, radius_difference=-0.1 * y, amplitude=3e-3)
