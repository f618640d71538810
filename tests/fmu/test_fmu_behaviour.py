"""The FMU against the same co-simulation run without FMU, and the promises of the interface."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fmpy.fmi1 import FMICallException
from fmu_host import Instance, UnpackedFmu

from fmu_src.variables import OUTPUTS, VARIABLES
from wheelrail.case import Case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.model_file import load_model, save_model

pytestmark = pytest.mark.fmu


@pytest.fixture(scope="module")
def standalone(small_case: Case, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The small case without FMU."""
    path = tmp_path_factory.mktemp("model") / "model.wrm"
    save_model(build_model(small_case), path)
    return load_model(path)


@pytest.fixture
def instance(small_fmu: UnpackedFmu) -> Iterator[Instance]:
    instance = small_fmu.instance()
    yield instance
    instance.close()


def outputs(instance: Instance) -> dict[str, Any]:
    return {name: instance.get(name) for name in OUTPUTS}


def test_equals_the_cosimulation_bit_for_bit(instance: Instance, standalone: Any) -> None:
    simulation = CoSimulation(standalone)
    simulation.initialise()
    time_step = instance.get("time_step")
    force = simulation.inputs["wheel_force_z"]
    for number, size in enumerate([1e-3, 0.0, 7.3 * time_step, time_step, 2e-3, 0.3 * time_step, 5e-3]):
        assert outputs(instance) == {name: simulation.output(name) for name in OUTPUTS}
        instance.set(wheel_force_z=force + 1e3 * number)
        simulation.set_inputs(wheel_force_z=force + 1e3 * number)
        instance.step(size)
        simulation.advance(size)
    assert outputs(instance) == {name: simulation.output(name) for name in OUTPUTS}
    assert instance.get("force_z") != force


