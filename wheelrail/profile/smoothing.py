"""A smooth curve through the points of a measured profile.

Both coordinates are smoothed over the way along the profile, so that a steep flank is treated as the tread is. A
smoothing spline with the penalty 1 / k_c^4 on the second derivative lets waves of the number k pass with
1 / (1 + (k / k_c)^4) (Reinsch 1967): half of the cut-off, nearly all of what is twice as long.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline, CubicSpline, make_smoothing_spline

from ..errors import DataFileError, ParameterError
from .curve import ProfileCurve
from .orientation import orient

__all__ = ["profile_from_points"]

_MM = 1e-3
_FEWEST_POINTS = 20
_PASSES = 3
_SAME_PLACE = 1e-4  # mm, along the profile
_LONGEST_STEP = 0.25  # mm, between knots
_STEEPEST = 20.0  # slope at which a profile is cut, as that of a new rail's side
_SHORTEST = 15.0  # mm, of the stretch that is left
_FLANGE_TIP = (-70.0, -40.0)  # mm from the tape circle: EN 13715 has it at -55 mm
_FLANGE_BACK = -70.0  # mm (EN 13715)
_BACK_DEPTH = 5.0  # mm below the tip: deep enough for a back that stands upright
_HEAD_DEPTH = 14.0  # mm below the top, where a rail's head is as wide as its sides
_LEAST_HEAD_DEPTH = 5.0  # mm
_OFF_MIDDLE = 5.0  # mm, by which a worn head may lie beside its axis
_TOP_OFF_AXIS = 20.0  # mm


def profile_from_points(
    y: ArrayLike, z: ArrayLike, *, kind: str, name: str, cutoff_wavelength: float = 5e-3
) -> tuple[ProfileCurve, list[str]]:
    """Smooth the points of a measured profile and bring them into the frame of the package.

    Parts that are steeper than 20:1 are cut: the back of a flange, the sides of a rail.

    The origin of a wheel's profile is its tape circle: that of the points if their flange lies where it must, else
    70 mm from the back of the flange. That of a rail is its axis: the origin of the points if it is within 5 mm of the
    middle of the head, else that middle.

    Parameters
    ----------
    y, z : array_like, shape (n,)
        Lateral and vertical position along the profile, m (mm are recognised). Upside-down and, for wheels, mirrored
        points are recognised.
    kind : {"wheel", "rail"}
    name : str
        For messages.
    cutoff_wavelength : float
        Of the smoothing, m; 1 mm to 50 mm.

    Returns
    -------
    curve : ProfileCurve
    notes : list of str
        What was assumed and done.

    Raises
    ------
    DataFileError
        If the points aren't those of a profile, or don't tell where they belong.
    ParameterError
        Another kind, or a cut-off out of range.
    """
    if not 1e-3 <= cutoff_wavelength <= 50e-3:
        raise ParameterError("cutoff_wavelength", cutoff_wavelength, "allowed: from 0.001 to 0.05 m")
    y, z = np.asarray(y, dtype=float), np.asarray(z, dtype=float)
    if y.ndim != 1 or y.shape != z.shape or len(y) < _FEWEST_POINTS:
        raise DataFileError(f"{name}: a profile needs at least {_FEWEST_POINTS} points, each with y and z")
    if not (np.all(np.isfinite(y)) and np.all(np.isfinite(z))):
        raise DataFileError(f"{name}: a point of the profile isn't finite")
    try:
        y, z, turned = orient(y, z, kind=kind)
    except DataFileError as error:
        raise DataFileError(f"{name}: {error}") from None
    notes = [f"{name}: {note}" for note in turned]
    across, down, length, note = _smoothed(y / _MM, z / _MM, cutoff_wavelength / _MM, name)
    notes.append(note)
    step = min(_LONGEST_STEP, 0.1 * cutoff_wavelength / _MM)
    way = np.linspace(0.0, length, max(math.ceil(length / step), 8) + 1)
    points = np.array([across(way), down(way)])
    first, last = _gentle(points, kind, name)
    place = _wheel_origin if kind == "wheel" else _rail_origin
    origin = place(points, first, last, name, notes)
    kept_y, kept_z = points[:, first : last + 1]
    curve = CubicSpline(kept_y - origin, kept_z)
    # Powers of mm become powers of m.
    coefficients = curve.c[::-1].T * _MM ** (1.0 - np.arange(4))
    coefficients[:, 0] -= _MM * float(curve(0.0))
    notes.append(
        f"{name}: used from {kept_y[0] - origin:.2f} to {kept_y[-1] - origin:.2f} mm of the "
        f"{'tape circle' if kind == 'wheel' else 'axis'}"
    )
    return ProfileCurve.from_polynomials(name, _MM * curve.x, coefficients), notes


def _smoothed(y: NDArray, z: NDArray, cutoff: float, name: str) -> tuple[BSpline, BSpline, float, str]:
    """Both coordinates over the way along the profile, its length, and a note; mm."""
    penalty = (cutoff / (2.0 * np.pi)) ** 4
    # Scatter lengthens the way from point to point: it is measured again along what has been smoothed.
    along_y, along_z = y, z
    for _ in range(_PASSES):
        way = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(along_y), np.diff(along_z)))))
        apart = np.concatenate(([True], np.diff(way) > _SAME_PLACE))
        y, z, way = y[apart], z[apart], way[apart]
        if len(way) < _FEWEST_POINTS:
            raise DataFileError(f"{name}: {len(way)} different points; a profile needs at least {_FEWEST_POINTS}")
        across, down = (make_smoothing_spline(way, values, w=np.gradient(way), lam=penalty) for values in (y, z))
        along_y, along_z = across(way), down(way)
    slope_y, slope_z = across.derivative()(way), down.derivative()(way)
    off = ((z - along_z) * slope_y - (y - along_y) * slope_z) / np.hypot(slope_y, slope_z)
    note = (
        f"{name}: smoothed with a cut-off wavelength of {cutoff:g} mm, which takes out "
        f"{1e3 * np.sqrt(np.mean(off**2)):.3g} um rms and {1e3 * np.max(np.abs(off)):.3g} um at most"
    )
    return across, down, float(way[-1]), note


def _gentle(points: NDArray, kind: str, name: str) -> tuple[int, int]:
    """Return the ends of the stretch around the flange's tip, or the top, in which no part is steep; indices."""
    run, fall = np.diff(points)
    steep = run * _STEEPEST <= np.abs(fall)
    # The tip of a flange and the top of a rail are level, and the tread follows the flange.
    middle = min(int(np.argmax(points[1]) if kind == "wheel" else np.argmin(points[1])), len(steep) - 1)
    before, after = np.flatnonzero(steep[:middle]), np.flatnonzero(steep[middle:])
    first = int(before[-1]) + 1 if len(before) else 0
    last = middle + int(after[0]) if len(after) else len(steep)
    if points[0, last] - points[0, first] < _SHORTEST:
        raise DataFileError(
            f"{name}: the profile is cut where it is steeper than {_STEEPEST:g}:1, and only "
            f"{points[0, last] - points[0, first]:.3g} mm are left; it needs {_SHORTEST:g} mm"
        )
    return first, last


