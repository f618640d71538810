"""Faults between keys of ``[[excitation]]`` tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from wheelrail.case.numbers import GRID_TOLERANCE, positive, shown, steps

__all__ = ["excitation_faults"]


def excitation_faults(label: str, excitation: Mapping[str, Any], dx: float | None) -> Iterator[str]:
    """Find the faults between the keys of one excitation.

    Parameters
    ----------
    label : str
        Its name in messages.
    excitation : mapping
        Its table.
    dx : float or None
        Grid spacing, m, if it is known.
    """
    match excitation.get("type"):
        case "sinusoid" | "corrugation":
            wavelength = positive(excitation, "wavelength")
            if wavelength is not None and dx is not None and wavelength <= 2 * dx * (1 + GRID_TOLERANCE):
                yield (
                    f"{label}.wavelength = {shown(wavelength)}: must be > 2 simulation.dx = {shown(2 * dx)} "
                    "(m); the grid can't carry a shorter one"
                )
        case "measured":
            if excitation.get("on") == "wheel" and "beyond_end" in excitation:
                yield f'{label}.beyond_end: not used with on = "wheel": the line repeats every turn; leave it out'
            if "column" in excitation and "lateral" in excitation:
                yield f"{label}: column and lateral both given; column takes one line, lateral all of them"
            yield from _position_faults(label, excitation, "lateral")
        case "spectrum":
            yield from _spectrum_faults(label, excitation, dx)
        case "wheel-flat":
            yield from _flat_faults(label, excitation)
        case "rail-joint":
            yield from _joint_faults(label, excitation)
        case "dent":
            wanted, other = ("angle", "position") if excitation.get("on") == "wheel" else ("position", "angle")
            if excitation.get("on") in ("wheel", "rail"):
                where = f'with on = "{excitation["on"]}"'
                yield from _needed(label, excitation, (wanted,), where)
                yield from _unused(label, excitation, (other,), where)
        case "out-of-round":
            yield from _round_faults(label, excitation)


def _needed(label: str, table: Mapping[str, Any], keys: tuple[str, ...], where: str) -> Iterator[str]:
    for key in keys:
        if key not in table:
            yield f"{label}.{key}: missing; needed {where}"


def _unused(label: str, table: Mapping[str, Any], keys: tuple[str, ...], where: str) -> Iterator[str]:
    for key in keys:
        if key in table:
            yield f"{label}.{key}: not used {where}; leave it out"


def _position_faults(label: str, excitation: Mapping[str, Any], key: str) -> Iterator[str]:
    positions = excitation.get(key)
    if isinstance(positions, list) and len(set(map(repr, map(_as_float, positions)))) < len(positions):
        yield f"{label}.{key}: a position is given twice"


def _as_float(value: object) -> object:
    return float(value) if isinstance(value, int | float) and abs(value) < 1e9 else value


def _spectrum_faults(label: str, excitation: Mapping[str, Any], dx: float | None) -> Iterator[str]:
    if "lines" in excitation and "coherence" not in excitation:
        yield f'{label}.coherence: missing; several lines need it (a number, or "none")'
    if "coherence" in excitation and "lines" not in excitation:
        yield f"{label}.lines: missing; coherence is that of several lines; give their positions across (m)"
    yield from _position_faults(label, excitation, "lines")
    if "name" in excitation and "file" in excitation:
        yield f"{label}: name and file both given; give one of them"
    elif "name" not in excitation and "file" not in excitation:
        yield f"{label}.name: missing; give name (a spectrum that comes with the program) or file (a CSV file)"
    if "length" not in excitation:
        return
    if excitation.get("on") == "wheel":
        yield f'{label}.length: not used with on = "wheel": the line repeats every turn; leave it out'
        return
    length = positive(excitation, "length")
    if length is not None and dx is not None:
        count, fits = steps(length, dx)
        if not fits or count < 1:
            yield (
                f"{label}.length = {shown(length)}: must be a multiple of simulation.dx = {shown(dx)} (m); "
                f"the nearest is {shown(max(count, 1) * dx)}"
            )


def _flat_faults(label: str, excitation: Mapping[str, Any]) -> Iterator[str]:
    shape = excitation.get("shape")
    where = f'with shape = "{shape}"'
    if shape == "new" and "depth" not in excitation and "length" not in excitation:
        yield f"{label}.depth: missing; a new flat needs its depth or its length (m)"
    if shape == "rounded":
        yield from _needed(label, excitation, ("depth", "length"), where)
    if shape in ("new", "rounded"):
        yield from _unused(label, excitation, ("file", "lateral"), where)
    if shape == "measured":
        yield from _needed(label, excitation, ("file",), where)
        yield from _unused(label, excitation, ("depth", "length"), where)


def _joint_faults(label: str, excitation: Mapping[str, Any]) -> Iterator[str]:
    if not any(excitation.get(key) for key in ("gap", "step", "dip")):
        yield f"{label}: nothing of a joint is given; give gap, step or dip (m)"
    if excitation.get("dip", 0) and "dip_length" not in excitation:
        yield f"{label}.dip_length: missing; a dip needs its length on each side (m)"
    if excitation.get("step", 0) and "spacing" in excitation and "step_length" not in excitation:
        yield f"{label}.step_length: missing; a step that comes again has to run back to level (m)"
    spacing = positive(excitation, "spacing")
    for key in ("dip_length", "step_length"):
        length = positive(excitation, key)
        if spacing is not None and length is not None and 2 * length > spacing:
            yield f"{label}.{key} = {shown(length)}: must be <= spacing / 2 = {shown(spacing / 2)} (m)"


def _round_faults(label: str, excitation: Mapping[str, Any]) -> Iterator[str]:
    orders = excitation.get("orders")
    for key in ("amplitudes", "phases"):
        values = excitation.get(key)
        if isinstance(orders, list) and isinstance(values, list) and len(values) != len(orders):
            yield f"{label}.{key}: {len(values)} values for {len(orders)} orders; give one for each"
