"""Solve the tangential contact with slip-velocity dependent friction.

Which solution, where there are several: the one that iterating between contact and law comes to from the guess, as in
the thesis. Here the contact is not solved in each of these iterations, but only improved by some descent steps, and
Newton's method takes over near the solution. Where it does not converge, or to a solution from which the iteration runs
away, the iteration goes on.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..tangential import accelerated_gradient
from .newton import is_reversed, newton
from .problem import TOLERANCE, SlipFrictionProblem, SlipFrictionState
from .thesis_iteration import fixed_point, solve_as_thesis

__all__ = ["SOLVERS", "solve_slip_friction"]

SOLVERS = ("newton", "broyden")

_ROUNDS = (16, 32, 64, 128)  # looks at the friction law between attempts of Newton's method
_FIRST, _BETWEEN = 20, 4  # descent steps before the first and the other looks
_NEAR = 1e-3  # a residual from which Newton's method takes over at once
_LEAST = 0.02  # relaxation factor
_CERTAIN = 3  # Newton steps up to which the solution is taken for that next to its start


def solve_slip_friction(
    problem: SlipFrictionProblem, tractions: NDArray, speed: NDArray, *, solver: str = "newton"
) -> SlipFrictionState:
    """Find tractions, slip and friction coefficients.

    Parameters
    ----------
    problem : SlipFrictionProblem
    tractions : ndarray, shape (2, k)
        Nearby, such as those of the step before, Pa.
    speed : ndarray, shape (k,)
        Slip velocities nearby, m/s; they select the solution where there are several.
    solver : {"newton", "broyden"}
        "broyden" is the thesis' own way, see `wheelrail.contact.friction.thesis_iteration`.

    Returns
    -------
    SlipFrictionState
        With a residual above `TOLERANCE` if no method converged within its bounds.
    """
    k = len(problem.contact)
    coefficient = problem.coefficient(speed)[0]
    if k == 0 or problem.static == 0.0:  # nothing to hold: everything slides freely
        return SlipFrictionState(
            np.zeros((2, k)), problem.shift.copy(), np.ones(k, dtype=bool), coefficient, 0, 0.0, "none"
        )
    if solver == "broyden":
        return solve_as_thesis(problem, tractions, speed)
    p, count = tractions, 0
    lipschitz = float(np.abs(problem.matrix).sum(axis=1).max())
    for rounds in _ROUNDS:
        if problem.carried is None:
            p, coefficient = _improve(problem, p, coefficient, lipschitz, rounds, first=count == 0)
        else:  # not symmetric: there is no descent
            p = fixed_point(problem, p, speed, maximum=rounds // 8).tractions
        solution, steps, converged = newton(problem, p)
        count += steps
        if converged and (steps <= _CERTAIN or not is_reversed(problem, solution)):
            return problem.state(solution, count, "newton")
        speed = problem.speed(problem.evaluate(p).slip)
    state = solve_as_thesis(problem, p, speed)
    count += state.iterations
    if state.residual > TOLERANCE:  # full stick leads to a solution more surely than anything else
        other = fixed_point(problem, p, np.zeros(k))
        count += other.iterations
        state = min(state, other, key=lambda each: each.residual)
    return state._replace(iterations=count)


def _improve(
    problem: SlipFrictionProblem, p: NDArray, coefficient: NDArray, lipschitz: float, rounds: int, *, first: bool
) -> tuple[NDArray, NDArray]:
    """Descend with bounds that follow the law."""
    steps, relaxation, last = _FIRST if first else _BETWEEN, 1.0, np.zeros_like(coefficient)
    for _ in range(rounds):
        p = accelerated_gradient(
            problem.matrix, p, problem.shift, coefficient * problem.pressure, lipschitz=lipschitz, steps=steps
        )
        at = problem.evaluate(p)
        change, steps = at.coefficient - coefficient, _BETWEEN
        if float(change @ last) < 0.0:  # it swings, as where friction rises
            relaxation = max(0.5 * relaxation, _LEAST)
        coefficient, last = coefficient + relaxation * change, change
        if at.residual <= _NEAR:
            break
    return p, coefficient
