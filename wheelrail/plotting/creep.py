"""Figures of creep-force curves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .contact import arrange
from .style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, new_figure

__all__ = ["CreepPanel", "creep_force_figure"]

_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": INK, "linestyle": "-", "linewidth": 1.8},
    {"color": ORANGE, "linestyle": "--"},
    {"color": BLUE, "linestyle": "-."},
    {"color": GREEN, "linestyle": (0, (5, 1.5))},
    {"color": PURPLE, "linestyle": ":"},
)


@dataclass(frozen=True)
class CreepPanel:
    """Curves over one creepage.

    Parameters
    ----------
    title : str
    creepage : ndarray, shape (n,)
        In the unit that ``creepage_label`` names.
    creepage_label, value_label : str
    curves : mapping of str to ndarray, shape (n,)
        By the names in the legend; NaN where a law does not apply.
    limits : (float, float), optional
        Of the values; a law without saturation leaves the axes there.
    """

    title: str
    creepage: NDArray
    creepage_label: str
    value_label: str
    curves: Mapping[str, NDArray]
    limits: tuple[float, float] | None = None


def creep_force_figure(panels: Sequence[CreepPanel], *, title: str, columns: int = 2) -> Figure:
    """Draw creep-force curves, panel by panel, with one legend.

    Parameters
    ----------
    panels : sequence of CreepPanel
    title : str
    columns : int
        Panels beside each other.

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        Without panels, or for more than 5 different curves: they could not be told apart.
    """
    names = list(dict.fromkeys(name for panel in panels for name in panel.curves))
    if not panels or len(names) > len(_LOOKS):
        raise ValueError(f"{len(panels)} panels with {len(names)} different curves: 1 or more with up to {len(_LOOKS)}")
    rows = -(-len(panels) // columns)
    figure, axes = new_figure(title, rows=rows * columns, height=0.9 + 2.5 * rows)
    arrange(figure, axes, rows=rows, columns=columns)
    for unused in axes[len(panels) :]:
        unused.set_axis_off()
    lines = {}
    for axis, panel in zip(axes, panels, strict=False):
        axis.axhline(0.0, color=GREY, linewidth=0.6)
        for name in (name for name in names if name in panel.curves):
            values = np.asarray(panel.curves[name], dtype=float)
            if np.isnan(values).all():
                continue
            look = _LOOKS[names.index(name)]
            (lines[name],) = axis.plot(panel.creepage, values, label=name, **{"linewidth": 1.2, **look})
        axis.set_title(panel.title, loc="left", fontsize=9.0)
        axis.set_xlabel(panel.creepage_label)
        axis.set_ylabel(panel.value_label)
        axis.set_xlim(float(np.min(panel.creepage)), float(np.max(panel.creepage)))
        if panel.limits is not None:
            axis.set_ylim(*panel.limits)
    handles = [lines[name] for name in names if name in lines]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=8.0, frameon=False, handlelength=3.2)
    return figure
