"""Files of the MiniProf instrument: rails (``.ban``) and wheels (``.whl``), in mm.

A header of ``Keyword=value`` lines, an empty line, then one point a line. ``ColumnDef`` names the columns (X lateral,
Y vertical, A angle, C curvature, N and K further ones); without it X and Y come first. ``XOffset`` and ``YOffset`` are
added to the points. A double quote, ``!`` or ``%`` starts a comment (software that edits profiles puts a quote before
a point to leave it out), and so does ``#`` at the start of a line. Older files begin with MINIPROF or MINIWHEELPROF and
have a header in plain words.

X of a wheel counts from the back of the flange to the field side, Y towards the flange. Of rails, public files have the
gauge side at either end of X and count Y up or down, depending on the program that wrote them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import DataFileError
from .file_points import FilePoints, finite_number, numbered_lines, point_arrays

__all__ = ["read_miniprof"]

_MILLIMETRE = 1e-3
_KIND_OF_SUFFIX = {".ban": "rail", ".whl": "wheel"}
_OLD_TITLE = re.compile(r"#?MINI(?P<kind>WHEEL|RAIL)?PROF\b", re.IGNORECASE)
_OLD_TITLE_LINES = 3
_POINT_LEFT_OUT = re.compile(r'["!%]\s*[-+]?[.\d]')
_DECIMAL_COMMA = re.compile(r"\d,\d")


@dataclass
class _Contents:
    """What a file holds, as text."""

    kind: str | None
    header: dict[str, tuple[str, int]] = field(default_factory=dict)
    rows: list[list[str]] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    left_out: int = 0


def read_miniprof(path: Path) -> FilePoints:
    """Read a MiniProf file of one profile.

    Parameters
    ----------
    path : Path

    Returns
    -------
    FilePoints

    Raises
    ------
    DataFileError
        Unreadable file, wrong ``ColumnDef``, a row of another width, a coordinate that isn't a finite number.
    """
    contents = _contents(path)
    lateral, vertical, width, notes = _columns(path, contents)
    points = []
    for row, line in zip(contents.rows, contents.lines, strict=True):
        where = f"{path}, line {line}"
        if len(row) != width:
            raise DataFileError(f"{where}: {len(row)} values; a point has {width} in this file")
        points.append((finite_number(where, row[lateral]), finite_number(where, row[vertical])))
    values, lines = point_arrays(points, contents.lines)
    for column, key in enumerate(("XOffset", "YOffset")):
        offset = _header_number(path, contents, key)
        if offset:
            values[:, column] += offset
            notes.append(f"{key} of {offset:g} mm added")
    announced, there = _header_number(path, contents, "XYPoints"), len(points)
    if announced is not None and announced not in (there, there + contents.left_out):
        notes.append(f"the header announces {announced:g} points, {there} are there")
    if contents.left_out:
        notes.append(f"points commented out in the file: {contents.left_out}")
    return FilePoints(values, lines, _MILLIMETRE, contents.kind, tuple(notes))


def _contents(path: Path) -> _Contents:
    contents = _Contents(_KIND_OF_SUFFIX.get(path.suffix.lower()))
    in_header, old_style = True, False
    for line, text in numbered_lines(path):
        where = f"{path}, line {line}"
        if line <= _OLD_TITLE_LINES and (title := _OLD_TITLE.match(text)):
            old_style = True
            contents.kind = title["kind"].lower() if title["kind"] else contents.kind
        if text.lower().startswith("[fileinfo]"):
            raise DataFileError(f"{where}: a MiniProf file of several parts; export each profile as .ban or .whl")
        if not text:
            in_header = in_header and not (contents.header or old_style)
            continue
        content = "" if text.startswith("#") else re.split(r'["!%]', text, maxsplit=1)[0].strip()
        if not content:
            contents.left_out += not in_header and bool(_POINT_LEFT_OUT.match(text))
        elif "=" in content:
            if not in_header:
                raise DataFileError(f"{where}: {content[:40]!r} among the points; the header comes before them")
            key, value = content.split("=", maxsplit=1)
            contents.header[key.strip().lower()] = value.strip(), line
        elif not (in_header and old_style):
            in_header = False
            fields = content.replace(";", " ").split()
            if len(fields) > 1 and _DECIMAL_COMMA.search(content):
                raise DataFileError(f"{where}: {content[:40]!r}: decimal commas are not read: write points")
            contents.rows.append(content.split(",") if "," in content else fields)
            contents.lines.append(line)
    return contents


def _header_number(path: Path, contents: _Contents, key: str) -> float | None:
    text, line = contents.header.get(key.lower(), ("", 0))
    return finite_number(f"{path}, line {line}, {key}", text) if text else None


def _columns(path: Path, contents: _Contents) -> tuple[int, int, int, list[str]]:
    """Positions of X and Y in a row, the number of columns, and what was taken for granted."""
    if "columndef" not in contents.header:
        width = len(contents.rows[0]) if contents.rows else 2
        if width < 2:
            raise DataFileError(f"{path}, line {contents.lines[0]}: one value; a point needs two, X and Y")
        return 0, 1, width, [f"no ColumnDef: the first two of {width} columns taken"] if width > 2 else []
    text, line = contents.header["columndef"]
    letters = [letter.strip().upper() for letter in text.split(",")]
    if letters.count("X") != 1 or letters.count("Y") != 1:
        raise DataFileError(f"{path}, line {line}: ColumnDef={text[:40]!r}; it must name X and Y, each once")
    return letters.index("X"), letters.index("Y"), len(letters), []
