import json
import math
import pickle

import numpy as np
import pytest

from wheelrail.errors import ExcitationRangeError
from wheelrail.excitation.coherent_spectrum import CoherentSpectrum
from wheelrail.excitation.line import Line
from wheelrail.excitation.spectrum_line import SpectrumLine
from wheelrail.excitation.surface_lines import SurfaceLines

DX = 1e-3
LATERAL = np.array([-6e-3, -2e-3, 4e-3])


def surface(*, count=50, periodic=True, on="rail", first_index=0):
    # Heights that tell line and node apart.
    values = 1e-6 * (np.arange(count)[None, :] + 1000.0 * np.arange(3)[:, None])
    return SurfaceLines(
        values=values, lateral=LATERAL, first_index=first_index, dx=DX, periodic=periodic, on=on, name="three lines"
    )


def window(source, first, y_wheel, y_rail, nodes=11):
    out = np.zeros((len(y_rail), nodes))
    source.add_surface(first, np.asarray(y_wheel), np.asarray(y_rail), out)
    return out


def recipe(**changes):
    keys = {
        "wavelengths": 10.0 ** (-np.arange(5, 22) / 10.0),
        "levels": np.linspace(10.0, -6.0, 17),
        "lateral": LATERAL,
        "decay": 0.3,
        "length": 4.0,
        "seed": 7,
        "dx": DX,
        "on": "rail",
        "name": "random lines",
    }
    return CoherentSpectrum(**(keys | changes))


def test_on_a_line_its_heights_between_lines_linear_beyond_the_outermost():
    source = surface()
    y = np.array([-0.02, -6e-3, -4e-3, -2e-3, -0.5e-3, 4e-3, 0.03])
    number = [0.0, 0.0, 0.5, 1.0, 1.25, 2.0, 2.0]
    expected = 1e-6 * (np.arange(5, 16)[None, :] + 1000.0 * np.array(number)[:, None])
    np.testing.assert_allclose(window(source, 5, y + 1.0, y), expected, rtol=1e-13)  # achieved 1e-15
    assert source.lateral_range == (-6e-3, 4e-3)
    assert source.across


def test_a_plane_across_is_reproduced_at_any_place():
    # Linear interpolation is exact for heights that are linear in y.
    slope = 0.02
    values = slope * np.repeat(LATERAL[:, None], 30, axis=1)
    source = SurfaceLines(values=values, lateral=LATERAL, first_index=0, dx=DX, periodic=True, on="wheel", name="plane")
    y = np.linspace(-6e-3, 4e-3, 23)
    np.testing.assert_allclose(window(source, 3, y, y + 0.5), slope * y[:, None] * np.ones(11), atol=1e-18)


def test_each_surface_looks_at_its_own_position():
    wheel, rail = np.array([-6e-3]), np.array([4e-3])
    assert window(surface(on="wheel"), 0, wheel, rail)[0, 0] == 0.0
    assert window(surface(on="rail"), 0, wheel, rail)[0, 0] == pytest.approx(2e-3)


@pytest.mark.parametrize("first", [-123, 0, 45, 49, 50, 1_000_007])
def test_periodic_lines_repeat(first):
    source = surface(count=50, first_index=3)
    expected = 1e-6 * ((first - 3 + np.arange(60)) % 50)
    np.testing.assert_array_equal(window(source, first, [0.0], [-6e-3], nodes=60)[0], expected)
    assert source.covered() is None


def test_one_line_is_the_line_all_across():
    heights = np.random.default_rng(1).standard_normal(40)
    line = Line(values=heights, first_index=-5, dx=DX, periodic=False, name="line")
    source = SurfaceLines(
        values=heights[None, :], lateral=[1e-3], first_index=-5, dx=DX, periodic=False, on="rail", name="line"
    )
    expected = np.zeros(11)
    line.add_window(2, expected)
    np.testing.assert_array_equal(window(source, 2, [0.0, 0.0], [-1.0, 1.0]), [expected, expected])


def test_windows_add_up_and_leave_the_range_with_a_message():
    source = surface(count=50, periodic=False, first_index=-10)
    out = np.full((2, 11), 1.0)
    source.add_surface(0, np.zeros(2), LATERAL[:2], out)
    assert out[1, 0] == pytest.approx(1.0 + 1010e-6, rel=1e-15)
    assert source.covered() == (pytest.approx(-0.01), pytest.approx(0.039))
    for first, at in ((-11, "-0.011"), (30, "0.04")):
        before = out.copy()
        with pytest.raises(ExcitationRangeError, match=f"three lines: .*x = {at} m.*-0.01 m to 0.039 m"):
            source.add_surface(first, np.zeros(2), LATERAL[:2], out)
        np.testing.assert_array_equal(out, before)


