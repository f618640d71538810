"""Points of a profile as a file prints them, before units, direction and order are settled."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError
from ..numerics.column_file import read_text

__all__ = ["FilePoints", "finite_number", "numbered_lines", "point_arrays"]

_MOST_BYTES = 50_000_000
_MOST_LINES = 1_000_000
_LONGEST_LINE = 4096
_LARGEST_NUMBER = 1e9  # in whatever unit: above it squares and sums may run over


@dataclass(frozen=True, eq=False)
class FilePoints:
    """Points of one profile file.

    Attributes
    ----------
    values : ndarray, shape (n, 2)
        Lateral and vertical coordinate in the file's unit, after the shifts that the file itself prescribes.
    lines : ndarray of int, shape (n,)
        Line of the file that holds each point, counted from 1.
    unit : float or None
        Length of the file's unit, m; None: the file doesn't tell.
    kind : {"wheel", "rail"} or None
        What the file says it holds; None: it doesn't tell.
    notes : tuple of str
        What was done to the printed numbers.
    """

    values: NDArray
    lines: NDArray
    unit: float | None
    kind: str | None
    notes: tuple[str, ...]


def numbered_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Return the lines of a text file without blanks around them, numbered from 1.

    Raises
    ------
    DataFileError
        If the file is missing, empty, no text, above 50 MB or above a million lines; on the way, at a line of more than
        4096 characters.
    """
    try:
        size = path.stat().st_size
    except (OSError, ValueError):
        size = 0  # read_text says what is wrong
    if size > _MOST_BYTES:
        raise DataFileError(
            f"{path}: {size / 1e6:.0f} MB; a profile file has at most {_MOST_BYTES / 1e6:.0f} MB. Is it a profile?"
        )
    text = read_text(path)
    count = max(text.count("\n"), text.count("\r"))
    if count > _MOST_LINES:
        raise DataFileError(f"{path}: {count} lines; a profile file has at most {_MOST_LINES}. Thin it out.")
    if not text.strip():
        raise DataFileError(f"{path}: the file is empty; it needs one point of the profile a line")
    return _numbered(path, text)


def _numbered(path: Path, text: str) -> Iterator[tuple[int, str]]:
    for line, row in enumerate(io.StringIO(text, newline=None), start=1):
        if len(row) > _LONGEST_LINE:
            raise DataFileError(
                f"{path}, line {line}: {len(row)} characters; at most {_LONGEST_LINE} are read. A profile?"
            )
        yield line, row.strip()


def finite_number(where: str, text: str) -> float:
    """Return the number that a field holds.

    Parameters
    ----------
    where : str
        File and line, for the message.
    text : str

    Raises
    ------
    DataFileError
        If it is no finite number or above a thousand million.
    """
    try:
        value = math.nan if "_" in text else float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        shown = repr(text.strip()[:40]) if text.strip() else "an empty field"
        hint = "; decimal commas are not read: write a point" if "," in text else ""
        raise DataFileError(f"{where}: {shown} is not a finite number{hint}")
    if abs(value) > _LARGEST_NUMBER:
        raise DataFileError(f"{where}: {value:g} is implausible; at most {_LARGEST_NUMBER:g} is allowed")
    return value


def point_arrays(points: list[tuple[float, float]], lines: list[int]) -> tuple[NDArray, NDArray]:
    """Return points, shape (n, 2), and their lines, shape (n,), as arrays; n may be 0."""
    return np.array(points, dtype=float).reshape(-1, 2), np.array(lines, dtype=np.int64)
