"""Transient and steady rolling: conditions in random sequences, symmetries, limits."""

from __future__ import annotations

import numpy as np
import pytest
from contact_conditions import STEEL, displacement, normal_residual, particle_work, traction_residual

from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, NormalState, solve_normal
from wheelrail.contact.rolling import RollingState, resultants, rigid_shift, roll, steady_rolling
from wheelrail.contact.tangential import TangentialProblem, solve_tangential

GRID = HalfSpace(15, 15, 1e-3, 1e-3, *STEEL)
SMOOTH = GRID.x**2 / (2 * 0.39) + GRID.y**2 / (2 * 0.30)
NOTHING = np.zeros((2, GRID.elements))


def pressed(load: float = 65e3, undeformed: np.ndarray = SMOOTH, half_space: HalfSpace = GRID) -> NormalState:
    return solve_normal(NormalProblem(half_space, undeformed, 0.0, 1.0, load))


def shifted(x: float, y: float, spin: float, half_space: HalfSpace = GRID) -> np.ndarray:
    return rigid_shift(half_space, creepage_x=x, creepage_y=y, creepage_spin=spin, distance=half_space.dx)


def steady(x: float, y: float, spin: float, normal: NormalState, half_space: HalfSpace = GRID) -> RollingState:
    return steady_rolling(half_space, normal, friction=0.3, creepage_x=x, creepage_y=y, creepage_spin=spin)


def random_sequence(steps: int, seed: int) -> dict[str, float]:
    """Load, creepages, friction, roughness and a structural shift change at every step; contact is lost and comes back.

    Largest residuals, and how often what occurred.
    """
    generator = np.random.default_rng(seed)
    result = dict.fromkeys(
        (
            "normal",
            "tangential",
            "reported",
            "iterations",
            "no contact",
            "all stick",
            "all slip",
            "reversals",
            "work",
        ),
        0.0,
    )
    tractions, contact, force = NOTHING, None, 0.0
    ribs = generator.standard_normal((GRID.my, 4000)).cumsum(axis=1)
    ribs = 5e-6 * (ribs - ribs.mean()) / ribs.std()
    size = 0.0
    for step in range(steps):
        if step % 25 == 0:  # quiet and wild stretches
            size, spread = 10.0 ** generator.uniform(-6, -1), generator.choice([0.0, 0.1, 3.0])
            mean = generator.standard_normal(3)
            mu, height = 10.0 ** generator.uniform(-2, 0), 10.0 ** generator.uniform(-3, 0)
            load, kind = 10.0 ** generator.uniform(1, 5), int(generator.integers(3))
        x, y, spin = size * (mean + spread * generator.standard_normal(3))
        start = step % (ribs.shape[1] - GRID.mx)
        h = SMOOTH - height * ribs[:, start : start + GRID.mx].ravel()
        swing = load * (1.0 + 0.3 * spread * generator.standard_normal())
        if generator.random() < 0.02:
            swing = -load
        approach = h.min() + np.sign(swing) * 1e-4 * (abs(swing) / 1e5) ** (2.0 / 3.0)
        arguments = [(0.0, 1.0, swing), (1.0, 0.0, approach), (1.0, 10.0 ** generator.uniform(-10, -8), approach)][kind]
        problem = NormalProblem(GRID, h, *arguments)
        normal = solve_normal(problem, contact)
        contact = normal.contact
        shift = shifted(x, y, 200.0 * spin)
        shift += 1e-3 * size * spread * generator.standard_normal((2, 1))  # wheel and rail move
        state = roll(GRID, normal, friction=mu, shift=shift, previous=tractions)
        residual = traction_residual(GRID, normal, state, friction=mu, shift=shift, previous=tractions)
        result["reversals"] += state.force_y * force < 0.0
        tractions, force = state.tractions, state.force_y
        result["normal"] = max(result["normal"], normal_residual(problem, normal))
        result["tangential"] = max(result["tangential"], residual)
        pulling = problem.weight == 0.0 and problem.rhs < 0.0  # can't be had, and is said so
        assert not pulling or normal.residual == 1.0
        result["reported"] = max(result["reported"], 0.0 if pulling else normal.residual, state.residual)
        result["work"] += state.friction_work
        result["iterations"] = max(result["iterations"], state.iterations)
        result["no contact"] += len(contact) == 0
        result["all stick"] += len(contact) > 3 and not state.slipping.any()
        result["all slip"] += len(contact) > 3 and bool(state.slipping[contact].all())
    return result


