"""Band-limited resampling of a measured line onto the grid.

One windowed-sinc kernel low-passes and interpolates at once (Smith and Gossett 1984): its stop band begins at the
Nyquist wavenumber of the coarser of file and grid, so neither short waves of a fine file fold back nor images of a
coarse file appear. The Blackman window keeps both below -74 dB; waves of at least 2.5 coarser spacings pass unchanged.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

__all__ = ["is_equidistant", "resample"]

_LOBES = 32  # half-length of the kernel, in coarser spacings
_HALF_TRANSITION = 2.75 / (2 * _LOBES)  # Blackman: transition width 5.5 / length
_UNIFORM_TOLERANCE = 1e-3  # of a spacing
_OVERSAMPLING = 4  # fine grid for points that are not equidistant
_CHUNK = 2_000_000  # kernel values held at once


def is_equidistant(x: np.ndarray) -> bool:
    """Whether positions lie within a thousandth of a spacing of an equidistant grid."""
    spacing = (x[-1] - x[0]) / (x.shape[0] - 1)
    return bool(np.max(np.abs(x - x[0] - spacing * np.arange(x.shape[0]))) <= _UNIFORM_TOLERANCE * spacing)


def _extend_odd(x: np.ndarray, r: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
    # Point reflection about the ends keeps value and slope; repeated for lines shorter than the kernel.
    low, high = x[0] - reach, x[-1] + reach
    while x[0] > low:
        x = np.concatenate((2.0 * x[0] - x[:0:-1], x))
        r = np.concatenate((2.0 * r[0] - r[:0:-1], r))
    while x[-1] < high:
        x = np.concatenate((x, 2.0 * x[-1] - x[-2::-1]))
        r = np.concatenate((r, 2.0 * r[-1] - r[-2::-1]))
    keep = slice(max(int(np.searchsorted(x, low)) - 1, 0), int(np.searchsorted(x, high)) + 2)
    return x[keep], r[keep]


def _extend_periodic(x: np.ndarray, r: np.ndarray, period: float, reach: float) -> tuple[np.ndarray, np.ndarray]:
    turns = int(np.ceil(reach / period)) + 1
    shifts = np.arange(-turns, turns + 1)
    long_x = (x[None, :] + shifts[:, None] * period).ravel()
    long_r = np.tile(r, shifts.shape[0])
    keep = slice(
        max(int(np.searchsorted(long_x, x[0] - reach)) - 1, 0),
        int(np.searchsorted(long_x, x[0] + period + reach)) + 2,
    )
    return long_x[keep], long_r[keep]


def _kernel(offset: np.ndarray, cutoff: float, reach: float) -> np.ndarray:
    u = np.clip(offset / reach, -1.0, 1.0)
    window = 0.42 + 0.5 * np.cos(np.pi * u) + 0.08 * np.cos(2.0 * np.pi * u)
    return np.sinc(2.0 * cutoff * offset) * window


def resample(x: np.ndarray, r: np.ndarray, *, dx: float, first: int, count: int, period: float | None) -> np.ndarray:
    """Heights at the nodes first, first + 1, ... of the grid.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Increasing positions, m.
    r : ndarray, shape (n,)
        Heights, m.
    dx : float
        Grid spacing, m.
    first, count : int
        First node and number of nodes; they lie within x (or anywhere, if the line is periodic).
    period : float or None
        Repeat length of the line, m (longer than ``x[-1] - x[0]``); None: not periodic, ends extended by point
        reflection.

    Returns
    -------
    ndarray, shape (count,)
        Heights, m, without waves shorter than two of the coarser spacings.
    """
    nodes = (first + np.arange(count)) * dx
    spacing = float(np.median(np.diff(x)))
    uniform = is_equidistant(x)
    if uniform:
        spacing = float((x[-1] - x[0]) / (x.shape[0] - 1))
        offset = (nodes[0] - x[0]) / spacing
        aligned = abs(spacing - dx) * count <= 1e-3 * dx and abs(offset - round(offset)) <= 1e-3
        if aligned and (period is None or abs(period - x.shape[0] * dx) <= 1e-3 * dx):
            # Already on the grid: a filter would only take away the shortest waves.
            return r[(round(offset) + np.arange(count)) % x.shape[0]].astype(float)

    # A straight line passes every step below exactly when it is taken out first.
    slope, level = (0.0, float(np.mean(r))) if period is not None else np.polyfit(x - x[0], r, 1)
    r = r - (level + slope * (x - x[0]))
    coarser = max(spacing, dx)
    reach = _LOBES * coarser
    cutoff = (0.5 - _HALF_TRANSITION) / coarser
    if period is None:
        long_x, long_r = _extend_odd(x, r, reach + 2.0 * coarser)
    else:
        long_x, long_r = _extend_periodic(x, r, period, reach + 2.0 * coarser)
    start = float(long_x[0])
    if is_equidistant(long_x):
        step = float((long_x[-1] - start) / (long_x.shape[0] - 1))
    else:
        step = min(spacing, dx) / _OVERSAMPLING
        fine = start + step * np.arange(int((long_x[-1] - start) / step) + 1)
        long_r = CubicSpline(long_x, long_r)(fine)

    half = int(np.ceil(reach / step))
    taps = np.arange(-half, half + 1)
    out = np.empty(count)
    chunk = max(_CHUNK // taps.shape[0], 1)
    # In a periodic line the nodes may lie anywhere.
    places = nodes if period is None else x[0] + np.mod(nodes - x[0], period)
    for begin in range(0, count, chunk):
        place = (places[begin : begin + chunk] - start) / step
        nearest = np.rint(place).astype(np.int64)
        index = np.clip(nearest[:, None] + taps[None, :], 0, long_r.shape[0] - 1)
        weights = _kernel((place[:, None] - nearest[:, None] - taps[None, :]) * step, cutoff, reach)
        weights /= np.sum(weights, axis=1, keepdims=True)
        out[begin : begin + chunk] = np.einsum("ij,ij->i", weights, long_r[index])
    return out + level + slope * (nodes - x[0]) if period is None else out + level
