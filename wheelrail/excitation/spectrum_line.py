"""Recipe of a random line from third-octave levels (numpy only: shipped in the FMU)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from .line import Line
from .sampled_heights import check_spacing, read_only, require
from .synthesis import plan_harmonics, seed_words, synthesise

__all__ = ["SpectrumLine"]


@dataclass(frozen=True, eq=False)
class SpectrumLine:
    """Recipe of a random line: third-octave levels, repeat length and seed; :meth:`realise` makes the line.

    Parameters
    ----------
    wavelengths : ndarray, shape (bands,)
        Exact centre wavelengths, m.
    levels : ndarray, shape (bands,)
        Levels, dB re 1 um.
    length : float
        Repeat length, m, rounded to whole grid steps (wheel: the circumference).
    seed : int
        Not negative. Lines of equal seed on wheel and rail are independent.
    dx : float
        Grid spacing, m.
    on : {"wheel", "rail"}
        Surface that carries the line.
    name : str
        What a message calls the line.
    """

    wavelengths: np.ndarray
    levels: np.ndarray
    length: float
    seed: int
    dx: float
    on: str
    name: str
    kind: str = field(default="spectrum", init=False)
    across: ClassVar[bool] = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "wavelengths", read_only(self.wavelengths))
        object.__setattr__(self, "levels", read_only(self.levels))
        require(self.wavelengths.ndim == 1 and self.wavelengths.shape[0] > 0, "wavelengths must be non-empty and 1-D")
        require(self.levels.shape == self.wavelengths.shape, "one level per wavelength")
        require(bool(np.all(np.isfinite(self.wavelengths) & (self.wavelengths > 0.0))), "wavelengths must be positive")
        require(bool(np.all(np.isfinite(self.levels))), "levels must be finite")
        require(bool(np.isfinite(self.dx)) and self.dx > 0.0, "dx must be positive")
        require(bool(np.isfinite(self.length)) and self.length > 4.0 * self.dx, "length must be longer than 4 dx")
        require(int(self.seed) == self.seed and self.seed >= 0, "seed must be a whole number, not negative")
        require(self.on in ("wheel", "rail"), "on must be 'wheel' or 'rail'")

    @property
    def count(self) -> int:
        """Samples per repeat."""
        return round(self.length / self.dx)

    def add_window(self, first: int, out: np.ndarray) -> None:  # noqa: ARG002
        """Refuse: the line must be realised before (``RuntimeError``)."""
        raise RuntimeError(f"{self.name}: realise() the spectrum before asking for heights")

    def realise(self, *, dx: float, seed_override: int | None) -> Line:
        """Synthesise the line.

        Parameters
        ----------
        dx : float
            Grid spacing, m; must be the recipe's.
        seed_override : int or None
            Another realisation of the whole case: combined with the line's own seed, so lines stay independent.

        Returns
        -------
        Line
            Periodic, first node 0.
        """
        check_spacing(self.dx, dx)
        entropy = seed_words(seed=self.seed, on=self.on, override=seed_override)
        plan = plan_harmonics(wavelengths=self.wavelengths, levels=self.levels, count=self.count, dx=self.dx)
        values = synthesise(plan, count=self.count, entropy=entropy)
        return Line(values=values, first_index=0, dx=self.dx, periodic=True, name=self.name)

    def covered(self) -> None:
        """Return None: defined for every x."""
        return

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description and arrays, for :func:`source_from_parts`."""
        meta = {
            "kind": self.kind,
            "length": float(self.length),
            "seed": int(self.seed),
            "dx": float(self.dx),
            "on": self.on,
            "name": self.name,
        }
        return meta, {"wavelengths": self.wavelengths, "levels": self.levels}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> SpectrumLine:
        """Inverse of :meth:`to_parts`."""
        return cls(
            wavelengths=arrays["wavelengths"],
            levels=arrays["levels"],
            length=meta["length"],
            seed=meta["seed"],
            dx=meta["dx"],
            on=meta["on"],
            name=meta["name"],
        )
