"""What a run says about squeal: stick/slip, its main frequency, its level."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..wheel.modes import Mode

__all__ = ["SquealMeasures", "amplitude_spectrum", "nearest_mode", "squeal_measures"]


@dataclass(frozen=True)
class SquealMeasures:
    """Measures of a stretch of a run.

    Attributes
    ----------
    stick_share : float
        Share of the steps in which a part of the contact sticks.
    main_frequency : float
        Hz; the strongest line of the lateral force.
    main_amplitude : float
        N; amplitude of that line.
    force_rms : float
        N; lateral force without its mean.
    """

    stick_share: float
    main_frequency: float
    main_amplitude: float
    force_rms: float


def amplitude_spectrum(values: ArrayLike, *, dt: float) -> tuple[NDArray, NDArray]:
    """Amplitudes of the lines of a signal, through a Hann window.

    Parameters
    ----------
    values : array_like, shape (n,)
        Equidistant samples.
    dt : float
        s.

    Returns
    -------
    frequency : ndarray, shape (n // 2 + 1,)
        Hz.
    amplitude : ndarray, shape (n // 2 + 1,)
        Peak amplitude of a sinusoid at that line, in the unit of the signal.
    """
    signal = np.asarray(values, dtype=float)
    window = np.hanning(len(signal))
    spectrum = np.abs(np.fft.rfft((signal - signal.mean()) * window)) * 2.0 / window.sum()
    return np.fft.rfftfreq(len(signal), dt), spectrum


def squeal_measures(
    *, force_y: ArrayLike, slip_fraction: ArrayLike, dt: float, lowest_frequency: float = 100.0
) -> SquealMeasures:
    """Measure the stick/slip of a stretch of a run.

    Parameters
    ----------
    force_y : array_like, shape (n,)
        Lateral contact force, N.
    slip_fraction : array_like, shape (n,)
        Slipping share of the contact area.
    dt : float
        s.
    lowest_frequency : float
        Hz; lines below don't count as the main one.

    Returns
    -------
    SquealMeasures
    """
    lateral = np.asarray(force_y, dtype=float)
    frequency, amplitude = amplitude_spectrum(lateral, dt=dt)
    audible = np.where(frequency >= lowest_frequency, amplitude, 0.0)
    main = int(np.argmax(audible))
    return SquealMeasures(
        stick_share=float(np.mean(np.asarray(slip_fraction) < 1.0)),
        main_frequency=float(frequency[main]),
        main_amplitude=float(amplitude[main]),
        force_rms=float(lateral.std()),
    )


def nearest_mode(modes: Iterable[Mode], frequency: float) -> Mode:
    """Return the mode whose natural frequency is nearest to a frequency in Hz."""
    return min(modes, key=lambda mode: abs(mode.frequency - frequency))
