"""What recipes of random roughness share: levels, repeat length and seed (numpy only: shipped in the FMU)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .sampled_heights import check_spacing, read_only, require
from .synthesis import HarmonicPlan, plan_harmonics, seed_words

__all__ = ["SpectrumRecipe"]


@dataclass(frozen=True, eq=False)
class SpectrumRecipe:
    """Third-octave levels, repeat length and seed.

    Parameters
    ----------
    wavelengths : ndarray, shape (bands,)
        Exact centre wavelengths, m.
    levels : ndarray, shape (bands,)
        Levels, dB re 1 um.
    length : float
        Repeat length, m, rounded to whole grid steps (wheel: the circumference).
    seed : int
        Not negative. Recipes of equal seed on wheel and rail are independent.
    dx : float
        Grid spacing, m.
    on : {"wheel", "rail"}
        Surface that carries it.
    name : str
        What a message calls it.
    """

    wavelengths: np.ndarray
    levels: np.ndarray
    length: float
    seed: int
    dx: float
    on: str
    name: str

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

    def plan(self, *, dx: float, seed_override: int | None) -> tuple[HarmonicPlan, list[int]]:
        """Amplitudes of the harmonics, and the seed words of their phases.

        Parameters
        ----------
        dx : float
            Grid spacing, m; must be the recipe's.
        seed_override : int or None
            Another realisation of the whole case: combined with the own seed, so that sources stay independent.
        """
        check_spacing(self.dx, dx)
        words = seed_words(seed=self.seed, on=self.on, override=seed_override)
        return plan_harmonics(wavelengths=self.wavelengths, levels=self.levels, count=self.count, dx=self.dx), words

    def refuse_heights(self) -> None:
        """Say that a recipe has no heights yet (``RuntimeError``)."""
        raise RuntimeError(f"{self.name}: realise() the spectrum before asking for heights")

    def covered(self) -> None:
        """Return None: defined for every x."""
        return

    def scalars(self) -> dict[str, Any]:
        """JSON-able numbers and words."""
        return {
            "length": float(self.length),
            "seed": int(self.seed),
            "dx": float(self.dx),
            "on": self.on,
            "name": self.name,
        }
