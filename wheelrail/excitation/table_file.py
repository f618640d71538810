"""Tables of numbers in text files: one header line with names and units, then rows."""

from __future__ import annotations

import io
import re
from array import array
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wheelrail.errors import DataFileError
from wheelrail.numerics.column_file import read_text

__all__ = ["LENGTH_UNITS", "LEVEL_UNITS", "MAX_ROWS", "Table", "read_table"]

LENGTH_UNITS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "\u00b5m": 1e-6, "\u03bcm": 1e-6, "micron": 1e-6, "microns": 1e-6}
"""Units of length that a header may name, in m (both code points of the Greek letter)."""

LEVEL_UNITS = {"db": 1.0}
"""Units of a level."""

MAX_ROWS = 5_000_000
_UNIT = re.compile(r"^(?P<name>.*?)\s*(?:\[\s*(?P<a>[^\]]*?)\s*\]|\(\s*(?P<b>[^)]*?)\s*\)|[\s_/](?P<c>[^\s_/]+))$")


@dataclass(frozen=True, eq=False)
class Table:
    """A table read from a file.

    Attributes
    ----------
    path : Path
        The file.
    names, units : tuple of str, length columns
        Header; units in lower case.
    values : ndarray, shape (rows, columns)
        Numbers as printed, all finite.
    lines : ndarray of int, shape (rows,)
        Line of the file that holds each row, counted from 1.
    header_line : int
        Line of the file that holds the header.
    """

    path: Path
    names: tuple[str, ...]
    units: tuple[str, ...]
    values: np.ndarray
    lines: np.ndarray
    header_line: int


def _separator(header: str) -> str | None:
    for separator in (";", "\t", ","):
        if separator in header:
            return separator
    return None


def _header_columns(header: str, separator: str | None) -> list[str]:
    if separator is not None:
        return [part.strip().strip("\"'").strip() for part in header.split(separator)]
    # Blank-separated: "x [mm] r [um]" has two columns, not four.
    return [part.strip() for part in re.findall(r"[^\s\[(]+\s*(?:\[[^\]]*\]|\([^)]*\))?", header)]


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _split_unit(path: Path, line: int, column: str, units: tuple[str, ...]) -> tuple[str, str]:
    match = _UNIT.match(column)
    unit = "" if match is None else (match["a"] or match["b"] or match["c"] or "").strip().lower()
    if match is None or not unit:
        raise DataFileError(
            f"{path}, line {line}: column {column[:60]!r} names no unit; write for example x_m or height [um] "
            f"(allowed: {', '.join(units)})"
        )
    if unit not in units:
        raise DataFileError(
            f"{path}, line {line}: column {column[:60]!r} has the unit {unit[:30]!r}; allowed: {', '.join(units)}"
        )
    return match["name"].strip(" _/"), unit


def _number(path: Path, line: int, text: str, separator: str | None) -> float:
    try:
        if "_" in text:
            raise ValueError
        value = float(text)
    except ValueError:
        hint = " (decimal commas are not read: write a point)" if "," in text and separator != "," else ""
        shown = repr(text.strip()[:40]) if text.strip() else "an empty field"
        raise DataFileError(f"{path}, line {line}: {shown} is not a number{hint}") from None
    if value != value or value in (float("inf"), float("-inf")):
        raise DataFileError(f"{path}, line {line}: {text.strip()[:40]!r} is not allowed; every value must be finite")
    return value


def read_table(path: Path | str, *, column_units: tuple[tuple[str, ...], ...]) -> Table:
    """Read a table: comment lines ``#``, one header line with units, rows of numbers.

    Columns are separated by ``;``, tab, ``,`` or blanks (the first of these that the header holds). A unit follows
    the name as ``x_m``, ``x [m]``, ``x (m)``, ``x/m`` or ``x m``.

    Parameters
    ----------
    path : Path or str
        File, UTF-8 or Latin-1.
    column_units : tuple of tuple of str
        Allowed units of the first, second, ... column, in lower case; the last entry holds for all further columns.

    Returns
    -------
    Table

    Raises
    ------
    DataFileError
        Missing, empty or unreadable file, no header, missing or unknown unit, a row of another width, a value that
        is not a finite number, or more than 5 million rows.
    """
    path = Path(path)
    numbers, lines = array("d"), array("q")
    names: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    separator: str | None = None
    header_line = 0
    for line, text in enumerate(io.StringIO(read_text(path), newline=None), start=1):
        text = text.strip(" \r\n") if separator == "\t" else text.strip()
        if not text or text.startswith("#"):
            continue
        if not names:
            separator = _separator(text)
            columns = _header_columns(text, separator)
            header_line = line
            if columns and all(_is_number(column.replace(",", ".")) for column in columns):
                raise DataFileError(
                    f"{path}, line {line}: no header; the first line must name columns and units, as x_m,height_um"
                )
            if len(columns) < len(column_units):
                raise DataFileError(
                    f"{path}, line {line}: the header names {len(columns)} column; "
                    f"at least {len(column_units)} are needed"
                )
            pairs = [
                _split_unit(path, line, column, column_units[min(i, len(column_units) - 1)])
                for i, column in enumerate(columns)
            ]
            names = tuple(name for name, _ in pairs)
            units = tuple(unit for _, unit in pairs)
            continue
        fields = text.split(separator)
        if len(fields) != len(names):
            raise DataFileError(f"{path}, line {line}: {len(fields)} values, but the header names {len(names)} columns")
        if len(lines) >= MAX_ROWS:
            raise DataFileError(f"{path}, line {line}: more than {MAX_ROWS} rows; cut the file or thin it out")
        numbers.extend(_number(path, line, item, separator) for item in fields)
        lines.append(line)
    if not names:
        raise DataFileError(
            f"{path}: the file is empty; it needs a header with units, as x_m,height_um, and rows of numbers"
        )
    values = (
        np.frombuffer(numbers, dtype=np.float64).reshape(len(lines), len(names)) if lines else np.empty((0, len(names)))
    )
    return Table(path, names, units, values, np.array(lines, dtype=np.int64), header_line)
