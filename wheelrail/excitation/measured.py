"""Measured roughness lines: reading, checking, and bringing them onto the grid."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.excitation.resampling import is_equidistant, resample
from wheelrail.excitation.sources import Line
from wheelrail.excitation.table_file import LENGTH_UNITS, MAX_ROWS, Table, read_table

__all__ = [
    "check_placement",
    "heights_of",
    "line_on_grid",
    "positions_of",
    "read_height_table",
    "read_heights",
    "read_measured_line",
]

_FEWEST_POINTS = 16
_LARGEST_GAP = 5.0  # median spacings
_LARGEST_HEIGHT = 10e-3  # m
_LARGEST_STRETCH = 0.02
_SEAM_POINTS = 8
_FADE_SHARE = 0.1  # of a repeating rail line, at most _LONGEST_FADE
_LONGEST_FADE = 1.0  # m


def read_heights(path: Path | str, *, column: str | int | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Read and check positions and heights of one line.

    Parameters
    ----------
    path : Path or str
        Text file: ``#`` comments, a header with units (as ``x_m,height_um`` or ``x [mm];r [um]``), rows of numbers.
        First column: position. Each further column: heights of one line, positive outward from the material.
    column : str, int or None
        Line to take, by name or number from 1; None: the first.

    Returns
    -------
    x, r : ndarray, shape (n,)
        Positions (increasing) and heights, m.

    Raises
    ------
    DataFileError
        The file can't be read or used; the message gives line, value and what is allowed.
    """
    table = read_height_table(path)
    chosen = _column(table.path, table.names, column)
    return positions_of(table), heights_of(table, chosen)


def read_height_table(path: Path | str) -> Table:
    """Read positions and heights as they are printed; :func:`positions_of` and :func:`heights_of` check them.

    Raises
    ------
    DataFileError
        The file can't be read as a table of lengths.
    """
    units = tuple(LENGTH_UNITS)
    return read_table(path, column_units=(units, units))


def positions_of(table: Table) -> np.ndarray:
    """Positions, m, shape (n,); checked: enough, increasing and without gaps (else `DataFileError`)."""
    path = table.path
    count = table.values.shape[0]
    if count < _FEWEST_POINTS:
        raise DataFileError(f"{path}: {count} points; a roughness line needs at least {_FEWEST_POINTS}")
    x = table.values[:, 0] * LENGTH_UNITS[table.units[0]]
    steps = np.diff(x)
    if np.any(steps <= 0.0):
        row = int(np.argmax(steps <= 0.0)) + 1
        raise DataFileError(
            f"{path}, line {table.lines[row]}: position {table.values[row, 0]:g} {table.units[0]} follows "
            f"{table.values[row - 1, 0]:g} {table.units[0]}; positions must increase"
        )
    median = float(np.median(steps))
    gaps = steps > _LARGEST_GAP * median * (1.0 + 1e-6)  # positions are printed numbers
    if np.any(gaps):
        row = int(np.argmax(gaps)) + 1
        raise DataFileError(
            f"{path}, line {table.lines[row]}: gap of {steps[row - 1]:g} m before x = {x[row]:g} m; at most "
            f"{_LARGEST_GAP:g} times the median spacing of {median:g} m is allowed. Fill the gap or cut the file there."
        )
    return x


def heights_of(table: Table, column: int) -> np.ndarray:
    """Heights of a column (1 is the first), m, shape (n,); checked: plausible (else `DataFileError`)."""
    r = table.values[:, column] * LENGTH_UNITS[table.units[column]]
    if np.any(np.abs(r) > _LARGEST_HEIGHT):
        row = int(np.argmax(np.abs(r) > _LARGEST_HEIGHT))
        raise DataFileError(
            f"{table.path}, line {table.lines[row]}: height {table.values[row, column]:g} {table.units[column]} is "
            f"implausible (at most {_LARGEST_HEIGHT * 1e3:g} mm); is the unit in the header right?"
        )
    return r


