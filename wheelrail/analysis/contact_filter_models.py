"""Contact filters from theory and from a standard: what a contact leaves of roughness of each wavelength.

All are levels 10 lg |H(k)|^2 in dB, k being the wavenumber of the roughness in rad/m. They tend to 0 dB for long waves.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from importlib import resources

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import j1

from wheelrail.errors import ParameterError
from wheelrail.numerics.third_octave_bands import band_numbers, exact_centres

__all__ = [
    "FilterTable",
    "averaging_filter",
    "cnossos_filters",
    "enclosing_filters",
    "patch_filter",
    "remington_filter",
]

_ANGLES = 400  # of the quadrature; the integrand has about ka alpha / pi oscillations


@dataclass(frozen=True, eq=False)
class FilterTable:
    """One printed contact filter.

    Attributes
    ----------
    load : float
        Of the wheel, N.
    wheel_diameter : float
        m.
    wavelengths : ndarray, shape (bands,)
        Exact centres of third-octave bands, m, descending.
    levels : ndarray, shape (bands,)
        dB.
    """

    load: float
    wheel_diameter: float
    wavelengths: NDArray
    levels: NDArray

    def at(self, wavelengths: ArrayLike) -> NDArray:
        """Levels in dB at wavelengths in m, linear over their logarithm; NaN outside of the table."""
        at = np.log(np.asarray(wavelengths, dtype=float))
        return np.interp(at, np.log(self.wavelengths[::-1]), self.levels[::-1], left=np.nan, right=np.nan)


def averaging_filter(wavelengths: ArrayLike, *, half_length: float) -> NDArray:
    """Filter of a mean over a contact of constant length, |H| = |sin(ka) / ka|.

    A Winkler bedding on roughness far smaller than its deflection filters in this way too.

    Parameters
    ----------
    wavelengths : array_like, shape (n,)
        m.
    half_length : float
        a in m.

    Returns
    -------
    ndarray, shape (n,)
        dB; very low at the wavelengths 2a, a, ...
    """
    size = _patch_over_wave(wavelengths, half_length)
    return 20.0 * np.log10(np.maximum(np.abs(np.sinc(size / np.pi)), 1e-15))


def patch_filter(wavelengths: ArrayLike, *, radius: float) -> NDArray:
    """Filter of a circular contact patch in closed form, |H|^2 = 1 / (1 + pi/4 (ka)^3).

    Parameters
    ----------
    wavelengths : array_like, shape (n,)
        m.
    radius : float
        a in m; of an ellipse the semi-axis along the rail.

    Returns
    -------
    ndarray, shape (n,)
        dB. Meant for ka < 2; at shorter waves it only shows the trend (Thompson 2009, Railway noise and vibration,
        section 5.4, after Remington 1987).
    """
    return -10.0 * np.log10(1.0 + 0.25 * np.pi * _patch_over_wave(wavelengths, radius) ** 3)


def remington_filter(wavelengths: ArrayLike, *, radius: float, alpha: float) -> NDArray:
    """Filter of a circular contact patch with a roughness that varies across it (Remington 1976; Pieringer 2011, 2.5).

    |H(k)|^2 = 4 / alpha / (ka)^2 times the integral of J1(ka sec psi)^2 over psi from 0 to arctan(alpha).

    Parameters
    ----------
    wavelengths : array_like, shape (n,)
        m.
    radius : float
        a in m.
    alpha : float
        How fast the roughness changes across the rail: small, the same on all parallel lines; large, hardly correlated.

    Returns
    -------
    ndarray, shape (n,)
        dB.

    Raises
    ------
    ParameterError
        If ``alpha`` is not positive.
    """
    if not (np.isfinite(alpha) and alpha > 0.0):
        raise ParameterError("alpha", alpha, "must be a number > 0")
    size = _patch_over_wave(wavelengths, radius)
    # With t = tan(psi) the oscillations are evenly spaced: d psi = dt / (1 + t^2).
    number = int(_ANGLES + 20.0 * alpha * float(size.max()))
    nodes, weights = np.polynomial.legendre.leggauss(min(number, 4000))
    slope = 0.5 * alpha * (nodes + 1.0)
    bessel = j1(np.multiply.outer(size, np.sqrt(1.0 + slope**2)))
    integral = 0.5 * alpha * (bessel**2 / (1.0 + slope**2)) @ weights
    return 10.0 * np.log10(4.0 / alpha * integral / size**2)


def _patch_over_wave(wavelengths: ArrayLike, extent: float) -> NDArray:
    """Return ka, shape (n,)."""
    waves = np.asarray(wavelengths, dtype=float)
    if not (np.all(np.isfinite(waves)) and np.all(waves > 0.0)):
        raise ParameterError("wavelengths", wavelengths, "all must be numbers > 0 m")
    if not (np.isfinite(extent) and extent > 0.0):
        raise ParameterError("contact size", extent, "must be a number > 0 m")
    return 2.0 * np.pi * extent / waves


@cache
def cnossos_filters() -> tuple[FilterTable, ...]:
    """Contact filters of Directive (EU) 2015/996, table G-2, as replaced by (EU) 2021/1226.

    Returns
    -------
    tuple of FilterTable
        Five, by growing load times diameter.
    """
    text = resources.files("wheelrail.analysis").joinpath("contact_filter_cnossos.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    # Band numbers count in mm, 30 bands from mm to m.
    wavelengths = exact_centres(band_numbers(np.array([float(row["wavelength_mm"]) for row in rows])) - 30)
    wavelengths.flags.writeable = False
    tables = []
    for column in rows[0]:
        if column == "wavelength_mm":
            continue
        load, diameter = column.split("_")
        levels = np.array([float(row[column]) for row in rows])
        levels.flags.writeable = False
        tables.append(
            FilterTable(
                1e3 * float(load.removesuffix("kN")), 1e-3 * float(diameter.removesuffix("mm")), wavelengths, levels
            )
        )
    return tuple(sorted(tables, key=_size))


def _size(table: FilterTable) -> float:
    """Cube of the contact's size but for a factor: in Hertz' theory it grows with load times radius."""
    return table.load * table.wheel_diameter


def enclosing_filters(*, load: float, wheel_diameter: float) -> tuple[FilterTable, FilterTable]:
    """Choose the two printed filters between which that of a wheel should lie.

    Parameters
    ----------
    load : float
        N.
    wheel_diameter : float
        m.

    Returns
    -------
    weaker, stronger : FilterTable
        Of the next smaller and the next larger contact, by load times diameter; the same one twice beyond the table
        and where both agree.
    """
    for name, value in (("load", load), ("wheel_diameter", wheel_diameter)):
        if not (np.isfinite(value) and value > 0.0):
            raise ParameterError(name, value, "must be a number > 0")
    tables = cnossos_filters()
    size = load * wheel_diameter
    smaller = [table for table in tables if _size(table) <= size * (1.0 + 1e-9)]
    larger = [table for table in tables if _size(table) >= size * (1.0 - 1e-9)]
    weaker = smaller[-1] if smaller else tables[0]
    return weaker, larger[0] if larger else tables[-1]
