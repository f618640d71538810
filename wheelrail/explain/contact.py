"""The contact law and its size, and what the file gives that no contact model uses."""

from __future__ import annotations

from wheelrail.case import Case
from wheelrail.contact.hertz import HertzContact

__all__ = ["explain_contact", "explain_what_has_no_effect"]

_SMALLEST_RESERVE = 2.0  # of the preload, in the potential contact area


def explain_contact(case: Case, hertz: HertzContact, warnings: list[str]) -> list[str]:
    """Return the lines on the contact; add to ``warnings`` what it filters or holds badly."""
    contact = case.contact
    lines = [
        f"{contact.normal}; preload {hertz.load * 1e-3:g} kN, coupling by {case.load.coupling}",
        f"Hertz ellipse             {hertz.semi_axis_x * 1e3:.2f} x {hertz.semi_axis_y * 1e3:.2f} mm (semi-axes along "
        f"and across the rail), {2.0 * hertz.semi_axis_x / case.simulation.dx:.1f} dx long",
        f"approach                  {hertz.approach * 1e6:.1f} um",
        f"largest pressure          {hertz.pressure_max * 1e-9:.3f} GPa",
        f"stiffness at the preload  {hertz.stiffness * 1e-9:.3f} GN/m",
        f"C_H                       {hertz.constant * 1e-9:.4g} GN/m^1.5",
    ]
    if contact.normal == "winkler":
        bedding = 0.75 * hertz.load / (hertz.semi_axis_x * hertz.approach)
        radius = hertz.semi_axis_x**2 / (2.0 * hertz.approach)
        lines.append(
            f"bedding                   k' = {bedding * 1e-9:.4g} GN/m2, R' = {radius:.4g} m: load, length and "
            "approach of Hertz for every load"
        )
    if contact.normal == "half-space":
        elements = hertz.area / (case.simulation.dx * contact.dy)
        grid = round(contact.length / case.simulation.dx), round(contact.width / contact.dy)
        lines.append(
            f"potential contact area    {grid[0]} x {grid[1]} elements of {case.simulation.dx * 1e3:g} x "
            f"{contact.dy * 1e3:g} mm; about {elements:.0f} in contact at the preload"
        )
    if contact.tangential != "none":
        lines.append(f"tangential                {contact.tangential}")
    moves = case.wheel.model == "flexible" or case.track.model == "waveguide"
    if contact.tangential == "transient" and case.simulation.first_sample == "zero" and moves:
        warnings.append(
            "with first samples of zero a contact that sticks all over can swing from step to step up to full sliding, "
            'without any physical cause: a smaller dx, a higher speed or simulation.first_sample = "kept" cure that'
        )
    if contact.length is not None and (contact.normal == "winkler" or contact.prefilter != "none"):
        half = 0.5 * (contact.length - case.simulation.dx)
        grows = (half / hertz.semi_axis_x) ** 3
        lines.append(
            f"potential contact area    {contact.length * 1e3:g} mm long; a smooth contact fits in up to "
            f"{grows:.2g} times the preload"
        )
        if contact.normal == "winkler" and grows < _SMALLEST_RESERVE:
            warnings.append(
                f"the potential contact area holds only {grows:.2g} times the preload; the run stops beyond that "
                "(contact.length)"
            )
    if contact.normal == "hertz" and contact.prefilter == "none" and case.excitation:
        warnings.append(
            "the Hertz spring feels the roughness at one point: wavelengths below about "
            f'{4e3 * hertz.semi_axis_x:.2g} mm act too strongly; contact.prefilter or normal = "winkler" filters them'
        )
    return lines


def explain_what_has_no_effect(case: Case) -> list[str]:
    """Return the given keys that the chosen models do not use."""
    lines = []
    if case.contact.tangential == "none":
        parts = [name for name in ("friction", "creepage") if getattr(case, name) is not None]
        if parts:
            lines.append(f"[{'], ['.join(parts)}]: there is no tangential contact model")
    if case.contact.tangential == "linear" and case.friction is not None:
        lines.append("[friction]: Kalker's linear theory has no friction limit")
    if case.friction is not None and case.friction.law == "constant":
        keys = ("memory_distance", "memory_speed", "solver", "branch", "find_solutions")
        given = [key for key in keys if key in case.friction.model_fields_set]
        if given:
            lines.append(f"friction.{', friction.'.join(given)}: the coefficient is constant")
    unused = () if case.contact.normal == "half-space" else ("dy", "width")
    lines += [
        f"contact.{key}: only used by a three-dimensional contact model"
        for key in unused
        if getattr(case.contact, key) is not None
    ]
    if case.contact.normal == "hertz" and case.contact.prefilter == "none" and case.contact.length is not None:
        lines.append("contact.length: the Hertz spring without prefilter is a point")
    return lines
