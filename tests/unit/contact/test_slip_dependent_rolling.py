"""Rolling with slip-velocity dependent friction: conditions in random sequences, transport, steady rolling, limits."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np
import pytest
from contact_conditions import STEEL, displacement, particle_work, traction_residual

from wheelrail.contact.friction.laws import ConstantLaw, ExponentialLaw, FrictionLaw, KraftLaw, PolachLaw, TableLaw
from wheelrail.contact.friction.memory import FrictionMemory
from wheelrail.contact.friction.settings import SlipFriction
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.normal import NormalProblem, NormalState, solve_normal
from wheelrail.contact.rolling import rigid_shift, roll, steady_rolling
from wheelrail.contact.slip_dependent_rolling import (
    SlipDependentState,
    entering,
    roll_slip_dependent,
    steady_rolling_slip_dependent,
)

GRID = HalfSpace(15, 15, 1e-3, 1e-3, *STEEL)
SMOOTH = GRID.x**2 / (2 * 0.39) + GRID.y**2 / (2 * 0.30)
NOTHING, STILL = np.zeros((2, GRID.elements)), np.zeros(GRID.elements)
DT = 1e-3 / (50.0 / 3.6)
MEMORY = FrictionMemory(3e-6, 1e-3)
LAWS: list[tuple[FrictionLaw, Callable]] = [
    (KraftLaw(True), lambda s: (20 / (100 + s**2) + 0.1 / (0.2 + s)) / 0.7),
    (KraftLaw(False), lambda s: 20 / (100 + s**2) + 0.1 / (0.2 + s)),
    (ExponentialLaw(0.4, 0.05), lambda s: 0.4 + 0.6 * 0.5 ** (s / 0.05)),
    (TableLaw((0.0, 0.02, 0.3), (1.0, 1.1, 0.5)), lambda s: np.interp(s, (0.0, 0.02, 0.3), (1.0, 1.1, 0.5))),
]
FORMULAS = dict(LAWS)


def pressed(load: float = 65e3, undeformed: np.ndarray = SMOOTH, half_space: HalfSpace = GRID) -> NormalState:
    return solve_normal(NormalProblem(half_space, undeformed, 0.0, 1.0, load))


def shifted(x: float, y: float, spin: float) -> np.ndarray:
    return rigid_shift(GRID, creepage_x=x, creepage_y=y, creepage_spin=spin, distance=GRID.dx)


def steady(friction: SlipFriction, x: float, y: float, spin: float, **changes) -> SlipDependentState:
    arguments = {"half_space": GRID, "normal": pressed(), "static": 0.3, "dt": DT} | changes
    return steady_rolling_slip_dependent(
        arguments.pop("half_space"),
        arguments.pop("normal"),
        friction=friction,
        creepage_x=x,
        creepage_y=y,
        creepage_spin=spin,
        **arguments,
    )


def transient(
    friction: SlipFriction,
    creepages: tuple[float, float, float],
    steps: int,
    *,
    half_space: HalfSpace = GRID,
    **changes,
) -> list[SlipDependentState]:
    """Steps under constant creepages, from rest."""
    normal = changes.pop("normal", pressed())
    arguments = {
        "previous": np.zeros((2, half_space.elements)),
        "speed": np.zeros(half_space.elements),
        "coefficient": entering(half_space, friction, 0.3),
    } | changes
    x, y, spin = creepages
    shift = rigid_shift(half_space, creepage_x=x, creepage_y=y, creepage_spin=spin, distance=half_space.dx)
    states = []
    for _ in range(steps):
        state = roll_slip_dependent(half_space, normal, friction=friction, static=0.3, dt=DT, shift=shift, **arguments)
        arguments = {"previous": state.rolling.tractions, "speed": state.speed, "coefficient": state.coefficient}
        states.append(state)
    return states


def brought(coefficient: np.ndarray, fresh: float, half_space: HalfSpace = GRID) -> np.ndarray:
    """What each element's particle had one step before, dx upstream; those that enter the grid are fresh."""
    rows = coefficient.reshape(half_space.my, half_space.mx)
    return np.hstack([rows[:, 1:], np.full((half_space.my, 1), fresh)]).ravel()


def expected_coefficient(
    friction: SlipFriction, speed: np.ndarray, before: np.ndarray, *, static: float, dt: float
) -> np.ndarray:
    """The law, or a step of mu' = -max(s, s_0) / d_c (mu - mu_law) by backward Euler."""
    law = static * np.array([FORMULAS[friction.law](float(s)) for s in speed])
    if friction.memory is None:
        return law
    rate = dt * np.maximum(speed, friction.memory.speed) / friction.memory.distance
    return (before + rate * law) / (1.0 + rate)


