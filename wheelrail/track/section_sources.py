"""Where a rail's cross-section comes from: presets, or a user's outline or mesh.

Presets
-------
60e1
    Lines and arcs of EN 13674-1.
bv50-like
    A stand-in for the Swedish BV50, whose drawing isn't at hand: straight sides with rounded corners, with its height
    of 155 mm, foot of 133 mm, head of 70 mm and web of 14 mm, adjusted to the area of 63.7 cm2 and the second moments
    of 2058 and 351 cm4 that catalogues give for it (as 50E3). Bending and torsion follow from these; the cut-on of the
    second web bending wave comes out at 3.98 kHz, where Pieringer (2011, section 3.3.2) has 4.03 kHz.
"""

from __future__ import annotations

import csv
from importlib.resources import files
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError
from ..numerics.outline_file import OUTLINE_SUFFIXES, read_outline
from ..numerics.section_mesh import read_mesh
from .section import RailSection, section_from_mesh

__all__ = ["PRESETS", "load_section", "preset_section"]

PRESETS = {"60e1": "rail_60e1.csv", "bv50-like": "rail_bv50_like.csv"}
_COLUMNS = "lateral, vertical in m"
_SAGITTA = 1e-3  # mm; distance of the outline's sides from the arcs they stand for
_STEP = np.radians(4.0)  # largest turn of an arc between two points of the outline
_LARGEST = 1.0  # m; no rail is that high, so its coordinates must be millimetres


def load_section(source: str, folder: Path | None = None) -> RailSection:
    """Find a section by the name of a preset or read it from a file.

    Parameters
    ----------
    source : str
        A name of `PRESETS`; or a file of points in turn, lateral and vertical in m (``.csv``, ``.txt`` or ``.json``,
        see `wheelrail.numerics.outline_file.read_outline`); or any mesh file that meshio reads, in m.
    folder : Path, optional
        What a file's name is relative to.

    Returns
    -------
    RailSection

    Raises
    ------
    DataFileError
        If there is no such preset or file, or it holds no section.
    """
    if source.lower() in PRESETS:
        return preset_section(source.lower())
    path = Path(source) if folder is None else folder / source
    if not path.is_file():
        raise DataFileError(f"{source}: neither a preset section ({', '.join(PRESETS)}) nor a file")
    try:
        if path.suffix.lower() in OUTLINE_SUFFIXES:
            section = RailSection(read_outline(path, columns=_COLUMNS), path.stem)
        else:
            section = section_from_mesh(read_mesh(path), path.stem)
    except ValueError as error:
        message = str(error)
        raise DataFileError(message if message.startswith(str(path)) else f"{path}: {message}") from error
    if section.height > _LARGEST:
        raise DataFileError(f"{path}: the section is {section.height:g} m high; its coordinates must be in metres")
    return section


def preset_section(name: str) -> RailSection:
    """Return a preset section, one of `PRESETS`."""
    rows = _rows(files("wheelrail.track").joinpath(PRESETS[name]).read_text(encoding="utf-8"))
    header, *rows = rows
    half = _segments(rows) if header[0] == "type" else _rounded(rows)
    mirrored = half[::-1] * [-1.0, 1.0]
    return RailSection(1e-3 * np.concatenate([half, mirrored[1:-1]]), name)


def _rows(text: str) -> list[list[str]]:
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    return [[entry.strip() for entry in row] for row in csv.reader(lines)]


def _segments(rows: list[list[str]]) -> NDArray:
    """Points of a chain of lines and arcs."""
    points: list[NDArray] = []
    for kind, x, y, x_centre, y_centre in rows:
        end = np.array([float(x), float(y)])
        if kind == "arc":
            points.extend(_arc(points[-1], end, np.array([float(x_centre), float(y_centre)])))
        else:
            points.append(end)
    return np.array(points)


def _rounded(rows: list[list[str]]) -> NDArray:
    """Points of a chain of straight sides whose corners have radii; radius 0 leaves a corner."""
    corners = np.array([[float(entry) for entry in row] for row in rows])
    points = [corners[0, :2]]
    for (ax, ay, _), (x, y, radius), (bx, by, _) in zip(corners[:-2], corners[1:-1], corners[2:], strict=True):
        corner = np.array([x, y])
        if radius == 0.0:
            points.append(corner)
            continue
        back, on = np.array([ax, ay]) - corner, np.array([bx, by]) - corner
        back, on = back / np.hypot(*back), on / np.hypot(*on)
        half = 0.5 * np.arccos(np.clip(back @ on, -1.0, 1.0))
        bisector = (back + on) / np.hypot(*(back + on))
        centre = corner + bisector * radius / np.sin(half)
        reach = radius / np.tan(half)
        begin, end = corner + reach * back, corner + reach * on
        points.append(begin)
        points.extend(_arc(begin, end, centre))
    points.append(corners[-1, :2])
    return np.array(points)


def _arc(begin: NDArray, end: NDArray, centre: NDArray) -> NDArray:
    """Points of the shorter arc, its beginning left out."""
    (xa, ya), (xb, yb) = begin - centre, end - centre
    turn = np.arctan2(xa * yb - ya * xb, xa * xb + ya * yb)
    radius = 0.5 * (np.hypot(xa, ya) + np.hypot(xb, yb))
    number = int(np.ceil(abs(turn) / min(_STEP, 2.0 * np.arccos(1.0 - _SAGITTA / radius))))
    angles = np.arctan2(ya, xa) + turn * np.arange(1, number + 1) / number
    points = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    points[-1] = end
    return points
