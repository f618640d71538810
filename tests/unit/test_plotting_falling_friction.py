"""Figures of slip-velocity dependent friction: what they show."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from wheelrail.case import case_from_dict, load_case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.simulate import stand_alone_inputs
from wheelrail.interaction.start import start
from wheelrail.plotting.contact_run import contact_of
from wheelrail.plotting.falling_friction import (
    CentreLine,
    centre_lines_figure,
    force_by_grid_figure,
    friction_laws_figure,
    spectra_figure,
)


def test_histories_keep_their_values_and_names():
    histories = {"dx 1 mm": (np.array([0.0, 1e-3]), np.array([-1e3, -2e3])), "fine": (np.zeros(1), np.zeros(1))}
    (axis,) = force_by_grid_figure(histories, title="force").axes
    first, second = axis.get_lines()
    np.testing.assert_allclose(first.get_xydata(), [[0.0, -1.0], [1.0, -2.0]])
    assert [line.get_label() for line in (first, second)] == list(histories)


def test_laws_start_at_rest():
    speed = np.array([0.0, 1.0])
    (axis,) = friction_laws_figure({"falling": (speed, np.array([0.3, 0.1]))}, title="laws").axes
    assert axis.get_xlim()[0] == 0.0
    np.testing.assert_allclose(axis.get_lines()[0].get_ydata(), [0.3, 0.1])


def test_centre_lines_share_their_scales():
    x = np.array([-1e-3, 0.0, 1e-3])
    lines = [
        CentreLine(str(n), x, n * np.array([0.0, 1e8, 0.0]), np.array([0.0, 4e8, 0.0]), np.array([0.0, n, 0.0]))
        for n in (1.0, 2.0, 4.0)
    ]
    figure = centre_lines_figure(lines, title="cycle", columns=2)
    shown = [axis for axis in figure.axes if axis.get_visible()]
    assert [axis.get_title() for axis in shown] == ["1.0", "2.0", "4.0"]
    for axis, n in zip(shown, (1.0, 2.0, 4.0), strict=True):
        traction, slip = axis.get_lines()
        assert traction.get_ydata().max() == n / 4.0
        assert slip.get_ydata().max() == n / 4.0


def test_spectra_are_levels_of_rms_values():
    frequency = np.linspace(0.0, 1e4, 101)
    amplitude = np.where(frequency == 1e3, 100.0 * np.sqrt(2.0), 1e-3)
    (axis,) = spectra_figure({"one": (frequency, amplitude)}, modes={"3,0,a": 1e3}, title="spectrum").axes
    (line,) = [line for line in axis.get_lines() if line.get_label() == "one"]
    assert np.isclose(line.get_ydata().max(), 40.0)
    assert line.get_xdata().max() <= 7.0


def test_contact_of_a_run_has_the_coefficient_of_each_element():
    data = load_case(Path(__file__).parents[2] / "examples" / "cases" / "falling_friction.toml").to_dict()
    data["simulation"]["dx"] = 1e-3
    data["contact"] |= {"dy": 1e-3, "length": 19e-3, "width": 19e-3}
    model = build_model(case_from_dict(data))
    state = contact_of(model, start(model, stand_alone_inputs(model)))
    sliding = state.contact & state.slipping
    assert sliding.any()
    # Sliding elements are at their own bound, which differs from element to element.
    np.testing.assert_allclose(np.hypot(*state.tractions)[sliding], state.bound[sliding], rtol=1e-8)
    assert np.ptp(np.asarray(state.friction)[sliding]) > 1e-3