def test_particles_carry_their_coefficients_downstream():
    """Without contact nothing slips: they move one element a step and recover with the least speed."""
    friction = SlipFriction(KraftLaw(False), MEMORY)
    coefficient = np.random.default_rng(3).uniform(0.05, 0.21, GRID.elements)
    shift = shifted(0.0, 5e-3, 0.0)
    for _ in range(GRID.mx):
        state = roll_slip_dependent(
            GRID,
            pressed(0.0),
            friction=friction,
            static=0.3,
            dt=DT,
            shift=shift,
            previous=NOTHING,
            speed=STILL,
            coefficient=coefficient,
        )
        rate = DT * 1e-3 / 3e-6
        expected = (brought(coefficient, 0.21) + rate * 0.21) / (1.0 + rate)
        np.testing.assert_allclose(state.coefficient, expected, rtol=1e-14)
        assert not state.speed.any()
        coefficient = state.coefficient
    # by now everybody has entered after the loss of contact
    np.testing.assert_allclose(coefficient, 0.21, rtol=1e-14)


def test_entering_particles_have_the_coefficient_at_rest():
    for law, ratio in ((KraftLaw(False), 0.7), (KraftLaw(True), 1.0), (ExponentialLaw(0.4, 0.1), 1.0)):
        np.testing.assert_allclose(entering(GRID, SlipFriction(law), 0.4), np.full(225, 0.4 * ratio), rtol=1e-15)
        state = transient(SlipFriction(law, MEMORY), (0.0, 5e-3, 0.0), 60)[-1]
        rows = state.coefficient.reshape(15, 15)
        np.testing.assert_allclose(rows[:, -1], 0.3 * ratio, rtol=1e-14)  # the upstream edge
        first = int(np.flatnonzero(pressed().pressure.reshape(15, 15)[7])[-1])
        # the first element in contact has slipped for one step, those behind it longer
        assert rows[7, first - 2] < rows[7, first - 1] < rows[7, first] < rows[7, first + 1]
        np.testing.assert_allclose(rows[7, first + 1], 0.3 * ratio, rtol=1e-14)


def test_outside_the_contact_the_coefficient_recovers():
    friction = SlipFriction(KraftLaw(True), FrictionMemory(3e-6, 5e-3))
    grid = HalfSpace(41, 15, 1e-3, 1e-3, *STEEL)
    normal = pressed(65e3, grid.x**2 / 0.78 + grid.y**2 / 0.6, grid)
    state = transient(friction, (0.0, 5e-3, 0.0), 60, half_space=grid, normal=normal)[-1]
    row = state.coefficient.reshape(15, 41)[7]
    trailing = int(np.flatnonzero(normal.pressure.reshape(15, 41)[7])[0])
    behind = row[:trailing]
    rate = DT * 5e-3 / 3e-6
    # with distance behind the contact, from what it had there
    expected = 0.3 - (0.3 - row[trailing]) * (1.0 + rate) ** -np.arange(trailing, 0, -1.0)
    np.testing.assert_allclose(behind, expected, rtol=1e-12)
    assert row[trailing] < 0.25
    assert behind[0] > 0.28


def test_without_memory_nothing_is_kept_outside():
    state = transient(SlipFriction(KraftLaw(False)), (0.0, 5e-3, 0.0), 3, coefficient=np.full(225, 0.01))[-1]
    np.testing.assert_array_equal(
        state.coefficient[pressed().pressure == 0.0], 0.3 * SlipFriction(KraftLaw(False)).at_rest
    )


@pytest.mark.parametrize(("x", "y", "spin"), [(0, 1e-3, 0), (2e-3, -1e-3, 0.4), (0, 0, 2.0), (0.02, 0.01, 0)])
def test_a_constant_law_rolls_as_coulomb_friction(x, y, spin):
    normal, friction = pressed(), SlipFriction(ConstantLaw(), MEMORY)
    previous = NOTHING
    for state in transient(friction, (x, y, spin), 12):
        coulomb = roll(GRID, normal, friction=0.3, shift=shifted(x, y, spin), previous=previous)
        previous = coulomb.tractions
        bound = 0.3 * normal.pressure.max()
        np.testing.assert_allclose(state.rolling.tractions, coulomb.tractions, rtol=0, atol=1e-8 * bound)  # 6e-13
        np.testing.assert_array_equal(state.rolling.slipping, coulomb.slipping)
        assert state.rolling.force_y == pytest.approx(coulomb.force_y, abs=1e-8 * 0.3 * 65e3)
        assert state.rolling.friction_work == pytest.approx(coulomb.friction_work, rel=1e-7, abs=1e-12)
    coulomb = steady_rolling(GRID, normal, friction=0.3, creepage_x=x, creepage_y=y, creepage_spin=spin)
    state = steady(friction, x, y, spin)
    np.testing.assert_allclose(state.rolling.tractions, coulomb.tractions, rtol=0, atol=1e-8 * bound)


