"""Kalker's active set algorithm TANG, as Pieringer (2011), section 3.6.1, describes it.

Kept beside `wheelrail.contact.tangential` for comparison: its sets of sticking and slipping elements can cycle, and its
Newton iteration for given sets need not converge; it then says so.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .tangential import TangentialProblem, TangentialState, influence_matrix, residual_of

__all__ = ["TangDidNotConverge", "solve_tang"]

MAXIMUM_SETS = 200
MAXIMUM_NEWTON = 50


class TangDidNotConverge(Exception):  # noqa: N818 - what happened, not a mistake of the caller
    """The sets cycled, or Newton's method failed for given sets."""


def solve_tang(problem: TangentialProblem, guess: NDArray | None = None) -> TangentialState:
    """Find tractions, slip and the slipping elements by TANG.

    Parameters
    ----------
    problem : TangentialProblem
    guess : ndarray, shape (2, k), optional
        Tractions from which Newton's method starts; the sets start with all elements in stick.

    Returns
    -------
    TangentialState

    Raises
    ------
    TangDidNotConverge
    """
    k, g = len(problem.contact), problem.bound
    if k == 0:
        return TangentialState(np.zeros((2, 0)), np.zeros((2, 0)), np.zeros(0, dtype=bool), 0, 0.0)
    A, h = influence_matrix(problem), problem.shift
    slipping = np.zeros(k, dtype=bool)  # step 1
    p = np.zeros((2, k)) if guess is None else guess.copy()
    seen: set[bytes] = set()
    iterations = 0
    while True:
        while True:
            p, used = _newton(A, h, g, slipping, p)  # step 2
            iterations += used
            beyond = ~slipping & (np.hypot(p[0], p[1]) > g * (1.0 + 1e-12))  # step 3
            if not beyond.any():
                break
            slipping |= beyond  # step 4
        S = (A @ p.reshape(-1)).reshape(2, k) + h
        along = slipping & ((p * S).sum(axis=0) > 0.0)  # step 5: slip in the direction of the traction
        if not along.any():
            break
        slipping &= ~along
        key = slipping.tobytes()
        if key in seen or len(seen) >= MAXIMUM_SETS:
            raise TangDidNotConverge(f"the sets of sticking and slipping elements cycle after {len(seen)} changes")
        seen.add(key)
    return TangentialState(p, np.where(slipping, S, 0.0), slipping, iterations, residual_of(problem, p, S, A))


def _newton(A: NDArray, h: NDArray, g: NDArray, slipping: NDArray, p: NDArray) -> tuple[NDArray, int]:
    """Solve eqs. 3.44 to 3.47, 3.53 and 3.55 for given sets by Newton's method."""
    k = len(g)
    stick, slide = np.flatnonzero(~slipping), np.flatnonzero(slipping)
    p = p.copy()
    # Slipping elements start on their circle.
    size = np.hypot(p[0, slide], p[1, slide])
    direction = np.where(size > 0.0, p[:, slide] / np.maximum(size, 1e-300), -_unit(h[:, slide]))
    p[:, slide] = g[slide] * direction
    scale = float(g.max())
    for iteration in range(1, MAXIMUM_NEWTON + 1):
        S = (A @ p.reshape(-1)).reshape(2, k) + h
        matrix = np.zeros((2 * k, 2 * k))
        rhs = np.empty(2 * k)
        rows = np.concatenate([stick, k + stick])
        matrix[: len(rows)] = A[rows]
        rhs[: len(rows)] = -S.reshape(-1)[rows]
        first = len(rows)
        on_circle = np.arange(first, first + len(slide))
        matrix[on_circle, slide], matrix[on_circle, k + slide] = p[0, slide] / scale, p[1, slide] / scale
        rhs[on_circle] = 0.5 * (g[slide] ** 2 - (p[:, slide] ** 2).sum(axis=0)) / scale
        parallel = on_circle + len(slide)
        matrix[parallel] = (p[0, slide, None] * A[k + slide] - p[1, slide, None] * A[slide]) / scale
        matrix[parallel, slide] += S[1, slide] / scale
        matrix[parallel, k + slide] -= S[0, slide] / scale
        rhs[parallel] = (p[1, slide] * S[0, slide] - p[0, slide] * S[1, slide]) / scale
        try:
            change = np.linalg.solve(matrix, rhs).reshape(2, k)
        except np.linalg.LinAlgError as error:
            raise TangDidNotConverge("Newton's method met a singular matrix") from error
        p += change
        size_of_change = float(np.abs(change).max())
        if not np.isfinite(size_of_change):
            break
        if size_of_change <= 1e-12 * scale:
            return p, iteration
    raise TangDidNotConverge(f"Newton's method did not converge in {MAXIMUM_NEWTON} iterations")


def _unit(vectors: NDArray) -> NDArray:
    return vectors / np.maximum(np.hypot(vectors[0], vectors[1]), 1e-300)
