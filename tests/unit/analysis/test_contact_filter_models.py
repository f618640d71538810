"""Analytic and printed contact filters."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j1

from wheelrail.analysis.contact_filter_models import (
    averaging_filter,
    cnossos_filters,
    enclosing_filters,
    patch_filter,
    remington_filter,
)
from wheelrail.errors import ParameterError

WAVES = np.geomspace(2.1e-3, 1.0, 30)
A = 6e-3


def test_averaging_filter_is_the_mean_of_a_sinusoid():
    for wavelength, level in zip(WAVES, averaging_filter(WAVES, half_length=A), strict=True):
        mean = quad(lambda x, k=2.0 * np.pi / wavelength: np.cos(k * x), -A, A, limit=200)[0] / (2.0 * A)
        assert level == pytest.approx(20.0 * np.log10(abs(mean)), abs=1e-6)


@pytest.mark.parametrize("alpha", [0.1, 2.0, 10.0])
def test_remington_filter_is_the_integral_over_the_angle(alpha):
    waves = WAVES[4::5]
    for wavelength, level in zip(waves, remington_filter(waves, radius=A, alpha=alpha), strict=True):
        size = 2.0 * np.pi * A / wavelength
        integral, _ = quad(lambda psi, s=size: j1(s / np.cos(psi)) ** 2, 0.0, np.arctan(alpha), limit=500, epsabs=1e-7)
        assert level == pytest.approx(10.0 * np.log10(4.0 / alpha * integral / size**2), abs=1e-4)


def test_a_disc_of_fully_correlated_roughness():
    # Mean of cos(kx) over a disc: 2 J1(ka) / ka, the limit of Remington's filter for alpha -> 0.
    size = 2.0 * np.pi * A / WAVES
    expected = 20.0 * np.log10(np.abs(2.0 * j1(size) / size))
    smooth = size < 3.0  # before the first zero at 3.83
    found = remington_filter(WAVES, radius=A, alpha=1e-3)
    np.testing.assert_allclose(found[smooth], expected[smooth], atol=1e-4)


def test_less_correlated_roughness_is_filtered_more():
    long = WAVES > 2.5 * A
    levels = [remington_filter(WAVES[long], radius=A, alpha=alpha) for alpha in (0.1, 1.0, 3.0, 10.0, 30.0)]
    assert np.all(np.diff(levels, axis=0) < 0.0)


def test_filters_leave_long_waves_alone():
    for level in (
        averaging_filter([10.0], half_length=A),
        patch_filter([10.0], radius=A),
        remington_filter([10.0], radius=A, alpha=10.0),
    ):
        assert abs(level[0]) < 1e-3


def test_closed_form_of_the_patch():
    # ka = 1: 1 / (1 + pi / 4).
    assert patch_filter([2.0 * np.pi * A], radius=A)[0] == pytest.approx(-2.51735, abs=1e-5)


def test_printed_filters_grow_with_the_contact():
    tables = cnossos_filters()
    sizes = [(table.load, table.wheel_diameter) for table in tables]
    assert sizes == [(50e3, 0.36), (25e3, 0.92), (50e3, 0.68), (50e3, 0.92), (100e3, 0.92)]
    levels = np.array([table.levels for table in tables])
    assert levels.shape == (5, 35)
    assert np.all(np.diff(levels, axis=1) <= 0.0)
    # A larger contact filters more where its filter is not flat; printed exceptions are up to 0.5 dB.
    assert np.all(np.diff(levels, axis=0) < 0.51)


def test_a_table_between_its_bands():
    table = cnossos_filters()[3]
    assert table.at(10.0**-1.4)[()] == pytest.approx(-1.3)
    assert table.at(10.0**-1.45)[()] == pytest.approx(0.5 * (-1.3 - 3.5))
    assert np.all(np.isnan(table.at([3.0, 0.5e-3])))


@pytest.mark.parametrize(
    ("load", "diameter", "expected"),
    [
        (65e3, 0.92, (50e3, 100e3)),
        (50e3, 0.92, (50e3, 50e3)),
        (200e3, 0.92, (100e3, 100e3)),
        (10e3, 0.3, (50e3, 50e3)),
    ],
)
def test_enclosing_filters(load, diameter, expected):
    assert tuple(table.load for table in enclosing_filters(load=load, wheel_diameter=diameter)) == expected


@pytest.mark.parametrize(
    "call",
    [
        lambda: averaging_filter([0.0], half_length=A),
        lambda: patch_filter([0.1], radius=-1.0),
        lambda: remington_filter([0.1], radius=A, alpha=0.0),
        lambda: enclosing_filters(load=float("nan"), wheel_diameter=0.92),
    ],
)
def test_refused(call):
    with pytest.raises(ParameterError):
        call()
