"""Vollebregt and Schuttelaars (2012), J. Sound Vib. 331, 2141-2155: several solutions of one step, two-dimensional.

Their example, as Vollebregt's open CONTACT ships it: from the steady state one step has three solutions, and what
follows depends on which is taken. The table has four digits.
"""

from __future__ import annotations

import csv
from functools import cache

import numpy as np
import pytest
from thesis_contact import DATA

from wheelrail.contact.friction.laws import ExponentialLaw
from wheelrail.contact.friction.problem import SlipFrictionProblem
from wheelrail.contact.friction.settings import SlipFriction
from wheelrail.contact.friction.solutions import Solution, find_solutions, force_spread
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, NormalState, solve_normal
from wheelrail.contact.rolling import rigid_shift
from wheelrail.contact.slip_dependent_rolling import (
    SlipDependentState,
    roll_slip_dependent,
    steady_rolling_slip_dependent,
)

STATIC, LAW, DX = 0.3, ExponentialLaw(ratio=0.6, half_speed=0.1), 0.1e-3
DT = DX / 45.0
CREEPAGE = -1e-3
DIGITS = 5e-4  # of the table, relative


@pytest.fixture(scope="module")
def table() -> list[dict[str, str]]:
    with (DATA / "falling_friction_two_dimensional.csv").open() as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


@cache
def line_contact() -> tuple[HalfSpace, NormalState]:
    """One row of elements, 0.2 m wide: nearly plane strain."""
    half_space = HalfSpace(93, 1, DX, 0.2, 82e9, 0.28)
    return half_space, solve_normal(NormalProblem(half_space, half_space.x**2 / (2.0 * 0.46), 0.0, 1.0, 622216.0))


@cache
def steady_state() -> SlipDependentState:
    half_space, normal = line_contact()
    return steady_rolling_slip_dependent(
        half_space,
        normal,
        friction=SlipFriction(LAW),
        static=STATIC,
        dt=DT,
        creepage_x=-0.0009999,
        creepage_y=0.0,
        creepage_spin=0.0,
    )


def shift() -> np.ndarray:
    half_space, _ = line_contact()
    return rigid_shift(half_space, creepage_x=CREEPAGE, creepage_y=0.0, creepage_spin=0.0, distance=DX)


def force(solution: Solution) -> float:
    return line_contact()[0].element_area * float(solution.state.tractions[0].sum())


def step_problem() -> tuple[SlipFrictionProblem, np.ndarray, np.ndarray]:
    half_space, normal = line_contact()
    before, contact = steady_state(), normal.contact
    h = shift() - half_space.carried_displacement(before.rolling.tractions)
    problem = SlipFrictionProblem(half_space, contact, normal.pressure[contact], h[:, contact], DT, LAW, STATIC)
    return problem, before.rolling.tractions[:, contact], before.speed[contact]


def test_normal_contact():
    _, normal = line_contact()
    assert len(normal.contact) == 81
    assert normal.pressure.max() == pytest.approx(495.3e6, rel=DIGITS)  # 7e-5
    assert normal.approach == pytest.approx(0.08879e-3, rel=DIGITS)  # 4e-5


def test_steady_rolling(table):
    state = steady_state()
    assert state.rolling.residual < 1e-10  # 5e-14
    assert state.rolling.force_x == pytest.approx(float(table[0]["force_x_N"]), rel=DIGITS)  # 110896 N: 4e-5
    assert np.count_nonzero(state.rolling.slipping) == 36


def test_three_solutions_of_one_step(table):
    problem, tractions, speed = step_problem()
    found = find_solutions(problem, tractions, speed)
    assert [solution.name for solution in found] == ["low-slip", "middle", "high-slip"]
    low, middle, high = found
    expected = [float(row["force_x_N"]) for row in (table[1], table[0], table[3])]
    # 111563, 110896 and 106447 N: 3e-4, 4e-5, 4e-4
    np.testing.assert_allclose([force(low), force(middle), force(high)], expected, rtol=DIGITS)
    assert [np.count_nonzero(solution.state.slipping) for solution in found] == [4, 36, 47]
    assert [solution.repelling for solution in found] == [False, True, False]
    assert max(solution.state.residual for solution in found) < 1e-8  # 1e-10
    assert force_spread(problem, found) == pytest.approx(force(low) - force(high))  # 5115 N


@pytest.mark.parametrize(
    ("branch", "first", "what"), [("low-slip", 1, "step from full stick"), ("high-slip", 3, "step from full slip")]
)
def test_branch_selects_the_solution(table, branch, first, what):
    assert table[first]["what"] == what
    state = rolled(branch, 1)[0]
    assert state.rolling.force_x == pytest.approx(float(table[first]["force_x_N"]), rel=DIGITS)  # 4e-4
    assert np.count_nonzero(state.rolling.slipping) == int(table[first]["slipping"])


def rolled(branch: str, steps: int) -> list[SlipDependentState]:
    half_space, normal = line_contact()
    state, states = steady_state(), []
    for _ in range(steps):
        state = roll_slip_dependent(
            half_space,
            normal,
            friction=SlipFriction(LAW, branch=branch),
            static=STATIC,
            dt=DT,
            shift=shift(),
            previous=state.rolling.tractions,
            speed=state.speed,
            coefficient=state.coefficient,
        )
        states.append(state)
    return states


def test_what_follows_the_step_of_high_slip(table):
    """The next jump comes after six steps and every sixth step again."""
    reference = np.array([float(row["force_x_N"]) for row in table[3:20]])
    states = rolled("high-slip", len(reference))
    forces = np.array([state.rolling.force_x for state in states])
    np.testing.assert_allclose(forces, reference, rtol=DIGITS)  # 4.8e-4, what rounding to four digits does
    jumps = np.flatnonzero(np.diff(reference) < 0.0)
    np.testing.assert_array_equal(np.flatnonzero(np.diff(forces) < 0.0), jumps)


def test_the_steady_state_is_left_even_if_it_is_started_on():
    forces = [state.rolling.force_x for state in rolled("previous", 8)]
    assert forces[0] == pytest.approx(110896.0, rel=1e-5)
    assert np.ptp(forces) > 4e3  # 5.8 kN


def test_the_power_of_friction(table):
    half_space, normal = line_contact()
    for state, row in zip(rolled("high-slip", 4), table[3:7], strict=True):
        # As the reference has it, with the traction after the step: -sum p S dx dy / dt.
        power = half_space.element_area * float((state.rolling.tractions * state.rolling.slip).sum()) / DT
        assert power == pytest.approx(float(row["friction_power_W"]), rel=3e-3)  # 1.9e-3; the later ones 3e-4
    assert len(normal.contact) == 81
