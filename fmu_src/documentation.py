"""``documentation/index.html`` of the FMU, from the variable table and the case."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from importlib import resources
from string import Template
from typing import Any

from .variables import ENUMERATIONS, VARIABLES, Variable

__all__ = ["documentation"]


def documentation(
    *, start: Mapping[str, Any], lateral: bool, case_text: str, title: str, version: str, step_size: float
) -> str:
    """Return the page.

    Parameters
    ----------
    start : mapping of str to object
        Start values by variable name.
    lateral : bool
        The lateral position of the wheel on the rail makes a difference.
    case_text : str
        The case file that the FMU was built from.
    title, version : str
        Title of the case and version of the package.
    step_size : float
        Communication step of the default experiment (s).

    Returns
    -------
    str
        HTML without references to anything outside, but for the licences beside it.
    """
    page = Template(resources.files("fmu_src").joinpath("documentation_template.html").read_text(encoding="utf-8"))
    return page.substitute(
        title=escape(title),
        version=escape(version),
        speed=f"{start['speed']:g}",
        dx=f"{1e3 * start['dx']:g}",
        time_step=f"{1e6 * start['dx'] / start['speed']:.4g}",
        step_size=f"{1e3 * step_size:g}",
        wheel_model=escape(str(start["wheel_model"])),
        track_model=escape(str(start["track_model"])),
        normal_contact_model=escape(str(start["normal_contact_model"])),
        tangential_contact_model=escape(str(start["tangential_contact_model"])),
        friction_law=escape(str(start["friction_law"])),
        coupling=escape(str(start["coupling"])),
        without_effect=_without_effect(
            str(start["tangential_contact_model"]),
            wheel=str(start["wheel_model"]),
            track=str(start["track_model"]),
            friction=str(start["friction_law"]),
            lateral=lateral,
            geometry=str(start["contact_geometry"]),
        ),
        guiding=_guiding(str(start["tangential_contact_model"]), wheel=str(start["wheel_model"])),
        inputs=_table("input", start),
        outputs=_table("output", start),
        parameters=_table("parameter", start),
        calculated=_table("calculated", start),
        constants=_table("constant", start),
        case_text=escape(case_text),
    )


def _without_effect(tangential: str, *, wheel: str, track: str, friction: str, lateral: bool, geometry: str) -> str:
    """Say which ports this FMU accepts or shows although its model has no use for them."""
    inputs, outputs = [] if lateral else ["wheel_y", "lateral_shift", "lateral_position"], []
    if geometry.startswith("wheel "):
        inputs.append("lateral_position")
    if tangential == "none":
        inputs += ["creepage_x", "creepage_y", "creepage_spin", "friction_coefficient"]
        outputs += ["force_x", "force_y", "force_x_mean", "force_y_mean"]
        outputs += ["moment_spin", "slip_fraction", "friction_power"]
    if tangential == "none" or wheel != "flexible":
        inputs += ["wheel_force_x", "wheel_force_y", "balance"]
        outputs += ["wheel_disp_x", "wheel_disp_y"]
    if tangential != "transient" or friction in ("none", "constant"):
        outputs += ["friction_method", "friction_solutions", "friction_force_spread"]
    if tangential == "none" or track != "waveguide":
        outputs += ["rail_disp_x", "rail_disp_y"]
    accepted, zero = (", ".join(f"<code>{name}</code>" for name in names) for names in (inputs, outputs))
    sentences = []
    if inputs:
        sentences.append(f"Its model has no use for {accepted}: no effect on any force.")
    if outputs:
        sentences.append(f"{zero} read 0.")
    return " ".join(sentences)


def _guiding(tangential: str, *, wheel: str) -> str:
    """Say what holds a flexible wheel against the tangential contact forces."""
    if tangential == "none" or wheel != "flexible":
        return ""
    return (
        "<p>The wheel feels the vehicle's forces less those of the contact. With <code>balance = true</code> the "
        "steady tangential forces at the start are taken as the vehicle's guiding forces, and "
        "<code>wheel_force_x</code>, <code>wheel_force_y</code> count from their values at the start: the wheel's "
        "rigid body is at rest and does not run away. With <code>false</code> they are the guiding forces themselves, "
        "and the wheel starts where its suspension holds the difference. With <code>coupling = displacement</code> the "
        "vehicle holds the wheel and none of this acts. The slip is made of the creepages and of what wheel and rail "
        "do by their own dynamics (<code>wheel_disp_x</code> to <code>rail_disp_y</code>): the vehicle's own lateral "
        "motion belongs to <code>creepage_y</code>, not to <code>wheel_y</code>.</p>"
    )


def _table(role: str, start: Mapping[str, Any]) -> str:
    rows = [
        _row(reference, variable, start.get(variable.name))
        for reference, variable in enumerate(VARIABLES)
        if variable.role == role
    ]
    head = "<tr><th>reference</th><th>name</th><th>type</th><th>unit</th><th>meaning</th>"
    head += (
        "</tr>" if role in ("output", "calculated") else f"<th>{'value' if role == 'constant' else 'start'}</th></tr>"
    )
    return "<table>\n" + "\n".join([head, *rows]) + "\n</table>"


def _row(reference: int, variable: Variable, start: Any) -> str:
    meaning = escape(variable.description)
    if variable.enumeration:
        items = ENUMERATIONS[variable.enumeration].items
        meaning += "".join(
            f"<br>{value} = <code>{name}</code>: {escape(text)}" for value, (name, text) in enumerate(items, 1)
        )
    cells = [str(reference), f"<code>{variable.name}</code>", variable.kind, variable.unit or "", meaning]
    if variable.role not in ("output", "calculated"):
        cells.append(escape(f"{start:g}" if isinstance(start, float) else str(start)))
    return "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"
