"""Errors a user can cause: each carries one complete message and needs no traceback."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = [
    "CaseError",
    "ContactGridError",
    "DataFileError",
    "ExcitationRangeError",
    "ModelFileError",
    "ParameterError",
    "StateError",
    "WheelrailError",
]


class WheelrailError(Exception):
    """Base class; ``str(error)`` says which file, key or port, which value, and what is allowed."""


class CaseError(WheelrailError):
    """A case file is refused.

    Parameters
    ----------
    source : str
        File (or other origin) of the case.
    faults : sequence of str
        Every fault found, one line each: key, value, what is allowed.
    """

    def __init__(self, source: str, faults: Sequence[str]) -> None:
        self.source = source
        self.faults = tuple(faults)
        count = "1 fault" if len(self.faults) == 1 else f"{len(self.faults)} faults"
        super().__init__(f"{source}: {count}\n" + "\n".join(f"  - {fault}" for fault in self.faults))


class DataFileError(WheelrailError):
    """A data file (roughness, spectrum, profile) can't be read or used."""


class ExcitationRangeError(WheelrailError):
    """A run leaves the stretch that a measured line covers."""


class ModelFileError(WheelrailError):
    """A saved model is missing, damaged or of another version."""


class ParameterError(WheelrailError):
    """A port or parameter got a value that is not allowed.

    Parameters
    ----------
    name : str
        Port or parameter.
    value : object
        The refused value.
    allowed : str
        What is allowed, and what to do instead.
    """

    def __init__(self, name: str, value: object, allowed: str) -> None:
        self.name = name
        self.value = value
        super().__init__(f"{name} = {value!r} is refused: {allowed}")


class ContactGridError(WheelrailError):
    """The contact reaches the edge of the potential contact area."""


class StateError(WheelrailError):
    """A saved state does not belong to this model or is damaged."""
