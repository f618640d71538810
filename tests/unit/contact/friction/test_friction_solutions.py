"""Several solutions of one step: all found, named, and the one between told from the others.

The step is the two-dimensional one of Vollebregt and Schuttelaars (2012), J. Sound Vib. 331, 2141-2155, in one row of
elements; their numbers are asserted in tests/verification.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from slip_conditions import GRID, NORMAL, random_guess, random_problem, violation

from wheelrail.contact.friction.laws import ExponentialLaw
from wheelrail.contact.friction.newton import is_repelling, is_reversed, newton
from wheelrail.contact.friction.problem import TOLERANCE, SlipFrictionProblem
from wheelrail.contact.friction.settings import SlipFriction
from wheelrail.contact.friction.solutions import find_solutions, force_spread
from wheelrail.contact.friction.solve import solve_slip_friction
from wheelrail.contact.friction.thesis_iteration import fixed_point
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, NormalState, solve_normal
from wheelrail.contact.rolling import rigid_shift
from wheelrail.contact.slip_dependent_rolling import (
    SlipDependentState,
    roll_slip_dependent,
    steady_rolling_slip_dependent,
)

LAW, STATIC, DX = ExponentialLaw(ratio=0.6, half_speed=0.1), 0.3, 0.1e-3


def formula(speed: float) -> float:
    return 0.6 + 0.4 * 0.5 ** (speed / 0.1)


@cache
def line_contact() -> tuple[HalfSpace, NormalState, SlipDependentState, np.ndarray]:
    """Contact, steady rolling at a slightly smaller creepage than that of the step, and the rigid shift of the step."""
    grid = HalfSpace(93, 1, DX, 0.2, 82e9, 0.28)
    normal = solve_normal(NormalProblem(grid, grid.x**2 / (2 * 0.46), 0.0, 1.0, 622216.0))
    others = {"creepage_y": 0.0, "creepage_spin": 0.0}
    before = steady_rolling_slip_dependent(
        grid, normal, friction=SlipFriction(LAW), static=STATIC, dt=DX / 45.0, creepage_x=-0.0009999, **others
    )
    return grid, normal, before, rigid_shift(grid, creepage_x=-0.001, distance=DX, **others)


@cache
def step() -> tuple[SlipFrictionProblem, np.ndarray, np.ndarray]:
    """Problem, tractions and slip velocities of the step before."""
    grid, normal, before, shift = line_contact()
    at, gap = normal.contact, shift - grid.carried_displacement(before.rolling.tractions)
    problem = SlipFrictionProblem(grid, at, normal.pressure[at], gap[:, at], DX / 45.0, LAW, STATIC)
    return problem, before.rolling.tractions[:, at], before.speed[at]


def solved():
    return find_solutions(*step())


def force(tractions: np.ndarray) -> float:
    return step()[0].half_space.element_area * float(tractions[0].sum())


def test_all_three_solutions_are_found_and_solve_the_equations():
    found = solved()
    assert [each.name for each in found] == ["low-slip", "middle", "high-slip"]
    assert [each.repelling for each in found] == [False, True, False]
    assert [np.count_nonzero(each.state.slipping) for each in found] == [4, 36, 47]
    np.testing.assert_allclose([force(each.state.tractions) for each in found], [111.6e3, 110.9e3, 106.4e3], atol=50.0)
    for each in found:
        assert each.state.residual <= TOLERANCE
        assert violation(step()[0], formula, each.state.tractions) < 1e-9  # 1.3e-10
    slips = [np.hypot(*each.state.slip).sum() for each in found]
    assert slips == sorted(slips)


def test_force_spread_is_the_largest_difference():
    found = solved()
    forces = [force(each.state.tractions) for each in found]
    assert force_spread(step()[0], found) == pytest.approx(forces[0] - forces[2], rel=1e-12)
    assert force_spread(step()[0], found[:2]) == pytest.approx(forces[0] - forces[1], rel=1e-12)
    assert force_spread(step()[0], found[1:2]) == 0.0


@pytest.mark.parametrize("solver", ["newton", "broyden"])
def test_full_stick_and_full_slip_as_guess_lead_to_the_ends(solver):
    problem, tractions, _ = step()
    low, _, high = solved()
    for guess, end in ((np.zeros(81), low), (problem.speed(problem.shift), high)):
        state = solve_slip_friction(problem, tractions, guess, solver=solver)
        np.testing.assert_allclose(state.tractions, end.state.tractions, rtol=0, atol=1e-8 * 0.3 * 495e6)


def test_the_ends_are_found_from_any_start():
    problem, _, _ = step()
    generator = np.random.default_rng(1)
    low, _, high = solved()
    for _ in range(5):
        found = find_solutions(problem, *random_guess(problem, generator))
        assert (found[0].name, found[-1].name) == ("low-slip", "high-slip")
        for each, end in ((found[0], low), (found[-1], high)):
            np.testing.assert_allclose(each.state.tractions, end.state.tractions, rtol=0, atol=1e-8 * 0.3 * 495e6)
        assert force_spread(problem, found) == pytest.approx(5115.23, abs=0.01)


@pytest.mark.parametrize(("branch", "number"), [("previous", 1), ("low-slip", 0), ("high-slip", 2)])
def test_a_rolling_step_takes_its_branch_and_counts_the_solutions(branch, number):
    grid, normal, before, shift = line_contact()
    for find in (False, True):
        state = roll_slip_dependent(
            grid,
            normal,
            friction=SlipFriction(LAW, branch=branch, find_solutions=find),
            static=STATIC,
            dt=DX / 45.0,
            shift=shift,
            previous=before.rolling.tractions,
            speed=before.speed,
            coefficient=before.coefficient,
        )
        assert state.rolling.force_x == pytest.approx(force(solved()[number].state.tractions), rel=1e-9)
        assert state.solutions == (3 if find else 0)
        assert state.force_spread == pytest.approx(5115.23 if find else 0.0, abs=0.01)


@pytest.mark.parametrize("seed", [0, 22, 41, 120, 135])
def test_a_third_solution_is_searched_between_two(seed):
    """Steep laws without memory in three dimensions; nothing is known of a step before."""
    generator, at = np.random.default_rng(seed), NORMAL.contact
    dt = GRID.dx / 10.0 ** generator.uniform(0.7, 1.8)
    ratio, half = generator.uniform(0.1, 0.5), 10.0 ** generator.uniform(-2.5, -1)
    x, y = (10.0 ** generator.uniform(-3.5, -2.3) * generator.standard_normal() for _ in range(2))
    shift = rigid_shift(GRID, creepage_x=x, creepage_y=y, creepage_spin=0.0, distance=GRID.dx)[:, at]
    problem = SlipFrictionProblem(GRID, at, NORMAL.pressure[at], shift, dt, ExponentialLaw(ratio, half), 0.4)
    start = np.zeros((2, len(at))), np.zeros(len(at))
    ends = find_solutions(problem, *start, between=False)
    assert [each.name for each in ends] == ["low-slip", "high-slip"]
    found = find_solutions(problem, *start)
    names = [each.name for each in found]
    assert names == ["low-slip", *["middle"] * (len(names) - 2), "high-slip"]
    assert any(each.repelling for each in found[1:-1])
    slips = [np.hypot(*each.state.slip).sum() for each in found]
    assert slips == sorted(slips)
    for each in found:
        assert violation(problem, lambda s: ratio + (1 - ratio) * 0.5 ** (s / half), each.state.tractions) < 1e-9


def test_iterating_runs_away_from_the_middle_and_back_to_the_ends():
    problem, _, _ = step()
    low, middle, high = solved()

    def goes_to(state, factor: float) -> int:
        """Number of slipping elements where contact and law in turn come to from beside a solution."""
        reached = fixed_point(problem, state.tractions, factor * problem.speed(state.slip))
        assert reached.residual <= TOLERANCE
        return int(np.count_nonzero(reached.slipping))

    assert (goes_to(middle.state, 0.999), goes_to(middle.state, 1.001)) == (4, 47)
    for factor in (0.98, 1.02):
        assert goes_to(low.state, factor) == 4
        assert goes_to(high.state, factor) == 47
    # Newton's method stays there.
    tractions, steps, converged = newton(problem, 1.00001 * middle.state.tractions)
    assert converged
    assert steps <= 4
    assert force(tractions) == pytest.approx(force(middle.state.tractions), rel=1e-9)


def derivative_of_iteration(problem: SlipFrictionProblem, tractions: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Matrix of d f(s(mu)) / d mu by central differences, s from the contact for given coefficients."""

    def image(coefficient: np.ndarray) -> np.ndarray:
        solution = problem.solve_for(coefficient, tractions, gradient_steps=0)
        return problem.coefficient(problem.speed(solution.slip))[0]

    size, step = len(mu), 1e-6 * mu.max()
    columns = [(image(mu + step * one) - image(mu - step * one)) / (2.0 * step) for one in np.eye(size)]
    return np.stack(columns, axis=1)


