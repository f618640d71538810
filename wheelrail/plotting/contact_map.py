"""A contact solution as plain arrays on the grid of elements, and the lines that figures need of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["ContactMap", "View", "border", "view_of"]

_MARGIN = 2  # elements around the contact

View = tuple[tuple[float, float], tuple[float, float]]
"""Limits of x and of y in mm."""


@dataclass(frozen=True)
class ContactMap:
    """Solution on the grid of elements, as plain arrays.

    Parameters
    ----------
    x : ndarray, shape (mx,)
        Centres in rolling direction, ascending with equal spacing, m.
    y : ndarray, shape (my,)
        Centres in lateral direction, m.
    pressure : ndarray, shape (my, mx)
        Pa.
    tractions : ndarray, shape (2, my, mx)
        Longitudinal and lateral, on the rail, Pa.
    contact, slipping : ndarray of bool, shape (my, mx)
        Elements in contact, and those of them that slip.
    friction : array_like
        Friction coefficient, or one for each element.

    Raises
    ------
    ValueError
        If a shape does not fit.
    """

    x: NDArray
    y: NDArray
    pressure: NDArray
    tractions: NDArray
    contact: NDArray
    slipping: NDArray
    friction: ArrayLike

    def __post_init__(self) -> None:
        shape = (len(self.y), len(self.x))
        if min(shape) < 2:
            raise ValueError(f"a map needs 2 elements or more in each direction, the grid has {shape[1]} x {shape[0]}")
        for name, expected in (
            ("pressure", shape),
            ("tractions", (2, *shape)),
            ("contact", shape),
            ("slipping", shape),
        ):
            found = np.shape(getattr(self, name))
            if found != expected:
                raise ValueError(f"{name} has the shape {found}; with this x and y it must be {expected}")

    @cached_property
    def bound(self) -> NDArray:
        """Traction bound in Pa, shape (my, mx)."""
        return np.asarray(self.friction, dtype=float) * self.pressure

    @cached_property
    def edges(self) -> tuple[NDArray, NDArray]:
        """Edges of the elements in mm, shapes (mx + 1,) and (my + 1,)."""
        return _edges(self.x), _edges(self.y)

    @property
    def slips(self) -> NDArray:
        """Elements that are in contact and slip, shape (my, mx) of bool."""
        return self.contact & self.slipping

    @property
    def centre_row(self) -> int:
        """Row of elements nearest to y = 0."""
        return int(np.argmin(np.abs(self.y)))


def _edges(centres: NDArray) -> NDArray:
    step = (centres[-1] - centres[0]) / (len(centres) - 1)
    return 1e3 * np.append(centres - 0.5 * step, centres[-1] + 0.5 * step)


def view_of(contact: NDArray, state: ContactMap) -> View:
    """Limits in mm of a square that shows all of ``contact``, shape (my, mx) of bool; without any, the whole grid."""
    x, y = state.edges
    rows, columns = np.flatnonzero(contact.any(axis=1)), np.flatnonzero(contact.any(axis=0))
    if not len(rows):
        rows, columns = np.arange(len(y) - 1), np.arange(len(x) - 1)
    sides, middles = [], []
    for used, edges in ((columns, x), (rows, y)):
        margin = _MARGIN * (edges[1] - edges[0])
        low, high = edges[used[0]] - margin, edges[used[-1] + 1] + margin
        sides.append(high - low)
        middles.append(0.5 * (low + high))
    half = 0.5 * max(sides)
    return (middles[0] - half, middles[0] + half), (middles[1] - half, middles[1] + half)


def border(mask: NDArray, x: NDArray, y: NDArray) -> list[NDArray]:
    """Segments between the elements of a mask, shape (my, mx), and the others; x and y are edges of elements."""
    padded = np.pad(mask, 1)
    across = padded[1:-1, 1:] != padded[1:-1, :-1]  # upright edges, shape (my, mx + 1)
    along = padded[1:, 1:-1] != padded[:-1, 1:-1]
    upright = [np.array([(x[j], y[i]), (x[j], y[i + 1])]) for i, j in np.argwhere(across)]
    return upright + [np.array([(x[j], y[i]), (x[j + 1], y[i])]) for i, j in np.argwhere(along)]
