"""Third-octave levels of roughness lines, their mean, and a limit.

After EN 15610:2009, method A (7.4.2): a record is cut into segments that overlap by half; mean and linear trend of each
are taken out, a Hann window is applied, and mean squares are averaged; lines of the FFT on a band's edge count in
proportion (annex C). The mean over records or lines is that of the mean squares (7.6). The standard asks for segments
of 1 m at least and leaves out wavelengths above a quarter of them (7.5).

This package's choices: segments of 4 m, so that the 400 mm of ISO 3095 are resolved, and only bands at least as wide as
the window resolves, which is stricter than the quarter. One turn of a wheel is exactly periodic and gets no window.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wheelrail.excitation.named_spectra import SpectrumTable

from .third_octave import roughness_third_octave

__all__ = [
    "SEGMENT_LENGTH",
    "SHORTEST_SEGMENT",
    "BandLevels",
    "LimitComparison",
    "compare_with_limit",
    "line_levels",
    "mean_levels",
]

SEGMENT_LENGTH = 4.0
"""Default length of segments, m."""

SHORTEST_SEGMENT = 1.0
"""Shortest length of segments and records, m (EN 15610:2009, 5.6 and 7.4.2)."""

_REFERENCE = 1e-6  # m (EN 15610:2009, 3.3)


@dataclass(frozen=True, eq=False)
class BandLevels:
    """Roughness levels per third-octave band.

    Attributes
    ----------
    wavelengths : ndarray, shape (bands,)
        Exact centre wavelengths, m, descending.
    levels : ndarray, shape (bands,)
        dB re 1 um; -inf for a band without anything in it.
    """

    wavelengths: np.ndarray
    levels: np.ndarray

    @property
    def bands(self) -> np.ndarray:
        """Band numbers n, with the centre wavenumber 10^(n/10) 1/m."""
        return np.rint(-10.0 * np.log10(self.wavelengths)).astype(int)


@dataclass(frozen=True, eq=False)
class LimitComparison:
    """Levels against a limit, in all bands of the limit.

    Attributes
    ----------
    wavelengths : ndarray, shape (bands,)
        m, descending.
    limit, levels : ndarray, shape (bands,)
        dB re 1 um; a level that isn't known is NaN.
    """

    wavelengths: np.ndarray
    limit: np.ndarray
    levels: np.ndarray

    @property
    def excess(self) -> np.ndarray:
        """Level minus limit, dB, shape (bands,); NaN where the level isn't known."""
        return self.levels - self.limit

    @property
    def exceeded(self) -> np.ndarray:
        """Bands above the limit, shape (bands,)."""
        return self.excess > 0.0

    @property
    def unknown(self) -> np.ndarray:
        """Bands that the measurement doesn't reach, shape (bands,)."""
        return np.isnan(self.levels)


def line_levels(
    heights: np.ndarray, *, spacing: float, periodic: bool = False, segment_length: float = SEGMENT_LENGTH
) -> BandLevels:
    """Third-octave levels of one line, after EN 15610:2009, 7.4.2.

    Parameters
    ----------
    heights : ndarray, shape (n,)
        Equidistant, m.
    spacing : float
        m.
    periodic : bool
        The heights are exactly one turn: bands up to a quarter of it, without a window.
    segment_length : float
        m; a shorter record is one segment.

    Returns
    -------
    BandLevels

    Raises
    ------
    ValueError
        Record or segments shorter than 1 m.
    """
    heights = np.asarray(heights, dtype=float)
    length = heights.shape[0] * spacing
    if not min(length, segment_length) >= SHORTEST_SEGMENT * (1.0 - 1e-9):
        raise ValueError(f"record and segments must be {SHORTEST_SEGMENT:g} m long at least")
    if periodic:
        whole = roughness_third_octave(heights, spacing=spacing, periodic=True)
        kept = whole.wavelengths <= 0.25 * length
        return BandLevels(whole.wavelengths[kept], whole.level(reference=_REFERENCE)[kept])
    count = min(round(segment_length / spacing), heights.shape[0])
    # Counted from the middle, so that trend and mean are orthogonal.
    slope = (np.arange(count) - 0.5 * (count - 1)) / np.sqrt(count * (count**2 - 1) / 12.0)
    spectra = []
    for start in range(0, heights.shape[0] - count + 1, max(count // 2, 1)):
        part = heights[start : start + count] - np.mean(heights[start : start + count])
        spectra.append(roughness_third_octave(part - slope * (slope @ part), spacing=spacing))
    mean_square = np.mean([spectrum.mean_square for spectrum in spectra], axis=0)
    with np.errstate(divide="ignore"):
        levels = 10.0 * np.log10(mean_square / _REFERENCE**2)
    return BandLevels(spectra[0].wavelengths, levels)


def mean_levels(lines: Sequence[BandLevels]) -> BandLevels:
    """Mean of the mean squares, in the bands that all have (EN 15610:2009, 7.6; ISO 3095:2013, C.2.1).

    Raises
    ------
    ValueError
        No line.
    """
    if not lines:
        raise ValueError("a mean needs a line at least")
    common = set.intersection(*(set(line.bands.tolist()) for line in lines))
    kept = [np.array([band in common for band in line.bands]) for line in lines]
    powers = [10.0 ** (line.levels[mask] / 10.0) for line, mask in zip(lines, kept, strict=True)]
    with np.errstate(divide="ignore"):
        return BandLevels(lines[0].wavelengths[kept[0]], 10.0 * np.log10(np.mean(powers, axis=0)))


def compare_with_limit(levels: BandLevels, limit: SpectrumTable) -> LimitComparison:
    """Compare band by band; EN 15610:2009, 8, lets no band be above.

    The allowance that ISO 3095:2013 (annex C) makes for single bands is not applied.

    Parameters
    ----------
    levels : BandLevels
    limit : SpectrumTable
        As the named spectrum "iso3095-2013-limit".

    Returns
    -------
    LimitComparison
    """
    known = dict(zip(levels.bands.tolist(), levels.levels.tolist(), strict=True))
    bands = np.rint(-10.0 * np.log10(limit.wavelengths)).astype(int)
    found = np.array([known.get(int(band), np.nan) for band in bands])
    return LimitComparison(limit.wavelengths, limit.levels, found)
