"""Figure of the velocities of wheel and rail at the contact in third-octave bands."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from wheelrail.analysis.contact_velocity import DISPLACEMENTS, ContactVelocities

from .band_axis import frequency_bands
from .style import BLUE, GREEN, ORANGE, legend, new_figure

__all__ = ["velocity_figure"]

_COLOURS = {"z": BLUE, "y": ORANGE, "x": GREEN}
_LOOKS = {"wheel": ("-", "o"), "rail": ("--", "s")}
_RANGE = 80.0  # dB below the highest level


def velocity_figure(velocities: ContactVelocities, *, title: str) -> Figure:
    """Draw velocity levels re 1e-9 m/s.

    Parameters
    ----------
    velocities : ContactVelocities
        By names of displacements.
    title : str

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        If there is no band.
    """
    if not len(velocities.centres):
        raise ValueError("no third-octave band: the run is too short")
    figure, (axis,) = new_figure(title, rows=1, height=4.0)
    top = -math.inf
    for name in velocities.mean_squares:
        levels = velocities.levels(name)
        body, _, direction = name.split("_")
        line, marker = _LOOKS[body]
        finite = np.isfinite(levels)
        axis.plot(
            velocities.centres[finite],
            levels[finite],
            color=_COLOURS[direction],
            linestyle=line,
            linewidth=1.2,
            marker=marker,
            markersize=3.0,
            label=DISPLACEMENTS[name],
        )
        top = max(top, float(levels[finite].max(initial=-math.inf)))
    frequency_bands(axis, velocities.centres)
    low, high = axis.get_ylim()
    if math.isfinite(top):
        axis.set_ylim(max(low, top - _RANGE), high)
    axis.yaxis.set_major_locator(MultipleLocator(10.0))
    axis.set_ylabel("Velocity level / dB re 1 nm/s")
    legend(axis, loc="best")
    return figure
