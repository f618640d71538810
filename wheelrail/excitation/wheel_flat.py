"""Wheel flats (Pieringer 2011, sections 2.3 and 5.2; Newton and Clark 1979).

s runs along the tread from the middle of the flat, f is the missing depth:

    newly formed, a chord with sharp edges    f = (l^2 / 4 - s^2) / (2 R),          depth d = l^2 / (8 R)
    rounded by wear                           f = d / 2 [1 + cos(2 pi s / l)],      depth d, length l free

(eq. 2.6 counts s from the edge, and ties a rounded flat's depth to its length by d = l^2 / (16 R)). The chord is, like
the wheel itself in the contact, a parabola in place of a circle.
"""

from __future__ import annotations

import math

import numpy as np

from wheelrail.errors import ParameterError

__all__ = ["chord_flat", "rounded_flat"]

_SPACING = 1e-4  # m, of the table; a parabola of radius R between its points is off by spacing^2 / 8R = 3 nm
_AGREEMENT = 0.02  # between a given depth and that of the chord


def chord_flat(*, depth: float | None, length: float | None, radius: float) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Shape a newly formed flat.

    Parameters
    ----------
    depth, length : float or None
        m; one of them, or both if they agree.
    radius : float
        R of the wheel, m.

    Returns
    -------
    positions, heights : ndarray, shape (n,)
        m; heights are -f.
    notes : list of str

    Raises
    ------
    ParameterError
        If depth and length don't belong together, or none is given.
    """
    if length is None:
        if depth is None:
            raise ParameterError("depth", depth, "a new flat needs its depth or its length")
        length = math.sqrt(8.0 * radius * depth)
    chord = length**2 / (8.0 * radius)
    if depth is not None and abs(depth - chord) > _AGREEMENT * chord:
        raise ParameterError(
            "depth",
            depth,
            f"a new flat is a chord of the wheel: {1e3 * length:.4g} mm are {1e3 * chord:.4g} mm deep at a radius of "
            f"{radius:g} m, and {1e3 * depth:.4g} mm are {1e3 * math.sqrt(8.0 * radius * depth):.4g} mm long; give one "
            'of them, or shape = "rounded"',
        )
    s = _table(length)
    notes = [f"new wheel flat: {1e3 * length:.4g} mm long, {1e3 * chord:.4g} mm deep"]
    return s, -(0.25 * length**2 - s**2) / (2.0 * radius), notes


def rounded_flat(*, depth: float, length: float, radius: float) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Shape a rounded flat; parameters and result as of `chord_flat`, both depth and length given."""
    s = _table(length)
    heights = -0.5 * depth * (1.0 + np.cos(2.0 * np.pi * s / length))
    heights[[0, -1]] = 0.0
    # At its middle the flat's curvature comes off that of the wheel.
    curvature = 1.0 / radius - 2.0 * np.pi**2 * depth / length**2
    notes = [f"rounded wheel flat: {1e3 * length:.4g} mm long, {1e3 * depth:.4g} mm deep"]
    if curvature < 0.0:
        notes.append(
            f"rounded wheel flat: it is hollow in the middle (curvature {curvature:.3g} 1/m): there the wheel touches "
            "at two places"
        )
    return s, heights, notes


def _table(length: float) -> np.ndarray:
    """Positions over a flat, symmetric, edges included, m."""
    half = max(math.ceil(0.5 * length / _SPACING), 8)
    return 0.5 * length * np.arange(-half, half + 1) / half
