"""Modal recursions against one exponential of the whole system, closed forms and the statics."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.greens.modal_discretisation import discretise_modes
from wheelrail.greens.ordinary import HIGHEST, discretise
from wheelrail.greens.protocol import FreeBodyError, compliance_matrix

DT = 7.2e-5
RNG = np.random.default_rng(4)
# Undamped, lightly damped, critical, overdamped, near half the sampling frequency; a suspended body.
FREQUENCY = np.array([310.0, 1500.0, 2400.0, 3900.0, 5900.0, 6200.0, 2.0])
RATIO = np.array([0.0, 1e-4, 1.0, 3.0, 1e-2, 1e-4, 0.3])
MASS = np.array([30.0, 22.0, 41.0, 18.0, 35.0, 20.0, 600.0])
OMEGA = 2.0 * np.pi * FREQUENCY
STIFFNESS, DAMPING = MASS * OMEGA**2, 2.0 * RATIO * MASS * OMEGA
SHAPES = RNG.normal(size=(7, 3))


def modes(**changes):
    given = {"mass": MASS, "stiffness": STIFFNESS, "damping": DAMPING, "shapes": SHAPES, "dt": DT}
    return discretise_modes(**{**given, **changes})


def whole(direction: int, force: int):
    """Displacement in one direction under a force in another, as one system of 14 states."""
    n = len(MASS)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(STIFFNESS / MASS), -np.diag(DAMPING / MASS)]])
    b = np.concatenate([np.zeros(n), SHAPES[:, force] / MASS])
    return discretise(A, b, np.concatenate([SHAPES[:, direction], np.zeros(n)]), dt=DT)


def test_values_are_those_of_the_whole_system():
    values = modes().values(400)
    scale = np.abs(values).max()
    for direction in range(3):
        for force in range(3):
            reference = whole(direction, force).values(400)
            # Achieved: 6e-14; 400 powers of a matrix of 14 states.
            assert np.abs(values[:, direction, force] - reference).max() < 1e-12 * scale


def test_modes_that_the_grid_cannot_carry_only_yield():
    limit = HIGHEST * 0.5 / DT
    frequency = limit * np.array([0.999, 1.001, 1.8])
    stiffness, shapes = MASS[:3] * (2.0 * np.pi * frequency) ** 2, SHAPES[:3]
    damping = 2e-4 * np.sqrt(stiffness * MASS[:3])
    given = {"mass": MASS[:3], "stiffness": stiffness, "damping": damping, "shapes": shapes}
    response = discretise_modes(**given, dt=DT)
    assert response.size == 2  # of the first one
    alone = discretise_modes(**{name: values[:1] for name, values in given.items()}, dt=DT)
    values, ringing = response.values(50), alone.values(50)
    np.testing.assert_array_equal(values[1:], ringing[1:])
    yielding = np.einsum("ni,nj,n->ij", shapes[1:], shapes[1:], 1.0 / stiffness[1:])
    np.testing.assert_allclose(values[0], ringing[0] + yielding, rtol=1e-13)
    total = np.einsum("ni,nj,n->ij", shapes, shapes, 1.0 / stiffness)
    np.testing.assert_allclose(compliance_matrix(response), total, rtol=1e-11)


def test_a_run_is_the_sum_over_all_past_forces():
    response = modes()
    values = response.values(300)
    forces = RNG.normal(size=(300, 3))
    state = np.zeros(response.size)
    for a in range(300):
        displacement = response.known(state) + response.first @ forces[a]
        if a % 37 == 0 or a > 297:
            direct = np.einsum("nij,nj->i", values[: a + 1], forces[a::-1])
            assert np.abs(displacement - direct).max() < 1e-12 * np.abs(values).max() * 17.0  # achieved: 3e-15
        response.advance(state, forces[a])


@pytest.mark.parametrize(("frequency", "ratio"), [(900.0, 0.0), (900.0, 0.02), (700.0, 1.0), (300.0, 4.0)])
def test_one_mode_against_the_integral_over_its_hat(frequency, ratio):
    """Independent: impulse response in closed form, integrated against the piecewise linear force by Gauss' rule."""
    m, w = 25.0, 2.0 * np.pi * frequency

    def impulse(t):
        if ratio < 1.0:
            wd = w * np.sqrt(1.0 - ratio**2)
            return np.exp(-ratio * w * t) * np.sin(wd * t) / (m * wd)
        if ratio == 1.0:
            return t * np.exp(-w * t) / m
        wd = w * np.sqrt(ratio**2 - 1.0)
        return np.exp(-ratio * w * t) * np.sinh(wd * t) / (m * wd)

    nodes, weights = np.polynomial.legendre.leggauss(30)
    s, ws = 0.5 * (nodes + 1.0) * DT, 0.5 * weights * DT
    response = discretise_modes(mass=[m], stiffness=[m * w**2], damping=[2.0 * ratio * m * w], shapes=[[2.0]], dt=DT)
    values = response.values(40)[:, 0, 0]
    expected = [4.0 * np.sum(ws * (1.0 - s / DT) * impulse(s))]
    for n in range(1, 40):
        rising, falling = impulse(n * DT + s - DT), impulse(n * DT + s)
        expected.append(4.0 * np.sum(ws * (s / DT * rising + (1.0 - s / DT) * falling)))
    # Achieved: 2e-14.
    np.testing.assert_allclose(values, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_free_bodies_move_as_newton_says():
    response = discretise_modes(mass=[500.0, 500.0], stiffness=[0.0, 0.0], damping=[0.0, 4e3], shapes=np.eye(2), dt=DT)
    state = np.zeros(response.size)
    for step in range(1, 2001):
        response.advance(state, np.array([80.0, 80.0]))
        time = step * DT
    free, damped = response.known(state) + response.first @ np.array([80.0, 80.0])
    # The force rises to 80 N within the step before the first.
    risen = 0.5 * 80.0 / 500.0 * (time**2 + time * DT + DT**2 / 3.0)
    assert free == pytest.approx(risen, rel=1e-12)  # achieved: 1e-15
    rate = 4e3 / 500.0
    settled = 80.0 / 4e3 * ((time + 0.5 * DT) - (1.0 - np.exp(-rate * time)) / rate)
    assert damped == pytest.approx(settled, rel=1e-3)  # the rise within the first step is not in this formula
    assert np.all(np.isinf(np.diag(response.static_compliance())))
    with pytest.raises(FreeBodyError):
        response.steady(np.array([0.0, 1.0]))
    assert not np.any(response.steady(np.zeros(2)))


def test_statics():
    response = modes()
    compliance = np.einsum("ni,n,nj->ij", SHAPES, 1.0 / STIFFNESS, SHAPES)
    # Achieved: 5e-12, of the soft suspension.
    np.testing.assert_allclose(response.static_compliance(), compliance, rtol=1e-10)
    force = np.array([3e3, -2e3, 6e4])
    state = response.steady(force)
    np.testing.assert_allclose(response.known(state) + response.first @ force, compliance @ force, rtol=1e-10)
    before = state.copy()
    for _ in range(100):
        response.advance(state, force)
    np.testing.assert_allclose(state, before, rtol=0, atol=1e-12 * np.abs(before).max())


def test_a_free_body_leaves_other_directions_finite():
    response = discretise_modes(
        mass=[500.0, 20.0], stiffness=[0.0, 1e9], damping=[0.0, 1e3], shapes=[[0, 0, 1.0], [0, 1.0, 0.5]], dt=DT
    )
    compliance = compliance_matrix(response)
    assert np.isinf(compliance[2, 2])
    assert compliance[1, 1] == pytest.approx(1e-9, rel=1e-9, abs=0.0)
    assert compliance[1, 2] == pytest.approx(0.5e-9, rel=1e-9, abs=0.0)
    assert compliance[0, 0] == 0.0
    response.steady(np.array([0.0, 5.0, -2.5]) * 0.0)
    with pytest.raises(FreeBodyError):
        response.steady(np.array([0.0, 5.0, 1.0]))


def test_modes_that_do_not_move_in_the_directions_are_left_out():
    shapes = SHAPES.copy()
    shapes[2, 2] = shapes[4, 2] = 0.0
    vertical = modes(shapes=shapes[:, 2:])
    assert vertical.size == 2 * 5
    np.testing.assert_allclose(
        vertical.values(50)[:, 0, 0], modes(shapes=shapes).values(50)[:, 2, 2], rtol=0, atol=1e-24
    )


def test_modes_at_large_and_small_steps_stay_bounded():
    for dt in (1e-7, 1e-3):
        response = modes(dt=dt)
        values = response.values(3000)
        assert np.all(np.isfinite(values))
        assert np.abs(response.own).max() < 5.0
