"""Figures of the model behind a result: receptances and Green's functions of its wheel and its track."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from wheelrail.case import Case
from wheelrail.greens.moving import MovingGreens
from wheelrail.greens.protocol import WheelResponse, first_sample
from wheelrail.interaction.build import hertz_of, track_of, wheel_of
from wheelrail.interaction.tracks import TrackModel, greens_of, track_receptance
from wheelrail.interaction.wheels import WheelModel, vertical_receptance, wheel_responses
from wheelrail.track.discrete import DiscreteTrack
from wheelrail.wheel.modes import FlexibleWheel
from wheelrail.wheel.rigid import RigidWheel

from .greens_functions import greens_components_figure
from .receptances import receptance_components_figure
from .response import greens_figure, receptance_figure

__all__ = ["impulse_samples", "model_figures", "names_of_modes"]

_LOWEST, _HIGHEST, _FREQUENCIES = 20.0, 5000.0, 700  # Hz
_HIGHEST_MODES = 7000.0  # Hz
_WIDTHS = np.sinh(np.linspace(-6.0, 6.0, 41))  # around a resonance, in half-power bandwidths
_EARLY, _WHEEL_EARLY, _FLEXIBLE_EARLY = 10e-3, 2e-3, 20e-3  # s
_POINT, _CROSS = ("xx", "yy", "zz"), ("yz", "xy", "xz")
_NEGLIGIBLE = 1e-6  # of a cross receptance, over the largest point receptance


def names_of_modes(wheel: WheelModel | None) -> dict[str, float]:
    """Natural frequencies in Hz of a wheel's flexible modes by name, of partners the first; empty without modes."""
    if not isinstance(wheel, FlexibleWheel):
        return {}
    return {mode.name: mode.frequency for mode in wheel.modes if not (mode.residual or mode.name.endswith("*"))}


def model_figures(
    case: Case, title: str, progress: Callable[[float], None] | None, left_out: list[str]
) -> dict[str, Figure]:
    """Draw wheel and track of a case.

    Parameters
    ----------
    case : Case
    title : str
    progress : callable or None
        Called with the share of the Green's functions done, if they have to be computed again.
    left_out : list of str
        Gets a line for each figure that can't be made.

    Returns
    -------
    dict of str to Figure
        By the ends of their files' names.
    """
    wheel, track = wheel_of(case), track_of(case)
    spatial = case.wheel.model == "flexible" or case.track.model == "waveguide"
    figures = {"receptances": _vertical_receptances(case, wheel, track, title)}
    if spatial:
        figures["receptances_xyz"] = _receptances(case, wheel, track, title)
    if wheel is None and track is None:
        left_out.append("Green's functions: neither wheel nor track has dynamics")
        return figures
    greens = greens_of(case, progress)
    figures["greens_functions"] = _vertical_greens(case, wheel, greens, title)
    if spatial:
        figures["greens_functions_xyz"] = _greens(case, wheel, greens, title)
    return figures


def _frequencies(case: Case, highest: float) -> NDArray:
    highest = min(highest, 0.5 * case.simulation.speed / case.simulation.dx)
    return np.geomspace(min(_LOWEST, 0.1 * highest), highest, _FREQUENCIES)


def _places(spacing: float | None) -> dict[str, float]:
    """Places along the track that differ, by the words for them."""
    return {"": 0.0} if spacing is None else {" over a sleeper": 0.0, " at midspan": 0.5 * spacing}


def _vertical_receptances(case: Case, wheel: WheelModel | None, track: TrackModel | None, title: str) -> Figure:
    frequency = _around_modes(_frequencies(case, _HIGHEST), wheel)
    curves = {}
    if wheel is not None:
        curves["wheel"] = vertical_receptance(wheel, frequency)
    if track is not None:
        for name, x in _places(track.sleeper_spacing).items():
            curves[f"track{name}"] = track_receptance(track, x, frequency)
    stiffness = hertz_of(case).stiffness
    curves["contact spring at the preload"] = np.full(len(frequency), 1.0 / stiffness + 0.0j)
    return receptance_figure(frequency=frequency, receptances=curves, title=title)


def _around_modes(frequency: NDArray, wheel: WheelModel | None) -> NDArray:
    """Add frequencies that show each resonance of a wheel at its height."""
    if not isinstance(wheel, FlexibleWheel):
        return frequency
    near = [mode.frequency * (1.0 + mode.damping_ratio * _WIDTHS) for mode in wheel.modes if mode.damping_ratio < 1e-2]
    both = np.unique(np.concatenate([frequency, *near]))
    return both[(both >= frequency[0]) & (both <= frequency[-1])]


