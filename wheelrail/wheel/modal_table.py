"""Modes from a table, as `wheelrail.wheel.modal_file` describes it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import DataFileError
from ..numerics.column_file import ColumnFile, read_columns

__all__ = ["FileMode", "table_modes"]

_SHAPES = ("shape_x", "shape_y", "shape_z")
_COLUMNS = ("name", "frequency", "damping_ratio", "loss_factor", "modal_mass", *_SHAPES)
_NORMALISED = {
    **dict.fromkeys(("1/sqrt(kg)", "kg^-0.5", "kg^-1/2", "kg^(-1/2)"), 1.0),
    **dict.fromkeys(("1/sqrt(t)", "t^-0.5", "t^-1/2", "t^(-1/2)"), 1e-3**0.5),
}
_ROUNDING = 1.0 + 1e-9  # critical damping may be written with all its digits


@dataclass(frozen=True)
class FileMode:
    """A mode as a file gives it.

    Attributes
    ----------
    name : str
    frequency : float
        Hz.
    ratio : float or None
        Damping ratio; None: the file gives none.
    mass : float
        Modal mass in kg.
    shape : tuple of 3 floats
        Displacement at the contact in the frame of the package, in the scale of `mass`.
    """

    name: str
    frequency: float
    ratio: float | None
    mass: float
    shape: tuple[float, float, float]


def table_modes(path: Path) -> list[FileMode]:
    """Read the modes of a table, in the order of its rows.

    Raises
    ------
    DataFileError
        The file can't be read or used.
    """
    file = read_columns(path, known=_COLUMNS)
    header = f"{path}, line {file.header_line}"
    for name in ("frequency", *_SHAPES):
        if name not in file.fields:
            raise DataFileError(f"{header}: no column {name}; needed are frequency, {', '.join(_SHAPES)}")
    if "damping_ratio" in file.fields and "loss_factor" in file.fields:
        raise DataFileError(f"{header}: both damping_ratio and loss_factor; one of them says it")
    frequency = file.numbers("frequency", {"Hz": 1.0, "kHz": 1e3})
    ratios: list[float | None] = [None] * len(frequency)
    for name, critical in (("damping_ratio", 1.0), ("loss_factor", 2.0)):
        if name in file.fields:
            values = file.numbers(name, {"": 1.0, "%": 1e-2})
            _check(
                file, name, values, lambda value, top=critical * _ROUNDING: 0.0 <= value <= top, f"0 to {critical:g}"
            )
            ratios = list((values / critical).tolist())
    if "modal_mass" in file.fields:
        mass = file.numbers("modal_mass", {"kg": 1.0, "t": 1e3, "g": 1e-3})
        _check(file, "modal_mass", mass, lambda value: value > 0.0, "above 0")
        shapes = [file.numbers(name, {"": 1.0}) for name in _SHAPES]
    else:
        mass = np.ones(len(frequency))
        bare = [name for name in _SHAPES if not file.units[name]]
        if bare:
            raise DataFileError(
                f"{header}: the scale of the shapes is open: there is no column modal_mass [kg], and {bare[0]} names "
                f'no unit; mass-normalised shapes are "{bare[0]} [1/sqrt(kg)]", or [1/sqrt(t)] from a model in mm, t '
                "and s"
            )
        shapes = [file.numbers(name, _NORMALISED) for name in _SHAPES]
    _check(file, "frequency", frequency, lambda value: value >= 0.0, "at least 0 Hz")
    names = [_bare_name(name) for name in file.fields.get("name", ())]
    names = names or [f"mode-{i + 1}" for i in range(len(frequency))]
    for i, name in enumerate(names):
        if not name or name in names[:i]:
            problem = f'a second mode "{name}" (mark the turned partner by an asterisk)' if name else "no name"
            raise DataFileError(f"{path}, line {file.lines[i]}: {problem}; each mode has a name of its own")
    shape_rows = np.transpose(shapes).tolist()
    return [
        FileMode(names[i], float(frequency[i]), ratios[i], float(mass[i]), (x, y, z))
        for i, (x, y, z) in enumerate(shape_rows)
    ]


def _bare_name(name: str) -> str:
    """As `FlexibleWheel.without` compares names: no blanks and no brackets."""
    return "".join(name.split()).replace("(", "").replace(")", "")


def _check(file: ColumnFile, name: str, values: Iterable[float], allowed: Callable[[float], bool], wanted: str) -> None:
    for line, value in zip(file.lines, values, strict=True):
        if not allowed(value):
            raise DataFileError(f"{file.path}, line {line}: {name} = {value:g}; allowed is {wanted}")
