"""Runs with slip-velocity dependent friction: from the case to the ports, and what a run has to keep."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from vector_models import vector_model

from wheelrail.case import case_from_dict, load_case
from wheelrail.contact.friction.laws import KraftLaw, PolachLaw
from wheelrail.contact.friction.memory import FrictionMemory
from wheelrail.contact.friction.settings import SlipFriction
from wheelrail.contact.influence import influence_coefficients
from wheelrail.contact.slip_dependent_model import SlipDependentRolling
from wheelrail.contact.tangential_models import TransientRolling
from wheelrail.errors import StateError
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.model import Model
from wheelrail.interaction.model_file import load_model, save_model
from wheelrail.interaction.simulate import Simulation
from wheelrail.interaction.start import start
from wheelrail.interaction.state import RESULTS, SOLUTIONS, SPREAD
from wheelrail.interaction.step import step

CASE = load_case(Path(__file__).parents[3] / "examples" / "cases" / "rolling_contact.toml").to_dict()
KRAFT = {"law": "kraft", "coefficient": 0.3, "normalise": True, "memory_distance": 3e-6, "memory_speed": 1e-3}
PORTS = ("friction_method", "friction_solutions", "friction_force_spread")


def model_of(friction: dict[str, Any] | None = None, **changes: Any) -> Model:
    """The example under 0.5 % lateral creepage and Kraft's law, with keys ``section__key`` changed."""
    data = deepcopy(CASE)
    data["friction"] = KRAFT if friction is None else friction
    data["creepage"]["y"] = 5e-3
    for name, value in changes.items():
        section, key = name.split("__")
        data[section][key] = value
    return build_model(case_from_dict(data))


def dynamic(**friction: Any) -> Model:
    """Wheel of two masses over a short track, with roughness and creepage."""
    data = deepcopy(CASE)
    data["friction"] = KRAFT | friction
    data["creepage"] = {"x": 1e-3, "y": 3e-3, "spin": 0.1}
    data["wheel"] = {"preset": "thesis-2dof", "radius": 0.39}
    data["track"] = {"preset": "thesis-discrete", "bays": 20, "elements_per_bay": 2, "memory": 0.02}
    data["excitation"] = [{"type": "sinusoid", "amplitude": 5e-6, "wavelength": 0.04}]
    return build_model(case_from_dict(data))


def vector(**changes: Any) -> Model:
    """Wheel and rail with modes in three directions under Kraft's law with memory."""
    model = vector_model(creepage=(1e-4, -4e-3, 0.1), **changes)
    assert isinstance(model.tangential, TransientRolling)
    friction = SlipFriction(KraftLaw(True), FrictionMemory(5e-6, 1e-3))
    return replace(model, tangential=SlipDependentRolling(model.tangential.half_space, friction))


def test_steady_rolling_stays_and_is_less_than_at_constant_friction():
    result = Simulation(
        model_of(), duration=30 * model_of().dt, record=("force_y", "solver_residual", *PORTS)
    ).collect()
    assert len(result["force_y"]) == 31
    np.testing.assert_allclose(result["force_y"], -16577.887, rtol=0, atol=1e-3)
    coulomb = CoSimulation(model_of({"law": "constant", "coefficient": 0.3}))
    assert coulomb.output("force_y") == pytest.approx(-19472.587, abs=1e-3)
    assert [coulomb.output(name) for name in PORTS] == [0, 0, 0.0]


@pytest.mark.parametrize(("solver", "allowed"), [("newton", {1}), ("broyden", {2, 3})])
def test_ports_tell_what_was_done(solver, allowed):
    for find in (False, True):
        model = model_of(KRAFT | {"solver": solver, "find_solutions": find})
        result = Simulation(model, duration=5 * model.dt, record=PORTS).collect()
        method, solutions, spread = (result[name][1:] for name in PORTS)  # without the start, steady rolling
        assert set(method) <= allowed
        assert method.dtype == solutions.dtype == np.int64
        np.testing.assert_array_equal(solutions, int(find))
        assert (spread == 0.0).all()
        run = CoSimulation(model)
        run.advance(5 * model.dt)
        assert run.output("friction_method") == max(method)
        assert run.output("friction_solutions") == int(find)
        assert isinstance(run.output("friction_method"), int)


def test_ports_where_there_are_several_solutions():
    """The law falls within some mm/s, without memory: from one state the spread is that between the branches."""
    steep = {"law": "exponential", "coefficient": 0.3, "ratio": 0.3, "half_speed": 3e-3, "find_solutions": True}
    model = model_of(steep, creepage__y=1e-3)
    before, contact = start(model, model.start_inputs), model.tangential
    results = []
    for branch in ("low-slip", "previous", "high-slip"):
        friction = replace(contact.friction, branch=branch)
        changed, state = replace(model, tangential=replace(contact, friction=friction)), before.copy(model)
        step(changed, state, model.start_inputs)
        results.append(state.block[[RESULTS["force_y"], SOLUTIONS, SPREAD]])
    forces, solutions, spreads = np.transpose(results)
    np.testing.assert_array_equal(solutions, 3)
    np.testing.assert_allclose(spreads, forces[2] - forces[0], rtol=1e-6)
    assert spreads[0] > 1e3  # 1212 N of 6.3 kN
    assert forces[0] < forces[1] < forces[2]


