"""Figure of contact filters: runs, theory, and a range that is plausible."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MultipleLocator
from numpy.typing import NDArray

from wheelrail.analysis.contact_filter import ContactFilter
from wheelrail.analysis.contact_filter_models import FilterTable

from .band_axis import wavelength_bands
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, legend, new_figure

__all__ = ["contact_filter_figure"]

_LOOKS = ((BLUE, "-", "o"), (ORANGE, "-", "s"), (GREEN, "-", "^"), (PURPLE, "-", "v"))
_THEORY = ("--", ":", "-.")


def contact_filter_figure(
    *,
    filters: Mapping[str, ContactFilter],
    speed: float,
    theory: Mapping[str, tuple[NDArray, NDArray]] | None = None,
    enclosing: tuple[FilterTable, FilterTable] | None = None,
    title: str,
) -> Figure:
    """Draw contact filters against wavelength, with the frequency above.

    Parameters
    ----------
    filters : mapping of str to ContactFilter
        One to four, by the names in the legend.
    speed : float
        m/s.
    theory : mapping of str to (wavelengths, levels), optional
        Up to three filters in m and dB, by the names in the legend.
    enclosing : tuple of two FilterTable, optional
        Drawn as a range.
    title : str

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        No filter, or more than can be told apart.
    """
    theory = theory or {}
    if not 1 <= len(filters) <= len(_LOOKS) or len(theory) > len(_THEORY):
        raise ValueError(f"one to {len(_LOOKS)} filters, and up to {len(_THEORY)} of theory, can be drawn")
    figure, (axis,) = new_figure(title, rows=1, height=4.2)
    waves = np.concatenate([one.wavelengths for one in filters.values()])
    shown = (waves.min(), waves.max())
    if enclosing is not None:
        weak, strong = enclosing
        axis.fill_between(
            1e3 * weak.wavelengths,
            weak.levels,
            strong.levels,
            color="#DDDDDD",
            linewidth=0,
            label=f"CNOSSOS, {1e-3 * weak.load:g} to {1e-3 * strong.load:g} kN",
        )
    lowest = 0.0
    for (name, one), (colour, line, marker) in zip(filters.items(), _LOOKS, strict=False):
        axis.plot(
            1e3 * one.wavelengths,
            one.levels,
            color=colour,
            linestyle=line,
            marker=marker,
            markersize=3.5,
            linewidth=1.2,
            label=name,
        )
        lowest = min(lowest, float(np.nanmin(one.levels)))
    for (name, (wavelengths, levels)), style in zip(theory.items(), _THEORY, strict=False):
        axis.plot(1e3 * wavelengths, levels, color=GREY, linestyle=style, linewidth=1.1, label=name)
    wavelength_bands(axis, np.array(shown))
    axis.set_ylim(5.0 * np.floor(lowest / 5.0 - 0.5), 5.0)
    axis.yaxis.set_major_locator(MultipleLocator(5.0))
    axis.set_ylabel("Contact filter / dB")

    def other(x: Any) -> Any:
        """Frequency of a wavelength in mm, and the other way round; matplotlib asks for 0 as well."""
        return 1e3 * speed / np.maximum(x, 1e-12)

    above = axis.secondary_xaxis("top", functions=(other, other))
    above.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    above.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    above.xaxis.set_minor_formatter(FuncFormatter(lambda *_: ""))
    above.set_xlabel(f"Frequency at {3.6 * speed:.4g} km/h / Hz", fontsize=9.0)
    above.tick_params(labelsize=8.0, direction="in", which="both", color=GREY)
    axis.tick_params(which="both", top=False)
    legend(axis, loc="lower left")
    return figure
