"""Interpolation between parallel lines on a surface (numpy only: shipped in the FMU)."""

from __future__ import annotations

import numpy as np

__all__ = ["lateral_weights"]


def lateral_weights(lateral: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Weights of the lines at given positions: linear between them, the outermost beyond.

    Parameters
    ----------
    lateral : ndarray, shape (lines,)
        Positions of the lines, m, increasing.
    y : ndarray, shape (rows,)
        m.

    Returns
    -------
    ndarray, shape (rows, lines)
        Each row sums up to 1.
    """
    y = np.asarray(y, dtype=float)
    weights = np.zeros((len(y), len(lateral)))
    if len(lateral) == 1:
        weights[:, 0] = 1.0
        return weights
    left = np.clip(np.searchsorted(lateral, y, side="right") - 1, 0, len(lateral) - 2)
    share = np.clip((y - lateral[left]) / (lateral[left + 1] - lateral[left]), 0.0, 1.0)
    rows = np.arange(len(y))
    weights[rows, left] = 1.0 - share
    weights[rows, left + 1] = share
    return weights
