"""Pydantic's findings in the words of the case file: key, value, what is allowed."""

from __future__ import annotations

import difflib
import json
import types
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt, MultipleOf
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from wheelrail.case.choices import TAG_KEYS
from wheelrail.case.consistency import excitation_label
from wheelrail.case.definition import Case
from wheelrail.case.fields import allowed_words, unit_of
from wheelrail.case.presets import presets_of

__all__ = [
    "available_choices",
    "closest",
    "did_you_mean",
    "error_line",
    "in_words",
    "is_known_key",
    "location",
    "must_be_one_of",
    "preset_hint",
    "shown_value",
]

RANGE_ERRORS = frozenset({"greater_than", "greater_than_equal", "less_than", "less_than_equal"})


def section_models(section: str) -> dict[str | None, type[BaseModel]]:
    """Tables that a section can be, by the value of its tag key (None for a section without one)."""
    models: list[type[BaseModel]] = [
        part for part in _leaves(Case.model_fields[section].annotation) if isinstance(part, type)
    ]
    models = [model for model in models if issubclass(model, BaseModel)]
    tag = TAG_KEYS.get(section)
    if tag is None:
        return {None: models[0]} if models else {}
    return {get_args(model.model_fields[tag].annotation)[0]: model for model in models}


def _leaves(annotation: Any) -> list[Any]:
    if get_origin(annotation) is Literal or not get_args(annotation):
        return [annotation]
    return [leaf for part in get_args(annotation) for leaf in _leaves(part)]


def shown_value(value: object) -> str:
    """Return a value as TOML would show it, cut if long."""
    if isinstance(value, bool | str | list | tuple | dict):
        text = json.dumps(value, ensure_ascii=False, default=str)
    else:
        text = str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def in_words(names: Iterable[str]) -> str:
    """Join names by commas."""
    return ", ".join(names)


