"""Direct time integration of track, wheel and contact: an independent check of the Green's functions.

The finite element track, the wheel and the contact are integrated as one system by Newmark's method (average
acceleration), the contact force moving along the rail through the elements' shape functions. Nothing of the moving
Green's functions, their discretisation or the interaction step is used here.

Source: Newmark (1959), J. Eng. Mech. Div. ASCE 85(3), beta = 1/4, gamma = 1/2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve_banded, cholesky_banded

from ..track.discrete import DiscreteTrack
from ..wheel.rigid import RigidWheel

__all__ = ["InteractionHistory", "hertz_law", "integrate_interaction", "integrate_moving_force"]

ContactLaw = Callable[[float, float], tuple[float, float]]
"""Force in N and stiffness in N/m at place x and approach d, both in m; the force must not fall with d."""

HALF_BANDWIDTH = 4  # each supported node is followed by its sleeper


@dataclass(frozen=True)
class InteractionHistory:
    """Histories at the instants of the integration, each of shape (n,).

    Attributes
    ----------
    time : s, from the start
    force : N, contact force
    wheel_displacement, rail_displacement : m, at the contact, positive down
    """

    time: NDArray
    force: NDArray
    wheel_displacement: NDArray
    rail_displacement: NDArray


class _NewmarkTrack:
    """The track with its sleepers, integrated with a constant step."""

    def __init__(self, track: DiscreteTrack, dt: float) -> None:
        self.track, self.dt = track, dt
        rail = 2 * (track.nodes - 2)
        supported = track.support_columns()
        # Order: a supported node's two degrees of freedom, then its sleeper, keeps the bands narrow.
        after = np.zeros(rail, dtype=int)
        after[supported + 2 if supported[-1] + 2 < rail else supported[:-1] + 2] = 1
        if supported[-1] + 2 >= rail:
            raise ValueError("the last support must have a free node behind it")
        self.rail_rows = np.arange(rail) + np.cumsum(after)
        self.sleeper_rows = self.rail_rows[supported] + 2
        size = rail + len(supported)
        stiffness, mass, damping = (np.zeros((HALF_BANDWIDTH + 1, size)) for _ in range(3))
        for source, target in zip(track.rail_bands(), (stiffness, mass), strict=True):
            for d in range(len(source)):
                rows, columns = self.rail_rows[d:], self.rail_rows[: rail - d]
                target[rows - columns, columns] += source[d, : rail - d]
        at = self.rail_rows[supported]
        for pad, ballast, target in (
            (track.pad_stiffness, track.ballast_stiffness, stiffness),
            (track.pad_damping, track.ballast_damping, damping),
        ):
            target[0, at] += pad
            target[0, self.sleeper_rows] += pad + ballast
            target[2, at] -= pad
        mass[0, self.sleeper_rows] += track.sleeper_mass
        self.stiffness, self.mass, self.damping = stiffness, mass, damping
        self.static_factor = cholesky_banded(stiffness, lower=True)
        self.factor = cholesky_banded(4.0 / dt**2 * mass + 2.0 / dt * damping + stiffness, lower=True)
        self.u, self.v, self.a = (np.zeros(size) for _ in range(3))

    def point(self, x: float) -> tuple[NDArray, NDArray]:
        columns, weights = self.track.interpolation(x)
        inside = weights[0] != 0.0
        return self.rail_rows[columns[0, inside]], weights[0, inside]

    def unit_force(self, x: float) -> NDArray:
        force = np.zeros_like(self.u)
        rows, weights = self.point(x)
        force[rows] = weights
        return force

    def settle(self, x: float, force: float) -> None:
        self.u = cho_solve_banded((self.static_factor, True), force * self.unit_force(x))
        self.v[:] = self.a[:] = 0.0

    def predict(self, x: float) -> tuple[float, float]:
        """Displacement at x at the new instant without force, and per unit force."""
        dt, u, v, a = self.dt, self.u, self.v, self.a
        inertia = 4.0 / dt**2 * u + 4.0 / dt * v + a
        viscous = 2.0 / dt * u + v
        rhs = _multiply(self.mass, inertia) + _multiply(self.damping, viscous)
        both = cho_solve_banded((self.factor, True), np.stack([rhs, self.unit_force(x)], axis=1), check_finite=False)
        self._free, self._unit = both[:, 0], both[:, 1]
        rows, weights = self.point(x)
        return float(weights @ self._free[rows]), float(weights @ self._unit[rows]) + self.local(x)

    def local(self, x: float) -> float:
        """Return the static deflection per unit force that the nodes don't show, m/N."""
        track = self.track
        s = (x + track.half_length) / track.element_length
        s -= int(s)
        return _clamped_compliance(s, track.element_length, track.bending_stiffness, track.shear_stiffness)

    def accept(self, force: float) -> None:
        new = self._free + force * self._unit
        dt = self.dt
        acceleration = 4.0 / dt**2 * (new - self.u) - 4.0 / dt * self.v - self.a
        self.v += 0.5 * dt * (self.a + acceleration)
        self.u, self.a = new, acceleration