def _column(path: Path, names: tuple[str, ...], column: str | int | None) -> int:
    if column is None:
        return 1
    if isinstance(column, str) and column in names[1:]:
        return names.index(column, 1)
    if isinstance(column, int) and 1 <= column < len(names):
        return column
    raise DataFileError(
        f"{path}: no height column {column!r}; there are {', '.join(names[1:])} (or numbers 1 to {len(names) - 1})"
    )


def read_measured_line(
    path: Path | str,
    *,
    dx: float,
    on: str,
    wheel_radius: float | None,
    beyond_end: str,
    column: str | int | None = None,
) -> tuple[Line, list[str]]:
    """Read a measured line and resample it onto the grid without aliasing.

    Parameters
    ----------
    path : Path or str
        File, see :func:`read_heights`.
    dx : float
        Grid spacing, m.
    on : {"wheel", "rail"}
        Rail: positions along the rail from the sleeper at 0. Wheel: one turn along the tread; it is stretched to
        the circumference (by 2 % at most), a linear drift is taken out, and it repeats every turn.
    wheel_radius : float or None
        Rolling radius, m; needed on the wheel.
    beyond_end : {"stop", "repeat"}
        Rail only. "repeat": the linear trend is taken out and the last tenth of the line (1 m at most) is faded into
        its beginning with constant power (weights sin and cos, squares add to 1).
    column : str, int or None
        Height column, by name or number from 1; None: the first.

    Returns
    -------
    line : Line
        On the grid.
    notes : list of str
        What was done to the line.

    Raises
    ------
    DataFileError
        The file can't be read or used.
    ParameterError
        Another value of ``on`` or ``beyond_end``, or no radius for a wheel.
    """
    check_placement(on=on, beyond_end=beyond_end)
    path = Path(path)
    x, r = read_heights(path, column=column)
    return line_on_grid(path, x, r, dx=dx, on=on, wheel_radius=wheel_radius, beyond_end=beyond_end)


def check_placement(*, on: str, beyond_end: str) -> None:
    """Raise `ParameterError` unless the surface and the treatment of the ends are known."""
    if on not in ("wheel", "rail"):
        raise ParameterError("on", on, 'allowed: "wheel" or "rail"')
    if beyond_end not in ("stop", "repeat"):
        raise ParameterError("beyond_end", beyond_end, 'allowed: "stop" or "repeat"')


def line_on_grid(
    path: Path, x: np.ndarray, r: np.ndarray, *, dx: float, on: str, wheel_radius: float | None, beyond_end: str
) -> tuple[Line, list[str]]:
    """Bring checked heights onto the grid, as :func:`read_measured_line` says; the path is for messages.

    Parameters
    ----------
    path : Path
    x, r : ndarray, shape (n,)
        From :func:`read_heights`, m.
    dx, on, wheel_radius, beyond_end
        As for :func:`read_measured_line`.

    Returns
    -------
    line : Line
    notes : list of str

    Raises
    ------
    DataFileError
        The line is too long or too short.
    ParameterError
        No radius for a wheel.
    """
    span = float(x[-1] - x[0])
    if span / dx > 10 * MAX_ROWS:
        raise DataFileError(
            f"{path}: {span:g} m are {span / dx:.3g} grid steps of {dx:g} m; at most {10 * MAX_ROWS} are allowed. "
            "Cut the file (or is the unit of x right?)."
        )
    notes = []
    if not is_equidistant(x):
        notes.append(f"{path.name}: positions are not equidistant; interpolated by a cubic spline before the low-pass")
    if on == "wheel":
        if wheel_radius is None or not wheel_radius > 0.0:
            raise ParameterError(
                "wheel_radius", wheel_radius, "a line on the wheel needs the rolling radius, above 0 m"
            )
        return _wheel_line(path, x, r, dx, wheel_radius, notes)
    return _rail_line(path, x, r, dx, beyond_end, notes)


def _spacing_note(path: Path, spacing: float, dx: float) -> str:
    coarser = "file" if spacing > dx else "grid"
    return (
        f"{path.name}: spacing {spacing:.6g} m resampled to dx = {dx:.6g} m; waves shorter than "
        f"{2.0 * max(spacing, dx):.6g} m (twice the spacing of the {coarser}) are removed"
    )


