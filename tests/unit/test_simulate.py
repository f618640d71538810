"""The stand-alone run against the same steps driven as a co-simulation, and its books."""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np
import pytest

from wheelrail.errors import ExcitationRangeError, ParameterError
from wheelrail.excitation.sources import Line
from wheelrail.interaction import simulate as module
from wheelrail.interaction.cosimulation import OUTPUT_NAMES, CoSimulation
from wheelrail.interaction.simulate import Simulation, Statistics, simulate, stand_alone_inputs, step_count


@pytest.mark.parametrize("coupling", ["load", "displacement"])
def test_every_output_equals_the_co_simulation_bit_for_bit(small_model, coupling):
    model = small_model(coupling=coupling)
    steps = 60
    simulation = simulate(model, duration=steps * model.dt, record=OUTPUT_NAMES, block=7)
    result = simulation.collect()
    driven = CoSimulation(model)
    driven.set_inputs(wheel_z=stand_alone_inputs(model).wheel_z)
    driven.initialise()
    for number in range(steps + 1):
        if number:
            assert driven.advance(model.dt) == 1
        # The distance follows from the clock there, and from the grid here.
        assert result["distance"][number] == pytest.approx(driven.output("distance"), rel=1e-14)
        for name in set(OUTPUT_NAMES) - {"distance"}:
            assert result[name][number] == driven.output(name), (name, number)
    assert simulation.state.digest() == driven.state.digest()
    assert np.ptp(result["force_z"]) > 1e3  # there was something to compare


def test_rows_time_and_distance(small_model):
    model = small_model()
    blocks = list(simulate(model, duration=20 * model.dt, record=["force_z"], block=8))
    assert [len(block["time"]) for block in blocks] == [8, 8, 5]  # the start and 20 steps
    time = np.concatenate([block["time"] for block in blocks])
    distance = np.concatenate([block["distance"] for block in blocks])
    np.testing.assert_array_equal(time, np.arange(21) * model.dt)
    np.testing.assert_array_equal(distance, np.arange(21) * model.dx)


@pytest.mark.parametrize(("duration", "steps"), [(0.0, 0), (0.999, 0), (3.0, 3), (3.0 - 1e-7, 3), (3.0 - 1e-5, 2)])
def test_step_count(duration, steps):
    # In units of dt, with 1e-6 dt of slack.
    dt = 1.7e-4
    assert step_count(duration=duration * dt, dt=dt) == steps


def test_no_duration_gives_the_start_alone(small_model):
    result = simulate(small_model(), duration=0.0, record=["force_z"]).collect()
    # In equilibrium over the roughness at the start.
    np.testing.assert_allclose(result["force_z"], [65e3], rtol=1e-12)


def test_block_size_does_not_matter_and_a_run_can_be_continued(small_model):
    model = small_model()
    whole = simulate(model, duration=50 * model.dt, record=["force_z", "rail_disp_z"], block=1000).collect()
    first = simulate(model, duration=23 * model.dt, record=["force_z", "rail_disp_z"], block=5)
    begun = first.collect()
    rest = Simulation(
        model,
        duration=50 * model.dt,
        record=["force_z", "rail_disp_z"],
        state=first.state,
        statistics=first.statistics,
        block=11,
    )
    ended = rest.collect()
    for name in whole:
        np.testing.assert_array_equal(np.concatenate([begun[name], ended[name]]), whole[name])
    assert rest.statistics.samples == 51


def test_statistics_are_those_of_the_record(small_model):
    # 100 um at 0.045 m and 30 m/s throw the wheel off the rail.
    rough = '[[excitation]]\ntype = "sinusoid"\namplitude = 100e-6\nwavelength = 0.045'
    model = small_model(contact="hertz", excitation=rough)
    simulation = simulate(model, duration=400 * model.dt, record=["force_z", "solver_residual", "in_contact"], block=64)
    result = simulation.collect()
    force, statistics = result["force_z"], simulation.statistics
    assert statistics.samples == 401
    assert statistics.force_min == force.min() == 0.0
    assert statistics.force_max == force.max()
    assert statistics.force_mean == pytest.approx(force.mean(), rel=1e-12)
    assert 0 < statistics.out_of_contact == np.count_nonzero(~result["in_contact"]) < 401
    assert statistics.residual_max == result["solver_residual"].max()
    assert statistics.unreliable == 0


def test_a_residual_above_the_limit_is_counted_and_said(small_model, monkeypatch, caplog):
    monkeypatch.setattr(module, "RESIDUAL_LIMIT", 1e-20)
    with caplog.at_level(logging.WARNING):
        simulation = simulate(small_model(), duration=10 * small_model().dt, record=["solver_residual"])
        residual = simulation.collect()["solver_residual"]
    assert simulation.statistics.unreliable == np.count_nonzero(residual > 1e-20) > 0
    assert "not reliable" in caplog.text


def test_a_residual_that_is_no_number_counts_as_unreliable():
    statistics = Statistics()
    statistics.add(np.array([1.0, 2.0]), np.array([0.0, np.nan]))
    assert statistics.unreliable == 1


def test_the_height_of_coupling_by_displacement_carries_the_preload(small_model):
    for wheel in ("1dof", "2dof"):
        model = small_model(wheel=wheel, coupling="displacement", excitation="")
        force = simulate(model, duration=0.0, record=["force_z"]).collect()["force_z"]
        assert force[0] == pytest.approx(65e3, rel=1e-10)  # achieved: 1e-14


def test_what_was_computed_before_trouble_is_not_lost(small_model):
    model = small_model(excitation="")
    # Covers the start and some 0.2 m, then ends.
    line = Line(np.zeros(60), -10, model.dx, False, "short line")
    model = replace(model, sources=(line,))
    simulation = simulate(model, duration=100 * model.dt, record=["force_z"], block=16)
    blocks = []
    with pytest.raises(ExcitationRangeError):
        blocks.extend(simulation)
    done = np.concatenate([block["step"] for block in blocks])
    # The last window that fits ends at index 49.
    last = 49 - model.contact.nodes // 2
    np.testing.assert_array_equal(done, np.arange(last + 1))
    assert simulation.state.step == last


@pytest.mark.parametrize("wrong", [{"record": ["force"]}, {"duration": -1.0}, {"duration": float("nan")}, {"block": 0}])
def test_bad_arguments_are_refused(small_model, wrong):
    with pytest.raises(ParameterError):
        simulate(small_model(), **{"duration": 0.1, "record": ["force_z"], **wrong})
