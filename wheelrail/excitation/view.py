"""How a contact model looks at a wheel flat, a rail joint or a dent.

These change the profile over centimetres, so the wheel's curvature has to meet them as it is. Three kinds of models:

* With the wheel's own radius R (half-space): as they are.
* Bedding under a wheel of reduced radius R' (Pieringer 2011, section 3.4.1): with the shape as it is, either its depth
  or its length would be wrong (section 5.2). Here distances from the nominal contact point are stretched by
  sqrt(R / R') before the shape is looked up, so that x'^2 / 2R' at the bedding's x' is x^2 / 2R at the real x:
  the path of a rigid wheel, with depth and length, is then exactly that of the real wheel, and every curvature has
  the same ratio to that of the wheel.
* A point (Hertz spring): it can only follow the path of a rigid wheel,
  e(X) = min over x of x^2 / 2R - r(X + x) (Wu and Thompson 2002), which is computed beforehand.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

__all__ = ["ContactView", "rigid_path"]

_FINE = 1e-4  # m; touching between two of these points costs at most their distance squared over 8 R, 3 nm
_GENTLE = 0.02  # curvature over that of the wheel, up to which a shape is nearly straight under the contact


class ContactView(NamedTuple):
    """What a contact model makes of large shapes.

    Attributes
    ----------
    radius : float
        Of the wheel, m.
    stretch : float
        sqrt(R / R').
    trajectory : bool
        The model looks at one point, and follows the path of a rigid wheel.
    """

    radius: float
    stretch: float
    trajectory: bool


def rigid_path(positions: np.ndarray, heights: np.ndarray, *, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Height that a rigid wheel rides at over a shape.

    Parameters
    ----------
    positions : ndarray, shape (n,)
        m, increasing.
    heights : ndarray, shape (n,)
        Positive outward, m; linear in between, constant beyond.
    radius : float
        R, m.

    Returns
    -------
    positions : ndarray, shape (m,)
        Of the path, m: those of the shape and the reach of the wheel before and behind.
    path : ndarray, shape (m,)
        max over x of r(X + x) - x^2 / 2R, m.
    """
    reach = 1.01 * math.sqrt(2.0 * radius * float(np.ptp(heights)))
    first, last = positions[0] - reach, positions[-1] + reach
    middle = 0.5 * (positions[1:] + positions[:-1])
    slope = np.diff(heights) / np.diff(positions)
    bends = np.abs(np.diff(slope)) > _GENTLE / radius * np.diff(middle)
    sharp = np.concatenate([positions[1:-1][bends], positions[[0, -1]]])
    fine = np.arange(math.floor(first / _FINE), math.ceil(last / _FINE) + 1) * _FINE
    near = _within(fine, np.sort(sharp), reach)
    at = np.union1d(fine[near], positions)
    close = _within(at, np.sort(sharp), reach)
    shape = np.interp(at, positions, heights)
    # Where the shape bends gently the wheel touches beside the lowest point by R r', and rides R r'^2 / 2 higher.
    path = shape + 0.5 * radius * np.interp(at, middle, slope, left=0.0, right=0.0) ** 2
    for k in np.flatnonzero(close):
        low, high = np.searchsorted(at, (at[k] - reach, at[k] + reach))
        touching = slice(low, max(high, low + 1))
        path[k] = float(np.max(shape[touching] - (at[touching] - at[k]) ** 2 / (2.0 * radius)))
    return at, path


def _within(at: np.ndarray, places: np.ndarray, reach: float) -> np.ndarray:
    """Whether positions lie within ``reach`` of any of the places, which increase."""
    after = np.clip(np.searchsorted(places, at), 1, len(places) - 1)
    return np.minimum(np.abs(at - places[after - 1]), np.abs(at - places[after])) <= reach
