"""Receptances sampled in frequency: their lines, and the resonances that these don't resolve."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import find_peaks, peak_widths

__all__ = ["FEWEST_LINES", "checked_lines", "even_lines", "unresolved_resonances"]

FEWEST_LINES = 4.0  # in a half-power bandwidth
_MOST_LINES = 1 << 20
_EVEN = 1e-3  # of a spacing


def checked_lines(frequency: ArrayLike, values: ArrayLike) -> tuple[NDArray, NDArray]:
    """Return lines, shape (nf,), and receptances, shape (nf, 3, 3), as arrays.

    Raises
    ------
    ValueError
        For other shapes, values that aren't finite, and lines that don't increase from 0 Hz on.
    """
    frequency, values = np.asarray(frequency, dtype=float), np.asarray(values, dtype=complex)
    if frequency.ndim != 1 or len(frequency) < 2 or values.shape != (len(frequency), 3, 3):
        raise ValueError(f"{frequency.shape} frequencies and {values.shape} receptances are refused: (nf,), (nf, 3, 3)")
    if not (np.all(np.isfinite(frequency)) and np.all(np.isfinite(values))):
        raise ValueError("frequencies and receptances have to be finite")
    if frequency[0] < 0.0 or np.any(np.diff(frequency) <= 0.0):
        raise ValueError("frequencies have to increase from 0 Hz on")
    return frequency, values


def even_lines(frequency: NDArray, values: NDArray, notes: list[str]) -> tuple[NDArray, NDArray]:
    """Bring receptances to lines 0, df, 2 df, ...; lines that are so already stay as they are.

    Parameters
    ----------
    frequency : ndarray, shape (nf,)
        Hz.
    values : ndarray of complex, shape (nf, 3, 3)
        m/N.
    notes : list of str
        An interpolation is noted here.

    Returns
    -------
    lines : ndarray, shape (count,)
        Hz.
    receptance : ndarray of complex, shape (count, 3, 3)
        Below the first line the real part is constant and the imaginary part proportional to frequency, as of a
        viscous loss.

    Raises
    ------
    ValueError
        If the smallest spacing makes too many lines.
    """
    steps = np.diff(frequency)
    df = (frequency[-1] - frequency[0]) / len(steps)
    on_grid = np.max(np.abs(frequency / df - np.round(frequency / df))) <= _EVEN
    interpolated = np.max(np.abs(steps - df)) > _EVEN * df or not on_grid
    if interpolated:
        df = float(steps.min())
        if frequency[-1] / df > _MOST_LINES:
            raise ValueError(
                f"the smallest spacing of the lines, {df:g} Hz, makes {frequency[-1] / df:.3g} of them up to "
                f"{frequency[-1]:g} Hz; at most {_MOST_LINES} are allowed"
            )
        notes.append(f"lines interpolated to multiples of {df:g} Hz")
    count = int(np.floor(frequency[-1] / df + _EVEN)) + 1
    lines = df * np.arange(count)
    result = np.empty((count, 3, 3), dtype=complex)
    inside = lines >= frequency[0] * (1.0 - 1e-9)
    if interpolated:
        result[inside] = CubicSpline(frequency, values)(lines[inside])
    else:
        result[count - len(frequency) :] = values
    share = lines[~inside] / frequency[0] if frequency[0] else np.zeros(0)
    result[~inside] = values[0].real + 1j * share[:, None, None] * values[0].imag
    result[0] = result[0].real
    return lines, result


def unresolved_resonances(lines: NDArray, even: NDArray, lowest: float, top: float) -> tuple[float, ...]:
    """Find resonances whose half-power bandwidth has too few lines, from the peaks of the point mobilities.

    Parameters
    ----------
    lines : ndarray, shape (nf,)
        0, df, 2 df, ... in Hz.
    even : ndarray of complex, shape (nf, 3, 3)
        Receptance at the lines, m/N.
    lowest, top : float
        Band to look at, Hz.

    Returns
    -------
    tuple of float
        Hz.
    """
    used = (lines >= lowest) & (lines <= top) & (lines > 0.0)
    mobility = lines[used] * np.abs(np.trace(even[used], axis1=1, axis2=2))
    level = 20.0 * np.log10(np.maximum(mobility, 1e-300))
    peaks, about = find_peaks(level, prominence=6.0, height=float(np.median(level)))
    bases = about["left_bases"], about["right_bases"]
    width = peak_widths(level, peaks, rel_height=0.5, prominence_data=(np.full(len(peaks), 6.02), *bases))[0]
    return tuple(float(f) for f in lines[used][peaks[width < FEWEST_LINES]])