def test_both_solvers_give_the_same_run():
    forces = []
    for solver in ("newton", "broyden"):
        model = dynamic(solver=solver)
        forces.append(Simulation(model, duration=40 * model.dt, record=("force_y",)).collect()["force_y"])
    np.testing.assert_allclose(forces[0], forces[1], rtol=0, atol=1e-5)  # 1.6e-7 N of 16 kN
    assert np.ptp(forces[0]) > 300.0


def test_the_vertical_force_does_not_feel_the_law():
    model = dynamic()
    assert isinstance(model.tangential, SlipDependentRolling)
    other = SlipDependentRolling(model.tangential.half_space, SlipFriction(PolachLaw(0.1, 5.0)))
    runs = [CoSimulation(model), CoSimulation(replace(model, tangential=other))]
    for _ in range(30):
        for run in runs:
            run.advance(model.dt)
        assert runs[0].output("force_z") == runs[1].output("force_z")
    assert abs(runs[0].output("force_y") - runs[1].output("force_y")) > 500.0


def test_the_friction_coefficient_scales_the_law():
    model = model_of()
    forces = {}
    for static in (0.0, 0.15, 0.3, 0.6):
        run = CoSimulation(model)
        run.configure(friction_coefficient=static)
        run.advance(30 * model.dt)
        forces[static] = -run.output("force_y")
        assert run.output("friction_method") == (1 if static else 0)
        other = CoSimulation(model_of(KRAFT | {"coefficient": static}))
        other.advance(30 * model.dt)
        assert other.output("force_y") == run.output("force_y")
    assert forces[0.0] == 0.0
    assert forces[0.3] == pytest.approx(2.0 * forces[0.15], rel=0.03)  # 1.7 %, both slide all over
    assert forces[0.3] < forces[0.6] < 2.0 * forces[0.3]


def test_a_copied_state_continues_to_the_bit():
    for model in (dynamic(), vector()):
        inputs = model.start_inputs
        state = start(model, inputs)
        for _ in range(15):
            step(model, state, inputs)
        copy = state.copy(model)
        digests = []
        for one in (state, copy):
            for _ in range(15):
                step(model, one, inputs)
            digests.append(one.digest())
        assert digests[0] == digests[1]


def test_save_load_and_model_file_give_the_same_run_to_the_bit(tmp_path):
    model = dynamic(find_solutions=True, branch="low-slip")
    run = CoSimulation(model)
    run.advance(15 * model.dt)
    saved = run.save()
    run.advance(15 * model.dt)
    digest = run.digest()
    run.load(saved)
    run.advance(15 * model.dt)
    assert run.digest() == digest
    save_model(model, tmp_path / "model")
    again = load_model(tmp_path / "model")
    assert again.tangential == model.tangential
    assert again.fingerprint == model.fingerprint
    loaded = CoSimulation(again)
    loaded.advance(15 * model.dt)
    loaded.advance(15 * model.dt)
    assert loaded.digest() == digest
    loaded.load(saved)
    loaded.advance(15 * model.dt)
    assert loaded.digest() == digest


def test_a_state_of_another_law_is_refused():
    run = CoSimulation(model_of())
    run.advance(3 * run.model.dt)
    saved = run.save()
    for change in ({"normalise": False}, {"memory_distance": 4e-6}, {"branch": "low-slip"}, {"solver": "broyden"}):
        with pytest.raises(StateError, match="another model"):
            CoSimulation(model_of(KRAFT | change)).load(saved)


def test_communication_steps_of_any_length_give_the_same():
    model = dynamic()
    whole, pieces = CoSimulation(model), CoSimulation(model)
    whole.advance(30 * model.dt)
    lengths = np.random.default_rng(1).dirichlet(np.ones(17)) * 30 * model.dt
    for length in lengths:
        pieces.advance(float(length))
    pieces.advance(max(30 * model.dt - pieces.time, 0.0))
    assert pieces.steps == whole.steps == 30
    np.testing.assert_array_equal(pieces.state.block, whole.state.block)