def _wheel_origin(points: NDArray, first: int, last: int, name: str, notes: list[str]) -> float:
    """Lateral position of the tape circle, mm."""
    y, z = points
    tip = int(np.argmax(z))
    origin = 0.0
    if not _FLANGE_TIP[0] <= y[tip] <= _FLANGE_TIP[1]:
        back = points[:, : tip + 1]
        if float(z[tip] - back[1, 0]) < _BACK_DEPTH:
            raise DataFileError(
                f"{name}: the tip of the flange lies at y = {y[tip]:.4g} mm, but must be {-_FLANGE_TIP[1]:g} to "
                f"{-_FLANGE_TIP[0]:g} mm beside the tape circle at y = 0, and the back of the flange isn't measured; "
                "shift y so that it counts from the tape circle"
            )
        origin = float(np.min(back[0])) - _FLANGE_BACK
        notes.append(
            f"{name}: the tape circle is taken {-_FLANGE_BACK:g} mm from the back of the flange, at y = "
            f"{origin:.3f} mm of the points"
        )
    if not y[first] <= origin <= y[last]:
        raise DataFileError(
            f"{name}: the tape circle lies beside the points; they must reach from the flange beyond it"
        )
    return origin


def _rail_origin(points: NDArray, first: int, last: int, name: str, notes: list[str]) -> float:
    """Lateral position of the rail's axis, mm."""
    y, z = points[:, first : last + 1]
    top = int(np.argmin(z))
    depth = min(_HEAD_DEPTH, float(z[0] - z[top]), float(z[-1] - z[top]))
    if depth < _LEAST_HEAD_DEPTH:
        if not (y[0] < 0.0 < y[-1] and abs(y[top]) <= _TOP_OFF_AXIS):
            raise DataFileError(
                f"{name}: one side of the rail's head is measured {depth:.3g} mm deep only, so that its middle can't "
                f"be told ({_LEAST_HEAD_DEPTH:g} mm are needed); shift y so that it counts from the rail's axis"
            )
        notes.append(f"{name}: only one side of the head is measured: y = 0 is taken for the rail's axis")
        return 0.0
    level = float(z[top]) + depth
    gauge_side = float(np.interp(-level, -z[: top + 1], y[: top + 1]))
    middle = 0.5 * (gauge_side + float(np.interp(level, z[top:], y[top:])))
    if abs(middle) <= _OFF_MIDDLE:
        return 0.0
    notes.append(f"{name}: the rail's axis is taken in the middle of its head, at y = {middle:.3f} mm of the points")
    return middle
