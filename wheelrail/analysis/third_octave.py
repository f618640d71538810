"""Third-octave spectra of time histories and of roughness lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import get_window

from wheelrail.numerics.third_octave_bands import band_edges, centres_between

__all__ = ["ThirdOctaveSpectrum", "roughness_third_octave", "third_octave"]

_WIDEST_LINE = {"boxcar": 1.0, "hann": 1.5}
# Equivalent noise bandwidth of the windows, in FFT lines: a narrower band is not resolved.


@dataclass(frozen=True, eq=False)
class ThirdOctaveSpectrum:
    """Mean squares per third-octave band.

    Attributes
    ----------
    centres : ndarray, shape (bands,)
        Exact centre frequencies, Hz (or wavenumbers 1/m), ascending.
    mean_square : ndarray, shape (bands,)
        Mean square in each band, unit of the signal squared.
    total : float
        Mean square of the whole signal without its mean (with a window: the window's estimate of it).
    below, above : float
        Share of ``total`` below the first and above the last band: ``below + sum(mean_square) + above = total``.
    lines_per_band : ndarray, shape (bands,)
        Width of each band in FFT lines; below about 3 a level is uncertain.
    """

    centres: np.ndarray
    mean_square: np.ndarray
    total: float
    below: float
    above: float
    lines_per_band: np.ndarray

    @property
    def wavelengths(self) -> np.ndarray:
        """Exact centre wavelengths 1 / centres, m, if the signal is a line along x."""
        return 1.0 / self.centres

    @property
    def rms(self) -> np.ndarray:
        """Root mean square in each band, shape (bands,)."""
        return np.sqrt(self.mean_square)

    def level(self, *, reference: float) -> np.ndarray:
        """Levels 10 lg(mean square / reference^2), dB, shape (bands,); -inf for an empty band."""
        with np.errstate(divide="ignore"):
            return 10.0 * np.log10(self.mean_square / reference**2)


def third_octave(
    signal: np.ndarray,
    *,
    spacing: float,
    lowest: float | None = None,
    highest: float | None = None,
    window: str = "hann",
    segment: int | None = None,
    share_lines: bool = True,
) -> ThirdOctaveSpectrum:
    """Third-octave spectrum by FFT (Welch 1967 if a segment length is given).

    The mean is taken out. Mean squares of the FFT lines are summed per band; a line that straddles a band edge is
    shared in proportion, so no power is lost or counted twice.

    Parameters
    ----------
    signal : ndarray, shape (n,)
        Equidistant samples.
    spacing : float
        Sample spacing, s (or m).
    lowest, highest : float or None
        Only bands that lie wholly between them, Hz (or 1/m); None: every band wide enough for the window's
        resolution, and up to the Nyquist frequency.
    window : {"hann", "boxcar"}
        "boxcar" suits records that hold whole periods: the bands then add up to the variance exactly (Parseval).
    segment : int or None
        Segment length in samples, overlapping by half; None: the whole record at once.
    share_lines : bool
        False: each line goes to the band that holds its centre, for records that are exactly periodic.

    Returns
    -------
    ThirdOctaveSpectrum

    Raises
    ------
    ValueError
        Signal too short, not finite or not 1-D; spacing or limits not positive; unknown window.
    """
    signal = np.asarray(signal, dtype=float)
    if signal.ndim != 1 or signal.shape[0] < 16 or not np.all(np.isfinite(signal)):
        raise ValueError("signal must be 1-D and finite, with at least 16 samples")
    if not (np.isfinite(spacing) and spacing > 0.0):
        raise ValueError("spacing must be positive")
    if window not in _WIDEST_LINE:
        raise ValueError(f"window {window!r}; allowed: {', '.join(_WIDEST_LINE)}")
    count = signal.shape[0] if segment is None else int(segment)
    if not 16 <= count <= signal.shape[0]:
        raise ValueError("segment must lie between 16 samples and the length of the signal")

    power = _line_mean_squares(signal - np.mean(signal), count, window)
    line = 1.0 / (count * spacing)
    nyquist = 0.5 / spacing
    # Narrowest band that the window resolves: width = centre (ratio - 1/ratio) = 0.2308 centre.
    low = lowest if lowest is not None else _WIDEST_LINE[window] * line / 0.2308
    high = min(highest if highest is not None else nyquist, nyquist)
    if not (low > 0.0 and high > 0.0):
        raise ValueError("lowest and highest must be positive")
    centres = centres_between(low, high) if high > low else np.empty(0)
    lower, upper = band_edges(centres)

    if share_lines:
        # Line m stands for the interval m -+ 1/2; the running sum over intervals is piecewise linear.
        edges = np.clip((np.arange(power.shape[0] + 1) - 0.5) * line, 0.0, nyquist)
        running = np.concatenate(([0.0], np.cumsum(power)))
        at_lower, at_upper = np.interp(lower, edges, running), np.interp(upper, edges, running)
    else:
        frequencies = np.arange(power.shape[0]) * line
        running = np.concatenate(([0.0], np.cumsum(power)))
        at_lower = running[np.searchsorted(frequencies, lower)]
        at_upper = running[np.searchsorted(frequencies, upper)]
    total = float(running[-1])
    below, inside = (float(at_lower[0]), float(at_upper[-1])) if centres.shape[0] else (0.0, 0.0)
    return ThirdOctaveSpectrum(
        centres=centres,
        mean_square=at_upper - at_lower,
        total=total,
        below=below,
        above=total - inside,
        lines_per_band=(upper - lower) / line,
    )


def _line_mean_squares(signal: np.ndarray, count: int, window: str) -> np.ndarray:
    """Mean square per FFT line, averaged over half-overlapping segments, shape (count // 2 + 1,)."""
    weights = np.asarray(get_window(window, count, fftbins=True))
    starts = np.arange(0, signal.shape[0] - count + 1, max(count // 2, 1))
    power = np.zeros(count // 2 + 1)
    for start in starts:
        power += np.abs(np.fft.rfft(signal[start : start + count] * weights)) ** 2
    power *= 2.0 / (starts.shape[0] * count * np.sum(weights**2))
    power[0] *= 0.5
    if count % 2 == 0:
        power[-1] *= 0.5  # the Nyquist line has no mirror image
    return power


def roughness_third_octave(
    heights: np.ndarray, *, spacing: float, periodic: bool = False, segment: int | None = None
) -> ThirdOctaveSpectrum:
    """Roughness by wavelength; levels re 1 um come from ``level(reference=1e-6)``.

    Parameters
    ----------
    heights : ndarray, shape (n,)
        m.
    spacing : float
        m.
    periodic : bool
        The heights are exactly one repeat (a wheel's turn, a synthesised line): no window, whole harmonics per band.
    segment : int or None
        Segment length in samples; None: the whole line.

    Returns
    -------
    ThirdOctaveSpectrum
        ``centres`` in 1/m; ``wavelengths`` in m.
    """
    heights = np.asarray(heights, dtype=float)
    if periodic:
        lowest = 0.99 / (heights.shape[0] * spacing) / 1.26  # from the band that holds the first harmonic
        return third_octave(heights, spacing=spacing, window="boxcar", lowest=lowest, share_lines=False)
    return third_octave(heights, spacing=spacing, window="hann", segment=segment)
