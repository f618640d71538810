"""Moving Green's functions of the track (Nordborg 2002; Pieringer 2011, eqs. 3.11 to 3.14).

Sample n of the function for position x0 is the rail's displacement at x0 + (n - 1) dx, (n - 1) dt after a force at x0.
The force is taken as piecewise linear in time, as in `wheelrail.greens.ordinary`; eq. 3.14 as printed is "sampled".

Length: the functions end where the energy (sum of squares) between the end and a horizon is, for every x0, at most a
given share of the whole. The horizon is the longest time for which the moving point stays well inside the track, at
most `LONGEST_HORIZON`. A rail without own damping keeps a weak ring at its pinned-pinned frequency for much longer than
that; how much is neglected is reported with the result.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .ordinary import Discretisation

__all__ = ["MovingGreens", "PeriodicTrack", "PeriodicTrackMotion", "compute_moving_greens"]

ENERGY_TOLERANCE = 1e-3
LONGEST_HORIZON = 0.5  # s
MARGIN_BAYS = 5  # the moving point keeps this distance from the track's end
_CHUNK = 256


class PeriodicTrackMotion(Protocol):
    """Motion of a periodic track after short unit forces on the degrees of freedom of one bay."""

    def start_hat(self) -> None: ...  # noqa: D102

    def finish_hat(self) -> None: ...  # noqa: D102

    def start_impulse(self, dt: float, /) -> None: ...  # noqa: D102

    def step(self) -> None: ...  # noqa: D102

    def bay_response(self, bay: int, /) -> NDArray: ...  # noqa: D102


class PeriodicTrack(Protocol):
    """What a track on equal bays offers."""

    @property
    def sleeper_spacing(self) -> float: ...  # noqa: D102

    @property
    def half_length(self) -> float: ...  # noqa: D102

    def motion(self, dt: float, /) -> PeriodicTrackMotion: ...  # noqa: D102

    def bay_shape_functions(self, positions: int, /) -> NDArray: ...  # noqa: D102

    def bay_local_compliance(self, positions: int, /) -> NDArray: ...  # noqa: D102


@dataclass(frozen=True)
class MovingGreens:
    """Discretised moving Green's functions.

    Attributes
    ----------
    values : ndarray, shape (positions, samples)
        g^{v,x0}(n) in m/N for x0 = 0, dx, ... within a bay.
    dx, dt : float
        m and s.
    neglected_energy : ndarray, shape (positions,)
        Energy between the end and the horizon over the whole energy.
    neglected_compliance : ndarray, shape (positions,)
        Sum of the samples between the end and the horizon over the sum of all.
    horizon : float
        s.
    """

    values: NDArray
    dx: float
    dt: float
    neglected_energy: NDArray
    neglected_compliance: NDArray
    horizon: float


def horizon_of(track: PeriodicTrack, speed: float) -> float:
    """Longest time in s that Green's functions of this track at this speed (m/s) can have."""
    stretch = track.half_length - (MARGIN_BAYS + 1) * track.sleeper_spacing
    return min(stretch / speed, LONGEST_HORIZON)


def compute_moving_greens(
    track: PeriodicTrack,
    *,
    speed: float,
    dx: float,
    memory: float | None = None,
    energy_tolerance: float = ENERGY_TOLERANCE,
    discretisation: Discretisation = "linear",
    progress: Callable[[float], None] | None = None,
) -> MovingGreens:
    """Compute the moving Green's functions of every position in a bay.

    Parameters
    ----------
    track : PeriodicTrack
    speed, dx : float
        m/s and m; the sleeper spacing must be a multiple of dx.
    memory : float, optional
        Length in s; by default it follows from ``energy_tolerance``.
    energy_tolerance : float
        Largest share of energy between the end and the horizon.
    discretisation : {"linear", "sampled"}
    progress : callable, optional
        Called with the share done, 0 to 1.

    Returns
    -------
    MovingGreens

    Raises
    ------
    ValueError
        If the spacing is no multiple of dx or the memory leaves the track.
    """
    positions = round(track.sleeper_spacing / dx)
    if positions < 1 or abs(positions * dx - track.sleeper_spacing) > 1e-9 * track.sleeper_spacing:
        raise ValueError(f"sleeper spacing {track.sleeper_spacing:g} m is no multiple of dx = {dx:g} m")
    dt = dx / speed
    horizon = horizon_of(track, speed)
    if memory is not None:
        if memory > (track.half_length - 2.0 * track.sleeper_spacing) / speed:
            raise ValueError(f"a memory of {memory:g} s leaves the track; at {speed:g} m/s it needs more bays")
        horizon = memory
    samples = max(int(horizon / dt), 2)
    shapes = track.bay_shape_functions(positions)
    motion = track.motion(dt)
    values = np.empty((positions, samples))
    chunk = np.empty((_CHUNK, positions))  # filled line by line, since writing columns of the result is slow
    if discretisation == "linear":
        motion.start_hat()
    else:
        motion.start_impulse(dt)
    for n in range(samples):
        bay, shift = divmod(n, positions)
        response = np.empty_like(shapes)
        response[: positions - shift] = shapes[shift:] @ motion.bay_response(bay)
        if shift:
            response[positions - shift :] = shapes[:shift] @ motion.bay_response(bay + 1)
        line = n % _CHUNK
        np.einsum("ij,ij->i", response, shapes, out=chunk[line])
        if n == 0 and discretisation == "sampled":
            chunk[0] *= 0.5
        if n == 0:  # only the present force has a local deflection
            chunk[0] += track.bay_local_compliance(positions)
        if line == _CHUNK - 1 or n == samples - 1:
            values[:, n - line : n + 1] = chunk[: line + 1].T
            if progress:
                progress((n + 1) / samples)
        if n == 0 and discretisation == "linear":
            motion.finish_hat()
        else:
            motion.step()
    return _cut(values, dx=dx, dt=dt, horizon=horizon, energy_tolerance=0.0 if memory else energy_tolerance)


def _cut(values: NDArray, *, dx: float, dt: float, horizon: float, energy_tolerance: float) -> MovingGreens:
    """Cut the functions where the energy beyond falls below the tolerance for every position."""
    keep = 2
    for row in values:  # row by row: the squares of all at once would double the memory
        remaining = np.cumsum(row[::-1] ** 2)[::-1]
        keep = max(keep, int(np.count_nonzero(remaining > energy_tolerance * remaining[0])))
    energy = np.array([np.sum(row[keep:] ** 2) / np.sum(row**2) for row in values])
    compliance = np.array([np.sum(row[keep:]) / np.sum(row) for row in values])
    kept = values[:, :keep].copy()
    kept[:, -1] *= 0.5  # eq. 3.14: the last sample is halved
    return MovingGreens(kept, dx, dt, energy, compliance, horizon)
