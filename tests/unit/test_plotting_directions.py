"""Figures of runs in three directions: which there are, and what they show."""

from __future__ import annotations

import numpy as np

from wheelrail.case import case_from_dict
from wheelrail.greens.modal_discretisation import discretise_modes
from wheelrail.plotting.files import plot_result
from wheelrail.plotting.model_figures import impulse_samples
from wheelrail.plotting.run_figures import modes_that_show
from wheelrail.run import run_case
from wheelrail.wheel.modes import FlexibleWheel, Mode

MODES = """name, frequency [Hz], damping_ratio, modal_mass [kg], shape_x, shape_y, shape_z
"2,0,a", 410.0, 1e-2, 60.0, 0.0, 0.9, 0.3
"2,0,a*", 410.0, 1e-2, 60.0, 0.4, 0.0, 0.0
"2,r", 2600.0, 3e-2, 50.0, 0.0, 0.4, 0.9
"""
COMBINED = {
    "simulation": {"speed": 20.0, "dx": 1e-3, "duration": 0.02, "start_position": 0.0},
    "wheel": {
        "model": "flexible",
        "radius": 0.39,
        "modes": "modes.csv",
        "mass": 340.0,
        "suspension_stiffness": 1.1e6,
        "suspension_damping": 13e3,
    },
    "track": {"model": "rigid"},
    "contact": {
        "normal": "half-space",
        "rail_radius": 0.3,
        "youngs_modulus": 207e9,
        "poisson_ratio": 0.3,
        "dy": 2e-3,
        "length": 17e-3,
        "width": 18e-3,
        "tangential": "fastsim",
    },
    "friction": {"law": "constant", "coefficient": 0.3},
    "creepage": {"x": 0.0, "y": -1e-2, "spin": 0.0},
    "load": {"preload": 65e3, "coupling": "load"},
    "excitation": [{"type": "sinusoid", "amplitude": 1e-6, "wavelength": 0.05}],
}


def combined_result(tmp_path, **output):
    (tmp_path / "cases").mkdir()
    (tmp_path / "results").mkdir()
    (tmp_path / "cases" / "modes.csv").write_text(MODES)
    path = tmp_path / "results" / "run.nc"
    run_case(case_from_dict({**COMBINED, "output": output}, folder=tmp_path / "cases"), path)
    return path


def names(plots):
    return [file.stem.removeprefix("run_") for file in plots.files]


def test_figures_in_three_directions(tmp_path):
    path = combined_result(tmp_path, record=["force_y", "force_z", "slip_fraction"])
    plots = plot_result(path, tmp_path)
    forces = ["force", "force_spectrum", "lateral_force", "lateral_spectrum"]
    model = ["receptances", "receptances_xyz", "greens_functions", "greens_functions_xyz"]
    assert names(plots) == forces + model
    assert plots.left_out == ()
    # The folders moved together, and the result alone.
    moved = tmp_path / "moved"
    moved.mkdir()
    (tmp_path / "cases").rename(moved / "cases")
    (tmp_path / "results").rename(moved / "results")
    path = moved / "results" / "run.nc"
    assert names(plot_result(path, tmp_path)) == forces + model
    alone = tmp_path / "run.nc"
    path.rename(alone)
    plots = plot_result(alone, tmp_path)
    assert names(plots) == forces
    (reason,) = plots.left_out
    looked_for = tmp_path.parent / "cases" / "modes.csv"
    assert reason == (
        f'receptances and Green\'s functions: wheel.modes = "modes.csv": no such file; looked for {looked_for}'
    )


def test_lateral_force_needs_what_it_shows(tmp_path):
    path = combined_result(tmp_path, record=["force_y", "force_z"])
    plots = plot_result(path, tmp_path)
    assert "lateral_force" not in names(plots)
    assert plots.left_out == (
        'lateral force, stick and slip: the result does not hold "slip_fraction"; add to output.record',
    )


def test_modes_that_show_in_a_spectrum():
    dt, n = 1e-4, 4000
    rng = np.random.default_rng(3)
    force = np.sin(2 * np.pi * 1252.0 * np.arange(n) * dt) + 1e-2 * np.sin(2 * np.pi * 700.0 * np.arange(n) * dt)
    force += 1e-6 * rng.normal(size=n)
    modes = {"3,r": 1225.0, "5,0,a": 1250.0, "2,0,a": 650.0, "7,0,a": 3000.0}
    assert modes_that_show(modes, force, dt) == {"5,0,a": 1250.0}
    assert modes_that_show({}, force, dt) == {}


def test_green_s_functions_of_the_figure_are_those_of_the_modes():
    wheel = FlexibleWheel(
        (Mode.with_frequency(name="a", mass=50.0, frequency=400.0, damping_ratio=1e-2, shape=(0.3, 0.9, -0.4)),)
    )
    (mode,), dt = wheel.modes, 1e-5
    arguments = {key: [getattr(mode, key)] for key in ("mass", "stiffness", "damping")}
    response = discretise_modes(**arguments, shapes=np.array([mode.shape]), dt=dt)
    samples = impulse_samples(response, 300)
    time = np.arange(1, 300) * dt
    decay = 0.5 * mode.damping / mode.mass
    omega = np.sqrt(mode.omega**2 - decay**2)
    expected = np.exp(-decay * time) * np.sin(omega * time) / (mode.mass * omega) * dt
    for i, j in np.ndindex(3, 3):
        part = mode.shape[i] * mode.shape[j]
        # A force that rises and falls over a step each; achieved: 5.3e-5.
        np.testing.assert_allclose(samples[1:, i, j], part * expected, rtol=0, atol=1e-4 * abs(part) * expected.max())
