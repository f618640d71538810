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
    reach = math.sqrt(2.0 * radius * float(np.ptp(heights)))
    spacing = max(float(np.diff(positions).min()), 2e-5)
    extra = math.ceil(reach / spacing) + 1
    first, last = positions[0] - extra * spacing, positions[-1] + extra * spacing
    fine = np.linspace(first, last, math.ceil((last - first) / spacing) + 1)
    fine = np.union1d(fine, positions)
    shape = np.interp(fine, positions, heights)
    path = np.empty_like(fine)
    for k, x in enumerate(fine):
        low, high = np.searchsorted(fine, (x - reach * 1.01, x + reach * 1.01))
        near = slice(low, max(high, low + 1))
        path[k] = float(np.max(shape[near] - (fine[near] - x) ** 2 / (2.0 * radius)))
    return fine, path
