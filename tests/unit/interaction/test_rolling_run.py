"""Rolling contact in the coupled run: what the step makes of creepages, load and the contact models."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wheelrail.case import case_from_dict, load_case
from wheelrail.errors import CaseError, ContactGridError
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.model_file import load_model, save_model

CASE = load_case(Path(__file__).parents[3] / "examples" / "cases" / "rolling_contact.toml").to_dict()


def run_of(**changes: Any) -> CoSimulation:
    """Run of the example with keys ``section__key`` changed."""
    data = deepcopy(CASE)
    for name, value in changes.items():
        section, key = name.split("__")
        data[section][key] = value
    return CoSimulation(build_model(case_from_dict(data)))


def dynamic() -> CoSimulation:
    """Wheel of two masses over a short track, with roughness and creepage."""
    data = deepcopy(CASE)
    data["wheel"] = {"preset": "thesis-2dof", "radius": 0.39}
    data["track"] = {"preset": "thesis-discrete", "bays": 20, "elements_per_bay": 2, "memory": 0.02}
    data["excitation"] = [{"type": "sinusoid", "amplitude": 5e-6, "wavelength": 0.04}]
    return CoSimulation(build_model(case_from_dict(data)))


def test_vertical_force_does_not_feel_the_tangential_contact():
    rolling, sliding = dynamic(), dynamic()
    sliding.configure(friction_coefficient=0.0)
    vertical = []
    for _ in range(150):
        for run in (rolling, sliding):
            run.advance(run.model.dt)
        vertical.append(rolling.output("force_z"))
        assert sliding.output("force_z") == vertical[-1]
        assert sliding.output("force_y") == 0.0
    assert np.ptp(vertical) > 1e3  # it does something
    assert abs(rolling.output("force_y")) > 5e3
    assert rolling.output("solver_residual") < 1e-9


def test_save_and_load_continue_to_the_bit_and_the_file_gives_the_same_run(tmp_path):
    run = dynamic()
    run.advance(20 * run.model.dt)
    saved = run.save()
    run.advance(30 * run.model.dt)
    digest = run.digest()
    run.load(saved)
    run.advance(30 * run.model.dt)
    assert run.digest() == digest
    save_model(run.model, tmp_path / "model")
    loaded = CoSimulation(load_model(tmp_path / "model"))
    loaded.advance(20 * run.model.dt)
    loaded.advance(30 * run.model.dt)
    assert [loaded.output(name) for name in ("force_y", "force_z")] == [
        run.output(name) for name in ("force_y", "force_z")
    ]


def test_half_space_and_hertz_give_the_same_vertical_dynamics():
    """Long waves and a fine grid: the same physics in two models."""
    forces = {}
    for normal in ("hertz", "half-space"):
        data = deepcopy(CASE)
        data["simulation"] |= {"dx": 0.5e-3, "speed": 20.0}
        data["contact"] |= {"normal": normal, "tangential": "none", "dy": 0.5e-3, "length": 18.5e-3, "width": 18.5e-3}
        data["wheel"] = {"preset": "thesis-1dof", "radius": 0.39}
        data["excitation"] = [{"type": "sinusoid", "amplitude": 5e-6, "wavelength": 0.2}]
        run = CoSimulation(build_model(case_from_dict(data)))
        forces[normal] = []
        for _ in range(400):
            run.advance(run.model.dt)
            forces[normal].append(run.output("force_z"))
    hertz, grid = np.array(forces["hertz"]), np.array(forces["half-space"])
    # Achieved: 4e-3 of the dynamic force, of the grid of 0.5 mm.
    assert np.abs(grid - hertz).max() < 1.5e-2 * np.ptp(hertz)


@pytest.mark.parametrize("tangential", ["fastsim", "linear"])
@pytest.mark.parametrize("normal", ["hertz", "winkler", "half-space"])
def test_creep_force_laws(normal, tangential):
    run = run_of(contact__normal=normal, contact__tangential=tangential)
    run.advance(1e-3)
    exact = -7995.25
    # FASTSIM: 6 % here; linear theory, which knows no limit, is beyond by 10 %.
    assert run.output("force_y") == pytest.approx(exact, rel=0.08 if tangential == "fastsim" else 0.13)
    assert run.output("friction_power") == pytest.approx(-run.output("force_y") * 1e-3 * 50.0 / 3.6, rel=1e-12)
    run.set_inputs(wheel_force_z=0.0)
    run.advance(1e-3)
    assert run.output("force_y") == run.output("force_z") == 0.0


def test_a_smaller_grid_is_refused_with_one_that_is_enough():
    with pytest.raises(ContactGridError, match=r"contact\.length") as caught:
        run_of(contact__length=11e-3, contact__width=9e-3).initialise()
    words = str(caught.value)
    length = float(words.split("contact.length = ")[1].split(" m")[0])
    width = float(words.split("contact.width = ")[1].split(" m")[0])
    run = run_of(contact__length=round(length, 6), contact__width=round(width, 6))
    assert run.output("force_y") == pytest.approx(-7995.24847593571, abs=1e-5)


def test_first_sample_zero_makes_displacements_known_beforehand():
    data = deepcopy(CASE)
    data["wheel"] = {"preset": "thesis-2dof", "radius": 0.39}
    data["simulation"]["first_sample"] = "zero"
    model = build_model(case_from_dict(data))
    assert model.wheel is not None
    assert model.wheel.first == 0.0


def test_what_does_not_go_together_is_refused():
    with pytest.raises(CaseError, match="half-space"):
        run_of(contact__normal="winkler")
