import hashlib
import json
import math
import struct

import numpy as np
import pytest

from wheelrail.errors import ContactGridError, ExcitationRangeError, ParameterError, StateError
from wheelrail.excitation.sources import Line
from wheelrail.interaction.cosimulation import OUTPUT_NAMES, CoSimulation
from wheelrail.interaction.inputs import Inputs
from wheelrail.interaction.model import Model

DT = 5e-3 / 30.0


def repr_short(value: object) -> str:
    return repr(value)[:12]


def forces_of(sim: CoSimulation) -> list[float]:
    """Make the run's recorder collect the force of each internal step."""
    forces: list[float] = []
    sim.recorder = lambda _time, _x, _y, force: forces.append(force)
    return forces


@pytest.fixture
def sim(small_model):
    return CoSimulation(small_model())


@pytest.fixture
def reference(small_model):
    """Forces of 300 steps done in one go."""
    sim = CoSimulation(small_model())
    forces = forces_of(sim)
    assert sim.advance(300 * DT) == 300
    return forces


@pytest.mark.parametrize("cut", [1.0, 7.3, 100.0, 0.1, 1 / 3, math.pi])
def test_communication_steps_of_any_length_give_the_same(sim, reference, cut):
    forces = forces_of(sim)
    count = round(300 / cut) if cut != 7.3 else 41
    steps = sum(sim.advance(cut * DT) for _ in range(count))
    assert steps == sim.steps == int(count * cut + 1e-6)
    assert forces == reference[: steps + 1]


def test_random_and_empty_communication_steps_give_the_same(sim, reference):
    rng, forces = np.random.default_rng(1), forces_of(sim)
    ends = np.sort(rng.uniform(0.0, 300 * DT, 200))
    lengths = [*np.diff([0.0, *ends, 300 * DT]), 0.0, 0.0]
    rng.shuffle(lengths)
    if lengths[0] == 0.0:
        lengths = lengths[::-1]
    assert sum(sim.advance(float(length)) for length in lengths) == 300
    assert forces == reference


def test_an_empty_communication_step_first_loses_nothing(sim, reference):
    """The record begins at the start, however the run is cut."""
    forces = forces_of(sim)
    assert sim.advance(0.0) == 0
    assert sim.advance(0.4 * DT) == 0
    sim.advance(299.6 * DT)
    assert forces == reference


def test_the_clock_does_not_drift(small_model):
    """A million steps of dt / 3, then exactly one internal step per dt."""
    sim = CoSimulation(small_model(track="rigid", wheel="rigid", contact="hertz", excitation=""))
    third = DT / 3
    for _ in range(30_000):
        sim.advance(third)
    assert sim.steps == 10_000
    assert sim.time == pytest.approx(30_000 * third, abs=0, rel=1e-15)
    for _ in range(10):
        assert sim.advance(DT) == 1


def test_outputs_over_a_communication_step(sim, reference):
    sim.advance(20 * DT)
    sim.advance(7.5 * DT)
    last = reference[21:28]
    assert sim.output("force_z") == last[-1]
    assert sim.output("force_z_mean") == pytest.approx(np.mean(last), abs=0, rel=1e-15)
    assert sim.output("force_z_max") == max(last)
    assert sim.output("force_z_min") == min(last)
    assert sim.output("distance") == pytest.approx(27.5 * 5e-3, abs=0, rel=1e-14)
    assert sim.output("in_contact") is True
    assert 1 <= sim.output("solver_iterations") <= 20
    assert 0.0 <= sim.output("solver_residual") <= 1e-12
    # No internal step within the communication step: the values stay.
    sim.advance(0.1 * DT)
    assert sim.output("force_z_max") == max(last)
    for name in OUTPUT_NAMES:
        assert np.isfinite(sim.output(name))


def test_outputs_at_the_start(sim):
    for name in ("force_z", "force_z_mean", "force_z_max", "force_z_min"):
        assert sim.output(name) == pytest.approx(65e3, abs=0, rel=1e-12)
    assert sim.output("wheel_disp_z") == 0.0
    assert sim.output("distance") == 0.0
    with pytest.raises(ParameterError, match="force_z_mean"):
        sim.output("force")