def test_repelling_means_an_eigenvalue_above_one():
    """The middle has two of them, 1.04 and 3.17, so that the sign of the determinant does not tell."""
    problem = step()[0]
    largest = []
    for each in solved():
        T = derivative_of_iteration(problem, each.state.tractions, each.state.coefficient)
        values = np.linalg.eigvals(T)
        largest.append(values.real.max())
        assert each.repelling == is_repelling(problem, each.state.tractions) == (largest[-1] > 1.0)
        assert is_reversed(problem, each.state.tractions) == (np.linalg.det(np.eye(len(T)) - T) < 0.0)
    np.testing.assert_allclose(largest, [0.197, 3.169, 0.675], atol=2e-3)


def test_derivative_of_the_iteration_in_random_steps():
    generator = np.random.default_rng(2)
    signs = []
    for _ in range(25):
        problem, _ = random_problem(generator, ("exponential", "rational", "kraft"))
        state = solve_slip_friction(problem, *random_guess(problem, generator))
        T = derivative_of_iteration(problem, state.tractions, state.coefficient)
        assert is_repelling(problem, state.tractions) == (np.linalg.eigvals(T).real.max() > 1.0)
        assert is_reversed(problem, state.tractions) == (np.linalg.det(np.eye(len(T)) - T) < 0.0)
        signs.append(np.abs(T).max() > 0.1)
    assert sum(signs) >= 5  # it is not about nothing


