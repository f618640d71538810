import json
import math
import pickle

import numpy as np
import pytest

from wheelrail.errors import ExcitationRangeError, ModelFileError
from wheelrail.excitation.sources import Line, Sinusoid, SpectrumLine, source_from_parts

DX = 1e-3


def window(source, first, count=19):
    out = np.zeros(count)
    source.add_window(first, out)
    return out


def spectrum_line(**changes):
    keys = {
        "wavelengths": 10.0 ** (-np.arange(5, 22) / 10.0),
        "levels": np.linspace(10.0, -6.0, 17),
        "length": 4.0,
        "seed": 7,
        "dx": DX,
        "on": "rail",
        "name": "random line",
    }
    return SpectrumLine(**(keys | changes))


@pytest.mark.parametrize("wavelength", [0.05, 0.0512345678, 1.0 / 3.0, 2.5e-3])
@pytest.mark.parametrize("first", [0, 13, -1234, 98_765_432])
def test_sinusoid_is_exact_at_any_distance(wavelength, first):
    source = Sinusoid(amplitude=1e-5, wavelength=wavelength, dx=DX)
    # Reference in whole numbers of a decimal grid: nodes 1e-3 m, wavelength in its printed decimals.
    from fractions import Fraction

    ratio = Fraction("0.001") / Fraction(repr(wavelength))
    expected = [1e-5 * math.sin(2.0 * math.pi * float((first + j) * ratio % 1)) for j in range(19)]
    np.testing.assert_allclose(window(source, first), expected, rtol=0, atol=1e-19)  # achieved 1e-20


def test_sinusoid_starts_at_zero_and_rises_at_the_sleeper():
    source = Sinusoid(amplitude=2e-6, wavelength=0.04, dx=DX)
    heights = window(source, 0, 11)
    assert heights[0] == 0.0
    assert heights[10] == pytest.approx(2e-6, rel=1e-15)
    assert source.covered() is None
    assert source.realise(dx=DX, seed_override=3) is source


def test_windows_add_up():
    a = Sinusoid(amplitude=1e-5, wavelength=0.05, dx=DX)
    b = Line(values=np.arange(100.0), first_index=-10, dx=DX, periodic=False, name="b")
    out = np.full(19, 2.0)
    a.add_window(5, out)
    b.add_window(5, out)
    np.testing.assert_allclose(out, 2.0 + window(a, 5) + np.arange(15.0, 34.0), rtol=1e-15)


@pytest.mark.parametrize("first", [0, 5, -3, -7 * 31, 10**9 + 3, -(10**9)])
@pytest.mark.parametrize("count", [1, 19, 5000])
def test_periodic_line_repeats_for_every_index(first, count):
    values = np.random.default_rng(1).standard_normal(31)
    line = Line(values=values, first_index=4, dx=DX, periodic=True, name="p")
    np.testing.assert_array_equal(window(line, first, count), values[(first - 4 + np.arange(count)) % 31])
    assert line.covered() is None


def test_line_that_stops_names_position_range_and_remedy():
    line = Line(values=np.ones(101), first_index=1300, dx=DX, periodic=False, name="measured line rail.csv")
    assert line.covered() == pytest.approx((1.3, 1.4))
    np.testing.assert_array_equal(window(line, 1300), np.ones(19))
    np.testing.assert_array_equal(window(line, 1382), np.ones(19))
    for first, where in ((1383, "x = 1.401 m"), (1299, "x = 1.299 m")):
        out = np.zeros(19)
        with pytest.raises(ExcitationRangeError) as caught:
            line.add_window(first, out)
        message = str(caught.value)
        for part in ("rail.csv", where, "1.3 m to 1.4 m", "start_position", 'beyond_end = "repeat"', "shorter"):
            assert part in message
        assert not out.any()


