"""Distance of wheel and rail around a contact point, along the common normal (numpy only: shipped in the FMU)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .contact_search import ContactPoint, ContactSearch
from .curve import ProfileCurve

__all__ = ["NO_CONTACT", "undeformed_distance"]

NO_CONTACT = 1.0
"""Distance in m where a profile has ended: too large for any contact, and a number that others can be added to."""

_UPRIGHT = 0.02  # slope of tangential over lateral position where a curve stands upright on the tangent plane
_NEWTON_STEPS = 2  # from between samples, 1e-3 of their distance of 0.1 mm off at most, which each step squares


def undeformed_distance(search: ContactSearch, point: ContactPoint, x: NDArray, y: NDArray) -> NDArray:
    """Distance of the two surfaces over the tangent plane of a point where they touch.

    The rail is exact. So is the wheel at x = 0; ahead of it and behind, its surface recedes by
    s / (cos(angle) - w' sin(angle)) with s = r - sqrt(r^2 - x^2) for its radius r and slope w' at that lateral
    position. What this leaves out is the lateral way s sin(angle) on its curved profile, about
    curvature (s sin(angle))^2 / 2: below 1 nm on the tread, 0.15 um 8 mm ahead on the flank of S1002.

    Parameters
    ----------
    search : ContactSearch
        Holds the profiles.
    point : ContactPoint
        Found by it.
    x : ndarray, shape (mx,)
        Positions along the rail from the point, m.
    y : ndarray, shape (my,)
        Positions across, in the tangent plane, from the point, + to the field side, m.

    Returns
    -------
    ndarray, shape (my, mx)
        m; `NO_CONTACT` where wheel or rail has ended or turns away from the plane.
    """
    x, y = np.asarray(x, dtype=float)[None, :], np.asarray(y, dtype=float)[:, None]
    rail, _, _ = _from_plane(search.rail, point.y_rail, point.angle - search.inclination, y)
    # The wheel's own directions, around it and along its meridian, are turned in the plane by the yaw.
    around = x * math.cos(point.turn) - y * math.sin(point.turn)
    along = y if point.turn == 0.0 else x * math.sin(point.turn) + y * math.cos(point.turn)
    wheel_angle = point.angle if point.turn == 0.0 else point.wheel_angle
    wheel, height, rate = _from_plane(search.wheel, point.y_wheel, wheel_angle, along)
    radius = search.nominal_radius + height
    recess = radius - np.sqrt(np.where(np.abs(around) < radius, radius**2 - around**2, np.nan))
    distance = rail - wheel + recess / rate
    return np.where(np.isnan(distance), NO_CONTACT, distance)


def _from_plane(curve: ProfileCurve, y: float, angle: float, offsets: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Distance of a curve from its tangent, + along z, at positions on the tangent.

    Parameters
    ----------
    curve : ProfileCurve
    y : float
        Where the tangent touches, m.
    angle : float
        Of the tangent: its slope is -tan(angle); rad.
    offsets : ndarray, any shape
        Positions on the tangent, m.

    Returns
    -------
    distance, height, rate : ndarray, shape of offsets
        Distance (m), height on the curve (m), and derivative of the offset over the lateral position on it; nan where
        the curve has ended or turned upright.
    """
    sine, cosine = math.sin(angle), math.cos(angle)
    touch = curve.at(y)[0]
    own, heights = curve.samples
    tangential = (own - y) * cosine - (heights - touch) * sine
    step = np.diff(tangential) <= _UPRIGHT * np.diff(own)
    middle = int(np.searchsorted(own, y))
    before, after = np.flatnonzero(step[: max(middle - 1, 0)]), np.flatnonzero(step[middle:])
    first = int(before[-1]) + 1 if len(before) else 0
    last = middle + int(after[0]) if len(after) else len(own) - 1
    open_to_plane = slice(first, last + 1)
    position = np.interp(offsets, tangential[open_to_plane], own[open_to_plane], left=np.nan, right=np.nan)
    for _ in range(_NEWTON_STEPS):
        height, slope, _ = curve.evaluate(position)
        rate = cosine - slope * sine
        error = (position - y) * cosine - (height - touch) * sine - offsets
        position = np.clip(position - error / rate, own[first], own[last])
    height, slope, _ = curve.evaluate(position)
    return (position - y) * sine + (height - touch) * cosine, height, cosine - slope * sine
