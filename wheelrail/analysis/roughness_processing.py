"""What a wheel feels of a measured roughness record (EN 15610:2009, 7.2 and 7.3).

Dust on the rail makes narrow spikes, which are taken out. The tip of a probe reaches into pits that a wheel rolls over,
so the record is replaced by the path of a wheel of 0.375 m radius. All figures are those of the standard; what it
leaves open is said where it is decided. Joints, welds and damage must have been cut out before (7.1): nothing here
finds them.
"""

from __future__ import annotations

import numpy as np

__all__ = ["WHEEL_RADIUS", "remove_spikes", "rolling_envelope"]

WHEEL_RADIUS = 0.375
"""Radius of the wheel that rolls over the record, m (7.3)."""

_SPIKE_CURVATURE = -10.0  # 1/m: -1e7 um/m^2 (7.2 c)
_EDGE_SLOPE = 5e-3  # 5e3 um/m (7.2 d)
_SPIKE_LENGTH = 3.0  # m, a of h > w^2 / a (7.2); 8 radii, so that h is the sagitta of the wheel over the width w


def remove_spikes(heights: np.ndarray, *, spacing: float) -> tuple[np.ndarray, int]:
    """Replace narrow upward spikes by straight lines (EN 15610:2009, 7.2).

    A spike is a crest (the slope changes its sign) with a second derivative below -10 1/m. It reaches on either side to
    the first point with a slope below 0.005, or to the end of the record. It is taken out if its height is above
    w^2 / 3 m with its width w: sharper than a wheel. This is repeated until no more is found.

    The standard does not say from where the height counts; here it is above the straight line that replaces the spike.
    Slopes at the feet are central differences; a crest is a point higher than its neighbours.

    Parameters
    ----------
    heights : ndarray, shape (n,)
        Equidistant, positive outward from the material, m.
    spacing : float
        m.

    Returns
    -------
    heights : ndarray, shape (n,)
        Copy without spikes, m.
    count : int
        How many were removed.
    """
    result = np.array(heights, dtype=float)
    count, found = 0, True
    while found:
        found = False
        for crest in _crests(result, spacing):
            # An earlier removal may have changed the neighbourhood.
            if not len(_crests(result[crest - 1 : crest + 2], spacing)):
                continue
            first, last = _foot(result, int(crest), spacing)
            chord = np.interp(np.arange(first, last + 1), [first, last], result[[first, last]])
            width = (last - first) * spacing
            if result[crest] - chord[crest - first] > width**2 / _SPIKE_LENGTH:
                result[first : last + 1] = chord
                count += 1
                found = True
    return result, count


def _crests(heights: np.ndarray, spacing: float) -> np.ndarray:
    """Points that are higher than the one before, no lower than the one after, and sharply bent."""
    steps = np.diff(heights)
    bent = np.diff(steps) < _SPIKE_CURVATURE * spacing**2
    return 1 + np.flatnonzero(bent & (steps[:-1] > 0.0) & (steps[1:] <= 0.0))


def _foot(heights: np.ndarray, crest: int, spacing: float) -> tuple[int, int]:
    """First and last point of a spike: the slope has died out, or the record ends."""
    end = len(heights) - 1
    first, last = crest - 1, crest + 1
    while first > 0 and abs(heights[first + 1] - heights[first - 1]) >= 2.0 * spacing * _EDGE_SLOPE:
        first -= 1
    while last < end and abs(heights[last + 1] - heights[last - 1]) >= 2.0 * spacing * _EDGE_SLOPE:
        last += 1
    return first, last


def rolling_envelope(
    heights: np.ndarray, *, spacing: float, radius: float = WHEEL_RADIUS, periodic: bool = False
) -> np.ndarray:
    """Path of a rigid wheel over the record, by its lowest point (EN 15610:2009, 7.3).

        r'(x) = max over s of r(x + s) - (R - sqrt(R^2 - s^2))

    Pits narrower than the wheel are bridged, and crests stay as they are; on a flank the wheel touches ahead of its
    lowest point, which is above the record there. The heights of a wheel are treated in the same way, with its own
    radius: on a straight rail it is the same curve that separates the two.

    Parameters
    ----------
    heights : ndarray, shape (n,)
        Equidistant, positive outward from the material, m.
    spacing : float
        m.
    radius : float
        R, m.
    periodic : bool
        The record repeats; else nothing is beyond its ends.

    Returns
    -------
    ndarray, shape (n,)
        At no point lower than before, m.
    """
    heights = np.asarray(heights, dtype=float)
    # Farther away the wheel has risen by more than all that the record spans.
    span = min(float(np.ptp(heights)), radius)
    reach = min(int(np.sqrt(span * (2.0 * radius - span)) / spacing), len(heights) - 1)
    envelope = heights.copy()
    for step in range(1, reach + 1):
        rise = radius - np.sqrt(max(radius**2 - (step * spacing) ** 2, 0.0))
        if periodic:
            both = np.maximum(np.roll(heights, step), np.roll(heights, -step))
            np.maximum(envelope, both - rise, out=envelope)
        else:
            np.maximum(envelope[step:], heights[:-step] - rise, out=envelope[step:])
            np.maximum(envelope[:-step], heights[step:] - rise, out=envelope[:-step])
    return envelope
