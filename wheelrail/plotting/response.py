"""Figures of what the model is made of: receptances and Green's functions."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, legend, log_axis, new_figure

__all__ = ["greens_figure", "receptance_figure"]

_LOOKS = ((BLUE, "-"), (ORANGE, "--"), (GREEN, "-."), (PURPLE, ":"))


def receptance_figure(*, frequency: NDArray, receptances: Mapping[str, NDArray], title: str) -> Figure:
    """Draw magnitude and phase of receptances.

    Parameters
    ----------
    frequency : ndarray, shape (n,)
        Hz.
    receptances : mapping of str to ndarray of complex, shape (n,)
        By the names in the legend; m/N, time factor exp(+i omega t).
    title : str

    Returns
    -------
    Figure
    """
    figure, (magnitude, phase) = new_figure(title, rows=2, height=5.4, share_x=True, height_ratios=(2.0, 1.0))
    for (name, values), (colour, style) in zip(receptances.items(), _LOOKS, strict=False):
        look = {"color": colour, "linestyle": style, "linewidth": 1.3}
        magnitude.plot(frequency, np.abs(values), label=name, **look)
        angle = np.degrees(np.angle(values))
        # A passive point receptance lies between -180 and 0 degrees; rounding must not wrap it to +180.
        phase.plot(frequency, np.where(angle > 90.0, angle - 360.0, angle), **look)
    magnitude.set_yscale("log")
    magnitude.set_ylabel("Receptance magnitude / (m/N)")
    legend(magnitude, loc="best")
    log_axis(phase, frequency[0], frequency[-1])
    phase.set_ylabel("Phase / °")
    phase.set_ylim(-190.0, 10.0)
    phase.yaxis.set_major_locator(MultipleLocator(45.0))
    return figure


def greens_figure(
    *,
    track_time: NDArray | None,
    track: Mapping[str, NDArray],
    wheel_time: NDArray | None,
    wheel: NDArray | None,
    shown: float,
    title: str,
) -> Figure:
    """Draw Green's functions: the track's moving ones with their decay, and the wheel's.

    Parameters
    ----------
    track_time : ndarray, shape (n,), or None
        s; None: a rigid track.
    track : mapping of str to ndarray, shape (n,)
        By the names in the legend; m/(N s).
    wheel_time, wheel : ndarray, shape (m,), or None
        s and m/(N s); None: a wheel without dynamics.
    shown : float
        Length in s of the first part of the track's functions that is drawn on a linear scale.
    title : str

    Returns
    -------
    Figure
    """
    rows = (2 if track_time is not None else 0) + (wheel_time is not None)
    figure, axes = new_figure(title, rows=max(rows, 1), height=0.6 + 2.3 * max(rows, 1))
    left = iter(axes)
    if track_time is not None:
        early, decay = next(left), next(left)
        peak = max(float(np.abs(values).max()) for values in track.values())
        for (name, values), (colour, style) in zip(track.items(), _LOOKS, strict=False):
            look = {"color": colour, "linestyle": style, "linewidth": 1.2, "label": name}
            first = track_time <= shown
            early.plot(track_time[first] * 1e3, values[first] * 1e6, **look)
            look["linestyle"] = "-"
            decay.plot(*_envelope(track_time * 1e3, np.abs(values) * 1e6), **look)
        early.axhline(0.0, color=GREY, linewidth=0.7)
        early.set_title("Track, moving with the contact: the first part", loc="left", fontsize=9.0)
        early.set_xlim(0.0, shown * 1e3)
        decay.set_title("Track: envelope over the whole memory", loc="left", fontsize=9.0)
        decay.set_yscale("log")
        decay.set_xlim(0.0, track_time[-1] * 1e3)
        decay.set_ylim(peak * 1e6 * 1e-5, peak * 1e6 * 2.0)
        for axis in (early, decay):
            axis.set_ylabel("$g$ / (µm/(N s))")
            axis.set_xlabel("Time since the impulse / ms")
            legend(axis, loc="upper right")
        decay.set_ylabel("$|g|$ / (µm/(N s))")
    if wheel_time is not None and wheel is not None:
        axis = next(left)
        axis.plot(wheel_time * 1e3, wheel * 1e6, color=GREEN, linewidth=1.2)
        axis.axhline(0.0, color=GREY, linewidth=0.7)
        axis.set_title("Wheel", loc="left", fontsize=9.0)
        axis.set_xlim(0.0, wheel_time[-1] * 1e3)
        axis.set_ylabel("$g$ / (µm/(N s))")
        axis.set_xlabel("Time since the impulse / ms")
    figure.align_ylabels(axes)
    if not rows:
        axes[0].text(0.5, 0.5, "rigid wheel on rigid track: no dynamics", ha="center", transform=axes[0].transAxes)
        axes[0].set_axis_off()
    return figure


def _envelope(time: NDArray, size: NDArray, points: int = 400) -> tuple[NDArray, NDArray]:
    """Largest value of each of ``points`` stretches."""
    if len(time) <= points:
        return time, size
    edges = np.linspace(0, len(time), points + 1).astype(int)
    return time[edges[:-1]], np.maximum.reduceat(size, edges[:-1])
