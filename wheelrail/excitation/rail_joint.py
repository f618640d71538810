"""Rail joints: gap, height step and dip (Wu and Thompson 2003; Pieringer 2011, section 2.3).

x runs from the middle of the gap. On both sides the rail dips towards the joint over the length L with the square of
the distance,

    z(x) = -d (1 - |x| / L)^2    for |x| < L,

the rail ahead is higher by the step h, and between them is nothing over the gap. What follows the step may run back to
level; else the rail stays at the new height.
"""

from __future__ import annotations

import numpy as np

__all__ = ["rail_joint"]

_SPACING = 1e-4  # m, near the gap
_WIDE_SPACING = 1e-3  # m, along the dip, whose second derivative 2 d / L^2 is small
_NEAR = 0.1  # m
_GAP_DEPTH = 5e-3  # m; no wheel reaches that far into a gap of less than 0.1 m
_EDGE = 1e-6  # m; a vertical face takes this length


def rail_joint(
    *, gap: float, step: float, dip: float, dip_length: float, step_length: float | None, reach: float = _NEAR
) -> tuple[np.ndarray, np.ndarray]:
    """Heights of the rail around a joint.

    Parameters
    ----------
    gap : float
        Width of the gap, m, >= 0.
    step : float
        Height of the rail ahead above the rail behind, m; negative: lower.
    dip : float
        d, depth of the dip at the joint, m, >= 0.
    dip_length : float
        L on each side, m; no effect without a dip.
    step_length : float or None
        Length over which the rail ahead comes back to level, with the square of the distance, m; None: it does not.
    reach : float
        Length of rail on each side that is given finely, m; half the distance of joints at most.

    Returns
    -------
    positions, heights : ndarray, shape (n,)
        m.
    """
    longest = max(reach, dip_length if dip > 0.0 else 0.0, 0.0 if step_length is None else step_length)
    near = np.arange(0.0, reach, _SPACING)
    far = np.linspace(reach, longest, max(round((longest - reach) / _WIDE_SPACING), 1) + 1)
    edge = 0.5 * max(gap, _EDGE)
    side = np.unique(np.concatenate([[edge], near[near > edge], far[far > edge]]))
    sag = -dip * np.maximum(1.0 - side / dip_length, 0.0) ** 2 if dip > 0.0 else np.zeros_like(side)
    raised = np.full_like(side, step)
    if step_length is not None:
        raised = step * np.maximum(1.0 - side / step_length, 0.0) ** 2
    behind, ahead = sag[::-1], sag + raised
    if gap <= 4.0 * _EDGE:  # faces touch
        return np.concatenate([-side[::-1], side]), np.concatenate([behind, ahead])
    bottom = min(behind[-1], ahead[0]) - _GAP_DEPTH
    inside = np.array([-edge + _EDGE, edge - _EDGE])
    positions = np.concatenate([-side[::-1], inside, side])
    return positions, np.concatenate([behind, [bottom, bottom], ahead])