def _multiply(bands: NDArray, vector: NDArray) -> NDArray:
    """Symmetric banded matrix (lower bands) times vector."""
    result = bands[0] * vector
    for d in range(1, len(bands)):
        result[d:] += bands[d, :-d] * vector[:-d]
        result[:-d] += bands[d, :-d] * vector[d:]
    return result


def _clamped_compliance(s: float, length: float, bending_stiffness: float, shear_stiffness: float) -> float:
    """Deflection under a unit force at ``s * length`` of a beam clamped at both ends, in m/N.

    Force method: the fixed end's reaction R and moment M minimise the complementary energy of bending and shear.
    """
    a = s * length
    b = length - a
    # With z from the left end: V = R - [z > a], m = M + R z - (z - a)+; flexibilities of (R, M) and of the load.
    f_rr = length**3 / (3.0 * bending_stiffness) + length / shear_stiffness
    f_rm = length**2 / (2.0 * bending_stiffness)
    f_mm = length / bending_stiffness
    load_r = -(b**2 * (2.0 * length + a) / 6.0) / bending_stiffness - b / shear_stiffness
    load_m = -(b**2) / (2.0 * bending_stiffness)
    load = b**3 / (3.0 * bending_stiffness) + b / shear_stiffness
    reaction, moment = np.linalg.solve([[f_rr, f_rm], [f_rm, f_mm]], [-load_r, -load_m])
    return float(load + load_r * reaction + load_m * moment)


def integrate_moving_force(
    track: DiscreteTrack, *, speed: float, start: float, force: Callable[[float], float], dt: float, steps: int
) -> tuple[NDArray, NDArray]:
    """Deflection of the rail under a moving force of given history, from rest.

    Parameters
    ----------
    track : DiscreteTrack
    speed : float
        In m/s.
    start : float
        Position of the force at t = 0 in m from the middle sleeper.
    force : callable
        Force in N at time t in s; the track is at rest until t = 0 and force(0) must be 0.
    dt : float
        Time step in s.
    steps : int
        Number of steps.

    Returns
    -------
    time, displacement : ndarray, shape (steps + 1,)
        s, and m under the force.
    """
    system = _NewmarkTrack(track, dt)
    time = dt * np.arange(steps + 1)
    displacement = np.zeros(steps + 1)
    for n in range(1, steps + 1):
        free, unit = system.predict(start + speed * time[n])
        value = force(time[n])
        system.accept(value)
        displacement[n] = free + unit * value
    return time, displacement


def hertz_law(constant: float, roughness: Callable[[float], float]) -> ContactLaw:
    """Make the law of a Hertz spring F = C_H (d + r(x))^1.5.

    Parameters
    ----------
    constant : float
        C_H in N/m^1.5.
    roughness : callable
        Combined roughness r(x) in m, adding to the indentation.
    """

    def law(x: float, approach: float) -> tuple[float, float]:
        depth = max(approach + roughness(x), 0.0)
        return constant * depth**1.5, 1.5 * constant * depth**0.5

    return law


