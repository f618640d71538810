"""Figures of the contact force: its history, and its third-octave spectrum."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, MultipleLocator, NullLocator
from numpy.typing import NDArray

from wheelrail.analysis.third_octave import third_octave
from wheelrail.numerics.third_octave_bands import band_edges

from .style import BLUE, GREY, INK, ORANGE, legend, new_figure

__all__ = ["force_figure", "nominal_frequency", "spectrum_figure"]

_MOST_POINTS = 4000
_ZOOM_WITHOUT_SLEEPERS = 1.0  # m
_RANGE = 80.0  # dB below the highest level
_NOMINAL = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)


def force_figure(
    *,
    time: NDArray,
    position: NDArray,
    force: NDArray,
    load: float | None,
    sleeper_spacing: float | None,
    title: str,
) -> Figure:
    """Draw the history of the vertical contact force: all of it, and two sleeper bays around its largest deviation.

    Parameters
    ----------
    time : ndarray, shape (n,)
        s.
    position : ndarray, shape (n,)
        Along the rail from a sleeper, m.
    force : ndarray, shape (n,)
        N.
    load : float or None
        Static load in N; None: no line for it.
    sleeper_spacing : float or None
        m; None: a rail without sleepers.
    title : str

    Returns
    -------
    Figure
    """
    figure, (whole, zoom) = new_figure(title, rows=2, height=5.2)
    whole.plot(*_thinned(time, force * 1e-3), color=BLUE, linewidth=0.7, label="contact force")
    whole.set_xlabel("Time / s")
    whole.set_xlim(time[0], max(time[-1], time[0] + 1e-9))
    window = 2.0 * sleeper_spacing if sleeper_spacing else _ZOOM_WITHOUT_SLEEPERS
    shown = _window(position, force, window, sleeper_spacing)
    whole.axvspan(time[shown][0], time[shown][-1], color="#E8E8E8", zorder=0.5, label="range shown below")
    zoom.plot(position[shown], force[shown] * 1e-3, color=BLUE, linewidth=0.9, label="contact force")
    zoom.set_xlabel("Position along the rail / m")
    zoom.set_xlim(position[shown][0], max(position[shown][-1], position[shown][0] + 1e-9))
    if sleeper_spacing:
        _mark_sleepers(zoom, position[shown], sleeper_spacing)
    for axis in (whole, zoom):
        if load is not None:
            axis.axhline(load * 1e-3, color=ORANGE, linewidth=0.9, linestyle="--", label="static load")
        axis.set_ylabel("Contact force / kN")
        _room_above(axis)
        legend(axis, ncols=3, loc="upper right")
    return figure


def _room_above(axis: Axes) -> None:
    """Leave room for a legend above the curves, and show zero force where the wheel lifts off."""
    low, high = axis.get_ylim()
    axis.set_ylim(low, high + 0.22 * (high - low))


def _thinned(x: NDArray, y: NDArray) -> tuple[NDArray, NDArray]:
    """Keep the lowest and the highest value of each stretch, so that a long run draws fast and no peak is lost."""
    size = -(-len(x) // (_MOST_POINTS // 2))
    if size <= 2:
        return x, y
    stretches = np.arange(0, len(x), size)
    ends = np.append(stretches[1:], len(x))
    kept = np.array(
        [sorted((a + int(np.argmin(y[a:b])), a + int(np.argmax(y[a:b])))) for a, b in zip(stretches, ends, strict=True)]
    ).ravel()
    return x[kept], y[kept]


def _window(position: NDArray, force: NDArray, length: float, spacing: float | None) -> slice:
    """Rows of a stretch around the largest deviation from the mean; from sleeper to sleeper if there are any."""
    at = position[int(np.argmax(np.abs(force - force.mean())))]
    first = math.floor(at / spacing - 0.5) * spacing if spacing else at - 0.5 * length
    # At the ends of the run, the stretch keeps its length rather than its place between the sleepers.
    first = max(min(first, position[-1] - length), position[0])
    step = 1e-9 * length
    low = int(np.searchsorted(position, first - step))
    high = int(np.searchsorted(position, first + length + step))
    return slice(min(low, len(position) - 1), max(high, low + 1))


def _mark_sleepers(axis: Axes, position: NDArray, spacing: float) -> None:
    first, last = math.ceil(position[0] / spacing - 1e-9), math.floor(position[-1] / spacing + 1e-9)
    for number in range(first, last + 1):
        axis.axvline(number * spacing, color=GREY, linewidth=0.9, linestyle=":", zorder=1)
        axis.plot(
            [number * spacing],
            [0.03],
            marker="^",
            markersize=7,
            color=GREY,
            transform=axis.get_xaxis_transform(),
            clip_on=False,
            zorder=3,
            linestyle="none",
            label="sleeper" if number == first else None,
        )


def nominal_frequency(centre: float) -> str:
    """Name of a third-octave band, such as 31.5 or 2k, from its exact centre in Hz."""
    number = round(10.0 * math.log10(centre))
    value = _NOMINAL[number % 10] * 10.0 ** (number // 10)
    return f"{value / 1000:g}k" if value >= 1000.0 else f"{value:g}"


def spectrum_figure(*, force: NDArray, dt: float, title: str, marks: Mapping[str, float] | None = None) -> Figure:
    """Draw the third-octave spectrum of a force.

    Parameters
    ----------
    force : ndarray, shape (n,)
        N; its mean is taken out.
    dt : float
        Sampling interval in s.
    title : str
    marks : mapping of str to float, optional
        Frequencies in Hz to point out, by name.

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        If the record is too short for a single band.
    """
    spectrum = third_octave(force, spacing=dt)
    if not len(spectrum.centres):
        raise ValueError(f"{len(force)} samples are too few for a third-octave band")
    levels = spectrum.level(reference=1.0)
    figure, (axis,) = new_figure(title, rows=1, height=3.6)
    finite = levels[np.isfinite(levels)]
    top = 10.0 * math.ceil((finite.max() if len(finite) else 0.0) / 10.0 + 0.3)
    bottom = min(0.0, top - 10.0)
    if len(finite):
        bottom = max(bottom if finite.min() > 0.0 else 10.0 * math.floor(finite.min() / 10.0), top - _RANGE)
    # Bands without anything in them, at the ends, are not drawn.
    seen = np.flatnonzero(levels >= bottom)
    shown = slice(seen[0], seen[-1] + 1) if len(seen) else slice(None)
    centres, levels = spectrum.centres[shown], levels[shown]
    lower, upper = band_edges(centres)
    axis.stairs(
        np.maximum(levels, bottom),
        np.append(lower, upper[-1]),
        baseline=bottom,
        fill=True,
        color=BLUE,
        alpha=0.25,
        linewidth=0,
    )
    axis.stairs(np.maximum(levels, bottom), np.append(lower, upper[-1]), baseline=bottom, color=BLUE, linewidth=1.1)
    axis.set_xscale("log")
    axis.set_xlim(lower[0], upper[-1])
    axis.set_ylim(bottom, top)
    axis.yaxis.set_major_locator(MultipleLocator(10.0))
    # Octaves are named, the bands between them only have a tick.
    octave = np.array([round(10.0 * math.log10(centre)) % 3 == 0 for centre in centres])
    axis.xaxis.set_major_locator(FixedLocator(list(centres[octave])))
    axis.xaxis.set_minor_locator(FixedLocator(list(centres[~octave])) if (~octave).any() else NullLocator())
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: nominal_frequency(value)))
    axis.xaxis.set_minor_formatter(FuncFormatter(lambda *_: ""))
    axis.set_xlabel("Third-octave band centre frequency / Hz")
    axis.set_ylabel("Contact force level / dB re 1 N")
    for name, frequency in (marks or {}).items():
        if lower[0] < frequency < upper[-1]:
            axis.axvline(frequency, color=ORANGE, linewidth=0.9, linestyle="--")
            axis.annotate(
                f"{name}\n{frequency:.3g} Hz",
                (frequency, top),
                xytext=(3, -3),
                textcoords="offset points",
                va="top",
                fontsize=7.5,
                color=INK,
            )
    return figure
