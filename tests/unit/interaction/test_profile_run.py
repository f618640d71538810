"""Runs on profiles: the same as crossed cylinders where they are that, and a live lateral shift."""

import numpy as np
import pytest

from wheelrail.case import parse_case
from wheelrail.errors import CaseError, ContactGridError, ParameterError
from wheelrail.interaction.build import build_model, hertz_of
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.model_file import load_model, save_model
from wheelrail.interaction.simulate import simulate

CASE = """
[simulation]
speed = 20.0
dx = 1e-3
duration = 0.01
start_position = 0.0
[wheel]
{wheel}
[track]
model = "rigid"
[contact]
normal = "{normal}"
{grid}
youngs_modulus = 207e9
poisson_ratio = 0.3
{shape}
[load]
preload = 65e3
coupling = "{coupling}"
{excitation}
"""
BUMP = """
[[excitation]]
type = "dent"
on = "rail"
depth = -0.2e-3
length = 2.0
position = 0.0
"""
GRID = "dy = 1e-3\nlength = 21e-3\nwidth = {width}e-3"
ROUND = "rail_radius = 0.3"
CIRCULAR = 'rail_radius = 0.3\nwheel_profile = "{wheel}"\nrail_profile = "circular"\ninclination = {inclination}'
S1002 = 'wheel_profile = "s1002"\nrail_profile = "60e1"\ninclination = 0.025\nlateral_shift = {shift}'
RIGID = 'model = "rigid"\nradius = 0.46'


def model(shape, *, width=19, coupling="load", wheel=RIGID, normal="half-space", excitation=""):
    grid = GRID.format(width=width) if normal == "half-space" else "length = 21e-3"
    return build_model(
        parse_case(
            CASE.format(shape=shape, grid=grid, coupling=coupling, wheel=wheel, normal=normal, excitation=excitation)
        )
    )


def outputs(built, **inputs):
    run = CoSimulation(built)
    run.set_inputs(**inputs)
    run.initialise()
    return run


def test_a_cylinder_on_a_circular_rail_is_a_straight_tread_on_a_round_rail():
    profiles = model(CIRCULAR.format(wheel="cylinder", inclination=0.0))
    plain = model(ROUND)
    a, b = outputs(profiles), outputs(plain)
    assert a.output("contact_y_wheel") == pytest.approx(0.0, abs=1e-15)
    assert a.output("contact_y_rail") == pytest.approx(0.0, abs=1e-15)
    # The circle against its parabola: x^4 / 8 R^3 is 0.02 um at the contact's edge. Achieved 1.2e-4.
    assert a.output("approach") == pytest.approx(b.output("approach"), rel=3e-4)
    assert a.output("pressure_max") == pytest.approx(b.output("pressure_max"), rel=3e-4)
    assert a.output("contact_area") == b.output("contact_area")
    assert hertz_of(parse_case(profiles.case)).approach == pytest.approx(hertz_of(parse_case(plain.case)).approach)


def test_a_cone_rides_where_the_slopes_meet():
    """On a circle of radius R the cone of slope g touches at R g, tilted by atan g; its curvature is cos / r."""
    run = outputs(model(CIRCULAR.format(wheel="cone", inclination=0.0) + "\nconicity = 0.05"))
    assert run.output("contact_angle") == pytest.approx(np.arctan(0.05), rel=1e-6)
    assert run.output("contact_y_rail") == pytest.approx(-0.3 * np.sin(np.arctan(0.05)), rel=1e-6)
    y = run.output("contact_y_wheel")
    assert run.output("rolling_radius") == pytest.approx(0.46 - 0.05 * y, rel=1e-9)
    # Leaning the rail by the cone's angle brings the contact to the crown.
    leaned = outputs(model(CIRCULAR.format(wheel="cone", inclination=np.arctan(0.05)) + "\nconicity = 0.05"))
    assert leaned.output("contact_y_rail") == pytest.approx(0.0, abs=1e-9)


def test_the_load_is_carried_wherever_the_wheel_is():
    built = model(S1002.format(shift=0.0), width=41)
    seen = []
    for shift in (-8e-3, -5e-3, 0.0, 1e-3):
        run = outputs(built, lateral_shift=shift)
        assert run.output("force_z") == pytest.approx(65e3, rel=1e-9)
        assert run.output("solver_residual") < 1e-12
        seen.append(run.output("contact_y_wheel"))
    assert np.all(np.diff(seen) < 0.0)  # the wheel goes to the field side, the contact on it towards the flange
    assert np.ptp(seen) > 20e-3  # the tread's jump


def test_a_live_shift_lifts_the_wheel():
    """In coupling by displacement the wheel stays as high; moved up its flank, it is pressed on the rail by as much."""
    built = model(S1002.format(shift=-5e-3), width=41, coupling="displacement")
    geometry = built.geometry
    rise = geometry.place(-3.5e-3).ride_height - geometry.place(-5e-3).ride_height
    assert abs(rise) > 5e-6
    moved = outputs(built, lateral_shift=-3.5e-3, wheel_z=6e-5)
    there = outputs(
        model(S1002.format(shift=-3.5e-3), width=41, coupling="displacement"),
        lateral_shift=-3.5e-3,
        wheel_z=6e-5 + rise,
    )
    assert moved.output("force_z") == pytest.approx(there.output("force_z"), rel=1e-6)
    added = outputs(built, lateral_shift=-5e-3, wheel_y=1.5e-3, wheel_z=6e-5)
    assert added.output("force_z") == pytest.approx(moved.output("force_z"), rel=1e-12)


