"""Where wheel and rail of a case touch."""

from __future__ import annotations

import math

from wheelrail.case import Case
from wheelrail.interaction.contacts import curvatures_of, geometry_of
from wheelrail.interaction.place_watch import STEEP
from wheelrail.interaction.profiles import profile_geometry_of

__all__ = ["explain_geometry"]

_NEAR = 1e-4  # m, gap of further points that are worth a line
_ELSEWHERE = 5e-3  # m, between the contact and where a flexible body's receptance is that of


def explain_geometry(case: Case, approach: float, warnings: list[str]) -> list[str]:
    """Return the lines on the place of contact; add to ``warnings`` what does not suit it.

    Parameters
    ----------
    case : Case
    approach : float
        Of the bodies under the preload, m.
    warnings : list of str
        Changed in place.
    """
    geometry = geometry_of(case)
    place = geometry.place(case.contact.lateral_shift)
    along, across = curvatures_of(case)
    lines = [
        f"geometry                  {geometry.description}",
        f"contact point             {_mm(place.y_wheel)} on the wheel, {_mm(place.y_rail)} on the rail (+ field side), "
        f"at a lateral shift of {1e3 * case.contact.lateral_shift:+g} mm",
        f"relative radii            {1.0 / along:.4g} m along, {1.0 / across:.4g} m across the rail",
    ]
    if case.contact.wheel_profile is not None:
        lines += [f"  {note}" for note in profile_geometry_of(case)[1]]
    if geometry.shaped:
        lines.append(f"contact angle             {place.angle:+.4f} rad; rolling radius {place.rolling_radius:.6g} m")
    for other in place.others:
        if other.gap > max(_NEAR, approach):
            continue
        lines.append(
            f"further point             {_mm(other.y_wheel)} on the wheel, {_mm(other.y_rail)} on the rail, "
            f"{1e6 * other.gap:.3g} um apart at first touch"
        )
        width = case.contact.width if case.contact.normal == "half-space" else None
        if other.gap < approach and (width is None or abs(other.y_rail - place.y_rail) > 0.5 * width):
            warnings.append(
                f"wheel and rail touch at a second place under the preload, {_mm(other.y_rail)} on the rail; "
                'only a wide contact.width with normal = "half-space" can take it in'
            )
    if abs(place.angle) > STEEP:
        warnings.append(
            f"the contact angle is {place.angle:.3g} rad: the contact's normal force is taken for the vertical one, "
            f"which is {100.0 * (1.0 - math.cos(place.angle)):.1f} % less, and its lateral part is left out"
        )
    for name, body, at in (("wheel", case.wheel, place.y_wheel), ("track", case.track, place.y_rail)):
        given = getattr(body, "contact_position", None)
        if geometry.shaped and given is not None and abs(at - given) > _ELSEWHERE:
            warnings.append(
                f"{name}.contact_position = {1e3 * given:g} mm, but the profiles touch at {_mm(at)}: the "
                f"{name}'s receptance is that of another place"
            )
    return lines


def _mm(position: float) -> str:
    return f"{1e3 * position:+.2f} mm"
