"""Smooth curves through measured points: known shapes with scatter, origins, directions, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.profile.contact_search import ContactSearch
from wheelrail.profile.named_profiles import named_rail_profile, named_wheel_profile
from wheelrail.profile.smoothing import profile_from_points

S1002, RAIL_60E1 = named_wheel_profile("s1002"), named_rail_profile("60e1")


def points(kind: str, scatter: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Points every 0.1 mm along S1002 with a back of the flange, or along 60E1 with its sides; m."""
    if kind == "wheel":
        y, z = S1002.samples
        back = np.linspace(-20e-3, z[0] - 1e-4, 250)
        y, z = np.concatenate([np.full(250, -70e-3), y]), np.concatenate([back, z])
    else:
        y, z = RAIL_60E1.samples
        side = np.linspace(35e-3, z[0] + 1e-4, 200)
        out = 36e-3 + (side - z[0]) / 20.0
        y, z = np.concatenate([-out, y, out[::-1]]), np.concatenate([side, z, side[::-1]])
    rng = np.random.default_rng(3)
    return y + scatter * rng.standard_normal(len(y)), z + scatter * rng.standard_normal(len(z))


@pytest.mark.parametrize(("kind", "exact"), [("wheel", S1002), ("rail", RAIL_60E1)])
@pytest.mark.parametrize("scatter", [0.0, 5e-6])
def test_known_shapes(kind, exact, scatter):
    curve, notes = profile_from_points(*points(kind, scatter), kind=kind, name="measured")
    assert curve.at(0.0)[0] == pytest.approx(0.0, abs=1e-18)
    y = np.linspace(exact.start + 1e-3, exact.end - 1e-3, 1000)
    normal = np.cos(np.arctan(exact.slope(y)))
    error = (curve.height(y) - exact.height(y)) * normal
    # Where arcs meet, radii change at once, which 5 mm can't follow. Achieved: 8.8e-6 m and 2.1e-6 m rms.
    assert np.abs(error).max() < 10e-6
    assert np.sqrt(np.mean(error**2)) < 2.5e-6
    assert any("takes out" in note for note in notes)
    smooth = np.min(np.abs(y[:, None] - exact.breaks), axis=1) > 6e-3
    worst = np.abs(curve.curvature(y) - exact.curvature(y))[smooth].max()
    # A crown of 300 mm has 3.3 1/m: points with such scatter want a longer cut-off.
    assert worst < (0.5 if scatter == 0.0 else 5.0)


def test_longer_waves_for_a_rougher_measurement():
    y = np.linspace(-8e-3, 8e-3, 100)
    noise = []
    for cutoff in (5e-3, 10e-3):
        curve, _ = profile_from_points(*points("rail", 5e-6), kind="rail", name="r", cutoff_wavelength=cutoff)
        noise.append(np.std(curve.curvature(y) - RAIL_60E1.curvature(y)))
    # White scatter bends as the cut-off to the power -2.5, by 5.7, and the joint at 10 mm is smoothed too: 3.3.
    assert noise[1] < 0.35 * noise[0]


def test_waves_are_halved_at_the_cut_off():
    """A wave on a wide flat arc, whose amplitude is known before and after."""
    amplitude, cutoff = 20e-6, 6e-3
    y = np.linspace(-60e-3, 60e-3, 2401)
    arc = 0.3 - np.sqrt(0.09 - y**2)
    for ratio in (0.5, 1.0, 2.0):
        z = arc + amplitude * np.sin(2.0 * np.pi * y / (ratio * cutoff))
        curve, _ = profile_from_points(y, z, kind="rail", name="wavy", cutoff_wavelength=cutoff)
        inner = np.linspace(-12e-3, 12e-3, 1001)
        wave = curve.height(inner) - (0.3 - np.sqrt(0.09 - inner**2))
        carrier = np.sin(2.0 * np.pi * inner / (ratio * cutoff))
        found = np.sum(wave * carrier) / np.sum(carrier**2) / amplitude
        assert found == pytest.approx(1.0 / (1.0 + ratio**-4), abs=2e-3)  # achieved: 3e-4


def test_contact_of_smoothed_profiles_is_that_of_the_profiles():
    wheel, _ = profile_from_points(*points("wheel"), kind="wheel", name="w", cutoff_wavelength=2e-3)
    rail, _ = profile_from_points(*points("rail"), kind="rail", name="r", cutoff_wavelength=2e-3)
    numbers = {"nominal_radius": 0.46, "inclination": 0.025, "yaw": 0.0}
    one = ContactSearch(wheel=wheel, rail=rail, **numbers)
    other = ContactSearch(wheel=S1002, rail=RAIL_60E1, **numbers)
    for shift in (-8e-3, 0.0, 4.5e-3):
        found, exact = one.find(shift), other.find(shift)
        assert found.ride_height == pytest.approx(exact.ride_height, abs=1e-6)  # achieved: 2.2e-7 m
        assert found.points[0].y_wheel == pytest.approx(exact.points[0].y_wheel, abs=1e-5)


