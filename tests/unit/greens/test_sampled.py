import numpy as np
import pytest

from wheelrail.greens.modal_discretisation import discretise_modes
from wheelrail.greens.sampled import SampledGreens

MODES = {"mass": [40.0, 25.0], "stiffness": [3e8, 2e9], "damping": [4e3, 9e3]}
SHAPES = np.array([[0.0, 1.0, 0.3], [0.1, -0.2, 0.9]])
DT = 7.2e-5


def run(response, force, state=None):
    """Displacement, as the protocol describes its use."""
    state = np.zeros(response.size) if state is None else state
    found = []
    for u in force:
        found.append(response.known(state) + response.first @ u)
        response.advance(state, u)
    return np.array(found), state


@pytest.mark.parametrize("d", [1, 3])
@pytest.mark.parametrize("n", [1, 2, 7, 400])
def test_is_the_convolution_with_its_values(d, n):
    rng = np.random.default_rng(n)
    values, force = rng.normal(size=(n, d, d)), rng.normal(size=(1000, d))
    expected = np.zeros((1000, d))
    for k in range(n):
        expected[k:] += force[: 1000 - k] @ values[k].T
    found, _ = run(SampledGreens(values), force)
    np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max())  # achieved: 1.5e-15


def test_is_the_modal_recursion_where_that_has_decayed():
    modal = discretise_modes(**MODES, shapes=SHAPES, dt=DT)
    sampled = SampledGreens(modal.values(6000))
    force = np.random.default_rng(1).normal(size=(9000, 3))
    expected, _ = run(modal, force)
    found, _ = run(sampled, force)
    # The slower mode has decayed to exp(-50 s^-1 0.43 s), 4e-10.
    np.testing.assert_allclose(found, expected, atol=1e-8 * np.abs(expected).max())  # achieved: 2e-10
    np.testing.assert_allclose(sampled.static_compliance(), modal.static_compliance(), rtol=1e-8)


@pytest.mark.parametrize("d", [1, 3])
def test_steady_state_is_kept_by_its_force(d):
    rng = np.random.default_rng(5)
    response = SampledGreens(rng.normal(size=(50, d, d)))
    force = rng.normal(size=d)
    state = response.steady(force)
    expected = response.static_compliance() @ force
    found, state = run(response, np.tile(force, (120, 1)), state)
    np.testing.assert_allclose(found, np.tile(expected, (120, 1)), atol=1e-12 * np.abs(expected).max())


def test_a_copied_state_goes_on_the_same():
    rng = np.random.default_rng(6)
    response = SampledGreens(rng.normal(size=(50, 3, 3)))
    _, state = run(response, rng.normal(size=(77, 3)))
    force = rng.normal(size=(200, 3))
    first, _ = run(response, force, state.copy())
    second, _ = run(response, force, state.copy())
    np.testing.assert_array_equal(first, second)


def test_state_can_be_a_part_of_a_larger_block():
    response = SampledGreens(np.random.default_rng(7).normal(size=(20, 3, 3)))
    block = np.full(response.size + 2, 7.0)
    block[1:-1] = 0.0
    force = np.random.default_rng(8).normal(size=(50, 3))
    expected, _ = run(response, force)
    found, _ = run(response, force, block[1:-1])
    np.testing.assert_array_equal(found, expected)
    assert (block[0], block[-1]) == (7.0, 7.0)
