"""Coherence of parallel roughness lines, by third-octave band of wavelength.

In a band, cross spectra are averaged over all its lines of the FFT and all segments before coherence is formed:

    gamma^2_ij = |sum S_ij|^2 / (sum S_ii sum S_jj),

the ordinary coherence (Bendat and Piersol 2010, chapter 5) of the part of the lines within the band. Averages over n
independent pieces come out too large, by about (1 - gamma^2)^2 / n (Carter, Knapp and Nuttall 1973): uncorrelated lines
seem to have the coherence 1 / n. A band of width B (1/m) of lines of length L has n = B L, about.

Pieringer, Kropp and Thompson (2011) assess roughness over the contact by one parameter, from the coherence of several
parallel lines. Its formula is in their paper, which was not at hand; `coherence_in_contact` is a definition of this
package: the plain mean of gamma^2 over all pairs of lines within the width of the contact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import get_window

from wheelrail.numerics.third_octave_bands import band_edges, centres_between

__all__ = ["BandCoherence", "coherence_in_contact", "roughness_coherence"]

_FEWEST_SAMPLES = 16
_FEWEST_AVERAGES = 2.0  # a single one is always fully coherent


@dataclass(frozen=True, eq=False)
class BandCoherence:
    """Coherence of all pairs of lines.

    Attributes
    ----------
    centres : ndarray, shape (bands,)
        Exact centre wavenumbers, 1/m, ascending.
    coherence : ndarray, shape (bands, lines, lines)
        gamma^2, between 0 and 1; symmetric, with ones on the diagonal. NaN where a line has nothing in a band.
    averages : ndarray, shape (bands,)
        n: independent pieces averaged. Uncorrelated lines come out at 1 / n.
    """

    centres: np.ndarray
    coherence: np.ndarray
    averages: np.ndarray

    @property
    def wavelengths(self) -> np.ndarray:
        """Exact centre wavelengths, m, shape (bands,)."""
        return 1.0 / self.centres

    @property
    def bias(self) -> np.ndarray:
        """By how much each coherence is expected to be too large, about, shape (bands, lines, lines)."""
        return (1.0 - self.coherence) ** 2 / self.averages[:, None, None]


def roughness_coherence(
    heights: np.ndarray, *, spacing: float, periodic: bool = False, segment: int | None = None
) -> BandCoherence:
    """Coherence between parallel lines in third-octave bands of wavelength (Welch 1967, along the rail).

    Parameters
    ----------
    heights : ndarray, shape (lines, n)
        m.
    spacing : float
        m.
    periodic : bool
        The heights are exactly one repeat: no window, whole harmonics per band.
    segment : int or None
        Segment length in samples, overlapping by half, Hann window; None: the whole lines at once, averaged over the
        bands alone.

    Returns
    -------
    BandCoherence
        Of bands with at least two averages.

    Raises
    ------
    ValueError
        Heights not 2-D, not finite or too short; spacing not positive; a segment that doesn't fit, or with periodic.
    """
    heights = np.asarray(heights, dtype=float)
    if heights.ndim != 2 or heights.shape[1] < _FEWEST_SAMPLES or not np.all(np.isfinite(heights)):
        raise ValueError(f"heights must be of shape (lines, n) and finite, n at least {_FEWEST_SAMPLES}")
    if not (np.isfinite(spacing) and spacing > 0.0):
        raise ValueError("spacing must be positive")
    if periodic and segment is not None:
        raise ValueError("periodic lines are taken whole: leave the segment out")
    samples = heights.shape[1]
    count = samples if segment is None else int(segment)
    if not _FEWEST_SAMPLES <= count <= samples:
        raise ValueError(f"segment must lie between {_FEWEST_SAMPLES} samples and the length of the lines")

    window = np.asarray(get_window("boxcar" if periodic else "hann", count, fftbins=True))
    centred = heights - np.mean(heights, axis=1, keepdims=True)
    cross = np.zeros((count // 2 + 1, heights.shape[0], heights.shape[0]), dtype=complex)
    for start in range(0, samples - count + 1, max(count // 2, 1)):
        spectra = np.fft.rfft(centred[:, start : start + count] * window, axis=1).T
        cross += spectra[:, :, None] * spectra.conj()[:, None, :]

    line = 1.0 / (count * spacing)
    # A Hann window smears over three lines, so the first ones hold the mean.
    centres = centres_between((0.5 if periodic else 1.5) * line, 0.5 / spacing)
    wavenumbers = np.arange(count // 2 + 1) * line
    edges = np.array([np.searchsorted(wavenumbers, edge) for edge in band_edges(centres)]).T
    kept = [(band, low, high) for band, (low, high) in enumerate(edges) if high > low]
    averages = np.array([_independent(window, samples, high - low) for _, low, high in kept])
    enough = np.flatnonzero(averages >= _FEWEST_AVERAGES)
    coherence = np.empty((len(enough), *cross.shape[1:]))
    for k, at in enumerate(enough):
        _, low, high = kept[at]
        total = np.sum(cross[low:high], axis=0)
        power = np.real(np.diagonal(total))
        with np.errstate(invalid="ignore", divide="ignore"):
            coherence[k] = np.minimum(np.abs(total) ** 2 / np.outer(power, power), 1.0)
    return BandCoherence(centres[[kept[at][0] for at in enough]], coherence, averages[enough])


def _independent(window: np.ndarray, samples: int, lines: int) -> float:
    """How many independent pieces a sum over segments and neighbouring lines of the FFT is worth, for a flat spectrum.

    With the correlations rho of all its terms, n = (number of terms)^2 / sum |rho|^2.
    """
    count = len(window)
    hop = max(count // 2, 1)
    segments = (samples - count) // hop + 1
    total = 0.0
    for shift in range(min(segments, 3)):
        overlap = np.zeros(count)
        overlap[: max(count - shift * hop, 0)] = window[: count - shift * hop] * window[shift * hop :]
        rho = np.abs(np.fft.fft(overlap)[: min(lines, count // 2)]) ** 2 / np.sum(window**2) ** 2
        apart = np.arange(len(rho))
        in_lines = np.sum(np.where(apart > 0, 2.0, 1.0) * (lines - apart) * rho)
        total += (1.0 if shift == 0 else 2.0) * (segments - shift) * in_lines
    return float((segments * lines) ** 2 / total)


def coherence_in_contact(bands: BandCoherence, *, lateral: np.ndarray, centre: float, width: float) -> np.ndarray:
    """Mean coherence over all pairs of different lines within the contact.

    1 means that the roughness is the same all across, so one line stands for all; 1 / n of `BandCoherence` means that
    the contact averages over lines that have nothing in common. The definition is this package's, see the module.

    Parameters
    ----------
    bands : BandCoherence
    lateral : ndarray, shape (lines,)
        Positions of the lines, m.
    centre, width : float
        Middle and full width of the contact, m.

    Returns
    -------
    ndarray, shape (bands,)

    Raises
    ------
    ValueError
        Another number of lines, or fewer than two within the contact.
    """
    lateral = np.asarray(lateral, dtype=float)
    if lateral.shape != bands.coherence.shape[1:2]:
        raise ValueError(f"{len(lateral)} positions for {bands.coherence.shape[1]} lines")
    # Lines on the edge count, whatever the rounding of their printed positions.
    within = np.flatnonzero(np.abs(lateral - centre) <= 0.5 * width * (1.0 + 1e-9))
    if len(within) < 2:
        raise ValueError(
            f"{len(within)} lines lie within the contact, {1e3 * width:g} mm wide at {1e3 * centre:g} mm; coherence "
            "needs two"
        )
    one, other = np.triu_indices(len(within), k=1)
    return np.mean(bands.coherence[:, within[one], within[other]], axis=1)
