"""The whole report of a case, section by section."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable

from wheelrail.case import Case
from wheelrail.explain.contact import explain_contact, explain_what_has_no_effect
from wheelrail.explain.discretisation import explain_cost, explain_grid
from wheelrail.explain.equations import explain_equations, explain_sources
from wheelrail.explain.excitation import explain_excitation
from wheelrail.explain.frequencies import explain_frequencies
from wheelrail.explain.friction import explain_friction
from wheelrail.explain.geometry import explain_geometry
from wheelrail.explain.structures import explain_track, explain_wheel
from wheelrail.interaction.build import hertz_of, track_of, wheel_of
from wheelrail.interaction.tracks import find_greens_of

__all__ = ["explain"]

_WIDTH = 110
_LABEL_WIDTH = 26  # of the names of numbers, which all sections keep to


def explain(case: Case) -> str:
    """Describe what a case computes.

    The moving Green's functions are not computed; what depends on them is taken from the cache, or estimated and then
    said to be an estimate. The modes of a flexible wheel and the waves of a rail are computed; that takes some seconds.

    Parameters
    ----------
    case : Case

    Returns
    -------
    str
        Several paragraphs of plain text.

    Raises
    ------
    WheelrailError
        If a data file of the excitation can't be used.
    """
    wheel, track, hertz = wheel_of(case), track_of(case), hertz_of(case)
    # What of the wheel is left here where the vehicle model moves it.
    moving = wheel.held() if wheel is not None and case.load.coupling == "displacement" else wheel
    greens = find_greens_of(case)
    warnings: list[str] = []
    sections = [
        ("Equations", explain_equations(case, moving, track)),
        ("Grid and time", explain_grid(case, hertz, warnings)),
        ("Wheel", explain_wheel(case, wheel, warnings)),
        ("Track", explain_track(case, track, greens, warnings)),
        ("Geometry", explain_geometry(case, hertz.approach, warnings)),
        ("Contact", explain_contact(case, hertz, warnings)),
        ("Friction", explain_friction(case, hertz, warnings)),
        ("Frequencies", explain_frequencies(case, moving, track, hertz)),
        ("Excitation", explain_excitation(case, hertz, warnings)),
        ("Cost", explain_cost(case, hertz, moving, track, greens)),
        ("Without effect", explain_what_has_no_effect(case)),
        ("Warnings", [f"! {line}" for line in warnings] or ["none"]),
        ("Sources", explain_sources(case, track)),
    ]
    title = case.title or "untitled case"
    lines = [title, "=" * len(title)]
    for heading, items in sections:
        if items:
            lines += ["", heading, "-" * len(heading), *_wrapped(items)]
    return "\n".join(lines)


def _wrapped(items: Iterable[str]) -> list[str]:
    lines: list[str] = []
    for item in items:
        if item.startswith("    "):  # an equation, to be left alone
            lines.append(item)
        else:
            lines += textwrap.wrap(
                item,
                _WIDTH,
                subsequent_indent=" " * (_LABEL_WIDTH if "  " in item.strip() else 2),
                break_on_hyphens=False,
            )
    return lines
