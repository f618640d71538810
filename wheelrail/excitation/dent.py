"""Dents and squats: a bounded hollow in rail or wheel.

With r the distance from the middle as a share of the half length along and the half width across, the depth is that of
a raised cosine, d / 2 [1 + cos(pi r)] for r < 1: level and smooth at the rim. A squat's two lobes are two dents.
"""

from __future__ import annotations

import numpy as np

__all__ = ["dent"]

_SPACING = 1e-4  # m, along
_LINES = 41  # across


def dent(*, depth: float, length: float, width: float | None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Heights of a dent.

    Parameters
    ----------
    depth : float
        d, m; negative: a bump.
    length : float
        Along, m.
    width : float or None
        Across, m; None: the same all across.

    Returns
    -------
    positions : ndarray, shape (n,)
        From the middle, m.
    heights : ndarray, shape (lines, n)
        m.
    offsets : ndarray, shape (lines,)
        Positions of the lines from the middle, m.
    """
    half = max(round(0.5 * length / _SPACING), 20)
    share = np.arange(-half, half + 1) / half
    across = np.zeros(1) if width is None else np.linspace(-1.0, 1.0, _LINES)
    r = np.minimum(np.hypot(share, across[:, None]), 1.0)
    heights = -0.5 * depth * (1.0 + np.cos(np.pi * r))
    heights[r >= 1.0] = 0.0
    return 0.5 * length * share, heights, across * (0.0 if width is None else 0.5 * width)