@pytest.mark.parametrize("creepages", [(0, 5e-3, 0), (0, 1e-3, 0), (1e-3, -1.5e-3, 0.3), (0, 0, 1.0), (0.01, 0, 0)])
def test_steady_rolling_is_the_limit_of_transient_steps(creepages):
    friction = SlipFriction(KraftLaw(True), MEMORY)
    at_once, last = steady(friction, *creepages), transient(friction, creepages, 300)[-1]
    assert at_once.rolling.residual < 1e-9
    size = np.abs(last.rolling.tractions).max()
    np.testing.assert_allclose(at_once.rolling.tractions, last.rolling.tractions, rtol=0, atol=1e-8 * size)  # 8e-11
    np.testing.assert_array_equal(at_once.rolling.slipping, last.rolling.slipping)
    contact = pressed().contact
    np.testing.assert_allclose(at_once.coefficient[contact], last.coefficient[contact], rtol=1e-8)
    np.testing.assert_allclose(at_once.speed, last.speed, rtol=0, atol=1e-8 * last.speed.max())
    if creepages == (0, 5e-3, 0):
        assert at_once.rolling.force_y == pytest.approx(-16577.887, abs=1e-3)


@pytest.mark.parametrize("memory", [None, MEMORY, FrictionMemory(1e-4, 1e-2)])
@pytest.mark.parametrize("law", [law for law, _ in LAWS], ids=lambda law: law.kind)
def test_steady_rolling_solves_its_equations(law, memory):
    """Also where the transient never comes to rest. Each row's coefficients follow from its upstream edge."""
    friction, normal = SlipFriction(law, memory), pressed()
    for creepages in ((0.0, 5e-3, 0.0), (-1e-3, 8e-4, 0.5), (3e-4, 0.0, 0.0)):
        state = steady(friction, *creepages)
        assert state.rolling.residual < 1e-9
        tractions, shift = state.rolling.tractions, shifted(*creepages)
        # Outside the contact it says nothing; a particle that enters has not slipped.
        fresh = 0.3 * FORMULAS[law](0.0)
        inside = np.where(normal.pressure > 0.0, state.coefficient, fresh)
        slip = displacement(GRID, tractions) + shift - displacement(GRID, tractions, moved=True)
        speed = np.where(normal.pressure > 0.0, np.hypot(*slip) / DT, 0.0)
        coefficient = expected_coefficient(friction, speed, brought(inside, fresh), static=0.3, dt=DT)
        touching = normal.contact
        np.testing.assert_allclose(state.coefficient[touching], coefficient[touching], rtol=1e-8)
        conditions = {"friction": coefficient, "shift": shift, "previous": tractions}
        assert traction_residual(GRID, normal, state.rolling, **conditions) < 1e-9  # 6e-11
        work = particle_work(GRID, tractions, shift=shift, previous=tractions)
        assert state.rolling.friction_work == pytest.approx(work, rel=1e-9)


def test_without_memory_the_transient_never_settles_on_this_grid():
    friction = SlipFriction(KraftLaw(True))
    forces = [state.rolling.force_y for state in transient(friction, (0.0, 5e-3, 0.0), 120)]
    assert np.ptp(forces[-20:]) > 2e3  # 3.1 kN, one step up, one down
    state = steady(friction, 0.0, 5e-3, 0.0)
    assert state.rolling.force_y == pytest.approx(-16157.45, abs=0.01)
    assert min(forces[-20:]) < state.rolling.force_y < max(forces[-20:])


def test_steady_rolling_can_be_followed_from_constant_friction(monkeypatch):
    """What is done where transient steps don't bring Newton's method near gives the same."""
    cases = [(law, memory, (1e-3, 4e-3, 0.2)) for law, _ in LAWS[:3] for memory in (None, MEMORY)]
    cases += [(law, None, (0.0, 0.0, 1.0)) for law in (KraftLaw(True), ExponentialLaw(0.4, 0.05))]  # not at one blow
    expected = [steady(SlipFriction(law, memory), *creepages) for law, memory, creepages in cases]
    monkeypatch.setattr("wheelrail.contact.slip_dependent_rolling.MAXIMUM_ATTEMPTS", 0)
    for (law, memory, creepages), other in zip(cases, expected, strict=True):
        state = steady(SlipFriction(law, memory), *creepages)
        assert state.rolling.residual < 1e-9
        np.testing.assert_allclose(state.rolling.tractions, other.rolling.tractions, rtol=0, atol=1e-8 * 0.3e9)


