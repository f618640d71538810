"""Faults between the keys of the contact geometry: radii, or profiles."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

__all__ = ["RAIL_PROFILES", "WHEEL_PROFILES", "profile_faults"]

WHEEL_PROFILES = ("s1002", "cone", "cylinder")
RAIL_PROFILES = ("60e1", "bv50-like", "circular")

_NEEDED = "with profiles"


def profile_faults(contact: Mapping[str, Any]) -> Iterator[str]:
    """Find the faults between the keys that give wheel and rail their shape.

    Parameters
    ----------
    contact : mapping
        The section of the case.
    """
    wheel, rail = contact.get("wheel_profile"), contact.get("rail_profile")
    if wheel is None and rail is None:
        if "rail_radius" not in contact:
            yield "contact.rail_radius: missing; give it, or wheel_profile, rail_profile and inclination (m)"
        for key in ("conicity", "inclination", "yaw", "wheel_profile_mirrored", "rail_profile_mirrored"):
            if contact.get(key):
                yield f"contact.{key}: only used with wheel_profile and rail_profile; leave it out"
        return
    for key, value, other in (("wheel_profile", wheel, "rail_profile"), ("rail_profile", rail, "wheel_profile")):
        if value is None:
            yield f"contact.{key}: missing; contact.{other} needs it"
    if "inclination" not in contact:
        yield f"contact.inclination: missing; needed {_NEEDED} (rad)"
    if "wheel_transverse_radius" in contact:
        yield f"contact.wheel_transverse_radius: not used {_NEEDED}; leave it out"
    for body, profile, names in (("wheel", wheel, WHEEL_PROFILES), ("rail", rail, RAIL_PROFILES)):
        if f"{body}_profile_mirrored" in contact and any(_named(profile, name) for name in names):
            yield f"contact.{body}_profile_mirrored: only for a profile from a file; leave it out"
    circular = _named(rail, "circular")
    if circular and "rail_radius" not in contact:
        yield 'contact.rail_radius: missing; rail_profile = "circular" needs it (m)'
    if not circular and rail is not None and "rail_radius" in contact:
        yield f'contact.rail_radius: not used with rail_profile = "{rail}"; leave it out'
    cone = _named(wheel, "cone")
    if cone and "conicity" not in contact:
        yield 'contact.conicity: missing; wheel_profile = "cone" needs it'
    if not cone and wheel is not None and "conicity" in contact:
        yield f'contact.conicity: not used with wheel_profile = "{wheel}"; leave it out'


def _named(profile: object, name: str) -> bool:
    return isinstance(profile, str) and profile.lower() == name
