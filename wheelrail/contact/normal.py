"""Normal contact of two half-spaces with any undeformed distance: Kalker's NORM (Pieringer 2011, section 3.4.2).

    d = h - delta + A33 p >= 0,      p >= 0,      d p = 0

with h the undeformed distance and delta the approach. As for every normal contact model here the approach follows from
``weight * delta + compliance * F = rhs``: a given approach, a given force, or the coupled equation with the first
samples of the Green's functions kept. For a given set of contact elements pressure and force are linear in the
approach, so all three are solved within the one active set iteration; no outer Newton loop is needed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .half_space import HalfSpace

__all__ = ["NormalProblem", "NormalState", "solve_normal"]

MAXIMUM_ITERATIONS = 200
SIMULTANEOUS_ITERATIONS = 30  # after which elements leave and enter in turn, which can't cycle
_ROUNDING = 1e-13  # of the deepest penetration: smaller negative distances are rounding


@dataclass(frozen=True)
class NormalProblem:
    """A normal contact problem.

    Parameters
    ----------
    half_space : HalfSpace
    undeformed_distance : ndarray, shape (n,)
        h in m; only differences matter, the approach counts from h = 0.
    weight, compliance, rhs : float
        ``weight * delta + compliance * F = rhs`` (-, m/N, m; or 0, 1, N for a given force).
    """

    half_space: HalfSpace
    undeformed_distance: NDArray
    weight: float
    compliance: float
    rhs: float


@dataclass(frozen=True)
class NormalState:
    """Solution of a normal contact problem.

    Attributes
    ----------
    pressure : ndarray, shape (n,)
        p3 in Pa, 0 outside the contact.
    contact : ndarray of int, shape (k,)
        Elements in contact.
    approach, force : float
        m and N.
    stiffness : float
        dF/d(approach) in N/m at constant contact set.
    iterations : int
        Linear systems solved.
    residual : float
        Largest violation of the contact conditions: distance over approach, pressure over largest pressure.
    """

    pressure: NDArray
    contact: NDArray
    approach: float
    force: float
    stiffness: float
    iterations: int
    residual: float


def solve_normal(problem: NormalProblem, guess: NDArray | None = None) -> NormalState:
    """Find pressure, contact elements and approach.

    Parameters
    ----------
    problem : NormalProblem
    guess : ndarray of int, optional
        Elements of a contact nearby, such as that of the step before.

    Returns
    -------
    NormalState
    """
    half_space, h = problem.half_space, problem.undeformed_distance
    weight, compliance, rhs = problem.weight, problem.compliance, problem.rhs
    lowest = int(np.argmin(h))
    if rhs - weight * h[lowest] <= 0.0:  # no contact: the approach is that of free bodies
        approach = rhs / weight if weight > 0.0 else float(h[lowest])
        residual = float(weight == 0.0 and rhs < 0.0)  # a pulling force can't be had
        return NormalState(np.zeros(len(h)), np.zeros(0, dtype=int), approach, 0.0, 0.0, 0, residual)
    contact = np.array([lowest]) if guess is None or len(guess) == 0 else guess
    area, table = half_space.element_area, half_space.coefficients.a33.ravel()
    pressure = np.zeros(len(h))
    approach = stiffness = residual = 0.0
    iterations = 0
    while iterations < MAXIMUM_ITERATIONS:
        iterations += 1
        matrix = table.take(half_space.pairs(contact, contact))
        # The pressure is approach * per_approach - rest; so are the forces.
        per_approach, rest = np.linalg.solve(matrix, np.stack([np.ones(len(contact)), h[contact]], axis=1)).T
        stiffness = area * float(per_approach.sum())
        approach = (rhs + compliance * area * float(rest.sum())) / (weight + compliance * stiffness)
        pressure[:] = 0.0
        pressure[contact] = approach * per_approach - rest
        distance = h - approach + half_space.normal_displacement(pressure)
        depth = approach - float(h[lowest])
        outside = np.ones(len(h), dtype=bool)
        outside[contact] = False
        enter = outside & (distance < -_ROUNDING * abs(depth))
        leave = pressure < 0.0
        if not (enter.any() or leave.any()):
            residual = max(float(np.abs(distance[contact]).max()), -float(distance.min())) / depth
            break
        # All at once converges in a few iterations from a good guess, but may cycle; elements that leave first and
        # enter only when no pressure is negative any more (Kalker's order) can't.
        if iterations > SIMULTANEOUS_ITERATIONS and leave.any():
            enter[:] = False
        contact = np.flatnonzero((~outside & ~leave) | enter)
        if len(contact) == 0:
            contact = np.array([lowest])
    else:
        residual = max(-float(distance.min()) / abs(depth), -float(pressure.min() / pressure.max()))
        pressure = np.maximum(pressure, 0.0)
    return NormalState(pressure, contact, approach, area * float(pressure.sum()), stiffness, iterations, residual)
