"""A profile as an exact curve: heights, slopes and curvatures at any lateral position (numpy only: shipped in the FMU).

A curve is a chain of pieces. Each is a polynomial, a circular arc, or the sum of both, so that the lines, arcs and
polynomials of standards are kept as they are, and a spline is a chain of cubics. Heights are positive along z, into the
rail: of a wheel the radius beyond that at the tape circle, of a rail the depth below the middle of its running surface.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Piece", "ProfileCurve"]

_SAMPLE_STEP = 1e-4  # m along the curve
_FINE_STEP = 1e-5  # m across, of the points that measure the way along it
_STEEP_END = 1e-6  # of an arc's radius: closer to where it stands upright, its slope stays finite


class Piece(NamedTuple):
    """One piece: sum_k coefficients[k] (y - origin)^k + bulge sqrt(radius^2 - (y - centre)^2).

    Attributes
    ----------
    start, end : float
        Lateral positions of its ends, m.
    coefficients : tuple of float
        Ascending powers, m^(1 - k).
    origin : float
        m.
    centre, radius : float
        Of the arc, m.
    bulge : int
        1: the arc's middle lies deepest; -1: its middle lies highest; 0: there is no arc.
    """

    start: float
    end: float
    coefficients: tuple[float, ...]
    origin: float = 0.0
    centre: float = 0.0
    radius: float = 1.0
    bulge: int = 0


@dataclass(frozen=True, eq=False)
class ProfileCurve:
    """Height over lateral position, piece by piece.

    Parameters
    ----------
    name : str
        What a message calls the profile.
    breaks : ndarray, shape (n + 1,)
        Ends of the pieces, increasing, m; where two pieces meet, the right one counts.
    coefficients : ndarray, shape (n, degree + 1)
        Ascending powers of y - origin, m^(1 - k).
    origins, centres, radii, bulges : ndarray, shape (n,)
        As those of a `Piece`.

    Raises
    ------
    ValueError
        If shapes don't fit, breaks don't increase, or a number isn't finite.
    """

    name: str
    breaks: NDArray
    coefficients: NDArray
    origins: NDArray
    centres: NDArray
    radii: NDArray
    bulges: NDArray

    _ARRAYS: ClassVar = ("breaks", "coefficients", "origins", "centres", "radii", "bulges")

    def __post_init__(self) -> None:
        for key in self._ARRAYS:
            values = np.array(getattr(self, key), dtype=float, order="C")
            values.flags.writeable = False
            if not np.all(np.isfinite(values)):
                raise ValueError(f"{key} of profile {self.name} must be finite")
            object.__setattr__(self, key, values)
        count = len(self.coefficients)
        per_piece = (self.origins, self.centres, self.radii, self.bulges)
        if self.coefficients.ndim != 2 or count == 0 or self.coefficients.shape[1] == 0:
            raise ValueError("coefficients must have the shape (pieces, degree + 1)")
        if self.breaks.shape != (count + 1,) or any(values.shape != (count,) for values in per_piece):
            raise ValueError("a profile of n pieces needs n + 1 breaks and n of each other number")
        if np.any(np.diff(self.breaks) <= 0.0):
            raise ValueError("the breaks of a profile must increase")

    @classmethod
    def from_pieces(cls, name: str, pieces: Sequence[Piece]) -> ProfileCurve:
        """Join pieces that follow each other in y.

        Raises
        ------
        ValueError
            If a piece does not start where the one before ends.
        """
        if any(before.end != piece.start for before, piece in pairwise(pieces)):
            raise ValueError("the pieces of a profile must follow each other")
        width = max(len(piece.coefficients) for piece in pieces)
        return cls(
            name=name,
            breaks=np.array([pieces[0].start, *(piece.end for piece in pieces)]),
            coefficients=np.array(
                [[*piece.coefficients, *[0.0] * (width - len(piece.coefficients))] for piece in pieces]
            ),
            origins=np.array([piece.origin for piece in pieces]),
            centres=np.array([piece.centre for piece in pieces]),
            radii=np.array([piece.radius for piece in pieces]),
            bulges=np.array([piece.bulge for piece in pieces]),
        )

    @classmethod
    def from_polynomials(cls, name: str, breaks: ArrayLike, coefficients: ArrayLike) -> ProfileCurve:
        """Chain of polynomials without arcs, such as a spline.

        Parameters
        ----------
        name : str
        breaks : array_like, shape (n + 1,)
            m.
        coefficients : array_like, shape (n, degree + 1)
            Ascending powers of the distance from a piece's start, m^(1 - k).
        """
        breaks = np.asarray(breaks, dtype=float)
        count = len(breaks) - 1
        zeros = np.zeros(count)
        return cls(name, breaks, np.asarray(coefficients, dtype=float), breaks[:-1], zeros, np.ones(count), zeros)

    @property
    def start(self) -> float:
        """Lateral position of the end at the gauge side, m."""
        return float(self.breaks[0])

    @property
    def end(self) -> float:
        """Lateral position of the end at the field side, m."""
        return float(self.breaks[-1])

    def evaluate(self, y: ArrayLike) -> tuple[NDArray, NDArray, NDArray]:
        """Height and its first two derivatives.

        Parameters
        ----------
        y : array_like, any shape
            Lateral positions, m.

        Returns
        -------
        height, slope, second : ndarray, shape of y
            m, 1 and 1/m; nan beyond the ends of the profile.
        """
        y = np.asarray(y, dtype=float)
        outside = ~((y >= self.breaks[0]) & (y <= self.breaks[-1]))
        some_outside = bool(np.any(outside))
        if some_outside:
            y = np.where(outside, self.breaks[0], y)
        index = np.clip(np.searchsorted(self.breaks, y, side="right") - 1, 0, len(self.origins) - 1)
        offset = y - self.origins[index]
        columns = self.coefficients[index]
        height, slope, second = (np.zeros(y.shape) for _ in range(3))
        for k in range(columns.shape[-1] - 1, -1, -1):  # Horner's scheme, for all derivatives at once
            second = second * offset + slope
            slope = slope * offset + height
            height = height * offset + columns[..., k]
        second = 2.0 * second
        bulge = self.bulges[index]
        if np.any(bulge != 0.0):
            radius = self.radii[index]
            along = y - self.centres[index]
            inside = radius**2 - along**2
            height = height + bulge * np.sqrt(np.maximum(inside, 0.0))
            root = np.sqrt(np.maximum(inside, (_STEEP_END * radius) ** 2))
            slope = slope - bulge * along / root
            second = second - bulge * radius**2 / root**3
        if some_outside:
            height, slope, second = (np.where(outside, np.nan, values) for values in (height, slope, second))
        return height, slope, second

    def height(self, y: ArrayLike) -> NDArray:
        """Heights, m; see `evaluate`."""
        return self.evaluate(y)[0]

    def slope(self, y: ArrayLike) -> NDArray:
        """Slopes dz/dy; see `evaluate`."""
        return self.evaluate(y)[1]

    def curvature(self, y: ArrayLike) -> NDArray:
        """Curvatures z'' / (1 + z'^2)^1.5 in 1/m: positive where the curve is convex to -z, as a rail's head is."""
        _, slope, second = self.evaluate(y)
        return second / (1.0 + slope**2) ** 1.5

    @cached_property
    def _table(self) -> tuple[list[float], list[tuple[Any, ...]]]:
        """Inner breaks and pieces as plain numbers, for `at`."""
        pieces = [
            (tuple(reversed(row)), origin, centre, radius, bulge)
            for row, origin, centre, radius, bulge in zip(
                self.coefficients.tolist(),
                self.origins.tolist(),
                self.centres.tolist(),
                self.radii.tolist(),
                self.bulges.tolist(),
                strict=True,
            )
        ]
        return self.breaks[1:-1].tolist(), pieces

    def at(self, y: float) -> tuple[float, float, float]:
        """Height, slope and second derivative at one position (m) of the profile: a fast `evaluate`."""
        inner, pieces = self._table
        coefficients, origin, centre, radius, bulge = pieces[bisect_right(inner, y)]
        offset = y - origin
        height = slope = second = 0.0
        for coefficient in coefficients:
            second = second * offset + slope
            slope = slope * offset + height
            height = height * offset + coefficient
        second *= 2.0
        if bulge:
            along = y - centre
            inside = radius * radius - along * along
            height += bulge * math.sqrt(max(inside, 0.0))
            root = math.sqrt(max(inside, (_STEEP_END * radius) ** 2))
            slope -= bulge * along / root
            second -= bulge * radius * radius / root**3
        return height, slope, second

    @cached_property
    def samples(self) -> tuple[NDArray, NDArray]:
        """Positions and heights of samples about 0.1 mm apart along the curve, all breaks included; m."""
        stretches = []
        for start, end in zip(self.breaks[:-1], self.breaks[1:], strict=True):
            # Closest at the ends, where an arc may stand upright.
            turn = np.linspace(0.0, np.pi, max(16, math.ceil((end - start) / _FINE_STEP)))
            fine = 0.5 * (start + end) - 0.5 * (end - start) * np.cos(turn)
            fine[[0, -1]] = start, end
            along = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(fine), np.diff(self.height(fine))))))
            count = math.ceil(along[-1] / _SAMPLE_STEP)
            stretches.append(np.interp(along[-1] * np.arange(count) / count, along, fine))
        y = np.concatenate([*stretches, self.breaks[-1:]])
        heights = self.height(y)
        y.flags.writeable = heights.flags.writeable = False
        return y, heights

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """JSON-able description and arrays, for `from_parts`."""
        return {"kind": "profile-curve", "name": self.name}, {key: getattr(self, key) for key in self._ARRAYS}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> ProfileCurve:
        """Inverse of `to_parts`."""
        return cls(name=str(meta["name"]), **{key: arrays[key] for key in cls._ARRAYS})