def recorded(folder: Path, name: str) -> list[list[float]]:
    with (folder / f"{name}_record.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["time", "force_x", "force_y", "force_z"]
    return [[float(text) for text in row] for row in rows[1:]]


def test_history_does_not_depend_on_the_communication_step(
    small_fmu: UnpackedFmu, standalone: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    simulation = CoSimulation(standalone)
    simulation.configure(record=True)
    history: list[list[float]] = []
    simulation.recorder = lambda *row: history.append(list(row))
    simulation.initialise()
    steps = 300
    time_step = small_fmu.instance("probe").get("time_step")
    simulation.advance(steps * time_step)
    assert len(history) == steps + 1  # and the start
    for name, cuts in {
        "one": [1.0] * steps,
        "odd": [7.3] * int(steps / 7.3) + [steps - 7.3 * int(steps / 7.3)],
        "large": [100.0] * (steps // 100),
        "mixed": [0.0, 1.0, 0.0, 7.3, 0.7, 100.0, 0.0, 0.5, 0.5, steps - 110.0],
    }.items():
        instance = small_fmu.instance(name, record=True)
        for cut in cuts:
            instance.step(cut * time_step)
        instance.close()
        assert recorded(tmp_path, name) == history, name


def test_record_follows_a_roll_back(small_fmu: UnpackedFmu, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    straight, back = small_fmu.instance("same", record=True), small_fmu.instance("same", record=True)
    for _ in range(4):
        straight.step(1e-3)
    back.step(1e-3)
    back.step(1e-3)
    state, time = back.slave.getFMUState(), back.time
    back.set(wheel_force_z=1e3)
    back.step(2e-3)
    back.slave.setFMUState(state)
    back.slave.freeFMUState(state)
    back.time = time
    back.step(1e-3)
    back.step(1e-3)
    straight.close()
    back.close()
    assert recorded(tmp_path, "same") == recorded(tmp_path, "same_2")
    assert len(recorded(tmp_path, "same")) > 10


def test_record_that_cannot_be_written_is_refused(
    small_fmu: UnpackedFmu, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "blocked_record.csv").mkdir()
    with pytest.raises(FMICallException):
        small_fmu.instance("blocked", record=True)
    assert "record = true, but" in capfd.readouterr().err


@pytest.mark.parametrize("serialised", [False, True])
def test_continues_bit_for_bit_after_a_roll_back(instance: Instance, serialised: bool) -> None:
    instance.step(2.3e-3)
    state, time = instance.slave.getFMUState(), instance.time
    at_state = outputs(instance)
    if serialised:
        data = instance.slave.serializeFMUState(state)
        instance.slave.freeFMUState(state)
    instance.set(wheel_force_z=80e3)
    instance.step(3.1e-3)
    first = outputs(instance)
    instance.step(1e-3)
    if serialised:
        state = instance.slave.deSerializeFMUstate(data)
    instance.slave.setFMUState(state)
    instance.slave.freeFMUState(state)
    instance.time = time
    assert outputs(instance) == at_state
    assert instance.get("wheel_force_z") != 80e3
    instance.set(wheel_force_z=80e3)
    instance.step(3.1e-3)
    assert outputs(instance) == first


def test_serialised_state_continues_in_another_instance(small_fmu: UnpackedFmu, instance: Instance) -> None:
    instance.step(2e-3)
    state = instance.slave.getFMUState()
    data = instance.slave.serializeFMUState(state)
    instance.slave.freeFMUState(state)
    other = small_fmu.instance("other", wheel_force_z=1e3)
    state = other.slave.deSerializeFMUstate(data)
    other.slave.setFMUState(state)
    other.slave.freeFMUState(state)
    other.time = instance.time
    for each in (instance, other):
        each.step(1e-3)
    assert outputs(other) == outputs(instance)
    other.close()


def test_state_of_another_fmu_is_refused(quick_fmu: UnpackedFmu, instance: Instance) -> None:
    foreign = quick_fmu.instance()
    state = foreign.slave.getFMUState()
    data = foreign.slave.serializeFMUState(state)
    foreign.slave.freeFMUState(state)
    foreign.close()
    before = outputs(instance)
    state = instance.slave.deSerializeFMUstate(data)
    with pytest.raises(FMICallException):
        instance.slave.setFMUState(state)
    instance.slave.freeFMUState(state)
    assert outputs(instance) == before


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"wheel_force_z": math.nan}, "wheel_force_z = nan"),
        ({"creepage_x": math.inf}, "creepage_x = inf"),
        ({"force_z": 1.0}, "force_z = 1.0"),
        ({"dx": 1.0}, "dx = 1.0"),
        ({"case_title": "other"}, "case_title = 'other'"),
        ({"speed": 25.0}, "speed = 25.0"),  # even the right one: parameters are fixed by now
    ],
)
def test_refused_while_running(
    instance: Instance, values: dict[str, Any], message: str, capfd: pytest.CaptureFixture[str]
) -> None:
    instance.step(1e-3)
    before = (outputs(instance), instance.get("wheel_force_z"), instance.get("creepage_x"))
    capfd.readouterr()
    with pytest.raises(FMICallException):
        instance.set(**values)
    assert f"{message} is refused" in capfd.readouterr().err
    assert any(f"{message} is refused" in text for _, _, text in instance.log)
    assert (outputs(instance), instance.get("wheel_force_z"), instance.get("creepage_x")) == before
    instance.step(1e-3)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"speed": -1.0}, "speed = -1.0"),
        ({"speed": 0.0}, "speed = 0.0"),
        ({"speed": 12.5}, "speed = 12.5"),
        ({"speed": math.nan}, "speed = nan"),
        ({"friction_coefficient": -0.1}, "friction_coefficient = -0.1"),
        ({"start_position": 1.2345e-4}, "start_position = 0.00012345"),
        ({"roughness_scale": math.inf}, "roughness_scale = inf"),
        ({"coupling": 3}, "coupling = 3"),
        ({"input_extrapolation": 0}, "input_extrapolation = 0"),
        ({"random_seed": -2}, "random_seed = -2"),
    ],
)
def test_parameters_refused(
    small_fmu: UnpackedFmu, values: dict[str, Any], message: str, capfd: pytest.CaptureFixture[str]
) -> None:
    instance = Instance(small_fmu, "wheel", {}, initialise=False)
    (name,) = values
    before = instance.get(name)
    with pytest.raises(FMICallException):
        instance.set(**values)
    assert f"{message} is refused" in capfd.readouterr().err
    assert instance.get(name) == before
    instance.begin()
    reference = small_fmu.instance()
    for each in (instance, reference):
        each.step(1e-3)
    assert outputs(instance) == outputs(reference)
    instance.close()
    reference.close()


def test_one_bad_value_of_several_sets_none(instance: Instance) -> None:
    references = [instance.fmu.variables[name].valueReference for name in ("wheel_force_z", "wheel_z")]
    before = instance.get("wheel_force_z")
    with pytest.raises(FMICallException):
        instance.slave.setReal(references, [1.0, math.nan])
    assert instance.get("wheel_force_z") == before


@pytest.mark.parametrize("size", [-1e-3, math.nan, math.inf])
def test_bad_step_is_discarded_and_leaves_the_state(instance: Instance, size: float) -> None:
    instance.step(1e-3)
    before = outputs(instance)
    with pytest.raises(FMICallException, match="discard"):
        instance.slave.doStep(instance.time, size)
    assert any(category == "logStatusDiscard" for _, category, _ in instance.log)
    assert outputs(instance) == before
    instance.step(1e-3)


