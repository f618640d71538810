"""What the laws refuse, and properties of the coefficients that every law relies on."""

from __future__ import annotations

import math

import pytest

from wheelrail.contact.creep.carter import carter
from wheelrail.contact.creep.fastsim import fastsim
from wheelrail.contact.creep.kalker_coefficients import AXIS_RATIO, POISSON_RATIO, TABLE, kalker_coefficients
from wheelrail.contact.creep.linear import linear_creep_force
from wheelrail.contact.creep.shen_hedrick_elkins import shen_hedrick_elkins
from wheelrail.contact.creep.vermeulen_johnson import saturated_fraction

ELASTIC = {"semi_axis_x": 6e-3, "semi_axis_y": 5e-3, "shear_modulus": 80e9, "poisson_ratio": 0.3}
GOOD = {
    "creepage_x": 1e-3,
    "creepage_y": -1e-3,
    "spin": 0.1,
    **ELASTIC,
    "load": 65e3,
    "friction_coefficient": 0.3,
}


@pytest.mark.parametrize("law", [fastsim, shen_hedrick_elkins])
@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("load", 0.0),
        ("friction_coefficient", 0.0),
        ("shear_modulus", -1.0),
        ("semi_axis_x", 0.0),
        ("semi_axis_y", math.nan),
        ("poisson_ratio", 0.6),
    ],
)
def test_what_is_refused(law, name, value):
    with pytest.raises(ValueError, match=name):
        law(**{**GOOD, name: value})


def test_axis_ratio_outside_the_table():
    with pytest.raises(ValueError, match=r"from 0\.1 to 10, this ellipse has 12"):
        kalker_coefficients(semi_axis_x=12.0, semi_axis_y=1.0, poisson_ratio=0.3)
    assert kalker_coefficients(semi_axis_x=10.0, semi_axis_y=1.0, poisson_ratio=0.25).c33 == pytest.approx(0.526)


def test_carter_refuses_a_contact_without_pressure():
    with pytest.raises(ValueError, match="pressure_max"):
        carter(
            creepage_x=1e-3,
            half_length=1e-3,
            pressure_max=0.0,
            friction_coefficient=0.3,
            shear_modulus=80e9,
            poisson_ratio=0.3,
        )


def test_fastsim_needs_a_strip():
    with pytest.raises(ValueError, match="strips"):
        fastsim(**GOOD, strips=0)


def test_coefficients_are_continuous():
    """Across entries and across the ends of the blend of C33; jumps would shake a time integration."""
    for ratio in (*AXIS_RATIO[1:-1], 0.5, 2.0, 0.95, 1.6):
        low, high = (
            kalker_coefficients(semi_axis_x=ratio * factor, semi_axis_y=1.0, poisson_ratio=0.3)
            for factor in (1.0 - 1e-9, 1.0 + 1e-9)
        )
        for name in ("c11", "c22", "c23", "c33"):
            assert getattr(high, name) == pytest.approx(getattr(low, name), rel=1e-7)


def test_table_without_poisson_effect():
    """nu = 0: both directions alike."""
    assert TABLE.shape == (len(AXIS_RATIO), 4, len(POISSON_RATIO))
    assert (TABLE[:, 0, 0] == TABLE[:, 1, 0]).all()


def test_linear_law_is_linear():
    one = linear_creep_force(creepage_x=1e-3, creepage_y=-2e-3, spin=0.2, **ELASTIC)
    two = linear_creep_force(creepage_x=2e-3, creepage_y=-4e-3, spin=0.4, **ELASTIC)
    assert (two.force_x, two.force_y, two.moment_spin) == (2 * one.force_x, 2 * one.force_y, 2 * one.moment_spin)


def test_saturation_curve():
    assert saturated_fraction(0.0) == 0.0
    assert saturated_fraction(3.0) == saturated_fraction(7.0) == 1.0
    assert saturated_fraction(1.2) == pytest.approx(1.2 - 1.2**2 / 3 + 1.2**3 / 27, rel=1e-15)
    assert saturated_fraction(1e-12) == pytest.approx(1e-12, rel=1e-11)