def integrate_interaction(
    track: DiscreteTrack,
    wheel: RigidWheel,
    *,
    law: ContactLaw,
    preload: float,
    speed: float,
    start: float,
    dt: float,
    steps: int,
) -> InteractionHistory:
    """Roll a wheel over the track.

    The run starts from static equilibrium under the preload at ``start``, all at rest.

    Parameters
    ----------
    track : DiscreteTrack
    wheel : RigidWheel
    law : ContactLaw
    preload : float
        In N.
    speed, start : float
        m/s, and m from the middle sleeper.
    dt : float
        Time step in s.
    steps : int
        Number of steps.

    Returns
    -------
    InteractionHistory
        With steps + 1 instants.
    """
    system = _NewmarkTrack(track, dt)
    system.settle(start, preload)
    M, C, K = wheel.mass_matrix, wheel.damping_matrix, wheel.stiffness_matrix
    effective = np.linalg.inv(4.0 / dt**2 * M + 2.0 / dt * C + K)
    u, v, a = (np.zeros(len(M)) for _ in range(3))
    time = dt * np.arange(steps + 1)
    force, wheel_displacement, rail_displacement = (np.zeros(steps + 1) for _ in range(3))
    force[0] = preload
    rows, weights = system.point(start)
    rail_displacement[0] = weights @ system.u[rows] + preload * system.local(start)
    # The wheel's displacement counts from its equilibrium under the preload.
    approach, _ = _solve(lambda d: _difference(law(start, d), preload), 1e-4)
    offset = approach + rail_displacement[0]
    for n in range(1, steps + 1):
        x = start + speed * time[n]
        rail_free, rail_unit = system.predict(x)
        rhs = M @ (4.0 / dt**2 * u + 4.0 / dt * v + a) + C @ (2.0 / dt * u + v)
        rhs[-1] += preload
        wheel_free, wheel_unit = effective @ rhs, effective[:, -1]
        free = offset + wheel_free[-1] - rail_free
        compliance = rail_unit + wheel_unit[-1]
        approach, _ = _solve(lambda d, x=x, f=free, c=compliance: _coupled(law(x, d), d, f, c), approach)
        value = law(x, approach)[0]
        system.accept(value)
        new = wheel_free - value * wheel_unit
        acceleration = 4.0 / dt**2 * (new - u) - 4.0 / dt * v - a
        v += 0.5 * dt * (a + acceleration)
        u, a = new, acceleration
        force[n], wheel_displacement[n] = value, u[-1]
        rail_displacement[n] = rail_free + rail_unit * value
    return InteractionHistory(time, force, wheel_displacement, rail_displacement)


def _difference(contact: tuple[float, float], load: float) -> tuple[float, float]:
    return contact[0] - load, contact[1]


def _coupled(contact: tuple[float, float], d: float, free: float, compliance: float) -> tuple[float, float]:
    """Return d + compliance F(d) - free, and its derivative."""
    return d + compliance * contact[0] - free, 1.0 + compliance * contact[1]


def _solve(function: Callable[[float], tuple[float, float]], guess: float) -> tuple[float, float]:
    """Root of an increasing function by Newton's method, by bisection where that leaves the bracket."""
    low, high, d = -np.inf, np.inf, guess
    value = np.inf
    for _ in range(200):
        value, slope = function(d)
        if value <= 0.0:
            low = d
        else:
            high = d
        if value == 0.0:
            break
        new = d - value / slope if slope > 0.0 else d - np.sign(value) * 1e-4
        if not low < new < high:
            new = 0.5 * (low + high) if np.isfinite(low + high) else d - np.sign(value) * 1e-4
        change, d = new - d, new
        if abs(change) < 1e-16 + 1e-13 * abs(d):
            break
    return float(d), float(value)
