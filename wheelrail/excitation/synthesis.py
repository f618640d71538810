"""Synthesis of a periodic random roughness line from third-octave levels (numpy only: shipped in the FMU).

A line of ``count`` samples repeats after ``count * dx``, so it consists of harmonics. Each band's mean square
(10^(level/10) um^2) is shared among the harmonics inside the band, with fixed amplitudes and random phases:
every realisation then has its band levels exactly, whatever the seed. Within a band the shares follow the
spectral density interpolated between the neighbouring centres, so no steps appear at band edges.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..numerics.third_octave_bands import band_edges

__all__ = ["REFERENCE_HEIGHT", "HarmonicPlan", "plan_harmonics", "rail_repeat_length", "seed_words", "synthesise"]

REFERENCE_HEIGHT = 1e-6
"""Reference of roughness levels, m: L_r = 10 lg(r_rms^2 / (1 um)^2) dB (EN 15610)."""

_STREAM = {"rail": 0, "wheel": 1}
# Seed word that keeps a rail line and a wheel line of equal seed apart.

_WAVELENGTHS_PER_REPEAT = 10.0
_SHORTEST_REPEAT = 20.0  # m


@dataclass(frozen=True, eq=False)
class HarmonicPlan:
    """Amplitudes of the harmonics of a line, and the bands that it can't hold.

    Attributes
    ----------
    amplitudes : ndarray, shape (count // 2 + 1,)
        Amplitude of harmonic m, wavelength ``count * dx / m``, m.
    kept : ndarray of bool, shape (bands,)
        Bands that the line holds.
    too_short : ndarray of bool, shape (bands,)
        Bands that reach below the wavelength 2 dx.
    without_harmonic : ndarray of bool, shape (bands,)
        Bands that no harmonic falls into (or longer than the line).
    """

    amplitudes: np.ndarray
    kept: np.ndarray
    too_short: np.ndarray
    without_harmonic: np.ndarray


def rail_repeat_length(wavelengths: np.ndarray) -> float:
    """Default repeat length of a rail line, m: ten times the longest wavelength, at least 20 m."""
    return max(_WAVELENGTHS_PER_REPEAT * float(np.max(wavelengths)), _SHORTEST_REPEAT)


def plan_harmonics(*, wavelengths: np.ndarray, levels: np.ndarray, count: int, dx: float) -> HarmonicPlan:
    """Share the bands' mean squares among the harmonics of a line.

    Parameters
    ----------
    wavelengths : ndarray, shape (bands,)
        Exact centre wavelengths, m, each band once.
    levels : ndarray, shape (bands,)
        Levels, dB re 1 um.
    count : int
        Samples per repeat.
    dx : float
        Grid spacing, m.

    Returns
    -------
    HarmonicPlan

    Raises
    ------
    ValueError
        No band can be held.
    """
    wavelengths = np.asarray(wavelengths, dtype=float)
    levels = np.asarray(levels, dtype=float)
    centres = 1.0 / wavelengths
    lower, upper = band_edges(centres)
    wavenumbers = np.arange(count // 2 + 1) / (count * dx)
    too_short = upper >= 0.5 / dx

    order = np.argsort(centres)
    density = levels - 10.0 * np.log10(upper - lower)  # dB re 1 um^2 per (1/m)
    log_density = np.full(wavenumbers.shape, -np.inf)
    log_density[1:] = _interpolate(np.log(wavenumbers[1:]), np.log(centres[order]), density[order])

    mean_square = np.zeros(wavenumbers.shape)
    without_harmonic = np.zeros(wavelengths.shape, dtype=bool)
    for band in np.flatnonzero(~too_short):
        first = int(np.searchsorted(wavenumbers, lower[band], side="left"))
        last = int(np.searchsorted(wavenumbers, upper[band], side="left"))
        first = max(first, 1)
        if first >= last:
            without_harmonic[band] = True
            continue
        shares = 10.0 ** ((log_density[first:last] - np.max(log_density[first:last])) / 10.0)
        target = REFERENCE_HEIGHT**2 * 10.0 ** (levels[band] / 10.0)
        mean_square[first:last] = target * shares / np.sum(shares)
    kept = ~(too_short | without_harmonic)
    if not np.any(kept):
        raise ValueError("no band of the spectrum fits between 2 dx and the repeat length")
    return HarmonicPlan(np.sqrt(2.0 * mean_square), kept, too_short, without_harmonic)


def _interpolate(at: np.ndarray, knots: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Piecewise linear, continued with the outermost slopes (the outer halves of the first and last bands)."""
    inside = np.interp(at, knots, values)
    if knots.shape[0] == 1:
        return inside
    slopes = np.diff(values) / np.diff(knots)
    return inside + slopes[0] * np.minimum(at - knots[0], 0.0) + slopes[-1] * np.maximum(at - knots[-1], 0.0)


def seed_words(*, seed: int, on: str, override: int | None) -> list[int]:
    """Seed words of a source.

    Parameters
    ----------
    seed : int
        The source's own.
    on : {"wheel", "rail"}
        Surface that carries it.
    override : int or None
        Another realisation of the whole case: combined with the own seed, so that sources stay independent.

    Raises
    ------
    ValueError
        The override is negative or no whole number.
    """
    own = [int(seed), _STREAM[on]]
    if override is None:
        return [0, 0, *own]
    if int(override) != override or override < 0:
        raise ValueError("seed_override must not be negative")
    # The leading word tells an override apart from a longer own seed.
    return [1, int(override), *own]


def synthesise(plan: HarmonicPlan, *, count: int, entropy: Sequence[int]) -> np.ndarray:
    """One repeat of a line with the plan's amplitudes and random phases.

    Parameters
    ----------
    plan : HarmonicPlan
        Amplitudes for this ``count``.
    count : int
        Samples per repeat.
    entropy : sequence of int
        Non-negative seed words; the same words give the same line.

    Returns
    -------
    ndarray, shape (count,)
        Heights, m.
    """
    generator = np.random.Generator(np.random.PCG64(np.random.SeedSequence(list(entropy))))
    phases = 2.0 * np.pi * generator.random(plan.amplitudes.shape[0])
    spectrum = 0.5 * count * plan.amplitudes * np.exp(1j * phases)
    return np.fft.irfft(spectrum, n=count)
