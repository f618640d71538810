"""First touch of wheel and rail against others: a published computation, surfaces in space, circles and cones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq, minimize

from wheelrail.profile.contact_search import ContactSearch
from wheelrail.profile.curve import ProfileCurve
from wheelrail.profile.named_profiles import named_rail_profile, named_wheel_profile
from wheelrail.profile.profile_geometry import ProfileGeometry
from wheelrail.profile.undeformed_distance import NO_CONTACT, undeformed_distance
from wheelrail.profile.wheelset import rail_axis_position, wheelset_contact

DATA = Path(__file__).parents[1] / "data" / "profiles"
S1002, RAIL_60E1 = named_wheel_profile("s1002"), named_rail_profile("60e1")
RADIUS = 0.46


def table(name: str) -> np.ndarray:
    lines = [line for line in (DATA / name).read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return np.loadtxt(lines[1:], delimiter=",")


def search(*, wheel=S1002, rail=RAIL_60E1, radius=RADIUS, inclination=0.025, yaw=0.0) -> ContactSearch:
    return ContactSearch(wheel=wheel, rail=rail, nominal_radius=radius, inclination=inclination, yaw=yaw)


# Manchester contact benchmark by the program CONTACT


@pytest.fixture(scope="module")
def benchmark_rail() -> ProfileCurve:
    """A cubic spline through the points of each of the zones, which meet in bends."""
    points = table("manchester_benchmark_rail.csv")
    breaks, coefficients = [], []
    start = None
    for zone in (13.0, 80.0, 300.0):
        y, z = 1e-3 * points[points[:, 0] == zone, 1:].T
        spline = CubicSpline(y, z)
        if start is not None and start < y[0]:  # the first piece goes on to where the last zone ends
            spline.c[:, 0] = CubicSpline(y, z).c[:, 0]
            first = np.polynomial.Polynomial(spline.c[::-1, 0])(np.polynomial.Polynomial([start - y[0], 1.0]))
            spline.c[:, 0], y = first.coef[::-1], np.concatenate(([start], y[1:]))
        breaks += y[:-1].tolist()
        coefficients += spline.c[::-1].T.tolist()
        start = float(y[-1])
    return ProfileCurve.from_polynomials("UIC60 v3", [*breaks, start], coefficients)


def test_gauge_of_the_benchmark(benchmark_rail):
    # Its position of the rail, from its outputs of the reference point in both frames: 760.5326 mm.
    axis = rail_axis_position(search(rail=benchmark_rail, inclination=0.0), gauge=1.435)
    assert axis == pytest.approx(0.7605326, abs=2e-7)


@pytest.mark.parametrize("row", table("manchester_benchmark_contact.csv").tolist(), ids=lambda row: f"{row[0]} mm")
def test_manchester_benchmark(benchmark_rail, row):
    lateral, roll, yaw, first, x, y_wheel, angle = row
    # The profile is canted already. In the frame that rolls with the wheelset it is turned by the roll.
    pair = search(rail=benchmark_rail, inclination=roll, yaw=yaw)
    axis = rail_axis_position(search(rail=benchmark_rail, inclination=0.0), gauge=1.435)
    tape_circle = 0.75 * np.cos(yaw)

    def placed(height):
        """Lateral shift, and what the wheel is too high, for a height of the wheelset's axis, m."""
        across, down = axis - 1e-3 * lateral, RADIUS - height
        shift = tape_circle - (across * np.cos(roll) + down * np.sin(roll))
        lift = down * np.cos(roll) - across * np.sin(roll) - RADIUS
        return shift, lift - pair.find(shift).ride_height

    height = brentq(lambda value: placed(value)[1], -12e-3, 5e-3, xtol=1e-11)
    point = pair.find(placed(height)[0]).points[0]
    # Printed to 0.1 um. Achieved: 0.05 um on the tread, 0.2 um on the flange, up to 19.2 mrad of yaw.
    assert 1e3 * height == pytest.approx(first, abs=0.25e-3)
    # The reference point there is the middle of what overlaps under 10 kN; it lies off the first touch where the
    # curvature changes, most at 0.5 mm. Achieved there 2.5 mm and 0.01, else 0.055 mm, 7e-4 and 0.04 mm.
    flat = lateral < 1.0
    assert 1e3 * point.y_wheel == pytest.approx(y_wheel, abs=2.7 if flat else 0.06)
    assert point.angle - roll == pytest.approx(angle, abs=0.011 if flat else 1e-3)
    assert 1e3 * (point.x - 0.75 * np.sin(yaw)) == pytest.approx(x, abs=0.05)


