"""An FMU with profiles, roughness across the contact and a wheel flat: the lateral shift is a live input."""

from __future__ import annotations

from pathlib import Path

import pytest
from fmpy import simulate_fmu
from fmu_host import UnpackedFmu

from fmu_src.build import build_fmu
from wheelrail.case import Case, parse_case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation

pytestmark = pytest.mark.fmu

CASE = """
title = "S1002 on 60E1"
[simulation]
speed = 20.0
dx = 1e-3
duration = 0.02
start_position = 0.0
[wheel]
preset = "thesis-1dof"
[track]
model = "rigid"
[contact]
normal = "half-space"
tangential = "transient"
dy = 1e-3
length = 41e-3
width = 41e-3
wheel_profile = "s1002"
rail_profile = "60e1"
inclination = 0.025
lateral_shift = -5e-3
youngs_modulus = 207e9
poisson_ratio = 0.3
[friction]
law = "constant"
coefficient = 0.3
[creepage]
x = 1e-3
y = 0.0
spin = 0.0
[load]
preload = 65e3
coupling = "load"
[[excitation]]
type = "spectrum"
name = "cnossos-wheel-disc-brake"
on = "wheel"
seed = 4
lines = [-12e-3, -6e-3, 0.0, 6e-3, 12e-3]
coherence = 1.0
[[excitation]]
type = "wheel-flat"
shape = "rounded"
depth = 0.2e-3
length = 0.05
angle = 0.3
"""
PORTS = (
    "force_x",
    "force_y",
    "force_z",
    "force_z_max",
    "contact_y_wheel",
    "contact_y_rail",
    "contact_angle",
    "rolling_radius",
    "contact_points",
    "missed_overlap",
    "contact_width",
    "solver_residual",
)


@pytest.fixture(scope="module")
def built(tmp_path_factory) -> tuple[Case, Path]:
    case = parse_case(CASE)
    return case, build_fmu(case, tmp_path_factory.mktemp("profiles"))


def test_equals_the_cosimulation_and_rolls_back_bit_for_bit(built, tmp_path):
    case, path = built
    fmu = UnpackedFmu(path, tmp_path)
    run, instance = CoSimulation(build_model(case)), fmu.instance()
    assert instance.get("contact_geometry") == "wheel s1002 on rail 60e1, inclined by 0.025 rad"
    assert instance.get("lateral_shift") == -5e-3

    def roll(first: int, last: int) -> list[list]:
        results = []
        for k in range(first, last):
            shift = -5e-3 + 60e-6 * k
            instance.set(lateral_shift=shift)
            instance.step(5e-4)
            run.set_inputs(lateral_shift=shift)
            run.advance(5e-4)
            results.append([instance.get(name) for name in PORTS])
            assert results[-1] == [run.output(name) for name in PORTS]
        return results

    roll(0, 6)
    state, time, save = instance.slave.getFMUstate(), instance.time, run.save()
    first = roll(6, 20)
    instance.slave.setFMUstate(state)
    instance.time = time
    run.load(save)
    assert roll(6, 20) == first
    instance.slave.freeFMUState(state)
    table = dict(zip(PORTS, zip(*first, strict=True), strict=True))
    assert table["contact_y_wheel"][-1] < table["contact_y_wheel"][0] < 9e-3  # towards the flange
    assert max(table["solver_residual"]) < 1e-9
    # The flat comes down at x = 0.138 m, in the 14th communication step.
    assert max(table["force_z_max"]) > 1.3 * 65e3


def test_a_shift_beyond_the_profiles_is_an_error_that_loses_nothing(built, tmp_path):
    _, path = built
    instance = UnpackedFmu(path, tmp_path).instance()
    instance.step(1e-3)
    before = instance.get("force_z")
    instance.set(lateral_shift=0.2)
    with pytest.raises(Exception, match="fmi2DoStep"):
        instance.step(1e-3)
    assert any("lateral_shift = 0.2" in message for _, _, message in instance.log)
    instance.set(lateral_shift=-5e-3)
    assert instance.get("force_z") == before
    instance.step(1e-3)


def test_under_fmpy(built):
    _, path = built
    result = simulate_fmu(str(path), stop_time=5e-3, output_interval=5e-4, output=["force_z", "rolling_radius"])
    assert result["force_z"].min() > 0.0
    assert result["rolling_radius"][-1] == pytest.approx(0.46, abs=1e-3)
