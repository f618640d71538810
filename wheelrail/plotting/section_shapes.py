"""Displacements of a cross-section: its outline at rest and displaced, the motion out of the plane as colour."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.tri import Triangulation
from numpy.typing import NDArray

from .style import BLUE, GREY, INK, ORANGE

__all__ = ["OUT_OF_PLANE", "SectionDrawing", "draw_section"]

OUT_OF_PLANE = LinearSegmentedColormap.from_list("out of plane", [BLUE, "#FFFFFF", ORANGE])
"""Colours of the motion out of the plane, from -1 to 1."""

_LARGEST = 0.11  # of the section's size, drawn for the largest displacement in the plane


@dataclass(frozen=True, eq=False)
class SectionDrawing:
    """A section's mesh in the directions in which it is drawn.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        To the right and up, m.
    quads : ndarray of int, shape (m, 4)
        Points at the corners of each element, in turn.
    sides : ndarray of int, shape (k, 3)
        Points at the two ends and in the middle of each side of the boundary.
    """

    points: NDArray
    quads: NDArray
    sides: NDArray


def draw_section(axis: Axes, section: SectionDrawing, *, plane: NDArray, out: NDArray, title: str) -> None:
    """Draw one shape.

    Parameters
    ----------
    axis : Axes
    section : SectionDrawing
    plane : ndarray, shape (n, 2)
        Displacements to the right and up, in any scale.
    out : ndarray, shape (n,)
        Displacement out of the plane, in the same scale.
    title : str
    """
    largest = float(np.sqrt(np.sum(plane**2, axis=1) + out**2).max()) or 1.0
    size = float(np.ptp(section.points, axis=0).max())
    moved = section.points + plane * (_LARGEST * size / largest)
    corners = section.quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    axis.tripcolor(
        Triangulation(1e3 * moved[:, 0], 1e3 * moved[:, 1], corners),
        out / largest,
        cmap=OUT_OF_PLANE,
        vmin=-1.0,
        vmax=1.0,
        shading="gouraud",
        rasterized=True,
    )
    for points, colour, width, style in ((section.points, GREY, 0.6, ":"), (moved, INK, 0.8, "-")):
        lines = 1e3 * points[section.sides[:, [0, 2, 1]]]
        axis.add_collection(LineCollection(list(lines), colors=colour, linewidths=width, linestyles=style))
    axis.set_title(title, loc="center", fontsize=7.5)
    axis.set_aspect("equal")
    axis.set_axis_off()
    reach = 1e3 * _LARGEST * size
    low, high = 1e3 * section.points.min(axis=0), 1e3 * section.points.max(axis=0)
    axis.set_xlim(low[0] - reach, high[0] + reach)
    axis.set_ylim(low[1] - reach, high[1] + reach)