def _receptances(case: Case, wheel: WheelModel | None, track: TrackModel | None, title: str) -> Figure:
    frequency = _around_modes(_frequencies(case, _HIGHEST_MODES), wheel)
    curves = {}
    if wheel is not None:
        curves["wheel"] = _in_three_directions(wheel.receptance(frequency))
    if track is not None:
        for name, x in _places(track.sleeper_spacing).items():
            rail = (
                track_receptance(track, x, frequency)
                if isinstance(track, DiscreteTrack)
                else track.receptance(frequency, x)
            )
            curves[f"track{name}"] = _in_three_directions(rail)
    for values in curves.values():
        _clear_cross_terms(values)
    cross = [
        pair
        for pair in _CROSS
        if any(values[:, "xyz".index(pair[0]), "xyz".index(pair[1])].any() for values in curves.values())
    ]
    return receptance_components_figure(
        frequency=frequency,
        receptances=curves,
        components=(*_POINT, *cross),
        marks=names_of_modes(wheel),
        title=title,
    )


def _in_three_directions(values: NDArray) -> NDArray:
    """Copy as [..., displacement, force]; what is vertical only stands still in the other directions."""
    if values.ndim == 3:
        return values.copy()
    whole = np.zeros((len(values), 3, 3), dtype=values.dtype)
    whole[:, 2, 2] = values
    return whole


def _clear_cross_terms(values: NDArray) -> None:
    """Take what only rounding has made of a symmetric structure's cross terms for zero."""
    largest = np.abs(values).max()
    for i, j in np.ndindex(3, 3):
        if i != j and np.abs(values[:, i, j]).max() < _NEGLIGIBLE * largest:
            values[:, i, j] = 0.0


def _vertical_greens(case: Case, wheel: WheelModel | None, greens: MovingGreens | None, title: str) -> Figure:
    dt = case.simulation.dx / case.simulation.speed
    track_time, curves, wheel_time, wheel_values = None, {}, None, None
    if greens is not None:
        values = greens.values if greens.values.ndim == 2 else greens.values[:, 2, 2]
        # Per time instead of per step; the first sample is half a step's.
        curves = {f"from{name}" if name else "anywhere": row / dt for name, row in _rows(values).items()}
        track_time = np.arange(values.shape[1]) * dt
    if isinstance(wheel, RigidWheel):
        wheel_dt = 2e-6
        wheel_values = wheel.impulse_response(wheel_dt, round(_WHEEL_EARLY / wheel_dt) + 1)
        wheel_time = np.arange(len(wheel_values)) * wheel_dt
    elif wheel is not None:
        response, _, _ = wheel_responses(case, wheel, dt=dt, directions=1)
        if response is not None:
            wheel_values = impulse_samples(response, round(_FLEXIBLE_EARLY / dt))[:, 0, 0] / dt
            wheel_time = np.arange(len(wheel_values)) * dt
    return greens_figure(
        track_time=track_time,
        track=curves,
        wheel_time=wheel_time,
        wheel=wheel_values,
        shown=_EARLY if track_time is None else min(_EARLY, float(track_time[-1])),
        title=title,
    )


def _rows(values: NDArray) -> dict[str, NDArray]:
    """Green's functions from the places along the track that differ."""
    places = _places(None if len(values) == 1 else 1.0)
    return {name: values[len(values) // 2 if x else 0] for name, x in places.items()}


def impulse_samples(response: WheelResponse, count: int) -> NDArray:
    """Discretised Green's functions of a wheel, shape (count, d, d): [sample, displacement, force]."""
    d = response.directions
    values = np.empty((max(count, 2), d, d))
    for j in range(d):
        state, force = np.zeros(response.size), np.eye(d)[j]
        for i in range(len(values)):
            values[i, :, j] = response.known(state)
            response.advance(state, force if i == 0 else 0.0 * force)
    values[0] = first_sample(response)
    return values


def _greens(case: Case, wheel: WheelModel | None, greens: MovingGreens | None, title: str) -> Figure:
    dt = case.simulation.dx / case.simulation.speed
    count = round(_FLEXIBLE_EARLY / dt)
    functions = {}
    if wheel is not None:
        response, _, _ = wheel_responses(case, wheel, dt=dt, directions=3)
        if response is not None:
            samples = impulse_samples(response, count)
            functions["wheel"] = samples if samples.shape[1] == 3 else _in_three_directions(samples[:, 0, 0])
    if greens is not None:
        for name, row in _rows(greens.values).items():
            # To [sample, displacement, force].
            functions[f"track{name}"] = _in_three_directions(row if row.ndim == 1 else row.transpose(2, 1, 0))
    for values in functions.values():
        _clear_cross_terms(values)
    return greens_components_figure(functions=functions, dt=dt, shown=_FLEXIBLE_EARLY, title=title)
