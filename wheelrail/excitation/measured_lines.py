"""Measured roughness on several parallel lines of one file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.excitation.measured import (
    check_placement,
    heights_of,
    line_on_grid,
    positions_of,
    read_height_table,
)
from wheelrail.excitation.surface_lines import SurfaceLines
from wheelrail.excitation.table_file import LENGTH_UNITS

__all__ = ["HeightLines", "names_positions", "read_height_lines", "read_measured_lines"]

_POSITION = re.compile(r"(?:^|[\s_])y\s*=\s*(?P<number>\S+?)\s*(?P<unit>mm|m)$", re.IGNORECASE)
_FARTHEST = 0.1  # m from the axis of the rail or the tape circle: the width of a wheel or a rail head is less


@dataclass(frozen=True, eq=False)
class HeightLines:
    """Heights of parallel lines as a file holds them.

    Attributes
    ----------
    x : ndarray, shape (n,)
        Positions along, increasing, m.
    heights : ndarray, shape (lines, n)
        Positive outward from the material, m.
    lateral : ndarray, shape (lines,), or None
        Positions across, increasing, m; None: neither the file nor the caller names them.
    names : tuple of str
        Column of each line.
    """

    x: np.ndarray
    heights: np.ndarray
    lateral: np.ndarray | None
    names: tuple[str, ...]


def names_positions(path: Path | str) -> bool:
    """Whether the header of a file names the positions of its lines across; `DataFileError` as `read_height_lines`."""
    table = read_height_table(path)
    return _positions_across(f"{table.path}, line {table.header_line}", table.names[1:]) is not None


def read_height_lines(path: Path | str, *, lateral: Sequence[float] | None = None) -> HeightLines:
    """Read and check all lines of a file.

    Parameters
    ----------
    path : Path or str
        Text file as `wheelrail.excitation.measured.read_heights` reads it, with one height column per line. A column
        may name its position across, in m or mm, before the unit of its heights: ``x_m, y=-4mm_um, y=0mm_um`` or
        ``x [m]; left y=-0.004m [um]; ...``. Columns may stand in any order.
    lateral : sequence of float, optional
        Positions across, m, one per height column in the order of the file, if the header does not name them.

    Returns
    -------
    HeightLines
        Sorted by position, if positions are known; else the first line alone.

    Raises
    ------
    DataFileError
        The file can't be read or used, or its header names some positions only, one twice, or an implausible one.
    ParameterError
        Positions given by the caller don't fit the file.
    """
    table = read_height_table(path)
    names = table.names[1:]
    where = f"{table.path}, line {table.header_line}"
    positions = _positions_across(where, names)
    if lateral is not None:
        if positions is not None:
            raise ParameterError("lateral", list(lateral), f"{where} names the positions already; leave it out")
        positions = np.array(lateral, dtype=float)
        if positions.shape != (len(names),):
            raise ParameterError(
                "lateral", list(lateral), f"{where} has {len(names)} height columns; give one position for each"
            )
        if not np.all(np.abs(positions) <= _FARTHEST):
            raise ParameterError(
                "lateral", list(lateral), f"positions must lie within {_FARTHEST * 1e3:g} mm of 0; they are in m"
            )
        if len(np.unique(positions)) < len(positions):
            raise ParameterError("lateral", list(lateral), "no position may appear twice")
    x = positions_of(table)
    order = [0] if positions is None else [int(i) for i in np.argsort(positions)]
    heights = np.array([heights_of(table, 1 + i) for i in order])
    return HeightLines(x, heights, None if positions is None else positions[order], tuple(names[i] for i in order))


def _positions_across(where: str, names: tuple[str, ...]) -> np.ndarray | None:
    """Positions that the names of columns give, m; None if no column gives one."""
    found = [_POSITION.search(name) for name in names]
    if not any(found):
        return None
    positions = np.empty(len(names))
    for i, (name, match) in enumerate(zip(names, found, strict=True)):
        if match is None:
            raise DataFileError(
                f"{where}: column {name!r} names no position across, but others do; write for example y=-4mm_um"
            )
        try:
            positions[i] = float(match["number"]) * LENGTH_UNITS[match["unit"].lower()]
        except ValueError:
            positions[i] = np.nan
        if not abs(positions[i]) <= _FARTHEST:
            raise DataFileError(
                f"{where}: column {name!r}: the position across must be a number within {_FARTHEST * 1e3:g} mm of 0, "
                "as in y=-4mm_um"
            )
        if np.any(positions[:i] == positions[i]):
            raise DataFileError(f"{where}: two columns have the position y = {positions[i] * 1e3:g} mm")
    return positions


def read_measured_lines(
    path: Path | str,
    *,
    dx: float,
    on: str,
    wheel_radius: float | None,
    beyond_end: str,
    lateral: Sequence[float] | None = None,
) -> tuple[SurfaceLines, list[str]]:
    """Read parallel measured lines and resample them onto the grid.

    Every line is treated as `wheelrail.excitation.measured.read_measured_line` treats a single one. Then the mean of
    each is taken out: lines are measured one after the other, each from a zero of its own, and the shape of the cross
    section belongs to the profiles.

    Parameters
    ----------
    path : Path or str
        File, see :func:`read_height_lines`.
    dx, on, wheel_radius, beyond_end
        As for `wheelrail.excitation.measured.read_measured_line`.
    lateral : sequence of float, optional
        Positions across, m, one per height column, if the header does not name them: on the wheel from the tape circle,
        on the rail from its axis, to the field side.

    Returns
    -------
    lines : SurfaceLines
        On the grid.
    notes : list of str
        What was done to the lines.

    Raises
    ------
    DataFileError
        The file can't be read or used.
    ParameterError
        Another value of ``on`` or ``beyond_end``, no radius for a wheel, or positions missing or wrong.
    """
    check_placement(on=on, beyond_end=beyond_end)
    path = Path(path)
    measured = read_height_lines(path, lateral=lateral)
    if measured.lateral is None:
        raise ParameterError(
            "lateral",
            None,
            f"{path} does not say where its lines lie across; name positions in its header, as y=-4mm_um, or here",
        )
    lines, notes = [], []
    for heights in measured.heights:
        line, line_notes = line_on_grid(
            path, measured.x, heights, dx=dx, on=on, wheel_radius=wheel_radius, beyond_end=beyond_end
        )
        lines.append(line)
        notes.append(line_notes)
    # Said once if it holds for all lines.
    common = [note for note in notes[0] if all(note in others for others in notes)]
    own = [
        f"column {name}: {note}"
        for name, line_notes in zip(measured.names, notes, strict=True)
        for note in line_notes
        if note not in common
    ]
    values = np.array([line.values - np.mean(line.values) for line in lines])
    surface = SurfaceLines(
        values=values,
        lateral=measured.lateral,
        first_index=lines[0].first_index,
        dx=dx,
        periodic=lines[0].periodic,
        on=on,
        name=f"measured lines {path.name}",
    )
    y = ", ".join(f"{position * 1e3:g}" for position in measured.lateral)
    summary = f"{path.name}: {len(lines)} lines at y = {y} mm; the mean of each is taken out"
    return surface, [*common, *own, summary]
