"""Figure of track decay rates beside the limits of a reference track."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from wheelrail.analysis.track_decay_rate import DecayRate, decay_rate_limit

from .band_axis import frequency_bands
from .style import BLUE, ORANGE, legend, new_figure

__all__ = ["decay_rate_figure"]

_LOOKS = {"vertical": (BLUE, "o"), "lateral": (ORANGE, "s")}


def decay_rate_figure(rates: Mapping[str, DecayRate], *, limits: bool = True, title: str) -> Figure:
    """Draw decay rates against frequency; bands in which the rate is an upper bound have a hollow mark.

    Parameters
    ----------
    rates : mapping of str to DecayRate
        By direction, as `wheelrail.analysis.track_decay_rate.track_decay_rate` gives them.
    limits : bool
        Draw the lower limits of EN ISO 3095 with them.
    title : str

    Returns
    -------
    Figure
    """
    figure, (axis,) = new_figure(title, rows=1, height=4.0)
    bands = np.concatenate([one.centres for one in rates.values()])
    for name, one in rates.items():
        colour, marker = _LOOKS[name]
        axis.plot(one.centres, one.rates, color=colour, linewidth=1.3, label=name)
        sure = one.measurable
        for kept, face, label in ((sure, colour, None), (~sure, "white", f"{name}, upper bound")):
            if np.any(kept):
                axis.plot(
                    one.centres[kept],
                    one.rates[kept],
                    color=colour,
                    marker=marker,
                    markersize=4.0,
                    markerfacecolor=face,
                    linestyle="none",
                    label=label,
                )
        if limits:
            centres, limit = decay_rate_limit(name)
            axis.plot(
                centres, limit, color=colour, linewidth=1.1, linestyle="--", label=f"{name}, EN ISO 3095 at least"
            )
    axis.set_yscale("log")
    low, high = axis.get_ylim()
    axis.set_ylim(min(low, 0.1), max(high, 20.0))
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    frequency_bands(axis, bands)
    axis.set_ylabel("Track decay rate / dB/m")
    legend(axis, loc="best")
    return figure
