"""Figures of slip-velocity dependent friction: laws, forces on several grids, tractions and slip along the contact."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .receptances import mark_frequencies
from .style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, legend, new_figure

__all__ = ["CentreLine", "centre_lines_figure", "force_by_grid_figure", "friction_laws_figure", "spectra_figure"]

_COLOURS = (BLUE, ORANGE, GREEN, PURPLE, INK)
_MARKERS = ("o", "s", "^", "d", "v")
_SMALL = 8.0  # pt
_RANGE = 80.0  # dB below the highest level


class CentreLine(NamedTuple):
    """Contact along its centre line.

    Attributes
    ----------
    label : str
    x : ndarray, shape (m,)
        m, in rolling direction.
    traction, bound : ndarray, shape (m,)
        Size of the tangential traction and what friction allows without slip, Pa.
    slip_speed : ndarray, shape (m,)
        m/s.
    """

    label: str
    x: NDArray
    traction: NDArray
    bound: NDArray
    slip_speed: NDArray


def friction_laws_figure(laws: Mapping[str, tuple[NDArray, NDArray]], *, title: str) -> Figure:
    """Draw friction laws (Pieringer 2011, fig. 3.26).

    Parameters
    ----------
    laws : mapping
        Slip velocities (m/s) and coefficients by name.
    title : str
    """
    figure, (axis,) = new_figure(title, rows=1, height=3.0)
    for (name, (speed, coefficient)), colour in zip(laws.items(), _COLOURS, strict=False):
        axis.plot(speed, coefficient, color=colour, linewidth=1.3, label=name)
    axis.set_xlim(left=0.0)
    axis.set_ylim(bottom=0.0)
    axis.set_xlabel("Slip velocity / (m/s)")
    axis.set_ylabel("Friction coefficient")
    legend(axis)
    return figure


def force_by_grid_figure(histories: Mapping[str, tuple[NDArray, NDArray]], *, title: str) -> Figure:
    """Draw the lateral force of runs on several grids (Pieringer 2011, fig. 5.6).

    Parameters
    ----------
    histories : mapping
        Times (s) and forces (N) by name.
    title : str
    """
    figure, (axis,) = new_figure(title, rows=1, height=3.2)
    for i, (name, (time, force)) in enumerate(histories.items()):
        axis.plot(
            1e3 * time,
            1e-3 * force,
            color=_COLOURS[i % len(_COLOURS)],
            marker=_MARKERS[i % len(_MARKERS)],
            markersize=3.0,
            linewidth=1.0,
            label=name,
        )
    axis.set_xlabel("Time / ms")
    axis.set_ylabel("$F_y$ / kN")
    low, high = axis.get_ylim()
    axis.set_ylim(low, high + 0.2 * (high - low))
    legend(axis, ncols=len(histories), loc="upper center")
    return figure


def spectra_figure(
    spectra: Mapping[str, tuple[NDArray, NDArray]],
    *,
    modes: Mapping[str, float] | None = None,
    highest: float = 7e3,
    title: str,
) -> Figure:
    """Draw spectra of the lateral force over each other (Pieringer 2011, figs. 5.9 and 5.10).

    Parameters
    ----------
    spectra : mapping
        Frequencies (Hz) and amplitudes (N) by name.
    modes : mapping of str to float, optional
        Frequencies of the wheel's modes in Hz, by name.
    highest : float
        Hz.
    title : str
    """
    figure, (axis,) = new_figure(title, rows=1, height=3.8)
    top = -np.inf
    for (name, (frequency, amplitude)), colour in zip(spectra.items(), _COLOURS, strict=False):
        level = 20.0 * np.log10(np.maximum(amplitude / math.sqrt(2.0), 1e-300))
        inside = (frequency > 0.0) & (frequency <= highest)
        axis.plot(frequency[inside] / 1e3, level[inside], color=colour, linewidth=0.9, label=name)
        top = max(top, float(level[inside].max()))
    axis.set_xlim(0.0, highest / 1e3)
    axis.set_ylim(top - _RANGE, top + 12.0)
    axis.set_xlabel("Frequency / kHz")
    axis.set_ylabel("Level of $F_y$ / dB re 1 N")
    mark_frequencies(axis, {f"({name})": f / 1e3 for name, f in (modes or {}).items()})
    legend(axis, ncols=len(spectra), loc="upper center")
    return figure


def centre_lines_figure(lines: Sequence[CentreLine], *, title: str, columns: int = 3) -> Figure:
    """Draw tractions and slip along the centre line, one panel each (Pieringer 2011, figs. 5.7 and 5.8).

    Parameters
    ----------
    lines : sequence of CentreLine
    title : str
    columns : int
    """
    rows = math.ceil(len(lines) / columns)
    figure = Figure(figsize=(6.7, 0.6 + 1.9 * rows), dpi=160, layout="constrained")
    figure.suptitle(title, fontsize=10.0, color=INK)
    grid: Any = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    largest = max(float(line.bound.max()) for line in lines)
    fastest = max(max(float(line.slip_speed.max()) for line in lines), np.finfo(float).tiny)
    for axis, line in zip(grid.flat, lines, strict=False):
        x = 1e3 * line.x
        axis.fill_between(x, line.bound / largest, color="#E6E6E6", linewidth=0.0, label="bound without slip")
        axis.plot(x, line.traction / largest, color=GREY, linewidth=1.3, linestyle="--", label="traction")
        axis.plot(x, line.slip_speed / fastest, color=BLUE, linewidth=1.3, label="slip velocity")
        axis.set_title(line.label, fontsize=_SMALL, color=INK)
        axis.tick_params(labelsize=_SMALL, direction="in", color=GREY)
        axis.grid(visible=True, color="#DDDDDD", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.set_ylim(0.0, 1.05)
    for axis in grid.flat[len(lines) :]:
        axis.set_visible(False)
    for axis in grid[-1]:
        axis.set_xlabel("x / mm (rolling to the right)", fontsize=_SMALL)
    for axis in grid[:, 0]:
        axis.set_ylabel(f"over {largest * 1e-6:.0f} MPa, {fastest:.2g} m/s", fontsize=_SMALL)
    handles, labels = grid.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=_SMALL, framealpha=0.9)
    return figure