def closest(word: str, known: Iterable[str], *, cutoff: float = 0.6) -> str | None:
    """Nearest known name, if any is near enough."""
    return next(iter(difflib.get_close_matches(word, list(known), n=1, cutoff=cutoff)), None)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return the nearest known name as a clause, or nothing."""
    near = closest(word, known)
    return f"did you mean '{near}'? " if near else ""


def must_be_one_of(names: Sequence[str]) -> str:
    """Say which names are allowed."""
    return "must be " + ("one of: " if len(names) > 1 else "") + in_words(names)


def is_known_key(section: str, key: str) -> bool:
    """Tell whether any table of a section has a key."""
    return any(key in model.model_fields for model in section_models(section).values())


def available_choices(section: str, key: str) -> list[str]:
    """Names that a key can have in any table of its section."""
    fields = [model.model_fields[key] for model in section_models(section).values()]
    return list(dict.fromkeys(name for field in fields for name in _choices(field)))


def location(loc: Sequence[str | int]) -> str:
    """Name of a key in the file; excitations are counted from 1."""
    if loc[0] == "excitation" and len(loc) > 1 and isinstance(loc[1], int):
        return ".".join([excitation_label(loc[1]), *map(str, loc[2:])])
    text = str(loc[0])
    for part in loc[1:]:
        text += f"[{part}]" if isinstance(part, int) else f".{part}"
    return text


def preset_hint(section: str, key: str | None = None, tag: str | None = None) -> str:
    """Clause that offers presets.

    Parameters
    ----------
    section : str
        Section to offer presets for.
    key : str, optional
        Offer only those that give this key.
    tag : str, optional
        Offer only those for this model.

    Returns
    -------
    str
        `` or name a preset (...)``, empty if there is none.
    """
    names = []
    for name, preset in presets_of(section).items():
        right_model = tag is None or preset.values.get(TAG_KEYS[section]) == tag
        if right_model and (key is None or key in preset.values):
            names.append(f'preset = "{name}"')
    return f" or name a preset ({' or '.join(names)})" if names else ""


def table_hint(section: str) -> str:
    """Say what to write for a missing section."""
    models = section_models(section)
    if section in TAG_KEYS:
        keys = f"{TAG_KEYS[section]} = " + " | ".join(f'"{name}"' for name in models)
    else:
        keys = in_words(name for name, field in models[None].model_fields.items() if field.is_required())
    return f"add a table [{section}] with {keys}{preset_hint(section)}"


def error_line(error: Mapping[str, Any], loc: tuple[str | int, ...], tag: str | None) -> str:
    """Put one pydantic error in one line.

    Parameters
    ----------
    error : mapping
        Entry of ``ValidationError.errors()``.
    loc : tuple
        Its place in the file, without pydantic's union tags.
    tag : str or None
        Value of the section's tag key.

    Returns
    -------
    str
        Key, value, what is allowed.
    """
    section, kind = str(loc[0]), error["type"]
    where = location(loc)
    if len(loc) == 1 and kind == "extra_forbidden":
        return _unknown_section(section, error["input"])
    if len(loc) == 1 and kind == "missing":
        return f"{where}: missing; {table_hint(section)}"
    if section == "title":
        return f"{where} = {shown_value(error['input'])}: must be text"
    key = next(str(part) for part in loc[1:] if isinstance(part, str))
    model = section_models(section)[tag]
    if kind == "extra_forbidden":
        return _unknown_key(where, section, key, tag, model)
    field = model.model_fields[key]
    if kind == "missing":
        give = f"give one of: {in_words(_choices(field))};" if _choices(field) else f"give it{_unit(field)}"
        give = "give true or false" if field.annotation is bool else give
        return f"{where}: missing; {give}{preset_hint(section, key, tag)}".rstrip(";")
    bounds = _bounds(field) if kind in RANGE_ERRORS and not _is_even(field) else ""
    allowed = bounds + _unit(field) if bounds else allowed_values(field, item=isinstance(loc[-1], int))
    suggestion = ""
    if kind == "literal_error" and isinstance(error["input"], str):
        suggestion = did_you_mean(error["input"], _choices(field))
    return f"{where} = {shown_value(error['input'])}: {suggestion}must be {allowed}"


def _unknown_section(name: str, value: object) -> str:
    if not isinstance(value, dict):
        homes = [section for section in Case.model_fields if is_known_key(section, name)]
        if homes:
            return f"{name}: unknown key; it belongs in a table: [{homes[0]}]"
    if name in ("vary", "point"):
        return f"{name}: unknown key; this is a study file: wheelrail study runs it"
    return f"{name}: unknown key; {did_you_mean(name, Case.model_fields)}allowed: {in_words(Case.model_fields)}"


def _unknown_key(where: str, section: str, key: str, tag: str | None, model: type[BaseModel]) -> str:
    allowed = [*model.model_fields, *(["preset"] if presets_of(section) else [])]
    if tag is not None and is_known_key(section, key):
        return f'{where}: not used with {TAG_KEYS[section]} = "{tag}"; allowed: {in_words(allowed)}'
    return f"{where}: unknown key; {did_you_mean(key, allowed)}allowed: {in_words(allowed)}"


def _unit(field: FieldInfo) -> str:
    unit = unit_of(field)
    return f" ({unit})" if unit and unit != "1" else ""


def _bounds(field: FieldInfo) -> str:
    parts = []
    for bound in field.metadata:
        match bound:
            case Gt(gt=limit):
                parts.append(f"> {limit}")
            case Ge(ge=limit):
                parts.append(f">= {limit}")
            case Lt(lt=limit):
                parts.append(f"< {limit}")
            case Le(le=limit):
                parts.append(f"<= {limit}")
    return " and ".join(parts)


def _is_even(field: FieldInfo) -> bool:
    return any(isinstance(part, MultipleOf) and part.multiple_of == 2 for part in field.metadata)


def _choices(field: FieldInfo) -> list[str]:
    return [value for leaf in _leaves(field.annotation) if get_origin(leaf) is Literal for value in get_args(leaf)]


def allowed_values(field: FieldInfo, *, item: bool = False) -> str:
    """Say what a key may be.

    Parameters
    ----------
    field : FieldInfo
        The key.
    item : bool
        True for an entry of a key that is a list.

    Returns
    -------
    str
        For example ``a number > 0 (N/m)``.
    """
    words = allowed_words(field, entry=item)
    if words:
        return words
    choices = _choices(field)
    outer = get_origin(field.annotation)
    is_list = outer is tuple and not item
    if choices and is_list:
        return f"a list of at least one of: {in_words(choices)}"
    if choices:
        return ("one of: " if len(choices) > 1 else "") + in_words(choices)
    leaves = _leaves(field.annotation) if outer in (Union, types.UnionType) else [field.annotation]
    if bool in leaves:
        return "true or false"
    if str in leaves and int in leaves:
        return "text, not empty, or a whole number >= 1"
    if str in leaves:
        return "text, not empty"
    noun = ("an even whole number" if _is_even(field) else "a whole number") if int in leaves else "a finite number"
    return f"{noun} {_bounds(field)}".rstrip() + _unit(field)
