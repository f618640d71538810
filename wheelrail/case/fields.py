"""What every section of a case file shares: strict immutable tables and fields that carry a unit and a range."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

LateralPosition = Annotated[float, Field(ge=-0.1, le=0.1)]
"""Position across a wheel or rail, m; none is wider."""

__all__ = ["LateralPosition", "Section", "allowed_words", "as_tuple", "quantity", "unit_of"]


class Section(BaseModel):
    """A table of the case file: immutable, no unknown keys, no conversions (but an int may stand for a float)."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


def quantity(description: str, unit: str, default: Any = ..., **bounds: Any) -> Any:
    """Field of a number with its unit and range.

    Parameters
    ----------
    description : str
        Meaning, for the JSON schema.
    unit : str
        SI unit; ``"1"`` for a pure number.
    default : optional
        Left out for a required key, which every physical quantity is.
    **bounds
        ``gt``, ``ge``, ``lt``, ``le``, ``multiple_of``.

    Returns
    -------
    pydantic.fields.FieldInfo
        To be assigned to an annotated class attribute.
    """
    return Field(default=default, description=description, json_schema_extra={"unit": unit}, **bounds)


def as_tuple(value: object) -> object:
    """Turn the list that TOML gives into a tuple, which an immutable table needs."""
    return tuple(value) if isinstance(value, list) else value


def allowed_words(field: Any, *, entry: bool = False) -> str | None:
    """Return what a key, or an entry of a list, may be where its type doesn't say it well.

    They are ``allowed`` and ``allowed_entry`` in the extra of the field.
    """
    extra = field.json_schema_extra
    return extra.get("allowed_entry" if entry else "allowed") if isinstance(extra, dict) else None


def unit_of(field: Any) -> str | None:
    """Return the unit of a field made by :func:`quantity`, or None for a key that is not a number."""
    extra = field.json_schema_extra
    return extra.get("unit") if isinstance(extra, dict) else None