def test_work_of_friction_is_that_of_the_creepages_in_steady_rolling():
    for x, y in ((0.0, 5e-3), (1e-3, -2e-3), (1e-4, 0.0)):
        rolling = steady(SlipFriction(KraftLaw(True), MEMORY), x, y, 0.0).rolling
        assert rolling.friction_work == pytest.approx(-(rolling.force_x * x + rolling.force_y * y) * GRID.dx, rel=1e-9)


def test_opposite_creepages_give_opposite_tractions():
    friction = SlipFriction(KraftLaw(True), MEMORY)
    for one, other in zip(
        transient(friction, (1e-3, -3e-3, 0.3), 20), transient(friction, (-1e-3, 3e-3, -0.3), 20), strict=True
    ):
        np.testing.assert_allclose(other.rolling.tractions, -one.rolling.tractions, rtol=0, atol=1e-8 * 0.3e9)
        np.testing.assert_allclose(other.coefficient, one.coefficient, rtol=1e-8)


def test_friction_that_falls_carries_less_and_memory_delays_it():
    """With sliding all over, the force is the law's; a particle crosses the contact while it slips 60 um."""
    speed = 5e-3 * GRID.dx / DT
    forces = {}
    for distance in (1e-9, 3e-6, 3e-5, 1.0):
        friction = SlipFriction(KraftLaw(True), FrictionMemory(distance, 1e-6))
        forces[distance] = -steady(friction, 0.0, 5e-3, 0.0).rolling.force_y
    coulomb = -steady(SlipFriction(ConstantLaw()), 0.0, 5e-3, 0.0).rolling.force_y
    assert list(forces.values()) == sorted(forces.values())
    assert forces[1.0] == pytest.approx(coulomb, rel=1e-4)
    assert forces[1e-9] == pytest.approx(0.3 * 65e3 * FORMULAS[KraftLaw(True)](speed), rel=0.03)


@pytest.mark.parametrize("find", [False, True])
def test_no_contact(find):
    friction = SlipFriction(KraftLaw(True), MEMORY, find_solutions=find)
    state = transient(friction, (0.0, 5e-3, 0.0), 1, normal=pressed(0.0), previous=1e6 * np.ones((2, 225)))[0]
    rolling = state.rolling
    assert (rolling.force_x, rolling.force_y, rolling.slip_fraction, rolling.residual) == (0.0, 0.0, 0.0, 0.0)
    assert (state.method, state.solutions, state.force_spread) == ("none", int(find), 0.0)
    assert not rolling.tractions.any()
    assert not state.speed.any()


def test_steady_rolling_without_contact():
    state = steady(SlipFriction(KraftLaw(True), MEMORY), 0.0, 5e-3, 0.0, normal=pressed(0.0))
    assert (state.rolling.force_y, state.rolling.residual, state.method) == (0.0, 0.0, "none")


def test_steady_rolling_of_a_contact_that_fills_its_grid():
    grid, friction = HalfSpace(7, 9, 1e-3, 1e-3, *STEEL), SlipFriction(KraftLaw(True), MEMORY)
    normal = pressed(40e3, grid.x**2 / 0.78 + grid.y**2 / 0.6, grid)
    last = transient(friction, (0.0, 3e-3, 0.0), 200, half_space=grid, normal=normal)[-1]
    state = steady(friction, 0.0, 3e-3, 0.0, half_space=grid, normal=normal)
    assert state.rolling.force_y == pytest.approx(last.rolling.force_y, rel=1e-8)


@pytest.mark.parametrize(
    ("law", "creepage"),
    [
        (TableLaw((0.0, 0.05, 1.0), (0.33, 1.0, 1.0)), 2e-3),
        (TableLaw((0.0, 0.02, 1.0), (0.17, 1.0, 1.0)), 2e-3),
        (TableLaw((0.0, 0.02, 0.1, 1.0), (0.33, 1.0, 1.0, 0.2)), 5e-3),
    ],
)
@pytest.mark.parametrize("memory", [None, MEMORY])
def test_friction_that_rises_first(law, creepage, memory):
    """Iterating between contact and law swings there."""
    states = transient(SlipFriction(law, memory), (0.0, creepage, 0.0), 40)
    assert max(state.rolling.residual for state in states) < 1e-8  # 1e-10
    assert max(state.rolling.iterations for state in states) < 60


@pytest.mark.parametrize("solver", ["newton", "broyden"])
def test_friction_that_vanishes_on_some_elements(solver):
    """exp(-B s) is exactly 0 on those that slip fast."""
    friction = SlipFriction(PolachLaw(0.0, 1e5), None, solver)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        states = transient(friction, (0.0, 1e-3, 0.0), 20)
    assert all(np.isfinite(state.rolling.force_y) for state in states)
    assert min(state.coefficient.min() for state in states) == 0.0