# Surfaces in space, without traces or slopes


def space_gap(pair: ContactSearch, shift: float):
    """Vertical distance of the rail below a point of the turned wheel, as a function of (y_wheel, angle on circle)."""
    c, s = np.cos(pair.inclination), np.sin(pair.inclination)
    own = np.linspace(pair.rail.start, pair.rail.end, 400_001)
    own = own[pair.rail.slope(own) > -1.0 / np.tan(pair.inclination) + 1.0] if s > 0.0 else own
    depth = pair.rail.height(own)
    rail_y, rail_z = own * c + depth * s, depth * c - own * s

    def gap(y, on_circle):
        radius = pair.nominal_radius + pair.wheel.height(y)
        across = shift + y * np.cos(pair.yaw) + radius * np.sin(on_circle) * np.sin(pair.yaw)
        rail = np.interp(across, rail_y, rail_z, left=np.inf, right=np.inf)
        return rail - radius * np.cos(on_circle) + pair.nominal_radius

    return gap


@pytest.mark.parametrize("yaw", [0.0, -0.012, 0.03])
@pytest.mark.parametrize("shift", [-13.5e-3, -6e-3, -2e-3, 1e-3, 3.5e-3, 5e-3])
def test_lowest_point_of_two_surfaces(shift, yaw):
    pair = search(yaw=yaw)
    gap = space_gap(pair, shift)
    y, on_circle = np.meshgrid(np.linspace(-0.0695, 0.0595, 2581), np.linspace(-0.1, 0.1, 401), indexing="ij")
    gaps = gap(y, on_circle)
    best = np.unravel_index(np.argmin(gaps), gaps.shape)
    start = np.array([y[best], on_circle[best]])
    simplex = start + np.array([[0.0, 0.0], [3e-5, 0.0], [0.0, 3e-4]])
    options = {"initial_simplex": simplex, "xatol": 1e-9, "fatol": 1e-15, "maxiter": 2000}
    found = minimize(lambda p: gap(*p), start, method="Nelder-Mead", options=options)
    touch = pair.find(shift)
    point = touch.points[0]
    assert touch.ride_height == pytest.approx(-found.fun, abs=2e-10)  # achieved: 1e-10 m
    assert point.y_wheel == pytest.approx(found.x[0], abs=2e-5)  # flat minimum; achieved: 1e-5 m
    radius = RADIUS + S1002.at(float(found.x[0]))[0]
    x = -found.x[0] * np.sin(yaw) + radius * np.sin(found.x[1]) * np.cos(yaw)
    assert point.x == pytest.approx(x, abs=2e-5)
    # No point of the wheel lies in the rail.
    assert gaps.min() + touch.ride_height > -1e-10


@pytest.mark.parametrize("yaw", [0.0, 0.02])
@pytest.mark.parametrize("shift", [-3.5e-3, 0.0, 2.5e-3, 3.5e-3, 5e-3])
def test_distance_along_the_normal(shift, yaw):
    """Each line along the normal meets the wheel, turned in space, and the rail: found by bisection."""
    pair = search(yaw=yaw)
    touch = pair.find(shift)
    point = touch.points[0]
    reach = 4e-3 if shift < 3e-3 else 1e-3  # a flank of the head is short
    x, y = np.linspace(-8e-3, 8e-3, 5), np.linspace(-reach, reach, 9)
    distance = undeformed_distance(pair, point, x, y)
    assert distance.shape == (9, 5)
    c, s = np.cos(yaw), np.sin(yaw)
    ci, si = np.cos(pair.inclination), np.sin(pair.inclination)
    z_touch = pair.rail.at(point.y_rail)[0] * ci - point.y_rail * si

    def in_wheel(p):
        """Depth under the wheel's surface, measured on the radius; p along, across, down from the rail's middle."""
        along, across = p[0], p[1] - shift
        axial = -along * s + across * c
        forward = along * c + across * s
        return RADIUS + S1002.height(axial) - np.hypot(forward, p[2] + RADIUS + touch.ride_height)

    def in_rail(p):
        own = p[1] * ci - p[2] * si
        return p[1] * si + p[2] * ci - RAIL_60E1.height(own)

    normal = np.array([0.0, np.sin(point.angle), np.cos(point.angle)])
    errors, recess = [], []
    for i, across in enumerate(y):
        for j, along in enumerate(x):
            base = np.array([point.x + along, point.y_track, z_touch])
            base = base + across * np.array([0.0, np.cos(point.angle), -np.sin(point.angle)])
            wheel = brentq(lambda q, base=base: float(in_wheel(base + q * normal)), -2e-3, 1e-3, xtol=1e-13)
            rail = brentq(lambda q, base=base: float(in_rail(base + q * normal)), -1e-4, 2e-3, xtol=1e-13)
            errors.append(distance[i, j] - (rail - wheel))
            recess.append(along**2 / (2.0 * RADIUS))
    # Twice what the docstring states, for the radius of 13 mm at the flange's root. Achieved: half of it; 2.7e-10 m on
    # the tread and 1.5e-7 m on the flank, 8 mm ahead.
    bound = 77.0 * (np.array(recess) * np.sin(point.angle)) ** 2 + 2e-10
    assert np.all(np.abs(errors) < bound)
    assert np.all(distance[4, [0, 1, 3, 4]] > 0.0)
    assert distance[4, 2] == pytest.approx(0.0, abs=1e-12)


