"""Both wheels of a wheelset on a track: contact over the lateral displacement, and the equivalent conicity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import ParameterError
from .contact_search import ContactSearch
from .profile_geometry import Place, ProfileGeometry

__all__ = ["GAUGE_DEPTH", "WheelsetContact", "equivalent_conicity", "rail_axis_position", "wheelset_contact"]

GAUGE_DEPTH = 14e-3
"""Depth below the highest point of the rails at which their gauge is measured, m (EN 13848-1)."""

_ANGLES = 400  # of the integral over a quarter of the wavelength


@dataclass(frozen=True, eq=False)
class WheelsetContact:
    """Contact of a wheelset's two wheels.

    Attributes
    ----------
    lateral : ndarray, shape (n,)
        Displacements of the wheelset, + to the right, m.
    right, left : tuple of Place
        Of each wheel, in its own frame: + to its field side.
    centred_shift : float
        Lateral shift of each wheel on its rail when the wheelset is in the middle, m.
    radius_difference : ndarray, shape (n,)
        Rolling radius of the right wheel less that of the left one, m.
    """

    lateral: NDArray
    right: tuple[Place, ...]
    left: tuple[Place, ...]
    centred_shift: float

    @property
    def radius_difference(self) -> NDArray:
        """Rolling radius of the right wheel less that of the left one, m."""
        return self.values("rolling_radius") - self.values("rolling_radius", left=True)

    def values(self, name: str, *, left: bool = False) -> NDArray:
        """One number of each `Place`, shape (n,)."""
        places: Sequence[Any] = self.left if left else self.right
        return np.array([getattr(place, name) for place in places])


def rail_axis_position(search: ContactSearch, *, gauge: float) -> float:
    """Lateral position of the middle of a rail's running surface from the track's centre, m.

    Parameters
    ----------
    search : ContactSearch
        Holds the inclined rail.
    gauge : float
        Distance of the rails' inner faces within 14 mm below their highest points, m.

    Raises
    ------
    ParameterError
        If the profile of the rail does not reach so deep at the gauge side.
    """
    y, depth = search.tilted_rail
    top = int(np.argmin(depth))
    level = float(depth[top]) + GAUGE_DEPTH
    if depth[0] < level:
        raise ParameterError(
            "gauge",
            gauge,
            f"the profile of the rail {search.rail.name} ends {1e3 * float(depth[0] - depth[top]):.3g} mm below its "
            f"top; the gauge is measured down to {1e3 * GAUGE_DEPTH:g} mm",
        )
    # The flank is the rail's widest place there: it descends all the way outwards.
    return 0.5 * gauge - float(np.interp(-level, -depth[: top + 1], y[: top + 1]))


def wheelset_contact(
    geometry: ProfileGeometry,
    *,
    lateral: ArrayLike,
    gauge: float,
    flange_back_spacing: float,
    flange_back_position: float,
) -> WheelsetContact:
    """Find both contacts of a wheelset whose wheels, and rails, are mirror images of each other.

    The roll of the wheelset, about 1e-4 rad before a flange climbs, is left out, and the yaw is that of the geometry.

    Parameters
    ----------
    geometry : ProfileGeometry
        Of the right wheel.
    lateral : array_like, shape (n,)
        Displacements of the wheelset from the track's centre, + to the right, m.
    gauge : float
        Distance of the rails' inner faces, m.
    flange_back_spacing : float
        Distance of the flanges' backs, m.
    flange_back_position : float
        Lateral position of a flange's back on the wheel's profile, negative, m.

    Returns
    -------
    WheelsetContact

    Raises
    ------
    ParameterError
        If the rail's profile does not reach down to the gauge, or a wheel does not touch within the profiles.
    """
    displacements = np.atleast_1d(np.asarray(lateral, dtype=float))
    tape_circle = 0.5 * flange_back_spacing - flange_back_position
    middle = tape_circle - rail_axis_position(geometry.search, gauge=gauge)
    # The left wheel is the right one's image, so that it yaws the other way in its own frame.
    image = ProfileGeometry(
        wheel=geometry.wheel,
        rail=geometry.rail,
        nominal_radius=geometry.nominal_radius,
        inclination=geometry.inclination,
        yaw=-geometry.yaw,
        reference_shift=geometry.reference_shift,
    )
    return WheelsetContact(
        lateral=displacements,
        right=tuple(geometry.place(middle + value) for value in displacements.tolist()),
        left=tuple(image.place(middle - value) for value in displacements.tolist()),
        centred_shift=middle,
    )


def equivalent_conicity(*, lateral: ArrayLike, radius_difference: ArrayLike, amplitude: float) -> float:
    """Slope of the cone whose wheelset runs in waves of the same length (UIC 519, EN 15302).

    Without inertia, y'' = -dr(y) / (2 b r0): half the square of y' is what the integral of dr has lost since the
    turning point. The quarter of the wavelength that follows is compared with that of dr = 2 gamma y. Both sides are
    averaged if dr is not odd. Neither b nor r0 has an effect.

    Parameters
    ----------
    lateral : array_like, shape (n,)
        Displacements, increasing and reaching the amplitude on both sides, m.
    radius_difference : array_like, shape (n,)
        m.
    amplitude : float
        Of the wave, m.

    Returns
    -------
    float

    Raises
    ------
    ParameterError
        If the displacements don't reach the amplitude, or the wheelset isn't led back to the centre.
    """
    y, difference = np.asarray(lateral, dtype=float), np.asarray(radius_difference, dtype=float)
    if not 0.0 < amplitude <= min(y[-1], -y[0]):
        raise ParameterError("amplitude", amplitude, f"allowed: above 0 and up to {min(y[-1], -y[0]):g} m")
    # y = a sin(t) takes away the singularity at the turning point, next to which the integrand of the work is linear.
    step = 0.25 * np.pi / _ANGLES
    t = step * np.arange(2 * _ANGLES + 1)
    at = amplitude * np.sin(t)
    odd = 0.5 * (np.interp(at, y, difference) - np.interp(-at, y, difference))
    force = odd * amplitude * np.cos(t)
    work = 0.5 * step * (force[1:] + force[:-1])
    left = np.cumsum(work[::-1])[::-1][1::2]  # from each second place to the turning point
    if np.any(left <= 0.0):
        raise ParameterError("amplitude", amplitude, "the difference of radii does not lead the wheelset back (m)")
    quarter = float(np.sum(amplitude * np.cos(t[1::2]) / np.sqrt(2.0 * left)) * 2.0 * step)
    return 0.5 * (0.5 * np.pi / quarter) ** 2