def test_contact_is_lost_and_comes_back():
    model = model_of()
    run = CoSimulation(model)
    grid = model.tangential
    assert isinstance(grid, SlipDependentRolling)
    run.advance(10 * model.dt)
    coefficient = grid.coefficients(run.state.tangential).copy()
    assert coefficient.min() < 0.26
    run.set_inputs(wheel_force_z=0.0)
    run.advance(model.dt)
    assert not any(
        run.output(name) for name in ("force_y", "force_z", "slip_fraction", "friction_method", "in_contact")
    )
    # downstream by one element, a little recovered
    rate, rows = model.dt * 1e-3 / 3e-6, coefficient.reshape(19, 19)
    after = grid.coefficients(run.state.tangential).reshape(19, 19)
    np.testing.assert_allclose(after[:, :-1], (rows[:, 1:] + rate * 0.3) / (1.0 + rate), rtol=1e-13)
    np.testing.assert_allclose(after[:, -1], 0.3, rtol=1e-13)
    # back at once it finds used particles, later only fresh ones
    forces = []
    for wait in (0, 20):
        again = CoSimulation(model)
        again.load(run.save())
        again.advance(wait * model.dt)
        assert (grid.coefficients(again.state.tangential).min() > 0.3 - 1e-12) == bool(wait)
        again.set_inputs(wheel_force_z=65e3)
        again.advance(3 * model.dt)
        forces.append(-again.output("force_y"))
        again.advance(60 * model.dt)
        assert again.output("force_y") == pytest.approx(-16577.887, abs=1e-3)
        assert not again.warnings
    assert 1e3 < forces[0] < forces[1]


def test_start_without_creepage():
    model = model_of(creepage__y=0.0)
    run = CoSimulation(model)
    assert run.output("force_y") == run.output("slip_fraction") == 0.0
    assert [run.output(name) for name in PORTS] == [0, 0, 0.0]
    for _ in range(3):
        np.testing.assert_allclose(model.tangential.coefficients(run.state.tangential), 0.3, rtol=1e-15)
        run.advance(model.dt)
    assert abs(run.output("force_y")) < 1e-6
    run.set_inputs(creepage_y=5e-3)
    run.advance(80 * model.dt)
    assert run.output("force_y") == pytest.approx(-16577.887, abs=1e-3)


@pytest.mark.parametrize("kept", [True, False])
def test_contact_conditions_of_a_coupled_run(kept):
    """From what the state holds: displacements of wheel and rail, pressures and tractions of each step."""
    roughness = ({"type": "sinusoid", "amplitude": 3e-6, "wavelength": 0.015},)
    model = vector(kept=kept, positions=3, excitation=roughness)
    inputs, state = model.start_inputs, start(model, model.start_inputs)
    contact = model.tangential
    assert isinstance(contact, SlipDependentRolling)
    grid, n, dt = contact.half_space, contact.half_space.elements, model.dt

    def influence(moved: float) -> np.ndarray:
        material = {name: getattr(grid, name) for name in ("dx", "dy", "shear_modulus", "poisson_ratio")}
        _, a11, a22, a12 = influence_coefficients(
            grid.x[:, None] - grid.x + moved, grid.y[:, None] - grid.y, **material
        )
        return np.block([[a11, a12], [a12, a22]])

    def moved() -> np.ndarray:
        """Rail less wheel along and across, m."""
        block = state.block
        return np.array([block[RESULTS[f"rail_disp_{axis}"]] - block[RESULTS[f"wheel_disp_{axis}"]] for axis in "xy"])

    A, carried = influence(0.0), influence(grid.dx)
    x, y, spin = inputs.creepage_x, inputs.creepage_y, inputs.creepage_spin
    creep = np.stack([x - grid.y * spin, y + grid.x * spin]) * grid.dx
    worst, shares = 0.0, []
    for _ in range(60):
        before, apart = state.tangential.copy(), moved()
        step(model, state, inputs)
        tractions, pressure = state.tangential[: 2 * n], state.normal
        slip = (A @ tractions - carried @ before[: 2 * n]).reshape(2, n) + creep + (moved() - apart)[:, None]
        speed = np.hypot(*slip) / dt
        rows = np.pad(before[4 * n :].reshape(grid.my, grid.mx), ((0, 0), (0, 1)), constant_values=0.3)[:, 1:].ravel()
        law = 0.3 * (20 / (100 + speed**2) + 0.1 / (0.2 + speed)) / 0.7
        rate = dt * np.maximum(speed, 1e-3) / 5e-6
        bound = (rows + rate * law) / (1.0 + rate) * pressure
        p, scaled, touching = tractions.reshape(2, n), slip / A[0, 0], pressure > 0.0
        length = np.hypot(*scaled)
        against = np.hypot(*(p * length + bound * scaled)) / np.maximum(length, bound.max())
        worst = max(worst, (np.hypot(*p) - bound)[touching].max() / bound.max(), against[touching].max() / bound.max())
        shares.append(state.tangential[2 * n : 3 * n].sum() / touching.sum())
    assert worst < 1e-8  # 1.6e-14
    assert np.ptp(shares) > 0.1
