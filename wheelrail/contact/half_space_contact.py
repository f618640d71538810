"""Three-dimensional normal contact as the interaction uses it: rough surfaces on a half-space.

The undeformed distance is x^2 / (2 R_x) + y^2 / (2 R_y) - r(x, y) of crossed cylinders; or that of profiles, which then
comes with the heights.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..errors import ContactGridError
from .half_space import HalfSpace
from .normal import NormalProblem, NormalState, solve_normal
from .solution import NormalSolution

__all__ = ["HalfSpaceContact"]


@dataclass(frozen=True)
class HalfSpaceContact:
    """Normal contact on a grid of rectangular elements.

    Parameters
    ----------
    half_space : HalfSpace
    radius_x, radius_y : float
        Relative radii in rolling and in lateral direction, m; of profiles at the reference shift, for messages alone.
    profiles : bool
        The heights hold the undeformed distance of profiles.
    """

    half_space: HalfSpace
    radius_x: float
    radius_y: float
    profiles: bool = False

    _OWN: ClassVar = ("radius_x", "radius_y", "profiles")

    @property
    def nodes(self) -> int:
        """Number of roughness nodes: one for each column of elements."""
        return self.half_space.mx

    @property
    def rows(self) -> int:
        """Number of rows of elements across."""
        return self.half_space.my

    @property
    def lateral_offsets(self) -> NDArray:
        """Positions of the rows, m."""
        return self.half_space.y[:: self.half_space.mx].copy()

    @property
    def memory(self) -> int:
        """Numbers that it keeps from step to step: the pressures, its warm start."""
        return self.half_space.elements

    @cached_property
    def _smooth(self) -> NDArray:
        grid = self.half_space
        if self.profiles:
            return np.zeros(grid.elements)
        return grid.x**2 / (2.0 * self.radius_x) + grid.y**2 / (2.0 * self.radius_y)

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """Return a JSON-able description, and no arrays."""
        grid = self.half_space
        names = ("mx", "my", "dx", "dy", "shear_modulus", "poisson_ratio")
        meta = {name: getattr(grid, name) for name in names}
        own = {name: getattr(self, name) for name in self._OWN}
        return {"kind": "half-space", **own, **meta}, {}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> HalfSpaceContact:
        """Rebuild it from `to_parts`."""
        del arrays
        grid = {name: value for name, value in meta.items() if name not in ("kind", *cls._OWN)}
        return cls(HalfSpace(**grid), **{name: meta[name] for name in cls._OWN})

    def solve(
        self,
        roughness: NDArray,
        *,
        weight: float,
        compliance: float,
        rhs: float,
        guess: float,
        memory: NDArray | None = None,
    ) -> NormalSolution:
        """Solve the contact, see `wheelrail.contact.solution.NormalContact`.

        Raises
        ------
        ContactGridError
            If an element at the edge of the grid is in contact.
        """
        del guess
        grid = self.half_space
        distance = self._smooth - (np.tile(roughness, grid.my) if roughness.ndim == 1 else roughness.ravel())
        nearby = None if memory is None else np.flatnonzero(memory > 0.0)
        state = solve_normal(NormalProblem(grid, distance, weight, compliance, rhs), nearby)
        contact = state.contact
        if len(contact) == 0:
            return NormalSolution(0.0, state.approach, 0.0, 0.0, 0.0, 0.0, 0.0, state.iterations, state.residual, state)
        if grid.edge[contact].any():
            self._refuse(state, distance, rough=bool(np.ptp(roughness) > 0.0))
        iy, ix = np.divmod(contact, grid.mx)
        return NormalSolution(
            force=state.force,
            approach=state.approach,
            stiffness=state.stiffness,
            length=float(ix.max() - ix.min() + 1) * grid.dx,
            width=float(iy.max() - iy.min() + 1) * grid.dy,
            area=len(contact) * grid.element_area,
            pressure_max=float(state.pressure.max()),
            iterations=state.iterations,
            residual=state.residual,
            field=state,
        )

    def _refuse(self, state: NormalState, distance: NDArray, *, rough: bool) -> None:
        grid = self.half_space
        # The contact lies within the overlap of the undeformed bodies.
        depth = state.approach - float(distance.min())
        sizes = []
        words = "is enough"
        for key, radius, step, count in (
            ("length", self.radius_x, grid.dx, grid.mx),
            ("width", self.radius_y, grid.dy, grid.my),
        ):
            touches = self._touches(state, key)
            if self.profiles or rough:  # no radius tells how far they go on touching
                if not touches:
                    continue
                half, words = 0.7 * count * step, "may be enough"
            else:
                half = max(math.sqrt(2.0 * radius * depth), (0.6 if touches else 0.5) * count * step)
            sizes.append(f"contact.{key} = {(2 * math.ceil(half / step) + 3) * step:g} m")
        raise ContactGridError(
            f"the contact reaches the edge of the potential contact area, {grid.mx * grid.dx:g} m long and "
            f"{grid.my * grid.dy:g} m wide; {' and '.join(sizes)} {words}"
        )

    def _touches(self, state: NormalState, key: str) -> bool:
        iy, ix = np.divmod(state.contact, self.half_space.mx)
        index, count = (ix, self.half_space.mx) if key == "length" else (iy, self.half_space.my)
        return bool(index.min() == 0 or index.max() == count - 1)
