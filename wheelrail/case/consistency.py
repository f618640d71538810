"""Faults that only show when several keys of a case are seen together."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from wheelrail.case.excitation_rules import excitation_faults
from wheelrail.case.friction_rules import friction_faults
from wheelrail.case.numbers import number, positive, shown, steps
from wheelrail.case.profile_rules import profile_faults
from wheelrail.case.structure_rules import structure_faults

__all__ = ["cross_faults", "excitation_label", "shown"]


def excitation_label(index: int) -> str:
    """Name of the excitation at a zero-based index, counted as in the file."""
    return f"excitation #{index + 1}"


def cross_faults(data: Mapping[str, Any]) -> list[str]:
    """Find the faults that involve more than one key.

    Parameters
    ----------
    data : mapping
        Case in the layout of the file, presets resolved. Values that are missing or bad on their own are passed
        over: they are reported where they stand.

    Returns
    -------
    list of str
        One line per fault; empty if the keys agree.
    """
    simulation, track, contact = (_table(data, name) for name in ("simulation", "track", "contact"))
    faults: list[str] = []
    dx = positive(simulation, "dx")
    if dx is not None:
        faults += _start_faults(simulation, dx)
        if "discrete" in (track.get("model"), track.get("support")):
            faults += _spacing_faults(track, dx)
        faults += _odd_faults("contact.length", positive(contact, "length"), "simulation.dx", dx)
    faults += structure_faults(_table(data, "wheel"), track)
    faults += _odd_faults("contact.width", positive(contact, "width"), "contact.dy", positive(contact, "dy"))
    if contact:
        faults += profile_faults(contact)
    faults += _prefilter_faults(contact)
    faults += _tangential_faults(data)
    faults += friction_faults(_table(data, "friction"), contact)
    excitations = data.get("excitation")
    for index, excitation in enumerate(excitations if isinstance(excitations, list) else ()):
        if isinstance(excitation, dict):
            faults += excitation_faults(excitation_label(index), excitation, dx)
    faults += _record_faults(_table(data, "output"))
    return faults


def _table(data: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    table = data.get(name)
    return table if isinstance(table, dict) else {}


def _start_faults(simulation: Mapping[str, Any], dx: float) -> Iterator[str]:
    start = number(simulation, "start_position")
    if start is None:
        return
    count, fits = steps(start, dx)
    if not fits:
        yield (
            f"simulation.start_position = {shown(start)}: must be a multiple of simulation.dx = {shown(dx)} (m); "
            f"the nearest is {shown(count * dx)}"
        )


def _spacing_faults(track: Mapping[str, Any], dx: float) -> Iterator[str]:
    spacing = positive(track, "sleeper_spacing")
    if spacing is None:
        return
    count, fits = steps(spacing, dx)
    if not fits or count < 1:
        yield (
            f"track.sleeper_spacing = {shown(spacing)}: must be a multiple of simulation.dx = {shown(dx)} (m); "
            f"the nearest dx that fits is {shown(spacing / max(count, 1))}"
        )


def _odd_faults(name: str, length: float | None, step_name: str, step: float | None) -> Iterator[str]:
    if length is None or step is None:
        return
    count, fits = steps(length, step)
    if fits and count % 2 == 1:
        return
    below = 2 * math.floor((length / step - 1) / 2) + 1 if math.isfinite(length / step) else -1
    nearest = " and ".join(shown(odd * step) for odd in (below, below + 2) if odd > 0)
    yield f"{name} = {shown(length)}: must be an odd number of {step_name} = {shown(step)} (m); nearest: {nearest}"


def _prefilter_faults(contact: Mapping[str, Any]) -> Iterator[str]:
    prefilter = contact.get("prefilter")
    if prefilter not in ("average", "winkler"):
        return
    if contact.get("normal") in ("winkler", "half-space"):
        yield (
            f'contact.prefilter = "{prefilter}": only with contact.normal = "hertz"; '
            f'with "{contact["normal"]}", which filters by itself, it must be "none"'
        )
    elif contact.get("normal") == "hertz" and "length" not in contact:
        yield f'contact.length: missing; contact.prefilter = "{prefilter}" needs it (m)'


def _tangential_faults(data: Mapping[str, Any]) -> Iterator[str]:
    contact = _table(data, "contact")
    tangential = contact.get("tangential")
    if tangential == "transient" and contact.get("normal") in ("hertz", "winkler"):
        yield 'contact.tangential = "transient": only with contact.normal = "half-space"'
    if tangential in ("transient", "friction-curve", "fastsim") and "friction" not in data:
        yield f'friction: missing; contact.tangential = "{tangential}" needs [friction] with law and coefficient'
    if tangential in ("transient", "friction-curve", "fastsim", "linear") and "creepage" not in data:
        yield (
            f'creepage: missing; contact.tangential = "{tangential}" needs the section [creepage] with x, y, spin; '
            "an FMU starts with these values"
        )


def _record_faults(output: Mapping[str, Any]) -> Iterator[str]:
    record = output.get("record")
    if not isinstance(record, list):
        return
    names = [name for name in record if isinstance(name, str)]
    for name in dict.fromkeys(name for name in names if names.count(name) > 1):
        yield f'output.record: "{name}" is given {names.count(name)} times; once is enough'
