"""All solutions of a step with slip-velocity dependent friction that can be found.

Full stick and full slip as guesses lead to the solutions with the least and the most slip. Where they differ there is a
third one between them, from which iterating between contact and law runs away to either side (Vollebregt and
Schuttelaars 2012, J. Sound Vib. 331, 2141-2155); only Newton's method finds it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .newton import is_repelling, newton
from .problem import TOLERANCE, SlipFrictionProblem, SlipFrictionState
from .solve import solve_slip_friction

__all__ = ["Solution", "find_solutions", "force_spread"]

_SAME = 1e-6  # of the largest bound: tractions that differ by less are one solution
_HALVINGS = 16  # of the way between two solutions
_ITERATIONS = 60  # between contact and law, after which one of the two should show
_DECIDED = 0.005  # share of the way to a solution within which the iteration has decided for it


@dataclass(frozen=True)
class Solution:
    """One of several solutions.

    Attributes
    ----------
    name : str
        "low-slip", "middle" or "high-slip"; "only" if there is no other.
    problem : SlipFrictionProblem
    state : SlipFrictionState
    """

    name: str
    problem: SlipFrictionProblem
    state: SlipFrictionState

    @cached_property
    def repelling(self) -> bool:
        """Whether iterating between contact and law runs away from it."""
        return is_repelling(self.problem, self.state.tractions)


def find_solutions(
    problem: SlipFrictionProblem,
    tractions: NDArray,
    speed: NDArray,
    *,
    between: bool = True,
    known: SlipFrictionState | None = None,
) -> tuple[Solution, ...]:
    """Look for all solutions.

    Parameters
    ----------
    problem : SlipFrictionProblem
    tractions : ndarray, shape (2, k)
        Of the step before, Pa.
    speed : ndarray, shape (k,)
        Slip velocities of the step before, m/s.
    between : bool
        Also search for a solution between two others, which takes long. Without, it is found only if it is near the
        tractions of the step before.
    known : SlipFrictionState, optional
        Solution from the slip of the step before, if it is at hand.

    Returns
    -------
    tuple of Solution
        In order of slip; none if no method converged.

    Notes
    -----
    There may be more. Solutions come with alternating signs of det(1 - T'), T' the derivative of the iteration between
    contact and law, that add up to 1; so an even number means that at least one was missed. The example of the
    publication has five: two more lie next to the middle one, which itself repels in two directions.
    """
    found: list[SlipFrictionState] = []
    if known is not None:
        _add(found, known)
    for guess in (np.zeros_like(speed), problem.speed(problem.shift), *([speed] if known is None else [])):
        _add(found, solve_slip_friction(problem, tractions, guess))
    if len(problem.contact):
        _try_newton(problem, tractions, found)
    found.sort(key=_slip)
    if between and len(found) == 2:
        for tractions in _along_the_watershed(problem, *found):
            _try_newton(problem, tractions, found)
        found.sort(key=_slip)
    names = ["low-slip", *["middle"] * (len(found) - 2), "high-slip"] if len(found) > 1 else ["only"] * len(found)
    return tuple(Solution(name, problem, state) for name, state in zip(names, found, strict=True))


def force_spread(problem: SlipFrictionProblem, solutions: tuple[Solution, ...]) -> float:
    """Return the largest difference between the tangential forces of solutions, N."""
    if not solutions:
        return 0.0
    forces = [problem.half_space.element_area * each.state.tractions.sum(axis=1) for each in solutions]
    return max(float(np.hypot(*(one - other))) for one in forces for other in forces)


def _along_the_watershed(
    problem: SlipFrictionProblem, low: SlipFrictionState, high: SlipFrictionState
) -> list[NDArray]:
    """Return tractions that pass near the solutions between two others, each of shape (2, k).

    Iterations that start on either side of them go to different solutions; one that starts close to the border passes
    close to the solutions that repel.
    """
    slow, fast = problem.speed(low.slip), problem.speed(high.slip)
    from_low, from_high = float(slow.sum()), float(fast.sum())
    below, above, way = 0.0, 1.0, []
    for _ in range(_HALVINGS):
        place = share = 0.5 * (below + above)
        speed, tractions, passed = slow + share * (fast - slow), low.tractions, []
        for _ in range(_ITERATIONS):
            tractions = problem.solve_for(problem.coefficient(speed)[0], tractions).tractions
            speed = problem.speed(problem.evaluate(tractions).slip)
            place = (float(speed.sum()) - from_low) / (from_high - from_low)
            passed.append(tractions)
            if not _DECIDED < place < 1.0 - _DECIDED:
                break
        if len(passed) > 1:
            way = passed
        if place < 0.5:
            below = share
        else:
            above = share
    return way


def _try_newton(problem: SlipFrictionProblem, tractions: NDArray, found: list[SlipFrictionState]) -> None:
    solution, steps, converged = newton(problem, tractions)
    if converged:
        _add(found, problem.state(solution, steps, "newton"))


def _add(found: list[SlipFrictionState], state: SlipFrictionState) -> None:
    if not state.residual <= TOLERANCE:
        return
    scale = max((float(np.abs(each.tractions).max(initial=0.0)) for each in [*found, state]), default=0.0)
    for each in found:
        if float(np.abs(each.tractions - state.tractions).max(initial=0.0)) <= _SAME * scale:
            return
    found.append(state)


def _slip(state: SlipFrictionState) -> float:
    return float(np.hypot(state.slip[0], state.slip[1]).sum())
