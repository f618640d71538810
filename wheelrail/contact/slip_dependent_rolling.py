"""Rolling with slip-velocity dependent friction: transient step, steady rolling (Pieringer 2011, section 3.6.2).

As `wheelrail.contact.rolling`, with a friction coefficient for each element that follows from its own slip velocity.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .friction.laws import FrictionLaw
from .friction.newton import newton
from .friction.problem import METHODS, TOLERANCE, SlipFrictionProblem, SlipFrictionState
from .friction.settings import SlipFriction
from .friction.solutions import find_solutions, force_spread
from .friction.solve import solve_slip_friction
from .half_space import HalfSpace
from .normal import NormalState
from .rolling import TRANSIENT_STEPS, RollingState, carried_matrix, on_grid, rigid_shift

__all__ = ["SlipDependentState", "entering", "roll_slip_dependent", "steady_rolling_slip_dependent"]

MAXIMUM_ATTEMPTS = 6  # of Newton's method on the steady equations, with transient steps between
HOMOTOPY_STEPS = 20  # from constant friction to the law


@dataclass(frozen=True)
class SlipDependentState:
    """Solution of a step.

    Attributes
    ----------
    rolling : RollingState
    speed : ndarray, shape (n,)
        Slip velocity in m/s, 0 in stick and outside the contact.
    coefficient : ndarray, shape (n,)
        Friction coefficient that the particle of each element has after the step.
    method : str
        What found the solution, see `wheelrail.contact.friction.problem.METHODS`.
    solutions : int
        Number of solutions, if they were looked for, else 0.
    force_spread : float
        Largest difference between their forces, N.
    """

    rolling: RollingState
    speed: NDArray
    coefficient: NDArray
    method: str
    solutions: int = 0
    force_spread: float = 0.0


def entering(half_space: HalfSpace, friction: SlipFriction, static: float) -> NDArray:
    """Return the coefficient of particles that have never slipped, shape (n,)."""
    return np.full(half_space.elements, static * friction.at_rest)


def roll_slip_dependent(
    half_space: HalfSpace,
    normal: NormalState,
    *,
    friction: SlipFriction,
    static: float,
    dt: float,
    shift: NDArray,
    previous: NDArray,
    speed: NDArray,
    coefficient: NDArray,
    compliance: NDArray | None = None,
) -> SlipDependentState:
    """Do one step of transient rolling.

    Parameters
    ----------
    half_space : HalfSpace
    normal : NormalState
        Normal contact of this step.
    friction : SlipFriction
    static : float
        mu_s, > 0.
    dt : float
        s.
    shift : ndarray, shape (2, n)
        Rigid shift W, with the structural part of wheel and rail, m.
    previous : ndarray, shape (2, n)
        Tractions of the step before, Pa.
    speed, coefficient : ndarray, shape (n,)
        Slip velocities (m/s) and friction coefficients of the step before.
    compliance : ndarray, shape (2, 2), optional
        Of rail and wheel within the step, m/N, as for `wheelrail.contact.rolling.roll`.

    Returns
    -------
    SlipDependentState
    """
    contact = normal.contact
    carried = half_space.carried_displacement(previous)
    fresh = entering(half_space, friction, static)
    brought = half_space.upstream(coefficient - fresh) + fresh
    problem = SlipFrictionProblem(
        half_space,
        contact,
        normal.pressure[contact],
        shift[:, contact] - carried[:, contact],
        dt,
        friction.law,
        static,
        friction.memory,
        brought[contact],
        compliance,
    )
    guess = {
        "previous": speed[contact],
        "low-slip": np.zeros(len(contact)),
        "high-slip": problem.speed(problem.shift),
    }[friction.branch]
    state = solve_slip_friction(problem, previous[:, contact], guess, solver=friction.solver)
    count, spread = 0, 0.0
    if friction.find_solutions:
        known = state if friction.branch == "previous" else None
        found = find_solutions(problem, previous[:, contact], speed[contact], between=False, known=known)
        count, spread = len(found), force_spread(problem, found)
    if compliance is not None:
        force = half_space.element_area * state.tractions.sum(axis=1)
        shift = shift + (compliance @ force)[:, None]
    rolling = on_grid(half_space, contact, state, shift=shift, previous=previous, carried=carried)
    after = fresh
    if friction.memory is not None:  # outside the contact nothing slips
        still = np.zeros(half_space.elements)
        after = friction.memory.follow(fresh, still, still, previous=brought, dt=dt)[0]
    return _spread(half_space, problem, state, rolling, after, count, spread)


def _spread(
    half_space: HalfSpace,
    problem: SlipFrictionProblem,
    state: SlipFrictionState,
    rolling: RollingState,
    coefficient: NDArray,
    solutions: int = 0,
    spread: float = 0.0,
) -> SlipDependentState:
    speed = np.zeros(half_space.elements)
    speed[problem.contact] = problem.speed(state.slip)
    coefficient = coefficient.copy()
    coefficient[problem.contact] = state.coefficient
    return SlipDependentState(rolling, speed, coefficient, state.method, solutions, spread)


@dataclass(frozen=True)
class _Blend:
    """A share of a law, the rest constant."""

    law: FrictionLaw
    ratio: float
    share: float
    kind = "blend"

    def evaluate(self, speed: NDArray) -> tuple[NDArray, NDArray]:
        value, slope = self.law.evaluate(speed)
        return self.ratio + self.share * (value - self.ratio), self.share * slope

    def to_parts(self) -> dict[str, object]:
        return {"kind": self.kind}


def steady_rolling_slip_dependent(
    half_space: HalfSpace,
    normal: NormalState,
    *,
    friction: SlipFriction,
    static: float,
    dt: float,
    creepage_x: float,
    creepage_y: float,
    creepage_spin: float,
) -> SlipDependentState:
    """Solve steady rolling: the transient with tractions and coefficients that do not change any more.

    Transient steps bring Newton's method near. Where they never settle, steady rolling is unstable, but its equations
    still have a solution: it is followed from constant friction to the law.

    Parameters
    ----------
    half_space : HalfSpace
    normal : NormalState
    friction : SlipFriction
    static : float
        mu_s, > 0.
    dt : float
        s, for a distance of dx.
    creepage_x, creepage_y : float
    creepage_spin : float
        1/m.

    Returns
    -------
    SlipDependentState
        Its residual is that of the steady equations.
    """
    contact = normal.contact
    shift = rigid_shift(
        half_space,
        creepage_x=creepage_x,
        creepage_y=creepage_y,
        creepage_spin=creepage_spin,
        distance=half_space.dx,
    )
    fresh = entering(half_space, friction, static)
    place = np.full(half_space.elements + 1, -1)
    place[contact] = np.arange(len(contact))
    upstream = np.where(contact % half_space.mx == half_space.mx - 1, -1, place[contact + 1])
    problem = SlipFrictionProblem(
        half_space,
        contact,
        normal.pressure[contact],
        shift[:, contact],
        dt,
        friction.law,
        static,
        friction.memory,
        fresh[contact],
        carried=carried_matrix(half_space, contact),
        upstream=upstream,
    )
    if len(contact) == 0:
        nothing = solve_slip_friction(problem, shift[:, contact], np.zeros(0))
        return _spread(half_space, problem, nothing, on_grid(half_space, contact, nothing, shift=shift), fresh)
    tractions = np.zeros((2, half_space.elements))
    speed, coefficient = np.zeros(half_space.elements), fresh
    alone = replace(friction, find_solutions=False)
    best, smallest, count = tractions[:, contact], np.inf, 0
    for _ in range(MAXIMUM_ATTEMPTS):
        for _ in range(TRANSIENT_STEPS):
            step = roll_slip_dependent(
                half_space,
                normal,
                friction=alone,
                static=static,
                dt=dt,
                shift=shift,
                previous=tractions,
                speed=speed,
                coefficient=coefficient,
            )
            tractions, speed, coefficient = step.rolling.tractions, step.speed, step.coefficient
            count += step.rolling.iterations
        solution, steps, converged = newton(problem, tractions[:, contact])
        count += steps
        residual = problem.evaluate(solution).residual
        if residual < smallest:
            best, smallest = solution, residual
        if converged:
            break
    if smallest > TOLERANCE:
        solution, steps = _from_constant_friction(problem, tractions[:, contact], (creepage_x, creepage_y))
        count += steps
        if problem.evaluate(solution).residual < smallest:
            best = solution
    state = problem.state(best, count, METHODS[1])
    return _spread(half_space, problem, state, on_grid(half_space, contact, state, shift=shift), fresh)


def _from_constant_friction(
    problem: SlipFrictionProblem, tractions: NDArray, creepage: tuple[float, float]
) -> tuple[NDArray, int]:
    """Follow the steady solution from constant friction to the law."""
    sliding = np.array([np.hypot(*creepage) * problem.half_space.dx / problem.dt])
    ratio, count = float(problem.law.evaluate(sliding)[0][0]), 0
    for share in np.linspace(0.0, 1.0, HOMOTOPY_STEPS + 1):
        part = replace(problem, law=_Blend(problem.law, ratio, float(share)))
        tractions, steps, converged = newton(part, tractions)
        count += steps
        if not converged and share == 0.0:
            tractions = part.solve_for(part.coefficient(np.zeros(len(part.contact)))[0], tractions).tractions
    return tractions, count
