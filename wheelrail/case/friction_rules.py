"""Faults between the keys of ``[friction]``, and with the contact model that uses them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

__all__ = ["friction_faults"]

_OF_TRANSIENT = {"solver": "newton", "branch": "previous", "find_solutions": False}


def friction_faults(friction: Mapping[str, Any], contact: Mapping[str, Any]) -> Iterator[str]:
    """Find the faults of a friction table.

    Parameters
    ----------
    friction, contact : mapping
        Tables of the case, presets resolved.
    """
    law, tangential = friction.get("law"), contact.get("tangential")
    if law in ("kraft", "polach", "exponential", "rational", "table"):
        if tangential == "fastsim":
            yield f'friction.law = "{law}": only with contact.tangential = "transient" or "friction-curve"'
        if _is_positive(friction.get("memory_distance")) and "memory_speed" not in friction:
            yield "friction.memory_speed: missing; friction.memory_distance needs it (m/s); 1e-3 is usual"
        if "memory_speed" in friction and friction.get("memory_distance", 0.0) == 0.0:
            yield "friction.memory_distance: missing or 0, so that there is no memory; memory_speed needs it (m)"
        if tangential == "friction-curve":
            for key, default in _OF_TRANSIENT.items():
                if friction.get(key, default) != default:
                    yield f'friction.{key}: only with contact.tangential = "transient"; leave it out'
    share = friction.get("square_share")
    if law == "rational" and _is_positive(share, highest=1.0) and "square_half_speed" not in friction:
        yield "friction.square_half_speed: missing; friction.square_share needs it (m/s)"
    if law == "table":
        yield from _table_faults(friction)


def _table_faults(friction: Mapping[str, Any]) -> Iterator[str]:
    speeds, coefficients = _numbers(friction.get("speeds")), _numbers(friction.get("coefficients"))
    if speeds and speeds[0] != 0.0:
        yield f"friction.speeds: the first is {speeds[0]:g}; it must be 0 (m/s), where the static coefficient belongs"
    for number, (before, after) in enumerate(pairwise(speeds), 2):
        if after <= before:
            yield f"friction.speeds: value {number} is {after:g} after {before:g}; they must rise"
            break
    if speeds and coefficients and len(speeds) != len(coefficients):
        yield f"friction.coefficients: {len(coefficients)} values for {len(speeds)} speeds; give one for each"


def _is_positive(value: object, *, highest: float = math.inf) -> bool:
    """Tell whether a value is a good one above 0; bad ones have their own faults."""
    return isinstance(value, int | float) and not isinstance(value, bool) and 0.0 < value <= highest


def _numbers(values: object) -> list[float]:
    """Values of a list if all of them are numbers, else none: they have their own faults."""
    if not isinstance(values, list | tuple):
        return []
    good = [value for value in values if isinstance(value, int | float) and not isinstance(value, bool)]
    return [float(value) for value in good] if len(good) == len(values) else []
