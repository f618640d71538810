"""An FMU with a flexible wheel on a waveguide rail: guiding forces in, displacements in three directions out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmu_host import UnpackedFmu

from fmu_src.build import build_fmu
from wheelrail.case import case_from_dict, load_case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation

pytestmark = pytest.mark.fmu

ROOT = Path(__file__).parents[2]
PORTS = (
    "force_x",
    "force_y",
    "force_z",
    *(f"{body}_disp_{axis}" for body in ("wheel", "rail") for axis in "xyz"),
    "friction_power",
)


@pytest.fixture(scope="module")
def case():
    data = load_case(ROOT / "examples" / "cases" / "rolling_contact.toml").to_dict()
    # Coarse, so that it is built fast.
    data["wheel"] = {"preset": "synthetic-c20", "element_size": 0.02, "max_frequency": 1300.0, "contact_position": 0.01}
    data["track"] = {"preset": "thesis-waveguide-60e1", "max_frequency": 1500.0, "memory": 0.02}
    data["track"]["contact_position"] = 5e-3
    data["simulation"]["duration"] = 0.02
    return case_from_dict(data)


@pytest.fixture(scope="module")
def built(case, tmp_path_factory) -> UnpackedFmu:
    folder = tmp_path_factory.mktemp("flexible")
    return UnpackedFmu(build_fmu(case, folder), folder / "unpacked")


def ports(instance) -> list[float]:
    return [instance.get(name) for name in PORTS]


def test_same_numbers_as_the_model(built, case):
    run, fmu = CoSimulation(build_model(case)), built.instance()
    seen = []
    for number in range(30):
        inputs = {"wheel_force_y": 400.0 * number, "wheel_force_x": -50.0 * number, "creepage_y": 1e-3 - 5e-5 * number}
        run.set_inputs(**inputs)
        fmu.set(**inputs)
        step_size = 0.7 * run.model.dt * (1 + number % 3)
        run.advance(step_size)
        fmu.step(step_size)
        seen.append(ports(fmu))
        assert seen[-1] == [run.output(name) for name in PORTS], number
    assert np.all(np.ptp(seen, axis=0) > 0.0)  # all ports are live


def test_balance_through_the_port(built):
    balanced, loose = built.instance(), built.instance(balance=False)
    assert abs(balanced.get("wheel_disp_y")) < 1e-15
    # The contact's force on the wheel, -force_y, bends its suspension.
    assert loose.get("wheel_disp_y") * loose.get("force_y") < 0.0
    for fmu in (balanced, loose):
        before = ports(fmu)
        fmu.step(1e-3)
        np.testing.assert_allclose(ports(fmu), before, rtol=1e-8, atol=1e-6)


def test_state_saved_and_restored(built):
    fmu = built.instance()
    fmu.step(1e-3)
    state, time = fmu.slave.getFMUState(), fmu.time
    fmu.set(wheel_force_y=5e3)
    fmu.step(1e-3)
    first = ports(fmu)
    fmu.slave.setFMUState(state)
    fmu.time = time
    fmu.set(wheel_force_y=5e3)
    fmu.step(1e-3)
    assert ports(fmu) == first
    fmu.slave.freeFMUState(state)


def test_the_documentation_names_what_has_no_effect(built):
    page = (Path(built.folder) / "documentation" / "index.html").read_text(encoding="utf-8")
    unused = page.split("Its model has no use for")[1].split("</p>")[0]
    for name in ("wheel_force_x", "wheel_force_y", "balance", "wheel_disp_y", "rail_disp_x", "creepage_y"):
        assert name not in unused
    assert "wheel_y" in unused
    assert "run away" in page
