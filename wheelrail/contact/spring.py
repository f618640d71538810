"""Hertz spring with an equivalent roughness (Pieringer 2011, eq. 2.19 and section 5.1).

A spring has no extension, so it knows nothing of the contact filter: what roughness it feels is decided beforehand.

* ``none``: the roughness at the nominal contact point.
* ``average``: its mean over the nominal contact length.
* ``winkler``: what a Winkler bedding under the constant preload would feel: how much higher than on a smooth surface
  the wheel would ride (Ford and Thompson 2006).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .bedding import WinklerBedding
from .newton import solve_approach
from .solution import NormalSolution

__all__ = ["HertzSpring", "Prefilter", "averaging_weights"]

Prefilter = Literal["none", "average", "winkler"]


def averaging_weights(*, half_length: float, dx: float, nodes: int) -> NDArray:
    """Weights that average a piecewise linear line over -half_length < x < half_length exactly.

    Parameters
    ----------
    half_length : float
        m; at most (nodes - 1) dx / 2.
    dx : float
        Grid spacing in m.
    nodes : int
        Odd.

    Returns
    -------
    ndarray, shape (nodes,)
        They sum up to 1.
    """
    x = (np.arange(nodes) - nodes // 2) * dx
    # Integral of each node's hat function from -half_length to half_length, by its antiderivative.
    edge = np.clip((half_length - x[:, None] * np.array([1.0, -1.0])) / dx, -1.0, 1.0)
    part = np.where(edge < 0.0, 0.5 * (1.0 + edge) ** 2, 0.5 + edge - 0.5 * edge**2)
    return (part.sum(axis=1) - 1.0) * dx / (2.0 * half_length)


@dataclass(frozen=True)
class HertzSpring:
    """Non-linear spring between wheel and rail.

    Parameters
    ----------
    constant : float
        C_H in N/m^1.5.
    axis_constants : tuple of float
        Semi-axes in rolling and lateral direction over the cube root of the load, m/N^(1/3).
    nodes : int
        Number of roughness nodes, odd.
    weights : ndarray, shape (nodes,)
        The equivalent roughness is their product with the nodes (``none`` and ``average``).
    bedding : WinklerBedding or None
        For ``winkler``: gives the equivalent roughness under ``preload``.
    preload : float
        N, nominal.
    """

    constant: float
    axis_constants: tuple[float, float]
    nodes: int
    weights: NDArray
    bedding: WinklerBedding | None
    preload: float
    _smooth: float = field(init=False, repr=False, compare=False, default=0.0)

    def __post_init__(self) -> None:
        if self.bedding is not None:
            object.__setattr__(self, "_smooth", self._riding_height(np.zeros(self.nodes)))

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """Return a JSON-able description, and the array of weights."""
        meta = {
            "kind": "hertz",
            "constant": self.constant,
            "axis_constants": list(self.axis_constants),
            "nodes": self.nodes,
            "preload": self.preload,
            "bedding": None if self.bedding is None else self.bedding.to_parts()[0],
        }
        return meta, {"weights": self.weights}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> HertzSpring:
        """Rebuild it from `to_parts`."""
        return cls(
            constant=meta["constant"],
            axis_constants=tuple(meta["axis_constants"]),
            nodes=meta["nodes"],
            weights=arrays["weights"],
            bedding=None if meta["bedding"] is None else WinklerBedding.from_parts(meta["bedding"], {}),
            preload=meta["preload"],
        )

    def _riding_height(self, roughness: NDArray) -> float:
        assert self.bedding is not None
        return self.bedding.solve(roughness, weight=0.0, compliance=1.0, rhs=self.preload, guess=self._smooth).approach

    def equivalent_roughness(self, roughness: NDArray) -> float:
        """Roughness that the spring feels, in m, from that at the nodes."""
        if self.bedding is None:
            return float(self.weights @ roughness)
        return self._smooth - self._riding_height(roughness)

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
        """Solve the contact, see `wheelrail.contact.solution.NormalContact`."""
        del memory
        felt = self.equivalent_roughness(roughness)
        constant = self.constant

        def law(d: float) -> tuple[float, float]:
            depth = d + felt
            if depth <= 0.0:
                return 0.0, 0.0
            root = math.sqrt(depth)
            return constant * depth * root, 1.5 * constant * root

        approach, force, stiffness, iterations, residual = solve_approach(
            law, -felt, 1e-4, weight, compliance, rhs, guess
        )
        if force <= 0.0:
            return NormalSolution(0.0, approach, 0.0, 0.0, 0.0, 0.0, 0.0, iterations, residual)
        cube_root = force ** (1.0 / 3.0)
        a, b = self.axis_constants[0] * cube_root, self.axis_constants[1] * cube_root
        area = math.pi * a * b
        return NormalSolution(
            force, approach, stiffness, 2.0 * a, 2.0 * b, area, 1.5 * force / area, iterations, residual
        )
