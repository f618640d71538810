"""Decay of vibration along the rail per third-octave band, as EN 15461 measures it, from a track's receptances.

EN 15461:2008+A1:2010: an accelerometer sits in the middle of a sleeper bay, and a hammer strikes the rail at 29 places
beside it. With the frequency response A(x_n) of each place, the decay rate is

    DR = 4.343 / sum of |A(x_n)|^2 / |A(x_0)|^2 dx_n   in dB/m    (clause 7, formula 1),

dx_n reaching halfway to the neighbours, at the first place only forwards, at the last as far forwards as backwards
(annex A.2). A wave that decays as exp(-beta x) has 8.686 beta. The sum holds the near field as well, which a wave's own
decay does not: rates come out higher than those (Thompson et al.). Force and response change places here, which a
reciprocal track does not notice.
"""

from __future__ import annotations

import csv
import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wheelrail.errors import ParameterError
from wheelrail.interaction.tracks import TrackModel
from wheelrail.numerics.third_octave_bands import EDGE_RATIO, band_numbers, centres_between, exact_centres
from wheelrail.track.discrete import DiscreteTrack

__all__ = [
    "DIRECTIONS",
    "GRID",
    "DecayRate",
    "decay_rate",
    "decay_rate_limit",
    "grid_positions",
    "track_decay_rate",
]

GRID = (
    *(0.25 * n for n in range(11)),
    *(3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0),
    *(10.0, 12.0, 16.0, 20.0, 24.0, 30.0, 36.0, 42.0, 48.0, 54.0, 66.0),
)
"""Places of the hammer from the accelerometer, in sleeper bays (EN 15461, 6.7, figure 2)."""

DIRECTIONS = {"vertical": 2, "lateral": 1}
"""Directions that EN 15461 asks for, and their index among (x', y', z')."""

_DECIBELS = 10.0 / math.log(10.0)  # the standard rounds it to 4.343
_UNSUPPORTED_SPACING = 0.6  # m, of the grid where there are no sleepers (6.7)
_SUFFICIENT_DROP = 10.0  # dB over the whole grid (6.7)
_BEYOND = 140  # bays between the last place and the end of the track
_STEEPEST = 0.5  # change of ln |A|^2 between neighbouring frequencies
_FINEST = 0.02  # Hz, between frequencies


@dataclass(frozen=True, eq=False)
class DecayRate:
    """Decay rates in one direction.

    Attributes
    ----------
    centres : ndarray, shape (bands,)
        Exact centre frequencies, Hz.
    rates : ndarray, shape (bands,)
        dB/m.
    drops : ndarray, shape (bands,)
        Level of the response at the nearest place over that at the farthest one, dB.
    positions : ndarray, shape (places,)
        m from the force.
    """

    centres: NDArray
    rates: NDArray
    drops: NDArray
    positions: NDArray

    @property
    def lowest(self) -> float:
        """Lowest rate that the grid can tell, 4.343 / x_max, dB/m (formula 2)."""
        return _DECIBELS / float(self.positions[-1])

    @property
    def measurable(self) -> NDArray:
        """Where the rate is at least twice the lowest one and the drop 10 dB (clauses 7 and 6.7), shape (bands,).

        Elsewhere the rate is an upper bound of the true one.
        """
        return (self.rates >= 2.0 * self.lowest) & (self.drops >= _SUFFICIENT_DROP)


def grid_positions(sleeper_spacing: float | None) -> NDArray:
    """Places of the hammer in m from the accelerometer, shape (29,).

    Parameters
    ----------
    sleeper_spacing : float or None
        m; None: no sleepers, and 0.6 m in their place.
    """
    return np.array(GRID) * (_UNSUPPORTED_SPACING if sleeper_spacing is None else sleeper_spacing)


def decay_rate(squares: ArrayLike, positions: ArrayLike) -> NDArray:
    """Decay rate from responses along the rail (EN 15461, formula 1).

    Parameters
    ----------
    squares : array_like, shape (places, ...)
        Squared magnitudes of the response; any unit.
    positions : array_like, shape (places,)
        m, from 0 on, increasing.

    Returns
    -------
    ndarray, shape (...)
        dB/m.

    Raises
    ------
    ParameterError
        If the positions don't begin with 0 or don't increase.
    ValueError
        If there is not one response for each position, or one is negative or not finite.
    """
    places = np.asarray(positions, dtype=float)
    if places.ndim != 1 or len(places) < 2 or places[0] != 0.0 or not np.all(np.diff(places) > 0.0):
        raise ParameterError("positions", positions, "at least two, the first 0 m, and increasing")
    values = np.asarray(squares, dtype=float)
    if values.shape[:1] != places.shape or not np.all(np.isfinite(values)) or np.any(values < 0.0):
        raise ValueError("squares must hold one finite number >= 0 for each position")
    if not np.all(values[0] > 0.0):
        raise ValueError("the response at the first position must not be 0")
    steps = np.diff(places)
    lengths = 0.5 * (np.append(steps, steps[-1]) + np.append(0.0, steps))
    return _DECIBELS / np.tensordot(lengths, values / values[0], axes=1)


