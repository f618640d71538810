"""Named sets of published values that a section of a case file can start from."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

__all__ = ["Preset", "load_presets", "presets_of"]


@dataclass(frozen=True)
class Preset:
    """A named set of values.

    Attributes
    ----------
    name : str
        Name in the case file.
    section : str
        Section it belongs to.
    source : str
        Where the values come from.
    values : dict
        Keys and values, SI units.
    """

    name: str
    section: str
    source: str
    values: dict[str, Any]


@cache
def load_presets() -> tuple[Preset, ...]:
    """Return every preset that comes with the program."""
    text = resources.files("wheelrail.case").joinpath("presets.toml").read_text(encoding="utf-8")
    return tuple(Preset(**entry) for entry in tomllib.loads(text)["preset"])


def presets_of(section: str) -> dict[str, Preset]:
    """Presets of one section by name; empty if it has none."""
    return {preset.name: preset for preset in load_presets() if preset.section == section}
