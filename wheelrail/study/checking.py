"""Checks of the tables of a study file, which collect faults instead of stopping at the first."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from wheelrail.case.faults import did_you_mean, in_words, shown_value

__all__ = ["TableCheck"]


class TableCheck:
    """Collects the faults of one study file.

    Attributes
    ----------
    faults : list of str
        One line each: key, value, what is allowed.
    """

    def __init__(self) -> None:
        self.faults: list[str] = []

    def known(self, table: Mapping[str, Any], allowed: tuple[str, ...], prefix: str) -> None:
        """Refuse keys that a table does not have."""
        if not prefix and {"simulation", "wheel", "track"} <= set(table):
            self.faults.append("this is a case file: wheelrail run runs it")
            return
        for key in table:
            if key not in allowed:
                hint = did_you_mean(str(key), allowed)
                self.faults.append(f"{prefix}{key}: unknown key; {hint}allowed: {in_words(allowed)}")

    def table(self, key: str, value: Any, allowed: tuple[str, ...]) -> Mapping[str, Any]:
        """Return a value if it is a table, and refuse keys that it does not have; else an empty table."""
        if not isinstance(value, Mapping):
            self.faults.append(f"{key} = {shown_value(value)}: must be a table")
            return {}
        self.known(value, allowed, f"{key}.")
        return value

    def whole(self, key: str, value: Any, least: int, most: int) -> int | None:
        """Return a value if it is a whole number within limits, or None."""
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
            self.faults.append(f"{key} = {shown_value(value)}: must be a whole number from {least} to {most}")
            return None
        return value
