"""Figures of one contact solution: pressure, tractions, stick and slip, and a cut along the rolling direction.

Maps look from above, rolling to the right. Elements are drawn as what they are in the theory: rectangles of constant
traction; nothing is smoothed.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from .contact_map import ContactMap, View, border, view_of
from .style import BLUE, GREY, INK, ORANGE, legend, new_figure

__all__ = ["BELOW", "arrange", "contact_figure", "draw_cut", "draw_stick_slip", "set_up_map", "stick_slip_handles"]

STICK, SLIP = "#6FA8D6", "#FBDDB8"  # blue and orange, told apart in grey too: slip is the lighter one
_FINEST = 21  # arrows along the longer side of the contact; finer grids get one for several elements
_LONGEST = 1.05  # longest arrow, in spacings of arrows
_MOST_MARKERS = 30
_SMALL = 8.0  # pt
BELOW: dict[str, Any] = {
    "loc": "upper center",
    "bbox_to_anchor": (0.5, -0.17),
    "ncols": 2,
    "columnspacing": 1.0,
    "handlelength": 1.6,
    "frameon": False,
}


def contact_figure(
    state: ContactMap, *, title: str = "", step: int | None = None, time: float | None = None, note: str = ""
) -> Figure:
    """Draw one solution in four panels: pressure, tractions, stick and slip, and the cut along the centre line.

    Parameters
    ----------
    state : ContactMap
    title : str
    step : int, optional
        Number of the time step, for the title.
    time : float, optional
        s, for the title.
    note : str
        More for the title, such as the creepages.

    Returns
    -------
    Figure
    """
    named = [note] if note else []
    if step is not None:
        named.append(f"step {step}")
    if time is not None:
        named.append(f"t = {1e3 * time:.4g} ms")
    heading = "\n".join(part for part in (title, ", ".join(named)) if part)
    figure, axes = new_figure(heading, rows=4, height=6.4)
    arrange(figure, axes, rows=2, columns=2)
    pressure, arrows, division, cut = axes
    view = view_of(state.contact, state)
    for axis, name in ((pressure, "Pressure"), (arrows, "Tractions on the rail"), (division, "Stick and slip")):
        set_up_map(axis, name, view)
    _draw_pressure(figure, pressure, state)
    draw_stick_slip(arrows, state, key=True)
    draw_stick_slip(division, state, with_arrows=False, element_edges=True)
    legend(division, handles=stick_slip_handles(state), **BELOW)
    draw_cut(cut, state)
    cut.set_xlim(*view[0])
    legend(cut, **BELOW)
    if not state.contact.any():
        for axis in axes:
            axis.text(0.5, 0.6, "no contact", ha="center", transform=axis.transAxes, color=GREY)
    return figure


def arrange(figure: Figure, axes: list[Axes], *, rows: int, columns: int, **ratios: Any) -> None:
    """Move axes, which `new_figure` puts below each other, into a grid, row by row."""
    grid = figure.add_gridspec(rows, columns, **ratios)
    for axis, (row, column) in zip(axes, np.ndindex(rows, columns), strict=True):
        axis.set_subplotspec(grid[row, column])


def set_up_map(axis: Axes, name: str, view: View | None = None) -> None:
    """Label a map; ``view`` holds the limits of x and y in mm."""
    axis.grid(visible=False)
    axis.set_aspect("equal")
    axis.set_title(name, loc="left", fontsize=9.0)
    axis.set_title(r"rolling $\longrightarrow$", loc="right", fontsize=_SMALL, color=INK)
    axis.set_xlabel("$x$ / mm")
    axis.set_ylabel("$y$ / mm")
    if view is not None:
        axis.set_xlim(*view[0])
        axis.set_ylim(*view[1])


def _draw_pressure(figure: Figure, axis: Axes, state: ContactMap) -> None:
    values = np.ma.masked_where(~state.contact, state.pressure * 1e-6)
    highest = float(state.pressure.max()) * 1e-6
    mesh = axis.pcolormesh(*state.edges, values, cmap="cividis", vmin=0.0, vmax=highest or 1.0)
    axis.add_collection(_outline(state, 1.2))
    bar = figure.colorbar(mesh, ax=axis, shrink=0.9, pad=0.03)
    bar.set_label("$p_3$ / MPa", size=9.0)
    bar.ax.tick_params(labelsize=_SMALL, color=GREY)


def _outline(state: ContactMap, width: float) -> LineCollection:
    """Outer edges of the elements in contact."""
    return LineCollection(
        border(state.contact, *state.edges), colors=INK, linewidths=width, capstyle="projecting", zorder=3
    )


def draw_stick_slip(
    axis: Axes,
    state: ContactMap,
    *,
    with_arrows: bool = True,
    element_edges: bool = False,
    key: bool = False,
    largest: float | None = None,
) -> list[Artist]:
    """Colour stick and slip, and draw the tractions over them as arrows.

    Parameters
    ----------
    axis : Axes
    state : ContactMap
    with_arrows : bool
    element_edges : bool
        Draw the elements.
    key : bool
        Put an arrow with its traction into the lower left corner.
    largest : float, optional
        Traction in Pa of the longest arrow; left out: the largest of this state.

    Returns
    -------
    list of Artist
        What was drawn; an animation removes it before the next frame.
    """
    kind = np.ma.masked_where(~state.contact, state.slips.astype(float))
    colours = ListedColormap([STICK, SLIP])
    look: dict[str, Any] = {"edgecolors": "white", "linewidth": 0.4} if element_edges else {}
    drawn: list[Artist] = [axis.pcolormesh(*state.edges, kind, cmap=colours, vmin=0.0, vmax=1.0, **look)]
    drawn.append(axis.add_collection(_outline(state, 1.2)))
    if not with_arrows:
        return drawn
    size = np.hypot(*state.tractions)
    largest = float(size.max()) if largest is None else largest
    if largest <= 0.0 or not state.contact.any():
        return drawn
    stride = _stride(state)
    shown = np.zeros_like(state.contact)
    shown[state.centre_row % stride :: stride, int(np.argmin(np.abs(state.x))) % stride :: stride] = True
    shown &= state.contact & (size > 0.0)
    rows, columns = np.nonzero(shown)
    p = state.tractions[:, rows, columns] * 1e-6
    spacing = 1e3 * stride * min(state.x[1] - state.x[0], state.y[1] - state.y[0])
    quiver = axis.quiver(
        state.x[columns] * 1e3,
        state.y[rows] * 1e3,
        p[0],
        p[1],
        angles="xy",
        scale_units="xy",
        scale=largest * 1e-6 / (_LONGEST * spacing),
        pivot="middle",
        color=INK,
        units="xy",
        width=0.08 * spacing,
        headwidth=4.0,
        headlength=4.5,
        headaxislength=4.0,
        zorder=4,
    )
    drawn.append(quiver)
    if key:
        value = _round_down(largest * 1e-6)
        drawn.append(
            axis.quiverkey(
                quiver, 0.08, 0.07, value, f"{value:g} MPa", labelpos="E", fontproperties={"size": _SMALL}, color=INK
            )
        )
    return drawn


def _stride(state: ContactMap) -> int:
    rows, columns = np.nonzero(state.contact)
    return max(1, math.ceil((max(np.ptp(rows), np.ptp(columns)) + 1) / _FINEST))


def _round_down(value: float) -> float:
    """Largest 1, 2 or 5 times a power of ten that is not above a value."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(factor * power for factor in (1.0, 2.0, 5.0) if factor * power <= value)