def _rail_line(
    path: Path, x: np.ndarray, r: np.ndarray, dx: float, beyond_end: str, notes: list[str]
) -> tuple[Line, list[str]]:
    first = int(np.ceil(x[0] / dx - 1e-6))
    count = int(np.floor(x[-1] / dx + 1e-6)) - first + 1
    if count < _FEWEST_POINTS:
        raise DataFileError(
            f"{path}: {x[-1] - x[0]:g} m hold {count} grid nodes at dx = {dx:g} m; at least {_FEWEST_POINTS} are needed"
        )
    values = resample(x, r, dx=dx, first=first, count=count, period=None)
    notes.append(_spacing_note(path, float(np.median(np.diff(x))), dx))
    if beyond_end == "stop":
        return Line(values=values, first_index=first, dx=dx, periodic=False, name=f"measured line {path.name}"), notes

    nodes = np.arange(count)
    slope, level = np.polyfit(nodes, values, 1)
    values = values - (level + slope * nodes)
    fade = max(min(int(_FADE_SHARE * count), round(_LONGEST_FADE / dx)), 1)
    period = count - fade
    angle = 0.5 * np.pi * np.arange(fade) / fade
    repeated = values[:period].copy()
    repeated[:fade] = np.sin(angle) * values[:fade] + np.cos(angle) * values[period:]
    notes.append(
        f"{path.name}: repeats every {period * dx:.6g} m; a linear trend of {slope / dx * 1e6:.3g} um/m and an offset "
        f"of {level * 1e6:.3g} um are taken out and the last {fade * dx:.3g} m faded into the beginning, so the "
        f"line is as measured from {(first + fade) * dx:.6g} m to {(first + period - 1) * dx:.6g} m"
    )
    return Line(values=repeated, first_index=first, dx=dx, periodic=True, name=f"measured line {path.name}"), notes


def _wheel_line(
    path: Path, x: np.ndarray, r: np.ndarray, dx: float, wheel_radius: float, notes: list[str]
) -> tuple[Line, list[str]]:
    turn = 2.0 * np.pi * wheel_radius
    spacing = float(np.median(np.diff(x)))
    span = float(x[-1] - x[0])
    # The last point either repeats the first one, or lies one spacing before it.
    ends_on_first = abs(span - turn) < abs(span + spacing - turn)
    length = span if ends_on_first else span + spacing
    if abs(length - turn) > _LARGEST_STRETCH * turn:
        raise DataFileError(
            f"{path}: the line is {length:.6g} m long, but one turn of the wheel (radius {wheel_radius:g} m) is "
            f"{turn:.6g} m; a difference of {_LARGEST_STRETCH * 100:g} % at most is allowed"
        )
    count = round(turn / dx)
    if count < _FEWEST_POINTS:
        raise DataFileError(
            f"{path}: one turn holds {count} grid nodes at dx = {dx:g} m; at least {_FEWEST_POINTS} are needed"
        )

    # Jump at the seam: straight lines through the first and the last points, both continued to the seam. Curvature
    # has the same effect on both, so a line that closes smoothly is left alone.
    x = x - x[0]
    edge = _SEAM_POINTS
    before = np.polyval(np.polyfit(x[-edge:] - length, r[-edge:], 1), 0.0)
    after = np.polyval(np.polyfit(x[:edge], r[:edge], 1), 0.0)
    jump = float(before - after)
    r = r - jump * (x / length - 0.5)
    if ends_on_first:
        x, r = x[:-1], r[:-1]
    closed = count * dx
    values = resample(x * (closed / length), r, dx=dx, first=0, count=count, period=closed)
    notes.append(_spacing_note(path, spacing, dx))
    notes.append(
        f"{path.name}: {length:.6g} m stretched to one turn of {closed:.6g} m ({count} steps; the circumference is "
        f"{turn:.6g} m, {(closed - turn) * 1e3:+.3g} mm a turn); a drift of {jump * 1e6:.3g} um a turn is taken out"
    )
    return Line(values=values, first_index=0, dx=dx, periodic=True, name=f"measured line {path.name}"), notes
