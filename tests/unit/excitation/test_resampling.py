import numpy as np
import pytest

from wheelrail.excitation.resampling import is_equidistant, resample

DX = 1e-3
EDGE = 40  # nodes near the ends where the extension of the line shows


def wave(x, wavelength):
    return 1e-5 * np.sin(2.0 * np.pi * x / wavelength + 0.3)


def onto_grid(x, r):
    first = int(np.ceil(x[0] / DX))
    count = int(np.floor(x[-1] / DX)) - first + 1
    nodes = (first + np.arange(count)) * DX
    return nodes, resample(x, r, dx=DX, first=first, count=count, period=None)


def amplitude_and_phase(nodes, r, wavelength):
    basis = np.column_stack((np.sin(2 * np.pi * nodes / wavelength), np.cos(2 * np.pi * nodes / wavelength)))
    (a, b), *_ = np.linalg.lstsq(basis, r, rcond=None)
    return np.hypot(a, b), np.arctan2(b, a)


@pytest.mark.parametrize("spacing", [1e-4, 3.3e-4, 0.7e-3, 1e-3, 1.7e-3, 3e-3])
@pytest.mark.parametrize(
    ("points", "tolerance"),
    [(2.5, 2e-4), (4.0, 1e-4), (10.0, 1e-5), (100.0, 1e-5)],  # achieved 9.8e-5, 5.7e-6, 9e-7, 2.3e-6
)
def test_sine_below_nyquist_is_kept(spacing, points, tolerance):
    wavelength = points * max(spacing, DX)
    x = 0.086e-3 + np.arange(int(3.0 / spacing)) * spacing
    nodes, r = onto_grid(x, wave(x, wavelength))
    inner = slice(2 * EDGE * max(1, round(spacing / DX)), -2 * EDGE * max(1, round(spacing / DX)))
    assert np.max(np.abs(r - wave(nodes, wavelength))[inner]) < tolerance * 1e-5
    amplitude, phase = amplitude_and_phase(nodes[inner], r[inner], wavelength)
    assert amplitude == pytest.approx(1e-5, rel=tolerance)
    assert phase == pytest.approx(0.3, abs=tolerance)


@pytest.mark.parametrize("spacing", [1e-4, 3.3e-4])
@pytest.mark.parametrize("wavelength", [1.99e-3, 1.5e-3, 1.001e-3, 0.7e-3])
def test_sine_above_nyquist_is_removed(spacing, wavelength):
    # Taken point by point, the wave of 1.001 mm would turn into one of 1 m with full amplitude.
    x = np.arange(int(3.0 / spacing)) * spacing
    _, r = onto_grid(x, wave(x, wavelength))
    suppression = 20.0 * np.log10(np.max(np.abs(r[EDGE:-EDGE])) / 1e-5)
    assert suppression < -70.0  # dB; achieved -78 at 1.99 mm, below -110 at 1.5 mm


def test_coarse_file_gets_no_images():
    # File at 4 mm, wave of 10 mm: its image on the grid would be a wave of 6.67 mm.
    x = np.arange(1000) * 4e-3
    nodes, r = onto_grid(x, wave(x, 10e-3))
    image, _ = amplitude_and_phase(nodes[400:-400], r[400:-400] - wave(nodes[400:-400], 10e-3), 1.0 / 150.0)
    assert 20.0 * np.log10(image / 1e-5) < -70.0  # achieved -94 dB


@pytest.mark.parametrize(("wavelength", "tolerance"), [(8e-3, 0.01), (20e-3, 1e-3), (100e-3, 1e-5)])
def test_sine_from_uneven_points(wavelength, tolerance):
    # Mean spacing 0.8 mm, varying by +-40 %; achieved 1.3e-3, 3.2e-5, 1.5e-6.
    steps = 0.8e-3 * (1.0 + 0.4 * np.random.default_rng(3).uniform(-1.0, 1.0, 4000))
    x = np.cumsum(steps)
    assert not is_equidistant(x)
    nodes, r = onto_grid(x, wave(x, wavelength))
    assert np.max(np.abs(r - wave(nodes, wavelength))[EDGE:-EDGE]) < tolerance * 1e-5


@pytest.mark.parametrize("spacing", [3.3e-4, 1.7e-3])
def test_straight_line_is_exact_up_to_the_ends(spacing):
    x = 0.012 + np.arange(2000) * spacing
    nodes, r = onto_grid(x, 2e-3 * x - 1e-4)
    np.testing.assert_allclose(r, 2e-3 * nodes - 1e-4, rtol=0, atol=1e-15)


def test_ends_of_longer_waves():
    x = np.arange(9000) * 3.3e-4
    nodes, r = onto_grid(x, wave(x, 0.03))
    assert np.max(np.abs(r - wave(nodes, 0.03))) < 0.001 * 1e-5  # achieved 1.4e-4


def test_file_on_the_grid_is_taken_as_it_stands():
    r = np.random.default_rng(5).standard_normal(500)
    x = (np.arange(500) + 40) * DX
    np.testing.assert_array_equal(resample(x, r, dx=DX, first=45, count=400, period=None), r[5:405])


@pytest.mark.parametrize("count", [500, 700, 4000])
def test_periodic_line_closes(count):
    # Harmonics of the repeat, sampled at another spacing: recovered everywhere, the seam included.
    period = 1000 * DX
    x = np.arange(count) * period / count
    harmonics = (1, 7, 100, 150)
    r = sum(np.sin(2 * np.pi * m * x / period + m) for m in harmonics)
    nodes = np.arange(1000) * DX
    expected = sum(np.sin(2 * np.pi * m * nodes / period + m) for m in harmonics)
    achieved = resample(x, r, dx=DX, first=0, count=1000, period=period)
    np.testing.assert_allclose(achieved, expected, rtol=0, atol=1e-4)  # achieved 2.6e-5


def test_line_shorter_than_the_kernel():
    x = np.arange(20) * 2e-3
    nodes, r = onto_grid(x, 1e-3 * x + 1e-6 * np.sin(2 * np.pi * x / 0.04))
    expected = 1e-3 * nodes + 1e-6 * np.sin(2 * np.pi * nodes / 0.04)
    assert np.max(np.abs(r - expected)) < 0.01e-6  # achieved 0.0011e-6
