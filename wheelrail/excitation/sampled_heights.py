"""Sampled heights: immutable arrays, periodic windows, and checks of the sources (numpy only: shipped in the FMU)."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["add_periodic", "check_spacing", "padded", "read_only", "require"]

_PAD = 4096
# Samples by which the copy of a periodic line goes on: windows up to this width are one contiguous slice.


def read_only(values: Any) -> np.ndarray:
    """Copy as float64 that can't be written to."""
    copy = np.array(values, dtype=np.float64, order="C")
    copy.flags.writeable = False
    return copy


def require(condition: bool, message: str) -> None:
    """Raise ``ValueError(message)`` unless the condition holds."""
    if not condition:
        raise ValueError(message)


def check_spacing(own: float, dx: float) -> None:
    """Raise ``ValueError`` if a source made for the spacing ``own`` is asked for another one (m)."""
    require(abs(dx - own) <= 1e-12 * own, f"the source was made for dx = {own!r} m, not {dx!r} m")


def padded(values: np.ndarray) -> np.ndarray:
    """One repeat, continued periodically, read-only, for :func:`add_periodic`."""
    return read_only(np.resize(values, values.shape[0] + _PAD))


def add_periodic(repeated: np.ndarray, period: int, start: int, out: np.ndarray) -> None:
    """Add samples start, start + 1, ... of a periodic line to ``out``.

    Parameters
    ----------
    repeated : ndarray, shape (period + pad,)
        From :func:`padded`.
    period : int
        Samples per repeat.
    start : int
        Any integer.
    out : ndarray, shape (n,)
        Changed in place.
    """
    start %= period
    stop = start + out.shape[0]
    if stop <= repeated.shape[0]:
        out += repeated[start:stop]
    else:
        out += repeated[np.arange(start, stop) % period]
