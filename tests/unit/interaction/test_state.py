import numpy as np
import pytest

from wheelrail.errors import StateError
from wheelrail.interaction.inputs import Inputs
from wheelrail.interaction.start import start
from wheelrail.interaction.state import State
from wheelrail.interaction.step import step

LOAD = Inputs(wheel_force_z=65e3)


@pytest.fixture
def model(small_model):
    return small_model()


@pytest.fixture
def state(model):
    state = start(model, LOAD)
    for _ in range(150):  # beyond the functions' 120 samples
        step(model, state, LOAD)
    return state


def go_on(model, state, count=200):
    for _ in range(count):
        step(model, state, LOAD)
    return state.to_bytes()


def test_a_copy_is_independent_and_goes_on_alike(model, state):
    copy = state.copy(model)
    data = state.to_bytes()
    end = go_on(model, copy)
    assert state.to_bytes() == data
    assert go_on(model, state) == end


def test_bytes_hold_everything(model, state):
    """Also the warm start: continued runs agree to the bit."""
    other = State.from_bytes(model, state.to_bytes())
    assert other.digest() == state.digest()
    assert go_on(model, other) == go_on(model, state)


def test_copy_from(model, state):
    other = start(model, LOAD)
    other.copy_from(state)
    assert go_on(model, other) == go_on(model, state)


def test_digest_sees_every_number(state):
    digests = {state.digest()}
    for i in range(len(state.block)):
        before = state.block[i]
        state.block[i] = np.nextafter(before, np.inf)
        digests.add(state.digest())
        state.block[i] = before
    assert len(digests) == len(state.block) + 1
    assert state.digest() in digests


def test_views_are_parts_of_the_block(model, state):
    assert np.shares_memory(state.wheel, state.block)
    assert np.shares_memory(state.future, state.block)
    assert len(state.wheel) == 4
    assert state.future.shape == (1, 2 * model.track.samples)


def test_foreign_bytes_are_refused(model, state, small_model):
    with pytest.raises(StateError, match="another model"):
        State.from_bytes(small_model(wheel="1dof"), state.to_bytes())
    with pytest.raises(StateError, match="damaged"):
        State.from_bytes(model, state.to_bytes()[:-3])
    with pytest.raises(StateError, match="another model"):
        State.from_bytes(model, state.to_bytes()[:-8])