def test_inputs_act_from_the_next_communication_step_on(sim, reference):
    forces = forces_of(sim)
    sim.advance(10 * DT)
    sim.set_inputs(wheel_force_z=80e3)
    assert sim.output("force_z") == reference[10]
    sim.advance(10 * DT)
    assert forces[:11] == reference[:11]
    assert forces[11] != reference[11]
    assert sim.inputs["wheel_force_z"] == 80e3


def quasi_static(small_model, extrapolation: str) -> CoSimulation:
    """Rigid wheel and track under a load: the contact force is the input of the step."""
    sim = CoSimulation(small_model(track="rigid", wheel="rigid", contact="hertz", excitation=""))
    sim.configure(input_extrapolation=extrapolation)
    return sim


@pytest.mark.parametrize("cut", [7.3, 0.4, 3.0])
def test_linear_extrapolation_is_exact_for_linear_inputs(small_model, cut):
    sim = quasi_static(small_model, "linear")
    forces = forces_of(sim)
    for _ in range(60):
        sim.set_inputs(wheel_force_z=50e3 + 1e6 * sim.time)
        sim.advance(cut * DT)
        if sim.time > 0:  # an event: the same input again, a step of no length
            sim.set_inputs(wheel_force_z=50e3 + 1e6 * sim.time)
            sim.advance(0.0)
    first = int(cut) + 1  # within the first communication step no slope is known
    expected = 50e3 + 1e6 * DT * np.arange(len(forces))
    assert len(forces) > 20
    np.testing.assert_allclose(forces[first:], expected[first:], rtol=1e-11)
    np.testing.assert_allclose(forces[:first], 50e3, rtol=1e-11)


def test_hold_keeps_the_input(small_model):
    sim = quasi_static(small_model, "hold")
    forces = forces_of(sim)
    for load in (50e3, 60e3, 40e3):
        sim.set_inputs(wheel_force_z=load)
        sim.advance(5 * DT)
    np.testing.assert_allclose(forces, [50e3] * 6 + [60e3] * 5 + [40e3] * 5, rtol=1e-12)


@pytest.mark.parametrize("extrapolation", ["hold", "linear"])
@pytest.mark.parametrize("done", [0.0, 3.7, 140.2])
def test_a_loaded_run_goes_on_bit_for_bit(small_model, extrapolation, done):
    def drive(sim, count):
        for _ in range(count):
            sim.set_inputs(wheel_force_z=65e3 + 1e3 * math.sin(50 * sim.time))
            sim.advance(1.7 * DT)
        return sim.save(), [sim.output(name) for name in OUTPUT_NAMES]

    sim = CoSimulation(small_model())
    sim.configure(input_extrapolation=extrapolation, roughness_scale=1.3, start_position=0.13)
    sim.set_inputs(wheel_force_z=66e3)
    if done:
        sim.advance(done * DT)
        sim.set_inputs(wheel_force_z=64e3)
    saved = sim.save()
    digest = sim.digest()
    expected = drive(sim, 90)
    assert sim.digest() != digest
    sim.load(saved)
    assert (sim.save(), sim.digest()) == (saved, digest)
    assert drive(sim, 90) == expected
    other = CoSimulation(small_model())  # another object, with other parameters
    other.advance(5 * DT)
    other.load(saved)
    assert other.parameters == {**other.parameters, "roughness_scale": 1.3, "start_position": 0.13}
    assert drive(other, 90) == expected


def refused(sim: CoSimulation, data: bytes) -> None:
    before = sim.save()
    with pytest.raises(StateError):
        sim.load(data)
    assert sim.save() == before
    sim.advance(DT)  # still alive


def test_damaged_states_are_refused(sim):
    sim.advance(10 * DT)
    good = sim.save()
    refused(sim, b"")
    refused(sim, good[:10])
    refused(sim, good[:-8])
    refused(sim, good[:-1])
    refused(sim, good + b"\0" * 8)
    refused(sim, b"X" + good[1:])
    for at in range(8, 300, 7):
        refused(sim, good[:at] + bytes([good[at] ^ 0x40]) + good[at + 1 :])


