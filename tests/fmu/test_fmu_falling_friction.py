"""An FMU whose friction falls with the slip velocity."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmu_host import UnpackedFmu

from fmu_src.build import build_fmu
from wheelrail.case import Case, case_from_dict, load_case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation

pytestmark = pytest.mark.fmu

ROOT = Path(__file__).parents[2]
PORTS = (
    "force_x",
    "force_y",
    "force_y_mean",
    "slip_fraction",
    "friction_power",
    "friction_method",
    "friction_solutions",
    "friction_force_spread",
    "solver_residual",
)


def case_with(**friction) -> Case:
    """Thesis section 5.3.2 on 1 mm, normalised law."""
    data = load_case(ROOT / "examples" / "cases" / "falling_friction.toml").to_dict()
    data["simulation"]["dx"] = 1e-3
    data["excitation"] = []
    data["contact"] |= {"dy": 1e-3, "length": 19e-3, "width": 19e-3}
    data["friction"] |= {"normalise": True, **friction}
    return case_from_dict(data)


@pytest.fixture(scope="module")
def with_memory(tmp_path_factory) -> tuple[Case, UnpackedFmu]:
    folder = tmp_path_factory.mktemp("falling")
    case = case_with(memory_distance=3e-6, memory_speed=1e-3)
    return case, UnpackedFmu(build_fmu(case, folder), folder / "unpacked")


def ports(instance) -> list:
    return [instance.get(name) for name in PORTS]


def test_starts_in_steady_rolling_and_stays(with_memory):
    _, fmu = with_memory
    instance = fmu.instance()
    assert instance.get("friction_law") == "kraft"
    # Vollebregt's open CONTACT (rev 2707) stops at -16581 N, at a change of the slip of 1e-3.
    assert instance.get("force_y") == pytest.approx(-16577.887, abs=1e-3)
    instance.step(5e-3)
    assert instance.get("force_y") == pytest.approx(-16577.887, abs=1e-3)
    assert instance.get("friction_method") == 1
    assert instance.get("friction_solutions") == 1
    assert not any("memory" in message for _, _, message in instance.log)


def test_equals_the_cosimulation_and_rolls_back_bit_for_bit(with_memory):
    case, fmu = with_memory
    run, instance = CoSimulation(build_model(case)), fmu.instance()
    generator = np.random.default_rng(3)

    def drive(number: int) -> list[list]:
        results = []
        for _ in range(number):
            values = {
                "creepage_y": 5e-3 * generator.standard_normal(),
                "wheel_force_z": 65e3 * generator.uniform(0, 1.2),
            }
            instance.set(**values)
            instance.step(0.3e-3)
            run.set_inputs(**values)
            run.advance(0.3e-3)
            results.append(ports(instance))
            assert results[-1] == [run.output(name) for name in PORTS]
            assert results[-1][-1] < 1e-8
        return results

    drive(8)
    state, time, save, bits = instance.slave.getFMUstate(), instance.time, run.save(), generator.bit_generator.state
    first = drive(12)
    instance.slave.setFMUstate(state)
    instance.time = time
    run.load(save)
    generator.bit_generator.state = bits
    assert drive(12) == first
    instance.slave.freeFMUState(state)


def test_without_memory_the_log_recommends_it(tmp_path):
    fmu = UnpackedFmu(build_fmu(case_with(), tmp_path), tmp_path / "unpacked")
    instance = fmu.instance(creepage_y=0.0)
    assert sum("friction.memory_distance" in message for _, _, message in instance.log) == 1
    instance.step(0.0)  # the start is without tractions, what is set now is a change
    instance.set(creepage_y=5e-3)
    forces = []
    for _ in range(60):
        instance.step(instance.get("time_step"))
        forces.append(instance.get("force_y"))
        assert instance.get("solver_residual") < 1e-8
    late = np.array(forces[40:])
    # As in tests/verification: swings between every two steps.
    assert late.min() == pytest.approx(-17673.6, rel=1e-3)  # 2e-4
    assert late.max() == pytest.approx(-14516.4, rel=1e-3)  # 1e-4
