"""Figures of profiles: what is drawn, and where the contact is marked."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from wheelrail.plotting.profiles import contact_over_shift_figure, profiles_figure
from wheelrail.plotting.style import ORANGE
from wheelrail.profile.named_profiles import named_rail_profile, named_wheel_profile
from wheelrail.profile.profile_geometry import ProfileGeometry

GEOMETRY = ProfileGeometry(
    wheel=named_wheel_profile("s1002"),
    rail=named_rail_profile("60e1"),
    nominal_radius=0.46,
    inclination=0.025,
    yaw=0.0,
    reference_shift=0.0,
)


def marks(axis):
    return np.array(
        [
            [line.get_xdata()[0], line.get_ydata()[0]]
            for line in axis.lines
            if line.get_marker() == "o" and line.get_color() == ORANGE
        ]
    )


def test_profiles_touch_where_it_is_marked():
    figure = profiles_figure(GEOMETRY, shift=2.5e-3, title="a $ b")
    FigureCanvasAgg(figure).draw()
    both, between = figure.axes
    labels = {text.get_text() for text in both.get_legend().get_texts()}
    assert labels == {"rail 60e1", "wheel s1002", "first touch", "further point"}
    points = GEOMETRY.search.find(2.5e-3).points
    assert len(points) == 2
    np.testing.assert_allclose(marks(both)[:, 0], [1e3 * point.y_track for point in points])
    np.testing.assert_allclose(marks(between)[:, 1], [1e3 * point.gap for point in points])
    curves = {line.get_label(): np.array(line.get_xydata()) for line in both.lines}
    for body in ("rail 60e1", "wheel s1002"):
        y, z = curves[body].T
        assert np.interp(marks(both)[0, 0], y, z) == pytest.approx(marks(both)[0, 1], abs=1e-4)  # between samples
    gap = np.array(between.lines[0].get_ydata())
    assert np.nanmin(gap) == pytest.approx(0.0, abs=1e-4)  # between samples
    low, high = both.get_ylim()
    assert low > high  # depth


def test_contact_over_the_shift():
    shifts = np.linspace(-10e-3, 5e-3, 151)
    figure = contact_over_shift_figure(GEOMETRY, shifts=shifts, title="")
    FigureCanvasAgg(figure).draw()
    positions, angle, radius, lateral = figure.axes
    wheel = np.array(positions.lines[0].get_xydata())
    drawn = ~np.isnan(wheel[:, 0])
    np.testing.assert_allclose(wheel[drawn, 0], 1e3 * shifts)
    places = [GEOMETRY.place(shift) for shift in shifts.tolist()]
    np.testing.assert_allclose(wheel[drawn, 1], [1e3 * place.y_wheel for place in places])
    # The contact jumps from the tread to the flange's root, at least.
    jumps = np.flatnonzero(~drawn)
    assert len(jumps) >= 1
    assert np.all(np.abs(wheel[jumps + 1, 1] - wheel[jumps - 1, 1]) > 1.0)
    for axis, expected in (
        (angle, np.degrees([place.angle for place in places])),
        (radius, [1e3 * (place.rolling_radius - 0.46) for place in places]),
        (lateral, [1.0 / place.curvature_y for place in places]),
    ):
        np.testing.assert_allclose(np.array(axis.lines[0].get_ydata())[drawn], expected)
    assert lateral.get_yscale() == "log"
    assert lateral.get_xlim() == (-10.0, 5.0)


def test_flat_fits_are_left_out():
    flat = ProfileGeometry(
        wheel=named_wheel_profile("cylinder"),
        rail=named_rail_profile("circular", radius=50.0),
        nominal_radius=0.46,
        inclination=0.0,
        yaw=0.0,
        reference_shift=0.0,
    )
    figure = contact_over_shift_figure(flat, shifts=[-1e-3, 1e-3], title="")
    FigureCanvasAgg(figure).draw()
    assert np.all(np.isnan(figure.axes[3].lines[0].get_ydata()))
