"""Two-dimensional Winkler bedding between wheel and rail (Pieringer 2011, section 3.4.1).

Springs of stiffness k' per length lie under a wheel of reduced radius R'. Their deflection is

    z(x) = d + r(x) - x^2 / (2 R'),      F = integral of k' z over all x with z > 0.

Calibration for any ellipse: k' = 3 P / (4 a d), R' = a^2 / (2 d) from the Hertz solution (both independent of the load)
give Hertz' load, contact length and approach for every load; for R_wheel = r_rail they are eqs. 3.25 and 3.26.

Integration: the roughness is linear between its nodes, so that z is a parabola in each cell and the integral over its
positive part is exact. The sum over springs (eq. 3.29) tends to it as dx -> 0, but jumps whenever a node enters or
leaves the contact; here force and stiffness are continuous, and a smooth surface gives Hertz' force to rounding.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ContactGridError
from .newton import solve_approach
from .solution import NormalSolution

__all__ = ["WinklerBedding"]


@dataclass(frozen=True)
class WinklerBedding:
    """Bedding on a grid of roughness nodes.

    Parameters
    ----------
    stiffness : float
        k' in N/m2.
    radius : float
        R' in m.
    dx : float
        Grid spacing in m.
    nodes : int
        Number of nodes, odd.
    width_constant : float
        Lateral semi-axis of the Hertz ellipse over the cube root of the load, m/N^(1/3): gives width and area.
    """

    stiffness: float
    radius: float
    dx: float
    nodes: int
    width_constant: float
    _parabola: NDArray = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        x = (np.arange(self.nodes) - self.nodes // 2) * self.dx
        object.__setattr__(self, "_parabola", -(x**2) / (2.0 * self.radius))

    @classmethod
    def from_hertz(
        cls, *, load: float, semi_axis_x: float, semi_axis_y: float, approach: float, dx: float, nodes: int
    ) -> WinklerBedding:
        """Calibrate to a Hertz solution (N and m); the load may be any, the constants do not depend on it."""
        return cls(
            stiffness=0.75 * load / (semi_axis_x * approach),
            radius=semi_axis_x**2 / (2.0 * approach),
            dx=dx,
            nodes=nodes,
            width_constant=semi_axis_y / load ** (1.0 / 3.0),
        )

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """Return a JSON-able description, and no arrays."""
        return {"kind": "winkler", **{f.name: getattr(self, f.name) for f in fields(self) if f.init}}, {}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> WinklerBedding:
        """Rebuild it from `to_parts`."""
        del arrays
        return cls(**{name: value for name, value in meta.items() if name != "kind"})

    @property
    def rows(self) -> int:
        """One line along the rail."""
        return 1

    @property
    def lateral_offsets(self) -> NDArray:
        """Nothing across: shape (1,)."""
        return np.zeros(1)

    @property
    def memory(self) -> int:
        """Nothing is kept from step to step."""
        return 0

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
            If the contact reaches the edge of the grid.
        """
        del memory
        dx = self.dx
        curvature = 0.5 / self.radius
        z = roughness + self._parabola
        left = z[:-1]
        # In a cell the deflection is top - curvature (s - vertex)^2, s counted from its left node.
        vertex = (z[1:] - left) / (2.0 * dx * curvature) + 0.5 * dx
        top = left + curvature * vertex * vertex
        start, stop = -vertex, dx - vertex
        # First touch: the highest point of each cell's parabola that lies inside the cell.
        inside = np.minimum(np.maximum(0.0, start), stop)
        touch = -float((top - curvature * inside * inside).max())
        k, inverse, third = self.stiffness, 1.0 / curvature, curvature / 3.0
        length = 0.0

        def law(d: float) -> tuple[float, float]:
            nonlocal length
            h = top + d
            reach = np.sqrt(np.maximum(h, 0.0) * inverse)
            low = np.maximum(start, -reach)
            high = np.maximum(np.minimum(stop, reach), low)
            share = high - low
            length = float(share.sum())
            # Cell by cell, so that those without contact are exactly 0: a small force would drown in their rounding.
            area = float((h * share - third * (high * high * high - low * low * low)).sum())
            return k * area, k * length

        approach, force, stiffness, iterations, residual = solve_approach(
            law, touch, 1e-4, weight, compliance, rhs, guess
        )
        if approach + z[0] > 0.0 or approach + z[-1] > 0.0:
            self._refuse(approach, z)
        if force <= 0.0:
            return NormalSolution(0.0, approach, 0.0, 0.0, 0.0, 0.0, 0.0, iterations, residual)
        width = 2.0 * self.width_constant * force ** (1.0 / 3.0)
        area = 0.25 * math.pi * length * width
        return NormalSolution(force, approach, stiffness, length, width, area, 1.5 * force / area, iterations, residual)

    def _refuse(self, approach: float, z: NDArray) -> None:
        covered = (self.nodes - 1) * self.dx
        deepest = approach + float(z.max())
        needed = max(2.0 * math.sqrt(2.0 * self.radius * deepest), covered) * 1.2
        cells = 2 * math.ceil(0.5 * (needed / self.dx)) + 1
        raise ContactGridError(
            f"the contact reaches the edge of the potential contact area, {self.nodes} nodes at {self.dx:g} m = "
            f"+-{0.5 * covered:g} m; contact.length = {cells * self.dx:g} m or more is needed"
        )
