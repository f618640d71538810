"""What the contact sees of wheel and rail, and how a lateral shift changes it."""

import numpy as np
import pytest

from wheelrail.case import parse_case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.cosimulation import CoSimulation
from wheelrail.interaction.inputs import Inputs
from wheelrail.interaction.start import start
from wheelrail.interaction.state import FORCE
from wheelrail.interaction.step import step
from wheelrail.interaction.surfaces import Surfaces, total_shift

CASE = """
[simulation]
speed = 20.0
dx = 1e-3
duration = 0.1
start_position = 0.0
[wheel]
model = "rigid"
radius = 0.46
[track]
model = "rigid"
[contact]
{contact}
rail_radius = 0.3
youngs_modulus = 207e9
poisson_ratio = 0.3
[load]
preload = 65e3
coupling = "{coupling}"
{excitation}
"""
HALF_SPACE = 'normal = "half-space"\ndy = 1e-3\nlength = 17e-3\nwidth = 15e-3'
WINKLER = 'normal = "winkler"\nlength = 21e-3'
# 10 um deep in the middle, 10 mm wide, without end along the rail as far as the run goes.
GROOVE = """
[[excitation]]
type = "dent"
on = "{on}"
depth = 10e-6
length = 2.0
width = 10e-3
{place}
lateral_position = {y}
"""
RAIL = GROOVE.format(on="rail", place="position = 0.0", y="{y}")
WHEEL = GROOVE.format(on="wheel", place="angle = 0.0", y="{y}")


def model(contact=HALF_SPACE, coupling="load", excitation=""):
    return build_model(parse_case(CASE.format(contact=contact, coupling=coupling, excitation=excitation)))


def heights(built, shift=0.0, index=0):
    surfaces = Surfaces(built)
    surfaces.move(built, shift)
    return surfaces.heights(built, index).copy()


def test_one_row_where_nothing_differs_across():
    built = model(excitation='[[excitation]]\ntype = "sinusoid"\namplitude = 1e-5\nwavelength = 0.05')
    line = heights(built, index=12)
    assert line.shape == (17,)
    np.testing.assert_allclose(line, 1e-5 * np.sin(2 * np.pi * (12 + np.arange(-8, 9)) * 1e-3 / 0.05), rtol=1e-12)
    np.testing.assert_array_equal(heights(built.configured(roughness_scale=3.0), index=12), 3.0 * line)


@pytest.mark.parametrize("y", [0.0, 2e-3])
def test_rows_see_the_surface_beside_the_contact_point(y):
    seen = heights(model(excitation=RAIL.format(y=y)))
    assert seen.shape == (15, 17)
    offset = np.arange(-7, 8) * 1e-3
    r = np.minimum(np.abs(offset - y) / 5e-3, 1.0)
    # A table of 41 lines over the width: achieved 1.5e-8 of 10e-6 m.
    np.testing.assert_allclose(seen[:, 8], -5e-6 * (1 + np.cos(np.pi * r)), rtol=0, atol=2e-8)


def test_a_shift_of_the_wheel_moves_the_contact_on_the_wheel_alone():
    on_rail, on_wheel = model(excitation=RAIL.format(y=0.0)), model(excitation=WHEEL.format(y=0.0))
    np.testing.assert_array_equal(heights(on_rail, 2e-3), heights(on_rail))
    moved = heights(on_wheel, 2e-3)
    # The wheel goes to the field side by 2 rows, and with it the groove.
    np.testing.assert_allclose(moved[2:], heights(on_wheel)[:-2], rtol=0, atol=1e-20)
    assert np.abs(moved - heights(on_wheel)).max() > 3e-6


def test_a_bedding_sees_the_line_at_the_contact_point():
    built = model(contact=WINKLER, excitation=WHEEL.format(y=1e-3))
    assert heights(built).shape == (21,)
    for shift in (0.0, 1e-3, -1e-3):
        r = abs(-shift - 1e-3) / 5e-3
        assert heights(built, shift)[10] == pytest.approx(-5e-6 * (1 + np.cos(np.pi * r)), abs=2e-8)


def test_lateral_position_and_a_wheel_that_the_vehicle_moves():
    built = model(contact=WINKLER, excitation=WHEEL.format(y=1e-3))
    assert heights(built.configured(lateral_position=2e-3))[10] == heights(built, -2e-3)[10]
    inputs = Inputs(lateral_shift=1e-3, wheel_y=5e-4)
    assert total_shift(built, inputs) == 1e-3
    assert total_shift(built.configured(coupling="displacement"), inputs) == 1.5e-3


def test_the_shift_is_a_live_input():
    built = model(coupling="displacement", excitation=WHEEL.format(y=0.0))
    inputs = Inputs(wheel_z=8e-5)
    state = start(built, inputs)
    in_groove = state.block[FORCE]
    step(built, state, Inputs(wheel_z=8e-5, lateral_shift=20e-3))
    smooth = start(model(coupling="displacement"), inputs).block[FORCE]
    assert state.block[FORCE] == pytest.approx(smooth, rel=1e-12)  # the groove is elsewhere: nothing left of it
    assert in_groove < 0.95 * smooth
    step(built, state, inputs)
    assert state.block[FORCE] == pytest.approx(in_groove, rel=2e-3)  # one step of the dent further along
    place = state.surfaces.place
    assert (place.y_wheel, place.y_rail, place.rolling_radius) == (0.0, 0.0, 0.46)


def test_a_run_continues_bit_for_bit_whatever_the_work_space_holds():
    built = model(excitation=WHEEL.format(y=0.0))
    run = CoSimulation(built)
    run.set_inputs(lateral_shift=1e-3)
    run.advance(1e-3)
    saved = run.save()
    run.set_inputs(lateral_shift=2e-3)
    run.advance(1e-3)
    digest = run.digest()
    run.set_inputs(lateral_shift=-5e-3)
    run.advance(1e-3)
    run.load(saved)
    run.set_inputs(lateral_shift=2e-3)
    run.advance(1e-3)
    assert run.digest() == digest
    other = CoSimulation(built)
    other.load(saved)
    other.set_inputs(lateral_shift=2e-3)
    other.advance(1e-3)
    assert other.digest() == digest
    assert other.output("contact_y_wheel") == -2e-3
    assert (other.output("contact_points"), other.output("missed_overlap")) == (1, 0.0)