def test_conditions_hold_in_a_random_sequence():
    result = random_sequence(500, seed=1)
    assert result["normal"] < 1e-9  # 7e-16
    assert result["tangential"] < 1e-9  # 1.5e-10
    assert result["reported"] < 1e-9  # 1e-10, where the iteration ends
    for kind in ("no contact", "all stick", "all slip", "reversals"):
        assert result[kind] > 5, kind


@pytest.mark.slow
def test_conditions_hold_in_10000_random_steps():
    result = random_sequence(10_000, seed=2)
    assert result["normal"] < 1e-9  # 2e-14
    assert result["tangential"] < 1e-9  # 1.3e-10
    assert result["reported"] < 1e-9  # 1e-10
    assert result["work"] > 0.0
    for kind in ("no contact", "all stick", "all slip", "reversals"):
        assert result[kind] > 100, kind


def test_rigid_shift_of_each_creepage():
    x, y = GRID.x, GRID.y
    np.testing.assert_allclose(shifted(1e-3, 0, 0), [1e-6 + 0 * x, 0 * x], rtol=1e-14)
    np.testing.assert_allclose(shifted(0, 2e-3, 0), [0 * x, 2e-6 + 0 * x], rtol=1e-14)
    np.testing.assert_allclose(shifted(0, 0, 0.5), [-0.5e-3 * y, 0.5e-3 * x], rtol=1e-14)


def test_resultants():
    tractions = np.zeros((2, GRID.elements))
    element = 3 * GRID.mx + 11  # x = 4 mm, y = -4 mm
    tractions[:, element] = 2e6, 5e6
    assert resultants(GRID, tractions) == pytest.approx((2.0, 5.0, 4e-3 * 5.0 + 4e-3 * 2.0), rel=1e-12)


def test_mirror_image():
    """y to -y: lateral creepage, spin, lateral force and spin moment change their signs."""
    generator = np.random.default_rng(3)

    def mirror(field: np.ndarray) -> np.ndarray:
        return field.reshape(-1, GRID.my, GRID.mx)[:, ::-1].reshape(field.shape)

    here, there = NOTHING, NOTHING
    for _ in range(40):
        h = SMOOTH - 3e-6 * generator.standard_normal(GRID.elements)
        load = generator.uniform(1e4, 8e4)
        x, y, spin = generator.standard_normal(3) * [1e-3, 1e-3, 0.2]
        one = roll(GRID, pressed(load, h), friction=0.3, shift=shifted(x, y, spin), previous=here)
        two = roll(GRID, pressed(load, mirror(h)), friction=0.3, shift=shifted(x, -y, -spin), previous=there)
        here, there = one.tractions, two.tractions
        bound = 0.3 * 2e9
        np.testing.assert_allclose(there[0], mirror(here[0]), rtol=0, atol=1e-9 * bound)
        np.testing.assert_allclose(there[1], -mirror(here[1]), rtol=0, atol=1e-9 * bound)
        limit = 0.3 * load
        assert two.force_x == pytest.approx(one.force_x, abs=1e-9 * limit)
        assert two.force_y == pytest.approx(-one.force_y, abs=1e-9 * limit)
        assert two.moment_spin == pytest.approx(-one.moment_spin, abs=1e-11 * limit)


def test_opposite_creepages_give_opposite_tractions():
    normal = pressed()
    one, two = steady(1e-3, -0.5e-3, 0.3, normal), steady(-1e-3, 0.5e-3, -0.3, normal)
    np.testing.assert_allclose(two.tractions, -one.tractions, rtol=0, atol=1e-9 * 0.3e9)


def test_scaling_of_lengths_and_moduli():
    """Lengths: forces with their square at the same creepage; moduli and load: forces with them, same displacements."""
    for factor, modulus in ((2.5, 1.0), (1.0, 0.2)):
        half_space = HalfSpace(15, 15, factor * 1e-3, factor * 1e-3, modulus * STEEL[0], STEEL[1])
        here, there = NOTHING, NOTHING
        for step in range(30):
            x, y, spin = 1e-3 * np.cos(step), 0.7e-3 * np.sin(3 * step), 0.3 * np.sin(step)
            load = 65e3 * (1 + 0.3 * np.sin(0.7 * step))
            one = roll(GRID, pressed(load), friction=0.3, shift=shifted(x, y, spin), previous=here)
            two = roll(
                half_space,
                pressed(modulus * factor**2 * load, factor * SMOOTH, half_space),
                friction=0.3,
                shift=shifted(x, y, spin / factor, half_space),
                previous=there,
            )
            here, there = one.tractions, two.tractions
            np.testing.assert_allclose(there, modulus * here, rtol=0, atol=1e-9 * modulus * 0.3e9)
            np.testing.assert_array_equal(two.slipping, one.slipping)
            scale = modulus * factor**2
            assert two.force_y == pytest.approx(scale * one.force_y, abs=1e-9 * scale * 2e4)
            assert two.moment_spin == pytest.approx(factor * scale * one.moment_spin, abs=1e-11 * factor * scale * 2e4)
            assert two.friction_work == pytest.approx(factor * scale * one.friction_work, rel=1e-6, abs=1e-9 * scale)


