"""Faults between the keys of ``[wheel]`` or ``[track]``: where a flexible body comes from, and what it needs then."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from wheelrail.case.fields import Section, unit_of
from wheelrail.case.track_sections import WaveguideTrack
from wheelrail.case.wheel_sections import FlexibleWheel

__all__ = ["WHEEL_SOURCES", "structure_faults"]

WHEEL_SOURCES = ("section", "modes", "receptances")
"""Keys of a flexible wheel of which one says where it comes from."""

_VERTICAL = ("mass", "suspension_stiffness", "suspension_damping")
_MOTIONS = (
    _VERTICAL,
    ("lateral_mass", "lateral_stiffness", "lateral_damping"),
    ("roll_inertia", "roll_stiffness", "roll_damping", "roll_arm_y", "roll_arm_z"),
)
_MATERIAL = ("youngs_modulus", "poisson_ratio", "density")
_RECEPTANCES = ("reference_node", "quantity", "low_frequency", "receptances_as")
_NEEDED = {
    "section": (*_MATERIAL, "contact_position", "max_frequency", "damping", *_VERTICAL),
    "modes": _VERTICAL,
    "receptances": ("low_frequency",),
}
_UNUSED = {
    "section": ("node", "axes", "units", "mass_normalised", *_RECEPTANCES),
    "modes": (*_MATERIAL, "contact_position", "element_size", *_RECEPTANCES),
    "receptances": (
        *_MATERIAL,
        "contact_position",
        "element_size",
        "max_frequency",
        "damping",
        "mass_normalised",
    ),
}
_LAYER = ("pad_youngs_modulus", "pad_poisson_ratio", "pad_density", "pad_loss_factor", "pad_thickness")
_SUPPORTS = (
    "sleeper_spacing",
    *(
        f"{part}_{direction}{kind}"
        for part in ("pad", "ballast")
        for kind in ("stiffness", "damping")
        for direction in ("", "lateral_", "longitudinal_")
    ),
    "sleeper_mass",
)


def structure_faults(wheel: Mapping[str, Any], track: Mapping[str, Any]) -> Iterator[str]:
    """Find the faults between keys of a flexible wheel, and between those of a waveguide track.

    Parameters
    ----------
    wheel, track : mapping
        Tables of the case, presets resolved.
    """
    if wheel.get("model") == "flexible":
        yield from _wheel_faults(wheel)
    if track.get("model") == "waveguide" and track.get("support") in ("continuous", "discrete"):
        continuous = track["support"] == "continuous"
        where = f'support = "{track["support"]}"'
        needed, unused = (_LAYER, _SUPPORTS) if continuous else ((*_SUPPORTS, "pad_width"), _LAYER)
        yield from _missing("track", WaveguideTrack, track, needed, where)
        yield from _not_used("track", track, unused, where)


def _wheel_faults(wheel: Mapping[str, Any]) -> Iterator[str]:
    given = [key for key in WHEEL_SOURCES if key in wheel]
    if not given:
        yield (
            "wheel.section: missing; give section (a preset or file), modes (a file) or receptances (a file), "
            'or name a preset (preset = "synthetic-c20")'
        )
    elif len(given) > 1:
        yield f"wheel: {' and '.join(given)} given together; give one of them"
    else:
        yield from _missing("wheel", FlexibleWheel, wheel, _NEEDED[given[0]], f"a wheel from {given[0]}")
        yield from _not_used("wheel", wheel, _UNUSED[given[0]], given[0])
    if given == ["receptances"] and wheel.get("receptances_as") == "functions":
        yield from _not_used("wheel", wheel, ("remove_modes",), 'receptances_as = "functions"')
    required = _NEEDED[given[0]] if len(given) == 1 else ()
    if given == ["receptances"] and wheel.get("low_frequency") == "free":
        required = (*required, *_VERTICAL)
        yield from _missing("wheel", FlexibleWheel, wheel, _VERTICAL, 'low_frequency = "free"')
    for motion in _MOTIONS:
        if any(key in wheel for key in motion):
            absent = [key for key in motion if key not in required]
            yield from _missing("wheel", FlexibleWheel, wheel, absent, _together(motion))


def _together(keys: Iterable[str]) -> str:
    return f"this motion ({', '.join(keys)})"


def _missing(
    section: str, model: type[Section], table: Mapping[str, Any], keys: Iterable[str], where: str
) -> Iterator[str]:
    for key in keys:
        if key not in table:
            unit = unit_of(model.model_fields[key])
            shown = f" ({unit})" if unit and unit != "1" else ""
            yield f"{section}.{key}: missing; {where} needs it{shown}"


def _not_used(section: str, table: Mapping[str, Any], keys: Iterable[str], where: str) -> Iterator[str]:
    for key in keys:
        if table.get(key) not in (None, []):  # an empty list is what leaving it out gives
            yield f"{section}.{key}: not used with {where}; leave it out"