def test_a_flipped_byte_in_the_numbers_is_noticed(sim):
    sim.advance(10 * DT)
    good = sim.save()
    for at in (len(good) - 1500, len(good) - 8 * 245, len(good) // 2):
        refused(sim, good[:at] + bytes([good[at] ^ 0x40]) + good[at + 1 :])


def test_a_state_with_a_part_missing_is_refused_whole(sim):
    """As another version might write it."""
    sim.advance(10 * DT)
    good = sim.save()
    (length,) = struct.unpack("<Q", good[24:32])
    header = json.loads(good[32 : 32 + length])
    for name in header:
        text = json.dumps({key: value for key, value in header.items() if key != name}).encode()
        content = good[8:24] + struct.pack("<Q", len(text)) + text + good[32 + length : -16]
        refused(sim, good[:8] + content + hashlib.blake2b(content, digest_size=16).digest())


def test_states_of_other_models_are_refused(sim, small_model):
    for other in (small_model(wheel="1dof"), small_model(track="rigid"), small_model(contact="hertz")):
        refused(sim, CoSimulation(other).save())


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, "1", None, 10**400, [1.0]], ids=repr_short)
def test_unusable_inputs_are_refused(sim, value):
    sim.advance(5 * DT)
    before = sim.save()
    with pytest.raises(ParameterError, match="wheel_force_z"):
        sim.set_inputs(creepage_x=1.0, wheel_force_z=value)
    with pytest.raises(ParameterError, match="communication step size"):
        sim.advance(value)
    assert sim.save() == before


def test_unknown_names_are_refused(sim):
    before = sim.save()
    with pytest.raises(ParameterError, match=r"no such input.*wheel_force_z"):
        sim.set_inputs(wheel_force_z=1.0, wheel_forze=2.0)
    with pytest.raises(ParameterError, match=r"no such parameter.*roughness_scale"):
        sim.configure(roughness_scale=2.0, rough=1.0)
    with pytest.raises(ParameterError, match=r"-0\.001"):
        sim.advance(-1e-3)
    assert sim.save() == before


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("speed", 0.0),
        ("speed", -30.0),
        ("speed", math.nan),
        ("friction_coefficient", -0.1),
        ("roughness_scale", math.inf),
        ("roughness_scale", 10**400),
        ("coupling", "force"),
        ("input_extrapolation", "cubic"),
        ("balance", 2),
        ("random_seed", -2),
        ("random_seed", 1.5),
        ("record", "yes"),
        ("start_position", math.nan),
    ],
    ids=repr_short,
)
def test_parameters_out_of_range_are_refused(sim, name, value):
    before = sim.parameters
    with pytest.raises(ParameterError, match=name):
        sim.configure(**{name: value})
    assert sim.parameters == before


def test_another_speed_is_refused_and_the_built_one_named(sim, small_model):
    with pytest.raises(ParameterError, match=r"30\.0 m/s.*wheelrail build"):
        sim.configure(speed=31.0)
    sim.configure(speed=30.0 * (1 + 1e-12))  # rounding of a unit conversion
    assert sim.parameters["speed"] == 30.0
    # Without dynamics there are no Green's functions, and any speed will do.
    free = CoSimulation(small_model(track="rigid", wheel="rigid"))
    free.configure(speed=15.0)
    assert free.advance(10 * DT) == 5


def test_start_between_grid_points_is_refused_and_the_nearest_named(sim):
    with pytest.raises(ParameterError, match=r"dx = 0\.005 m; the nearest is 0\.125 m"):
        sim.configure(start_position=0.1262)
    sim.configure(start_position=0.125)
    assert sim.output("distance") == 0.0


def test_parameters_are_fixed_once_the_run_has_begun(sim):
    sim.configure(roughness_scale=2.0)
    sim.advance(DT)
    with pytest.raises(ParameterError, match="reset"):
        sim.configure(roughness_scale=1.0)
    sim.reset()
    assert sim.parameters["roughness_scale"] == 1.0
    sim.configure(roughness_scale=3.0)


def test_reset_repeats_the_run(sim, reference):
    sim.configure(roughness_scale=2.0)
    sim.set_inputs(wheel_force_z=50e3)
    sim.advance(30 * DT)
    sim.reset()
    forces = forces_of(sim)
    sim.advance(300 * DT)
    assert forces == reference