# A whole wheelset of polygons, in the frame of the track


def test_wheelset_of_polygons():
    """Both wheels and rails as polygons of 1 um, each placed from gauge and flange backs, lowered without searching."""
    lateral = np.linspace(-10e-3, 10e-3, 21)
    geometry = ProfileGeometry(
        wheel=S1002, rail=RAIL_60E1, nominal_radius=RADIUS, inclination=0.025, yaw=0.0, reference_shift=0.0
    )
    track = {"gauge": 1.435, "flange_back_spacing": 1.36, "flange_back_position": -0.07}
    found = wheelset_contact(geometry, lateral=lateral, **track)
    own = np.linspace(RAIL_60E1.start, RAIL_60E1.end, 72_001)
    turn = np.exp(-0.025j)  # y + i z
    rail = (own + 1j * RAIL_60E1.height(own)) * turn
    rail -= 1j * rail.imag.min()
    inner = slice(0, int(np.argmin(rail.imag)))
    rail += 0.5 * 1.435 - np.interp(-14e-3, -rail.imag[inner], rail.real[inner])
    y = np.linspace(-0.07, 0.06, 130_001)
    z = S1002.height(y)
    radii, heights = [], []
    for side in (1.0, -1.0):
        rail_y, rail_z = (side * rail.real)[:: int(side)], rail.imag[:: int(side)]
        wheel_y = side * (0.68 + 0.07 + y)
        for displacement in lateral:
            gap = np.interp(wheel_y + displacement, rail_y, rail_z, left=np.inf, right=np.inf) - z
            lowest = np.argmin(gap)
            radii.append(RADIUS + z[lowest])
            heights.append(-gap[lowest])
    difference = np.subtract(*np.split(np.array(radii), 2))
    # Achieved: 1.3e-6 m on the flank, whose slope makes that of the polygons' step.
    np.testing.assert_allclose(found.radius_difference, difference, atol=3e-6)
    # Heights count from the middle of the rail's surface there, from its highest point here. Achieved: 1.4e-8 m on the
    # flank, since the gauge is read from samples 0.1 mm apart; below 1e-9 m on the tread.
    tilt = np.concatenate([found.values("ride_height"), found.values("ride_height", left=True)]) - np.array(heights)
    assert tilt[0] == pytest.approx(0.3 / np.cos(0.025) - 0.3, abs=1e-7)
    assert np.ptp(tilt) < 3e-8


# Circles and cones


@pytest.mark.parametrize("inclination", [0.0, 0.025, -0.01])
@pytest.mark.parametrize("shift", [-4e-3, 0.0, 7e-3])
def test_cone_on_a_circle(inclination, shift):
    conicity, rail_radius = 0.1, 0.3
    pair = search(
        wheel=named_wheel_profile("cone", conicity=conicity),
        rail=named_rail_profile("circular", radius=rail_radius),
        inclination=inclination,
    )
    touch = pair.find(shift)
    (point,) = touch.points
    angle = np.arctan(conicity)
    # Where the circle, whose centre the inclination moves, has the slope of the cone.
    across = rail_radius * (np.sin(inclination) - np.sin(angle))
    depth = rail_radius * (np.cos(inclination) - np.cos(angle))
    assert point.y_track == pytest.approx(across, abs=1e-13)
    assert point.y_rail == pytest.approx(rail_radius * np.sin(inclination - angle), abs=1e-13)
    assert point.y_wheel == pytest.approx(across - shift, abs=1e-13)
    assert point.angle == pytest.approx(angle, abs=1e-12)
    assert point.rolling_radius == pytest.approx(RADIUS - conicity * (across - shift), abs=1e-14)
    assert touch.ride_height == pytest.approx(-conicity * (across - shift) - depth, abs=1e-14)
    # Radii as Hertz has them: of the cone in its normal section, of the rail.
    assert point.curvature_x == pytest.approx(np.cos(angle) / point.rolling_radius, rel=1e-12)
    assert point.curvature_y == pytest.approx(1.0 / rail_radius, rel=1e-12)