def test_start_of_the_solver_does_not_matter():
    """The previous tractions are data and first guess in one; the solution must be that of a cold start."""
    normal = pressed()
    tractions = NOTHING
    for creepage in (1e-3, -2e-3, 5e-3, -1e-4):
        shift = shifted(0.3 * creepage, creepage, 100 * creepage)
        state = roll(GRID, normal, friction=0.3, shift=shift, previous=tractions)
        gap = shift - displacement(GRID, tractions, moved=True)
        contact = normal.contact
        cold = solve_tangential(TangentialProblem(GRID, contact, 0.3 * normal.pressure[contact], gap[:, contact]))
        np.testing.assert_allclose(state.tractions[:, contact], cold.tractions, rtol=0, atol=1e-9 * 0.3e9)
        tractions = state.tractions


@pytest.mark.parametrize(
    "creepages",
    [(1e-5, 0, 0), (1e-3, 0, 0), (0, 1e-3, 0), (-0.5e-3, 1e-3, 0.3), (0, 0, 0.5), (0, 0, 3.0), (5e-3, 2e-3, -1.0)],
)
def test_steady_rolling_is_the_limit_of_transient_steps(creepages):
    normal = pressed()
    at_once = steady(*creepages, normal)
    assert at_once.residual < 1e-10
    tractions = NOTHING
    for _ in range(150):
        state = roll(GRID, normal, friction=0.3, shift=shifted(*creepages), previous=tractions)
        tractions = state.tractions
    limit = 0.3 * 65e3
    size = max(np.abs(tractions).max(), 1.0)
    np.testing.assert_allclose(at_once.tractions, tractions, rtol=0, atol=1e-8 * size)
    np.testing.assert_array_equal(at_once.slipping, state.slipping)
    assert at_once.force_y == pytest.approx(state.force_y, abs=1e-9 * limit)
    # and one more step leaves it where it is
    again = roll(GRID, normal, friction=0.3, shift=shifted(*creepages), previous=at_once.tractions)
    np.testing.assert_allclose(again.tractions, at_once.tractions, rtol=0, atol=1e-9 * 0.3e9)
    assert again.friction_work == pytest.approx(at_once.friction_work, rel=1e-6, abs=1e-9)


def test_steady_rolling_is_found_for_random_creepages_on_rough_surfaces():
    generator = np.random.default_rng(10)
    for _ in range(80):
        normal = pressed(10.0 ** generator.uniform(2, 5), SMOOTH - 3e-6 * generator.standard_normal(GRID.elements))
        x, y, spin = 10.0 ** generator.uniform(-6, -1) * generator.standard_normal(3) * [1, 1, 200]
        mu = 10.0 ** generator.uniform(-2, 0)
        state = steady_rolling(GRID, normal, friction=mu, creepage_x=x, creepage_y=y, creepage_spin=spin)
        conditions = {"friction": mu, "shift": shifted(x, y, spin), "previous": state.tractions}
        assert traction_residual(GRID, normal, state, **conditions) < 1e-9  # 1.2e-10


def test_full_sliding():
    normal = pressed()
    for angle in (0.0, 0.4, 2.0, -1.2):
        cosine, sine = np.cos(angle), np.sin(angle)
        state = steady(0.1 * cosine, 0.1 * sine, 0.0, normal)
        assert state.slip_fraction == 1.0
        # opposite to the creepage, up to what the displacements turn: 0.2 % of 10 % creepage
        assert np.hypot(state.force_x, state.force_y) == pytest.approx(0.3 * 65e3, rel=1e-4)
        assert state.force_x == pytest.approx(-0.3 * 65e3 * cosine, abs=2e-3 * 0.3 * 65e3)
        assert state.force_y == pytest.approx(-0.3 * 65e3 * sine, abs=2e-3 * 0.3 * 65e3)
        # all the power: force times creepage
        assert state.friction_work == pytest.approx(0.3 * 65e3 * 0.1 * GRID.dx, rel=1e-3)