def test_initialise_follows_the_inputs_until_the_run_begins(sim):
    sim.set_inputs(wheel_force_z=40e3)
    assert sim.output("force_z") == pytest.approx(40e3, abs=0, rel=1e-12)
    sim.set_inputs(wheel_force_z=50e3)
    sim.initialise()
    assert sim.output("force_z") == pytest.approx(50e3, abs=0, rel=1e-12)
    sim.advance(DT)
    force = sim.output("force_z")
    sim.set_inputs(wheel_force_z=10e3)
    assert sim.output("force_z") == force


def limited(model: Model, line: np.ndarray) -> Model:
    source = Line(values=line, first_index=-10, dx=model.dx, periodic=False, name="track.csv")
    return Model(**{**{f: getattr(model, f) for f in Model.__dataclass_fields__}, "sources": (source,)})


def test_a_step_beyond_the_measured_line_raises_and_changes_nothing(small_model):
    sim = CoSimulation(limited(small_model(), 1e-6 * np.sin(np.arange(100.0))))
    forces = forces_of(sim)
    sim.advance(60 * DT)
    before, recorded = sim.save(), list(forces)
    with pytest.raises(ExcitationRangeError, match=r"track\.csv.*-0\.05 m to 0\.445 m"):
        sim.advance(40 * DT)
    assert sim.save() == before
    assert forces == recorded
    assert sim.advance(26 * DT) == 26  # up to the last node
    with pytest.raises(ExcitationRangeError):
        sim.advance(DT)


def test_a_contact_that_outgrows_its_grid_raises_and_changes_nothing(small_model):
    line = np.zeros(400)
    line[60:] = 3e-3
    sim = CoSimulation(limited(small_model(), line))
    sim.advance(20 * DT)
    before = sim.save()
    with pytest.raises(ContactGridError, match=r"contact\.length"):
        sim.advance(100 * DT)
    assert sim.save() == before


def test_a_failed_start_is_refused_and_a_better_one_taken(small_model):
    sim = CoSimulation(limited(small_model(), np.zeros(100)))
    sim.configure(start_position=3.0)
    with pytest.raises(ExcitationRangeError):
        sim.initialise()
    with pytest.raises(ExcitationRangeError):
        sim.advance(DT)
    sim.configure(start_position=0.1)
    assert sim.advance(3 * DT) == 3


def test_recorder_gets_the_times(sim):
    times = []
    sim.recorder = lambda time, *_: times.append(time)
    sim.advance(3 * DT)
    sim.advance(2 * DT)
    np.testing.assert_allclose(times, DT * np.arange(6), rtol=1e-14)


def test_a_failed_first_step_does_not_record_the_start_twice(small_model):
    sim = CoSimulation(limited(small_model(), np.zeros(100)))
    times = []
    sim.recorder = lambda time, *_: times.append(time)
    with pytest.raises(ExcitationRangeError):
        sim.advance(200 * DT)
    sim.advance(2 * DT)
    np.testing.assert_allclose(times, DT * np.arange(3), rtol=1e-14)


def test_two_runs_share_a_model(small_model):
    model = small_model()
    one, other = CoSimulation(model), CoSimulation(model)
    other.configure(roughness_scale=4.0)
    forces, others = forces_of(one), forces_of(other)
    for _ in range(50):
        one.advance(DT)
        other.advance(DT)
    alone = CoSimulation(model)
    expected = forces_of(alone)
    alone.advance(50 * DT)
    assert forces == expected
    assert others != expected


def test_warning_about_a_solution_that_is_not_reliable(sim, monkeypatch):
    assert sim.warnings == []
    sim.advance(DT)
    assert sim.warnings == []
    monkeypatch.setattr("wheelrail.interaction.cosimulation.RESIDUAL_LIMIT", -1.0)
    sim.advance(DT)
    assert len(sim.warnings) == 1
    assert "step 2" in sim.warnings[0]


def test_inputs_begin_with_the_case_preload(sim):
    assert sim.inputs["wheel_force_z"] == 65e3
    assert set(sim.inputs) == set(Inputs.__dataclass_fields__)
