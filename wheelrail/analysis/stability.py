"""Which wheel modes can squeal at constant friction: stability of steady sliding.

In full sliding the tangential force is the friction coefficient times the normal force, against the sliding. A change
of the normal force then changes the tangential one, both move wheel and rail, and with lateral and vertical motion
coupled (a contact away from the centre of the tread) the motion acts back on the normal force:

    dF_n = -k_H (G_nn - mu (e_x G_nx + e_y G_ny)) dF_n,   G = receptance of the wheel + receptance of the rail,

with k_H the contact stiffness and (e_x, e_y) the unit vector of the creepage (rail relative to wheel; the force on the
rail is against it). Steady sliding is stable if 1 + k_H (...) has no zero with positive real part. It is independent of
the time-domain model: neither its contact algorithm nor its Green's functions are used.

Source: de Beer, Janssens and Kooijman (2003), J. Sound Vib. 267, 497-507; Pieringer (2011), section 5.3.1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..wheel.modes import FlexibleWheel

__all__ = ["SlidingLoop", "WheelModeStability", "mode_stability", "unstable_count"]

_STEP = 0.3  # largest change of phase between two points of a Nyquist curve, rad
_ROUNDS = 40
_CONVERGED = 1e-9
_SHARES = (10, 40, 160)  # steps in which the contact stiffness is raised
_SAME = 1e-7  # relative distance below which two zeros are one


@dataclass(frozen=True)
class SlidingLoop:
    """The loop of normal force, sliding and vibration, linearised about steady full sliding.

    Parameters
    ----------
    wheel : FlexibleWheel
    rail : callable
        Receptance of the rail at the contact: complex frequencies in Hz, shape (n,), to m/N, shape (n, 3, 3).
    contact_stiffness : float
        N/m.
    friction_coefficient : float
    creepage : tuple of 2 floats
        Longitudinal and lateral creepage; only their direction counts.
    """

    wheel: FlexibleWheel
    rail: Callable[[NDArray], NDArray]
    contact_stiffness: float
    friction_coefficient: float
    creepage: tuple[float, float]

    def force_direction(self) -> NDArray:
        """Force on the rail per normal force, (x', y', z'); shape (3,)."""
        slip = np.array([*self.creepage, 0.0])
        length = float(np.hypot(*self.creepage))
        if length == 0.0:
            raise ValueError("creepage: both components are 0, so there is no direction of sliding")
        return np.array([0.0, 0.0, 1.0]) - self.friction_coefficient * slip / length

    def return_difference(self, s: NDArray) -> NDArray:
        """1 + loop gain at complex s = i 2 pi f in 1/s; shape (n,)."""
        s = np.atleast_1d(np.asarray(s, dtype=complex))
        frequency = s / (2j * np.pi)
        force = self.force_direction()
        compliance = self.rail(frequency)[:, 2] @ force
        for mode in self.wheel.all_modes:
            gain = mode.shape[2] * float(np.dot(mode.shape, force))
            if gain:
                compliance = compliance + gain / (mode.mass * s**2 + mode.damping * s + mode.stiffness)
        return 1.0 + self.contact_stiffness * compliance


@dataclass(frozen=True)
class WheelModeStability:
    """One wheel mode in contact.

    Attributes
    ----------
    name : str
    frequency, damping_ratio : float
        Of the wheel alone, Hz and 1.
    coupled_frequency, coupled_damping_ratio : float
        In sliding contact; a negative damping ratio means that the mode grows.
    converged : bool
        Whether the mode could be followed into contact; if not, the coupled values are not to be used.
    """

    name: str
    frequency: float
    damping_ratio: float
    coupled_frequency: float
    coupled_damping_ratio: float
    converged: bool

    @property
    def unstable(self) -> bool:
        """Whether the mode is known to grow."""
        return self.converged and self.coupled_damping_ratio < 0.0

    @property
    def growth_rate(self) -> float:
        """Rate of exponential growth, 1/s; negative for decay."""
        return -2.0 * np.pi * self.coupled_frequency * self.coupled_damping_ratio


def mode_stability(loop: SlidingLoop, *, lowest_frequency: float = 100.0) -> tuple[WheelModeStability, ...]:
    """Follow every wheel mode into sliding contact.

    Parameters
    ----------
    loop : SlidingLoop
    lowest_frequency : float
        Hz; modes below are left out, and so are modes that the loop does not drive, and residual ones.

    Returns
    -------
    tuple of WheelModeStability
        In order of frequency.

    Notes
    -----
    The contact stiffness is raised from 0 in steps, and the zero that starts at the mode's pole is followed by the
    secant method; in finer steps if it does not converge or meets another mode's zero.
    """
    force = loop.force_direction()
    result: list[WheelModeStability] = []
    taken: list[complex] = []
    for mode in loop.wheel.modes:
        residue = mode.shape[2] * float(np.dot(mode.shape, force))
        if mode.frequency < lowest_frequency or residue == 0.0 or mode.damping_ratio >= 1.0 or mode.residual:
            continue
        s, converged = 0j, False
        for steps in _SHARES:
            s, converged = _follow(loop, mode.mass, mode.damping, mode.stiffness, steps)
            converged = converged and all(abs(s - other) > _SAME * abs(s) for other in taken)
            if converged:
                taken.append(s)
                break
        size = abs(s)
        result.append(
            WheelModeStability(
                mode.name,
                mode.frequency,
                mode.damping_ratio,
                size / (2.0 * np.pi),
                -s.real / size,
                converged,
            )
        )
    return tuple(sorted(result, key=lambda entry: entry.frequency))


def _follow(loop: SlidingLoop, mass: float, damping: float, stiffness: float, steps: int) -> tuple[complex, bool]:
    """Zero that grows out of a mode's pole as the contact stiffness rises from 0, and whether it was found."""
    omega = np.sqrt(stiffness / mass)
    zeta = damping / (2.0 * mass * omega)
    s = omega * (-zeta + 1j * np.sqrt(1.0 - zeta**2))

    def value(point: complex, share: float) -> complex:
        difference = loop.return_difference(np.array([point]))[0]
        # 1 + share * gain, freed of the mode's own pole.
        return (1.0 + share * (difference - 1.0)) * (mass * point**2 + damping * point + stiffness) / stiffness

    converged = False
    for share in (np.arange(1, steps + 1) / steps) ** 2:
        converged = False
        before, now = s * (1.0 - 1e-6), s * (1.0 + 1e-7j)
        f_before, f_now = value(before, share), value(now, share)
        for _ in range(_ROUNDS):
            if f_now == f_before:
                converged = f_now == 0.0
                break
            before, now, f_before = now, now - f_now * (now - before) / (f_now - f_before), f_now
            if not np.isfinite(now):
                return s, False
            if abs(now - before) < _CONVERGED * abs(now):
                converged = True
                break
            f_now = value(now, share)
        s = now
    return s, converged


def unstable_count(loop: SlidingLoop, *, highest_frequency: float, lowest_frequency: float = 1.0) -> int:
    """Count growing oscillations by Nyquist's criterion.

    Parameters
    ----------
    loop : SlidingLoop
    highest_frequency, lowest_frequency : float
        Hz; range of the curve. Above, the modal receptances have to be small.

    Returns
    -------
    int
        Number of pairs of zeros with positive real part.
    """
    omega = 2.0 * np.pi * np.geomspace(lowest_frequency, highest_frequency, 4000)
    peaks = []
    for mode in loop.wheel.all_modes:
        if mode.stiffness and mode.damping_ratio < 1.0:
            width = max(mode.damping_ratio, 1e-6) * mode.omega
            spread = np.sinh(np.linspace(-12.0, 12.0, 241)) * width * 0.1
            peaks.append(mode.omega + spread[np.abs(spread) < 0.05 * mode.omega])
    omega = np.unique(np.concatenate([omega, *peaks]))
    omega = omega[(omega >= 2.0 * np.pi * lowest_frequency) & (omega <= 2.0 * np.pi * highest_frequency)]
    values = loop.return_difference(1j * omega)
    for _ in range(_ROUNDS):
        change = np.abs(np.angle(values[1:] / values[:-1]))
        coarse = np.flatnonzero(change > _STEP)
        if len(coarse) == 0:
            break
        middle = 0.5 * (omega[coarse] + omega[coarse + 1])
        omega = np.insert(omega, coarse + 1, middle)
        values = np.insert(values, coarse + 1, loop.return_difference(1j * middle))
    # A pair of zeros in the right half plane turns the curve by -2 pi between 0 and infinity, as the loop has no poles
    # there. The ends are closed to the real axis, which the curve meets at 0 and at infinity.
    turn = np.sum(np.angle(values[1:] / values[:-1])) + np.angle(values[0]) - np.angle(values[-1])
    return -round(float(turn) / (2.0 * np.pi))
