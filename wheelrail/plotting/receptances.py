"""Figures of receptances in several directions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MultipleLocator
from numpy.typing import NDArray

from .contact import arrange
from .style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, log_axis, new_figure

__all__ = ["DIRECTIONS", "mark_frequencies", "receptance_components_figure"]

DIRECTIONS = "xyz"
_LOOKS = ((BLUE, "-"), (ORANGE, "--"), (GREEN, "-."), (PURPLE, ":"))
_DECADES = 7.0  # shown below the largest value
_CLOSEST = 0.022  # of the width, between two labels


def receptance_components_figure(
    *,
    frequency: NDArray,
    receptances: Mapping[str, NDArray],
    components: Sequence[str] = ("zz", "yy", "yz"),
    marks: Mapping[str, float] | None = None,
    title: str,
) -> Figure:
    """Draw magnitude and phase of some components of receptances.

    Parameters
    ----------
    frequency : ndarray, shape (n,)
        Hz.
    receptances : mapping of str to ndarray of complex, shape (n, 3, 3)
        By the names in the legend; [frequency, displacement, force], m/N, time factor exp(+i omega t). A component
        that is zero throughout isn't drawn.
    components : sequence of str
        "yz" is the displacement in y under a force in z.
    marks : mapping of str to float, optional
        Frequencies in Hz to point out, such as those of modes, by name.
    title : str

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        For another component, or more than 4 receptances, which could not be told apart.
    """
    for component in components:
        if len(component) != 2 or set(component) - set(DIRECTIONS):
            raise ValueError(f'component "{component}" is refused: two of x, y and z, "yz" for instance')
    if len(receptances) > len(_LOOKS):
        raise ValueError(f"{len(receptances)} receptances are refused: at most {len(_LOOKS)} can be told apart")
    rows = len(components)
    figure, axes = new_figure(title, rows=2 * rows, height=1.0 + 2.15 * rows)
    arrange(figure, axes, rows=rows, columns=2, width_ratios=(1.7, 1.0))
    lines = {}
    for component, magnitude, phase in zip(components, axes[::2], axes[1::2], strict=True):
        i, j = (DIRECTIONS.index(direction) for direction in component)
        top = 0.0
        for (name, values), (colour, style) in zip(receptances.items(), _LOOKS, strict=False):
            one = np.asarray(values)[:, i, j]
            if not one.any():
                continue
            look = {"color": colour, "linestyle": style, "linewidth": 1.1}
            (lines[name],) = magnitude.plot(frequency, np.abs(one), label=name, **look)
            phase.plot(frequency, _phase(one, point=i == j), **look)
            top = max(top, float(np.abs(one).max()))
        magnitude.set_yscale("log")
        if top:
            low, high = magnitude.get_ylim()
            magnitude.set_ylim(max(low, top * 10.0**-_DECADES), high)
        magnitude.set_ylabel(rf"$|\alpha_{{{component}}}|$ / (m/N)")
        phase.set_ylabel(rf"$\arg\alpha_{{{component}}}$ / °")
        phase.set_ylim(*((-190.0, 10.0) if i == j else (-190.0, 190.0)))
        phase.yaxis.set_major_locator(MultipleLocator(45.0 if i == j else 90.0))
        for axis in (magnitude, phase):
            log_axis(axis, float(frequency[0]), float(frequency[-1]))
            if axis is phase:
                axis.xaxis.set_major_locator(LogLocator())  # it is too narrow for more than the decades
            if component != components[-1]:
                axis.set_xlabel("")
        mark_frequencies(magnitude, marks or {}, named=component == components[0])
    figure.align_ylabels(axes[::2])
    if lines:
        figure.legend(handles=list(lines.values()), loc="outside lower center", ncols=4, fontsize=8.0, frameon=False)
    return figure


def _phase(values: NDArray, *, point: bool) -> NDArray:
    angle = np.degrees(np.angle(values))
    # A passive point receptance lies between -180 and 0 degrees; rounding must not wrap it to +180.
    return np.where(angle > 90.0, angle - 360.0, angle) if point else angle


def mark_frequencies(axis: Axes, marks: Mapping[str, float], *, named: bool = True) -> None:
    """Point out frequencies by lines, and by their names above the axes where these don't run into each other.

    Parameters
    ----------
    axis : Axes
        With its final limits and scale.
    marks : mapping of str to float
        Hz, by name.
    named : bool
        Without, only the lines are drawn.
    """
    low, high = axis.get_xlim()
    shown = sorted((f, name) for name, f in marks.items() if low < f < high)
    last = -1.0
    for f, name in shown:
        axis.axvline(f, color=GREY, linewidth=0.6, linestyle=":", zorder=1)
        place = axis.transAxes.inverted().transform(axis.transData.transform((f, axis.get_ylim()[1])))[0]
        if named and place - last >= _CLOSEST:
            axis.annotate(
                name,
                (place, 1.0),
                xycoords="axes fraction",
                xytext=(0, 3),
                textcoords="offset points",
                rotation=90.0,
                ha="center",
                va="bottom",
                fontsize=6.5,
                color=INK,
            )
            last = float(place)
