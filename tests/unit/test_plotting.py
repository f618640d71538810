"""What the figures show: the curves, their units and their marks."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from wheelrail.case import case_from_dict, parse_case
from wheelrail.plotting.files import PlotError, plot_result
from wheelrail.plotting.force import force_figure, nominal_frequency, spectrum_figure
from wheelrail.plotting.response import greens_figure, receptance_figure
from wheelrail.run import run_case

DX, SPACING = 1e-2, 0.6


def curve(axis, label):
    (line,) = (line for line in axis.lines if line.get_label() == label)
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def force_record(n=1201, peak_at=700):
    position = 0.1 + np.arange(n) * DX
    force = 65e3 + 1e3 * np.sin(np.arange(n))
    force[peak_at] = 90e3
    return np.arange(n) * 1e-4, position, force


def test_force_figure_shows_all_of_it_and_two_bays_around_the_peak():
    time, position, force = force_record()
    figure = force_figure(
        time=time, position=position, force=force, load=65e3, sleeper_spacing=SPACING, title="100 $ a_b"
    )
    whole, zoom = figure.axes
    x, y = curve(whole, "contact force")
    np.testing.assert_array_equal(x, time)
    np.testing.assert_allclose(y, force / 1e3)
    x, y = curve(zoom, "contact force")
    assert y.max() == 90.0
    assert x[-1] - x[0] == pytest.approx(2 * SPACING)
    assert x[0] / SPACING == pytest.approx(round(x[0] / SPACING))
    sleepers = [line.get_xdata()[0] for line in zoom.lines if line.get_marker() == "^"]
    np.testing.assert_allclose(sleepers, x[0] + SPACING * np.arange(3))
    assert curve(zoom, "static load")[1][0] == 65.0
    assert whole.get_xlabel() == "Time / s"
    assert whole.get_ylabel() == "Contact force / kN"
    FigureCanvasAgg(figure).draw()  # a dollar sign in the title is no formula


@pytest.mark.parametrize("peak_at", [0, 1200])
def test_peak_at_an_end_still_gives_a_full_window(peak_at):
    time, position, force = force_record(peak_at=peak_at)
    figure = force_figure(time=time, position=position, force=force, load=None, sleeper_spacing=SPACING, title="")
    x, y = curve(figure.axes[1], "contact force")
    assert y.max() == 90.0
    assert x[-1] - x[0] > SPACING
    assert "static load" not in [line.get_label() for line in figure.axes[0].lines]


def test_a_long_record_is_thinned_without_losing_a_peak():
    time, position, force = force_record(n=100_001, peak_at=54_321)
    force[77_777] = 1e3
    figure = force_figure(time=time, position=position, force=force, load=65e3, sleeper_spacing=None, title="")
    x, y = curve(figure.axes[0], "contact force")
    assert len(x) <= 4000
    assert np.all(np.diff(x) > 0.0)
    assert (y.max(), y.min()) == (90.0, 1.0)
    assert x[np.argmax(y)] == time[54_321]


def test_records_of_one_and_two_samples_can_be_drawn():
    for n in (1, 2):
        time, position, force = np.arange(n) * 1e-4, np.arange(n) * DX, np.full(n, 65e3)
        figure = force_figure(time=time, position=position, force=force, load=65e3, sleeper_spacing=SPACING, title="")
        FigureCanvasAgg(figure).draw()
        assert any(len(line.get_xdata()) == n for axis in figure.axes for line in axis.lines)


def test_spectrum_has_the_level_of_a_sine_in_its_band():
    dt = 1e-4
    force = 65e3 + 1e3 * np.sin(2 * np.pi * 250.0 * np.arange(20_000) * dt)
    force += np.random.default_rng(1).normal(scale=10.0, size=20_000)
    figure = spectrum_figure(force=force, dt=dt, title="", marks={"sleeper passing": 46.2, "too low": 1e-3})
    (axis,) = figure.axes
    steps = axis.patches[-1].get_data()
    loudest = int(np.argmax(steps.values))
    # 20 lg (1000 / sqrt 2) in the band around 251.2 Hz.
    assert steps.values[loudest] == pytest.approx(56.99, abs=0.02)  # achieved: 0.00
    assert steps.edges[loudest] < 250.0 < steps.edges[loudest + 1]
    assert axis.get_ylabel() == "Contact force level / dB re 1 N"
    assert [text.get_text() for text in axis.texts] == ["sleeper passing\n46.2 Hz"]
    FigureCanvasAgg(figure).draw()
    assert "250" in [label.get_text() for label in axis.get_xticklabels()]


def test_empty_bands_at_the_ends_are_not_drawn():
    # A pure tone has nothing below or above its band but what the window leaks.
    force = 1e3 * np.sin(2 * np.pi * 250.0 * np.arange(20_000) * 1e-4)
    (axis,) = spectrum_figure(force=force, dt=1e-4, title="").axes
    low, high = axis.get_xlim()
    assert 100.0 < low < 250.0 < high < 630.0


def test_spectrum_of_a_constant_force_and_of_too_few_samples():
    FigureCanvasAgg(spectrum_figure(force=np.full(1000, 65e3), dt=1e-4, title="")).draw()
    with pytest.raises(ValueError, match="16 samples"):
        spectrum_figure(force=np.ones(10), dt=1e-4, title="")


@pytest.mark.parametrize(
    ("number", "name"), [(15, "31.5"), (18, "63"), (21, "125"), (30, "1k"), (33, "2k"), (41, "12.5k")]
)
def test_nominal_frequencies(number, name):
    # IEC 61260-1:2014, annex E.
    assert nominal_frequency(10 ** (number / 10)) == name


def test_receptances_are_drawn_as_magnitude_and_phase_from_minus_180():
    frequency = np.geomspace(20.0, 5000.0, 50)
    free_mass = -1.0 / (100.0 * (2 * np.pi * frequency) ** 2) + 0.0j  # on the branch cut of the angle
    figure = receptance_figure(
        frequency=frequency, receptances={"mass": free_mass, "spring": np.full(50, 1e-9 + 0j)}, title="t"
    )
    magnitude, phase = figure.axes
    np.testing.assert_allclose(curve(magnitude, "mass")[1], np.abs(free_mass))
    np.testing.assert_allclose(phase.lines[0].get_ydata(), -180.0)
    np.testing.assert_allclose(phase.lines[1].get_ydata(), 0.0)
    assert magnitude.get_xscale() == magnitude.get_yscale() == "log"


def test_greens_figure_leaves_out_what_is_rigid():
    time = np.linspace(0.0, 0.05, 501)
    values = 5e-6 * np.exp(-time * 100.0)
    both = greens_figure(track_time=time, track={"a": values}, wheel_time=time, wheel=values, shown=0.01, title="")
    assert [axis.get_title(loc="left").split(",")[0].split(":")[0] for axis in both.axes] == ["Track", "Track", "Wheel"]
    x, y = curve(both.axes[0], "a")
    assert x[-1] == pytest.approx(10.0)  # ms
    assert y[0] == pytest.approx(5.0)  # um/(N s)
    wheel = greens_figure(track_time=None, track={}, wheel_time=time, wheel=values, shown=0.01, title="")
    assert [axis.get_title(loc="left") for axis in wheel.axes] == ["Wheel"]


CASE = """
[simulation]
speed = 30.0
dx = 5e-3
duration = 0.05
start_position = 0.0
[wheel]
preset = "thesis-2dof"
[track]
preset = "thesis-discrete"
bays = 20
memory = 0.02
[contact]
normal = "hertz"
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
[load]
preload = 65e3
coupling = "load"
"""


def result(tmp_path, monkeypatch, **sections):
    monkeypatch.setenv("WHEELRAIL_CACHE", str(tmp_path / "cache"))
    data = parse_case(CASE).to_dict()
    for name, keys in sections.items():
        data[name] = {**data.get(name, {}), **keys}
    path = tmp_path / "run.nc"
    run_case(case_from_dict(data), path)
    return path


@pytest.mark.parametrize(("format", "magic"), [("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml")])
def test_all_figures_of_a_result_as_files(tmp_path, monkeypatch, format, magic):
    path = result(tmp_path, monkeypatch)
    plots = plot_result(path, tmp_path, format=format)
    assert [file.name for file in plots.files] == [
        f"run_{name}.{format}" for name in ("force", "force_spectrum", "receptances", "greens_functions")
    ]
    assert plots.left_out == ()
    for file in plots.files:
        assert file.read_bytes().startswith(magic)
    assert not list(tmp_path.glob("*.part"))


def test_what_can_not_be_drawn_is_said(tmp_path, monkeypatch):
    path = result(
        tmp_path,
        monkeypatch,
        output={"record": ["approach"]},
    )
    plots = plot_result(path, tmp_path)
    assert [file.name for file in plots.files] == ["run_receptances.png", "run_greens_functions.png"]
    assert "force_z" in plots.left_out[0]
    path = result(tmp_path, monkeypatch, simulation={"duration": 0.001})
    assert "7 samples are too few" in plot_result(path, tmp_path).left_out[0]


def test_refusals(tmp_path, monkeypatch):
    path = result(tmp_path, monkeypatch)
    with pytest.raises(PlotError, match="no such folder"):
        plot_result(path, tmp_path / "nowhere")
    with pytest.raises(PlotError, match="png, pdf, svg"):
        plot_result(path, tmp_path, format="bmp")