@pytest.mark.parametrize("source", [surface(), surface(periodic=False, first_index=-4, on="wheel")])
def test_lines_survive_being_taken_apart(source):
    meta, arrays = source.to_parts()
    again = SurfaceLines.from_parts(json.loads(json.dumps(meta)), arrays)
    for other in (again, pickle.loads(pickle.dumps(source))):
        np.testing.assert_array_equal(window(other, 3, LATERAL, LATERAL), window(source, 3, LATERAL, LATERAL))
        assert other.covered() == source.covered()


def test_lines_are_immutable():
    values = np.zeros((3, 20))
    source = SurfaceLines(values=values, lateral=LATERAL, first_index=0, dx=DX, periodic=True, on="rail", name="a")
    values[:] = 1.0
    assert np.all(source.values == 0.0)
    with pytest.raises(ValueError, match="read-only"):
        source.values[0, 0] = 1.0
    assert source.realise(dx=DX, seed_override=4) is source
    with pytest.raises(ValueError, match="made for dx"):
        source.realise(dx=2e-3, seed_override=None)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"lateral": [0.0, 0.0, 1.0]}, "lateral must increase"),
        ({"lateral": [0.0, 1.0]}, "shape"),
        ({"values": np.full((3, 4), np.nan)}, "finite"),
        ({"values": np.zeros((3, 0))}, "n at least 1"),
        ({"dx": 0.0}, "dx"),
        ({"on": "road"}, "'wheel' or 'rail'"),
    ],
)
def test_lines_refuse(changes, message):
    keys = {
        "values": np.zeros((3, 4)), "lateral": LATERAL, "first_index": 0, "dx": DX, "periodic": True, "on": "rail",
        "name": "a",
    }  # fmt: skip
    with pytest.raises(ValueError, match=message):
        SurfaceLines(**(keys | changes))


def test_recipe_is_deterministic_and_survives_being_taken_apart():
    first = recipe().realise(dx=DX, seed_override=None)
    np.testing.assert_array_equal(first.values, recipe().realise(dx=DX, seed_override=None).values)
    for decay in (0.0, 0.3, math.inf):
        source = recipe(decay=decay)
        meta, arrays = source.to_parts()
        again = CoherentSpectrum.from_parts(json.loads(json.dumps(meta, allow_nan=False)), arrays)
        for override in (None, 3):
            np.testing.assert_array_equal(
                again.realise(dx=DX, seed_override=override).values,
                source.realise(dx=DX, seed_override=override).values,
            )


def test_other_seeds_overrides_and_surfaces_give_other_lines():
    lines = [
        recipe(**changes).realise(dx=DX, seed_override=override).values
        for changes in ({}, {"seed": 8}, {"on": "wheel"})
        for override in (None, 0, 7)
    ]
    for i, one in enumerate(lines):
        for other in lines[:i]:
            # 4000 samples of smooth lines: a correlation of 0.4 would be several standard deviations.
            assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.4  # achieved 0.21


@pytest.mark.parametrize("override", [None, 5])
def test_first_line_is_that_of_a_single_spectrum_line(override):
    keys = {key: getattr(recipe(), key) for key in ("wavelengths", "levels", "length", "seed", "dx", "on", "name")}
    single = SpectrumLine(**keys).realise(dx=DX, seed_override=override)
    several = recipe().realise(dx=DX, seed_override=override)
    np.testing.assert_array_equal(several.values[0], single.values)


def test_recipe_must_be_realised_first_and_refuses():
    with pytest.raises(RuntimeError, match="realise"):
        window(recipe(), 0, [0.0], [0.0])
    assert recipe().covered() is None
    assert recipe().across
    assert recipe().lateral_range == (-6e-3, 4e-3)
    for changes, message in (
        ({"decay": -0.1}, "decay"),
        ({"decay": math.nan}, "decay"),
        ({"lateral": [0.0, -1.0]}, "lateral must increase"),
        ({"lateral": []}, "lateral"),
        ({"levels": [1.0]}, "one level"),
        ({"seed": -1}, "seed"),
        ({"length": 1e-3}, "length"),
        ({"on": "road"}, "'wheel' or 'rail'"),
    ):
        with pytest.raises(ValueError, match=message):
            recipe(**changes)
    with pytest.raises(ValueError, match="seed_override"):
        recipe().realise(dx=DX, seed_override=-1)