def test_scatter_does_not_lose_the_contact():
    wheel, _ = profile_from_points(*points("wheel", 5e-6), kind="wheel", name="w")
    rail, _ = profile_from_points(*points("rail", 5e-6), kind="rail", name="r")
    pair = ContactSearch(wheel=wheel, rail=rail, nominal_radius=0.46, inclination=0.025, yaw=0.005)
    shifts = np.arange(-12e-3, 6e-3, 5e-5)
    heights = np.array([pair.find(shift).ride_height for shift in shifts])
    slopes = np.diff(heights) / 5e-5
    # Between the slopes of tread and flank.
    assert slopes.min() > -0.01
    assert slopes.max() < 2.85


def test_millimetres_upside_down_mirrored_and_backward():
    y, z = points("wheel")
    plain, _ = profile_from_points(y, z, kind="wheel", name="w")
    turned, notes = profile_from_points(-1e3 * y, -1e3 * z, kind="wheel", name="w")
    at = np.linspace(-65e-3, 55e-3, 200)
    np.testing.assert_allclose(turned.height(at), plain.height(at), atol=1e-9)
    text = " ".join(notes)
    for word in ("mm", "upside down", "mirrored"):
        assert word in text


def test_wheel_that_counts_from_elsewhere_is_placed_by_the_back_of_its_flange():
    y, z = points("wheel")
    curve, notes = profile_from_points(y + 70e-3, z + 0.46, kind="wheel", name="w")
    assert any("70 mm from the back" in note for note in notes)
    at = np.linspace(-60e-3, 50e-3, 100)
    np.testing.assert_allclose(curve.height(at), S1002.height(at), atol=3e-5)  # achieved: 2.2e-5 m, on the flank
    bare = y > -62e-3
    with pytest.raises(DataFileError, match=r"w: the tip of the flange lies at y = 15\.05 mm"):
        profile_from_points(y[bare] + 70e-3, z[bare], kind="wheel", name="w")


def test_rail_that_counts_from_elsewhere_is_placed_by_the_middle_of_its_head():
    y, z = points("rail")
    curve, notes = profile_from_points(y + 36e-3, z - 0.172, kind="rail", name="r")
    assert any("middle of its head, at y = 36.00" in note for note in notes)
    at = np.linspace(-30e-3, 30e-3, 100)
    np.testing.assert_allclose(curve.height(at), RAIL_60E1.height(at), atol=1e-5)


def test_one_side_of_a_rail():
    y, z = points("rail")
    half = y < 12e-3
    curve, notes = profile_from_points(y[half], z[half], kind="rail", name="r")
    assert any("only one side" in note for note in notes)
    assert curve.height(5e-3) == pytest.approx(RAIL_60E1.height(5e-3), abs=1e-6)
    with pytest.raises(DataFileError, match="r: one side of the rail's head"):
        profile_from_points(y[half] + 40e-3, z[half], kind="rail", name="r")


def test_steep_sides_are_cut():
    curve, _ = profile_from_points(*points("rail"), kind="rail", name="r")
    assert -36.5e-3 < curve.start < -35.5e-3
    assert np.abs(curve.slope(np.linspace(curve.start, curve.end, 2000))).max() < 25.0


@pytest.mark.parametrize(
    ("y", "z", "message"),
    [
        (np.linspace(-0.03, 0.03, 10), np.zeros(10), "at least 20 points"),
        (np.linspace(-0.03, 0.03, 50), np.full(50, np.nan), "isn't finite"),
        (np.linspace(-0.03, 0.03, 50), np.zeros(50), "straight line"),
        (np.linspace(-3e3, 3e3, 50), np.linspace(-3e3, 3e3, 50) ** 2, "plausible"),
        (np.linspace(-0.03, 0.03, 50), np.zeros(49), "each with y and z"),
    ],
)
def test_what_is_no_profile_is_refused(y, z, message):
    with pytest.raises(DataFileError, match=f"^bad.csv: .*{message}"):
        profile_from_points(y, z, kind="rail", name="bad.csv")


def test_refused_settings():
    with pytest.raises(ParameterError, match="cutoff_wavelength"):
        profile_from_points(*points("rail"), kind="rail", name="r", cutoff_wavelength=0.5)
    with pytest.raises(ParameterError, match="kind"):
        profile_from_points(*points("rail"), kind="sleeper", name="r")
