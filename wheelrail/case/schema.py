"""JSON schema of the case file as a user writes it, for editors."""

from __future__ import annotations

import copy
from typing import Any

from wheelrail.case.choices import TAG_KEYS
from wheelrail.case.definition import Case
from wheelrail.case.presets import Preset, presets_of
from wheelrail.case.structure_rules import WHEEL_SOURCES

__all__ = ["json_schema"]

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def json_schema() -> dict[str, Any]:
    """Return the JSON schema of a case file.

    Returns
    -------
    dict
        Draft 2020-12. Every number has a ``unit``. A section that can name a preset needs either the preset or the
        keys themselves. Rules that involve several numbers, such as a length being an odd number of dx, are checked
        when the file is read and are not in the schema.
    """
    schema = copy.deepcopy(Case.model_json_schema())
    schema = {"$schema": DIALECT, **schema, "title": "wheelrail case file"}
    schema["description"] = "A wheel/rail interaction case; SI units."
    _tidy(schema)
    definitions = schema["$defs"]
    for section in Case.model_fields:
        presets = presets_of(section)
        for definition in definitions.values() if presets else ():
            chosen = _presets_for(definition, section, presets)
            if chosen:
                _allow_presets(definition, chosen)
    _state_rules(definitions)
    return schema


def _tidy(node: Any) -> None:
    """Drop what only serves pydantic: discriminators, generated titles and nulls, which TOML does not have."""
    if isinstance(node, list):
        for item in node:
            _tidy(item)
        return
    if not isinstance(node, dict):
        return
    node.pop("discriminator", None)
    node.pop("allowed", None)
    node.pop("allowed_entry", None)
    if "default" in node and node["default"] is None:
        del node["default"]
    options = node.get("anyOf")
    if options and {"type": "null"} in options:
        rest = [option for option in options if option != {"type": "null"}]
        del node["anyOf"]
        node.update(rest[0] if len(rest) == 1 else {"anyOf": rest})
    for name, part in node.get("properties", {}).items():
        if isinstance(part, dict) and isinstance(part.get("title"), str) and name in node["properties"]:
            part.pop("title")
    for part in node.values():
        _tidy(part)


def _presets_for(definition: dict[str, Any], section: str, presets: dict[str, Preset]) -> dict[str, Preset]:
    """Presets that fill the table of a definition, by name."""
    properties = definition.get("properties", {})
    tag = TAG_KEYS.get(section)
    chosen = {}
    for name, preset in presets.items():
        same_model = tag is None or properties.get(tag, {}).get("const") == preset.values[tag]
        if same_model and set(preset.values) <= set(properties):
            chosen[name] = preset
    return chosen


def _allow_presets(definition: dict[str, Any], presets: dict[str, Preset]) -> None:
    required = definition.pop("required")
    given = set.intersection(*(set(preset.values) for preset in presets.values()))
    sources = " ".join(f"{name}: {preset.source}" for name, preset in presets.items())
    definition["properties"]["preset"] = {
        "description": f"Published values to start from; keys of the file override them. {sources}",
        "enum": list(presets),
        "type": "string",
    }
    always = [key for key in required if key not in given]
    definition["anyOf"] = [{"required": ["preset"]}, {"required": [key for key in required if key in given]}]
    if always:
        definition["required"] = always


def _state_rules(definitions: dict[str, Any]) -> None:
    """Add the rules between keys of one table that a schema can express."""
    on_wheel = {"properties": {"on": {"const": "wheel"}}, "required": ["on"]}
    definitions["Spectrum"]["oneOf"] = [{"required": ["name"]}, {"required": ["file"]}]
    definitions["Spectrum"].update({"if": on_wheel, "then": {"properties": {"length": False}}})
    definitions["Measured"].update({"if": on_wheel, "then": {"properties": {"beyond_end": False}}})
    definitions["WinklerContact"]["properties"]["prefilter"]["enum"] = ["none"]
    definitions["Output"]["properties"]["record"]["uniqueItems"] = True
    flexible = definitions["FlexibleWheel"]
    flexible["anyOf"][-1]["oneOf"] = [{"required": [key]} for key in WHEEL_SOURCES]
    filtered = {"properties": {"prefilter": {"enum": ["average", "winkler"]}}, "required": ["prefilter"]}
    definitions["HertzContact"].update({"if": filtered, "then": {"required": ["length"]}})