def stick_slip_handles(state: ContactMap | None = None) -> list[Patch]:
    """Make the patches that name the colours of stick and slip in a legend, with numbers of elements for a state."""
    names = ["stick", "slip"]
    if state is not None:
        slip = int(state.slips.sum())
        counts = (int(state.contact.sum()) - slip, slip)
        names = [f"{name}: {count} element{'s' * (count != 1)}" for name, count in zip(names, counts, strict=True)]
    return [
        Patch(facecolor=colour, edgecolor=GREY, linewidth=0.6, label=name)
        for colour, name in zip((STICK, SLIP), names, strict=True)
    ]


def draw_cut(axis: Axes, state: ContactMap, *, row: int | None = None) -> list[Artist]:
    """Draw tractions and their bound along the rolling direction (as Pieringer 2011, figure 4.6).

    Parameters
    ----------
    axis : Axes
    state : ContactMap
    row : int, optional
        Row of elements; left out: the one nearest to y = 0.

    Returns
    -------
    list of Artist
        What was drawn; an animation removes it before the next frame.
    """
    row = state.centre_row if row is None else row
    touching = np.flatnonzero(state.contact[row])
    used = slice(max(touching[0] - 1, 0), touching[-1] + 2) if len(touching) else slice(0, 0)
    x = 1e3 * state.x[used]
    axis.set_title(f"Cut along $y$ = {1e3 * state.y[row]:.3g} mm", loc="left", fontsize=9.0)
    axis.set_title(r"rolling $\longrightarrow$", loc="right", fontsize=_SMALL, color=INK)
    axis.set_xlabel("$x$ / mm")
    axis.set_ylabel("Traction / MPa")
    bound = np.where(state.contact[row], state.bound[row], 0.0)[used] * 1e-6
    p1, p2 = np.where(state.contact[row], state.tractions[:, row], 0.0)[:, used] * 1e-6
    drawn: list[Artist] = []
    edges = state.edges[0]
    for n, i in enumerate(np.flatnonzero(state.slips[row])):
        label = "slip" if n == 0 else None
        drawn.append(axis.axvspan(edges[i], edges[i + 1], color=SLIP, linewidth=0.0, zorder=0.5, label=label))
    drawn += axis.plot(x, bound, color=GREY, linewidth=1.2, linestyle="--", label=r"bound $\pm\mu\,p_3$")
    drawn += axis.plot(x, -bound, color=GREY, linewidth=1.2, linestyle="--")
    look: dict[str, Any] = {"linewidth": 1.2, "markersize": 3.5 if len(x) <= _MOST_MARKERS else 0.0}
    drawn += axis.plot(x, p1, color=BLUE, marker="o", label="longitudinal $p_1$", **look)
    drawn += axis.plot(x, p2, color=ORANGE, marker="s", label="lateral $p_2$", **look)
    return drawn
