"""Where a wheel first touches a rail, and where else they come close (numpy only: shipped in the FMU).

The wheel is a body of revolution, the rail a prism; both are rigid. Of each circle of a wheel that is turned by the yaw
angle, one point has a normal without a component along the rail: only those can touch it (the trace of the wheel, Wang
1984). Their vertical distance from the rail is sampled, and each minimum is refined to where the slopes are equal.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from .curve import ProfileCurve

__all__ = ["ContactPoint", "ContactSearch", "FirstTouch"]

_SAMPLED_ERROR = 5e-6  # m, by which a sampled minimum may seem higher than it is
_MOST_CANDIDATES = 24
_UPRIGHT = 0.02  # slope of the lateral over the own position where a tilted rail counts as upright
_POSITION_ERROR = 1e-13  # m
_SAME_SLOPE = 1e-12  # of profiles that fit along a stretch, where rounding alone decides
_MOST_STEPS = 200


class ContactPoint(NamedTuple):
    """A point where wheel and rail touch, or come close.

    Attributes
    ----------
    y_wheel : float
        Lateral position on the wheel from the tape circle, m.
    y_rail : float
        Lateral position on the rail from its axis, in the frame that is inclined with the rail, m.
    y_track : float
        Lateral position from the middle of the rail's running surface, in the frame of the track, m.
    x : float
        Position along the rail ahead of the wheel's centre, m; not 0 with yaw.
    angle : float
        Contact angle in the track's cross-section, rad: positive where the flange climbs.
    rolling_radius : float
        m.
    curvature_x, curvature_y : float
        Relative principal curvatures along and across the rail, 1/m. Negative: it is no minimum, but a corner.
    wheel_angle : float
        Contact angle in the wheel's meridian plane, rad.
    turn : float
        Angle in the tangent plane from the rail's direction to that of the wheel's circle, rad; 0 without yaw.
    gap : float
        Vertical distance when wheel and rail touch at the first point, m.
    """

    y_wheel: float
    y_rail: float
    y_track: float
    x: float
    angle: float
    rolling_radius: float
    curvature_x: float
    curvature_y: float
    wheel_angle: float
    turn: float
    gap: float


class FirstTouch(NamedTuple):
    """Result of a search.

    Attributes
    ----------
    ride_height : float
        Height of the wheel's axis over the middle of the rail's running surface, less the nominal radius, m.
    points : tuple of ContactPoint
        The point of first touch, then further ones in the order of their gaps.
    """

    ride_height: float
    points: tuple[ContactPoint, ...]


class ContactSearch:
    """Search for one pair of profiles; what does not depend on the lateral shift is computed once.

    Parameters
    ----------
    wheel, rail : ProfileCurve
    nominal_radius : float
        Of the wheel at its tape circle, m.
    inclination : float
        Angle by which the rail leans to the track's centre, rad: 1:40 is 0.025.
    yaw : float
        Turn of the wheel about the vertical, from the rolling direction to the field side, rad.

    Raises
    ------
    ParameterError
        If the radius is not larger than the wheel's profile is deep, or an angle is out of range.
    """

    def __init__(
        self, *, wheel: ProfileCurve, rail: ProfileCurve, nominal_radius: float, inclination: float, yaw: float
    ) -> None:
        if not (math.isfinite(nominal_radius) and nominal_radius + float(np.min(wheel.samples[1])) > 0.0):
            raise ParameterError("nominal_radius", nominal_radius, "the wheel needs a positive radius everywhere (m)")
        for name, angle in (("inclination", inclination), ("yaw", yaw)):
            if not abs(angle) <= 0.5:
                raise ParameterError(name, angle, "allowed: from -0.5 to 0.5 rad")
        self.wheel = wheel
        self.rail = rail
        self.nominal_radius = float(nominal_radius)
        self.inclination = float(inclination)
        self.yaw = float(yaw)

    @cached_property
    def _trace(self) -> tuple[NDArray, NDArray, NDArray]:
        """Samples of the trace: position on the wheel, lateral position, depth below the nominal radius; m."""
        y, depth = self.wheel.samples
        if self.yaw == 0.0:
            return y, y, depth
        slope = self.wheel.slope(y)
        radius = self.nominal_radius + depth
        sine = slope * math.tan(self.yaw)
        cosine = np.sqrt(np.maximum(1.0 - sine**2, 0.0))
        # Circles too steep for the yaw angle have no point of the trace: nowhere is their normal across the rail.
        lowest = np.where(np.abs(sine) < 1.0, radius * cosine - self.nominal_radius, -np.inf)
        return y, y * math.cos(self.yaw) - radius * sine * math.sin(self.yaw), lowest

    @cached_property
    def _tilted(self) -> tuple[NDArray, NDArray, NDArray]:
        """Samples of the rail: lateral position and depth in the track's frame, position in its own; m."""
        own, depth = self.rail.samples
        cosine, sine = math.cos(self.inclination), math.sin(self.inclination)
        upright = cosine + self.rail.slope(own) * sine < _UPRIGHT
        # A side that the inclination brings past the vertical can't be touched from above.
        middle = int(np.argmin(depth))
        first = int(np.flatnonzero(upright[:middle])[-1]) + 1 if upright[:middle].any() else 0
        last = middle + int(np.argmax(upright[middle:])) if upright[middle:].any() else len(own)
        own, depth = own[first:last], depth[first:last]
        return own * cosine + depth * sine, depth * cosine - own * sine, own

    @property
    def trace(self) -> tuple[NDArray, NDArray]:
        """Samples of the wheel's trace: lateral position from the tape circle, and depth; m, nan where it has none."""
        _, across, lowest = self._trace
        return across, np.where(np.isfinite(lowest), lowest, np.nan)

    @property
    def tilted_rail(self) -> tuple[NDArray, NDArray]:
        """Samples of the rail in the track's frame: lateral position, increasing, and depth; m."""
        return self._tilted[0], self._tilted[1]

    def find(self, shift: float, *, tolerance: float = 1e-4, separation: float = 2e-3) -> FirstTouch:
        """Lower the wheel until it touches the rail.

        Parameters
        ----------
        shift : float
            Lateral position of the tape circle from the middle of the rail's running surface, m, + to the field side.
        tolerance : float
            Largest gap of a further point, m.
        separation : float
            Smallest distance of two points on the wheel, m.

        Returns
        -------
        FirstTouch

        Raises
        ------
        ParameterError
            If they touch at the end of a profile, or pass each other.
        """
        shift = float(shift)
        _, across, lowest = self._trace
        y_track, depth, _ = self._tilted
        gap = np.interp(across + shift, y_track, depth, left=np.inf, right=np.inf) - lowest
        least = float(np.min(gap))
        if not math.isfinite(least):
            self._refuse(shift)
        inner = gap[1:-1]
        near = (inner <= gap[:-2]) & (inner < gap[2:]) & (inner <= least + tolerance + _SAMPLED_ERROR)
        candidates = np.flatnonzero(near) + 1
        candidates = candidates[np.argsort(gap[candidates], kind="stable")][:_MOST_CANDIDATES]
        refined: list[tuple[float, float]] = []
        for candidate in candidates.tolist():
            root = self._refine(shift, candidate, gap)
            if root is not None:
                refined.append((self._compare(shift, root)[1], root))
        refined.sort()
        # At the end of a profile the sampled distance is exact, so that it can be compared.
        if not refined or refined[0][0] > least + 1e-12 + _SAMPLED_ERROR:
            self._refuse(shift)
        height = refined[0][0]
        chosen: list[ContactPoint] = []
        for found, y in refined:
            if found - height > tolerance:
                break
            if all(abs(y - point.y_wheel) >= separation for point in chosen):
                chosen.append(self._point(shift, y, found - height))
        return FirstTouch(-height, tuple(chosen))

    def _refuse(self, shift: float) -> None:
        raise ParameterError(
            "lateral_shift",
            shift,
            f"the wheel {self.wheel.name} would touch the rail {self.rail.name} at the end of a profile, or pass it "
            f"(the wheel's profile goes from {1e3 * self.wheel.start:.4g} to {1e3 * self.wheel.end:.4g} mm, the rail's "
            f"from {1e3 * self.rail.start:.4g} to {1e3 * self.rail.end:.4g} mm); choose a smaller shift (m), or "
            "profiles that reach farther",
        )

    def _on_rail(self, y: float) -> float:
        """Position in the rail's own frame of a lateral position in the track's, m."""
        y_track, _, own = self._tilted
        position = float(np.interp(y, y_track, own))
        if self.inclination == 0.0:
            return y
        cosine, sine = math.cos(self.inclination), math.sin(self.inclination)
        for _ in range(20):
            depth, slope, _ = self.rail.at(position)
            step = (position * cosine + depth * sine - y) / (cosine + slope * sine)
            position -= step
            if abs(step) < 1e-16:
                break
        return position

    def _compare(self, shift: float, y: float) -> tuple[float, float]:
        """Return the vertical distance from the rail: its derivative over the position on the wheel, and itself (m)."""
        depth, slope, second = self.wheel.at(y)
        across, rate = y, 1.0
        if self.yaw != 0.0:
            radius = self.nominal_radius + depth
            tangent, sine = math.tan(self.yaw), math.sin(self.yaw)
            across = y * math.cos(self.yaw) - radius * slope * tangent * sine
            rate = math.cos(self.yaw) - tangent * sine * (slope * slope + radius * second)
            cosine = math.sqrt(max(1.0 - (slope * tangent) ** 2, 1e-30))
            depth = radius * cosine - self.nominal_radius
            slope = slope / (math.cos(self.yaw) * cosine)
        own = self._on_rail(across + shift)
        rail, rail_slope, _ = self.rail.at(own)
        cosine, sine = math.cos(self.inclination), math.sin(self.inclination)
        tilted = (rail_slope * cosine - sine) / (cosine + rail_slope * sine)
        return rate * (tilted - slope), rail * cosine - own * sine - depth

    def _refine(self, shift: float, index: int, gap: NDArray) -> float | None:
        """Position on the wheel where the distance is least, near a sample where it seems to be; None: at an end."""
        on_wheel = self._trace[0]

        def rise(i: int) -> float:
            return self._compare(shift, float(on_wheel[i]))[0]

        low, high = index - 1, index + 1
        while rise(low) > _SAME_SLOPE:
            low, high = low - 1, low
            if low < 0 or not math.isfinite(gap[low]):
                return None
        while rise(high) < -_SAME_SLOPE:
            low, high = high, high + 1
            if high >= len(gap) or not math.isfinite(gap[high]):
                return None
        return _root(lambda y: self._compare(shift, y)[0], float(on_wheel[low]), float(on_wheel[high]))

    def _point(self, shift: float, y: float, gap: float) -> ContactPoint:
        depth, slope, second = self.wheel.at(y)
        radius = self.nominal_radius + depth
        sine, cosine = math.sin(self.yaw), math.cos(self.yaw)
        backward = slope * math.tan(self.yaw)  # sine of the angle on the circle
        downward = math.sqrt(max(1.0 - backward * backward, 0.0))
        y_track = y * cosine - radius * backward * sine + shift
        own = self._on_rail(y_track)
        _, rail_slope, rail_second = self.rail.at(own)
        # Slopes agree unless one body has a corner there, which the other's tangent plane then passes.
        wheel_angle = -math.atan(slope)
        of_wheel = -math.atan2(slope, cosine * downward)
        of_rail = self.inclination - math.atan(rail_slope)
        angle = 0.5 * (of_wheel + of_rail)
        turn = -math.asin(max(-1.0, min(1.0, sine / math.cos(wheel_angle))))
        # Tensors of curvature in the tangent plane: a surface of revolution turned against a prism.
        around = math.cos(wheel_angle) / radius
        along_meridian = -second * math.cos(wheel_angle) ** 3
        of_prism = rail_second * math.cos(math.atan(rail_slope)) ** 3
        c, s = math.cos(turn), math.sin(turn)
        xx = around * c * c + along_meridian * s * s
        yy = around * s * s + along_meridian * c * c + of_prism
        xy = (along_meridian - around) * s * c
        mean, half = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
        first, other = (mean + half, mean - half) if xx > yy else (mean - half, mean + half)
        return ContactPoint(
            y_wheel=y,
            y_rail=own,
            y_track=y_track,
            x=-y * sine - radius * backward * cosine,
            angle=angle,
            rolling_radius=radius,
            curvature_x=first,
            curvature_y=other,
            wheel_angle=wheel_angle,
            turn=turn,
            gap=gap,
        )


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """Zero of a function that rises from below to above 0: secants, and halving where they don't get on."""
    f_low, f_high = function(low), function(high)
    if f_low >= 0.0:
        return low
    if f_high <= 0.0:
        return high
    for step in range(_MOST_STEPS):
        width = high - low
        if width <= _POSITION_ERROR:
            break
        middle = high - f_high * width / (f_high - f_low) if step % 3 else 0.5 * (low + high)
        # Close to an end, a step by the least width brackets the zero from the other side.
        middle = min(max(middle, low + 0.25 * _POSITION_ERROR), high - 0.25 * _POSITION_ERROR)
        value = function(middle)
        if value == 0.0:
            return middle
        if value < 0.0:
            low, f_low = middle, value
        else:
            high, f_high = middle, value
    return low if -f_low < f_high else high
