"""Recipe of random parallel lines from third-octave levels and a coherence (numpy only: shipped in the FMU)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from .coherent_synthesis import synthesise_lines
from .sampled_heights import read_only, require
from .spectrum_recipe import SpectrumRecipe
from .surface_lines import SurfaceLines

__all__ = ["CoherentSpectrum"]


@dataclass(frozen=True, eq=False)
class CoherentSpectrum(SpectrumRecipe):
    """Recipe of random parallel lines, all with the same levels; :meth:`realise` makes the lines.

    Parameters
    ----------
    wavelengths, levels, length, seed, dx, on, name
        As of a `SpectrumRecipe`.
    lateral : ndarray, shape (lines,)
        Positions across, increasing, m: on the wheel from the tape circle, on the rail from its axis, to the field
        side.
    decay : float
        c of the coherence gamma^2 = exp(-2 c k |dy|), see `wheelrail.excitation.coherent_synthesis`; not negative, may
        be infinite.
    """

    lateral: np.ndarray
    decay: float
    kind: str = field(default="coherent-spectrum", init=False)
    across: ClassVar[bool] = True

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "lateral", read_only(self.lateral))
        object.__setattr__(self, "decay", float(self.decay))
        require(self.lateral.ndim == 1 and self.lateral.shape[0] > 0, "lateral must be non-empty and 1-D")
        require(
            bool(np.all(np.isfinite(self.lateral)) and np.all(np.diff(self.lateral) > 0.0)), "lateral must increase"
        )
        require(self.decay >= 0.0, "decay must not be negative")

    @property
    def lateral_range(self) -> tuple[float, float]:
        """Positions of the outermost lines, m; beyond them their heights continue."""
        return float(self.lateral[0]), float(self.lateral[-1])

    def add_surface(self, first: int, y_wheel: np.ndarray, y_rail: np.ndarray, out: np.ndarray) -> None:  # noqa: ARG002
        """Refuse: the lines must be realised before (``RuntimeError``)."""
        self.refuse_heights()

    def realise(self, *, dx: float, seed_override: int | None) -> SurfaceLines:
        """Synthesise the lines.

        Parameters
        ----------
        dx, seed_override
            As `SpectrumRecipe.plan` takes them.

        Returns
        -------
        SurfaceLines
            Periodic, first node 0.
        """
        plan, entropy = self.plan(dx=dx, seed_override=seed_override)
        values = synthesise_lines(
            plan, count=self.count, dx=self.dx, lateral=self.lateral, decay=self.decay, entropy=entropy
        )
        return SurfaceLines(
            values=values, lateral=self.lateral, first_index=0, dx=self.dx, periodic=True, on=self.on, name=self.name
        )

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description and arrays, for `wheelrail.excitation.sources.source_from_parts`."""
        # JSON knows no infinity.
        decay = self.decay if np.isfinite(self.decay) else "inf"
        arrays = {"wavelengths": self.wavelengths, "levels": self.levels, "lateral": self.lateral}
        return {"kind": self.kind, "decay": decay, **self.scalars()}, arrays

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> CoherentSpectrum:
        """Inverse of :meth:`to_parts`."""
        own = {name: meta[name] for name in ("length", "seed", "dx", "on", "name")}
        given = {name: arrays[name] for name in ("wavelengths", "levels", "lateral")}
        return cls(**given, decay=float(meta["decay"]), **own)