@pytest.mark.parametrize("creepages", [(0.0, 1e-3, 0.0), (2e-3, 0.0, 0.0), (1e-3, -1.5e-3, 0.0), (0.1, -0.2, 0.0)])
def test_work_of_friction_is_that_of_the_creepages_in_steady_rolling(creepages):
    """The elastic energy does not change: what the creepages put in is dissipated, on any grid."""
    for dx, size in ((1e-3, 15), (0.5e-3, 27)):
        half_space = HalfSpace(size, size, dx, dx, *STEEL)
        normal = pressed(65e3, half_space.x**2 / (2 * 0.39) + half_space.y**2 / (2 * 0.30), half_space)
        state = steady(*creepages, normal, half_space)
        put_in = -(state.force_x * creepages[0] + state.force_y * creepages[1]) * dx
        assert put_in > 0.0
        assert state.friction_work == pytest.approx(put_in, rel=1e-9)  # 1e-15


def test_work_of_friction_under_spin():
    """The mean of a particle's tractions acts half an element upstream of the traction after the step."""
    normal = pressed()
    state = steady(1e-3, -0.5e-3, 0.4, normal)
    moment = state.moment_spin - 0.5 * GRID.dx * state.force_y
    put_in = -(state.force_x * 1e-3 - state.force_y * 0.5e-3 + moment * 0.4) * GRID.dx
    assert state.friction_work == pytest.approx(put_in, rel=1e-9)


def test_work_of_friction_over_a_cycle():
    """From rest through transients, loading and release: the sum is what is put in, for nothing stays stored."""
    generator = np.random.default_rng(8)
    tractions, total = NOTHING, 0.0
    for step in range(60):
        load = 65e3 * (1.0 + 0.4 * np.sin(0.5 * step))
        x, y, spin = generator.standard_normal(3) * [2e-3, 2e-3, 0.5]
        shift = shifted(x, y, spin)
        state = roll(GRID, pressed(load), friction=0.3, shift=shift, previous=tractions)
        work = particle_work(GRID, state.tractions, shift=shift, previous=tractions)
        assert state.friction_work == pytest.approx(work, rel=1e-9, abs=1e-12)
        total += state.friction_work
        tractions = state.tractions
    assert total > 0.0


def test_no_creepage_keeps_nothing():
    """Tractions at the trailing edge leave the contact, none enter."""
    normal = pressed()
    tractions = steady(0.0, 1e-3, 0.0, normal).tractions
    for _ in range(60):
        state = roll(GRID, normal, friction=0.3, shift=NOTHING, previous=tractions)
        tractions = state.tractions
    assert abs(state.force_y) < 1.0  # from 8 kN
    assert not steady(0.0, 0.0, 0.0, normal).tractions.any()


def test_no_contact():
    nothing = pressed(0.0)
    before = steady(0.0, 1e-3, 0.0, pressed()).tractions
    for state in (
        roll(GRID, nothing, friction=0.3, shift=shifted(1e-3, 0, 0), previous=before),
        steady(1e-3, 0.0, 0.0, nothing),
    ):
        assert (state.force_x, state.force_y, state.moment_spin) == (0.0, 0.0, 0.0)
        assert (state.slip_fraction, state.residual) == (0.0, 0.0)
        assert not state.tractions.any()
    # it comes back without the old tractions
    fresh = roll(GRID, pressed(), friction=0.3, shift=shifted(1e-3, 0, 0), previous=state.tractions)
    first = roll(GRID, pressed(), friction=0.3, shift=shifted(1e-3, 0, 0), previous=NOTHING)
    np.testing.assert_array_equal(fresh.tractions, first.tractions)


def test_two_patches_roll_like_two_contacts():
    half_space = HalfSpace(15, 61, 1e-3, 1e-3, *STEEL)
    apart = 20e-3
    one, two = (half_space.x**2 / 0.2 + (half_space.y - c) ** 2 / 0.2 for c in (-apart, apart))
    normal = pressed(30e3, np.minimum(one, two), half_space)
    single = pressed(15e3, one, half_space)
    assert len(normal.contact) == 2 * len(single.contact)
    both, alone = steady(1e-3, 2e-3, 0.0, normal, half_space), steady(1e-3, 2e-3, 0.0, single, half_space)
    left = half_space.y < 0.0
    forces = [half_space.element_area * both.tractions[:, side].sum(axis=1) for side in (left, ~left)]
    np.testing.assert_allclose(forces[0][0], forces[1][0], rtol=5e-3)
    # the other patch's displacements change along this one only little
    np.testing.assert_allclose(forces[0], [alone.force_x, alone.force_y], rtol=1e-2)
    # under spin about the middle, each goes its own way along the rail: -y spin
    turning = steady(0.0, 0.0, 0.1, normal, half_space)
    forces = [half_space.element_area * turning.tractions[:, side].sum(axis=1) for side in (left, ~left)]
    assert forces[0][0] < 0.0 < forces[1][0]
    assert turning.moment_spin < -2 * 0.9 * apart * forces[1][0]
