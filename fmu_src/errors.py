"""Errors of the FMU itself that a user can put right; the model's own are in ``wheelrail.errors``."""

from __future__ import annotations

__all__ = ["BuildError", "PortError", "RecordError", "SlaveError"]


class SlaveError(Exception):
    """Base class; the message says which variable or file, which value, and what is allowed."""


class PortError(SlaveError):
    """The host asks for something that the interface does not have or does not allow."""


class RecordError(SlaveError):
    """The file of the internal time history can't be written."""


class BuildError(SlaveError):
    """An FMU can't be built."""
