"""Axes of third-octave bands: octaves are named, the bands between them have a tick."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from numpy.typing import NDArray

from .force import nominal_frequency

__all__ = ["frequency_bands", "wavelength_bands"]

_MARGIN = 10.0**0.07


def frequency_bands(axis: Axes, centres: NDArray) -> None:
    """Label the x axis with the nominal frequencies of bands.

    Parameters
    ----------
    axis : Axes
    centres : ndarray, shape (bands,)
        Exact centres, Hz.
    """
    _mark(axis, centres)
    axis.set_xlim(centres.min() / _MARGIN, centres.max() * _MARGIN)
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: nominal_frequency(value)))
    axis.set_xlabel("Third-octave band centre frequency / Hz")


def wavelength_bands(axis: Axes, wavelengths: NDArray) -> None:
    """Label the x axis, in mm, with the nominal wavelengths of bands; it falls to the right.

    Parameters
    ----------
    axis : Axes
    wavelengths : ndarray, shape (n,)
        m; the bands between the longest and the shortest.
    """
    numbers = np.rint(10.0 * np.log10(1e3 * np.array([wavelengths.min(), wavelengths.max()])))
    _mark(axis, 10.0 ** (np.arange(numbers[0], numbers[1] + 1) / 10.0))
    axis.set_xlim(1e3 * wavelengths.max() * _MARGIN, 1e3 * wavelengths.min() / _MARGIN)
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: _millimetres(value)))
    axis.set_xlabel("Wavelength / mm")


def _mark(axis: Axes, centres: NDArray) -> None:
    octave = np.rint(10.0 * np.log10(centres)).astype(int) % 3 == 0
    axis.set_xscale("log")
    axis.xaxis.set_major_locator(FixedLocator(list(centres[octave])))
    axis.xaxis.set_minor_locator(FixedLocator(list(centres[~octave])) if np.any(~octave) else NullLocator())
    axis.xaxis.set_minor_formatter(FuncFormatter(lambda *_: ""))


def _millimetres(wavelength: float) -> str:
    name = nominal_frequency(wavelength)
    return f"{1e3 * float(name[:-1]):g}" if name.endswith("k") else name
