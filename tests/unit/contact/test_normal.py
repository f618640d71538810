"""Normal contact: conditions, symmetries, scaling, several patches."""

from __future__ import annotations

import numpy as np
import pytest
from contact_conditions import STEEL, normal_residual

from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, solve_normal

GRID = HalfSpace(17, 17, 1e-3, 1e-3, *STEEL)


def cylinders(half_space: HalfSpace, *, x: float = 0.0, y: float = 0.0) -> np.ndarray:
    return (half_space.x - x) ** 2 / (2 * 0.39) + (half_space.y - y) ** 2 / (2 * 0.30)


def rough(generator: np.random.Generator, half_space: HalfSpace, height: float) -> np.ndarray:
    """Random surface of a random correlation length."""
    noise = generator.standard_normal((half_space.my, half_space.mx))
    ky, kx = np.fft.fftfreq(half_space.my)[:, None], np.fft.fftfreq(half_space.mx)
    length = generator.uniform(0.0, 3.0)
    smooth = np.fft.ifft2(np.fft.fft2(noise) * np.exp(-0.5 * (2 * np.pi * length) ** 2 * (kx**2 + ky**2))).real
    return height * (smooth / smooth.std()).ravel()


def random_sequence(steps: int, seed: int) -> tuple[float, dict[str, int]]:
    """Worst residual over a sequence with warm starts, and how often what occurred."""
    generator = np.random.default_rng(seed)
    seen = {"no contact": 0, "return": 0, "one element": 0}
    worst, contact = 0.0, None
    for _ in range(steps):
        h = cylinders(GRID, x=generator.uniform(-1e-3, 1e-3), y=generator.uniform(-2e-3, 2e-3))
        h = h - rough(generator, GRID, 10.0 ** generator.uniform(-8, -4.7))
        kind = generator.integers(4)
        force = 10.0 ** generator.uniform(0, 5)
        approach = h.min() + 10.0 ** generator.uniform(-9, -4)
        if kind == 0:  # given force
            arguments = (0.0, 1.0, force)
        elif kind == 1:  # given approach
            arguments = (1.0, 0.0, approach)
        elif kind == 2:  # coupled, with the compliance of a stiff or soft structure
            arguments = (1.0, 10.0 ** generator.uniform(-11, -7), approach)
        else:  # loss of contact, in one of the three ways
            arguments = [(0.0, 1.0, -force), (1.0, 0.0, h.min() - 1e-6), (1.0, 1e-9, h.min() - 1e-5)][
                generator.integers(3)
            ]
        problem = NormalProblem(GRID, h, *arguments)
        state = solve_normal(problem, contact)
        pulling = problem.weight == 0.0 and problem.rhs < 0.0  # can't be had, and is said so
        assert not pulling or state.residual == 1.0
        worst = max(worst, normal_residual(problem, state), 0.0 if pulling else state.residual)
        seen["return"] += len(state.contact) > 0 and contact is not None and len(contact) == 0
        seen["no contact"] += len(state.contact) == 0
        seen["one element"] += len(state.contact) == 1
        contact = state.contact
    return worst, seen


def test_conditions_hold_in_a_random_sequence():
    worst, seen = random_sequence(500, seed=1)
    assert worst < 1e-9  # 7e-12
    assert seen["no contact"] > 50
    assert seen["return"] > 50
    assert seen["one element"] > 5


@pytest.mark.slow
def test_conditions_hold_in_10000_random_steps():
    worst, seen = random_sequence(10_000, seed=2)
    assert worst < 1e-9  # 3.4e-12
    assert seen["no contact"] > 1000


def test_start_does_not_matter():
    generator = np.random.default_rng(3)
    for _ in range(60):
        h = cylinders(GRID) - rough(generator, GRID, 10.0 ** generator.uniform(-7, -4.5))
        problem = NormalProblem(GRID, h, 0.0, 1.0, 10.0 ** generator.uniform(2, 5))
        cold = solve_normal(problem)
        for size in (1, 30, 289):
            guess = np.sort(generator.choice(289, size, replace=False))
            warm = solve_normal(problem, guess)
            np.testing.assert_array_equal(warm.contact, cold.contact)
            np.testing.assert_allclose(warm.pressure, cold.pressure, rtol=0, atol=1e-11 * cold.pressure.max())
            assert warm.approach == pytest.approx(cold.approach, rel=1e-12)