def test_time_that_jumps_is_discarded(instance: Instance) -> None:
    instance.step(1e-3)
    with pytest.raises(FMICallException, match="discard"):
        instance.slave.doStep(0.5, 1e-3)
    assert any("currentCommunicationPoint = 0.5 s is refused" in text for _, _, text in instance.log)
    instance.step(1e-3)


def test_outputs_have_values_in_initialisation_mode_and_follow_the_inputs(small_fmu: UnpackedFmu) -> None:
    instance = Instance(small_fmu, "wheel", {}, initialise=False)
    instance.slave.setupExperiment()
    instance.slave.enterInitializationMode()
    for name in OUTPUTS:
        assert math.isfinite(instance.get(name)), name
    for load in (30e3, 70e3):
        instance.set(wheel_force_z=load)
        assert instance.get("force_z") == pytest.approx(load, rel=1e-6)
    # a parameter after outputs were read
    instance.set(roughness_scale=0.0)
    assert instance.get("wheel_force_z") == 70e3
    assert instance.get("force_z") == pytest.approx(70e3, rel=1e-6)
    instance.slave.exitInitializationMode()
    direct = small_fmu.instance("direct", wheel_force_z=70e3, roughness_scale=0.0)
    for each in (instance, direct):
        each.step(3e-3)
    assert outputs(instance) == outputs(direct)
    instance.close()
    direct.close()


def test_inputs_up_to_the_first_step_belong_to_the_start(small_fmu: UnpackedFmu, instance: Instance) -> None:
    """Many hosts hand on connected values only after initialisation mode; that must not begin the run with a jolt."""
    instance.set(wheel_force_z=90e3)
    assert instance.get("force_z") == pytest.approx(90e3, rel=1e-6)
    direct = small_fmu.instance("direct", wheel_force_z=90e3)
    for each in (instance, direct):
        each.step(5e-3)
    assert outputs(instance) == outputs(direct)
    # from the first step on, even an empty one, a change acts on the running wheel
    for each in (instance, direct):
        each.step(0.0)
    before = instance.get("force_z")
    instance.set(wheel_force_z=40e3)
    assert instance.get("force_z") == before
    direct.close()


def test_reset_starts_again(instance: Instance) -> None:
    instance.set(wheel_force_z=40e3)
    instance.step(2e-3)
    instance.slave.reset()
    instance.time = 0.0
    instance.begin()
    fresh = instance.fmu.instance("fresh")
    for each in (instance, fresh):
        each.step(2e-3)
    assert outputs(instance) == outputs(fresh)
    assert instance.get("wheel_force_z") != 40e3
    fresh.close()


def test_start_values_are_those_of_the_model_description(instance: Instance) -> None:
    kinds = {"Real": float, "Integer": int, "Enumeration": int, "String": str, "Boolean": lambda text: text == "true"}
    for variable in VARIABLES:
        if variable.role not in ("output", "calculated"):
            declared = instance.fmu.variables[variable.name].start
            assert instance.get(variable.name) == kinds[variable.kind](declared), variable.name


def test_start_time_shifts_nothing(small_fmu: UnpackedFmu, instance: Instance) -> None:
    late = Instance(small_fmu, "late", {}, initialise=False)
    late.time = 100.0
    late.begin()
    for _ in range(50):
        instance.step(1e-4)
        late.step(1e-4)
    assert outputs(late) == outputs(instance)
    late.close()


def test_warnings_and_faults_reach_stderr_and_log(quick_fmu: UnpackedFmu, capfd: pytest.CaptureFixture[str]) -> None:
    """What the step says, with the signs that printf and FMI would swallow; a fault of the program has a traceback."""
    import sys

    instance = quick_fmu.instance()
    module = next(m for n, m in sys.modules.items() if n.startswith("wheelrail_rt_") and n.endswith(".cosimulation"))
    original = module.CoSimulation.advance

    def advance(simulation: Any, size: float) -> int:
        simulation.warnings.append("50 % of #3")
        return original(simulation, size) if size < 1.0 else 1 // 0

    module.CoSimulation.advance = advance
    try:
        for _ in range(300):
            instance.step(1e-6)
        with pytest.raises(FMICallException):
            instance.slave.doStep(instance.time, 2.0)
    finally:
        module.CoSimulation.advance = original
    warnings = [text for _, category, text in instance.log if category == "logStatusWarning"]
    assert len(warnings) == 100
    assert warnings[0] == "50 %% of ##3"
    assert "further ones are not shown" in warnings[-1]
    error = capfd.readouterr().err
    assert "warning: 50 % of #3" in error
    assert "Traceback" in error
    assert "ZeroDivisionError" in instance.log[-1][2]
    instance.close()
