"""The look that all figures share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

__all__ = ["BLUE", "GREEN", "GREY", "INK", "ORANGE", "PURPLE", "legend", "log_axis", "new_figure"]

# Okabe and Ito (2008), told apart with any kind of colour vision.
BLUE, ORANGE, GREEN, PURPLE = "#0072B2", "#D55E00", "#009E73", "#CC79A7"
GREY, INK = "#767676", "#222222"

WIDTH = 6.7  # in, the text width of a usual page
_SMALL, _TEXT, _TITLE = 8.0, 9.0, 10.0  # pt


def new_figure(
    title: str, *, rows: int, height: float, share_x: bool = False, height_ratios: Sequence[float] | None = None
) -> tuple[Figure, list[Axes]]:
    """Make a figure with axes below each other.

    Parameters
    ----------
    title : str
    rows : int
        Number of axes.
    height : float
        In inches.
    share_x : bool
        Only the last axes label their x axis.
    height_ratios : sequence of float, optional

    Returns
    -------
    figure : Figure
        Without any state of pyplot, so it works on every machine and in every thread.
    axes : list of Axes
    """
    figure = Figure(figsize=(WIDTH, height), dpi=160, layout="constrained")
    figure.get_layout_engine().set(h_pad=0.06, w_pad=0.06)  # type: ignore[union-attr]
    # A title of the case file may hold characters that start a formula.
    figure.suptitle(title.replace("$", r"\$"), fontsize=_TITLE, color=INK)
    grid: Any = figure.subplots(rows, 1, sharex=share_x, squeeze=False, height_ratios=height_ratios)
    axes = [row[0] for row in grid]
    for axis in axes:
        axis.tick_params(which="both", labelsize=_SMALL, direction="in", top=True, right=True, color=GREY)
        axis.grid(visible=True, which="major", color="#DDDDDD", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.xaxis.label.set_size(_TEXT)
        axis.yaxis.label.set_size(_TEXT)
        axis.title.set_size(_TEXT)
        for spine in axis.spines.values():
            spine.set_color(GREY)
            spine.set_linewidth(0.8)
    return figure, axes


def legend(axis: Axes, **where: Any) -> None:
    """Put a legend that stays legible over curves."""
    axis.legend(fontsize=_SMALL, framealpha=0.9, edgecolor="#DDDDDD", **where)


def log_axis(axis: Axes, lowest: float, highest: float, *, unit: str = "Hz") -> None:
    """Make a logarithmic frequency axis with plain numbers at 1, 2 and 5 times powers of ten."""
    axis.set_xscale("log")
    axis.set_xlim(lowest, highest)
    decades = 10.0 ** np.arange(np.floor(np.log10(lowest)), np.ceil(np.log10(highest)) + 1)
    ticks = np.outer(decades, [1.0, 2.0, 5.0]).ravel()
    axis.set_xticks(ticks[(ticks >= lowest * 0.999) & (ticks <= highest * 1.001)])
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.set_xlabel(f"Frequency / {unit}")
