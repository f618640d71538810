"""Start and step in three directions, against sums over all past forces written down naively."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from vector_models import VERTICAL, vector_model

from wheelrail.contact.rolling import rigid_shift, roll
from wheelrail.errors import WheelrailError
from wheelrail.greens.combined import CombinedResponse
from wheelrail.greens.sampled import SampledGreens
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.model_file import load_model, save_model
from wheelrail.interaction.simulate import simulate, stand_alone_inputs
from wheelrail.interaction.start import start
from wheelrail.interaction.state import FORCE, FORCE_X, FORCE_Y, OFFSET, RESULTS, State
from wheelrail.interaction.step import step

SINE = ({"type": "sinusoid", "amplitude": 8e-6, "wavelength": 0.031},)
DISPLACEMENTS = [[RESULTS[f"{body}_disp_{axis}"] for axis in "xyz"] for body in ("wheel", "rail")]


def displacements(state: State) -> np.ndarray:
    """Wheel and rail, shape (2, 3)."""
    return state.block[DISPLACEMENTS]


def force(state: State) -> np.ndarray:
    return state.block[[FORCE_X, FORCE_Y, FORCE]]


@pytest.mark.parametrize("kept", [True, False])
@pytest.mark.parametrize(("coupling", "balance"), [("load", True), ("load", False), ("displacement", True)])
def test_against_brute_force(coupling, balance, kept):
    """Eqs. 3.5, 3.15, 3.50 and 3.51 as they stand, with forces, loads and creepages that change."""
    model = vector_model(positions=7, kept=kept, coupling=coupling, excitation=SINE, balance=balance)
    model = model.configured(start_position=0.003)
    assert model.track is not None
    assert model.active_wheel is not None
    inputs = stand_alone_inputs(model)
    if not balance:
        inputs = replace(inputs, wheel_force_y=12e3)  # not the contact's force
    state = start(model, inputs)
    track, wheel = model.track.values, model.active_wheel.values(400)
    compliance = model.active_wheel.static_compliance()
    begin, count = force(state), 260
    first_wheel, before = displacements(state)[0].copy(), displacements(state).copy()
    grid = model.contact.half_space
    tractions = state.tangential[: 2 * grid.elements].reshape(2, -1).copy()
    forces, drives = [begin], []
    guide = begin - np.array([inputs.wheel_force_x, inputs.wheel_force_y, 0.0]) if balance else np.zeros(3)
    offset = state.block[OFFSET]
    scale = np.abs(displacements(state)).max()
    if coupling == "displacement":
        np.testing.assert_allclose(first_wheel, -compliance @ begin, rtol=0, atol=1e-12 * scale)
    else:
        drive = np.zeros(3) if balance else np.array([-begin[0], 12e3 - begin[1], 0.0])
        np.testing.assert_allclose(first_wheel, compliance @ drive, rtol=0, atol=1e-12 * scale)
    drives.append(np.zeros(3))
    worst = 0.0
    for number in range(1, count):
        swing = np.sin(0.07 * number)
        now = replace(
            inputs,
            wheel_force_z=65e3 + 6e3 * swing,
            wheel_force_y=inputs.wheel_force_y + 2e3 * swing,
            wheel_force_x=500.0 * swing,
            wheel_z=inputs.wheel_z + 4e-6 * swing,
            creepage_y=inputs.creepage_y * (1.0 - 0.9 * swing),
        )
        step(model, state, now)
        forces.append(force(state))
        pushed = np.array([now.wheel_force_x + guide[0], now.wheel_force_y + guide[1], now.wheel_force_z])
        if coupling == "displacement":
            drives.append(begin - forces[-1])
        elif balance:
            drives.append(pushed - forces[-1])
        else:  # change against what acted before the start
            drives.append(pushed - forces[-1] - np.array([-begin[0], 12e3 - begin[1], 0.0]))
        rail = np.zeros(3)
        for age in range(model.track.samples):
            at = number - age
            function = track[(model.start_index + at) % 7, :, :, age]
            rail += (forces[at] if at >= 0 else begin) @ function
        body = first_wheel + sum(wheel[age] @ drives[number - age] for age in range(number))
        # The first samples that couple the vertical with another direction count for nothing.
        np.testing.assert_allclose(displacements(state), [body, rail], rtol=0, atol=1e-11 * scale)
        moved = (rail - body) - (before[1] - before[0])
        before = np.array([body, rail])
        if number % 13 and number > 4:
            tractions = state.tangential[: 2 * grid.elements].reshape(2, -1).copy()
            continue
        base = now.wheel_z if coupling == "displacement" else offset
        window = np.zeros(model.contact.nodes)
        for line in model.lines:
            line.add_window(model.start_index + number - len(window) // 2, window)
        approach = base + body[2] - rail[2]
        law = model.contact.solve(window, weight=1.0, compliance=0.0, rhs=approach, guess=approach)
        assert law.force == pytest.approx(forces[-1][2], rel=1e-9)
        shift = rigid_shift(
            grid,
            creepage_x=now.creepage_x,
            creepage_y=now.creepage_y,
            creepage_spin=now.creepage_spin,
            distance=grid.dx,
        )
        shift += moved[:2, None]
        rolled = roll(grid, law.field, friction=0.3, shift=shift, previous=tractions)
        worst = max(worst, np.abs([rolled.force_x, rolled.force_y] - forces[-1][:2]).max())
        assert state.block[RESULTS["friction_power"]] * model.dt == pytest.approx(rolled.friction_work, abs=1e-7)
        tractions = state.tangential[: 2 * grid.elements].reshape(2, -1).copy()
    assert worst < 1e-3  # N, of some kN
    assert np.ptp([f[1] for f in forces]) > 3e3
    assert np.ptp([d[0] for d in drives]) > 50.0


@pytest.mark.parametrize("coupling", ["load", "displacement"])
@pytest.mark.parametrize("kept", [True, False])
@pytest.mark.parametrize("creepage", [(0.0, 0.0, 0.0), (3e-4, -2e-3, 0.2), (0.0, 8e-3, 0.0)])
def test_a_smooth_uniform_rail_stays_in_equilibrium(coupling, kept, creepage):
    model = vector_model(kept=kept, coupling=coupling, creepage=creepage)
    inputs = stand_alone_inputs(model)
    state = start(model, inputs)
    before, moved = force(state), displacements(state).copy()
    assert before[2] == pytest.approx(65e3, rel=1e-9)
    if any(creepage):
        assert before[1] * creepage[1] < 0.0  # the rail's surface moves to the field side: it is held back
        assert moved[1, 1] * before[1] > 0.0  # and pushed to where the force points
    else:
        assert not np.any(before[:2])
    for _ in range(150):
        step(model, state, inputs)
        # Achieved: 2e-7 N with slip everywhere, of the contact's own tolerance.
        np.testing.assert_allclose(force(state), before, rtol=0, atol=1e-4)
    np.testing.assert_allclose(displacements(state), moved, rtol=0, atol=1e-12)


def test_balance_takes_the_steady_force_as_the_guiding_force():
    """Without it the wheel starts where its suspension holds the difference; both stay there."""
    states = {}
    for balance in (True, False):
        model = vector_model(balance=balance)
        inputs = replace(model.start_inputs, wheel_force_y=4e3)
        state = start(model, inputs)
        before = displacements(state).copy()
        for _ in range(100):
            step(model, state, inputs)
        np.testing.assert_allclose(displacements(state), before, rtol=0, atol=1e-12)
        states[balance] = state
    assert np.abs(displacements(states[True])[0]).max() < 1e-15  # achieved: 1e-18
    stiffness = 340.0 * (2.0 * np.pi * 18.0) ** 2
    lateral = (4e3 - force(states[False])[1]) / stiffness
    assert displacements(states[False])[0, 1] == pytest.approx(lateral, rel=0.02)  # the wheel's modes add to it
    np.testing.assert_allclose(force(states[True]), force(states[False]), rtol=1e-9)


def test_no_equilibrium_without_a_suspension():
    free = (0.0, 0.0, 340.0, (0.0, 1.0, 0.0))
    balanced = vector_model(rigid=(VERTICAL, free))
    state = start(balanced, balanced.start_inputs)
    for _ in range(50):
        step(balanced, state, balanced.start_inputs)
    assert abs(displacements(state)[0, 1]) < 1e-12
    loose = balanced.configured(balance=False)
    with pytest.raises(WheelrailError, match="balance = true"):
        start(loose, loose.start_inputs)
    start(loose, replace(loose.start_inputs, creepage_x=0.0, creepage_y=0.0, creepage_spin=0.0))


def test_a_lateral_push_moves_the_wheel_to_that_side():
    model = vector_model(creepage=(0.0, 0.0, 0.0))
    state = start(model, model.start_inputs)
    pushed = replace(model.start_inputs, wheel_force_y=5e3)
    for _ in range(200):
        step(model, state, pushed)
    wheel, rail = displacements(state)
    assert wheel[1] > 1e-7
    assert rail[1] > 1e-7
    assert force(state)[1] > 100.0  # the wheel drags the rail along


@pytest.mark.parametrize("kept", [True, False])
def test_sticking_contact_needs_its_first_sample(kept):
    """A rail whose displacement comes one step late runs away from the contact's stiffness of 1 GN/m."""
    model = vector_model(kept=kept, creepage=(0.0, 0.0, 0.0), excitation=SINE)
    assert model.track is not None
    # As of a long rail: a push leaves it displaced for long.
    values = model.track.values.copy()
    values[0, 1, 1] = 2e-9 * np.exp(-np.arange(values.shape[-1]) / 30.0)
    values[0, 1, 1, 0] = 0.5e-9 if kept else 0.0
    model = replace(model, track=type(model.track)(values))
    late = simulate(model, duration=300 * model.dt, record=("force_y",)).collect()["force_y"][-60:]
    alternating = float(np.abs(np.diff(late)).mean())
    if kept:
        assert alternating < 100.0  # achieved: 27 N, of the roughness
    else:
        assert alternating > 3e3  # achieved: 5.8 kN


