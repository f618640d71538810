"""Unit and direction of a measured profile, told from its shape.

Frame of the package: y to the field side, z down. A wheel has its flange at negative y, and the flange reaches to
larger z (a larger radius); the head of a rail is convex upward, so that its top has the smallest z.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError, ParameterError

__all__ = ["check_kind", "directions", "is_plausible_width", "orient", "resampled", "unit_by_size"]

_NARROWEST, _WIDEST = 20e-3, 200e-3  # m

# Wheel: lateral distance from the tip of the flange to a stretch that is tread on every main-line wheel (the tape
# circle of EN 13715 lies 55 mm from the tip), and what makes it a tread.
_TREAD = (40e-3, 80e-3)  # m
_SHORTEST_TREAD = 20e-3  # m
_STEEPEST_TREAD = 0.2
_ROUGHEST_TREAD = 1.5e-3  # m, rms about a straight line: worn treads are hollow
_FLANGE_HEIGHTS = (15e-3, 45e-3)  # m; EN 13715: 28 mm to 32 mm, worn up to 36 mm
_DEEPEST_DIP = 3e-3  # m, below the tread, between tip and tread
_BACK = 5e-3  # m: beyond the tip by this much, laterally, lies the back of the flange,
_LEAST_RETURN = 2e-3  # m, which falls behind the tip by more than this
_CLEAR_RATIO = 1.3  # of two possible flange heights

# Rail.
_LEAST_SAGITTA = 1e-3  # m
_LARGEST_HOLLOW = 0.25  # of the sagitta: undercut of the head
_SMALLEST_OPENING = 0.5  # distance of the ends, of the width

_STEP = 0.5e-3  # m


def check_kind(kind: str) -> None:
    """Raise `ParameterError` unless the kind is "wheel" or "rail"."""
    if kind not in ("wheel", "rail"):
        raise ParameterError("kind", kind, 'allowed: "wheel" or "rail"')


def is_plausible_width(width: float) -> bool:
    """Whether a profile may be so wide, m: 20 mm to 200 mm."""
    return _NARROWEST <= width <= _WIDEST


def unit_by_size(y: NDArray) -> tuple[float, str]:
    """Tell the unit of lateral coordinates: a profile is 20 mm to 200 mm wide.

    Parameters
    ----------
    y : ndarray, shape (n,)
        Lateral coordinate in mm or m.

    Returns
    -------
    unit : float
        Length of the unit, m.
    name : {"mm", "m"}

    Raises
    ------
    DataFileError
        If neither unit gives a plausible width.
    """
    width = float(np.max(y)) - float(np.min(y))
    for unit, name in ((1e-3, "mm"), (1.0, "m")):
        if is_plausible_width(width * unit):
            return unit, name
    raise DataFileError(
        f"the profile is {width:g} units wide, which is plausible neither in mm nor in m (20 mm to 200 mm); if the "
        "unit is another one, name it in the header"
    )


def orient(y: NDArray, z: NDArray, *, kind: str) -> tuple[NDArray, NDArray, tuple[str, ...]]:
    """Turn a profile into the frame of the package.

    Which side of a rail is the gauge side can't be told from its shape: y of a rail keeps its direction.

    Parameters
    ----------
    y, z : ndarray, shape (n,)
        Lateral and vertical coordinate along the profile, m or mm, either sign.
    kind : {"wheel", "rail"}

    Returns
    -------
    y, z : ndarray, shape (n,)
        y to the field side, z down, m; from the end at smaller y to the end at larger y.
    notes : tuple of str
        What was changed.

    Raises
    ------
    DataFileError
        If the shape doesn't tell the direction, or isn't that of a wheel or rail.
    ParameterError
        Another kind.
    """
    check_kind(kind)
    y, z = np.asarray(y, dtype=float), np.asarray(z, dtype=float)
    unit, name = unit_by_size(y)
    notes = [f"taken as {name}, by the width"] if unit != 1.0 else []
    y, z = unit * y, unit * z
    side, down = directions(y, z, kind=kind)
    if down < 0.0:
        z = -z
        notes.append("turned upside down: z counted upward")
    if side < 0.0:
        y = -y
        notes.append("mirrored: the flange lay at positive y")
    if y[0] > y[-1]:
        y, z = y[::-1].copy(), z[::-1].copy()
        notes.append("order of the points reversed")
    return y, z, tuple(notes)


def directions(y: NDArray, z: NDArray, *, kind: str) -> tuple[float, float]:
    """Signs that turn a profile into the frame of the package.

    Parameters
    ----------
    y, z : ndarray, shape (n,)
        As for `orient`, but in m.
    kind : {"wheel", "rail"}

    Returns
    -------
    side : float
        1.0, or -1.0 if y must change its sign; always 1.0 for a rail.
    down : float
        1.0, or -1.0 if z must change its sign.

    Raises
    ------
    DataFileError
        As for `orient`.
    """
    points = resampled(y, z, step=_STEP)
    return _wheel_signs(*points.T) if kind == "wheel" else (1.0, _rail_sign(*points.T))


def resampled(y: NDArray, z: NDArray, *, step: float) -> NDArray:
    """Points at equal distances of at least `step` (or both ends alone) along a polyline, shape (m, 2)."""
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(y), np.diff(z)))])
    positions = np.linspace(0.0, arc[-1], max(int(arc[-1] / step), 1) + 1)
    return np.column_stack([np.interp(positions, arc, y), np.interp(positions, arc, z)])


def _wheel_signs(y: NDArray, z: NDArray) -> tuple[float, float]:
    found = []
    for side in (1.0, -1.0):
        for down in (1.0, -1.0):
            flange = _flange(side * y, down * z)
            if flange is not None:
                found.append((*flange, side, down))
    # A wheel measured round the rim, stood on its head, can pass for a flange without a back.
    found.sort(reverse=True)
    if not found:
        raise DataFileError(
            "no flange and tread of a wheel are found; the points must run from the tip of the flange over at least "
            "60 mm towards the field side"
        )
    clear = len(found) == 1 or found[0][0] > found[1][0] or found[0][1] > _CLEAR_RATIO * found[1][1]
    if not clear:
        raise DataFileError(
            "the flange can't be told from the outer rim; cut the points beyond the chamfer, or include the back of "
            "the flange"
        )
    return found[0][2], found[0][3]


def _flange(y: NDArray, z: NDArray) -> tuple[bool, float] | None:
    """Whether the flange has a back and its height above the tread; None: these directions show no flange."""
    tip = int(np.argmax(z))
    distance = y - y[tip]
    tread = (distance >= _TREAD[0]) & (distance <= _TREAD[1])
    if not np.any(tread) or np.ptp(y[tread]) < _SHORTEST_TREAD:
        return None
    line = np.polyfit(distance[tread], z[tread], 1)
    residual = z[tread] - np.polyval(line, distance[tread])
    level = float(np.mean(z[tread]))
    height = float(z[tip]) - level
    between = (distance >= 0.0) & (distance < _TREAD[0])
    if (
        abs(line[0]) > _STEEPEST_TREAD
        or float(np.sqrt(np.mean(residual**2))) > _ROUGHEST_TREAD
        or not _FLANGE_HEIGHTS[0] <= height <= _FLANGE_HEIGHTS[1]
        or float(np.min(z[between])) < level - _DEEPEST_DIP
    ):
        return None
    back = z[distance <= -_BACK]
    return bool(back.size) and float(z[tip] - np.min(back)) >= _LEAST_RETURN, height


def _rail_sign(y: NDArray, z: NDArray) -> float:
    """1.0 if the head is convex towards negative z, -1.0 if the other way."""
    if y[0] > y[-1]:
        y, z = y[::-1], z[::-1]
    chord = np.array([y[-1] - y[0], z[-1] - z[0]])
    length = float(np.hypot(*chord))
    if length < _SMALLEST_OPENING * np.ptp(y):
        raise DataFileError("the points run round the rail; cut them to the head, from the gauge to the field side")
    above = ((z - z[0]) * chord[0] - (y - y[0]) * chord[1]) / length
    upward, downward = -float(np.min(above)), float(np.max(above))
    if max(upward, downward) < _LEAST_SAGITTA:
        raise DataFileError("the points lie on a straight line; which side of the rail is up can't be told")
    if min(upward, downward) > _LARGEST_HOLLOW * max(upward, downward):
        raise DataFileError("the shape isn't that of a rail head, which is convex upward")
    return 1.0 if upward > downward else -1.0