def test_oblong_elements_roughness_and_any_start():
    """White roughness, flat or curved bodies; guesses of random elements."""
    generator = np.random.default_rng(9)
    grids = [HalfSpace(15, 15, 1e-3, dy, *STEEL) for dy in (0.2e-3, 1e-3, 4e-3)]
    for case in range(300):
        half_space = grids[case % 3]
        h = cylinders(half_space) * generator.choice([0.0, 1e-3, 1.0])
        h = h + 10.0 ** generator.uniform(-7, -4) * generator.standard_normal(225)
        given_force = (0.0, 1.0, 10.0 ** generator.uniform(0, 6))
        given_approach = (1.0, 0.0, h.min() + 10.0 ** generator.uniform(-9, -3.5))
        problem = NormalProblem(half_space, h, *(given_force if case % 2 else given_approach))
        guess = np.sort(generator.choice(225, generator.integers(1, 226), replace=False))
        assert normal_residual(problem, solve_normal(problem, guess)) < 1e-9  # 1e-11


def test_force_approach_and_coupled_equation_agree():
    generator = np.random.default_rng(4)
    for _ in range(30):
        h = cylinders(GRID) - rough(generator, GRID, 5e-6)
        by_approach = solve_normal(NormalProblem(GRID, h, 1.0, 0.0, h.min() + generator.uniform(1e-6, 8e-5)))
        by_force = solve_normal(NormalProblem(GRID, h, 0.0, 1.0, by_approach.force))
        compliance = 10.0 ** generator.uniform(-11, -7)
        coupled = solve_normal(
            NormalProblem(GRID, h, 1.0, compliance, by_approach.approach + compliance * by_approach.force)
        )
        for other in (by_force, coupled):
            assert other.approach == pytest.approx(by_approach.approach, rel=1e-11)
            assert other.force == pytest.approx(by_approach.force, rel=1e-10)
            np.testing.assert_array_equal(other.contact, by_approach.contact)


def test_stiffness_is_the_derivative():
    h = cylinders(GRID)
    for approach in (1e-5, 4.2e-5, 8e-5):
        here, there = (solve_normal(NormalProblem(GRID, h, 1.0, 0.0, approach + change)) for change in (-1e-10, 1e-10))
        assert len(here.contact) == len(there.contact)
        assert (there.force - here.force) / 2e-10 == pytest.approx(here.stiffness, rel=1e-5)


@pytest.mark.parametrize("force", [0.0, -1e3])
def test_no_load_no_contact(force):
    state = solve_normal(NormalProblem(GRID, cylinders(GRID), 0.0, 1.0, force), np.arange(100, 120))
    assert state.force == 0.0
    assert len(state.contact) == 0
    assert not state.pressure.any()


def test_bodies_that_just_do_not_touch():
    h = cylinders(GRID) + 3e-6
    for weight, compliance in ((1.0, 0.0), (1.0, 1e-9), (2.0, 1e-9)):
        state = solve_normal(NormalProblem(GRID, h, weight, compliance, weight * 3e-6))
        assert state.force == 0.0
        assert state.approach == pytest.approx(3e-6, rel=1e-15)
        assert solve_normal(NormalProblem(GRID, h, weight, compliance, weight * 3.001e-6)).force > 0.0


def test_mirror_symmetry():
    generator = np.random.default_rng(5)
    for _ in range(20):
        h = cylinders(GRID, y=1.3e-3) - rough(generator, GRID, 5e-6)
        state = solve_normal(NormalProblem(GRID, h, 0.0, 1.0, 65e3))
        for flip in (np.flipud, np.fliplr, np.transpose):
            there = solve_normal(NormalProblem(GRID, flip(h.reshape(17, 17)).ravel(), 0.0, 1.0, 65e3))
            np.testing.assert_allclose(
                there.pressure, flip(state.pressure.reshape(17, 17)).ravel(), rtol=0, atol=1e-11 * 1.2e9
            )
            assert there.approach == pytest.approx(state.approach, rel=1e-12)