def test_bodies_without_tangential_dynamics_stand_still():
    """Rigid wheel and beam track in a combined run."""
    model = vector_model(excitation=SINE)
    assert model.track is not None
    vertical = replace(model, wheel=None, held_wheel=None, track=type(model.track)(model.track.values[:, 2:, 2:]))
    state = start(vertical, vertical.start_inputs)
    for _ in range(20):
        step(vertical, state, vertical.start_inputs)
    assert not np.any(displacements(state)[:, :2])
    assert abs(force(state)[1]) > 1e3


def test_only_the_rail_moves_under_a_rigid_wheel():
    model = replace(vector_model(), wheel=None, held_wheel=None)
    state = start(model, model.start_inputs)
    before = displacements(state).copy()
    assert before[1, 1] != 0.0
    for _ in range(20):
        step(model, state, model.start_inputs)
    np.testing.assert_allclose(displacements(state), before, rtol=0, atol=1e-12)


def wheels(model):
    """The same wheel as recursions, as samples, and as both."""
    values = model.wheel.values(300)
    body = vector_model().wheel
    return [model.wheel, SampledGreens(values), CombinedResponse((SampledGreens(values), body))]


@pytest.mark.parametrize("kind", range(3))
def test_roll_back_and_model_file_continue_to_the_bit(tmp_path, kind):
    base = vector_model(positions=5, excitation=SINE)
    wheel = wheels(base)[kind]
    model = replace(base, wheel=wheel, held_wheel=wheel)
    assert model.fingerprint != vector_model(positions=5, excitation=SINE, creepage=(0.0, 0.0, 0.0)).fingerprint
    run = CoSimulation(model)
    run.advance(40 * model.dt)
    saved = run.save()
    run.advance(110 * model.dt)  # beyond the track's functions
    digest = run.digest()
    run.load(saved)
    run.advance(50 * model.dt)
    run.advance(60 * model.dt)
    run2 = CoSimulation(model)
    run2.load(saved)
    run2.advance(110 * model.dt)
    assert run2.digest() == digest
    assert run.state.digest() == run2.state.digest()
    save_model(model, tmp_path / "model")
    loaded = load_model(tmp_path / "model")
    assert loaded.fingerprint == model.fingerprint
    again = CoSimulation(loaded)
    again.load(saved)
    again.advance(110 * model.dt)
    assert again.digest() == digest


