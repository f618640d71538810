"""The contact conditions, evaluated from the equations with full matrices: nothing of the solvers' own bookkeeping."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.influence import influence_coefficients
from wheelrail.contact.normal import NormalProblem, NormalState
from wheelrail.contact.rolling import RollingState

STEEL = 207e9 / 2.6, 0.3


@cache
def influence(half_space: HalfSpace, moved: bool = False) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """A33, A11, A22 and A12 of all elements on all, each shape (n, n); ``moved``: seen from one element upstream."""
    x = half_space.x[:, None] - half_space.x + (half_space.dx if moved else 0.0)
    y = half_space.y[:, None] - half_space.y
    return influence_coefficients(
        x,
        y,
        dx=half_space.dx,
        dy=half_space.dy,
        shear_modulus=half_space.shear_modulus,
        poisson_ratio=half_space.poisson_ratio,
    )


def displacement(half_space: HalfSpace, tractions: NDArray, moved: bool = False) -> NDArray:
    """Tangential displacements under tractions on the whole grid, both of shape (2, n)."""
    _, a11, a22, a12 = influence(half_space, moved)
    return np.stack([a11 @ tractions[0] + a12 @ tractions[1], a12 @ tractions[0] + a22 @ tractions[1]])


def normal_residual(problem: NormalProblem, state: NormalState) -> float:
    """Largest violation of p >= 0, d >= 0, p d = 0, F = sum p dx dy and the coupling equation, each made relative."""
    half_space, p = problem.half_space, state.pressure
    load = problem.weight * state.approach + problem.compliance * state.force - problem.rhs
    terms = abs(problem.weight * state.approach) + abs(problem.compliance * state.force) + abs(problem.rhs)
    violations = [abs(load) / terms if terms > 0.0 else 0.0]
    if problem.weight == 0.0 and problem.rhs <= 0.0:  # a pull cannot be carried
        assert state.force == 0.0
        violations = []
    touching = np.zeros(half_space.elements, dtype=bool)
    touching[state.contact] = True
    assert not p[~touching].any()
    d = problem.undeformed_distance - state.approach + influence(half_space)[0] @ p
    if p.any():
        depth = state.approach - problem.undeformed_distance.min()
        assert depth > 0.0
        violations += [-p.min() / p.max(), -d.min() / depth, np.abs(p * d).max() / (p.max() * depth)]
        violations += [np.abs(d[touching]).max() / depth]
        violations += [abs(p.sum() * half_space.element_area / state.force - 1.0)]
    else:
        assert state.force == 0.0
        assert len(state.contact) == 0
        violations.append(-d.min() / np.ptp(problem.undeformed_distance))
    return float(max(violations))


def traction_residual(
    half_space: HalfSpace,
    normal: NormalState,
    state: RollingState,
    *,
    friction: float,
    shift: NDArray,
    previous: NDArray,
) -> float:
    """Largest violation of |p| <= mu p3, S = 0 in stick, p = -mu p3 S / |S| in slip, over the largest bound.

    Slip distances count by the traction that makes them on one element.
    """
    p, touching = state.tractions, normal.pressure > 0.0
    assert not p[:, ~touching].any()
    assert not state.slipping[~touching].any()
    if not touching.any():
        return 0.0
    bound = friction * normal.pressure
    largest = bound.max()
    S = displacement(half_space, p) + shift - displacement(half_space, previous, moved=True)
    compliance = influence(half_space)[1][0, 0]
    S = S / compliance
    size, speed = np.hypot(*p), np.hypot(*S)
    stick, slip = touching & ~state.slipping, state.slipping
    violations = [(size - bound)[touching].max(), speed[stick].max(initial=0.0)]
    violations += [np.abs(size - bound)[slip].max(initial=0.0)]
    # p |S| + mu p3 S = 0, in units of a traction
    against = np.hypot(*(p * speed + bound * S)) / np.maximum(speed, largest)
    violations += [against[slip].max(initial=0.0)]
    # the traction after the step alone never drives the slip
    assert (p * S)[:, slip].sum(axis=0).max(initial=0.0) <= 0.0
    return float(max(violations)) / float(largest)


def particle_work(half_space: HalfSpace, tractions: NDArray, *, shift: NDArray, previous: NDArray) -> float:
    """Work of friction in a step, J: for each particle the mean of its tractions before and after, times its slip."""
    S = displacement(half_space, tractions) + shift - displacement(half_space, previous, moved=True)
    total = 0.0
    for element in range(half_space.elements):
        before = previous[:, element + 1] if (element + 1) % half_space.mx else np.zeros(2)
        total -= 0.5 * half_space.element_area * float((tractions[:, element] + before) @ S[:, element])
    return total
