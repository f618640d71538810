"""Synthesis of parallel roughness lines with a given coherence across (numpy only: shipped in the FMU).

Between lines a distance dy apart, waves of wavenumber k (rad/m) have the complex coherence

    gamma(k, dy) = S_12 / sqrt(S_11 S_22) = exp(-c k |dy|),

real and positive: waves stand square to the rail on the average. What is called coherence is gamma^2 (Bendat and
Piersol 2010, chapter 5). The decay c has no unit; c = 0 makes all lines the same, c = inf uncorrelated.

Harmonics have the fixed amplitudes of `wheelrail.excitation.synthesis`, so every line of every realisation has its band
levels exactly. From line to line only the phase of a harmonic moves, in a random walk: a normal step of variance
2 c k dy has the mean exp(i step) = exp(-c k dy), and as steps are independent, their product gives gamma for every pair
of lines. With many harmonics to a band the lines are a Gaussian field with this cross-spectral matrix, as factoring the
matrix would give, but without levels that scatter.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .synthesis import HarmonicPlan

__all__ = ["synthesise_lines"]

_FULL_SCATTER = 100.0
# Standard deviation of a phase step, rad, that leaves no coherence: exp(-100^2 / 2) = 0 in double precision.


def synthesise_lines(
    plan: HarmonicPlan, *, count: int, dx: float, lateral: np.ndarray, decay: float, entropy: Sequence[int]
) -> np.ndarray:
    """One repeat of parallel lines with the plan's amplitudes.

    Parameters
    ----------
    plan : HarmonicPlan
        Amplitudes for this ``count``.
    count : int
        Samples per repeat.
    dx : float
        Grid spacing, m.
    lateral : ndarray, shape (lines,)
        Positions across, m, increasing.
    decay : float
        c, not negative; may be infinite.
    entropy : sequence of int
        Non-negative seed words; the same words give the same lines. The first line is the one that
        `wheelrail.excitation.synthesis.synthesise` makes of them.

    Returns
    -------
    ndarray, shape (lines, count)
        Heights, m.
    """
    generator = np.random.Generator(np.random.PCG64(np.random.SeedSequence(list(entropy))))
    harmonics = plan.amplitudes.shape[0]
    wavenumber = 2.0 * np.pi * np.arange(1, harmonics) / (count * dx)
    phases = 2.0 * np.pi * generator.random(harmonics)
    lines = np.empty((len(lateral), count))
    for number in range(len(lateral)):
        if number > 0:
            variance = 2.0 * decay * (wavenumber * (lateral[number] - lateral[number - 1]))
            phases[1:] += np.minimum(np.sqrt(variance), _FULL_SCATTER) * generator.standard_normal(harmonics - 1)
        lines[number] = np.fft.irfft(0.5 * count * plan.amplitudes * np.exp(1j * phases), n=count)
    return lines
