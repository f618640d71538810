"""Text files with one named column per quantity: a header line with names and units, then rows.

Lines that start with ``#`` are comments. Columns are separated by ``;``, tab or ``,`` (the first of these that the
header holds). A unit follows its name in brackets, as ``frequency [Hz]`` or ``frequency (Hz)``, or after an underscore,
as ``frequency_Hz``. A field that holds the separator stands in double quotes.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError

__all__ = ["ColumnFile", "read_columns", "read_text"]

_MOST_BYTES = 1_000_000_000
_SEPARATORS = (";", "\t", ",")


def read_text(path: Path) -> str:
    """Return the text of a file in UTF-8 or, failing that, Latin-1.

    Raises
    ------
    DataFileError
        If there is no such file or it isn't text.
    """
    try:
        size = path.stat().st_size
        if not (path.is_file() or path.is_dir()):  # a pipe would never end
            raise DataFileError(f"{path}: is no ordinary file")
        if size > _MOST_BYTES:
            shown = f"{size / 1e9:.1f} GB; at most {_MOST_BYTES / 1e9:.0f} GB are read"
            raise DataFileError(f"{path}: {shown}; cut the file")
        raw = path.read_bytes()
    except FileNotFoundError:
        raise DataFileError(f"{path}: there is no such file") from None
    except IsADirectoryError:
        raise DataFileError(f"{path}: this is a folder, not a file") from None
    except (OSError, ValueError) as error:
        raise DataFileError(f"{path}: can't be read: {getattr(error, 'strerror', None) or error}") from None
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise DataFileError(f"{path}: the text is in UTF-16; save it as UTF-8")
    if b"\x00" in raw:
        raise DataFileError(f"{path}: this is not a text file (it holds zero bytes)")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")  # instruments write the micro sign as one byte


@dataclass(frozen=True, eq=False)
class ColumnFile:
    """A file's columns as text.

    Attributes
    ----------
    path : Path
    header_line : int
        Line that holds the header, counted from 1.
    lines : tuple of int
        Line of each row.
    units : dict of str to str
        Unit of each column as the header gives it; empty: none.
    fields : dict of str to tuple of str
        Entries of each column.
    """

    path: Path
    header_line: int
    lines: tuple[int, ...]
    units: dict[str, str]
    fields: dict[str, tuple[str, ...]]

    def factor(self, name: str, units: Mapping[str, float]) -> float:
        """Factor of a column's unit.

        Parameters
        ----------
        name : str
        units : mapping of str to float
            Allowed units, compared without blanks and without regard to case unless only the case differs; the key ""
            allows a column without one.

        Raises
        ------
        DataFileError
            If the column has another unit or none.
        """
        given = self.units[name].replace(" ", "")
        for known in (units, {unit.lower(): factor for unit, factor in units.items()}):
            for candidate in (given, given.lower()):
                if candidate in known:
                    return known[candidate]
        allowed = ", ".join(unit for unit in units if unit)
        where = f"{self.path}, line {self.header_line}: column {name}"
        if not given:
            example = next(unit for unit in units if unit)
            raise DataFileError(f'{where} names no unit; write "{name} [{example}]" (allowed: {allowed})')
        if not allowed:
            raise DataFileError(f"{where} has the unit [{given}]; it is a number without a unit")
        raise DataFileError(f"{where} has the unit [{given}]; allowed: {allowed}{' or none' if '' in units else ''}")

    def numbers(self, name: str, units: Mapping[str, float]) -> NDArray:
        """Numbers of a column in the unit whose factor is 1.

        Parameters
        ----------
        name : str
        units : mapping of str to float
            As for `factor`.

        Returns
        -------
        ndarray, shape (rows,)

        Raises
        ------
        DataFileError
            For another unit or an entry that isn't a finite number.
        """
        factor = self.factor(name, units)
        result = np.empty(len(self.lines))
        for i, (line, text) in enumerate(zip(self.lines, self.fields[name], strict=True)):
            try:
                value = math.nan if "_" in text else float(text)
            except ValueError:
                value = math.nan
            if not math.isfinite(value):
                shown = f'"{text[:40]}"' if text else "an empty field"
                hint = "; decimal commas are not read: write a point" if "," in text else ""
                raise DataFileError(f"{self.path}, line {line}: {name} is {shown}, not a finite number{hint}")
            result[i] = value * factor
        return result


def read_columns(path: Path | str, *, known: Sequence[str]) -> ColumnFile:
    """Read a file of named columns.

    Parameters
    ----------
    path : Path or str
    known : sequence of str
        Names that columns may have, in any order.

    Returns
    -------
    ColumnFile
        With at least one row.

    Raises
    ------
    DataFileError
        Unreadable or empty file, unknown or repeated column, row of another length.
    """
    path = Path(path)
    header_line, separator = 0, ","
    names: list[str] = []
    units: dict[str, str] = {}
    rows: list[list[str]] = []
    lines: list[int] = []
    for line, text in enumerate(read_text(path).splitlines(), start=1):
        if not text.strip() or text.lstrip().startswith("#"):
            continue
        if not header_line:
            header_line = line
            separator = next((mark for mark in _SEPARATORS if mark in text), ",")
            names, units = _header(path, line, _split(text, separator), known)
            continue
        row = _split(text, separator)
        if len(row) != len(names):
            raise DataFileError(
                f"{path}, line {line}: {len(row)} entries, but the header names {len(names)} columns (an entry that "
                f'holds "{separator}" stands in double quotes)'
            )
        rows.append(row)
        lines.append(line)
    if not rows:
        raise DataFileError(f"{path}: the file is empty; it needs a header and rows under it")
    fields = {name: tuple(row[i] for row in rows) for i, name in enumerate(names)}
    return ColumnFile(path, header_line, tuple(lines), units, fields)


def _split(text: str, separator: str) -> list[str]:
    return [field.strip() for field in next(csv.reader([text], delimiter=separator, skipinitialspace=True))]


def _header(path: Path, line: int, columns: Sequence[str], known: Sequence[str]) -> tuple[list[str], dict[str, str]]:
    names, units = [], {}
    for column in columns:
        name, unit = _name_and_unit(column, known)
        if not name:
            raise DataFileError(f'{path}, line {line}: unknown column "{column[:60]}"; known: {", ".join(known)}')
        if name in units:
            raise DataFileError(f"{path}, line {line}: two columns {name}")
        names.append(name)
        units[name] = unit
    return names, units


def _name_and_unit(column: str, known: Sequence[str]) -> tuple[str, str]:
    """Split "frequency [Hz]" or "frequency_Hz"; the name is empty if it isn't known."""
    folded = column.lower()
    # Longer names first, so that "shape_x" isn't taken for a "shape" in the unit "x".
    for name in sorted(known, key=len, reverse=True):
        if not folded.startswith(name.lower()):
            continue
        rest = column[len(name) :].strip()
        if not rest:
            return name, ""
        if (rest[0], rest[-1]) in (("[", "]"), ("(", ")")):
            return name, rest[1:-1].strip()
        if rest[0] == "_" and len(rest) > 1:
            return name, rest[1:].strip()
    return "", ""
