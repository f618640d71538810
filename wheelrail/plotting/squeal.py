"""Figures of squeal: the history of the lateral force, its stick/slip cycle, its spectrum."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from wheelrail.analysis.squeal import amplitude_spectrum

from .receptances import mark_frequencies
from .style import BLUE, GREEN, GREY, ORANGE, legend, new_figure

__all__ = ["squeal_figure", "squeal_spectrum_figure"]

_CYCLES = 4.0  # shown
_RANGE = 100.0  # dB below the highest level
_STICK = "#D9EAF5"


def squeal_figure(
    *,
    time: NDArray,
    force: NDArray,
    bound: NDArray,
    slip_fraction: NDArray,
    frequency: float,
    start: float | None = None,
    title: str,
) -> Figure:
    """Draw the lateral force and its stick/slip cycle (Pieringer 2011, figs. 5.3 and 5.4).

    Parameters
    ----------
    time : ndarray, shape (n,)
        Equidistant, s.
    force : ndarray, shape (n,)
        Lateral contact force on the rail, N.
    bound : ndarray, shape (n,)
        Friction coefficient times normal force, N.
    slip_fraction : ndarray, shape (n,)
        Slipping share of the contact area.
    frequency : float
        Of the cycle, Hz; four of them are drawn.
    start : float, optional
        Where the drawn cycles start in s; by default the last ones of the run are drawn.
    title : str

    Returns
    -------
    Figure
    """
    figure, (whole, cycle, stick) = new_figure(title, rows=3, height=6.2, height_ratios=(1.0, 1.3, 0.6))
    length = _CYCLES / frequency
    first = time[-1] - length if start is None else start
    shown = (time >= first) & (time <= first + length)
    whole.plot(time, force * 1e-3, color=BLUE, linewidth=0.6)
    whole.axvspan(first, first + length, color="#E0E0E0", zorder=0.5)
    whole.set_xlim(float(time[0]), float(time[-1]))
    whole.set_xlabel("Time / s")
    whole.set_ylabel("$F_y$ / kN")
    side = math.copysign(1.0, float(np.mean(force)))
    local = (time[shown] - first) * 1e3
    cycle.plot(local, force[shown] * 1e-3, color=BLUE, linewidth=1.2, label="lateral force $F_y$")
    name = r"traction bound $\mu F_z$" if side > 0.0 else r"traction bound $-\mu F_z$"
    cycle.plot(local, side * bound[shown] * 1e-3, color=GREY, linewidth=1.2, linestyle="--", label=name)
    sticking = 100.0 * (1.0 - slip_fraction[shown])
    stick.fill_between(local, sticking, color=GREEN, alpha=0.35, linewidth=0.0, step="mid")
    stick.step(local, sticking, where="mid", color=GREEN, linewidth=1.0)
    stick.set_ylim(0.0, max(5.0, 1.15 * float(sticking.max(initial=0.0))))
    stick.set_ylabel("Stick / %")
    for i, (begin, end) in enumerate(_stretches(sticking > 0.0)):
        half = 0.5e3 * (time[1] - time[0])
        label = "part of the contact sticks" if i == 0 else None
        cycle.axvspan(local[begin] - half, local[end] + half, color=_STICK, linewidth=0.0, zorder=0.4, label=label)
    cycle.set_ylabel("Force / kN")
    low, high = cycle.get_ylim()
    cycle.set_ylim(low, high + 0.25 * (high - low))
    legend(cycle, loc="upper center", ncols=3)
    for axis in (cycle, stick):
        axis.set_xlim(0.0, length * 1e3)
    cycle.tick_params(labelbottom=False)
    stick.set_xlabel(f"Time after {first:.6g} s / ms")
    figure.align_ylabels([whole, cycle, stick])
    return figure


def _stretches(flags: NDArray) -> list[tuple[int, int]]:
    """First and last place of each stretch of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]])))
    return [(int(begin), int(end) - 1) for begin, end in zip(edges[::2], edges[1::2], strict=True)]


def squeal_spectrum_figure(
    *,
    force: NDArray,
    dt: float,
    modes: Mapping[str, float] | None = None,
    highest: float | None = None,
    title: str,
) -> Figure:
    """Draw the narrow-band spectrum of the lateral force with the modes of the wheel.

    Parameters
    ----------
    force : ndarray, shape (n,)
        N; its mean is taken out.
    dt : float
        Time step in s.
    modes : mapping of str to float, optional
        Frequencies of the wheel's modes in Hz, by name.
    highest : float, optional
        Hz; by default half the sampling frequency.
    title : str

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        For fewer than 16 samples.
    """
    if len(force) < 16:
        raise ValueError(f"{len(force)} samples are too few for a spectrum; at least 16 are needed")
    frequency, amplitude = amplitude_spectrum(force, dt=dt)
    level = 20.0 * np.log10(np.maximum(amplitude / math.sqrt(2.0), 1e-300))
    figure, (axis,) = new_figure(title, rows=1, height=3.8)
    end = min(highest or 0.5 / dt, 0.5 / dt)
    inside = (frequency > 0.0) & (frequency <= end)
    top = 10.0 * math.ceil(float(level[inside].max()) / 10.0 + 0.4)
    axis.plot(frequency[inside] / 1e3, level[inside], color=BLUE, linewidth=0.8)
    strongest = int(np.flatnonzero(inside)[np.argmax(level[inside])])
    axis.plot(frequency[strongest] / 1e3, level[strongest], marker="o", markersize=4.0, color=ORANGE)
    axis.annotate(
        f"{frequency[strongest]:.0f} Hz",
        (frequency[strongest] / 1e3, level[strongest]),
        xytext=(5, 2),
        textcoords="offset points",
        fontsize=8.0,
        color=ORANGE,
    )
    axis.set_xlim(0.0, end / 1e3)
    axis.set_ylim(max(top - _RANGE, min(float(level[inside].min()), top - 10.0)), top)
    axis.set_xlabel("Frequency / kHz")
    axis.set_ylabel("Level of $F_y$ / dB re 1 N")
    mark_frequencies(axis, {f"({name})": f / 1e3 for name, f in (modes or {}).items()})
    return figure
