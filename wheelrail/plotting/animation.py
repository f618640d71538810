"""A transient contact: as an animation with the force history, and as some instants beside each other."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.animation import FFMpegWriter, PillowWriter
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .contact import BELOW, arrange, draw_cut, draw_stick_slip, set_up_map, stick_slip_handles
from .contact_map import ContactMap, view_of
from .files import PlotError
from .style import BLUE, GREY, INK, ORANGE, legend, new_figure

__all__ = ["FORMATS", "animate_contact", "instants_figure"]

FORMATS = (".gif", ".mp4")
_DPI = 110


def animate_contact(
    path: str | os.PathLike[str],
    states: Sequence[ContactMap],
    forces: NDArray,
    *,
    distance: NDArray,
    title: str,
    force_limit: float | None = None,
    frames_per_second: float = 8.0,
    progress: Callable[[float], None] | None = None,
) -> Path:
    """Write a GIF, or an MP4 film where the program ffmpeg is installed; an earlier file is replaced when it is done.

    All frames are held in memory, about 1 MB each.

    Parameters
    ----------
    path : path-like
        Ends in .gif or .mp4.
    states : sequence of ContactMap
        One for each frame, all on one grid.
    forces : ndarray, shape (frames, 2)
        Longitudinal and lateral force on the rail, N.
    distance : ndarray, shape (frames,)
        Rolled distance in m, ascending.
    title : str
    force_limit : float, optional
        Friction coefficient times load in N, to draw as the bound of the force.
    frames_per_second : float
    progress : callable, optional
        Called with the share of the frames done.

    Returns
    -------
    Path

    Raises
    ------
    PlotError
        If the format is neither of both, ffmpeg is missing, the frames don't fit together, or the file can't be
        written.
    """
    path = Path(path)
    forces, distance = np.asarray(forces, dtype=float), np.asarray(distance, dtype=float)
    _check(path, states, forces, distance)
    figure, (arrows, cut, history) = new_figure(title, rows=3, height=5.4)
    grid = figure.add_gridspec(2, 2, height_ratios=(2.2, 1.0))
    for axis, cell in zip((arrows, cut, history), (grid[0, 0], grid[0, 1], grid[1, :]), strict=True):
        axis.set_subplotspec(cell)
    largest = _common_scales(states, [arrows], [cut])
    set_up_map(arrows, "Tractions on the rail")
    length = 1e3 * distance
    for component, colour, name in ((0, BLUE, "longitudinal $F_1$"), (1, ORANGE, "lateral $F_2$")):
        history.plot(length, forces[:, component] * 1e-3, color=colour, linewidth=1.2, label=name)
    if force_limit is not None:
        extreme = forces.flat[int(np.abs(forces).argmax())]  # the bound is drawn on this side only
        history.axhline(
            np.copysign(1e-3 * force_limit, extreme), color=GREY, linewidth=1.0, linestyle="--", label=r"$\mu N$"
        )
    (now,) = history.plot([], [], color=INK, linewidth=0.8)
    points = [history.plot([], [], marker="o", markersize=4.5, color=colour)[0] for colour in (BLUE, ORANGE)]
    history.set_xlim(length[0], max(length[-1], length[0] + 1e-9))
    history.set_xlabel("Rolled distance / mm")
    history.set_ylabel("Force on the rail / kN")
    legend(history, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)
    writer_class = PillowWriter if path.suffix == ".gif" else FFMpegWriter
    writer = writer_class(fps=frames_per_second)  # type: ignore[arg-type]
    part = path.with_name(f".{path.stem}.part{path.suffix}")  # the writers go by the suffix
    reading = figure.text(0.99, 0.985, "", ha="right", va="top", fontsize=8.0, color=INK)
    try:
        with writer.saving(figure, str(part), _DPI):
            for n, state in enumerate(states):
                drawn = draw_stick_slip(arrows, state, key=True, largest=largest) + draw_cut(cut, state)
                if n == 0:
                    legend(arrows, handles=stick_slip_handles(), **BELOW)
                    legend(
                        cut, handles=[line for line in cut.lines if not str(line.get_label()).startswith("_")], **BELOW
                    )
                    figure.draw_without_rendering()
                    figure.set_layout_engine("none")  # nothing may move from frame to frame
                now.set_data([length[n]] * 2, history.get_ylim())
                for point, value in zip(points, forces[n], strict=True):
                    point.set_data([length[n]], [1e-3 * value])
                reading.set_text(f"{length[n]:.4g} mm")
                writer.grab_frame()
                for artist in drawn:
                    artist.remove()
                if progress is not None:
                    progress((n + 1) / len(states))
        os.replace(part, path)
    except OSError as error:
        raise PlotError(f"{path}: can't be written: {error.strerror or error}") from error
    finally:
        part.unlink(missing_ok=True)
    return path


def _common_scales(states: Sequence[ContactMap], maps: Sequence[Axes], cuts: Sequence[Axes]) -> float:
    """Give all axes the limits that show all states; return the largest traction in Pa."""
    (x, y) = view_of(np.any([state.contact for state in states], axis=0), states[0])
    largest = max(float(np.hypot(*state.tractions).max()) for state in states)
    top = 1.08e-6 * max(max(float(state.bound.max()) for state in states), largest) or 1.0
    for axis in maps:
        axis.set_xlim(*x)
        axis.set_ylim(*y)
    for axis in cuts:
        axis.set_xlim(*x)
        axis.set_ylim(-top, top)
    return largest


def instants_figure(states: Sequence[ContactMap], names: Sequence[str], *, title: str) -> Figure:
    """Draw some instants beside each other: tractions over stick and slip, and below them the cut along y = 0.

    Parameters
    ----------
    states : sequence of ContactMap
        All on one grid, 2 to 4 of them.
    names : sequence of str
        One for each.
    title : str

    Returns
    -------
    Figure
    """
    count = len(states)
    figure, axes = new_figure(title, rows=2 * count, height=1.8 + 9.6 / count)
    arrange(figure, axes, rows=2, columns=count, height_ratios=(1.5, 1.0))
    maps, cuts = axes[:count], axes[count:]
    largest = _common_scales(states, maps, cuts)
    for n, (state, name, arrows, cut) in enumerate(zip(states, names, maps, cuts, strict=True)):
        set_up_map(arrows, "")
        arrows.set_title(f"{name}\n", loc="left", fontsize=9.0)  # above the rolling direction
        draw_stick_slip(arrows, state, key=n == 0, largest=largest)
        draw_cut(cut, state)
        cut.set_title("Cut" if count > 2 else cut.get_title(loc="left"), loc="left", fontsize=9.0)
        if n:
            for axis in (arrows, cut):
                axis.set_ylabel("")
                axis.tick_params(labelleft=False)
    curves = [line for line in cuts[0].lines if not str(line.get_label()).startswith("_")]
    handles = [*stick_slip_handles(), *curves]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), fontsize=8.0, frameon=False)
    return figure


def _check(path: Path, states: Sequence[ContactMap], forces: NDArray, distance: NDArray) -> None:
    if path.suffix not in FORMATS:
        raise PlotError(f"{path}: an animation is written as {' or '.join(FORMATS)}")
    if path.suffix == ".mp4" and not FFMpegWriter.isAvailable():
        raise PlotError(f"{path}: an MP4 film needs the program ffmpeg, which is not installed; write a .gif instead")
    if not path.parent.is_dir():
        raise PlotError(f"{path}: there is no folder {path.parent}; make it first or choose another")
    if not states:
        raise PlotError(f"{path}: there are no frames to animate")
    count = len(states)
    if forces.shape != (count, 2) or distance.shape != (count,):
        raise PlotError(
            f"{path}: {count} frames need forces of shape ({count}, 2) and distances of shape ({count},), "
            f"they have {forces.shape} and {distance.shape}"
        )
    first = states[0]
    for n, state in enumerate(states):
        if not (np.array_equal(state.x, first.x) and np.array_equal(state.y, first.y)):
            raise PlotError(f"{path}: frame {n} lies on another grid than frame 0")
