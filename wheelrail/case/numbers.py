"""Numbers of a case file as the rules between keys read and print them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

__all__ = ["GRID_TOLERANCE", "number", "positive", "shown", "steps"]

GRID_TOLERANCE = 1e-6
"""A length counts as n grid steps if it is so to this share of a step; decimal fractions are not exact."""


def shown(value: float) -> str:
    """Return a number as a user would type it."""
    return f"{value:.12g}"


def number(table: Mapping[str, Any], key: str) -> float | None:
    """Return the finite number at a key; None if there is none."""
    value = table.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        return float(value) if math.isfinite(value) else None
    except OverflowError:
        return None


def positive(table: Mapping[str, Any], key: str) -> float | None:
    """Return the positive number at a key; None if there is none."""
    value = number(table, key)
    return value if value is not None and value > 0 else None


def steps(length: float, step: float) -> tuple[float, bool]:
    """Nearest whole number of steps in a length, and whether the length is that number of steps."""
    count = length / step
    if not math.isfinite(count):
        return 0.0, False
    return round(count) + 0.0, abs(count - round(count)) <= GRID_TOLERANCE
