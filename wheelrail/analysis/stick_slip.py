"""Stick and slip of a contact along a run: phases, cycles, and whether these repeat regularly.

`wheelrail.analysis.squeal` measures level and frequency of the vibration; here the share of the contact area that slips
is followed in time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wheelrail.errors import ParameterError

__all__ = ["STATES", "StickSlip", "slip_states", "stick_slip"]

STATES = ("no contact", "stick", "partial slip", "full slip")
"""What `slip_states` counts from 0 on."""

_FULL = 1.0 - 1e-9


@dataclass(frozen=True, eq=False)
class StickSlip:
    """Stick/slip of a stretch of a run.

    Attributes
    ----------
    shares : dict of str to float
        Share of the time in each of `STATES`; together 1.
    episodes : dict of str to int
        Number of uninterrupted stretches in each.
    cycles : int
        Whole cycles: from one beginning of full slip to the next, with stick of at least a part of the area between.
    frequency : float
        One over the mean period of the cycles without those that are half as long again as the median, or shorter by
        as much (a cycle missed, or one too many), Hz; NaN with less than one whole cycle.
    spread : float
        Standard deviation of the cycles' periods over their mean; NaN with less than two whole cycles.
    steps : float
        Mean length of a cycle in time steps; NaN with less than one whole cycle.
    periodicity : float
        Largest value of the force's autocorrelation coefficient between half a period and ten and a half, so that it is
        found also where a period is no whole number of steps: 1 for a force that repeats; NaN with less than two whole
        cycles.
    """

    shares: dict[str, float]
    episodes: dict[str, int]
    cycles: int
    frequency: float
    spread: float
    steps: float
    periodicity: float

    @property
    def occurs(self) -> bool:
        """Whether the contact sticks and slips in turn."""
        return self.cycles >= 1

    def regular(self, *, spread: float = 0.1, periodicity: float = 0.8) -> bool:
        """Whether cycles repeat: three at least, of like period, under a force that repeats.

        A period of 4.4 steps shows as one of 4 or 5: half a step of spread is that of the grid.
        """
        return self.cycles >= 3 and self.spread <= spread + 0.5 / self.steps and self.periodicity >= periodicity


def slip_states(slip_fraction: ArrayLike, *, in_contact: ArrayLike) -> NDArray:
    """State of the contact in each step.

    Parameters
    ----------
    slip_fraction : array_like, shape (n,)
        Slipping share of the contact area.
    in_contact : array_like, shape (n,)
        True, or a force > 0, where wheel and rail touch.

    Returns
    -------
    ndarray of int, shape (n,)
        Index into `STATES`.

    Raises
    ------
    ValueError
        If shapes differ, or a share is not between 0 and 1.
    """
    slip = np.asarray(slip_fraction, dtype=float)
    touching = np.asarray(in_contact) > 0
    if slip.ndim != 1 or slip.shape != touching.shape or not len(slip):
        raise ValueError("slip_fraction and in_contact must be 1-D, of the same length and not empty")
    if not np.all((slip >= 0.0) & (slip <= 1.0 + 1e-9)):
        raise ValueError("slip_fraction must lie between 0 and 1")
    return np.where(~touching, 0, np.where(slip >= _FULL, 3, np.where(slip > 0.0, 2, 1)))


def stick_slip(*, slip_fraction: ArrayLike, in_contact: ArrayLike, force: ArrayLike, dt: float) -> StickSlip:
    """Follow stick and slip in time.

    Parameters
    ----------
    slip_fraction, in_contact : array_like, shape (n,)
        As `slip_states` takes them.
    force : array_like, shape (n,)
        Tangential contact force, N, to see whether it repeats.
    dt : float
        s.

    Returns
    -------
    StickSlip

    Raises
    ------
    ValueError
        As `slip_states`, or if the force has another length.
    ParameterError
        If ``dt`` is not positive.
    """
    if not (math.isfinite(dt) and dt > 0.0):
        raise ParameterError("dt", dt, "must be a number > 0 s")
    states = slip_states(slip_fraction, in_contact=in_contact)
    tangential = np.asarray(force, dtype=float)
    if tangential.shape != states.shape:
        raise ValueError("force must be as long as slip_fraction")
    begins = np.flatnonzero(np.diff(states, prepend=-1))
    phases = states[begins]
    shares = {name: float(np.mean(states == number)) for number, name in enumerate(STATES)}
    episodes = {name: int(np.count_nonzero(phases == number)) for number, name in enumerate(STATES)}
    onsets = _onsets(states)
    periods = np.diff(onsets) * dt
    count = len(periods)
    frequency = 1.0 / _typical(periods) if count else math.nan
    return StickSlip(
        shares=shares,
        episodes=episodes,
        cycles=count,
        frequency=frequency,
        spread=float(periods.std() / periods.mean()) if count > 1 else math.nan,
        steps=1.0 / (frequency * dt),
        periodicity=_periodicity(tangential, period=1.0 / (frequency * dt)) if count > 1 else math.nan,
    )


def _typical(periods: NDArray) -> float:
    """Mean of the periods that are like most."""
    median = float(np.median(periods))
    return float(np.mean(periods[(periods > median / 1.5) & (periods < 1.5 * median)]))


def _onsets(states: NDArray) -> NDArray:
    """Rows at which full slip begins after stick of a part of the area; loss of contact ends no phase."""
    rows = np.flatnonzero(states > 0)
    full = states[rows] == 3
    return rows[1:][full[1:] & ~full[:-1]]


def _periodicity(force: NDArray, *, period: float) -> float:
    """Largest autocorrelation coefficient from half a period (in steps) on, each lag over its own overlap."""
    signal = force - force.mean()
    count = len(signal)
    last = min(round(10.5 * period), count // 2)
    first = min(max(round(0.5 * period), 1), last)
    # By FFT, padded so that nothing wraps round.
    power = np.abs(np.fft.rfft(signal, 2 * count)) ** 2
    products = np.fft.irfft(power)[first : last + 1]
    squares = np.concatenate(([0.0], np.cumsum(signal**2)))
    lags = np.arange(first, last + 1)
    energy = np.sqrt(squares[count - lags] * (squares[-1] - squares[lags]))
    if not np.all(energy > 0.0):
        return 0.0
    return float(np.max(products / energy))
