"""The iteration of Pieringer (2011), section 3.6.2: contact and friction law in turn.

    g(mu) = mu - f(s(mu)) = 0,     s(mu) from the contact for given coefficients (eq. 3.56)

Broyden's method first; if it fails, the direct iteration mu <- f(s(mu)), with shorter steps where it swings and longer
ones where it creeps (as it does where two solutions have just ceased to exist). The guess are the coefficients that the
slip of the previous step gives.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .problem import TOLERANCE, SlipFrictionProblem, SlipFrictionState

__all__ = ["broyden", "fixed_point", "solve_as_thesis"]

MAXIMUM_BROYDEN = 40
MAXIMUM_FIXED_POINT = 400
_PATIENCE = 12  # direct iterations that hardly bring progress, after which their steps grow
_SHORTER, _LONGER, _SMALLEST, _LARGEST = 0.7, 1.5, 0.05, 20.0  # of the relaxation factor


def solve_as_thesis(problem: SlipFrictionProblem, tractions: NDArray, speed: NDArray) -> SlipFrictionState:
    """Solve by Broyden's method, or else by the direct iteration.

    Parameters
    ----------
    problem : SlipFrictionProblem
    tractions : ndarray, shape (2, k)
        Nearby, Pa.
    speed : ndarray, shape (k,)
        Slip velocities nearby, m/s.

    Returns
    -------
    SlipFrictionState
        With a residual above `TOLERANCE` if neither method converged; the better one's.
    """
    first = broyden(problem, tractions, speed)
    if first.residual <= TOLERANCE:
        return first
    second = fixed_point(problem, tractions, speed)
    best = second if second.residual <= first.residual else first
    return best._replace(iterations=first.iterations + second.iterations)


def broyden(problem: SlipFrictionProblem, tractions: NDArray, speed: NDArray) -> SlipFrictionState:
    """Solve by Broyden's (good) method with the identity as first Jacobian; parameters as `solve_as_thesis`."""
    mu = problem.coefficient(speed)[0]
    state = problem.solve_for(mu, tractions)
    g = mu - problem.coefficient(problem.speed(state.slip))[0]
    inverse = np.eye(len(mu))
    best, smallest, count = state.tractions, np.inf, 1
    while count < MAXIMUM_BROYDEN:
        residual = problem.evaluate(state.tractions).residual
        if residual < smallest:
            best, smallest = state.tractions, residual
        if residual <= TOLERANCE:
            break
        step = -inverse @ g
        if not np.all(mu + step > 0.0):  # no friction coefficients any more: it has gone astray
            break
        mu = mu + step
        state = problem.solve_for(mu, state.tractions)
        count += 1
        new = mu - problem.coefficient(problem.speed(state.slip))[0]
        mapped = inverse @ (new - g)
        size = float(step @ mapped)
        if size == 0.0:
            break
        inverse += np.outer((step - mapped) / size, step @ inverse)
        g = new
    return problem.state(best, count, "broyden")


def fixed_point(
    problem: SlipFrictionProblem,
    tractions: NDArray,
    speed: NDArray,
    *,
    maximum: int = MAXIMUM_FIXED_POINT,
) -> SlipFrictionState:
    """Solve by direct iteration with relaxation; parameters as `solve_as_thesis`.

    Started from full stick (speed 0) it comes to the solution with the least slip, from full slip to that with the
    most: more slip lowers the coefficients, and lower coefficients give more slip everywhere.
    """
    mu = problem.coefficient(speed)[0]
    relaxation, since, smallest, best = 1.0, 0, np.inf, tractions
    last, count = np.zeros_like(mu), 0
    while count < maximum:
        tractions = problem.solve_for(mu, tractions).tractions
        count += 1
        at = problem.evaluate(tractions)
        since = 0 if at.residual < 0.9 * smallest else since + 1
        if at.residual < smallest:
            best, smallest = tractions, at.residual
        if at.residual <= TOLERANCE:
            break
        change = at.coefficient - mu
        if float(change @ last) < 0.0:
            relaxation = max(_SHORTER * relaxation, _SMALLEST)
        elif since >= _PATIENCE:
            relaxation = min(_LONGER * relaxation, _LARGEST)
        mu = np.maximum(mu + relaxation * change, 0.5 * np.minimum(mu, at.coefficient))
        last = change
    return problem.state(best, count, "fixed-point")
