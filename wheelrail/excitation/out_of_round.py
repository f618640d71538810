"""Out-of-round wheels: harmonics of a turn (numpy only: shipped in the FMU).

    r(X) = sum of A_n cos(n X / R + phase_n)

at the rolled distance X, exact over any number of turns.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from .sampled_heights import check_spacing, read_only, require

__all__ = ["OutOfRound"]


@dataclass(frozen=True, eq=False)
class OutOfRound:
    """A wheel that is not round, the same all across.

    Parameters
    ----------
    orders : ndarray, shape (n,)
        Waves on the circumference, whole numbers from 1.
    amplitudes : ndarray, shape (n,)
        m.
    phases : ndarray, shape (n,)
        rad; of the contact point at x = 0.
    radius : float
        R, m.
    dx : float
        Grid spacing, m.
    """

    orders: np.ndarray
    amplitudes: np.ndarray
    phases: np.ndarray
    radius: float
    dx: float
    kind: str = field(default="out-of-round", init=False)
    across: ClassVar[bool] = False

    def __post_init__(self) -> None:
        for name in ("orders", "amplitudes", "phases"):
            values = read_only(getattr(self, name))
            require(values.ndim == 1 and bool(np.all(np.isfinite(values))), f"{name} must be finite and 1-D")
            object.__setattr__(self, name, values)
        require(len(self.orders) == len(self.amplitudes) == len(self.phases) > 0, "one amplitude and phase per order")
        require(bool(np.all((self.orders >= 1.0) & (self.orders == np.round(self.orders)))), "orders are whole numbers")
        require(self.radius > 0.0 and self.dx > 0.0, "radius and dx must be positive")

    def add_window(self, first: int, out: np.ndarray) -> None:
        """Add the heights of nodes first, first + 1, ... to ``out`` (shape (n,), m)."""
        # The turns are taken off first, so that the angle keeps its digits.
        start = math.fmod(int(first) * self.dx / self.radius, 2.0 * math.pi)
        angle = start + np.arange(out.shape[0]) * (self.dx / self.radius)
        out += self.amplitudes @ np.cos(self.orders[:, None] * angle + self.phases[:, None])

    def realise(self, *, dx: float, seed_override: int | None) -> OutOfRound:  # noqa: ARG002
        """Return itself: nothing is random."""
        check_spacing(self.dx, dx)
        return self

    def covered(self) -> None:
        """Return None: defined for every x."""
        return

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description and arrays, for `wheelrail.excitation.sources.source_from_parts`."""
        arrays = {"orders": self.orders, "amplitudes": self.amplitudes, "phases": self.phases}
        return {"kind": self.kind, "radius": self.radius, "dx": self.dx}, arrays

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> OutOfRound:
        """Inverse of :meth:`to_parts`."""
        names = ("orders", "amplitudes", "phases")
        return cls(**{name: arrays[name] for name in names}, radius=meta["radius"], dx=meta["dx"])
