"""Recipe of random parallel lines from third-octave levels and a coherence (numpy only: shipped in the FMU)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from .coherent_synthesis import synthesise_lines
from .sampled_heights import check_spacing, read_only, require
from .surface_lines import SurfaceLines
from .synthesis import plan_harmonics, seed_words

__all__ = ["CoherentSpectrum"]


@dataclass(frozen=True, eq=False)
class CoherentSpectrum:
    """Recipe of random parallel lines, all with the same levels; :meth:`realise` makes the lines.

    Parameters
    ----------
    wavelengths : ndarray, shape (bands,)
        Exact centre wavelengths, m.
    levels : ndarray, shape (bands,)
        Levels, dB re 1 um.
    lateral : ndarray, shape (lines,)
        Positions across, increasing, m: on the wheel from the tape circle, on the rail from its axis, to the field
        side.
    decay : float
        c of the coherence gamma^2 = exp(-2 c k |dy|), see `wheelrail.excitation.coherent_synthesis`; not negative, may
        be infinite.
    length : float
        Repeat length, m, rounded to whole grid steps (wheel: the circumference).
    seed : int
        Not negative. Lines of equal seed on wheel and rail are independent.
    dx : float
        Grid spacing, m.
    on : {"wheel", "rail"}
        Surface that carries the lines.
    name : str
        What a message calls the lines.
    """

    wavelengths: np.ndarray
    levels: np.ndarray
    lateral: np.ndarray
    decay: float
    length: float
    seed: int
    dx: float
    on: str
    name: str
    kind: str = field(default="coherent-spectrum", init=False)
    across: ClassVar[bool] = True

    def __post_init__(self) -> None:
        for name in ("wavelengths", "levels", "lateral"):
            object.__setattr__(self, name, read_only(getattr(self, name)))
        object.__setattr__(self, "decay", float(self.decay))
        require(self.wavelengths.ndim == 1 and self.wavelengths.shape[0] > 0, "wavelengths must be non-empty and 1-D")
        require(self.levels.shape == self.wavelengths.shape, "one level per wavelength")
        require(bool(np.all(np.isfinite(self.wavelengths) & (self.wavelengths > 0.0))), "wavelengths must be positive")
        require(bool(np.all(np.isfinite(self.levels))), "levels must be finite")
        require(self.lateral.ndim == 1 and self.lateral.shape[0] > 0, "lateral must be non-empty and 1-D")
        require(
            bool(np.all(np.isfinite(self.lateral)) and np.all(np.diff(self.lateral) > 0.0)), "lateral must increase"
        )
        require(self.decay >= 0.0, "decay must not be negative")
        require(bool(np.isfinite(self.dx)) and self.dx > 0.0, "dx must be positive")
        require(bool(np.isfinite(self.length)) and self.length > 4.0 * self.dx, "length must be longer than 4 dx")
        require(int(self.seed) == self.seed and self.seed >= 0, "seed must be a whole number, not negative")
        require(self.on in ("wheel", "rail"), "on must be 'wheel' or 'rail'")

    @property
    def count(self) -> int:
        """Samples per repeat."""
        return round(self.length / self.dx)

    @property
    def lateral_range(self) -> tuple[float, float]:
        """Positions of the outermost lines, m; beyond them their heights continue."""
        return float(self.lateral[0]), float(self.lateral[-1])

    def add_surface(self, first: int, y_wheel: np.ndarray, y_rail: np.ndarray, out: np.ndarray) -> None:  # noqa: ARG002
        """Refuse: the lines must be realised before (``RuntimeError``)."""
        raise RuntimeError(f"{self.name}: realise() the spectrum before asking for heights")

    def realise(self, *, dx: float, seed_override: int | None) -> SurfaceLines:
        """Synthesise the lines.

        Parameters
        ----------
        dx : float
            Grid spacing, m; must be the recipe's.
        seed_override : int or None
            Another realisation of the whole case: combined with the lines' own seed, so sources stay independent.

        Returns
        -------
        SurfaceLines
            Periodic, first node 0.
        """
        check_spacing(self.dx, dx)
        entropy = seed_words(seed=self.seed, on=self.on, override=seed_override)
        plan = plan_harmonics(wavelengths=self.wavelengths, levels=self.levels, count=self.count, dx=self.dx)
        values = synthesise_lines(
            plan, count=self.count, dx=self.dx, lateral=self.lateral, decay=self.decay, entropy=entropy
        )
        return SurfaceLines(
            values=values, lateral=self.lateral, first_index=0, dx=self.dx, periodic=True, on=self.on, name=self.name
        )

    def covered(self) -> None:
        """Return None: defined for every x."""
        return

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description and arrays, for `wheelrail.excitation.sources.source_from_parts`."""
        meta = {
            "kind": self.kind,
            # JSON knows no infinity.
            "decay": self.decay if np.isfinite(self.decay) else "inf",
            "length": float(self.length),
            "seed": int(self.seed),
            "dx": float(self.dx),
            "on": self.on,
            "name": self.name,
        }
        return meta, {"wavelengths": self.wavelengths, "levels": self.levels, "lateral": self.lateral}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> CoherentSpectrum:
        """Inverse of :meth:`to_parts`."""
        return cls(
            wavelengths=arrays["wavelengths"],
            levels=arrays["levels"],
            lateral=arrays["lateral"],
            decay=float(meta["decay"]),
            length=meta["length"],
            seed=meta["seed"],
            dx=meta["dx"],
            on=meta["on"],
            name=meta["name"],
        )