def track_decay_rate(
    track: TrackModel,
    *,
    directions: Sequence[str] | None = None,
    positions: ArrayLike | None = None,
    lowest: float = 89.0,
    highest: float = 5650.0,
    lines: int = 12,
) -> dict[str, DecayRate]:
    """Decay rates of a track, the force at midspan.

    Parameters
    ----------
    track : DiscreteTrack or WaveguideTrack
        A discrete track is made long enough for its clamped ends not to matter. The lateral response of a waveguide is
        that at the contact on the head.
    directions : sequence of str, optional
        Of `DIRECTIONS`; left out: all that the track has. A beam has the vertical one.
    positions : array_like, shape (places,), optional
        m; left out: `grid_positions`.
    lowest, highest : float
        Bands wholly between them, Hz; by default the standard's 100 Hz to 5 kHz.
    lines : int
        Frequencies in each band, at least; there are more around peaks.

    Returns
    -------
    dict of str to DecayRate
        By direction.

    Raises
    ------
    ParameterError
        Unknown direction, positions or bands.
    """
    offered = ("vertical",) if isinstance(track, DiscreteTrack) else tuple(DIRECTIONS)
    wanted = offered if directions is None else tuple(directions)
    for name in wanted:
        if name not in offered:
            raise ParameterError("directions", name, f"this track has: {', '.join(offered)}")
    spacing = track.sleeper_spacing
    places = grid_positions(spacing) if positions is None else np.asarray(positions, dtype=float)
    if not (0.0 < lowest < highest):
        raise ParameterError("lowest", lowest, f"must be > 0 Hz and below the highest frequency, {highest:g} Hz")
    centres = centres_between(lowest, highest)
    if not len(centres):
        raise ParameterError("highest", highest, f"no third-octave band lies between {lowest:g} Hz and this")
    x0 = 0.0 if spacing is None else 0.5 * spacing
    edges = np.append(centres / EDGE_RATIO, centres[-1] * EDGE_RATIO)
    frequency, squares = _resolved(lambda f: _mobility_squares(track, x0, places, f, wanted), edges, lines)
    rows = np.searchsorted(frequency, edges)
    result = {}
    for name, values in zip(wanted, squares, strict=True):
        bands = np.array(
            [
                np.trapezoid(values[first : last + 1], frequency[first : last + 1], axis=0)
                for first, last in itertools.pairwise(rows)
            ]
        ).T
        result[name] = DecayRate(centres, decay_rate(bands, places), 10.0 * np.log10(bands[0] / bands[-1]), places)
    return result


def _resolved(squares: Callable[[NDArray], NDArray], edges: NDArray, lines: int) -> tuple[NDArray, NDArray]:
    """Frequencies close enough together for every peak of the response at the first place, and the responses there.

    A rail without loss on sleepers has pinned-pinned resonances that are a fraction of a hertz wide.

    Returns
    -------
    frequency : ndarray, shape (n,)
        Hz; holds the edges.
    values : ndarray, shape (directions, n, places)
    """
    inside = np.arange(lines) / lines
    frequency = np.append((edges[:-1, None] + np.diff(edges)[:, None] * inside).ravel(), edges[-1])
    values = squares(frequency)
    while True:
        level = np.log(values[:, :, 0])
        steep = np.abs(np.diff(level, axis=1)).max(axis=0) > _STEEPEST
        # The top of a peak has a flank on either side, and so may be between two that are not steep.
        steep[1:-1] |= steep[:-2] | steep[2:]
        split = steep & (np.diff(frequency) > _FINEST)
        if not np.any(split):
            return frequency, values
        between = 0.5 * (frequency[:-1] + frequency[1:])[split]
        where = np.flatnonzero(split) + 1
        values = np.insert(values, where, squares(between), axis=1)
        frequency = np.insert(frequency, where, between)


def _mobility_squares(
    track: TrackModel, x0: float, places: NDArray, frequency: NDArray, directions: Sequence[str]
) -> NDArray:
    """Squared mobilities at the places for a force at x0, (m/(N s))^2; shape (directions, frequencies, places)."""
    responses = _responses(track, x0, places, frequency, directions)
    return np.array([np.abs(2.0 * np.pi * frequency * responses[name]).T ** 2 for name in directions])


def _responses(
    track: TrackModel, x0: float, places: NDArray, frequency: NDArray, directions: Sequence[str]
) -> dict[str, NDArray]:
    """Receptances at the places for a force at x0, each of shape (places, frequencies), m/N."""
    if isinstance(track, DiscreteTrack):
        bays = 2 * (math.ceil((x0 + float(places[-1])) / track.sleeper_spacing) + _BEYOND)
        long = replace(track, bays=max(bays, track.bays))
        return {name: long.receptance(x0, x0 + places, frequency).T for name in directions}
    values = np.array([track.receptance(frequency, x0, x0 + place) for place in places])
    return {name: values[:, :, DIRECTIONS[name], DIRECTIONS[name]] for name in directions}


@cache
def decay_rate_limit(direction: str) -> tuple[NDArray, NDArray]:
    """Lowest decay rates of a reference track (EN ISO 3095:2013, 6.2.6, figure 3).

    Parameters
    ----------
    direction : {"vertical", "lateral"}

    Returns
    -------
    centres : ndarray, shape (14,)
        Exact centre frequencies, 250 Hz to 5 kHz.
    limits : ndarray, shape (14,)
        dB/m.

    Raises
    ------
    ParameterError
        If the direction is another.
    """
    if direction not in DIRECTIONS:
        raise ParameterError("direction", direction, f"allowed: {', '.join(DIRECTIONS)}")
    text = resources.files("wheelrail.analysis").joinpath("track_decay_rate_limits.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    centres = exact_centres(band_numbers(np.array([float(row["frequency_Hz"]) for row in rows])))
    limits = np.array([float(row[direction]) for row in rows])
    centres.flags.writeable = limits.flags.writeable = False
    return centres, limits
