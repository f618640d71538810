"""Values of the varied keys, and the cases that they make of the base case."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from copy import deepcopy
from typing import Any

import numpy as np

from wheelrail.case import Case
from wheelrail.case.faults import did_you_mean, in_words, shown_value

__all__ = ["MOST_POINTS", "combined", "flattened", "key_fault", "per_point_seeds", "spread", "with_values"]

MOST_POINTS = 100_000
_RANGE_KEYS = ("from", "to", "count", "spacing")
_DIGITS = 15  # of a double that decimal steps keep: 0.3 and not 0.30000000000000004
_FIXED = ("title", "output")  # say nothing about the run


def flattened(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return the leaves of a table by dotted key; ``"a.b" = 1`` and ``a.b = 1`` are the same."""
    leaves: dict[str, Any] = {}
    for key, value in table.items():
        name = f"{prefix}{key}"
        if isinstance(value, Mapping) and value and not is_range(value):
            leaves |= flattened(value, f"{name}.")
        else:
            leaves[name] = value
    return leaves


def is_range(value: Mapping[str, Any]) -> bool:
    """Tell a range of values from a table of keys; no key of a case file is called like this."""
    return "from" in value or "to" in value


def spread(value: Any) -> tuple[Any, ...] | str:
    """Return the values that a key of ``[vary]`` stands for, or what is allowed if it can't be understood.

    Parameters
    ----------
    value : object
        A list, or ``{from, to, count, spacing}``.
    """
    if isinstance(value, list):
        if not value:
            return "must have at least one value"
        if any(isinstance(item, Mapping) for item in value):
            return "must be a list of values, not of tables"
        shown = [shown_full(item) for item in value]
        twice = next((text for number, text in enumerate(shown) if text in shown[:number]), None)
        return tuple(value) if twice is None else f"has {twice} twice; give each value once"
    if not isinstance(value, Mapping):
        return "must be a list of values, or a range {from = , to = , count = }"
    unknown = next((key for key in value if key not in _RANGE_KEYS), None)
    if unknown is not None:
        return (
            f"{unknown}: unknown key of a range; {did_you_mean(unknown, _RANGE_KEYS)}allowed: {in_words(_RANGE_KEYS)}"
        )
    missing = [key for key in _RANGE_KEYS[:3] if key not in value]
    if missing:
        return f"a range needs {in_words(missing)}"
    first, last, count = value["from"], value["to"], value["count"]
    if not (_is_number(first) and _is_number(last)) or first == last:
        return "from and to must be two different finite numbers"
    if not isinstance(count, int) or isinstance(count, bool) or not 2 <= count <= MOST_POINTS:
        return f"count = {shown_value(count)}: must be a whole number from 2 to {MOST_POINTS}"
    spacing = value.get("spacing", "linear")
    if spacing not in ("linear", "log"):
        return f"spacing = {shown_value(spacing)}: must be one of: linear, log"
    if spacing == "log" and not (first > 0 and last > 0):
        return "from and to must be > 0 with spacing = log"
    numbers = (np.linspace if spacing == "linear" else np.geomspace)(first, last, count)
    values = [float(f"{number:.{_DIGITS}g}") for number in numbers]
    values[0], values[-1] = first, last
    if isinstance(first, int) and isinstance(last, int) and all(float(item).is_integer() for item in values):
        values = [int(item) for item in values]
    return tuple(values)


def shown_full(value: Any) -> str:
    """Return a value as text that no other value has, with 1 and 1.0 the same."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(shown_full(item) for item in value)}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) < 2**53:
        return repr(float(value))
    return repr(value)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and bool(np.isfinite(value))


def combined(columns: Sequence[tuple[Any, ...]], *, grid: bool) -> list[tuple[Any, ...]]:
    """Return the values at each point: all combinations, the last key fastest, or one after the other."""
    return list(itertools.product(*columns) if grid else zip(*columns, strict=True))


def key_fault(data: Mapping[str, Any], key: str) -> str | None:
    """Say what is wrong with a key that is to be varied, as far as one value does not matter; None if nothing is.

    Parameters
    ----------
    data : mapping
        The base case.
    key : str
        Dotted; excitations are counted from 1, as in messages about a case.
    """
    section, *rest = key.split(".")
    if section in _FIXED:
        return "can't be varied, it does not shape the run"
    if section not in Case.model_fields:
        return f"no such section; {did_you_mean(section, Case.model_fields)}allowed: {in_words(Case.model_fields)}"
    if section == "excitation":
        count = len(data.get("excitation", []))
        number = rest[0] if rest else ""
        if not (number.isascii() and number.isdigit() and 1 <= int(number) <= count):
            allowed = "excitation.1.KEY" if count == 1 else f"excitation.1.KEY to excitation.{count}.KEY"
            return (
                f"excitations are counted from 1; the case has {count}, so "
                f"{allowed if count else 'there is nothing to vary'}"
            )
        rest = rest[1:]
    if len(rest) != 1 or not rest[0]:
        return f"must be a key of a table, such as {'excitation.1' if section == 'excitation' else section}.KEY"
    return None


def with_values(data: Mapping[str, Any], keys: Sequence[str], values: Sequence[Any]) -> dict[str, Any]:
    """Return the base case with other values of some keys, which `key_fault` finds nothing wrong with."""
    changed = deepcopy(dict(data))
    for key, value in zip(keys, values, strict=True):
        section, *middle, last = key.split(".")
        table = changed[section][int(middle[0]) - 1] if middle else changed.setdefault(section, {})
        table[last] = list(value) if isinstance(value, tuple) else value
    return changed


def per_point_seeds(data: dict[str, Any], *, seed: int, index: int) -> None:
    """Give each random line of a case a seed that depends on the study's seed, the point and the line alone.

    The seeds are those of `numpy.random.SeedSequence`, whose numbers numpy keeps stable.
    """
    for number, table in enumerate(data.get("excitation", [])):
        if "seed" in table:
            words = np.random.SeedSequence([seed, index, number]).generate_state(1)
            table["seed"] = int(words[0]) & 0x7FFFFFFF
