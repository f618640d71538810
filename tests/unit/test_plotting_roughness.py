"""Figures of roughness: what is drawn, the falling wavelength, the limit."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from wheelrail.analysis.coherence import BandCoherence
from wheelrail.analysis.roughness_levels import BandLevels, compare_with_limit
from wheelrail.excitation.named_spectra import named_spectrum
from wheelrail.plotting.roughness import coherence_figure, roughness_figure

LIMIT = named_spectrum("iso3095-2013-limit")


def curve(axis, label):
    (line,) = (line for line in axis.lines if line.get_label() == label)
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def test_levels_lines_limit_and_what_is_above():
    above = np.zeros(22)
    above[[3, 10]] = 2.0
    mean = BandLevels(LIMIT.wavelengths, LIMIT.levels - 1.0 + above)
    lines = [BandLevels(LIMIT.wavelengths, mean.levels + shift) for shift in (-0.5, 0.4)]
    comparison = compare_with_limit(mean, LIMIT)
    figure = roughness_figure(mean=mean, lines=lines, limit=comparison, title="a $ b")
    FigureCanvasAgg(figure).draw()
    (axis,) = figure.axes
    x, y = curve(axis, "mean over lines")
    np.testing.assert_allclose(x, 1e3 * LIMIT.wavelengths)
    np.testing.assert_array_equal(y, mean.levels)
    np.testing.assert_array_equal(curve(axis, "limit")[1], LIMIT.levels)
    x, y = curve(axis, "above the limit")
    np.testing.assert_allclose(x, 1e3 * LIMIT.wavelengths[[3, 10]])
    np.testing.assert_allclose(y, LIMIT.levels[[3, 10]] + 1.0)
    # Two lines, the mean, the limit, the marks.
    assert len(axis.lines) == 5
    left, right = axis.get_xlim()
    assert left > 398.0
    assert right < 3.2
    assert {"31.5", "125", "250"} <= {label.get_text() for label in axis.get_xticklabels()}
    assert axis.get_ylabel() == "Roughness level / dB re 1 µm"


def test_a_single_line_without_a_limit_and_with_an_empty_band():
    line = BandLevels(np.array([2.0, 1.0, 0.1]), np.array([20.0, -np.inf, 3.0]))
    figure = roughness_figure(mean=line, lines=[line], title="")
    FigureCanvasAgg(figure).draw()
    (axis,) = figure.axes
    assert len(axis.lines) == 1
    np.testing.assert_array_equal(np.isnan(curve(axis, "line")[1]), [False, True, False])
    assert "1000" in {label.get_text() for label in axis.get_xticklabels()}


def bands_of(lateral):
    centres = 10.0 ** (np.arange(10, 24) / 10.0)
    distance = np.abs(lateral[:, None] - lateral[None, :])
    coherence = np.exp(-0.4 * 2.0 * np.pi * centres[:, None, None] * distance)
    return BandCoherence(centres, coherence, np.full(14, 20.0))


def test_coherence_of_neighbours_and_by_distance():
    lateral = np.array([-4e-3, 0.0, 4e-3, 6e-3])
    bands = bands_of(lateral)
    figure = coherence_figure(bands=bands, lateral=lateral, title="lines")
    FigureCanvasAgg(figure).draw()
    curves, chart = figure.axes[:2]
    x, y = curve(curves, "y = 4 and 6 mm")
    np.testing.assert_allclose(x, 1e3 / bands.centres)
    np.testing.assert_array_equal(y, bands.coherence[:, 2, 3])
    np.testing.assert_allclose(curve(curves, "expected of uncorrelated lines")[1], 0.05)
    assert [label.get_text() for label in chart.get_yticklabels()] == ["2", "4", "6", "8", "10"]
    (mesh,) = chart.collections
    shown = np.asarray(mesh.get_array()).reshape(5, 14)
    np.testing.assert_allclose(shown[1], np.exp(-0.4 * 2.0 * np.pi * bands.centres * 4e-3))
    assert mesh.get_clim() == (0.0, 1.0)
    for axis in (curves, chart):
        left, right = axis.get_xlim()
        assert left > right


def test_coherence_without_positions():
    figure = coherence_figure(bands=bands_of(np.array([0.0, 4e-3])), lateral=None, title="")
    FigureCanvasAgg(figure).draw()
    assert len(figure.axes) == 1
    assert curve(figure.axes[0], "lines 1 and 2")[1][0] == pytest.approx(np.exp(-0.4 * 2.0 * np.pi * 10.0 * 4e-3))
