"""Flexible wheels: what the contact sees, names, damping, rigid-body modes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from wheelrail.wheel.damping import damping_ratios
from wheelrail.wheel.flexible import WheelShapes, flexible_wheel, wheel_shapes
from wheelrail.wheel.modes import FlexibleWheel, Mode, rigid_modes
from wheelrail.wheel.section import load_section
from wheelrail.wheel.tuning import tune_two_dof

STEEL = {"youngs_modulus": 207e9, "poisson_ratio": 0.3, "density": 7860.0}
SUSPENSION = {"mass": 341.5, "suspension_stiffness": 1.12e6, "suspension_damping": 13.2e3}
ROLL = {"roll_inertia": 200.0, "roll_stiffness": 1e6, "roll_damping": 5e3, "roll_arm_y": 0.75, "roll_arm_z": 0.39}


@pytest.fixture(scope="module")
def shapes() -> WheelShapes:
    section = load_section("synthetic-c20", element_size=0.015)
    return wheel_shapes(section, **STEEL, max_frequency=7000.0)


def wheel(shapes, position=0.02, **changes) -> FlexibleWheel:
    modes = shapes.at(contact_position=position, damping=changes.pop("damping", "thesis"))
    return FlexibleWheel(modes, rigid_modes(**SUSPENSION, **changes))


def test_names(shapes):
    """As engineers order them: by nodal diameters and circles, one name each."""
    names = [mode.name for mode in shapes.modes]
    assert len(set(names)) == len(names) == 35
    for n, expected in {
        0: ["0,0,a", "0,c", "0,1,a", "0,2,a", "0,r", "0,c2"],
        1: ["1,0,a", "1,r", "1,1,a", "1,2,a", "1,c"],
        2: ["2,0,a", "2,r", "2,1,a", "2,2,a", "2,c"],
        3: ["3,0,a", "3,1,a", "3,r", "3,2,a"],
        6: ["6,0,a", "6,1,a", "6,r"],
        7: ["7,0,a", "7,r", "7,1,a"],
        8: ["8,0,a"],
    }.items():
        assert [mode.name for mode in shapes.modes if mode.harmonic == n] == expected


@pytest.mark.parametrize("highest", [1600.0, 2300.0, 3000.0, 5000.0, 12e3])
def test_names_do_not_depend_on_the_highest_frequency(shapes, highest):
    section = load_section("synthetic-c20", element_size=0.015)
    other = wheel_shapes(section, **STEEL, max_frequency=highest)
    limit = min(highest, 7000.0)
    assert [m.name for m in other.modes if m.frequency < limit] == [m.name for m in shapes.modes if m.frequency < limit]


def test_partners(shapes):
    """Modes with n > 0 come twice; one moves the contact across the rail, the other along it."""
    modes = {mode.name: mode for mode in wheel(shapes).modes}
    assert len(modes) == 64
    for name, mode in modes.items():
        x, y, z = mode.shape
        if name in ("0,c", "0,c2") or name.endswith("*"):
            assert x != 0.0
            assert y == z == 0.0
        else:
            assert x == 0.0
            assert (y, z) != (0.0, 0.0)
        if name.endswith("*"):
            partner = modes[name[:-1]]
            assert (mode.mass, mode.stiffness, mode.damping) == (partner.mass, partner.stiffness, partner.damping)
        else:
            assert name[0] == "0" or f"{name}*" in modes


def test_contact_position(shapes):
    first, last = shapes.tread
    assert (first, last) == pytest.approx((-0.073, 0.060), abs=1e-6)
    # A field's value at the contact: that of the coordinates.
    for position in (first, -0.0321, 0.0, 0.0123, last):
        r, z = shapes.contact_weights(position) @ shapes.body.points
        assert z == pytest.approx(-position, abs=1e-9)
        assert r >= 0.387 - 1e-9
    for position in (first - 1e-3, last + 1e-3, math.nan):
        with pytest.raises(ValueError, match=r"tread reaches from -0\.073 to 0\.06 m"):
            shapes.contact_weights(position)


def test_flexible_wheel_in_one_call(shapes):
    rigid = rigid_modes(**SUSPENSION)
    section = shapes.section
    made = flexible_wheel(
        section=section, **STEEL, max_frequency=7000.0, damping="thesis", contact_position=0.02, rigid=rigid
    )
    assert made.rigid == rigid
    frequency = [100.0, 5000.0]
    np.testing.assert_allclose(made.receptance(frequency), wheel(shapes).receptance(frequency), rtol=1e-9)


def test_receptance_of_one_mode():
    """By the equation of motion of one mass."""
    mode = Mode.with_frequency(name="2,r", mass=3.0, frequency=400.0, damping_ratio=0.02, shape=(0.0, 0.5, -2.0))
    assert mode.frequency == pytest.approx(400.0, rel=1e-14)
    assert mode.damping_ratio == pytest.approx(0.02, rel=1e-14)
    found = FlexibleWheel((mode,)).receptance([0.0, 390.0])
    for f, matrix in zip([0.0, 390.0], found, strict=True):
        own, at = 2.0 * math.pi * 400.0, 2.0 * math.pi * f
        oscillator = 1.0 / (3.0 * (own**2 - at**2 + 0.04j * own * at))
        np.testing.assert_allclose(matrix, oscillator * np.outer([0.0, 0.5, -2.0], [0.0, 0.5, -2.0]), rtol=1e-12)


def test_static_compliance(shapes):
    full = wheel(shapes, **ROLL)
    np.testing.assert_allclose(full.static_compliance(), full.receptance(0.0)[0].real, rtol=1e-12, atol=1e-25)
    free = FlexibleWheel((), rigid_modes(mass=300.0, suspension_stiffness=0.0, suspension_damping=0.0))
    np.testing.assert_array_equal(free.static_compliance(), np.diag([0.0, 0.0, np.inf]))
    with pytest.raises(ValueError, match="no receptance at 0 Hz"):
        free.receptance(0.0)
    assert free.all_modes[0].damping_ratio == 0.0


def test_removing_modes(shapes):
    full = wheel(shapes)
    names = {mode.name for mode in full.modes}
    assert names - {mode.name for mode in full.without(["7,0,a", "(2, c)"]).modes} == {
        "7,0,a",
        "7,0,a*",
        "2,c",
        "2,c*",
    }
    assert names - {mode.name for mode in full.without(["7,0,a*"]).modes} == {"7,0,a*"}
    assert full.without(["0,c"]).rigid == full.rigid
    with pytest.raises(ValueError, match=r'no mode "70,a"; nearest names: .*7,0,a'):
        full.without(["70,a"])
    assert FlexibleWheel(full.modes) == full.held()


def test_damping_factor(shapes):
    full = wheel(shapes)
    raised = full.with_damping_factor(10.0)
    assert raised.rigid == full.rigid
    for before, after in zip(full.modes, raised.modes, strict=True):
        assert after.damping_ratio == pytest.approx(10.0 * before.damping_ratio, rel=1e-12)
        assert after.frequency == before.frequency


NAMES = ["0,0,a", "0,c", "1,r", "1,r*", "7,0,a", "7,0,a*"]


@pytest.mark.parametrize(
    ("damping", "expected"),
    [
        ("thesis", [1e-3, 1e-3, 1.0, 1.0, 1e-4, 1e-4]),
        (0.02, [0.02] * 6),
        ({"7,0,a": 0.5, "others": "thesis"}, [1e-3, 1e-3, 1.0, 1.0, 0.5, 0.5]),
        ({"(7,0,a)": 0.5, "7,0,a*": 0.25, "others": 0}, [0.0, 0.0, 0.0, 0.0, 0.5, 0.25]),
    ],
)
def test_damping(damping, expected):
    assert list(damping_ratios(NAMES, damping).values()) == expected


@pytest.mark.parametrize(
    ("damping", "message"),
    [
        ({"7,0,b": 0.1, "others": 0.1}, 'no mode "7,0,b"; nearest names: 7,0,a'),
        ({"7,0,a": 0.1}, "no value for 0,0,a, 0,c, 1,r, 1,r[*];"),
        ({"7,0,a": -0.1, "others": 0.1}, "mode 7,0,a = -0.1 is refused"),
        ("thompson", "'thompson' is refused"),
        (True, "True is refused"),
        (math.inf, "inf is refused"),
    ],
)
def test_refused_damping(damping, message):
    with pytest.raises(ValueError, match=message):
        damping_ratios(NAMES, damping)


def test_rigid_modes():
    """A force at the contact, against the motion of a rigid body about its centre."""
    lateral = {"lateral_mass": 400.0, "lateral_stiffness": 0.0, "lateral_damping": 0.0}
    free = {"suspension_stiffness": 0.0, "suspension_damping": 0.0, "roll_stiffness": 0.0, "roll_damping": 0.0}
    modes = rigid_modes(**{**SUSPENSION, **lateral, **ROLL, **free})
    assert [mode.name for mode in modes] == ["vertical", "lateral", "roll"]
    accelerations = []
    for force in np.eye(3)[1:]:
        arm = np.array([0.0, 0.75, 0.39])
        angular = np.cross(arm, force)[0] / 200.0
        accelerations.append(force / [1.0, 400.0, 341.5] + np.cross([angular, 0.0, 0.0], arm))
    found = -((2.0 * np.pi * 3.0) ** 2) * FlexibleWheel((), modes).receptance(3.0)[0]
    np.testing.assert_allclose(found[1:], accelerations, rtol=1e-12)
    assert [mode.name for mode in rigid_modes(**SUSPENSION)] == ["vertical"]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"mass": 0.0}, "mass = 0.0 is refused"),
        ({"suspension_damping": -1.0}, "suspension_damping = -1.0 is refused"),
        ({"lateral_mass": 3.0}, "lateral_stiffness, lateral_damping: missing"),
        ({**ROLL, "roll_arm_z": None}, "roll_arm_z: missing"),
        ({**ROLL, "roll_inertia": math.nan}, "roll_inertia = nan"),
    ],
)
def test_refused_rigid_modes(changes, message):
    with pytest.raises(ValueError, match=message):
        rigid_modes(**{**SUSPENSION, **changes})


def test_tuning_needs_flexible_modes():
    with pytest.raises(ValueError, match="no flexible mode"):
        tune_two_dof(FlexibleWheel((), rigid_modes(**SUSPENSION)), **SUSPENSION, contact_mass=3.0)
