"""Measured or computed receptances of a wheel at the contact: a table, or functions in a universal file.

**Table** (text, see `wheelrail.numerics.column_file`), one frequency per row::

    frequency [Hz], re_zz [m/N], im_zz [m/N], re_yy [m/N], im_yy [m/N], re_yz [m/N], im_yz [m/N]
    100.0, -2.9e-8, -1.1e-9, 3.1e-8, -2.2e-9, 4.0e-9, -1e-10

A pair ``yz`` is the displacement in y under a force in z, in the frame of the package: x' in rolling direction, y' to
the field side, z' down. Each pair has the columns ``re_`` and ``im_``, or ``abs_`` and ``phase_`` (in deg or rad). The
unit says what was measured: displacement (m/N, mm/N, um/N, nm/N), velocity (m/s/N, mm/s/N) or acceleration (m/s2/N,
1/kg, g/N) per force; the last two are converted. The time factor is exp(+i omega t), so that the imaginary part of a
point receptance is negative.

**Universal file**: data sets 58 with frequency response functions; their nodes, directions, quantities and units are
those of the file.

Of a pair and its mirror image one is enough; where both are there, their mean is used. Pairs that are missing
altogether are taken as zero, and the notes say so: for x' with y' and z' this is exact by the symmetry of the wheel,
for y' with z' it is not, and without it no squeal from the coupling of these directions can develop.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError, ParameterError
from ..numerics.column_file import read_columns
from .receptance_checks import checked_receptance
from .receptance_universal import universal_receptance
from .universal_file import DIRECTIONS, is_universal

__all__ = ["PointReceptance", "read_receptance"]

_PAIRS = tuple("".join(pair) for pair in product(DIRECTIONS, repeat=2))
_PARTS = ("re", "im", "abs", "phase")
_LENGTHS = {"": 1.0, "m": 1e-3, "u": 1e-6, "\u00b5": 1e-6, "\u03bc": 1e-6, "n": 1e-9}
# What a unit measures, as the number of time derivatives, and its factor.
_UNITS: dict[str, tuple[int, float]] = {
    **{f"{prefix}m/N": (0, factor) for prefix, factor in _LENGTHS.items()},
    **{
        form.format(prefix): (1, factor)
        for prefix, factor in _LENGTHS.items()
        for form in ("{}m/s/N", "({}m/s)/N", "{}m/(Ns)", "{}m/(sN)", "{}m/Ns")
    },
    **{
        form.format(prefix): (2, factor)
        for prefix, factor in _LENGTHS.items()
        for form in ("{}m/s2/N", "{}m/s^2/N", "({}m/s2)/N", "({}m/s^2)/N", "{}m/s\u00b2/N")
    },
    "1/kg": (2, 1.0),
    "g/N": (2, 9.80665),
}


@dataclass(frozen=True, eq=False)
class PointReceptance:
    """Receptances at the contact, sampled in frequency.

    Attributes
    ----------
    frequency : ndarray, shape (nf,)
        Hz, increasing.
    values : ndarray of complex, shape (nf, 3, 3)
        Displacement (second index) under a force on the wheel (third index), m/N; symmetric; time factor
        exp(+i omega t).
    given : ndarray of bool, shape (3, 3)
        Pairs that were measured, as they are or mirrored; the others are zero.
    """

    frequency: NDArray
    values: NDArray
    given: NDArray


def read_receptance(
    path: Path | str,
    *,
    node: int | None = None,
    reference_node: int | None = None,
    axes: Sequence[str] | None = None,
    units: str | None = None,
    quantity: str | None = None,
) -> tuple[PointReceptance, list[str]]:
    """Read the receptances of a wheel at the contact and check them.

    Parameters
    ----------
    path : Path or str
        Table or universal file; which of them follows from its first line.
    node : int, optional
        Universal file: the node of the response; needed if there are several.
    reference_node : int, optional
        Universal file: the node of the force; by default the node of the response.
    axes : sequence of 3 str
        Universal file: its axes in rolling direction, to the field side and down, as in ("x", "-z", "y").
    units : {"m-kg-s", "mm-t-s", "mm-kg-s"}, optional
        Universal file: its units, instead of those that it says itself.
    quantity : {"receptance", "mobility", "accelerance"}, optional
        Universal file: what the functions are, if they don't say it themselves.

    Returns
    -------
    receptance : PointReceptance
    notes : list of str
        What was done and found: missing pairs, deviation from reciprocity, lines that aren't passive.

    Raises
    ------
    DataFileError
        The file can't be read or used; the message says where, which value and what is allowed.
    ParameterError
        An argument that isn't allowed, or doesn't apply to this kind of file.
    """
    path = Path(path)
    notes: list[str] = []
    if is_universal(path):
        frequency, pairs = universal_receptance(
            path,
            node=node,
            reference_node=reference_node,
            axes=axes,
            units=units,
            quantity=quantity,
            notes=notes,
        )
    else:
        given = {"node": node, "reference_node": reference_node, "axes": axes, "units": units, "quantity": quantity}
        for name, value in given.items():
            if value is not None:
                raise ParameterError(name, value, f"it belongs to a universal file; {path} is a table, which says it")
        frequency, pairs = _table_receptance(path, notes)
    values, known = checked_receptance(path, frequency, pairs, notes)
    return PointReceptance(frequency, values, known), notes


def _table_receptance(path: Path, notes: list[str]) -> tuple[NDArray, dict[str, NDArray]]:
    file = read_columns(path, known=("frequency", *(f"{part}_{pair}" for part, pair in product(_PARTS, _PAIRS))))
    header = f"{path}, line {file.header_line}"
    if "frequency" not in file.fields:
        raise DataFileError(f"{header}: no column frequency [Hz]")
    frequency = file.numbers("frequency", {"Hz": 1.0, "kHz": 1e3})
    steps = np.diff(frequency)
    if frequency[0] < 0.0 or np.any(steps <= 0.0):
        row = 0 if frequency[0] < 0.0 else int(np.argmax(steps <= 0.0)) + 1
        before = f" follows {frequency[row - 1]:g} Hz" if row else ""
        raise DataFileError(
            f"{path}, line {file.lines[row]}: frequency {frequency[row]:g} Hz{before}; they increase from 0 Hz on"
        )
    pairs, differentiated = {}, False
    for pair in _PAIRS:
        parts = [part for part in _PARTS if f"{part}_{pair}" in file.fields]
        if not parts:
            continue
        if parts not in (["re", "im"], ["abs", "phase"]):
            raise DataFileError(
                f"{header}: the pair {pair} has {' and '.join(f'{part}_{pair}' for part in parts)}; it needs "
                f"re_{pair} and im_{pair}, or abs_{pair} and phase_{pair}"
            )
        orders = {unit: float(order) for unit, (order, _) in _UNITS.items()}
        factors = {unit: factor for unit, (_, factor) in _UNITS.items()}
        size, second = (f"{part}_{pair}" for part in parts)
        order = file.factor(size, orders)
        if parts[0] == "abs":
            angle = file.numbers(second, {"deg": np.pi / 180.0, "\u00b0": np.pi / 180.0, "rad": 1.0})
            response = file.numbers(size, factors) * np.exp(1j * angle)
        else:
            if file.factor(second, orders) != order:
                raise DataFileError(
                    f"{header}: {size} is in {file.units[size]} and {second} in {file.units[second]}; both are parts "
                    "of the same quantity"
                )
            response = file.numbers(size, factors) + 1j * file.numbers(second, factors)
        differentiated |= order > 0.0
        with np.errstate(divide="ignore", invalid="ignore"):
            pairs[pair] = response / (2j * np.pi * frequency) ** order
    if not pairs:
        raise DataFileError(f"{header}: no receptance; the vertical one for instance is re_zz [m/N] and im_zz [m/N]")
    if differentiated and frequency[0] == 0.0:
        notes.append(f"{path.name}: line at 0 Hz left out: a velocity or acceleration says nothing about it")
        frequency, pairs = frequency[1:], {pair: values[1:] for pair, values in pairs.items()}
    return frequency, pairs
