"""Wheel flats, rail joints, dents: a shape in a bounded stretch (numpy only: shipped in the FMU).

The shape belongs to the profile: it is evaluated in the whole contact zone at every step, at the rolled distance as it
is. A turn of the wheel need not be a whole number of grid steps, so nothing drifts over many turns.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from .lateral_interpolation import lateral_weights
from .sampled_heights import check_spacing, read_only, require

__all__ = ["Irregularity"]


@dataclass(frozen=True, eq=False)
class Irregularity:
    """A shape on wheel or rail that is level outside of a bounded stretch.

    Parameters
    ----------
    positions : ndarray, shape (n,)
        Along the surface from the shape's origin, m, increasing. Heights are linear in between; beyond the first and
        the last they stay as they are there.
    heights : ndarray, shape (lines, n)
        Positive outward from the material, m.
    lateral : ndarray, shape (lines,)
        Positions of the lines across the surface, m, increasing; heights are linear in between and constant beyond.
        With one line the shape is the same all across.
    on : {"wheel", "rail"}
        Surface that carries it.
    origin : float
        Rolled distance x at which the origin passes the nominal contact point, m.
    period : float or None
        Distance after which it comes again, m: a turn of the wheel. None: once.
    stretch : float
        Factor on distances from the nominal contact point: sqrt(R / R') for a contact model whose wheel has the radius
        R' instead of R, so that x^2 / 2R and the shape meet as they do under the real wheel. See
        `wheelrail.excitation.view`.
    dx : float
        Grid spacing, m.
    name : str
        What a message calls it.
    """

    positions: np.ndarray
    heights: np.ndarray
    lateral: np.ndarray
    on: str
    origin: float
    period: float | None
    stretch: float
    dx: float
    name: str
    kind: str = field(default="irregularity", init=False)
    _level: float | None = field(init=False, repr=False)

    _SCALARS: ClassVar = ("on", "origin", "period", "stretch", "dx", "name")

    def __post_init__(self) -> None:
        positions, heights, lateral = (read_only(a) for a in (self.positions, self.heights, self.lateral))
        require(positions.ndim == 1 and len(positions) >= 2, "at least two positions")
        require(bool(np.all(np.isfinite(positions)) and np.all(np.diff(positions) > 0.0)), "positions must increase")
        require(heights.shape == (len(lateral), len(positions)), "heights must be of shape (lines, positions)")
        require(bool(np.all(np.isfinite(heights))), "heights must be finite")
        require(lateral.ndim == 1 and len(lateral) >= 1, "at least one line")
        require(bool(np.all(np.isfinite(lateral)) and np.all(np.diff(lateral) > 0.0)), "lateral must increase")
        require(self.on in ("wheel", "rail"), "on must be 'wheel' or 'rail'")
        require(self.dx > 0.0 and self.stretch > 0.0, "dx and stretch must be positive")
        if self.period is not None:
            require(positions[-1] - positions[0] <= self.period, "the shape must fit into its period")
            require(bool(np.allclose(heights[:, 0], heights[:, -1])), "a shape that repeats must end as it begins")
        for name, array in (("positions", positions), ("heights", heights), ("lateral", lateral)):
            object.__setattr__(self, name, array)
        # Most steps are far from the shape, where it has one height all along.
        object.__setattr__(self, "_level", float(heights[0, 0]) if np.ptp(heights[:, 0]) == 0.0 else None)

    @property
    def across(self) -> bool:
        """Whether it differs across the surface: then :meth:`add_surface` answers, else :meth:`add_window`."""
        return len(self.lateral) > 1

    def _along(self, first: int, nodes: int) -> np.ndarray | None:
        """Positions of nodes in the shape's own coordinate; None if all lie where it is level before it."""
        half = nodes // 2
        x = (int(first) + half) * self.dx - self.origin
        reach = half * self.dx * self.stretch
        if self.period is None:
            if self._level is not None and x + reach <= self.positions[0]:
                return None
        else:
            middle = 0.5 * (self.positions[0] + self.positions[-1])
            # The copy of the shape whose middle is nearest.
            x -= self.period * math.floor((x - middle) / self.period + 0.5)
            away = x + reach <= self.positions[0] or x - reach >= self.positions[-1]
            if self._level is not None and away:
                return None
        return x + (np.arange(nodes) - half) * (self.dx * self.stretch)

    def add_window(self, first: int, out: np.ndarray) -> None:
        """Add the heights at nodes first, first + 1, ... to ``out`` (shape (n,), m); of a shape with one line."""
        along = self._along(first, out.shape[0])
        out += self._level if along is None else np.interp(along, self.positions, self.heights[0])

    def add_surface(self, first: int, y_wheel: np.ndarray, y_rail: np.ndarray, out: np.ndarray) -> None:
        """Add the heights at nodes first, first + 1, ... along and at given positions across.

        Parameters
        ----------
        first : int
            Node of the first column.
        y_wheel, y_rail : ndarray, shape (rows,)
            Positions on wheel and rail, m.
        out : ndarray, shape (rows, nodes)
            Changed in place; m.
        """
        along = self._along(first, out.shape[1])
        if along is None:
            out += self._level
            return
        lines = np.array([np.interp(along, self.positions, line) for line in self.heights])
        out += lateral_weights(self.lateral, y_wheel if self.on == "wheel" else y_rail) @ lines

    def realise(self, *, dx: float, seed_override: int | None) -> Irregularity:  # noqa: ARG002
        """Return itself: nothing is random."""
        check_spacing(self.dx, dx)
        return self

    def covered(self) -> None:
        """Return None: defined for every x."""
        return

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description and arrays, for `wheelrail.excitation.sources.source_from_parts`."""
        meta = {"kind": self.kind, **{name: getattr(self, name) for name in self._SCALARS}}
        return meta, {"positions": self.positions, "heights": self.heights, "lateral": self.lateral}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> Irregularity:
        """Inverse of :meth:`to_parts`."""
        scalars = {name: meta[name] for name in cls._SCALARS}
        return cls(positions=arrays["positions"], heights=arrays["heights"], lateral=arrays["lateral"], **scalars)