@pytest.mark.parametrize("kind", ["constant", "kraft"])
def test_one_solution_is_the_only_one(kind):
    generator = np.random.default_rng(3)
    for _ in range(8):
        problem, _ = random_problem(generator, (kind,))
        found = find_solutions(problem, *random_guess(problem, generator))
        assert [each.name for each in found] == ["only"]
        assert found[0].state.residual <= TOLERANCE
        assert not found[0].repelling
        assert force_spread(problem, found) == 0.0


def test_nothing_in_contact_has_one_solution():
    nothing = SlipFrictionProblem(GRID, np.zeros(0, dtype=int), np.zeros(0), np.zeros((2, 0)), 1e-4, LAW, STATIC)
    (only,) = find_solutions(nothing, np.zeros((2, 0)), np.zeros(0))
    assert only.name == "only"
    assert force_spread(nothing, (only,)) == 0.0


def failing(monkeypatch, failures: int) -> tuple[SlipFrictionProblem, list]:
    """A step whose first solutions are not converged."""
    problem, _ = random_problem(np.random.default_rng(4), ("kraft",))
    calls = []

    def solve(problem, tractions, speed):
        state = solve_slip_friction(problem, tractions, speed)
        calls.append(state)
        return problem.state(0.99 * state.tractions, 400, "fixed-point") if len(calls) <= failures else state

    monkeypatch.setattr("wheelrail.contact.friction.solutions.solve_slip_friction", solve)
    return problem, calls


def test_what_does_not_solve_the_equations_is_no_solution(monkeypatch):
    problem, calls = failing(monkeypatch, 1)
    found = find_solutions(problem, np.zeros_like(problem.shift), np.zeros(len(NORMAL.contact)))
    assert [each.name for each in found] == ["only"]
    assert found[0].state.residual <= TOLERANCE
    assert len(calls) == 3


def test_nothing_is_found_where_nothing_converges(monkeypatch):
    problem, _ = failing(monkeypatch, 3)
    monkeypatch.setattr("wheelrail.contact.friction.solutions.newton", lambda _, p: (p, 12, False))
    found = find_solutions(problem, np.zeros_like(problem.shift), np.zeros(len(NORMAL.contact)))
    assert found == ()
    assert force_spread(problem, found) == 0.0