def test_the_fingerprint_sees_wheel_and_track():
    model = vector_model()
    assert model.track is not None
    values = model.track.values.copy()
    values[0, 1, 2, 5] = np.nextafter(values[0, 1, 2, 5], 1.0)
    prints = {model.fingerprint, replace(model, track=type(model.track)(values)).fingerprint}
    assert isinstance(model.wheel, type(model.held_wheel))
    own = model.wheel.own.copy()
    own[0, 0] = np.nextafter(own[0, 0], 2.0)
    prints.add(replace(model, wheel=replace(model.wheel, own=own)).fingerprint)
    prints.add(replace(model, held_wheel=None).fingerprint)
    assert len(prints) == 4


def test_a_failed_step_leaves_the_state_untouched():
    model = vector_model()
    state = start(model, model.start_inputs)
    step(model, state, model.start_inputs)
    before = state.to_bytes()
    with pytest.raises(WheelrailError):
        step(model, state, replace(model.start_inputs, creepage_y=float("nan")))
    assert state.to_bytes() == before


def test_outputs_are_live():
    model = vector_model(excitation=SINE)
    names = [f"{body}_disp_{axis}" for body in ("wheel", "rail") for axis in "xyz"]
    result = simulate(model, duration=80 * model.dt, record=names).collect()
    for name in names:
        assert np.ptp(result[name]) > 1e-10, name
    driven = CoSimulation(model)
    driven.advance(80 * model.dt)
    for name in names:
        assert driven.output(name) == result[name][-1]
