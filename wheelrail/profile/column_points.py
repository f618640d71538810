"""Profiles as plain columns of numbers: lateral and vertical coordinate.

Columns are separated by ``;``, tab, ``,`` or blanks (the first of these in the first line). Lines that start with
``#``, ``!`` or ``%`` are comments. A header line is optional; it may name the columns (y and z, x and y, or x and z)
and their unit, as ``y [mm]``, ``y (mm)`` or ``y_mm``.
"""

from __future__ import annotations

import re
from pathlib import Path

from ..errors import DataFileError
from .file_points import FilePoints, finite_number, numbered_lines, point_arrays

__all__ = ["UNITS", "read_column_points"]

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "\u00b5m": 1e-6, "\u03bcm": 1e-6, "in": 25.4e-3}
"""Units of length that a header may name, m (both code points of the Greek letter)."""

_PAIRS = (("y", "z"), ("x", "y"), ("x", "z"))
_BRACKETED = re.compile(r"(?P<name>[^\[\](),;]*?)[\s_]*[\[(]\s*(?P<unit>[^\])]*?)\s*[\])]$")
_SUFFIXED = re.compile(r"(?P<name>.+?)[_/\s](?P<unit>[^_/\s]+)$")


def read_column_points(path: Path) -> FilePoints:
    """Read a profile from columns of a text file.

    Parameters
    ----------
    path : Path

    Returns
    -------
    FilePoints
        Without a unit if no header names one.

    Raises
    ------
    DataFileError
        Unreadable file, a header that doesn't tell the columns, an unknown unit, a row of another width or with
        something that isn't a finite number.
    """
    separator: str | None = None
    width, lateral, vertical, unit = 0, 0, 1, None
    points: list[tuple[float, float]] = []
    lines: list[int] = []
    notes: list[str] = []
    for line, text in numbered_lines(path):
        if not text or text[0] in "#!%":
            continue
        where = f"{path}, line {line}"
        if not width:
            separator = next((mark for mark in (";", "\t", ",") if mark in text), None)
            fields = _fields(text, separator)
            width = len(fields)
            if any(_is_number(field) for field in fields):
                if width != 2:
                    raise DataFileError(
                        f"{where}: {width} columns and no header; allowed are two, or a header that names y and z"
                        + ("; decimal commas are not read: write points" if separator == "," else "")
                    )
                notes.append("no header: first column taken as lateral, second as vertical")
            else:
                if separator is None:
                    fields = [part.strip() for part in re.findall(r"[^\s\[(]+\s*(?:\[[^\]]*\]|\([^)]*\))?", text)]
                    width = len(fields)
                lateral, vertical, unit, told = _header(where, fields)
                notes += told
                continue
        fields = text.split(separator)
        if len(fields) != width:
            hint = "; decimal commas are not read: write points" if separator == "," else ""
            raise DataFileError(f"{where}: {len(fields)} values; the lines before have {width}{hint}")
        points.append((finite_number(where, fields[lateral]), finite_number(where, fields[vertical])))
        lines.append(line)
    values, line_numbers = point_arrays(points, lines)
    return FilePoints(values, line_numbers, unit, None, tuple(notes))


def _fields(text: str, separator: str | None) -> list[str]:
    return [field.strip().strip("\"'").strip() for field in text.split(separator)]


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True


def _header(where: str, columns: list[str]) -> tuple[int, int, float | None, list[str]]:
    """Positions of the lateral and vertical column, their unit, m, and what was taken for granted."""
    names, units = zip(*(_name_and_unit(where, column) for column in columns), strict=True)
    for pair in _PAIRS:
        if all(names.count(name) == 1 for name in pair):
            lateral, vertical = (names.index(name) for name in pair)
            notes = []
            break
    else:
        if len(names) != 2:
            shown = ", ".join(column[:20] for column in columns[:8])
            raise DataFileError(f"{where}: columns {shown}; allowed are two columns, or more of which two are y and z")
        lateral, vertical = 0, 1
        notes = [f"columns taken as lateral ({columns[0][:40]}) and vertical ({columns[1][:40]})"]
    if units[lateral] != units[vertical]:
        raise DataFileError(f"{where}: columns {columns[lateral][:40]!r} and {columns[vertical][:40]!r} differ in unit")
    return lateral, vertical, units[lateral], notes


def _name_and_unit(where: str, column: str) -> tuple[str, float | None]:
    folded = column.lower()
    match = _BRACKETED.match(folded)
    if match:
        if match["unit"] not in UNITS:
            raise DataFileError(
                f"{where}: column {column[:40]!r}: unit {match['unit'][:20]!r}; allowed: {', '.join(UNITS)}"
            )
        return match["name"].strip(), UNITS[match["unit"]]
    match = _SUFFIXED.match(folded)
    if match and match["unit"] in UNITS:
        return match["name"].strip(), UNITS[match["unit"]]
    return folded, None
