"""Frequencies at which wheel, track and contact resonate, from their receptances."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from wheelrail.interaction.tracks import TrackModel, track_receptance
from wheelrail.interaction.wheels import WheelModel, vertical_receptance
from wheelrail.track.discrete import DiscreteTrack

__all__ = ["interaction_peaks", "pinned_pinned_frequency"]

_LOWEST = 20.0  # Hz


def pinned_pinned_frequency(track: DiscreteTrack) -> float | None:
    """Find the frequency of the first pinned-pinned mode, from the peak of the receptance at midspan.

    Parameters
    ----------
    track : DiscreteTrack

    Returns
    -------
    float or None
        Hz; None if there is no peak near that of a Timoshenko beam on pins (Pieringer 2011, section 3.3.1).
    """
    k2 = (math.pi / track.sleeper_spacing) ** 2
    EI, kGA = track.bending_stiffness, track.shear_stiffness
    m, rho_i = track.mass_per_length, track.rotary_inertia
    # m rho_i w^4 - (kGA rho_i k^2 + EI m k^2 + kGA m) w^2 + EI kGA k^4 = 0
    p = (kGA * rho_i + EI * m) * k2 + kGA * m
    omega2 = (p - math.sqrt(p * p - 4.0 * m * rho_i * EI * kGA * k2 * k2)) / (2.0 * m * rho_i)
    near = math.sqrt(omega2) / (2.0 * math.pi)
    midspan = 0.5 * track.sleeper_spacing

    def size(frequency: NDArray) -> NDArray:
        return np.abs(track.receptance(midspan, [midspan], frequency)[:, 0])

    peaks = _peaks(size, np.linspace(0.85 * near, 1.15 * near, 61))
    return min(peaks, key=lambda f: abs(f - near)) if peaks else None


def interaction_peaks(
    wheel: WheelModel | None, track: TrackModel | None, *, contact_stiffness: float, x: float, highest: float
) -> list[float]:
    """Find where roughness makes the largest contact force, linearised: peaks of 1 / |a_W + a_R + 1 / k_H|.

    With the receptances a of wheel and rail, F = r / (a_W + a_R + 1 / k_H) (Thompson 2009, Railway noise and
    vibration).

    Parameters
    ----------
    wheel, track : wheel and track models or None
        From `wheelrail.interaction.build`.
    contact_stiffness : float
        k_H in N/m.
    x : float
        Position of the contact from a sleeper, m.
    highest : float
        Hz.

    Returns
    -------
    list of float
        Hz, ascending.
    """

    def size(frequency: NDArray) -> NDArray:
        total = np.full(len(frequency), 1.0 / contact_stiffness, dtype=complex)
        if wheel is not None:
            total += vertical_receptance(wheel, frequency)
        if track is not None:
            total += track_receptance(track, x, frequency)
        return 1.0 / np.abs(total)

    return _peaks(size, np.geomspace(_LOWEST, highest, 500), least=1.05)


def _peaks(size: Callable[[NDArray], NDArray], frequency: NDArray, *, least: float = 1.0) -> list[float]:
    """Inner maxima that stand out from the minima beside them by a factor ``least``, refined."""
    values = size(frequency)
    found = []
    for i in range(1, len(values) - 1):
        if not values[i - 1] < values[i] >= values[i + 1]:
            continue
        left = right = i
        while left > 0 and values[left - 1] < values[left]:
            left -= 1
        while right < len(values) - 1 and values[right + 1] < values[right]:
            right += 1
        if values[i] >= least * max(values[left], values[right]):
            best: Any = minimize_scalar(
                lambda f: -float(size(np.array([f]))[0]),
                bounds=(frequency[i - 1], frequency[i + 1]),
                method="bounded",
                options={"xatol": 1e-4 * frequency[i]},
            )
            found.append(float(best.x))
    return found
