"""Keys that select a model."""

from __future__ import annotations

__all__ = ["MODEL_KEYS", "TAG_KEYS"]

TAG_KEYS: dict[str, str] = {
    "wheel": "model",
    "track": "model",
    "contact": "normal",
    "friction": "law",
    "excitation": "type",
}
"""Key that says which table a section is."""

MODEL_KEYS: tuple[tuple[str, str], ...] = (*TAG_KEYS.items(), ("contact", "tangential"))
"""Section and key of everything that selects a model."""
