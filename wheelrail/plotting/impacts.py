"""Figure of impacts: how long a force is exceeded, and the largest and smallest of every wheel turn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator
from numpy.typing import NDArray

from wheelrail.analysis.impact_statistics import ImpactStatistics, Turn, exceedance

from .style import BLUE, GREY, ORANGE, legend, new_figure

__all__ = ["impacts_figure"]

_LEVELS = 400


def impacts_figure(*, force: NDArray, statistics: ImpactStatistics, turns: Sequence[Turn] = (), title: str) -> Figure:
    """Draw the share of time in which a force is exceeded, and below it the extremes of every turn.

    Parameters
    ----------
    force : ndarray, shape (n,)
        N; what ``statistics`` was found from.
    statistics : ImpactStatistics
    turns : sequence of Turn
        Without any, there are no axes for them.
    title : str

    Returns
    -------
    Figure
    """
    figure, axes = new_figure(title, rows=2 if turns else 1, height=5.4 if turns else 3.2)
    axis = axes[0]
    levels = np.linspace(statistics.smallest, statistics.largest, _LEVELS)
    # A little below the smallest force, which a steady one is always above.
    levels = np.append(levels[0] - 1e-6 * statistics.static_load, levels)
    share = exceedance(force, levels)
    seen = share > 0.0
    axis.plot(1e-3 * levels[seen], 100.0 * share[seen], color=BLUE, linewidth=1.3, label="contact force")
    axis.axvline(1e-3 * statistics.static_load, color=ORANGE, linewidth=0.9, linestyle="--", label="static load")
    axis.axvline(1e-3 * statistics.threshold, color=GREY, linewidth=0.9, linestyle=":", label="impact above")
    axis.set_yscale("log")
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_xlabel("Contact force / kN")
    axis.set_ylabel("Time above / %")
    legend(axis, loc="best")
    if turns:
        axis = axes[1]
        number = [turn.number + 1 for turn in turns]
        largest, smallest = ([1e-3 * getattr(turn, name) for turn in turns] for name in ("largest", "smallest"))
        axis.vlines(number, smallest, largest, color="#CCCCCC", linewidth=1.2)
        axis.plot(number, largest, color=BLUE, marker="^", markersize=4.5, linestyle="none", label="largest")
        axis.plot(number, smallest, color=GREY, marker="v", markersize=4.5, linestyle="none", label="smallest")
        axis.axhline(1e-3 * statistics.static_load, color=ORANGE, linewidth=0.9, linestyle="--", label="static load")
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
        axis.set_xlim(number[0] - 0.6, number[-1] + 0.6)
        low, high = axis.get_ylim()
        axis.set_ylim(low, high + 0.22 * (high - low))
        axis.set_xlabel("Wheel turn")
        axis.set_ylabel("Contact force / kN")
        legend(axis, ncols=3, loc="upper right")
    return figure