def test_a_moving_wheel_continues_bit_for_bit():
    built = model(S1002.format(shift=-2e-3), width=41, wheel='preset = "thesis-1dof"')

    def roll(run, first, last):
        for k in range(first, last):
            run.set_inputs(lateral_shift=-2e-3 - 20e-6 * k)
            run.advance(5e-4)
        return run

    whole = roll(CoSimulation(built), 0, 12)
    half = roll(CoSimulation(built), 0, 6)
    other = CoSimulation(built)
    other.load(half.save())
    assert roll(other, 6, 12).digest() == whole.digest()
    assert whole.output("force_z_min") > 0.0
    assert not whole.warnings


def test_what_is_out_of_reach_is_said():
    with pytest.raises(ContactGridError, match=r"contact.width = 0.0\d+ m may be enough"):
        outputs(model(S1002.format(shift=-3e-3), width=15))
    built = model(S1002.format(shift=0.0), width=41)
    run = CoSimulation(built)
    run.advance(1e-3)
    before = run.digest()
    run.set_inputs(lateral_shift=0.2)
    with pytest.raises(ParameterError, match="lateral_shift"):
        run.advance(1e-3)
    run.set_inputs(lateral_shift=0.0)
    assert run.digest() == before
    (warning,) = outputs(built, lateral_shift=3e-3).warnings  # in the flange's throat
    assert "contact angle is 0.372 rad" in warning


def test_a_second_contact_beside_the_grid_is_reported(caplog):
    wide, narrow = (model(S1002.format(shift=1.9e-3), width=width) for width in (41, 15))
    place = wide.geometry.place(1.9e-3)
    first = next(other for other in place.others if other.gap < 1e-4)
    run, missing = outputs(wide), outputs(narrow)
    assert run.output("contact_points") == missing.output("contact_points") == 2
    assert (run.output("missed_overlap"), run.warnings) == (0.0, [])
    # The overlap of rigid bodies that have approached: the approach less the gap.
    assert missing.output("missed_overlap") == pytest.approx(missing.output("approach") - first.gap, rel=1e-12)
    assert missing.output("missed_overlap") > 30e-6
    (warning,) = missing.warnings
    assert "also touch outside of the potential contact area" in warning
    list(simulate(narrow, duration=0.005, record=["force_z"], block=20))
    assert sum("also touch outside" in record.message for record in caplog.records) == 1
    # With the second contact in the grid, the first one bears less.
    assert run.output("approach") < missing.output("approach")


@pytest.mark.parametrize("normal", ["winkler", "hertz"])
def test_ellipses_of_profiles(normal):
    built = model(S1002.format(shift=-10e-3), normal=normal)
    run = outputs(built)
    assert run.output("force_z") == pytest.approx(65e3)
    nearly_flat = CIRCULAR.format(wheel="cylinder", inclination=0.0).replace("0.3", "20.0")
    with pytest.raises(CaseError, match=r'curvature of 0.05 1/m across the rail.*use "half-space"'):
        model(nearly_flat, normal=normal)


def test_model_file(tmp_path):
    built = model(S1002.format(shift=-5e-3), width=41)
    save_model(built, tmp_path / "model")
    again = load_model(tmp_path / "model")
    assert again.fingerprint == built.fingerprint
    a, b = (simulate(m, duration=0.002, record=["force_z", "pressure_max"]).collect() for m in (built, again))
    for name in a:
        np.testing.assert_array_equal(a[name], b[name])


def test_a_live_shift_counts_a_second_contact_as_one_from_the_start():
    """Whatever height the approach counts from, and whatever lies all across both places."""
    overlaps = []
    for reference in (2e-3, 1.75e-3, 0.0, -5e-3):
        for excitation in ("", BUMP):
            # The second place lies beside this narrow grid.
            built = model(S1002.format(shift=reference), width=15, excitation=excitation)
            run = outputs(built, lateral_shift=2e-3)
            assert run.output("contact_points") == 2
            overlaps.append(run.output("missed_overlap"))
    assert overlaps[0] > 50e-6
    # Achieved 7 nm with the bump, whose top is not quite level, 1e-20 m between the reference shifts.
    np.testing.assert_allclose(overlaps, overlaps[0], rtol=0, atol=20e-9)


def test_nothing_touches_where_the_wheel_is_lifted():
    run = outputs(model(ROUND, coupling="displacement"), wheel_z=-1e-3)
    assert (run.output("force_z"), run.output("contact_points")) == (0.0, 0)


def test_a_hertz_contact_rises_with_a_live_shift_and_says_what_it_keeps():
    hertz = model(S1002.format(shift=-5e-3), normal="hertz", coupling="displacement")
    run = outputs(hertz, wheel_z=6e-5)
    assert not run.warnings
    start_force = run.output("force_z")
    rise = hertz.geometry.place(-6e-3).lift
    assert rise < -5e-6
    moved = outputs(hertz, lateral_shift=-6e-3, wheel_z=6e-5 - rise)
    assert moved.output("force_z") == pytest.approx(start_force, rel=1e-12)
    assert any("keeps the radii" in warning for warning in moved.warnings)
