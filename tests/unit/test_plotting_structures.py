"""Figures of flexible wheels, waveguide rails and squeal: the curves, their units and their marks."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection

from wheelrail.plotting.greens_functions import greens_components_figure
from wheelrail.plotting.rail_waves import dispersion_figure, wave_shapes_figure
from wheelrail.plotting.receptances import receptance_components_figure
from wheelrail.plotting.squeal import squeal_figure, squeal_spectrum_figure
from wheelrail.plotting.wheel_modes import wheel_modes_figure
from wheelrail.track.dispersion import disperse
from wheelrail.track.safe_matrices import Material, section_matrices
from wheelrail.track.section import RailSection
from wheelrail.wheel.flexible import wheel_shapes
from wheelrail.wheel.section import load_section

STEEL = {"youngs_modulus": 207e9, "poisson_ratio": 0.3, "density": 7860.0}


def drawn(figure):
    FigureCanvasAgg(figure).draw()
    return figure


def curve(axis, label):
    (line,) = (line for line in axis.lines if line.get_label() == label)
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def test_components_of_receptances():
    frequency = np.geomspace(20.0, 5000.0, 60)
    values = np.zeros((60, 3, 3), dtype=complex)
    values[:, 2, 2] = 1 / (1e9 - 0.5 * (2 * np.pi * frequency) ** 2 + 1e3j * frequency)
    values[:, 1, 2] = values[:, 2, 1] = -0.5 * values[:, 2, 2]
    figure = receptance_components_figure(
        frequency=frequency,
        receptances={"wheel": values},
        components=("zz", "yz", "xx"),
        marks={"2,0,a": 440.0, "close": 441.0, "outside": 1e4},
        title="100 $",
    )
    magnitude, phase, cross, cross_phase, empty, _ = drawn(figure).axes
    np.testing.assert_allclose(curve(magnitude, "wheel")[1], np.abs(values[:, 2, 2]))
    np.testing.assert_allclose(curve(cross, "wheel")[1], np.abs(values[:, 1, 2]))
    assert np.all(phase.lines[0].get_ydata() < 0.0)
    np.testing.assert_allclose(cross_phase.lines[0].get_ydata(), np.degrees(np.angle(values[:, 1, 2])))
    assert not [line for line in empty.lines if line.get_label() == "wheel"]
    assert [text.get_text() for text in magnitude.texts] == ["2,0,a"]
    assert len(cross.texts) == 0
    assert len([line for line in cross.lines if line.get_linestyle() == ":"]) == 2
    assert magnitude.get_ylabel() == r"$|\alpha_{zz}|$ / (m/N)"
    with pytest.raises(ValueError, match='component "zq" is refused'):
        receptance_components_figure(frequency=frequency, receptances={}, components=("zq",), title="")
    with pytest.raises(ValueError, match="at most 4"):
        receptance_components_figure(frequency=frequency, receptances=dict.fromkeys("abcde", values), title="")


@pytest.fixture(scope="module")
def shapes():
    return wheel_shapes(load_section("synthetic-c20", element_size=0.02), **STEEL, max_frequency=1300.0)


def test_wheel_modes(shapes):
    figure = drawn(wheel_modes_figure(shapes, names=["(2,0,a)", "0,c"], title="two"))
    panels = [axis for axis in figure.axes if axis.get_title()]
    by_name = {mode.name: mode for mode in shapes.modes}
    assert [panel.get_title().split("\n")[0] for panel in panels] == [
        f"({name})  {by_name[name].frequency:.0f} Hz" for name in ("2,0,a", "0,c")
    ]
    assert panels[1].get_title().endswith("r 0, c 100, a 0")
    # The rest position: tread (and flange, at the left) below the hub.
    rest = next(item for item in panels[0].collections if isinstance(item, LineCollection))
    points = np.concatenate(rest.get_segments())
    assert points[:, 1].min() == pytest.approx(-1e3 * shapes.body.points[:, 0].max())
    lowest = points[np.argmin(points[:, 1])]
    assert lowest[0] < 0.0
    with pytest.raises(ValueError, match='no mode "9,9,a"; it has '):
        wheel_modes_figure(shapes, names=["9,9,a"])
    with pytest.raises(ValueError, match="0 modes are refused"):
        wheel_modes_figure(shapes, names=[])


def test_all_wheel_modes_are_drawn_by_default(shapes):
    figure = wheel_modes_figure(shapes)
    assert len([axis for axis in figure.axes if axis.get_title()]) == len(shapes.modes)


@pytest.fixture(scope="module")
def bar():
    outline = np.array([[-0.03, 0.0], [0.03, 0.0], [0.03, 0.1], [-0.03, 0.1]])
    matrices = section_matrices(
        RailSection(outline), material=Material(**STEEL, loss_factor=0.0), pad=None, contact_position=0.0, size=0.03
    )
    return matrices, disperse(matrices, np.linspace(0.1, 8.0, 9), number=4)


def test_dispersion(bar):
    _, dispersion = bar
    (axis,) = drawn(dispersion_figure(dispersion, cut_ons=[0.0, 900.0], highest=2000.0)).axes
    for i, name in enumerate(dispersion.names):
        frequency, wavenumber = curve(axis, name)
        np.testing.assert_array_equal(frequency, dispersion.frequency[:, i])
        np.testing.assert_array_equal(wavenumber, dispersion.wavenumber)
    assert [text.get_text() for text in axis.texts] == ["900 Hz"]
    assert axis.get_xlim() == (0.0, 2000.0)


def test_wave_shapes(bar):
    matrices, dispersion = bar
    figure = drawn(wave_shapes_figure(matrices, dispersion, wavenumber=5.1))
    titles = [axis.get_title() for axis in figure.axes if axis.get_title()]
    at = int(np.argmin(np.abs(dispersion.wavenumber - 5.1)))
    order = np.argsort(dispersion.frequency[at])
    assert titles == [f"{dispersion.names[i]}\n{dispersion.frequency[at, i]:.0f} Hz" for i in order]
    # The vertical bending wave moves up or down as a whole, not sideways.
    panel = next(axis for axis in figure.axes if axis.get_title().startswith("vertical bending"))
    rest, moved = (
        np.concatenate(item.get_segments()) for item in panel.collections if isinstance(item, LineCollection)
    )
    shift = np.abs((moved - rest).mean(axis=0))
    assert shift[1] > 5.0  # mm in the drawing
    assert shift[0] < 1e-3 * shift[1]


def test_components_of_greens_functions():
    dt, n = 1e-4, 200
    values = np.zeros((n, 3, 3))
    values[:, 2, 2] = 1e-9 * np.exp(-np.arange(n) / 50)
    figure = drawn(greens_components_figure(functions={"wheel": values}, dt=dt, shown=0.01, title=""))
    axis = figure.axes[8]
    time, shown = curve(axis, "wheel")
    np.testing.assert_allclose(time, np.arange(1, 101) * 0.1)
    np.testing.assert_allclose(shown, values[1:101, 2, 2] / dt * 1e6)
    assert axis.get_title(loc="left") == "$g_{zz}$"
    assert [text.get_text() for text in figure.axes[0].texts] == ["zero"]
    with pytest.raises(ValueError, match="at most 4"):
        greens_components_figure(functions=dict.fromkeys("abcde", values), dt=dt, title="")


def stick_slip(side=1.0):
    time = np.arange(4000) * 1e-5
    bound = 20e3 + 2e3 * np.sin(2 * np.pi * 500.0 * time)
    stick = (np.sin(2 * np.pi * 500.0 * time + 0.03) < -0.97).astype(float) * 0.4
    return {"time": time, "force": side * bound * (1 - 0.5 * stick), "bound": bound, "slip_fraction": 1 - stick}


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_stick_slip_cycle(side):
    record = stick_slip(side)
    figure = drawn(squeal_figure(**record, frequency=500.0, start=0.02, title=""))
    whole, cycle, stick = figure.axes
    assert len(whole.lines[0].get_xdata()) == 4000
    time, force = curve(cycle, "lateral force $F_y$")
    assert (time[0], time[-1]) == (pytest.approx(0.0, abs=1e-9), pytest.approx(8.0))
    np.testing.assert_allclose(force, record["force"][2000:2801] / 1e3)
    name = r"traction bound $\mu F_z$" if side > 0 else r"traction bound $-\mu F_z$"
    np.testing.assert_allclose(curve(cycle, name)[1], side * record["bound"][2000:2801] / 1e3)
    assert len(cycle.patches) == 4  # one stretch of sticking in each cycle
    assert max(stick.lines[0].get_ydata()) == pytest.approx(40.0)


def test_no_stick_and_the_last_cycles_by_default():
    record = {**stick_slip(), "slip_fraction": np.ones(4000)}
    figure = drawn(squeal_figure(**record, frequency=500.0, title=""))
    assert len(figure.axes[1].patches) == 0
    assert figure.axes[2].get_xlabel() == "Time after 0.03199 s / ms"


def test_spectrum_names_the_strongest_line_and_the_modes():
    dt = 1e-4
    force = 20e3 + 1e3 * np.sin(2 * np.pi * 1250.0 * np.arange(8000) * dt)
    (axis,) = drawn(
        squeal_spectrum_figure(force=force, dt=dt, modes={"3,0,a": 1200.0, "9,0,a": 7e3}, highest=4e3, title="")
    ).axes
    assert [text.get_text() for text in axis.texts] == ["1250 Hz", "(3,0,a)"]
    frequency, level = (np.asarray(values) for values in axis.lines[0].get_data())
    assert level.max() == pytest.approx(20 * np.log10(1e3 / np.sqrt(2)), abs=0.01)
    assert frequency[np.argmax(level)] == pytest.approx(1.25)
    with pytest.raises(ValueError, match="15 samples are too few"):
        squeal_spectrum_figure(force=force[:15], dt=dt, title="")
