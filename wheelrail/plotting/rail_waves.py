"""Figures of the waves in a rail: dispersion, and the motion of the cross-section."""

from __future__ import annotations

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from wheelrail.numerics.quad_mesh import mesh_edges
from wheelrail.track.dispersion import Dispersion
from wheelrail.track.safe_matrices import SectionMatrices

from .contact import arrange
from .section_shapes import OUT_OF_PLANE, SectionDrawing, draw_section
from .style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, legend, new_figure

__all__ = ["dispersion_figure", "wave_shapes_figure"]

_COLOURS = (BLUE, ORANGE, GREEN, PURPLE)
_STYLES = ("-", "--", "-.", ":")
_CLOSEST = 0.025  # of the width, between two labels


def dispersion_figure(
    dispersion: Dispersion, *, cut_ons: ArrayLike = (), highest: float | None = None, title: str = "Waves in the rail"
) -> Figure:
    """Draw the wavenumbers of waves over the frequency.

    Parameters
    ----------
    dispersion : Dispersion
    cut_ons : array_like, shape (n,)
        Frequencies in Hz to mark, from which on waves travel.
    highest : float, optional
        Hz; by default the largest at which every wave that begins below is known.
    title : str

    Returns
    -------
    Figure
    """
    figure, (axis,) = new_figure(title, rows=1, height=4.2)
    highest = highest or float(dispersion.frequency[-1].min())
    for i, name in enumerate(dispersion.names):
        if dispersion.frequency[:, i].min() >= highest:
            continue
        axis.plot(
            dispersion.frequency[:, i],
            dispersion.wavenumber,
            label=name,
            linewidth=1.3,
            color=_COLOURS[i % len(_COLOURS)],
            linestyle=_STYLES[i // len(_COLOURS) % len(_STYLES)],
        )
    axis.set_xlim(0.0, highest)
    axis.set_ylim(0.0, float(dispersion.wavenumber[-1]))
    last = -1.0
    for f in np.sort(np.atleast_1d(np.asarray(cut_ons, dtype=float))):
        if not 1.0 < f < highest:
            continue
        axis.axvline(f, color=GREY, linewidth=0.7, linestyle=":")
        if f / highest - last >= _CLOSEST:
            axis.annotate(
                f"{f:.0f} Hz",
                (f / highest, 1.0),
                xycoords="axes fraction",
                xytext=(0, 3),
                textcoords="offset points",
                rotation=90.0,
                ha="center",
                va="bottom",
                fontsize=7.0,
                color=INK,
            )
            last = f / highest
    axis.set_xlabel("Frequency / Hz")
    axis.set_ylabel("Wavenumber / (rad/m)")
    legend(axis, loc="upper left")
    return figure


def wave_shapes_figure(
    matrices: SectionMatrices, dispersion: Dispersion, *, wavenumber: float, columns: int = 4, title: str = ""
) -> Figure:
    """Draw the motion of the section in each wave at one wavenumber, field side to the right.

    Parameters
    ----------
    matrices : SectionMatrices
        Those of the dispersion.
    dispersion : Dispersion
    wavenumber : float
        rad/m; the nearest one that is known is drawn.
    columns : int
        Panels beside each other.
    title : str

    Returns
    -------
    Figure
    """
    at = int(np.argmin(np.abs(dispersion.wavenumber - wavenumber)))
    count = len(dispersion.names)
    columns = min(columns, count)
    rows = -(-count // columns)
    k = float(dispersion.wavenumber[at])
    heading = title or f"Waves in the rail at {k:.3g} rad/m" + (f" (wavelength {2.0 * np.pi / k:.3g} m)" if k else "")
    figure, axes = new_figure(heading, rows=rows * columns, height=1.1 + 1.75 * rows)
    arrange(figure, axes, rows=rows, columns=columns)
    ends, middles = mesh_edges(matrices.mesh)
    outer = matrices.mesh.boundary_facets()
    section = SectionDrawing(
        matrices.mesh.doflocs.T, matrices.mesh.t.T, np.column_stack([ends[:, outer].T, middles[outer]])
    )
    order = np.argsort(dispersion.frequency[at])
    for axis, i in zip(axes, order, strict=False):
        shape = matrices.displacement(dispersion.shapes[at][:, i])
        # The axial motion is a quarter of a wave ahead of the others; z' points down, the drawing up.
        draw_section(
            axis,
            section,
            plane=np.column_stack([shape[:, 1], -shape[:, 2]]),
            out=shape[:, 0],
            title=f"{dispersion.names[i]}\n{dispersion.frequency[at, i]:.0f} Hz",
        )
    for axis in axes[count:]:
        axis.set_axis_off()
    bar = figure.colorbar(
        ScalarMappable(Normalize(-1.0, 1.0), OUT_OF_PLANE), ax=axes, location="bottom", shrink=0.5, aspect=40, pad=0.02
    )
    bar.set_label("displacement along the rail, a quarter of a wavelength on, over the largest one", fontsize=8.0)
    bar.ax.tick_params(labelsize=7.0)
    return figure
