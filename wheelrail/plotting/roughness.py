"""Figures of roughness: levels against wavelength with a limit, and the coherence of parallel lines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, MultipleLocator, NullLocator

from wheelrail.analysis.coherence import BandCoherence
from wheelrail.analysis.roughness_levels import BandLevels, LimitComparison

from .force import nominal_frequency
from .style import BLUE, GREY, INK, ORANGE, legend, new_figure

__all__ = ["coherence_figure", "roughness_figure"]

_LOWEST = -60.0  # dB; a band without anything in it is not drawn
_PAIRS_NAMED = 6


def _wavelength_axis(axis: Axes, wavelengths: np.ndarray) -> None:
    """Make the wavelength fall to the right, as EN 15610 presents spectra, with the bands' nominal names in mm."""
    bands = np.rint(10.0 * np.log10(1e3 * wavelengths)).astype(int)
    first, last = int(bands.min()), int(bands.max())
    axis.set_xscale("log")
    axis.set_xlim(10.0 ** ((last + 0.7) / 10.0), 10.0 ** ((first - 0.7) / 10.0))
    numbers = np.arange(first, last + 1)
    # Octaves are named, the bands between them only have a tick.
    named = numbers % 3 == 0
    axis.xaxis.set_major_locator(FixedLocator(list(10.0 ** (numbers[named] / 10.0))))
    between = list(10.0 ** (numbers[~named] / 10.0))
    axis.xaxis.set_minor_locator(FixedLocator(between) if between else NullLocator())
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: _nominal(value)))
    axis.xaxis.set_minor_formatter(FuncFormatter(lambda *_: ""))
    axis.set_xlabel("Third-octave band centre wavelength / mm")


def _nominal(wavelength: float) -> str:
    """Name of a band, such as 31.5 or 1250, from its exact centre in mm."""
    name = nominal_frequency(wavelength)
    return f"{1e3 * float(name[:-1]):g}" if name.endswith("k") else name


def roughness_figure(
    *, mean: BandLevels, lines: Sequence[BandLevels] = (), limit: LimitComparison | None = None, title: str
) -> Figure:
    """Draw roughness levels against wavelength.

    Parameters
    ----------
    mean : BandLevels
        Mean over lines, drawn thick.
    lines : sequence of BandLevels
        Single lines, drawn thin; a single one is the mean and isn't drawn again.
    limit : LimitComparison, optional
        Drawn with it; bands above it are marked.
    title : str

    Returns
    -------
    Figure
    """
    figure, (axis,) = new_figure(title, rows=1, height=4.0)
    if len(lines) > 1:
        for number, line in enumerate(lines):
            axis.plot(
                1e3 * line.wavelengths,
                _drawable(line.levels),
                color=GREY,
                linewidth=0.7,
                alpha=0.8,
                label=f"{len(lines)} lines" if number == 0 else None,
            )
    label = "mean over lines" if len(lines) > 1 else "line"
    axis.plot(1e3 * mean.wavelengths, _drawable(mean.levels), color=BLUE, linewidth=2.0, label=label)
    shown = mean.wavelengths
    if limit is not None:
        axis.plot(1e3 * limit.wavelengths, limit.limit, color=ORANGE, linewidth=1.4, linestyle="--", label="limit")
        if np.any(limit.exceeded):
            axis.plot(
                1e3 * limit.wavelengths[limit.exceeded],
                limit.levels[limit.exceeded],
                color=ORANGE,
                marker="o",
                markersize=4.5,
                markeredgecolor=INK,
                markeredgewidth=0.5,
                linestyle="none",
                zorder=4,
                label="above the limit",
            )
        shown = np.concatenate((shown, limit.wavelengths))
    _wavelength_axis(axis, shown)
    axis.yaxis.set_major_locator(MultipleLocator(10.0))
    axis.set_ylabel("Roughness level / dB re 1 µm")
    legend(axis, loc="best")
    return figure


def _drawable(levels: np.ndarray) -> np.ndarray:
    return np.where(levels > _LOWEST, levels, np.nan)


def coherence_figure(*, bands: BandCoherence, lateral: np.ndarray | None, title: str) -> Figure:
    """Draw the coherence of neighbouring lines against wavelength, and of all pairs by distance.

    Parameters
    ----------
    bands : BandCoherence
        Of two lines at least.
    lateral : ndarray, shape (lines,), or None
        Positions of the lines, increasing, m; None: neighbours only, without the distances.
    title : str

    Returns
    -------
    Figure
        Without positions one axis, else two.
    """
    count = bands.coherence.shape[1]
    rows = 1 if lateral is None else 2
    figure, axes = new_figure(title, rows=rows, height=3.4 if rows == 1 else 6.2)
    axis = axes[0]
    shades = np.linspace(1.0, 0.35, max(count - 1, 1))
    for i in range(count - 1):
        if lateral is None:
            label = f"lines {i + 1} and {i + 2}"
        else:
            label = f"y = {1e3 * lateral[i]:g} and {1e3 * lateral[i + 1]:g} mm"
        axis.plot(
            1e3 * bands.wavelengths,
            bands.coherence[:, i, i + 1],
            color=BLUE,
            alpha=shades[i],
            linewidth=1.2,
            label=label if i < _PAIRS_NAMED else None,
        )
    axis.plot(
        1e3 * bands.wavelengths,
        1.0 / bands.averages,
        color=GREY,
        linewidth=1.0,
        linestyle=":",
        label="expected of uncorrelated lines",
    )
    _wavelength_axis(axis, bands.wavelengths)
    axis.set_ylim(0.0, 1.02)
    axis.set_ylabel("Coherence of neighbours")
    legend(axis, loc="best")
    if lateral is not None:
        _distance_map(figure, axes[1], bands, lateral)
    return figure


def _distance_map(figure: Figure, axis: Axes, bands: BandCoherence, lateral: np.ndarray) -> None:
    """Mean coherence of the pairs of each distance, as a map over wavelength."""
    one, other = np.triu_indices(len(lateral), k=1)
    # Distances of printed positions, in whole micrometres.
    distances = np.rint(1e6 * (lateral[other] - lateral[one])).astype(int)
    steps = np.unique(distances)
    means = np.array([np.mean(bands.coherence[:, one[distances == d], other[distances == d]], axis=1) for d in steps])
    edges = np.append(1e3 * bands.wavelengths * 10.0**0.05, 1e3 * bands.wavelengths[-1] * 10.0**-0.05)
    mesh = axis.pcolormesh(edges, np.arange(len(steps) + 1), means, vmin=0.0, vmax=1.0, cmap="viridis", rasterized=True)
    axis.grid(visible=False)
    _wavelength_axis(axis, bands.wavelengths)
    axis.yaxis.set_major_locator(FixedLocator(list(np.arange(len(steps)) + 0.5)))
    axis.set_yticklabels([f"{d * 1e-3:g}" for d in steps])
    axis.set_ylabel("Distance of lines / mm")
    bar = figure.colorbar(mesh, ax=axis, label="Coherence")
    bar.ax.tick_params(labelsize=8)
