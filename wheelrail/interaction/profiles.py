"""Profiles of wheel and rail of a case."""

from __future__ import annotations

from ..case import Case
from ..profile.curve import ProfileCurve
from ..profile.named_profiles import (
    NAMED_RAIL_PROFILES,
    NAMED_WHEEL_PROFILES,
    named_rail_profile,
    named_wheel_profile,
)
from ..profile.profile_geometry import ProfileGeometry
from ..profile.reading import read_profile
from ..profile.smoothing import profile_from_points

__all__ = ["profile_geometry_of"]


def profile_geometry_of(case: Case) -> tuple[ProfileGeometry, list[str]]:
    """Make the geometry of a case with profiles.

    Parameters
    ----------
    case : Case
        With ``contact.wheel_profile`` and ``contact.rail_profile``.

    Returns
    -------
    geometry : ProfileGeometry
    notes : list of str
        What was assumed and done to measured profiles.

    Raises
    ------
    DataFileError
        If a file can't be read or used.
    ParameterError
        If the profiles don't touch at the lateral shift.
    """
    contact = case.contact
    assert contact.wheel_profile is not None
    assert contact.rail_profile is not None
    assert contact.inclination is not None
    notes: list[str] = []
    if contact.wheel_profile.lower() in NAMED_WHEEL_PROFILES:
        wheel = named_wheel_profile(contact.wheel_profile, conicity=contact.conicity)
    else:
        wheel = _measured(case, contact.wheel_profile, "wheel", contact.wheel_profile_mirrored, notes)
    if contact.rail_profile.lower() in NAMED_RAIL_PROFILES:
        rail = named_rail_profile(contact.rail_profile, radius=contact.rail_radius)
    else:
        rail = _measured(case, contact.rail_profile, "rail", contact.rail_profile_mirrored, notes)
    geometry = ProfileGeometry(
        wheel=wheel,
        rail=rail,
        nominal_radius=case.wheel.radius,
        inclination=contact.inclination,
        yaw=contact.yaw,
        reference_shift=contact.lateral_shift,
    )
    return geometry, notes


def _measured(case: Case, file: str, kind: str, mirrored: bool | None, notes: list[str]) -> ProfileCurve:
    points = read_profile(case.data_path(file), kind=kind, mirrored=mirrored)
    curve, remarks = profile_from_points(
        points.y, points.z, kind=kind, name=points.path.name, cutoff_wavelength=case.contact.profile_smoothing
    )
    notes += [*points.notes, *remarks]
    return curve