def test_scaling_of_lengths_and_moduli():
    generator = np.random.default_rng(6)
    h = cylinders(GRID) - rough(generator, GRID, 5e-6)
    state = solve_normal(NormalProblem(GRID, h, 0.0, 1.0, 65e3))
    larger = HalfSpace(17, 17, 3e-3, 3e-3, *STEEL)
    there = solve_normal(NormalProblem(larger, 3.0 * h, 0.0, 1.0, 9.0 * 65e3))
    np.testing.assert_allclose(there.pressure, state.pressure, rtol=0, atol=1e-11 * state.pressure.max())
    assert there.approach == pytest.approx(3.0 * state.approach, rel=1e-12)
    softer = HalfSpace(17, 17, 1e-3, 1e-3, 0.1 * STEEL[0], STEEL[1])
    there = solve_normal(NormalProblem(softer, h, 0.0, 1.0, 0.1 * 65e3))
    np.testing.assert_allclose(there.pressure, 0.1 * state.pressure, rtol=0, atol=1e-12 * state.pressure.max())
    assert there.approach == pytest.approx(state.approach, rel=1e-12)
    # the level from which the approach counts
    there = solve_normal(NormalProblem(GRID, h + 1e-3, 0.0, 1.0, 65e3))
    np.testing.assert_allclose(there.pressure, state.pressure, rtol=0, atol=1e-10 * state.pressure.max())
    assert there.approach == pytest.approx(state.approach + 1e-3, rel=1e-12)


def test_two_patches():
    """Two hills far apart carry like two single ones, each sunk by what the other's force displaces there."""
    half_space = HalfSpace(61, 17, 1e-3, 1e-3, *STEEL)
    hills = [(half_space.x - c) ** 2 / 0.2 + half_space.y**2 / 0.2 for c in (-20e-3, 20e-3)]
    h = np.minimum(hills[0], hills[1] + 4e-6)
    problem = NormalProblem(half_space, h, 0.0, 1.0, 20e3)
    both = solve_normal(problem)
    assert normal_residual(problem, both) < 1e-9
    left = half_space.x[both.contact] < 0.0
    assert 0 < np.count_nonzero(~left) < np.count_nonzero(left)
    assert np.abs(half_space.x[both.contact]).min() > 15e-3
    forces = [both.pressure[both.contact[side]].sum() * half_space.element_area for side in (left, ~left)]
    for own, other, hill, level in ((0, 1, hills[0], 0.0), (1, 0, hills[1], 4e-6)):
        sunk = (1.0 - STEEL[1]) * forces[other] / (np.pi * STEEL[0] * 40e-3)
        alone = solve_normal(NormalProblem(half_space, hill + level, 1.0, 0.0, both.approach - sunk))
        assert alone.force == pytest.approx(forces[own], rel=2e-3)  # the other's force is no point force
    # lightly loaded, only the higher hill carries
    light = solve_normal(NormalProblem(half_space, h, 0.0, 1.0, 50.0))
    assert (half_space.x[light.contact] < 0.0).all()


def test_patch_over_a_jump_of_the_radius():
    """Radius 0.3 m for y > 0, 0.08 m for y < 0: coarse grids against a finer one."""
    found = {}
    for dx, size in ((1e-3, 21), (0.5e-3, 41), (0.25e-3, 81)):
        half_space = HalfSpace(size, size, dx, dx, *STEEL)
        radius = np.where(half_space.y > 0.0, 0.30, 0.08)
        h = half_space.x**2 / (2 * 0.39) + half_space.y**2 / (2 * radius)
        problem = NormalProblem(half_space, h, 0.0, 1.0, 65e3)
        if dx > 0.3e-3:
            state = solve_normal(problem)
            assert normal_residual(problem, state) < 1e-9
        else:
            state = solve_normal(problem, np.flatnonzero(h < 0.6 * 9e-5))
            assert state.residual < 1e-9
        assert not half_space.edge[state.contact].any()
        y = half_space.y[state.contact]
        centre = half_space.y @ state.pressure / state.pressure.sum()
        found[dx] = np.array([state.approach, state.pressure.max(), y.max() - y.min() + dx, y.max() + y.min(), centre])
    fine = found[0.25e-3]
    assert fine[3] > 1.5e-3  # the patch lies towards the flatter side
    assert fine[4] > 0.5e-3
    # approach 1.5e-3 and less of it, pressure 3.4e-2: at the jump it has a peak, which elements average
    assert (np.abs(found[1e-3] - fine) < [3e-3 * fine[0], 5e-2 * fine[1], 1.1e-3, 1.1e-3, 5e-5]).all()
    assert (np.abs(found[0.5e-3] - fine) < [1e-3 * fine[0], 2.5e-2 * fine[1], 0.6e-3, 0.6e-3, 3e-5]).all()
