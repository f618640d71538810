"""All faults of a case in one report."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from wheelrail.case.choices import MODEL_KEYS, TAG_KEYS
from wheelrail.case.consistency import cross_faults
from wheelrail.case.definition import Case
from wheelrail.case.faults import (
    available_choices,
    closest,
    did_you_mean,
    error_line,
    in_words,
    is_known_key,
    location,
    must_be_one_of,
    preset_hint,
    shown_value,
)
from wheelrail.case.presets import presets_of
from wheelrail.case.profile_rules import RAIL_PROFILES, WHEEL_PROFILES
from wheelrail.case.structure_rules import WHEEL_SOURCES
from wheelrail.case.track_sections import RAIL_SECTIONS
from wheelrail.case.wheel_sections import WHEEL_SECTIONS

__all__ = ["CaseCheck"]

Place = tuple[str | int, ...]

SELECTORS = {section: (key,) for section, key in TAG_KEYS.items()}
"""Keys that decide which other keys a section has."""


class CaseCheck:
    """Collects the faults of one case; a bad selector is replaced so that the rest of its table is still checked.

    Parameters
    ----------
    data : mapping
        Values in the layout of the case file; not changed.
    folder : pathlib.Path
        Folder that data files are relative to.

    Attributes
    ----------
    data : dict
        The values, with presets resolved by :meth:`run`.
    faults : list of str
        Fault lines found by :meth:`run`, in the order of the sections.
    """

    def __init__(self, data: Mapping[str, Any], *, folder: Path) -> None:
        self.data: dict[str, Any] = _as_from_toml(data)
        self.folder = folder
        self.faults: list[str] = []
        self._done: set[Place] = set()  # places that already have their fault
        self._incomplete: set[Place] = set()  # tables whose keys can't be told missing
        self._untold: set[Place] = set()  # tables that don't say which of this version's they are

    def run(self) -> Case | None:
        """Check everything; None if there are faults."""
        tables = self._tables()
        for place, table in tables:
            self._merge_preset(str(place[0]), table)
        # Before selectors are replaced: rules between keys are for the models that the file asks for.
        self.faults += cross_faults(self.data)
        self._check_files()
        for place, table in tables:
            self._check_choices(place, table)
        case = None
        try:
            case = Case.model_validate(self.data)
        except ValidationError as error:
            self._add_errors(error)
            if not self.faults:  # never call a case good that validation refused
                self.faults = [entry["msg"] for entry in error.errors()]
        self.faults.sort(key=_file_order)
        return None if self.faults else case

    def _tables(self) -> list[tuple[Place, dict[str, Any]]]:
        """Every table of the case with its place; those of the wrong type get their fault and are passed over."""
        tables: list[tuple[Place, Any]] = []
        for section in Case.model_fields:
            if section == "title" or section not in self.data:
                continue
            value = self.data[section]
            if section == "excitation":
                if not isinstance(value, list):
                    self._fault((section,), "excitation: must be an array of tables; write [[excitation]]")
                    self.data[section] = []
                    continue
                tables += [((section, index), item) for index, item in enumerate(value)]
            else:
                tables.append(((section,), value))
        for loc, value in tables:
            if not isinstance(value, dict):
                self._fault(loc, f"{location(loc)} = {shown_value(value)}: must be a table")
        return [(loc, value) for loc, value in tables if isinstance(value, dict)]

    def _fault(self, loc: Place, line: str) -> None:
        self.faults.append(line)
        self._done.add(loc)

    def _merge_preset(self, section: str, table: dict[str, Any]) -> None:
        presets = presets_of(section)
        if "preset" not in table or not presets:
            return
        name = table.pop("preset")
        preset = presets.get(name) if isinstance(name, str) else None
        where = f"{section}.preset = {shown_value(name)}"
        if preset is None:
            self._incomplete.add((section,))
            self.faults.append(f"{where}: no such preset; known for [{section}]: {in_words(presets)}")
            return
        tag = TAG_KEYS.get(section)
        if tag in table and table[tag] != preset.values.get(tag):
            self._incomplete.add((section,))
            self.faults.append(
                f'{where}: is for {tag} = "{preset.values[tag]}", but {section}.{tag} = {shown_value(table[tag])}'
            )
            return
        kind = next((key for key in ("support", *WHEEL_SOURCES) if key in preset.values), "")
        others = [key for key in WHEEL_SOURCES if key in table and key != kind] if kind in WHEEL_SOURCES else []
        if others or (kind == "support" and table.get(kind, preset.values[kind]) != preset.values[kind]):
            self._incomplete.add((section,))
            given = f"{others[0]} is given" if others else f"{section}.{kind} = {shown_value(table[kind])}"
            its = kind if others else f"{kind} = {shown_value(preset.values[kind])}"
            self.faults.append(f"{where}: is for {its}, but {given}; give the keys themselves")
            return
        for key, value in preset.values.items():
            table.setdefault(key, value)

    def _check_choices(self, loc: Place, table: dict[str, Any]) -> None:
        """Judge the keys that select a model, before validation picks a table by them."""
        section = str(loc[0])
        for name, key in MODEL_KEYS:
            if name != section:
                continue
            available = available_choices(section, key)
            line = self._choice_fault(section, location((*loc, key)), table, key, available)
            if line is None:
                continue
            if key in table or loc not in self._incomplete:
                self.faults.append(line)
            self._done.add((*loc, key))
            if key in SELECTORS.get(section, ()):
                # Only the keys that the tables share can still be judged; any available table will do for that.
                self._incomplete.add(loc)
                self._untold.add(loc)
                table[key] = closest(str(table.get(key)), available) or available[-1]

    @staticmethod
    def _choice_fault(section: str, where: str, table: dict[str, Any], key: str, available: list[str]) -> str | None:
        if key not in table:
            if key != TAG_KEYS.get(section):
                return None
            return f"{where}: missing; give one of: {in_words(available)};{preset_hint(section, key)}".rstrip(";")
        value = table[key]
        if value in available:
            return None
        suggestion = did_you_mean(value, available) if isinstance(value, str) else ""
        return f"{where} = {shown_value(value)}: {suggestion}{must_be_one_of(available)}"

    def _add_errors(self, error: ValidationError) -> None:
        entries = error.errors()
        for entry in entries:
            loc = entry["loc"]
            if not loc:
                continue  # cross_faults says it
            if entry["type"] == "too_short" and any(
                len(other["loc"]) > len(loc) and other["loc"][: len(loc)] == loc for other in entries
            ):
                continue  # pydantic doesn't count refused entries, which have their own faults
            depth = 2 if loc[0] == "excitation" else 1
            tag = None
            if loc[0] in TAG_KEYS and len(loc) > depth:
                tag = str(loc[depth])
                loc = (*loc[:depth], *loc[depth + 1 :])
            # Past the key only the number of a list's entry belongs to the file; the rest is pydantic's.
            loc = (*loc[: depth + 1], *(part for part in loc[depth + 1 :] if isinstance(part, int)))
            if any(loc[:length] in self._done for length in range(1, len(loc) + 1)):
                continue
            if len(loc) > depth and self._doubtful(entry["type"], loc[:depth], str(loc[depth])):
                continue
            self._fault(loc, error_line(entry, loc, tag))

    def _doubtful(self, kind: str, table: Place, key: str) -> bool:
        """Tell whether a key can't be called missing or unknown because the model of its table is not known."""
        if kind == "missing":
            return table in self._incomplete
        if kind == "extra_forbidden":
            return table in self._untold and is_known_key(str(table[0]), key)
        return False

    def _check_files(self) -> None:
        excitations = self.data.get("excitation", [])
        for index, table in enumerate(excitations):
            if isinstance(table, dict) and table.get("type") in ("measured", "spectrum", "wheel-flat"):
                self._check_file(("excitation", index, "file"), table.get("file"), ())
        contact = self.data.get("contact")
        if isinstance(contact, dict):
            self._check_file(("contact", "wheel_profile"), contact.get("wheel_profile"), WHEEL_PROFILES)
            self._check_file(("contact", "rail_profile"), contact.get("rail_profile"), RAIL_PROFILES)
        for section, key, presets in (
            ("wheel", "section", WHEEL_SECTIONS),
            ("wheel", "modes", ()),
            ("wheel", "receptances", ()),
            ("track", "section", RAIL_SECTIONS),
        ):
            table = self.data.get(section)
            if isinstance(table, dict) and table.get("model") in ("flexible", "waveguide"):
                self._check_file((section, key), table.get(key), presets)

    def _check_file(self, loc: Place, file: object, presets: Sequence[str]) -> None:
        """Check that a data file exists, unless its name is that of something that comes with the program."""
        if not isinstance(file, str) or not file or file.lower() in presets:
            return
        path = self.folder / file
        where = f"{location(loc)} = {shown_value(file)}"
        if path.is_dir():
            self.faults.append(f"{where}: is a folder; give a data file")
        elif not path.is_file():
            known = f"{did_you_mean(file, presets)}it comes with the program ({in_words(presets)}) or is a file; "
            self.faults.append(f"{where}: {known if presets else 'no such file; '}looked for {path.absolute()}")


def _as_from_toml(value: Any) -> Any:
    """Copy plain values into what TOML could have given: lists for tuples, nothing for None."""
    if isinstance(value, Mapping):
        return {key: _as_from_toml(item) for key, item in value.items() if item is not None}
    if isinstance(value, list | tuple):
        return [_as_from_toml(item) for item in value]
    return value


def _file_order(line: str) -> tuple[int, int]:
    """Place of a fault line in the order of the sections; unknown ones come last."""
    match = re.match(r"(\w+)(?: #(\d+))?", line)
    names = list(Case.model_fields)
    if match is None or match[1] not in names:
        return len(names), 0
    return names.index(match[1]), int(match[2] or 0)
