"""Impacts in a history of the contact force: peaks, loss of contact, exceedance, and the peak of every wheel turn.

A peak is a stretch above a threshold, with the static load as its measure. While wheel and rail don't touch, the force
is exactly 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wheelrail.errors import ParameterError

__all__ = ["Impact", "ImpactStatistics", "LossOfContact", "Turn", "exceedance", "impact_statistics", "turns"]


@dataclass(frozen=True)
class Impact:
    """A stretch of the force above the threshold.

    Attributes
    ----------
    time : float
        Of the peak, s.
    position : float
        Rolled distance at the peak, m.
    peak : float
        Largest force, N.
    duration : float
        Above the threshold, s.
    impulse : float
        Of the force above the static load during that time, N s.
    """

    time: float
    position: float
    peak: float
    duration: float
    impulse: float


@dataclass(frozen=True)
class LossOfContact:
    """A stretch without contact.

    Attributes
    ----------
    time : float
        Of its beginning, s.
    duration : float
        s.
    distance : float
        Rolled meanwhile, m.
    """

    time: float
    duration: float
    distance: float


@dataclass(frozen=True)
class Turn:
    """One whole turn of the wheel.

    Attributes
    ----------
    number : int
        From 0, the first whole turn after the start.
    time : float
        Of the largest force, s.
    angle : float
        Of the wheel at the largest force since the turn's beginning, rad.
    largest, smallest : float
        Force, N.
    lost : float
        Share of the turn without contact.
    """

    number: int
    time: float
    angle: float
    largest: float
    smallest: float
    lost: float


@dataclass(frozen=True, eq=False)
class ImpactStatistics:
    """What a history of the contact force says about impacts.

    Attributes
    ----------
    static_load, threshold : float
        N.
    largest, smallest, mean, standard_deviation : float
        Of the force, N.
    percentiles : dict of float to float
        Force in N that is not exceeded in so many percent of the time.
    impacts : tuple of Impact
    losses : tuple of LossOfContact
    duration : float
        Of the history, s.
    """

    static_load: float
    threshold: float
    largest: float
    smallest: float
    mean: float
    standard_deviation: float
    percentiles: dict[float, float]
    impacts: tuple[Impact, ...]
    losses: tuple[LossOfContact, ...]
    duration: float

    @property
    def dynamic_load_factor(self) -> float:
        """Largest force over the static load."""
        return self.largest / self.static_load

    @property
    def lost_share(self) -> float:
        """Share of the time without contact."""
        return math.fsum(loss.duration for loss in self.losses) / self.duration


def impact_statistics(
    force: ArrayLike,
    *,
    dt: float,
    speed: float,
    static_load: float,
    factor: float = 1.5,
    percentiles: tuple[float, ...] = (0.1, 1.0, 5.0, 50.0, 95.0, 99.0, 99.9),
    start_time: float = 0.0,
) -> ImpactStatistics:
    """Find impacts and losses of contact.

    Parameters
    ----------
    force : array_like, shape (n,)
        Vertical contact force, positive in compression, N; each sample stands for one step.
    dt : float
        s.
    speed : float
        m/s.
    static_load : float
        N.
    factor : float
        An impact exceeds this multiple of the static load.
    percentiles : tuple of float
    start_time : float
        Of the first sample, s.

    Returns
    -------
    ImpactStatistics

    Raises
    ------
    ParameterError
        If a number is out of its range.
    ValueError
        If the force is not 1-D, empty or not finite.
    """
    values = _checked(force, dt=dt, speed=speed)
    if not (math.isfinite(static_load) and static_load > 0.0):
        raise ParameterError("static_load", static_load, "must be a number > 0 N")
    if not (math.isfinite(factor) and factor > 1.0):
        raise ParameterError("factor", factor, "must be a number > 1")
    if any(not 0.0 <= percent <= 100.0 for percent in percentiles):
        raise ParameterError("percentiles", percentiles, "all must lie between 0 and 100")
    threshold = factor * static_load
    impacts = []
    for first, stop in _stretches(values > threshold):
        at = first + int(np.argmax(values[first:stop]))
        time = start_time + at * dt
        impulse = float(np.sum(values[first:stop] - static_load)) * dt
        impacts.append(Impact(time, time * speed, float(values[at]), (stop - first) * dt, impulse))
    losses = tuple(
        LossOfContact(start_time + first * dt, (stop - first) * dt, (stop - first) * dt * speed)
        for first, stop in _stretches(values <= 0.0)
    )
    found = np.percentile(values, percentiles) if percentiles else np.empty(0)
    return ImpactStatistics(
        static_load=static_load,
        threshold=threshold,
        largest=float(values.max()),
        smallest=float(values.min()),
        mean=float(values.mean()),
        standard_deviation=float(values.std()),
        percentiles=dict(zip(percentiles, found.tolist(), strict=True)),
        impacts=tuple(impacts),
        losses=losses,
        duration=len(values) * dt,
    )


def _checked(force: ArrayLike, *, dt: float, speed: float) -> NDArray:
    values = np.asarray(force, dtype=float)
    if values.ndim != 1 or not len(values) or not np.all(np.isfinite(values)):
        raise ValueError("force must be 1-D, finite and not empty")
    for name, value in (("dt", dt), ("speed", speed)):
        if not (math.isfinite(value) and value > 0.0):
            raise ParameterError(name, value, "must be a number > 0")
    return values


def _stretches(inside: NDArray) -> list[tuple[int, int]]:
    """First row and the row after the last of each stretch of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], inside, [False])).astype(np.int8)))
    return [(int(first), int(stop)) for first, stop in edges.reshape(-1, 2)]


def exceedance(force: ArrayLike, levels: ArrayLike) -> NDArray:
    """Share of the time in which a force is above given levels.

    Parameters
    ----------
    force : array_like, shape (n,)
        N.
    levels : array_like, shape (m,)
        N.

    Returns
    -------
    ndarray, shape (m,)
        1 below the smallest force, 0 from the largest on.
    """
    ordered = np.sort(np.asarray(force, dtype=float))
    return 1.0 - np.searchsorted(ordered, np.asarray(levels, dtype=float), side="right") / len(ordered)


def turns(force: ArrayLike, *, dt: float, speed: float, radius: float, start_time: float = 0.0) -> tuple[Turn, ...]:
    """Largest and smallest force of every whole turn of the wheel, where a flat strikes once.

    Parameters
    ----------
    force : array_like, shape (n,)
        Vertical contact force, N.
    dt : float
        s.
    speed : float
        m/s.
    radius : float
        Rolling radius, m.
    start_time : float
        Of the first sample, s; turns are counted from 0 s on, and one that has begun before the first sample is left
        out.

    Returns
    -------
    tuple of Turn
        Empty if the history is shorter than a turn.

    Raises
    ------
    ParameterError
        If a number is not positive.
    """
    values = _checked(force, dt=dt, speed=speed)
    if not (math.isfinite(radius) and radius > 0.0):
        raise ParameterError("radius", radius, "must be a number > 0 m")
    period = 2.0 * math.pi * radius / speed
    found = []
    number = math.ceil(start_time / period - 1e-9)
    while True:
        # Turns and steps don't match: a step belongs to the turn in which it lies.
        first, stop = (math.ceil((bound * period - start_time) / dt - 1e-9) for bound in (number, number + 1))
        if stop > len(values):
            return tuple(found)
        part = values[first:stop]
        at = int(np.argmax(part))
        time = start_time + (first + at) * dt
        angle = (time - number * period) * speed / radius
        found.append(Turn(number, time, angle, float(part.max()), float(part.min()), float(np.mean(part <= 0.0))))
        number += 1