def test_sources_are_immutable_and_keep_no_reference():
    values = np.zeros(40)
    line = Line(values=values, first_index=0, dx=DX, periodic=True, name="p")
    values[:] = 1.0
    assert not window(line, 0).any()
    with pytest.raises(ValueError, match="read-only"):
        line.values[0] = 1.0
    with pytest.raises(AttributeError):
        line.first_index = 3
    with pytest.raises(ValueError, match="read-only"):
        spectrum_line().levels[0] = 1.0


@pytest.mark.parametrize(
    "source",
    [
        Sinusoid(amplitude=1e-5, wavelength=0.05, dx=DX),
        Sinusoid(amplitude=1e-5, wavelength=0.0512345678, dx=DX),
        Line(values=np.random.default_rng(2).standard_normal(50), first_index=-7, dx=DX, periodic=True, name="p"),
        Line(values=np.random.default_rng(3).standard_normal(50), first_index=-7, dx=DX, periodic=False, name="q"),
        spectrum_line(),
    ],
    ids=lambda source: source.kind,
)
def test_parts_round_trip(source):
    meta, arrays = source.to_parts()
    back = source_from_parts(json.loads(json.dumps(meta)), arrays)
    again = pickle.loads(pickle.dumps(source))
    for copy in (back, again):
        assert type(copy) is type(source)
        a, b = source.realise(dx=DX, seed_override=None), copy.realise(dx=DX, seed_override=None)
        assert a.covered() == b.covered()
        np.testing.assert_array_equal(window(a, 3), window(b, 3))


@pytest.mark.parametrize(
    ("meta", "arrays"),
    [
        ({"kind": "noise"}, {}),
        ({}, {}),
        ({"kind": ["line"]}, {}),
        ({"kind": "line", "first_index": 0, "dx": DX, "periodic": True, "name": "p"}, {}),
        ({"kind": "line", "first_index": 0, "dx": DX, "periodic": True, "name": "p"}, {"values": np.array([np.nan])}),
        ({"kind": "sinusoid", "amplitude": "x", "wavelength": 0.1, "dx": DX}, {}),
        ({"kind": "sinusoid", "amplitude": 1.0, "wavelength": 1e-3, "dx": DX}, {}),
    ],
)
def test_damaged_parts_are_a_model_file_error(meta, arrays):
    with pytest.raises(ModelFileError):
        source_from_parts(meta, arrays)


def test_another_grid_is_refused():
    with pytest.raises(ValueError, match="dx"):
        Sinusoid(amplitude=1e-5, wavelength=0.05, dx=DX).realise(dx=2e-3, seed_override=None)


def test_spectrum_must_be_realised_first():
    with pytest.raises(RuntimeError, match="realise"):
        window(spectrum_line(), 0)


def test_same_seed_same_bytes():
    a = spectrum_line().realise(dx=DX, seed_override=None)
    b = spectrum_line().realise(dx=DX, seed_override=None)
    assert a.values.tobytes() == b.values.tobytes()
    c = spectrum_line().realise(dx=DX, seed_override=5)
    d = spectrum_line().realise(dx=DX, seed_override=5)
    assert c.values.tobytes() == d.values.tobytes()
    assert a.values.tobytes() != c.values.tobytes()


def test_lines_of_other_seed_override_or_surface_are_independent():
    lines = [
        spectrum_line(seed=seed, on=on).realise(dx=DX, seed_override=override).values
        for seed in (0, 1, 2)
        for on in ("rail", "wheel")
        for override in (None, 0, 1, 2)
    ]
    correlation = np.corrcoef(lines) - np.eye(len(lines))
    # Some 30 harmonics carry most of the power: independent lines scatter by about 0.2; equal ones would give 1.
    assert np.max(np.abs(correlation)) < 0.6  # achieved 0.32 among 276 pairs


def test_spectrum_line_repeats_without_a_step_at_the_seam():
    line = spectrum_line().realise(dx=DX, seed_override=None)
    assert line.periodic
    assert line.first_index == 0
    assert line.values.shape == (4000,)
    second = np.diff(window(line, 0, 4000), n=2)
    seam = np.diff(window(line, 3990, 20), n=2)
    assert np.max(np.abs(seam)) <= np.max(np.abs(second))
