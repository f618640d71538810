"""Checks that measured points are one curve: enough of them, in order, without holes and without running back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError
from .orientation import resampled

__all__ = ["checked_curve"]

_FEWEST_POINTS = 20
_SAME_POINT = 1e-7  # m
_LARGEST_GAP = 15e-3  # m
_NOTED_GAP = 3e-3  # m, if also this many times the median step:
_NOTED_RATIO = 5.0
_LONGEST = 1.0  # m, arc length
_STEP = 0.5e-3  # m
_APART = 5e-3  # m, along the curve: parts farther apart than this must not meet
_SHARPEST_TURN = -0.2  # cosine of the angle between successive steps; edges of rims have 0
_LARGEST_SCATTER = 2e-3  # m, step back


def checked_curve(path: Path, points: NDArray, lines: NDArray) -> tuple[NDArray, list[str]]:
    """Check points along a profile and drop repeated ones.

    The lateral coordinate may run back, as on the face of a flange or under the head of a rail. Scatter that steps
    back by 2 mm at most stays, with a note.

    Parameters
    ----------
    path : Path
        For messages.
    points : ndarray, shape (n, 2)
        Lateral and vertical coordinate, m, within 10 m of the origin.
    lines : ndarray of int, shape (n,)
        Lines of the file.

    Returns
    -------
    points : ndarray, shape (m, 2)
    notes : list of str

    Raises
    ------
    DataFileError
        Fewer than 20 different points, a gap above 15 mm, points out of order, outliers, a curve that meets itself.
    """
    notes = []
    if len(points):
        steps = np.hypot(*np.diff(points, axis=0).T)
        different = np.concatenate([[True], steps > _SAME_POINT])
        repeated = len(points) - int(np.sum(different))
        points, lines = points[different], lines[different]
        if repeated:
            notes.append(f"repeated points left out: {repeated}")
    if len(points) < _FEWEST_POINTS:
        raise DataFileError(f"{path}: {len(points)} different points; a profile needs at least {_FEWEST_POINTS}")
    steps = np.hypot(*np.diff(points, axis=0).T)
    if float(np.max(steps)) > _LARGEST_GAP:
        row = int(np.argmax(steps > _LARGEST_GAP))
        raise DataFileError(
            f"{path}, line {lines[row + 1]}: {steps[row] * 1e3:.4g} mm from the point before; a gap of "
            f"{_LARGEST_GAP * 1e3:g} mm at most is allowed, and the points must be in order along the profile"
        )
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    if arc[-1] > _LONGEST:
        raise DataFileError(
            f"{path}: the points make a curve {arc[-1]:.3g} m long; at most {_LONGEST:g} m is allowed. Are they in "
            "order along the profile?"
        )
    gaps = steps > max(_NOTED_GAP, _NOTED_RATIO * float(np.median(steps)))
    if np.any(gaps):
        notes.append(f"gaps between points: {int(np.sum(gaps))}, up to {float(np.max(steps)) * 1e3:.3g} mm")
    notes += _scatter_note(path, points, lines, steps)
    _refuse_meeting(path, points, lines, arc)
    return points, notes


def _refuse_meeting(path: Path, points: NDArray, lines: NDArray, arc: NDArray) -> None:
    """Refuse a curve that crosses itself or runs back along itself."""
    even = resampled(points[:, 0], points[:, 1], step=_STEP)
    # If two stretches cross, the sample nearest to the crossing on each is within half a step of it.
    spacing = float(arc[-1]) / (len(even) - 1)
    lag = int(_APART / spacing) + 1
    y, z = even.T
    near = np.triu((y[:, None] - y) ** 2 + (z[:, None] - z) ** 2 <= spacing**2, lag)
    if np.any(near):
        pair = np.unravel_index(np.argmax(near), near.shape)
        there, here = (int(lines[np.searchsorted(arc, index * spacing * (1.0 - 1e-9))]) for index in pair)
        raise DataFileError(
            f"{path}, line {here}: the profile comes back to where it was at line {there}; the points must follow the "
            "profile once, from one end to the other, without outliers"
        )


def _scatter_note(path: Path, points: NDArray, lines: NDArray, steps: NDArray) -> list[str]:
    """Refuse points far off the curve of their neighbours; tell of smaller scatter."""
    directions = np.diff(points, axis=0) / steps[:, None]
    sharp = np.sum(directions[1:] * directions[:-1], axis=1) < _SHARPEST_TURN
    if not np.any(sharp):
        return []
    reach = np.where(sharp, np.minimum(steps[1:], steps[:-1]), 0.0)
    worst = int(np.argmax(reach))
    if reach[worst] > _LARGEST_SCATTER:
        raise DataFileError(
            f"{path}, line {lines[worst + 1]}: the profile turns back after {reach[worst] * 1e3:.3g} mm; at most "
            f"{_LARGEST_SCATTER * 1e3:g} mm is taken as scatter. Is this an outlier, or are the points out of order?"
        )
    return [f"steps back along the profile: {int(np.sum(sharp))}, up to {reach[worst] * 1e3:.2g} mm; kept as scatter"]
