"""Newton's method with a safeguard for the approach of one contact.

The approach d of wheel and rail solves

    stiffness_free * d + compliance * F(d) = right_hand_side

with F zero up to first touch and convex and increasing beyond it: stiffness_free = 1 with the first samples of the
Green's functions as compliance is the coupled equation of Pieringer (2011), eqs. 3.28 to 3.32; stiffness_free = 0 and
compliance = 1 is contact under a given force.
"""

from __future__ import annotations

from collections.abc import Callable

__all__ = ["MAXIMUM_ITERATIONS", "TOLERANCE", "solve_approach"]

TOLERANCE = 1e-13  # of the residual, relative to the largest term
MAXIMUM_ITERATIONS = 100
_SMALLEST = 1e-12  # m; approaches are judged against at least this length


def solve_approach(
    law: Callable[[float], tuple[float, float]],
    touch: float,
    scale: float,
    weight: float,
    compliance: float,
    rhs: float,
    guess: float,
) -> tuple[float, float, float, int, float]:
    """Solve ``weight * d + compliance * F(d) = rhs``.

    Parameters
    ----------
    law : callable
        F(d) in N and dF/dd in N/m.
    touch : float
        Approach of first touch in m: F = 0 for d <= touch.
    scale : float
        An approach in m, counted from first touch, typical of the contact (for the first trial step).
    weight, compliance, rhs : float
        Coefficients of the equation; weight >= 0, compliance >= 0, not both 0.
    guess : float
        Where to start, m.

    Returns
    -------
    approach, force, stiffness : float
        m, N and N/m, consistent with each other.
    iterations : int
        Evaluations of the law.
    residual : float
        Of the equation, relative to its largest term.
    """
    if rhs - weight * touch <= 0.0:
        # Out of contact: F = 0 and the bodies separate. (With weight 0, no force is asked for: they just touch.)
        # A pulling force can't be had at all, which the residual says.
        return (rhs / weight if weight > 0.0 else touch), 0.0, 0.0, 0, float(weight == 0.0 and rhs < 0.0)
    # The solution lies right of first touch; with weight 0 the upper bound is not known yet.
    low = touch
    high = rhs / weight if weight > 0.0 else float("inf")
    d = guess if low < guess < high else min(low + scale, 0.5 * (low + high))
    largest = abs(rhs) + abs(weight * touch) + weight * _SMALLEST
    force = stiffness = residual = 0.0
    iterations = 0
    while iterations < MAXIMUM_ITERATIONS:
        iterations += 1
        force, stiffness = law(d)
        error = weight * d + compliance * force - rhs
        residual = abs(error) / largest
        if residual <= TOLERANCE:
            break
        if error > 0.0:
            high = d
        else:
            low = d
        slope = weight + compliance * stiffness
        trial = d - error / slope if slope > 0.0 else low
        # Newton stays inside the bracket except far from the solution; then the interval is halved (or opened).
        if not low < trial <= high:
            trial = 0.5 * (low + high) if high < float("inf") else low + 2.0 * (low - touch) + scale
        if trial in (d, low):  # the bracket has shrunk to neighbouring numbers: rounding is all that is left
            break
        d = trial
    return d, force, stiffness, iterations, residual
