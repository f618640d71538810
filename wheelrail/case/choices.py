"""Names that select a model: those of this version and those that the case file format foresees for later ones."""

from __future__ import annotations

from wheelrail.version import __version__

__all__ = ["LATER_CHOICES", "LATER_KEYS", "TAG_KEYS", "not_available"]

TAG_KEYS: dict[str, str] = {
    "wheel": "model",
    "track": "model",
    "contact": "normal",
    "friction": "law",
    "excitation": "type",
}
"""Key that says which table a section is."""

LATER_CHOICES: dict[tuple[str, str], tuple[str, ...]] = {
    ("wheel", "model"): (),
    ("track", "model"): (),
    ("contact", "normal"): (),
    ("contact", "tangential"): (),
    ("friction", "law"): (),
    ("excitation", "type"): (),
}
"""Values by section and key; every key that selects a model is here, also where nothing is to come."""

LATER_KEYS: dict[str, frozenset[str]] = {
    "contact": frozenset({"wheel_profile", "rail_profile", "inclination"}),
    "excitation": frozenset({"coherence", "lines"}),
}
"""Keys by section."""


def not_available() -> str:
    """Words that follow a name which this version does not offer."""
    return f"not available in this version ({__version__})"
