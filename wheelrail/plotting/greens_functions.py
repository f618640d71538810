"""Figures of Green's functions between all directions."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .contact import arrange
from .receptances import DIRECTIONS
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, new_figure

__all__ = ["greens_components_figure"]

_LOOKS = ((BLUE, "-"), (ORANGE, "--"), (GREEN, "-."), (PURPLE, ":"))
_NEGLIGIBLE = 1e-9  # of the largest component
_MOST_POINTS = 3000


def greens_components_figure(
    *, functions: Mapping[str, NDArray], dt: float, shown: float | None = None, title: str
) -> Figure:
    """Draw Green's functions between three directions: rows are displacements, columns forces.

    Parameters
    ----------
    functions : mapping of str to ndarray, shape (n, 3, 3)
        Discretised, by the names in the legend; [sample, displacement, force], m/N.
    dt : float
        Time step in s.
    shown : float, optional
        Length in s of the part that is drawn; by default all of it.
    title : str

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        For more than 4 functions, which could not be told apart.
    """
    if len(functions) > len(_LOOKS):
        raise ValueError(f"{len(functions)} functions are refused: at most {len(_LOOKS)} can be told apart")
    figure, axes = new_figure(title, rows=9, height=6.4)
    arrange(figure, axes, rows=3, columns=3)
    longest = max(len(values) for values in functions.values()) * dt
    end = min(shown or longest, longest)
    largest = max(float(np.abs(values[1:]).max()) for values in functions.values()) if functions else 1.0
    lines = {}
    for axis, (i, j) in zip(axes, np.ndindex(3, 3), strict=True):
        drawn = False
        axis.axhline(0.0, color=GREY, linewidth=0.6)
        for (name, values), (colour, style) in zip(functions.items(), _LOOKS, strict=False):
            count = min(len(values), round(end / dt) + 1)
            # Per time instead of per step; the first sample, which is half a step's, is left out.
            one = values[1:count, i, j] / dt * 1e6
            if np.abs(one).max() <= _NEGLIGIBLE * largest / dt * 1e6:
                continue
            time = np.arange(1, count) * dt * 1e3
            every = max(1, len(one) // _MOST_POINTS) if len(one) > 10 * _MOST_POINTS else 1
            (lines[name],) = axis.plot(
                time[::every], one[::every], color=colour, linestyle=style, linewidth=0.9, label=name
            )
            drawn = True
        axis.set_title(f"$g_{{{DIRECTIONS[i]}{DIRECTIONS[j]}}}$", loc="left", fontsize=9.0)
        axis.set_xlim(0.0, end * 1e3)
        axis.ticklabel_format(axis="y", scilimits=(-2, 3))
        axis.yaxis.get_offset_text().set_fontsize(7.0)
        if not drawn:
            axis.text(0.5, 0.55, "zero", ha="center", transform=axis.transAxes, color=GREY, fontsize=8.0)
            axis.set_yticks([])
        if j == 0:
            axis.set_ylabel("µm/(N s)")
        if i == 2:
            axis.set_xlabel("Time / ms")
    figure.align_ylabels(axes[::3])
    if len(lines) > 1:
        figure.legend(handles=list(lines.values()), loc="outside lower center", ncols=4, fontsize=8.0, frameon=False)
    return figure
