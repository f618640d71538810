"""Profile files of SIMPACK: rails (``.prr``) and wheels (``.prw``).

Sections ``header``, ``spline`` and inside it ``point``, each between ``.begin`` and ``.end``; ``!`` starts a comment.
The points are those before processing: ``shift.y`` and ``shift.z`` are added, then come ``rotate`` (about the
longitudinal axis), the bounds, ``mirror.y`` and ``mirror.z``, ``inversion`` of the order, and the unit ``units.len.f``
(units in a metre), in the order in which the files number these steps. After them y counts to the field side, z down.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError
from .file_points import FilePoints, finite_number, numbered_lines, point_arrays

__all__ = ["read_simpack"]

_KINDS = {"0": "rail", "1": "wheel"}
_KIND_OF_SUFFIX = {".prr": "rail", ".prw": "wheel"}
_UNITS_IN_A_METRE = {"m": 1.0, "cm": 1e2, "mm": 1e3}
_PARENTS = {"header": [], "spline": [], "point": ["spline"]}
_CONTENT = re.compile(r"(?:[^'!]|'[^']*')*")
_SECTION = re.compile(r"(?P<name>\w+)\.(?P<edge>begin|end)$")

Keys = dict[str, tuple[str, int]]


def read_simpack(path: Path) -> FilePoints:
    """Read a SIMPACK profile file and carry out the steps it prescribes.

    Parameters
    ----------
    path : Path

    Returns
    -------
    FilePoints

    Raises
    ------
    DataFileError
        Unreadable file, sections that don't fit or don't end, a wrong value, bounds in z that cut off points.
    """
    keys, points, lines = _sections(path)
    values, line_numbers = point_arrays(points, lines)
    notes = []
    values = values + np.array([_number(path, keys, "shift.y", 0.0), _number(path, keys, "shift.z", 0.0)])
    angle = _number(path, keys, "rotate", 0.0)
    if angle:
        per_radian = _positive(path, keys, "units.ang.f", 1.0)
        c, s = math.cos(angle / per_radian), math.sin(angle / per_radian)
        values = values @ np.array([[c, s], [-s, c]])
        notes.append(f"rotated by {angle / per_radian:.6g} rad from y towards z")
    values, line_numbers, cut = _bounded(path, keys, values, line_numbers)
    notes += cut
    for column, axis in enumerate("yz"):
        if _flag(path, keys, f"mirror.{axis}"):
            values[:, column] *= -1.0
            notes.append(f"{axis} mirrored, as the file says")
    if _flag(path, keys, "inversion"):
        values, line_numbers = values[::-1], line_numbers[::-1]
    kind, line = keys.get("header.type", ("", 0))
    if kind and kind not in _KINDS:
        raise DataFileError(f"{path}, line {line}: type = {kind[:20]!r}; allowed: 0 (rail) or 1 (wheel)")
    told = _KINDS.get(kind) or _KIND_OF_SUFFIX.get(path.suffix.lower())
    return FilePoints(values, line_numbers, _unit(path, keys), told, tuple(notes))


def _sections(path: Path) -> tuple[Keys, list[tuple[float, float]], list[int]]:
    """Keys (those of the header as "header.key") and the points with their lines."""
    keys: Keys = {}
    points: list[tuple[float, float]] = []
    lines: list[int] = []
    stack: list[str] = []
    seen_points = False
    for line, text in numbered_lines(path):
        content = _content(text)
        where = f"{path}, line {line}"
        if not content:
            continue
        if edge := _SECTION.match(content):
            _enter_or_leave(where, stack, edge["name"], edge["edge"])
            seen_points = seen_points or stack[-1:] == ["point"]
        elif stack[-1:] == ["point"]:
            numbers = [finite_number(where, field) for field in content.split()]
            if len(numbers) not in (2, 3):
                raise DataFileError(f"{where}: {len(numbers)} values; a point has y, z and perhaps a weight")
            points.append((numbers[0], numbers[1]))
            lines.append(line)
        elif "=" in content and stack:
            key, value = content.split("=", maxsplit=1)
            prefix = "header." if stack == ["header"] else ""
            keys[prefix + key.strip().lower()] = value.strip(), line
        else:
            raise DataFileError(
                f"{where}: {content[:40]!r} is neither a key with a value nor a point inside its section"
            )
    if stack:
        raise DataFileError(f"{path}: section {stack[-1]} doesn't end; the file is cut off")
    if not seen_points:
        raise DataFileError(f"{path}: no points; a SIMPACK profile has them between point.begin and point.end")
    return keys, points, lines


def _content(text: str) -> str:
    """Line without its comment; an exclamation mark inside quotes starts none."""
    match = _CONTENT.match(text)
    return match[0].strip() if match else ""


def _enter_or_leave(where: str, stack: list[str], name: str, edge: str) -> None:
    if name not in _PARENTS:
        raise DataFileError(f"{where}: unknown section {name[:40]!r}; allowed: {', '.join(_PARENTS)}")
    if edge == "begin" and stack == _PARENTS[name]:
        stack.append(name)
    elif edge == "end" and stack[-1:] == [name]:
        stack.pop()
    else:
        raise DataFileError(f"{where}: {name}.{edge} is out of place")


def _number(path: Path, keys: Keys, key: str, default: float) -> float:
    text, line = keys.get(key, ("", 0))
    if not text:
        return default
    return finite_number(f"{path}, line {line}, {key}", text)


def _positive(path: Path, keys: Keys, key: str, default: float) -> float:
    value = _number(path, keys, key, default)
    if not value > 1e-9:
        raise DataFileError(f"{path}, line {keys[key][1]}: {key} = {value:g}; it must be above 0")
    return value


def _flag(path: Path, keys: Keys, key: str) -> bool:
    value = _number(path, keys, key, 0.0)
    if value not in (0.0, 1.0):
        raise DataFileError(f"{path}, line {keys[key][1]}: {key} = {value:g}; allowed: 0 or 1")
    return value == 1.0


def _bounded(path: Path, keys: Keys, values: NDArray, lines: NDArray) -> tuple[NDArray, NDArray, list[str]]:
    """Points inside the bounds; a lower bound that isn't below the upper one switches the pair off."""
    notes = []
    for column, axis in enumerate("yz"):
        low = _number(path, keys, f"bound.{axis}.min", 1.0)
        high = _number(path, keys, f"bound.{axis}.max", 0.0)
        inside = (values[:, column] >= low) & (values[:, column] <= high)
        if not low < high or np.all(inside):
            continue
        if axis == "z":
            # Programs differ: some move these points onto the bound, which makes a flat that nobody measured.
            first = int(lines[np.argmin(inside)])
            raise DataFileError(f"{path}, line {first}: outside bound.z of {low:g} to {high:g}; delete such points")
        notes.append(f"points outside bound.y left out: {int(np.sum(~inside))}")
        values, lines = values[inside], lines[inside]
    return values, lines, notes


def _unit(path: Path, keys: Keys) -> float | None:
    if keys.get("units.len.f", ("", 0))[0]:
        return 1.0 / _positive(path, keys, "units.len.f", 1.0)
    name, line = keys.get("units.len", ("", 0))
    if not name:
        return None
    name = name.strip("'\" ").lower()
    if name not in _UNITS_IN_A_METRE:
        raise DataFileError(f"{path}, line {line}: units.len = {name[:20]!r}; allowed: {', '.join(_UNITS_IN_A_METRE)}")
    return 1.0 / _UNITS_IN_A_METRE[name]
