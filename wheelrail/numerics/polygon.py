"""Simple polygons: order, self-intersection, points inside, and places along the outline."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Outline", "clean_polygon", "is_inside", "polygon_area"]


def polygon_area(points: NDArray) -> float:
    """Return the area that a polygon of shape (n, 2) encloses, positive when it runs anticlockwise."""
    x, y = points.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def clean_polygon(points: ArrayLike) -> NDArray:
    """Check a polygon and turn it anticlockwise.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Corners in turn; the first may be repeated at the end.

    Returns
    -------
    ndarray, shape (m, 2)
        Without repeated points.

    Raises
    ------
    ValueError
        If it isn't a simple polygon: fewer than three points, values that aren't finite, sides that cross or touch.
    """
    points = np.asarray(points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"an outline needs two columns of coordinates; it has the shape {points.shape}")
    if not np.all(np.isfinite(points)):
        raise ValueError("an outline's coordinates must be finite numbers")
    extent = np.ptp(points, axis=0).max(initial=0.0)
    repeated = np.hypot(*(points - np.roll(points, 1, axis=0)).T) <= 1e-9 * extent
    points = points[~repeated]
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False) if len(points) else np.zeros(2)
    if len(points) < 3 or spread[-1] <= 1e-9 * extent:
        raise ValueError("an outline needs at least three points that enclose an area")
    crossing = _crossing(points)
    if crossing is not None:
        first, second = points[crossing[0]], points[crossing[1]]
        raise ValueError(
            f"the outline crosses or touches itself: the side from ({first[0]:g}, {first[1]:g}) meets "
            f"the one from ({second[0]:g}, {second[1]:g})"
        )
    return points if polygon_area(points) > 0.0 else points[::-1].copy()


def _crossing(points: NDArray) -> tuple[int, int] | None:
    """Return two sides that share a point though they aren't neighbours, or that fold back on each other."""
    start, end = points, np.roll(points, -1, axis=0)
    along = end - start
    folded = np.roll(along, -1, axis=0)
    turn = along[:, 0] * folded[:, 1] - along[:, 1] * folded[:, 0]
    back = (np.abs(turn) <= 1e-9 * np.hypot(*along.T) * np.hypot(*folded.T)) & (np.sum(along * folded, axis=1) < 0.0)
    if back.any():
        i = int(np.argmax(back))
        return i, (i + 1) % len(points)
    for i in range(len(points) - 2):
        others = slice(i + 2, len(points) - (1 if i == 0 else 0))
        c, d = start[others], end[others]
        lowest, highest = np.minimum(start[i], end[i]), np.maximum(start[i], end[i])
        near = np.all((np.minimum(c, d) <= highest) & (np.maximum(c, d) >= lowest), axis=1)
        if not near.any():
            continue
        c, d = c[near], d[near]
        sides = _side(start[i], end[i], c) * _side(start[i], end[i], d)
        others_sides = _side(c, d, start[i]) * _side(c, d, end[i])
        hit = (sides <= 0.0) & (others_sides <= 0.0)
        if hit.any():
            return i, int(np.arange(len(points))[others][near][np.argmax(hit)])
    return None


def _side(a: NDArray, b: NDArray, point: NDArray) -> NDArray:
    """Sign of the side of the line ab on which a point lies."""
    along, to = b - a, point - a
    return np.sign(along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0])


def is_inside(polygon: NDArray, points: NDArray) -> NDArray:
    """Return which of the points, shape (n, 2), lie inside a polygon; shape (n,)."""
    x, y = points[:, 0], points[:, 1]
    inside = np.zeros(len(points), dtype=bool)
    for (xa, ya), (xb, yb) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        if ya != yb:
            between = (ya > y) != (yb > y)
            inside ^= between & (x < xa + (y - ya) * (xb - xa) / (yb - ya))
    return inside


class Outline:
    """A closed polygon with the length along it.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        A clean polygon.

    Attributes
    ----------
    position : ndarray, shape (n + 1,)
        Length from the first corner to each, the last being the whole way round.
    turning : ndarray, shape (n,)
        Angle by which the outline turns at each corner, rad.
    """

    def __init__(self, points: NDArray) -> None:
        self.points = points
        self._closed = np.vstack([points, points[:1]])
        self.position = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self._closed, axis=0).T))])
        after = np.diff(self._closed, axis=0)
        before = np.roll(after, 1, axis=0)
        self.turning = np.arctan2(
            before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], np.sum(before * after, axis=1)
        )

    @property
    def length(self) -> float:
        """Length of the whole way round."""
        return float(self.position[-1])

    def at(self, position: ArrayLike) -> NDArray:
        """Return the points at given lengths from the first corner; shape (..., 2)."""
        wrapped = np.mod(position, self.length)
        return np.stack([np.interp(wrapped, self.position, column) for column in self._closed.T], axis=-1)
