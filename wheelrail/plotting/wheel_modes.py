"""Figures of a wheel's modes: the motion of its cross-section."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from wheelrail.wheel.flexible import SectionMode, WheelShapes

from .contact import arrange
from .section_shapes import OUT_OF_PLANE, SectionDrawing, draw_section
from .style import new_figure

__all__ = ["wheel_modes_figure"]

_MOST = 48


def wheel_modes_figure(
    shapes: WheelShapes, *, names: Sequence[str] | None = None, columns: int = 6, title: str = "Modes of the wheel"
) -> Figure:
    """Draw modes as the section at the wheel's lowest point sees them, the field side to the right and the rail below.

    Each panel names the mode by its nodal diameters and circles and gives its frequency and its shares of the kinetic
    energy in radial, circumferential and axial motion.

    Parameters
    ----------
    shapes : WheelShapes
    names : sequence of str, optional
        Modes to draw, "7,0,a" for instance, in this order; by default all, by frequency.
    columns : int
        Panels beside each other.
    title : str

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        For a mode that the wheel doesn't have, none at all, or more than 48.
    """
    modes = _chosen(shapes, names)
    columns = min(columns, len(modes))
    rows = -(-len(modes) // columns)
    figure, axes = new_figure(title, rows=rows * columns, height=1.2 + 1.5 * rows)
    arrange(figure, axes, rows=rows, columns=columns)
    body = shapes.body
    # z_axial points to the flange, the drawing to the field side; the contact is at the bottom.
    flip = np.array([-1.0, -1.0])
    section = SectionDrawing(body.points[:, ::-1] * flip, body.quads, body.boundary)
    for axis, mode in zip(axes, modes, strict=False):
        radial, circumferential, axial = mode.shape.T
        # The circumferential motion belongs to a quarter of a wave further on.
        draw_section(
            axis,
            section,
            plane=np.column_stack([axial, radial]) * flip,
            out=circumferential,
            title=f"({mode.name})  {mode.frequency:.0f} Hz\n{_energy(mode)}",
        )
    for axis in axes[len(modes) :]:
        axis.set_axis_off()
    colours = ScalarMappable(Normalize(-1.0, 1.0), OUT_OF_PLANE)
    bar = figure.colorbar(colours, ax=axes, location="bottom", shrink=0.5, aspect=40, pad=0.02)
    bar.set_label("circumferential displacement over the largest one; r, c, a: shares of the energy in %", fontsize=8.0)
    bar.ax.tick_params(labelsize=7.0)
    return figure


def _energy(mode: SectionMode) -> str:
    return ", ".join(f"{letter} {100.0 * share:.0f}" for letter, share in zip("rca", mode.energy, strict=True))


def _chosen(shapes: WheelShapes, names: Sequence[str] | None) -> list[SectionMode]:
    by_name = {mode.name: mode for mode in shapes.modes}
    modes = list(shapes.modes) if names is None else []
    for name in names or ():
        bare = name.replace(" ", "").strip("()")
        if bare not in by_name:
            raise ValueError(f'the wheel has no mode "{name}"; it has {", ".join(by_name)}')
        modes.append(by_name[bare])
    if not 0 < len(modes) <= _MOST:
        raise ValueError(f"{len(modes)} modes are refused: 1 to {_MOST} can be drawn; choose some by their names")
    return modes
