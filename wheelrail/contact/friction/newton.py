"""Newton's method for tractions, slip and friction coefficients at once.

The equations p = Proj(p - rho S) with the discs |p_I| <= f(s_I) p3_I, where the bound now moves with the slip. A
sticking element gives S = 0; a slipping one, with n the direction of its trial traction, t across it and e = S / |S|,

    n p = f(s) p3,     t p = 0,     d s = e dS / dt,     dS = A dp.

The method converges in a few steps from a good guess, also to solutions from which iterating between contact and law
runs away: those lie between two others (Vollebregt and Schuttelaars 2012). With T' the derivative of that iteration,
they have eigenvalues of T' above 1. The determinant of the Jacobian has the sign of det(1 - T'), so that a negative one
tells that there is an odd number of them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .problem import TOLERANCE, Evaluation, SlipFrictionProblem

__all__ = ["is_repelling", "is_reversed", "newton"]

MAXIMUM_STEPS = 12
_SHARES = (1.0, 0.5, 0.25)
_DECREASE = 0.9  # of the residual that a step has to bring


def newton(problem: SlipFrictionProblem, tractions: NDArray) -> tuple[NDArray, int, bool]:
    """Solve from tractions nearby.

    Parameters
    ----------
    problem : SlipFrictionProblem
    tractions : ndarray, shape (2, k)
        Pa.

    Returns
    -------
    tuple of ndarray, int and bool
        Tractions, number of steps, and whether they solve the problem.
    """
    at = problem.evaluate(tractions)
    for count in range(MAXIMUM_STEPS):
        if at.residual <= TOLERANCE:
            return tractions, count, True
        matrix, rhs = _system(problem, tractions, at)
        try:
            step = np.linalg.solve(matrix, rhs).reshape(tractions.shape)
        except np.linalg.LinAlgError:
            return tractions, count, False
        for share in _SHARES:
            new = tractions + share * step
            new_at = problem.evaluate(new)
            if new_at.residual < _DECREASE * at.residual:
                break
        else:
            return tractions, count + 1, False
        tractions, at = new, new_at
    return tractions, MAXIMUM_STEPS, at.residual <= TOLERANCE


def is_reversed(problem: SlipFrictionProblem, tractions: NDArray) -> bool:
    """Tell whether the determinant of the Jacobian is negative at a solution, tractions in Pa of shape (2, k)."""
    matrix, _ = _system(problem, tractions, problem.evaluate(tractions))
    return bool(np.linalg.slogdet(matrix)[0] < 0.0)


def is_repelling(problem: SlipFrictionProblem, tractions: NDArray) -> bool:
    """Tell whether iterating between contact and law runs away from a solution.

    Parameters
    ----------
    problem : SlipFrictionProblem
    tractions : ndarray, shape (2, k)
        Of a solution, Pa.

    Returns
    -------
    bool
        Whether an eigenvalue of the iteration's derivative has a real part above 1; relaxation can't cure that.
    """
    at = problem.evaluate(tractions)
    slide = np.flatnonzero(at.size > at.bound)
    if len(slide) == 0:
        return False
    k = len(at.bound)
    given, _ = _system(problem, tractions, at._replace(slope=np.zeros(k)))
    drive = np.zeros((2 * k, len(slide)))
    drive[slide, np.arange(len(slide))] = problem.pressure[slide]
    # What the coefficients of the slipping elements do to the bounds, over the pressure: f'(s) ds/dmu.
    derivative = -_bound_change(problem, at, slide) @ np.linalg.solve(given, drive)
    return bool(np.linalg.eigvals(derivative / problem.pressure[slide, None]).real.max() > 1.0)


def _system(problem: SlipFrictionProblem, p: NDArray, at: Evaluation) -> tuple[NDArray, NDArray]:
    """Jacobian, shape (2 k, 2 k), and right-hand side of a step.

    Row I and row k + I belong to element I; its determinant is positive if the friction coefficients are constant.
    """
    A, k = problem.matrix, p.shape[1]
    rho = 1.0 / A[0, 0]
    jacobian = rho * A
    rhs = -rho * at.slip.reshape(-1)
    slide = np.flatnonzero(at.size > at.bound)
    if len(slide) == 0:
        return jacobian, rhs
    nx, ny = at.trial[:, slide] / at.size[slide]
    tx, ty = -ny, nx
    share = at.bound[slide] / at.size[slide]
    across = (tx * share)[:, None] * jacobian[slide] + (ty * share)[:, None] * jacobian[k + slide]
    across[np.arange(len(slide)), slide] += (1.0 - share) * tx
    across[np.arange(len(slide)), k + slide] += (1.0 - share) * ty
    along = _bound_change(problem, at, slide)
    along[np.arange(len(slide)), slide] += nx
    along[np.arange(len(slide)), k + slide] += ny
    rhs[slide] = at.bound[slide] - nx * p[0, slide] - ny * p[1, slide]
    rhs[k + slide] = -tx * p[0, slide] - ty * p[1, slide]
    jacobian[slide], jacobian[k + slide] = along, across
    return jacobian, rhs


def _bound_change(problem: SlipFrictionProblem, at: Evaluation, slide: NDArray) -> NDArray:
    """Minus the derivative of the bounds of the elements ``slide`` over the tractions, shape (m, 2 k)."""
    A, k = problem.matrix, len(at.bound)
    speed = np.maximum(np.hypot(at.slip[0], at.slip[1]), np.finfo(float).tiny)
    ex, ey = at.slip / speed
    if at.slope.ndim == 1:
        factor = -at.slope[slide] * problem.pressure[slide] / problem.dt
        return (factor * ex[slide])[:, None] * A[slide] + (factor * ey[slide])[:, None] * A[k + slide]
    moved = ex[:, None] * A[:k] + ey[:, None] * A[k:]
    return -(problem.pressure[slide] / problem.dt)[:, None] * (at.slope[slide] @ moved)
