"""Tangential contact with given traction bounds: slip and stick in one step (Pieringer 2011, section 3.6.1).

    S = u + W - u' = A p + h,     |p_I| <= g_I,     S_I = 0 where |p_I| < g_I,     else p_I = -g_I S_I / |S_I|

These are the optimality conditions of a convex problem, minimise p'Ap/2 + h'p over the discs |p_I| <= g_I, so there is
one solution (Kalker 1990, section 4.2). Two methods find it:

* `solve_tangential`: Newton's method on p = Proj(p - rho S), projected, with a descent step where it does not decrease
  (semi-smooth Newton; Alart and Curnier 1991). The set of slipping elements and their directions follow at once. It
  never fails: every step decreases the functional, and gradient steps alone converge.
* Kalker's active set algorithm TANG, which the thesis uses: `wheelrail.contact.tang`. Its sets can cycle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .half_space import HalfSpace

__all__ = [
    "TangentialProblem",
    "TangentialState",
    "accelerated_gradient",
    "influence_matrix",
    "residual_of",
    "solve_tangential",
]

TOLERANCE = 1e-10  # of the residual
ROUNDING = 1e-9  # a residual below which a step that brings nothing more is taken for rounding
MAXIMUM_ITERATIONS = 100
GRADIENT_STEPS = 20
_NO_FRICTION = 1e-15  # of the largest bound, for elements on which friction has vanished


@dataclass(frozen=True)
class TangentialProblem:
    """A tangential contact problem over the k elements in contact.

    Parameters
    ----------
    half_space : HalfSpace
    contact : ndarray of int, shape (k,)
        Elements in contact.
    bound : ndarray, shape (k,)
        Traction bounds g = mu p3 in Pa, > 0.
    shift : ndarray, shape (2, k)
        h = W - u' in m: rigid shift of rail against wheel in this step, less the displacement of the step before.
    compliance : ndarray, shape (2, 2), optional
        How far rail and wheel as a whole give way to the resultant force within the step, m/N; symmetric and positive
        semi-definite. Left out: not at all.
    """

    half_space: HalfSpace
    contact: NDArray
    bound: NDArray
    shift: NDArray
    compliance: NDArray | None = None


@dataclass(frozen=True)
class TangentialState:
    """Solution of a tangential contact problem.

    Attributes
    ----------
    tractions : ndarray, shape (2, k)
        Pa, on the rail.
    slip : ndarray, shape (2, k)
        Slip distance S of the step in m, 0 in stick.
    slipping : ndarray of bool, shape (k,)
    iterations : int
    residual : float
        Largest violation of the conditions over the largest bound, as `residual_of` defines it.
    """

    tractions: NDArray
    slip: NDArray
    slipping: NDArray
    iterations: int
    residual: float


def influence_matrix(problem: TangentialProblem) -> NDArray:
    """Matrix A of the contact elements, shape (2 k, 2 k); first all x, then all y components.

    A compliance of rail and wheel adds the same displacement to all elements, for the sum of all tractions.
    """
    k = len(problem.contact)
    pairs = problem.half_space.pairs(problem.contact, problem.contact)
    table = problem.half_space.coefficients
    matrix = np.empty((2 * k, 2 * k))
    matrix[:k, :k] = table.a11.ravel().take(pairs)
    matrix[k:, k:] = table.a22.ravel().take(pairs)
    matrix[:k, k:] = matrix[k:, :k] = table.a12.ravel().take(pairs)
    if problem.compliance is not None:
        matrix.reshape(2, k, 2, k)[:] += (problem.half_space.element_area * problem.compliance)[:, None, :, None]
    return matrix


def _projected(tractions: NDArray, bound: NDArray) -> NDArray:
    size = np.hypot(tractions[0], tractions[1])
    return tractions * (bound / np.maximum(size, bound))


def residual_of(problem: TangentialProblem, tractions: NDArray, slip: NDArray, matrix: NDArray) -> float:
    """Measure how far tractions and slip are from the conditions, over the largest bound.

    Parameters
    ----------
    problem : TangentialProblem
    tractions, slip : ndarray, shape (2, k)
        Pa and m.
    matrix : ndarray
        Of the problem; its first entry makes a traction of the slip.

    Returns
    -------
    float
        Largest component of p - Proj(p - S / A_11) over the largest bound; 0 if and only if all conditions hold.
    """
    expected = _projected(tractions - slip / matrix[0, 0], problem.bound)
    return float(np.abs(tractions - expected).max()) / float(problem.bound.max())


def solve_tangential(
    problem: TangentialProblem,
    guess: NDArray | None = None,
    matrix: NDArray | None = None,
    *,
    symmetric: bool = True,
    gradient_steps: int = GRADIENT_STEPS,
) -> TangentialState:
    """Find tractions, slip and the slipping elements.

    Parameters
    ----------
    problem : TangentialProblem
    guess : ndarray, shape (2, k), optional
        Tractions nearby, such as those of the step before.
    matrix : ndarray, shape (2 k, 2 k), optional
        `influence_matrix` if it is at hand, or another one, positive definite.
    symmetric : bool
        Whether the matrix is symmetric; that of steady rolling is not.
    gradient_steps : int
        Descent steps before Newton's method, which find the slipping elements from a distant guess.

    Returns
    -------
    TangentialState
        With a residual above `TOLERANCE` only if rounding forbids more.
    """
    k = len(problem.contact)
    if k == 0 or not np.any(problem.bound > 0.0):  # nothing to hold: everything slides freely
        return TangentialState(np.zeros((2, k)), problem.shift.copy(), np.ones(k, dtype=bool), 0, 0.0)
    g = np.maximum(problem.bound, _NO_FRICTION * float(problem.bound.max()))
    A = influence_matrix(problem) if matrix is None else matrix
    h = problem.shift
    rho = 1.0 / A[0, 0]  # makes tractions of slip; any positive number gives the same solution

    def evaluate(p: NDArray) -> tuple[NDArray, NDArray, float]:
        S = (A @ p.reshape(-1)).reshape(2, k) + h
        trial = p - rho * S
        return S, trial, float(np.abs(p - _projected(trial, g)).max()) / float(g.max())

    p = np.zeros((2, k)) if guess is None else _projected(guess, g)
    lipschitz = float(np.abs(A).sum(axis=1).max())
    if symmetric:
        p = accelerated_gradient(A, p, h, g, lipschitz=lipschitz, steps=gradient_steps)
    S, trial, residual = evaluate(p)
    iterations = 0
    while residual > TOLERANCE and iterations < MAXIMUM_ITERATIONS:
        iterations += 1
        step = _newton_step(A, p, S, trial, g, rho)
        energy = float(np.vdot(p, S + h))
        for share in (1.0, 0.5, 0.25, 0.1):
            new = _projected(p + share * step, g)
            new_S, new_trial, new_residual = evaluate(new)
            if new_residual < 0.5 * residual:
                break
            if symmetric and float(np.vdot(new, new_S + h)) < energy - 1e-10 * abs(energy):
                break
        else:
            if not symmetric or (residual < ROUNDING and new_residual >= residual):
                break
            steps = GRADIENT_STEPS * (1 + iterations)
            new = accelerated_gradient(A, p, h, g, lipschitz=lipschitz, steps=steps)
            new_S, new_trial, new_residual = evaluate(new)
        p, S, trial, residual = new, new_S, new_trial, new_residual
    slipping = np.hypot(trial[0], trial[1]) > g
    return TangentialState(p, np.where(slipping, S, 0.0), slipping, iterations, residual)


def accelerated_gradient(A: NDArray, p: NDArray, h: NDArray, g: NDArray, *, lipschitz: float, steps: int) -> NDArray:
    """Descend by projected gradient steps with momentum (Nesterov 1983): they find the slipping elements cheaply.

    Parameters
    ----------
    A : ndarray, shape (2 k, 2 k)
        Symmetric.
    p : ndarray, shape (2, k)
        Tractions to start from, Pa.
    h, g : ndarray, shapes (2, k) and (k,)
        Shift in m and traction bounds in Pa.
    lipschitz : float
        Bound of the largest eigenvalue of A, m/Pa.
    steps : int

    Returns
    -------
    ndarray, shape (2, k)
        Within the bounds after one step or more.
    """
    ahead, momentum = p, 1.0
    for _ in range(steps):
        S = (A @ ahead.reshape(-1)).reshape(p.shape) + h
        new = _projected(ahead - S / lipschitz, g)
        following = 0.5 * (1.0 + np.sqrt(1.0 + 4.0 * momentum**2))
        ahead = new + (momentum - 1.0) / following * (new - p)
        p, momentum = new, following
    return p


def _newton_step(A: NDArray, p: NDArray, S: NDArray, trial: NDArray, g: NDArray, rho: float) -> NDArray:
    """Newton's step for p = Proj(p - rho S), as a symmetric system.

    A sticking element has two unknowns and S = 0 as equations. A slipping one moves to its circle, p n = g with
    n the direction of the trial traction, and has one unknown along t, across n.
    """
    k = len(g)
    size = np.hypot(trial[0], trial[1])
    slipping = size > g
    stick, slide = np.flatnonzero(~slipping), np.flatnonzero(slipping)
    nx, ny = trial[:, slide] / size[slide]
    step = np.zeros((2, k))
    missing = g[slide] - nx * p[0, slide] - ny * p[1, slide]
    step[0, slide], step[1, slide] = nx * missing, ny * missing
    both_slide = np.concatenate([slide, k + slide])
    rhs = -S.reshape(-1) - A[:, both_slide] @ step.reshape(-1)[both_slide]
    tx, ty = -ny, nx
    both = np.concatenate([stick, k + stick])
    m = len(both)
    columns = np.empty((2 * k, m + len(slide)))
    columns[:, :m] = A[:, both]
    np.multiply(A[:, slide], tx, out=columns[:, m:])
    columns[:, m:] += A[:, k + slide] * ty
    matrix = np.empty((m + len(slide),) * 2)
    matrix[:m] = columns[both]
    matrix[m:] = tx[:, None] * columns[slide] + ty[:, None] * columns[k + slide]
    diagonal = np.arange(m, m + len(slide))
    excess = (size[slide] - g[slide]) / (rho * g[slide])
    matrix[diagonal, diagonal] += excess
    along = tx * p[0, slide] + ty * p[1, slide]
    right = np.concatenate(
        [
            rhs[both],
            tx * rhs[slide]
            + ty * rhs[k + slide]
            - size[slide] / (rho * g[slide]) * along
            + S[0, slide] * tx
            + S[1, slide] * ty,
        ]
    )
    unknown = np.linalg.solve(matrix, right)
    step.reshape(-1)[both] = unknown[:m]
    step[0, slide] += tx * unknown[m:]
    step[1, slide] += ty * unknown[m:]
    return step
