"""Corrugation over a stretch of rail (numpy only: shipped in the FMU).

    r(x) = A sin(2 pi (x - x0) / wavelength)    for x0 < x < x0 + length,

fading in and out over a ramp of half a cosine at each end, so that no corner excites what the waves don't.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from .sampled_heights import check_spacing, require

__all__ = ["Corrugation"]


@dataclass(frozen=True, eq=False)
class Corrugation:
    """Waves on a stretch of rail, the same all across.

    Parameters
    ----------
    amplitude : float
        A, m.
    wavelength : float
        m, longer than 2 dx.
    start, length : float
        Where it begins, and how long it is, m.
    ramp : float
        Length of the ramp at each end, m; at most half of the length.
    dx : float
        Grid spacing, m.
    """

    amplitude: float
    wavelength: float
    start: float
    length: float
    ramp: float
    dx: float
    kind: str = field(default="corrugation", init=False)
    across: ClassVar[bool] = False

    _SCALARS: ClassVar = ("amplitude", "wavelength", "start", "length", "ramp", "dx")

    def __post_init__(self) -> None:
        for name in self._SCALARS:
            value = float(getattr(self, name))
            require(bool(np.isfinite(value)), f"{name} must be finite")
            object.__setattr__(self, name, value)
        require(self.dx > 0.0, "dx must be positive")
        require(self.wavelength > 2.0 * self.dx, "wavelength must be longer than 2 dx")
        require(self.length > 0.0, "length must be positive")
        require(0.0 <= 2.0 * self.ramp <= self.length, "the ramps must fit into the length")

    def add_window(self, first: int, out: np.ndarray) -> None:
        """Add the heights of nodes first, first + 1, ... to ``out`` (shape (n,), m)."""
        x = (int(first) + np.arange(out.shape[0])) * self.dx - self.start
        if x[-1] <= 0.0 or x[0] >= self.length:
            return
        inside = np.clip(np.minimum(x, self.length - x), 0.0, None)
        weight = (inside > 0.0).astype(float)
        if self.ramp > 0.0:
            weight = 0.5 - 0.5 * np.cos(np.pi * np.minimum(inside / self.ramp, 1.0))
        out += self.amplitude * weight * np.sin(2.0 * np.pi * x / self.wavelength)

    def realise(self, *, dx: float, seed_override: int | None) -> Corrugation:  # noqa: ARG002
        """Return itself: nothing is random."""
        check_spacing(self.dx, dx)
        return self

    def covered(self) -> None:
        """Return None: defined for every x."""
        return

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description, and no arrays, for `wheelrail.excitation.sources.source_from_parts`."""
        return {"kind": self.kind, **{name: getattr(self, name) for name in self._SCALARS}}, {}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> Corrugation:  # noqa: ARG003
        """Inverse of :meth:`to_parts`."""
        return cls(**{name: meta[name] for name in cls._SCALARS})