def test_crossed_cylinders_and_their_parabola():
    pair = search(
        wheel=named_wheel_profile("cylinder"), rail=named_rail_profile("circular", radius=0.3), inclination=0.0
    )
    point = pair.find(0.0).points[0]
    np.testing.assert_allclose([point.x, point.angle, point.turn, point.gap], 0.0, atol=1e-15)
    x, y = np.linspace(-0.01, 0.01, 9), np.linspace(-0.006, 0.006, 7)
    distance = undeformed_distance(pair, point, x, y)
    exact = RADIUS - np.sqrt(RADIUS**2 - x**2) + (0.3 - np.sqrt(0.09 - y**2))[:, None]
    np.testing.assert_allclose(distance, exact, atol=1e-15)
    parabola = x**2 / (2.0 * RADIUS) + (y**2 / 0.6)[:, None]
    for scale in (1.0, 0.1):  # what is left falls with the fourth power: 1.9e-8 m, 1.9e-12 m
        distance = undeformed_distance(pair, point, scale * x, scale * y)
        assert np.abs(distance - scale**2 * parabola).max() < 2e-8 * scale**4


def test_a_sphere_on_a_circle_turned_by_a_large_yaw():
    """A sphere is the same from all sides: neither place nor radii know the yaw."""
    radius, rail_radius = 0.4, 0.25
    from wheelrail.profile.curve import Piece

    ball = ProfileCurve.from_pieces("ball", [Piece(-0.05, 0.05, (-radius,), 0.0, 0.0, radius, 1)])
    pair = search(wheel=ball, rail=named_rail_profile("circular", radius=rail_radius), radius=radius, yaw=0.3)
    touch = pair.find(0.004)
    point = touch.points[0]
    # Centres below each other.
    angle = -np.arcsin((0.004 - rail_radius * np.sin(0.025)) / (radius + rail_radius))
    assert point.angle == pytest.approx(angle, abs=1e-11)
    assert point.x == pytest.approx(0.0, abs=1e-11)
    assert point.curvature_x == pytest.approx(1.0 / radius, rel=1e-10)
    assert point.curvature_y == pytest.approx(1.0 / radius + 1.0 / rail_radius, rel=1e-10)
    distance = undeformed_distance(pair, point, np.linspace(-0.01, 0.01, 5), np.array([0.0]))
    np.testing.assert_allclose(distance[0], radius - np.sqrt(radius**2 - np.linspace(-0.01, 0.01, 5) ** 2), atol=2e-9)


def test_mirror():
    """Wheel and rail mirrored, with shift, inclination and yaw reversed, touch at the mirrored place."""

    def mirrored(curve):
        flipped = curve.coefficients[::-1] * (-1.0) ** np.arange(curve.coefficients.shape[1])
        numbers = (-curve.breaks[::-1], flipped, -curve.origins[::-1], -curve.centres[::-1])
        return ProfileCurve("mirrored", *numbers, curve.radii[::-1], curve.bulges[::-1])

    here = search(yaw=0.01)
    there = search(wheel=mirrored(S1002), rail=mirrored(RAIL_60E1), inclination=-0.025, yaw=-0.01)
    for shift in (-8e-3, 0.0, 4e-3):
        one, other = here.find(shift), there.find(-shift)
        assert other.ride_height == pytest.approx(one.ride_height, abs=1e-12)
        a, b = one.points[0], other.points[0]
        np.testing.assert_allclose([b.y_wheel, b.y_rail, b.angle], -np.array([a.y_wheel, a.y_rail, a.angle]), atol=2e-9)
        np.testing.assert_allclose([b.x, b.rolling_radius], [a.x, a.rolling_radius], atol=2e-9)


def test_beyond_the_head_there_is_no_contact():
    pair = search()
    distance = undeformed_distance(pair, pair.find(0.0).points[0], np.array([0.0]), np.array([-0.06, 0.0, 0.2]))
    assert distance[:, 0].tolist() == [NO_CONTACT, 0.0, NO_CONTACT]
