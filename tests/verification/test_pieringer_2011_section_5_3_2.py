"""Squeal with falling friction (Pieringer 2011, section 5.3.2): runs in time against the stability of sliding.

The case is examples/cases/squeal_falling_friction.toml. The stability check uses neither the contact algorithm nor the
Green's functions of the runs, and has the contact as a point with a spring.
"""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import butter, hilbert, sosfiltfilt

from wheelrail.analysis.sliding_case import sliding_loop
from wheelrail.analysis.stability import mode_stability
from wheelrail.case import Case, case_from_dict
from wheelrail.interaction.build import build_model
from wheelrail.interaction.simulate import Simulation
from wheelrail.interaction.tracks import track_of

CASE = Path(__file__).parents[2] / "examples" / "cases" / "squeal_falling_friction.toml"


def squeal_case(*, tangential: str = "transient", amplitude: float = 1e-6, **friction) -> Case:
    data = tomllib.loads(CASE.read_text(encoding="utf-8"))
    data["contact"]["tangential"] = tangential
    data["excitation"][0]["amplitude"] = amplitude
    data["friction"].update(friction)
    return case_from_dict(data)


def growth(model, names: dict[str, float], *, duration: float) -> dict[str, float]:
    """Growth rates in 1/s of the wheel's lateral velocity around some frequencies, while the contact slides."""
    run = Simulation(model, duration=duration, record=["wheel_disp_y", "slip_fraction", "solver_residual"]).collect()
    assert run["slip_fraction"].min() == 1.0
    assert run["solver_residual"].max() < 1e-8  # 1e-10
    velocity, rates = np.gradient(run["wheel_disp_y"], model.dt), {}
    for name, frequency in names.items():
        band = butter(3, [frequency - 80.0, frequency + 80.0], "bandpass", fs=1.0 / model.dt, output="sos")
        envelope = np.abs(hilbert(sosfiltfilt(band, velocity)))
        late = slice(len(envelope) // 2, int(0.85 * len(envelope)))
        rates[name] = float(np.polyfit(run["time"][late], np.log(envelope[late]), 1)[0])
    return rates


MODES = ("2,0,a", "3,0,a", "4,0,a")


@pytest.fixture(scope="module")
def expected() -> dict:
    return {mode.name: mode for mode in mode_stability(sliding_loop(squeal_case())) if mode.name in MODES}


@pytest.mark.slow
def test_modes_grow_in_the_point_contact_as_the_stability_check_says(expected):
    """The check is continuous in time: the run comes to it as dx goes to 0, in the first order."""
    names = {name: mode.coupled_frequency for name, mode in expected.items()}
    runs = []
    for dx in (0.5e-3, 0.25e-3):
        data = squeal_case(tangential="friction-curve", amplitude=5e-9).to_dict()
        data["simulation"]["dx"] = dx
        data["contact"] |= {"normal": "hertz", "length": 19 * dx, "dy": dx, "width": 19 * dx}
        runs.append(growth(build_model(case_from_dict(data)), names, duration=0.09))
    for name, mode in expected.items():
        coarse, fine = runs[0][name], runs[1][name]
        assert 2.0 * fine - coarse == pytest.approx(mode.growth_rate, rel=0.03)  # 79.2, 76.2, 75.3 1/s: 1.4, 0.8, 0.7 %
        assert abs(fine - mode.growth_rate) < abs(coarse - mode.growth_rate)


@pytest.mark.slow
def test_modes_grow_in_the_transient_contact_nearly_as_the_stability_check_says(expected):
    """The slip is not the same all over the contact, and particles bring their friction along."""
    names = {name: mode.coupled_frequency for name, mode in expected.items()}
    rates = growth(build_model(squeal_case(amplitude=5e-9)), names, duration=0.09)
    for name, mode in expected.items():
        assert rates[name] == pytest.approx(mode.growth_rate, rel=0.1)  # 85.5, 81.1, 70.7 1/s: 6.5, 5.6, 6.8 %


@pytest.mark.slow
def test_more_memory_makes_high_modes_stable():
    """The low-pass of the memory, s / d_c, comes below their frequencies."""
    rail = track_of(squeal_case()).receptance
    growing = {}
    for distance in (3e-6, 30e-6, 300e-6):
        loop = replace(sliding_loop(squeal_case(memory_distance=distance)), rail=rail)
        growing[distance] = {mode.name for mode in mode_stability(loop) if mode.unstable}
    assert growing[3e-6] >= {f"{n},0,a" for n in range(1, 9)}
    assert growing[300e-6] < growing[30e-6] <= growing[3e-6]
