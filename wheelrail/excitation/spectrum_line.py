"""Recipe of a random line from third-octave levels (numpy only: shipped in the FMU)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from .line import Line
from .spectrum_recipe import SpectrumRecipe
from .synthesis import synthesise

__all__ = ["SpectrumLine"]


@dataclass(frozen=True, eq=False)
class SpectrumLine(SpectrumRecipe):
    """Recipe of a random line; :meth:`realise` makes the line. Parameters are those of a `SpectrumRecipe`."""

    kind: str = field(default="spectrum", init=False)
    across: ClassVar[bool] = False

    def add_window(self, first: int, out: np.ndarray) -> None:  # noqa: ARG002
        """Refuse: the line must be realised before (``RuntimeError``)."""
        self.refuse_heights()

    def realise(self, *, dx: float, seed_override: int | None) -> Line:
        """Synthesise the line.

        Parameters
        ----------
        dx, seed_override
            As `SpectrumRecipe.plan` takes them.

        Returns
        -------
        Line
            Periodic, first node 0.
        """
        plan, entropy = self.plan(dx=dx, seed_override=seed_override)
        values = synthesise(plan, count=self.count, entropy=entropy)
        return Line(values=values, first_index=0, dx=self.dx, periodic=True, name=self.name)

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description and arrays, for :func:`source_from_parts`."""
        return {"kind": self.kind, **self.scalars()}, {"wavelengths": self.wavelengths, "levels": self.levels}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> SpectrumLine:
        """Inverse of :meth:`to_parts`."""
        own = {name: meta[name] for name in ("length", "seed", "dx", "on", "name")}
        return cls(wavelengths=arrays["wavelengths"], levels=arrays["levels"], **own)
