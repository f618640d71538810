"""Third-octave bands in the base-10 system: exact centres and band edges (numpy only)."""

from __future__ import annotations

import numpy as np

__all__ = ["EDGE_RATIO", "band_edges", "band_numbers", "centres_between", "exact_centres"]

EDGE_RATIO = 10.0**0.05
"""Upper edge over centre, and centre over lower edge (IEC 61260-1:2014, eqs. 4 and 5 with G = 10^0.3)."""

_LARGEST_MISFIT = 0.25
# Largest distance of a printed centre from an exact one, in bands: nominal values are within 0.05, but tables
# also print 12 mm or 120 mm for 12.5 mm and 125 mm (0.21).


def band_numbers(nominal: np.ndarray) -> np.ndarray:
    """Band number n of nominal centres, with the exact centre 10^(n/10).

    Parameters
    ----------
    nominal : ndarray, shape (n,)
        Printed centres (frequency, wavenumber or wavelength), positive, any unit that is a power of ten of the SI unit.

    Returns
    -------
    ndarray of int, shape (n,)

    Raises
    ------
    ValueError
        A value is not positive, or lies between two centres.
    """
    nominal = np.asarray(nominal, dtype=float)
    if not (np.all(np.isfinite(nominal)) and np.all(nominal > 0.0)):
        raise ValueError("band centres must be positive")
    number = 10.0 * np.log10(nominal)
    nearest = np.rint(number)
    astray = np.abs(number - nearest) > _LARGEST_MISFIT
    if np.any(astray):
        raise ValueError(
            f"{nominal[astray][0]:.6g} is not the centre of a third-octave band (1, 1.25, 1.6, 2, 2.5, ...)"
        )
    return nearest.astype(int)


def exact_centres(numbers: np.ndarray) -> np.ndarray:
    """Exact centres 10^(n/10) (IEC 61260-1:2014, eq. 2: reference 1000, G = 10^0.3, three bands an octave)."""
    return 10.0 ** (np.asarray(numbers, dtype=float) / 10.0)


def band_edges(centres: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper edges of bands with exact ``centres``, in the same unit."""
    centres = np.asarray(centres, dtype=float)
    return centres / EDGE_RATIO, centres * EDGE_RATIO


def centres_between(lowest: float, highest: float) -> np.ndarray:
    """Exact centres of all bands that lie wholly between ``lowest`` and ``highest`` (may be empty).

    Parameters
    ----------
    lowest, highest : float
        Positive limits for the band edges.
    """
    # 1e-9 bands of slack: an edge given as a limit must not lose its band to rounding.
    first = int(np.ceil(10.0 * np.log10(lowest * EDGE_RATIO) - 1e-9))
    last = int(np.floor(10.0 * np.log10(highest / EDGE_RATIO) + 1e-9))
    return exact_centres(np.arange(first, last + 1))
