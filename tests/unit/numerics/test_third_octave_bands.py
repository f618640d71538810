import numpy as np
import pytest

from wheelrail.numerics.third_octave_bands import band_edges, band_numbers, centres_between, exact_centres

NOMINAL = [1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8, 10]


def test_nominal_values_are_consecutive_bands():
    np.testing.assert_array_equal(band_numbers(np.array(NOMINAL)), np.arange(11))
    np.testing.assert_array_equal(band_numbers(np.array(NOMINAL) * 100), np.arange(20, 31))


def test_exact_values_of_iec_61260():
    # IEC 61260-1:2014, table E.1: 800 Hz nominal is 794.33 Hz, 1250 Hz is 1258.9 Hz, 20 Hz is 19.953 Hz.
    np.testing.assert_allclose(exact_centres(np.array([29, 31, 13])), [794.33, 1258.9, 19.953], rtol=3e-5)


def test_bands_touch():
    lower, upper = band_edges(exact_centres(np.arange(-20, 40)))
    np.testing.assert_allclose(upper[:-1], lower[1:], rtol=1e-14)


def test_centres_between_takes_whole_bands():
    np.testing.assert_allclose(centres_between(90.0, 180.0), [10**2.1, 10**2.2], rtol=1e-14)
    lower, upper = band_edges(np.array([100.0, 10**2.3]))
    np.testing.assert_allclose(centres_between(lower[0], upper[1]), 10.0 ** np.array([2.0, 2.1, 2.2, 2.3]), rtol=1e-14)
    assert centres_between(100.0, 105.0).shape == (0,)


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, 1.12])
def test_no_band_centre(value):
    with pytest.raises(ValueError, match="band"):
        band_numbers(np.array([value]))
