"""Exact receptance of the discretely supported track: Timoshenko's differential equations solved in each bay.

Between supports, forces and points looked at, the rail's steady motion follows the exact transfer matrix of the
Rayleigh-Timoshenko equations, whose dynamic stiffness joins the points. There is no mesh, so it shows what a finite
element mesh of the same track falls short of.

Sources: Timoshenko (1921), Phil. Mag. 41; transfer matrices as in Pestel and Leckie (1963), Matrix Methods in
Elastomechanics.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import expm, solve_banded

from ..track.discrete import DiscreteTrack

__all__ = ["exact_receptance", "pinned_pinned_frequency"]

MERGE = 1e-9  # points closer than this share of the sleeper spacing are one
_BANDWIDTH = 3


def pinned_pinned_frequency(track: DiscreteTrack) -> float:
    """First natural frequency in Hz of one bay of the rail alone, simply supported at the sleepers.

    With w ~ sin(k x), theta ~ cos(k x), k = pi / L_s, the equations of motion become
    (EI k^2 + kGA - rho I w^2) (kGA k^2 - m' w^2) = (kGA k)^2; the lower root for w^2 belongs to bending.
    """
    k = math.pi / track.sleeper_spacing
    bending, shear = track.bending_stiffness * k**2, track.shear_stiffness
    a = track.rotary_inertia * track.mass_per_length
    b = track.mass_per_length * (bending + shear) + track.rotary_inertia * shear * k**2
    c = bending * shear * k**2
    return math.sqrt(2.0 * c / (b + math.sqrt(b * b - 4.0 * a * c))) / (2.0 * math.pi)


def _segment(track: DiscreteTrack, length: float, omega: float) -> NDArray:
    """Dynamic stiffness of a free piece of rail for (w1, theta1, w2, theta2), shape (4, 4).

    State along the rail: w, theta, shear force Q = kGA (w' - theta), bending moment M = EI theta'.
    """
    rates = np.zeros((4, 4))
    rates[0, 1], rates[0, 2] = 1.0, 1.0 / track.shear_stiffness
    rates[1, 3] = 1.0 / track.bending_stiffness
    rates[2, 0] = -(omega**2) * track.mass_per_length
    rates[3, 1], rates[3, 2] = -(omega**2) * track.rotary_inertia, -1.0
    transfer = expm(rates * length)
    uu, uf, fu, ff = transfer[:2, :2], transfer[:2, 2:], transfer[2:, :2], transfer[2:, 2:]
    inverse = np.linalg.inv(uf)
    # Forces on the piece from outside: -(Q, M) at its left end, +(Q, M) at its right end.
    return np.block([[inverse @ uu, -inverse], [fu - ff @ inverse @ uu, ff @ inverse]])


def exact_receptance(track: DiscreteTrack, x0: float, x: ArrayLike, frequency: ArrayLike) -> NDArray:
    """Receptance of the track whose finite elements are infinitely small.

    Parameters
    ----------
    track : DiscreteTrack
        Its ``elements_per_bay`` is without effect.
    x0 : float
        Position of the force in m from the middle sleeper.
    x : array_like, shape (n,)
        Positions of the response in m.
    frequency : array_like, shape (m,)
        In Hz, positive.

    Returns
    -------
    ndarray of complex, shape (m, n)
        Displacement per force in m/N, time factor exp(+i omega t).

    Raises
    ------
    ValueError
        If a point does not lie between the clamped ends.
    """
    positions = np.concatenate([[x0], np.atleast_1d(np.asarray(x, dtype=float))])
    if np.any(np.abs(positions) >= track.half_length):
        raise ValueError(f"positions must lie within +-{track.half_length:g} m of the middle sleeper")
    sleepers = track.sleeper_spacing * np.arange(1 - track.bays // 2, track.bays // 2)
    merge = MERGE * track.sleeper_spacing
    extra: list[float] = []
    for position in positions:
        if np.min(np.abs(np.concatenate([sleepers, extra]) - position)) > merge:
            extra.append(float(position))
    points = np.sort(np.concatenate([[-track.half_length, track.half_length], sleepers, extra]))
    nodes = [int(np.argmin(np.abs(points - position))) - 1 for position in positions]
    supported = 2 * (np.searchsorted(points, sleepers - merge) - 1)
    lengths, kind = np.unique(np.round(np.diff(points) / merge), return_inverse=True)
    size = 2 * (len(points) - 2)
    frequency = np.atleast_1d(np.asarray(frequency, dtype=float))
    result = np.empty((len(frequency), len(nodes) - 1), dtype=complex)
    force = np.zeros(size, dtype=complex)
    force[2 * nodes[0]] = 1.0
    for line, f in enumerate(frequency):
        stiffness = [_segment(track, length * merge, 2.0 * np.pi * f) for length in lengths]
        band = np.zeros((2 * _BANDWIDTH + 1, size + 4), dtype=complex)
        for segment, which in enumerate(kind):
            for i in range(4):
                for j in range(4):
                    band[_BANDWIDTH + i - j, 2 * segment + j] += stiffness[which][i, j]
        # The clamped ends drop out; the couplings to them lie outside the matrix, where solve_banded does not look.
        band = band[:, 2:-2]
        band[_BANDWIDTH, supported] += track.support_stiffness(f)
        response = solve_banded((_BANDWIDTH, _BANDWIDTH), band, force)
        result[line] = response[[2 * node for node in nodes[1:]]]
    return result
