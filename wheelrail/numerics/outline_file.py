"""Outlines of sections from files: points in turn, as a table or as JSON."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["OUTLINE_SUFFIXES", "parse_outline", "read_outline"]

OUTLINE_SUFFIXES = (".csv", ".txt", ".json")


def read_outline(path: Path | str, *, columns: str) -> NDArray:
    """Read the points of an outline.

    Parameters
    ----------
    path : Path or str
        ``.json``: a list of pairs ``[[x, y], ...]``. Otherwise a text file with two columns between commas, after an
        optional line of headings; ``#`` starts a comment line.
    columns : str
        What the two columns are, for messages: "r, z in m".

    Returns
    -------
    ndarray, shape (n, 2)

    Raises
    ------
    ValueError
        If the file can't be read or holds something else; the message names the file.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "isn't a text file in UTF-8"
        raise ValueError(f"{path}: can't be read: {reason}") from error
    try:
        if path.suffix.lower() == ".json":
            return _points(json.loads(text), columns)
        return parse_outline(text, columns=columns)
    except json.JSONDecodeError as error:
        raise ValueError(f"{path}, line {error.lineno}: isn't JSON: {error.msg}") from error
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error


def parse_outline(text: str, *, columns: str) -> NDArray:
    """Read the points of an outline from a table's text; see `read_outline`."""
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    rows = [[_number(entry) for entry in row] for row in csv.reader(lines)]
    if rows and all(isinstance(entry, str) for entry in rows[0]):
        rows = rows[1:]
    return _points(rows, columns)


def _points(rows: object, columns: str) -> NDArray:
    if not isinstance(rows, list):
        raise ValueError(f"holds no list of points; each point is a pair {columns}")
    for number, row in enumerate(rows, start=1):
        pair = isinstance(row, list) and len(row) == 2
        if not (pair and all(isinstance(entry, int | float) and math.isfinite(entry) for entry in row)):
            raise ValueError(f"point {number} is {row!r}; each needs two numbers, {columns}")
    if len(rows) < 3:
        raise ValueError(f"holds {len(rows)} points; an outline needs at least three")
    return np.array(rows, dtype=float)


def _number(entry: str) -> float | str:
    try:
        return float(entry)
    except ValueError:
        return entry.strip()
