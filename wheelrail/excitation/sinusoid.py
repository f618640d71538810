"""Sinusoidal roughness, exact at any distance (numpy only: shipped in the FMU)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, ClassVar

import numpy as np

from .sampled_heights import add_periodic, check_spacing, padded, require

__all__ = ["Sinusoid"]

_LONGEST_TABLE = 65536
# Longest exact repeat (samples) that is held as a table.


@dataclass(frozen=True, eq=False)
class Sinusoid:
    """Sinusoidal roughness r(x) = A sin(2 pi x / wavelength), zero above the sleeper at x = 0.

    Parameters
    ----------
    amplitude : float
        A, m.
    wavelength : float
        m, longer than 2 dx.
    dx : float
        Grid spacing, m.
    """

    amplitude: float
    wavelength: float
    dx: float
    kind: str = field(default="sinusoid", init=False)
    across: ClassVar[bool] = False
    _ratio: tuple[int, int] = field(init=False, repr=False)
    _table: np.ndarray | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        for name in ("amplitude", "wavelength", "dx"):
            value = float(getattr(self, name))
            require(bool(np.isfinite(value)), f"{name} must be finite")
            object.__setattr__(self, name, value)
        require(self.dx > 0.0, "dx must be positive")
        require(self.wavelength > 2.0 * self.dx, "wavelength must be longer than 2 dx")
        # dx and wavelength as the decimal numbers a user writes: node i has the phase (i p mod q) / q of a turn
        # in whole numbers, so nothing is lost however far the wheel has rolled.
        ratio = Fraction(repr(self.dx)) / Fraction(repr(self.wavelength))
        p, q = ratio.numerator, ratio.denominator
        table = None
        if q <= _LONGEST_TABLE:
            turns = (np.arange(q, dtype=np.int64) * p % q) / q
            table = padded(self.amplitude * np.sin(2.0 * np.pi * turns))
        object.__setattr__(self, "_ratio", (p, q))
        object.__setattr__(self, "_table", table)

    def add_window(self, first: int, out: np.ndarray) -> None:
        """Add the heights of nodes first, first + 1, ... to ``out`` (shape (n,), m)."""
        p, q = self._ratio
        if self._table is not None:
            add_periodic(self._table, q, int(first), out)
            return
        turns = (int(first) * p % q) / q + np.arange(out.shape[0]) * (p / q)
        out += self.amplitude * np.sin(2.0 * np.pi * turns)

    def realise(self, *, dx: float, seed_override: int | None) -> Sinusoid:  # noqa: ARG002
        """Return itself: nothing is random."""
        check_spacing(self.dx, dx)
        return self

    def covered(self) -> None:
        """Return None: defined for every x."""
        return

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description and arrays, for :func:`source_from_parts`."""
        return {"kind": self.kind, "amplitude": self.amplitude, "wavelength": self.wavelength, "dx": self.dx}, {}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> Sinusoid:  # noqa: ARG003
        """Inverse of :meth:`to_parts`."""
        return cls(amplitude=meta["amplitude"], wavelength=meta["wavelength"], dx=meta["dx"])
