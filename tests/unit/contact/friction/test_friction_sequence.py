"""Sequences of rolling steps in which everything changes: the conditions hold at each."""

from __future__ import annotations

import numpy as np
import pytest
from slip_conditions import (
    GRID,
    KINDS,
    Formula,
    coefficient_of,
    influence,
    law_and_formula,
    slip_of,
    violation,
)

from wheelrail.contact.friction.laws import ConstantLaw
from wheelrail.contact.friction.memory import FrictionMemory
from wheelrail.contact.friction.problem import SlipFrictionProblem
from wheelrail.contact.friction.settings import SlipFriction
from wheelrail.contact.normal import NormalProblem, NormalState, solve_normal
from wheelrail.contact.rolling import rigid_shift
from wheelrail.contact.slip_dependent_rolling import SlipDependentState, entering, roll_slip_dependent

STILL = np.zeros(GRID.elements)
SMOOTH = GRID.x**2 / (2 * 0.39) + GRID.y**2 / (2 * 0.30)


def brought(coefficient: np.ndarray, fresh: float) -> np.ndarray:
    """What each element's particle had one step before, dx upstream; those that enter the grid are fresh."""
    rows = coefficient.reshape(GRID.my, GRID.mx)
    return np.hstack([rows[:, 1:], np.full((GRID.my, 1), fresh)]).ravel()


def check(
    friction: SlipFriction,
    formula: Formula,
    normal: NormalState,
    state: SlipDependentState,
    *,
    shift: np.ndarray,
    previous: np.ndarray,
    before: np.ndarray,
    **others,
) -> float:
    """Violation of the conditions; slip, speeds and coefficients are what they have to be."""
    at, tractions = normal.contact, state.rolling.tractions
    outside = np.ones(GRID.elements, dtype=bool)
    outside[at] = False
    assert not tractions[:, outside].any()
    assert not state.rolling.slip[:, outside].any()
    a11, a22, a12 = influence(GRID, moved=True)
    gone = np.stack([a11 @ previous[0] + a12 @ previous[1], a12 @ previous[0] + a22 @ previous[1]])
    pressure, h = normal.pressure[at], (shift - gone)[:, at]
    problem = SlipFrictionProblem(
        GRID, at, pressure, h, law=friction.law, memory=friction.memory, previous=before[at], **others
    )
    slip, slipping = slip_of(problem, tractions[:, at]), state.rolling.slipping[at]
    np.testing.assert_allclose(state.rolling.slip[:, at], np.where(slipping, slip, 0.0), rtol=1e-7, atol=1e-17)
    np.testing.assert_allclose(
        state.speed[at], np.where(slipping, np.hypot(*slip) / problem.dt, 0.0), rtol=1e-7, atol=1e-12
    )
    np.testing.assert_allclose(state.coefficient[at], coefficient_of(problem, formula, slip), rtol=1e-8)
    # Where there is no contact, nothing slips.
    still = SlipFrictionProblem(
        GRID, at, pressure, h, law=friction.law, memory=friction.memory, previous=before, **others
    )
    rest = coefficient_of(still, formula, np.zeros((2, GRID.elements)))
    np.testing.assert_allclose(state.coefficient[outside], rest[outside], rtol=1e-14)
    work = friction_work(state, previous, shift=shift - gone, compliance=problem.compliance)
    assert state.rolling.friction_work == pytest.approx(work, rel=1e-9, abs=1e-12)
    return violation(problem, formula, tractions[:, at]) if len(at) else 0.0


def friction_work(
    state: SlipDependentState, previous: np.ndarray, *, shift: np.ndarray, compliance: np.ndarray | None
) -> float:
    """For each particle the mean of its tractions before and after, times its slip, J."""
    tractions = state.rolling.tractions
    everywhere = SlipFrictionProblem(
        GRID, np.arange(GRID.elements), STILL, shift, 1.0, ConstantLaw(), 1.0, compliance=compliance
    )
    before = np.stack([brought(component, 0.0) for component in previous])
    return -GRID.dx * GRID.dy * float(np.sum(0.5 * (tractions + before) * slip_of(everywhere, tractions)))


def random_sequence(steps: int, seed: int) -> dict[str, float]:
    """Law, memory, load, creepages, roughness and compliance change; contact is lost and comes back."""
    generator = np.random.default_rng(seed)
    result = dict.fromkeys(("residual", "reported", "iterations", "work", "no contact", "stick", "slip"), 0.0)
    tractions, speed, size = np.zeros((2, GRID.elements)), STILL, 0.0
    for step in range(steps):
        if step % 20 == 0:
            law, formula = law_and_formula(str(generator.choice(KINDS)), generator)
            memory = FrictionMemory(10.0 ** generator.uniform(-6, -4), 10.0 ** generator.uniform(-4, -2))
            friction = SlipFriction(law, memory if generator.random() < 0.6 else None)
            static, dt = generator.uniform(0.05, 0.6), GRID.dx / 10.0 ** generator.uniform(0.7, 1.8)
            size, spread = 10.0 ** generator.uniform(-5, -2), generator.choice([0.0, 0.1, 1.0])
            mean, root = generator.standard_normal(3), generator.standard_normal((2, 2))
            load = 10.0 ** generator.uniform(1, 4.3)
            compliance = root @ root.T * 10.0 ** generator.uniform(-11, -9) if generator.random() < 0.5 else None
            coefficient = entering(GRID, friction, static)
        x, y, spin = size * (mean + spread * generator.standard_normal(3))
        now = 0.0 if generator.random() < 0.03 else load * np.exp(0.2 * spread * generator.standard_normal())
        rough = SMOOTH - 1e-6 * spread * generator.standard_normal(GRID.elements)
        normal = solve_normal(NormalProblem(GRID, rough, 0.0, 1.0, now))
        shift = rigid_shift(GRID, creepage_x=x, creepage_y=y, creepage_spin=100 * spin, distance=GRID.dx)
        shift += 1e-3 * size * spread * generator.standard_normal((2, 1))  # wheel and rail move
        changing = {"static": static, "dt": dt, "compliance": compliance}
        state = roll_slip_dependent(
            GRID,
            normal,
            friction=friction,
            shift=shift,
            previous=tractions,
            speed=speed,
            coefficient=coefficient,
            **changing,
        )
        before = brought(coefficient, static * formula(0.0))
        found = check(friction, formula, normal, state, shift=shift, previous=tractions, before=before, **changing)
        tractions, speed, coefficient = state.rolling.tractions, state.speed, state.coefficient
        result["residual"] = max(result["residual"], found)
        result["reported"] = max(result["reported"], state.rolling.residual)
        result["iterations"] = max(result["iterations"], state.rolling.iterations)
        result["work"] += state.rolling.friction_work
        touching = len(normal.contact)
        result["no contact"] += touching == 0
        result["stick"] += touching > 3 and not state.rolling.slipping.any()
        result["slip"] += touching > 3 and state.rolling.slip_fraction == 1.0
    return result


def test_conditions_hold_in_a_random_sequence():
    result = random_sequence(600, seed=1)
    assert result["residual"] < 1e-8  # 1.4e-10
    assert result["reported"] <= 1e-10
    assert result["iterations"] <= 30  # 2
    assert result["work"] > 0.0
    for kind in ("no contact", "stick", "slip"):
        assert result[kind] > 5, kind


@pytest.mark.slow
def test_conditions_hold_in_10000_random_steps():
    result = random_sequence(10_000, seed=2)
    assert result["residual"] < 1e-8  # 2.1e-10
    assert result["reported"] <= 1e-10
    assert result["iterations"] <= 60  # 3
