"""Search for contact points: several points, fits without a single minimum, corners, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.errors import ParameterError
from wheelrail.profile.contact_search import ContactSearch
from wheelrail.profile.curve import Piece, ProfileCurve
from wheelrail.profile.named_profiles import named_rail_profile, named_wheel_profile

S1002, RAIL_60E1 = named_wheel_profile("s1002"), named_rail_profile("60e1")


def search(*, wheel=S1002, rail=RAIL_60E1, inclination=0.025, yaw=0.0) -> ContactSearch:
    return ContactSearch(wheel=wheel, rail=rail, nominal_radius=0.46, inclination=inclination, yaw=yaw)


def test_two_points_at_the_jump_from_tread_to_flange_root():
    pair = search()
    # The shift at which both touch at once: there the first point changes.
    low, high = 2.0e-3, 3.0e-3
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if pair.find(middle).points[0].y_wheel > -25e-3 else (low, middle)
    before, after = pair.find(low), pair.find(high)
    assert [len(before.points), len(after.points)] == [2, 2]
    assert after.ride_height == pytest.approx(before.ride_height, abs=1e-9)
    for touch in (before, after):
        assert touch.points[0].gap == 0.0
        assert 0.0 <= touch.points[1].gap < 1e-9
    np.testing.assert_allclose(
        [point.y_wheel for point in before.points], [point.y_wheel for point in reversed(after.points)], atol=1e-7
    )
    assert before.points[0].angle < 0.2 < before.points[1].angle


def test_further_points_are_minima_with_their_vertical_gap():
    pair = search()
    touch = pair.find(2.5e-3)
    first, second = touch.points
    heights = [S1002.at(point.y_wheel)[0] for point in touch.points]
    c, s = np.cos(0.025), np.sin(0.025)
    depths = [RAIL_60E1.at(point.y_rail)[0] * c - point.y_rail * s for point in touch.points]
    gaps = np.array(depths) - heights + touch.ride_height
    np.testing.assert_allclose(gaps, [first.gap, second.gap], atol=1e-15)
    assert second.gap > 1e-6
    assert len(pair.find(2.5e-3, tolerance=0.5 * second.gap).points) == 1
    assert len(pair.find(2.5e-3, separation=15e-3).points) == 1
    for point in touch.points:
        assert point.curvature_y > 0.0


@pytest.mark.parametrize("yaw", [0.0, 0.01])
def test_ride_height_is_continuous(yaw):
    pair = search(yaw=yaw)
    shifts = np.arange(-14e-3, 6.5e-3, 2e-5)
    heights = np.array([pair.find(shift).ride_height for shift in shifts])
    # Its slope is that of the contact: never above that of the flange, 2.75, and never below that of the tread.
    slopes = np.diff(heights) / 2e-5
    assert slopes.max() < 2.76
    assert slopes.min() > 0.0


def test_slope_of_the_ride_height_is_that_of_the_contact():
    pair = search()
    for shift in (-6e-3, 0.0, 4e-3):
        rise = (pair.find(shift + 1e-6).ride_height - pair.find(shift - 1e-6).ride_height) / 2e-6
        assert rise == pytest.approx(np.tan(pair.find(shift).points[0].angle), abs=1e-4)


def test_a_fit_without_a_single_minimum():
    """A groove of the rail's own radius, 20 mm wide, touches all along: any of its points will do."""
    depth, slope = 0.3 - np.sqrt(0.3**2 - 0.01**2), 0.01 / np.sqrt(0.3**2 - 0.01**2)
    groove = ProfileCurve.from_pieces(
        "groove",
        [
            Piece(-0.03, -0.01, (depth, -slope), origin=-0.01),
            Piece(-0.01, 0.01, (0.3,), centre=0.0, radius=0.3, bulge=-1),
            Piece(0.01, 0.03, (depth, slope), origin=0.01),
        ],
    )
    rail = named_rail_profile("circular", radius=0.3)
    touch = search(wheel=groove, rail=rail, inclination=0.0).find(0.0)
    assert touch.ride_height == pytest.approx(0.0, abs=1e-15)
    for point in touch.points:
        assert abs(point.y_wheel) < 0.01 + 1e-9
        assert point.gap < 1e-15


def test_a_corner_touches_with_the_plane_between_its_sides():
    roof = ProfileCurve.from_pieces("roof", [Piece(-0.05, 0.0, (0.0, -0.2)), Piece(0.0, 0.05, (0.0, 0.1))])
    (point,) = search(wheel=named_wheel_profile("cylinder"), rail=roof, inclination=0.0).find(3e-3).points
    assert point.y_rail == pytest.approx(0.0, abs=1e-12)
    assert point.y_wheel == pytest.approx(-3e-3, abs=1e-12)
    assert abs(point.angle) < 0.11


def test_the_same_twice():
    one, other = search(yaw=0.004), search(yaw=0.004)
    one.find(-2e-3)
    assert one.find(1.234e-3) == other.find(1.234e-3)


@pytest.mark.parametrize("shift", [-0.11, 0.11, 0.5, np.nan, np.inf])
def test_contact_at_the_end_of_a_profile_is_refused(shift):
    with pytest.raises(ParameterError, match=r"lateral_shift = .* end of a profile"):
        search().find(shift)


def test_a_tread_that_ends_on_the_rail_is_refused():
    short = ProfileCurve.from_pieces("short", [Piece(-0.07, 0.004, (0.0, 0.1))])
    with pytest.raises(ParameterError, match="wheel short would touch the rail 60e1 at the end"):
        search(wheel=short).find(0.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [({"inclination": 0.6}, "inclination"), ({"yaw": np.nan}, "yaw"), ({"nominal_radius": 0.0}, "nominal_radius")],
)
def test_refused_numbers(change, message):
    numbers = {"nominal_radius": 0.46, "inclination": 0.025, "yaw": 0.0, **change}
    with pytest.raises(ParameterError, match=message):
        ContactSearch(wheel=S1002, rail=RAIL_60E1, **numbers)


def test_a_rail_that_leans_past_the_vertical():
    """An inclination that brings a head's steep side past the vertical leaves it out, at the gauge side."""
    pair = search(inclination=0.2)
    y, depth = pair.tilted_rail
    assert np.all(np.diff(y) > 0.0)
    assert np.all(np.diff(depth[: np.argmin(depth)]) < 0.0)
    pair.find(0.0)
