"""Which wheel modes can squeal: stability of steady sliding at constant friction or at friction that falls with speed.

In full sliding the tangential force is the friction coefficient times the normal force, against the sliding. A change
of the normal force then changes the tangential one, both move wheel and rail, and with lateral and vertical motion
coupled (a contact away from the centre of the tread) the motion acts back on the normal force. With friction that
changes with the slip velocity s, the motion along the sliding acts on the tangential force directly, too:

    dF_n = -k_H D_n,     dF_e = -mu dF_n - m(p) (D_e + C dF_e),     D = G dF,     m(p) = N mu' p / (1 + p d_c / s_0),

with e the unit vector of the creepage (rail relative to wheel; the force on the rail is against it), dF the force on
the rail, D the displacement of the rail relative to the wheel, G = receptance of the wheel + receptance of the rail,
k_H the normal stiffness and C the tangential compliance of the contact, N the load, mu' the slope of the friction law
at the sliding speed s_0, d_c the distance over which friction follows its law, d mu/dt = -(s / d_c) (mu - mu_law(s)),
and p the complex frequency. Steady sliding is stable if the return difference

    (1 + k_H G_nn) (1 + m (G_ee + C)) - k_H G_ne (mu + m G_en)

has no zero with positive real part; at constant friction it is 1 + k_H (G_nn - mu G_ne). The check is independent of
the time-domain model: neither its contact algorithm nor its Green's functions are used.

What is left out: motion in the contact plane across the sliding, which turns the force and is damped by mu N / s_0; and
that particles pass through the contact. The contact is one point with one friction coefficient, which holds for memory
distances that are short against the sliding distance in one passage, the creepage times the contact's length.

A contact spring without mass and falling friction without memory have no well-posed limit: 1 + m C is zero at the real
p = 1 / (N |mu'| C), so without any motion of wheel and rail the force runs away, and in time steps as fast as they
allow. With memory this contact is stable if 1 / C > N |mu'| s_0 / d_c, so for d_c > N |mu'| s_0 C (Rice and Ruina
1983).

Sources: de Beer, Janssens and Kooijman (2003), J. Sound Vib. 267, 497-507; Pieringer (2011), section 5.3.1; Rice and
Ruina (1983), J. Appl. Mech. 50, 343-349.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from ..wheel.modes import FlexibleWheel, Mode

__all__ = ["SlidingLoop", "WheelModeStability", "mode_stability", "unstable_count"]

_STEP = 0.3  # largest change of phase between two points of a Nyquist curve, rad
_ROUNDS = 40
_CONVERGED = 1e-9
_SHARES = (10, 40, 160)  # steps in which wheel and rail are coupled
_SAME = 1e-7  # relative distance below which two poles or two zeros are one
_CORNER = 64  # points of a Nyquist curve between the real and the imaginary axis


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
    load : float
        Mean normal force, N. This and what follows count only where friction has a slope.
    sliding_speed : float
        Mean slip velocity, m/s.
    friction_slope : float
        Slope of the friction law over the slip velocity at the sliding speed, s/m; negative where friction falls.
    memory_distance : float
        Sliding distance over which the friction coefficient follows its law, m; 0: at once.
    tangential_compliance : float
        Of the contact, m/N: tangential elastic displacement per force.

    Raises
    ------
    ValueError
        For a negative value of one that can't be negative, and for a slope without load or sliding speed.
    """

    wheel: FlexibleWheel
    rail: Callable[[NDArray], NDArray]
    contact_stiffness: float
    friction_coefficient: float
    creepage: tuple[float, float]
    load: float = 0.0
    sliding_speed: float = 0.0
    friction_slope: float = 0.0
    memory_distance: float = 0.0
    tangential_compliance: float = 0.0

    def __post_init__(self) -> None:
        for name in ("load", "sliding_speed", "memory_distance", "tangential_compliance"):
            if not getattr(self, name) >= 0.0:
                raise ValueError(f"{name} = {getattr(self, name)!r} is refused: it has to be at least 0")
        if self.friction_slope and not (self.load and self.sliding_speed):
            raise ValueError("friction_slope: needs load and sliding_speed, both above 0")

    @property
    def critical_memory_distance(self) -> float:
        """Memory distance (m) down to which the contact alone is stable; 0 where friction doesn't fall."""
        return max(0.0, -self.friction_slope * self.load) * self.sliding_speed * self.tangential_compliance

    @property
    def contact_unstable(self) -> bool:
        """Whether the contact runs away by itself, without any motion of wheel and rail."""
        return self.memory_distance < self.critical_memory_distance

    def sliding_direction(self) -> NDArray:
        """Return the unit vector of the creepage, (x', y', z'); shape (3,)."""
        length = float(np.hypot(*self.creepage))
        if length == 0.0:
            raise ValueError("creepage: both components are 0, so there is no direction of sliding")
        return np.array([*self.creepage, 0.0]) / length

    def force_direction(self) -> NDArray:
        """Force on the rail per normal force, (x', y', z'); shape (3,)."""
        return np.array([0.0, 0.0, 1.0]) - self.friction_coefficient * self.sliding_direction()

    def drives(self, mode: Mode) -> bool:
        """Whether the loop can change a wheel mode."""
        normal, along = self._plane @ mode.shape
        if self.friction_slope:
            return bool(normal or along)
        return bool(normal * (normal - self.friction_coefficient * along))

    def friction_stiffness(self, s: NDArray) -> NDArray:
        """Dynamic stiffness m of friction, along the sliding, at complex s in 1/s, N/m; shape (n,)."""
        stiffness = self.load * self.friction_slope * s
        if self.friction_slope and self.memory_distance:
            stiffness = stiffness / (1.0 + s * self.memory_distance / self.sliding_speed)
        return stiffness

    def contact_difference(self, s: NDArray) -> NDArray:
        """Return difference of the contact alone, on bodies that don't move; shape (n,)."""
        return 1.0 + self.friction_stiffness(s) * self.tangential_compliance

    def added_stiffness(self, mode: Mode, s: NDArray) -> NDArray:
        """Stiffness that the contact adds to a wheel mode which alone moves, to first order, N/m; shape (n,)."""
        normal, along = self._plane @ mode.shape
        tangential = self.friction_stiffness(s) * along - self.contact_stiffness * self.friction_coefficient * normal
        return self.contact_stiffness * normal**2 + along * tangential / self.contact_difference(s)

    def return_difference(self, s: NDArray, share: float = 1.0) -> NDArray:
        """Return difference at complex s in 1/s, with the receptances multiplied by a share; shape (n,)."""
        s = np.atleast_1d(np.asarray(s, dtype=complex))
        mass, damping, stiffness, products = self._driven
        flexibility = 1.0 / (mass * s[:, None] ** 2 + damping * s[:, None] + stiffness)
        compliance = self._plane @ self.rail(s / (2j * np.pi)) @ self._plane.T + np.tensordot(flexibility, products, 1)
        (normal, cross), (cross_back, along) = share * np.moveaxis(compliance, 0, -1)
        friction = self.friction_stiffness(s)
        own = (1.0 + self.contact_stiffness * normal) * (self.contact_difference(s) + friction * along)
        return own - self.contact_stiffness * cross * (self.friction_coefficient + friction * cross_back)

    @cached_property
    def _plane(self) -> NDArray:
        """Directions of normal force and sliding, shape (2, 3)."""
        return np.array([[0.0, 0.0, 1.0], self.sliding_direction()])

    @cached_property
    def _driven(self) -> tuple[NDArray, NDArray, NDArray, NDArray]:
        """Masses, dampings, stiffnesses, shape (m,), and products of shapes, (m, 2, 2), of the driven modes."""
        modes = [mode for mode in self.wheel.all_modes if self.drives(mode)]
        mass, damping, stiffness = (
            np.array([getattr(mode, name) for mode in modes]) for name in ("mass", "damping", "stiffness")
        )
        shapes = np.array([mode.shape for mode in modes]).reshape(-1, 3) @ self._plane.T
        return mass, damping, stiffness, shapes[:, :, None] * shapes[:, None, :]


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
    The receptances are raised from 0 in steps, which comes to raising the contact's stiffness and the effect of the
    slip velocity together, and the zero that starts at the mode's pole is followed by the secant method; in finer steps
    if it does not converge or meets another mode's zero. Modes with one and the same pole, as the two of a pair have,
    are followed together.
    """
    groups: list[list[Mode]] = []
    for mode in loop.wheel.modes:
        if mode.frequency < lowest_frequency or mode.damping_ratio >= 1.0 or mode.residual or not loop.drives(mode):
            continue
        pole = _pole(mode)
        group = next((group for group in groups if abs(_pole(group[0]) - pole) < _SAME * abs(pole)), None)
        if group is None:
            groups.append([mode])
        else:
            group.append(mode)
    result: list[WheelModeStability] = []
    taken: list[complex] = []
    for group in groups:
        zeros: list[complex] = []
        found: list[bool] = []
        for steps in _SHARES:
            zeros, found = _follow(loop, group, steps)
            for i, s in enumerate(zeros):
                found[i] = found[i] and all(abs(s - other) > _SAME * abs(s) for other in taken)
            if all(found):
                break
        taken += [s for s, converged in zip(zeros, found, strict=True) if converged]
        for mode, s, converged in zip(group, zeros, found, strict=True):
            frequency, ratio = float(abs(s) / (2.0 * np.pi)), float(-s.real / abs(s))
            result.append(
                WheelModeStability(mode.name, mode.frequency, mode.damping_ratio, frequency, ratio, converged)
            )
    return tuple(sorted(result, key=lambda entry: entry.frequency))


def _pole(mode: Mode) -> complex:
    """Pole of an oscillating mode, 1/s."""
    return mode.omega * (-mode.damping_ratio + 1j * np.sqrt(1.0 - mode.damping_ratio**2))


def _follow(loop: SlidingLoop, group: list[Mode], steps: int) -> tuple[list[complex], list[bool]]:
    """Zeros that grow out of the pole of some modes as the receptances rise from 0, and whether they were found."""

    def value(point: complex, share: float, others: list[complex]) -> complex:
        result = complex(loop.return_difference(np.array([point]), share)[0])
        for mode in group:  # freed of the modes' own pole
            result *= (mode.mass * point**2 + mode.damping * point + mode.stiffness) / mode.stiffness
        for other in others:  # and of the zeros that the group's other modes have
            result *= abs(other) / (point - other)
        return result

    zeros = [_pole(mode) for mode in group]
    rates = [0j] * len(group)
    together = len(group) > 1
    if together:
        # Change of each zero with the share, at first that of the mode alone: from one and the same start it would be
        # left to chance which mode gets which zero.
        for i, (mode, pole) in enumerate(zip(group, zeros, strict=True)):
            added = complex(loop.added_stiffness(mode, np.array([pole]))[0])
            rates[i] = -added / (2.0 * mode.mass * pole + mode.damping)
    found = [False] * len(group)
    last = 0.0
    for share in (np.arange(1, steps + 1) / steps) ** 2:
        for i, before in enumerate(zeros):
            start = before + (share - last) * rates[i]
            zeros[i], found[i] = _secant(partial(value, share=share, others=zeros[:i]), start)
            if not np.isfinite(zeros[i]):
                return [*zeros[:i], before, *zeros[i + 1 :]], [False] * len(group)
            if together:
                rates[i] = (zeros[i] - before) / (share - last)
        last = share
    return zeros, found


def _secant(value: Callable[[complex], complex], start: complex) -> tuple[complex, bool]:
    """Zero of an analytic function near a point, infinite if the secant method got lost, and whether it converged."""
    before, now = start * (1.0 - 1e-6), start * (1.0 + 1e-7j)
    f_before, f_now = value(before), value(now)
    for _ in range(_ROUNDS):
        if f_now == f_before:
            return now, f_now == 0.0
        before, now, f_before = now, now - f_now * (now - before) / (f_now - f_before), f_now
        if not np.isfinite(now):
            return complex(np.inf), False
        if abs(now - before) < _CONVERGED * abs(now):
            return now, True
        f_now = value(now)
    return now, False


def unstable_count(loop: SlidingLoop, *, highest_frequency: float, lowest_frequency: float = 1.0) -> int:
    """Count growing oscillations by Nyquist's criterion.

    Parameters
    ----------
    loop : SlidingLoop
    highest_frequency, lowest_frequency : float
        Hz; range of the curve. Above, the modal receptances have to be small; zeros below aren't counted.

    Returns
    -------
    int
        Half the number of zeros with positive real part, rounded up: pairs, and one more for a single zero on the real
        axis, where something grows without oscillating. This is the case where the contact runs away by itself
        (`SlidingLoop.contact_unstable`), and where sliding diverges slowly. Two zeros on the real axis count as a pair.

    Notes
    -----
    Where friction has a slope the return difference does not go to 1 at high frequency, but with the contact's
    compliance to that of the contact alone, 1 + m C, which rises with the frequency or, with memory, to a constant that
    may be negative. Their quotient goes to 1 in any case. Its pole, the zero of 1 + m C, is the one that may lie in the
    right half plane, and is added to what the curve says.
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
    # The curve begins on the real axis, where the quotient is real, positive or negative, and goes around 0, where a
    # free body has its pole.
    corner = omega[0] * np.exp(0.5j * np.pi * np.arange(_CORNER) / _CORNER)
    s = np.concatenate([corner, 1j * omega])

    def quotient(points: NDArray) -> NDArray:
        return loop.return_difference(points) / loop.contact_difference(points)

    values = quotient(s)
    for _ in range(_ROUNDS):
        change = np.abs(np.angle(values[1:] / values[:-1]))
        coarse = np.flatnonzero(change > _STEP)
        if len(coarse) == 0:
            break
        middle = 0.5 * (s[coarse] + s[coarse + 1])
        s = np.insert(s, coarse + 1, middle)
        values = np.insert(values, coarse + 1, quotient(middle))
    # Each zero in the right half plane turns this half of the curve by -pi on the way to infinity, each pole by pi; the
    # other half is its mirror image. The end is closed to 1.
    turn = np.sum(np.angle(values[1:] / values[:-1])) - np.angle(values[-1])
    zeros = int(loop.contact_unstable) - round(float(turn) / np.pi)
    return (zeros + 1) // 2
