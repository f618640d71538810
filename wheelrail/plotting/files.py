"""All figures of one result as files."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from wheelrail.case import Case
from wheelrail.errors import WheelrailError
from wheelrail.greens.cache import cached_moving_greens
from wheelrail.interaction.build import hertz_of, memory_of, track_of, wheel_of
from wheelrail.results import case_of_result, open_result

from .force import force_figure, spectrum_figure
from .response import greens_figure, receptance_figure

__all__ = ["FORMATS", "PlotError", "Plots", "plot_result"]

FORMATS = ("png", "pdf", "svg")
_LOWEST, _HIGHEST, _FREQUENCIES = 20.0, 5000.0, 700  # Hz
_EARLY, _WHEEL_EARLY = 10e-3, 2e-3  # s


class PlotError(WheelrailError):
    """Figures can't be made or written."""


@dataclass(frozen=True)
class Plots:
    """What was drawn.

    Attributes
    ----------
    files : tuple of Path
    left_out : tuple of str
        Why a figure is missing, one line each.
    """

    files: tuple[Path, ...]
    left_out: tuple[str, ...]


def plot_result(
    path: str | os.PathLike[str],
    folder: str | os.PathLike[str],
    *,
    format: str = "png",
    progress: Callable[[float], None] | None = None,
) -> Plots:
    """Draw a result and the model behind it.

    Parameters
    ----------
    path : path-like
        A result file.
    folder : path-like
        Where the figures go, each named after the result.
    format : {"png", "pdf", "svg"}
    progress : callable, optional
        Called with the share of the Green's functions done, if they have to be computed again.

    Returns
    -------
    Plots

    Raises
    ------
    ResultFileError
        If the result can't be read.
    PlotError
        If a figure can't be written.
    """
    path, folder = Path(path), Path(folder)
    if format not in FORMATS:
        raise PlotError(f"format {format!r} is refused: allowed are {', '.join(FORMATS)}")
    if not folder.is_dir():
        raise PlotError(f"{folder}: there is no such folder; make it first or choose another --output")
    left_out: list[str] = []
    with open_result(path) as dataset:
        case = case_of_result(dataset, source=str(path))
        time, distance = dataset["time"].values, dataset["distance"].values
        names = [name for name in ("force_z", "force_z_mean") if name in dataset]  # equal within single steps
        force = dataset[names[0]].values if names else None
    title = case.title or path.stem
    figures: dict[str, Figure] = {}
    spacing = getattr(case.track, "sleeper_spacing", None)
    if force is None:
        left_out.append('force and its spectrum: the result does not hold "force_z"; add it to output.record')
    else:
        figures["force"] = force_figure(
            time=time,
            position=case.simulation.start_position + distance,
            force=force,
            load=case.load.preload if case.load.coupling == "load" else None,
            sleeper_spacing=spacing,
            title=title,
        )
        marks = {} if spacing is None else {"sleeper passing": case.simulation.speed / spacing}
        try:
            figures["force_spectrum"] = spectrum_figure(
                force=force, dt=case.simulation.dx / case.simulation.speed, title=title, marks=marks
            )
        except ValueError:
            left_out.append(f"spectrum of the force: {len(force)} samples are too few")
    figures["receptances"] = _receptances(case, title)
    if case.wheel.model == "rigid" and case.track.model == "rigid":
        left_out.append("Green's functions: neither wheel nor track has dynamics")
    else:
        figures["greens_functions"] = _greens(case, title, progress)
    files = []
    for name, figure in figures.items():
        target = folder / f"{path.stem}_{name}.{format}"
        _write(figure, target, format)
        files.append(target)
    return Plots(tuple(files), tuple(left_out))


def _write(figure: Figure, target: Path, format: str) -> None:
    part = target.with_name(target.name + ".part")
    try:
        figure.savefig(part, format=format)
        os.replace(part, target)
    except OSError as error:
        raise PlotError(f"{target}: can't be written: {error.strerror or error}") from error
    finally:
        part.unlink(missing_ok=True)


def _receptances(case: Case, title: str) -> Figure:
    highest = min(_HIGHEST, 0.5 * case.simulation.speed / case.simulation.dx)
    frequency = np.geomspace(min(_LOWEST, 0.1 * highest), highest, _FREQUENCIES)
    curves = {}
    wheel, track = wheel_of(case), track_of(case)
    if wheel is not None:
        curves["wheel"] = wheel.receptance(frequency)
    if track is not None:
        curves["track over a sleeper"] = track.receptance(0.0, [0.0], frequency)[:, 0]
        midspan = 0.5 * track.sleeper_spacing
        curves["track at midspan"] = track.receptance(midspan, [midspan], frequency)[:, 0]
    stiffness = hertz_of(case).stiffness
    curves["contact spring at the preload"] = np.full(len(frequency), 1.0 / stiffness + 0.0j)
    return receptance_figure(frequency=frequency, receptances=curves, title=title)


def _greens(case: Case, title: str, progress: Callable[[float], None] | None) -> Figure:
    wheel, track = wheel_of(case), track_of(case)
    dx, speed = case.simulation.dx, case.simulation.speed
    dt = dx / speed
    track_time, curves, wheel_time, wheel_values = None, {}, None, None
    if track is not None:
        greens = cached_moving_greens(track, speed=speed, dx=dx, memory=memory_of(case), progress=progress)
        middle = greens.values.shape[0] // 2
        # Per time instead of per step; the first sample is half a step's.
        curves = {"from over a sleeper": greens.values[0] / dt, "from midspan": greens.values[middle] / dt}
        track_time = np.arange(greens.values.shape[1]) * dt
    if wheel is not None:
        wheel_dt = 2e-6
        wheel_values = wheel.impulse_response(wheel_dt, round(_WHEEL_EARLY / wheel_dt) + 1)
        wheel_time = np.arange(len(wheel_values)) * wheel_dt
    return greens_figure(
        track_time=track_time,
        track=curves,
        wheel_time=wheel_time,
        wheel=wheel_values,
        shown=_EARLY if track_time is None else min(_EARLY, float(track_time[-1])),
        title=title,
    )
