"""What a causal function says about the parts of its receptance in and out of phase with the force.

By the relations of Kramers and Kronig the part out of phase, which holds all the dissipation, determines the part in
phase but for what comes from outside the band: a constant compliance of all modes above it, and -A/omega^2 of a free
body below it.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

__all__ = ["LowFrequency", "in_phase", "outside_the_band"]

LowFrequency = Literal["static", "free"]

_PADDING = 8  # of the band, so that the periodic Hilbert transform is that of a single band


def in_phase(odd: NDArray) -> NDArray:
    """Part in phase with the force that belongs to a causal function with a given part out of phase.

    Parameters
    ----------
    odd : ndarray, shape (nf, 3, 3)
        Imaginary part at the lines 0, df, 2 df, ...

    Returns
    -------
    ndarray, shape (nf, 3, 3)
        Real part.
    """
    count = len(odd)
    size = 2 * _PADDING * count
    spectrum = np.zeros((size // 2 + 1, 3, 3), dtype=complex)
    spectrum[:count] = 1j * odd
    time = np.fft.irfft(spectrum, size, axis=0)
    # The odd part of a causal function is half of it after the impulse; the even part mirrors that.
    time[1 + size // 2 :] *= -1.0
    time[0] = time[size // 2] = 0.0
    return np.fft.rfft(time, axis=0)[:count].real


def outside_the_band(
    lines: NDArray, even: NDArray, odd: NDArray, lowest: float, top: float, low_frequency: LowFrequency
) -> tuple[NDArray, NDArray, float]:
    """Fit what comes from outside the band to what the lines in it don't explain.

    Parameters
    ----------
    lines : ndarray, shape (nf,)
        0, df, 2 df, ... in Hz.
    even : ndarray of complex, shape (nf, 3, 3)
        Receptance at the lines, m/N.
    odd : ndarray, shape (nf, 3, 3)
        Imaginary part that is used of it.
    lowest, top : float
        Band in which the receptance is known, Hz.
    low_frequency : {"static", "free"}

    Returns
    -------
    compliance : ndarray, shape (3, 3)
        Of what lies above the band, m/N.
    accelerance : ndarray, shape (3, 3)
        Of the free body, 1/kg; 0 for "static".
    non_causal : float
        What of the real part neither the imaginary part nor modes outside the band explain, rms over the rms of the
        receptance.
    """
    used = (lines >= lowest) & (lines > 0.0) & (lines <= top)
    explained = in_phase(odd)[used]
    omega = 2.0 * np.pi * lines[used]
    missing = np.real(even[used]) - explained
    size = np.abs(even[used])
    # Modes above the band: a constant is what the result can have of them, even powers are what they may show.
    share = (lines[used] / top) ** 2
    above = [np.ones(len(omega)), share, share**2]
    below = [-1.0 / omega**2] if low_frequency == "free" else []
    compliance, accelerance, left = np.zeros((3, 3)), np.zeros((3, 3)), missing.copy()
    for i, j in np.ndindex(3, 3):
        level = float(np.median(size[:, i, j]))
        if level == 0.0:
            continue
        weight = 1.0 / (size[:, i, j] + level)
        constant, *body = _fit([above[0], *below], missing[:, i, j], weight)
        terms = [*above, *below]
        left[:, i, j] -= np.stack(terms, axis=1) @ _fit(terms, missing[:, i, j], weight)
        compliance[i, j], accelerance[i, j] = constant, body[0] if body else 0.0
    return compliance, accelerance, float(np.linalg.norm(left) / np.linalg.norm(even[used]))


def _fit(terms: list[NDArray], target: NDArray, weight: NDArray) -> NDArray:
    """Weighted least squares; the terms may differ by many orders of magnitude."""
    weighted = np.stack(terms, axis=1) * weight[:, None]
    scale = np.abs(weighted).max(axis=0)
    return np.linalg.lstsq(weighted / scale, target * weight, rcond=None)[0] / scale
