"""Figures of wheel and rail profiles: both in contact, and the place of contact over the lateral shift."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from wheelrail.profile.contact_search import ContactPoint
from wheelrail.profile.profile_geometry import Place, ProfileGeometry

from .style import BLUE, GREEN, GREY, INK, ORANGE, legend, new_figure

__all__ = ["contact_over_shift_figure", "profiles_figure"]

_MARGIN = 4.0  # mm around the rail
_JUMP = 1e-3  # m between neighbouring shifts: the contact is at another place
_NORMAL = 6.0  # mm
_FLATTEST = 20.0  # m, of the radii that are drawn


def profiles_figure(geometry: ProfileGeometry, *, shift: float, title: str) -> Figure:
    """Draw both profiles as they touch, and what is between them, which is too small to be seen there.

    Parameters
    ----------
    geometry : ProfileGeometry
    shift : float
        Lateral shift of the wheel on the rail, m.
    title : str

    Returns
    -------
    Figure

    Raises
    ------
    ParameterError
        If wheel and rail touch at the end of a profile.
    """
    search = geometry.search
    touch = search.find(shift)
    figure, (both, between) = new_figure(title, rows=2, height=5.0, share_x=True, height_ratios=[1.4, 1.0])
    rail_y, rail_z = search.tilted_rail
    wheel_y, wheel_z = search.trace
    wheel_y, wheel_z = wheel_y + shift, wheel_z - touch.ride_height
    both.fill_between(1e3 * rail_y, 1e3 * rail_z, 1e3 * float(np.max(rail_z)), color=GREY, alpha=0.15, linewidth=0.0)
    both.plot(1e3 * rail_y, 1e3 * rail_z, color=INK, linewidth=1.2, label=f"rail {geometry.rail.name}")
    both.plot(1e3 * wheel_y, 1e3 * wheel_z, color=BLUE, linewidth=1.2, label=f"wheel {geometry.wheel.name}")
    for number, point in enumerate(touch.points):
        _mark(both, point, rail_y, rail_z, number)
    both.set_aspect("equal", adjustable="datalim")
    both.invert_yaxis()
    both.set_ylabel("Depth / mm")
    legend(both, loc="lower center", ncols=2)

    gap = np.interp(wheel_y, rail_y, rail_z, left=np.nan, right=np.nan) - wheel_z
    between.plot(1e3 * wheel_y, 1e3 * gap, color=GREEN, linewidth=1.2)
    for number, point in enumerate(touch.points):
        between.plot(1e3 * point.y_track, 1e3 * point.gap, "o", color=ORANGE, markersize=5.0, fillstyle=_fill(number))
    between.set_ylim(-0.05, 1.0)
    between.set_xlim(1e3 * rail_y[0] - _MARGIN, 1e3 * rail_y[-1] + _MARGIN)
    between.set_ylabel("Vertical gap / mm")
    between.set_xlabel("Lateral position from the rail's axis, + to the field side / mm")
    return figure


def contact_over_shift_figure(geometry: ProfileGeometry, *, shifts: ArrayLike, title: str) -> Figure:
    """Draw the place of contact, its angle, the rolling radius and the relative lateral radius over the shift.

    Parameters
    ----------
    geometry : ProfileGeometry
    shifts : array_like, shape (n,)
        Lateral shifts of the wheel on the rail, increasing, m.
    title : str

    Returns
    -------
    Figure

    Raises
    ------
    ParameterError
        If wheel and rail touch at the end of a profile.
    """
    values = np.asarray(shifts, dtype=float)
    places = [geometry.place(shift) for shift in values.tolist()]
    figure, (positions, angle, radius, lateral) = new_figure(title, rows=4, height=8.0, share_x=True)
    on_wheel, on_rail = (np.array([getattr(place, name) for place in places]) for name in ("y_wheel", "y_rail"))
    jumps = np.flatnonzero(np.abs(np.diff(on_wheel)) > _JUMP) + 1
    _line(positions, values, 1e3 * on_wheel, jumps, BLUE, "on the wheel, from the tape circle")
    _line(positions, values, 1e3 * on_rail, jumps, INK, "on the rail, from its axis")
    _others(positions, values, places)
    positions.set_ylabel("Position / mm")
    legend(positions, loc="best")
    _line(angle, values, np.degrees([place.angle for place in places]), jumps, BLUE)
    angle.set_ylabel("Contact angle / °")
    difference = np.array([place.rolling_radius for place in places]) - geometry.nominal_radius
    _line(radius, values, 1e3 * difference, jumps, BLUE)
    radius.set_ylabel("Rolling radius\nless nominal / mm")
    curvature = np.array([place.curvature_y for place in places])
    across = np.where(curvature > 1.0 / _FLATTEST, 1.0 / np.maximum(curvature, 1.0 / _FLATTEST), np.nan)
    _line(lateral, values, across, jumps, BLUE)
    lateral.set_yscale("log")
    lateral.set_ylabel("Relative lateral\nradius / m")
    lateral.set_xlabel("Lateral shift of the wheel on the rail, + to the field side / mm")
    lateral.set_xlim(1e3 * values[0], 1e3 * values[-1])
    return figure


def _fill(number: int) -> str:
    """Fill the mark of the first touch alone."""
    return "full" if number == 0 else "none"


def _mark(axis: Axes, point: ContactPoint, rail_y: NDArray, rail_z: NDArray, number: int) -> None:
    y, z = 1e3 * point.y_track, 1e3 * float(np.interp(point.y_track, rail_y, rail_z))
    label = ("first touch", "further point")[min(number, 1)] if number < 2 else None
    axis.plot(y, z, "o", color=ORANGE, markersize=5.0, fillstyle=_fill(number), label=label, zorder=4.0)
    end = (y + _NORMAL * math.sin(point.angle), z + _NORMAL * math.cos(point.angle))
    axis.plot([y, end[0]], [z, end[1]], color=ORANGE, linewidth=0.9)


def _line(axis: Axes, shifts: NDArray, values: NDArray, jumps: NDArray, colour: str, label: str | None = None) -> None:
    """Draw a curve, interrupted where the contact jumps to another place."""
    axis.plot(
        np.insert(1e3 * shifts, jumps, np.nan),
        np.insert(values, jumps, np.nan),
        color=colour,
        linewidth=1.2,
        label=label,
    )


def _others(axis: Axes, shifts: NDArray, places: Sequence[Place]) -> None:
    points = [
        (shift, other.y_wheel)
        for shift, place in zip(shifts, places, strict=True)
        for other in place.others
        if other.gap <= 1e-4
    ]
    if points:
        x, y = 1e3 * np.array(points).T
        axis.plot(x, y, ".", color=ORANGE, markersize=3.0, label="further points on the wheel, gap below 0.1 mm")
