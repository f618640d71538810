"""Sound files: a force or a velocity as it would sound."""

from __future__ import annotations

import os
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy.io import wavfile
from scipy.signal import firwin, oaconvolve, resample_poly

__all__ = ["write_sound"]

RATE = 48000  # Hz
_LOUDEST = 0.9  # of full scale
_FADE = 5e-3  # s at both ends, against clicks
_LOWEST = 20.0  # Hz


def write_sound(path: str | os.PathLike[str], values: ArrayLike, *, dt: float, rate: int = RATE) -> float:
    """Write a signal as a mono WAV file of 16 bit.

    The signal is freed of what is below 20 Hz, brought to the sampling rate of the file and scaled to 90 % of full
    scale. It is not what a microphone would hear: the radiation from wheel and rail is left out.

    Parameters
    ----------
    path : path-like
    values : array_like, shape (n,)
        Equidistant samples in any unit.
    dt : float
        Their distance in s.
    rate : int
        Sampling rate of the file in Hz.

    Returns
    -------
    float
        Value that full scale stands for, in the unit of the signal.

    Raises
    ------
    ValueError
        If the signal is constant, not finite or shorter than 0.05 s.
    """
    signal = np.asarray(values, dtype=float)
    if signal.ndim != 1 or len(signal) * dt < 0.05:
        raise ValueError(f"a sound needs one signal of at least 0.05 s; this has {signal.size} samples of {dt:g} s")
    if not np.all(np.isfinite(signal)):
        raise ValueError("the signal has values that are not finite")
    ratio = Fraction(rate * dt).limit_denominator(1000)
    mean = signal.mean()
    sound = resample_poly(signal - mean, ratio.numerator, ratio.denominator)
    taps = min(len(sound) // 4 * 2 - 1, 2 * int(rate / _LOWEST) + 1)  # odd: no delay of half a sample
    sound = sound - oaconvolve(sound, firwin(taps, _LOWEST, fs=rate), mode="same")
    fade = int(_FADE * rate)
    ramp = 0.5 - 0.5 * np.cos(np.pi * np.arange(fade) / fade)
    sound[:fade] *= ramp
    sound[-fade:] *= ramp[::-1]
    largest = float(np.abs(sound).max())
    if largest <= 1e-12 * max(abs(mean), 1e-300):
        raise ValueError("the signal is constant: there is nothing to hear")
    wavfile.write(Path(path), rate, np.round(sound / largest * _LOUDEST * 32767.0).astype(np.int16))
    return largest / _LOUDEST
