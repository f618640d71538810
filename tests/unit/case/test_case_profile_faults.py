"""Faults between the keys that give wheel and rail their shape."""

import pytest
from case_faults import changed, faults_of

from wheelrail.case import case_from_dict

PROFILES = {
    "contact.rail_radius": None,
    "contact.wheel_profile": "s1002",
    "contact.rail_profile": "60e1",
    "contact.inclination": 0.025,
}

FAULTS = [
    (
        {"contact.rail_radius": None},
        "contact.rail_radius: missing; give it, or wheel_profile, rail_profile and inclination (m)",
    ),
    (
        {"contact.inclination": 0.025},
        "contact.inclination: only used with wheel_profile and rail_profile; leave it out",
    ),
    ({**PROFILES, "contact.rail_profile": None}, "contact.rail_profile: missing; contact.wheel_profile needs it"),
    ({**PROFILES, "contact.inclination": None}, "contact.inclination: missing; needed with profiles (rad)"),
    (
        {**PROFILES, "contact.rail_radius": 0.3},
        'contact.rail_radius: not used with rail_profile = "60e1"; leave it out',
    ),
    (
        {**PROFILES, "contact.rail_profile": "circular"},
        'contact.rail_radius: missing; rail_profile = "circular" needs it (m)',
    ),
    ({**PROFILES, "contact.wheel_profile": "cone"}, 'contact.conicity: missing; wheel_profile = "cone" needs it'),
    (
        {**PROFILES, "contact.conicity": 0.05},
        'contact.conicity: not used with wheel_profile = "s1002"; leave it out',
    ),
    (
        {**PROFILES, "contact.rail_profile_mirrored": True},
        "contact.rail_profile_mirrored: only for a profile from a file; leave it out",
    ),
    (
        {**PROFILES, "contact.wheel_transverse_radius": 0.4},
        "contact.wheel_transverse_radius: not used with profiles; leave it out",
    ),
]


def test_profiles_stand_for_the_radius():
    contact = case_from_dict(changed(PROFILES)).contact
    assert (contact.wheel_profile, contact.rail_radius, contact.yaw) == ("s1002", None, 0.0)
    circular = {**PROFILES, "contact.rail_profile": "circular", "contact.wheel_profile": "cone"}
    circular |= {"contact.rail_radius": 0.3, "contact.conicity": 0.05}
    assert case_from_dict(changed(circular)).contact.rail_radius == 0.3


@pytest.mark.parametrize(("changes", "line"), FAULTS, ids=lambda value: str(value)[:80])
def test_faults(changes, line):
    given = {key: value for key, value in changes.items() if value is not None or key == "contact.rail_radius"}
    assert faults_of(changed(given)) == [line]


def test_a_profile_that_is_not_there(tmp_path):
    (fault,) = faults_of(changed({**PROFILES, "contact.wheel_profile": "s1003"}), folder=tmp_path)
    assert fault.startswith("contact.wheel_profile = \"s1003\": did you mean 's1002'? it comes with the program")
