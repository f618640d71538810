"""Receptances from a universal file: frequency response functions in data sets 58."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError, ParameterError
from .universal_file import DIRECTIONS, DataSet, axes_matrix, check_node_frame, node_number, read_sets

__all__ = ["QUANTITIES", "universal_receptance"]

QUANTITIES = {"receptance": 0, "mobility": 1, "accelerance": 2}
"""Time derivatives in what a frequency response function relates to the force."""

_ORDERS = {8: 0, 11: 1, 12: 2}  # specific data types of the ordinate
_FORCE, _FREQUENCY = 13, 18
_FRF = 4


def universal_receptance(
    path: Path,
    *,
    node: int | None,
    reference_node: int | None,
    axes: Sequence[str] | None,
    units: str | None,
    quantity: str | None,
    notes: list[str],
) -> tuple[NDArray, dict[str, NDArray]]:
    """Read receptances; for the arguments see `wheelrail.wheel.receptance_file.read_receptance`.

    Returns
    -------
    frequency : ndarray, shape (nf,)
        Hz.
    pairs : dict of str to ndarray of complex, shape (nf,)
        By displacement and force in the frame of the package; m/N.

    Raises
    ------
    DataFileError
        The file can't be read or used.
    ParameterError
        Arguments that aren't allowed.
    """
    if quantity is not None and quantity not in QUANTITIES:
        raise ParameterError("quantity", quantity, f"allowed: {', '.join(QUANTITIES)}")
    rotation = axes_matrix(path, axes, notes)
    sets = list(read_sets(path, kinds=(15, 58, 2411, 2420), units=units))
    functions = [data for data in sets if data.kind == 58 and data.content.get("func_type") == _FRF]
    if not functions:
        raise DataFileError(f"{path}: no frequency response function (data set 58 of function type 4)")
    response = node_number(node, [data.content["rsp_node"] for data in functions], path, "responses")
    wanted = response if reference_node is None else reference_node
    at_node = [data for data in functions if int(data.content["rsp_node"]) == response]
    reference = node_number(
        wanted, [data.content["ref_node"] for data in at_node], path, f"forces with node {response}"
    )
    chosen = [data for data in at_node if int(data.content["ref_node"]) == reference]
    left = sum(data.kind == 58 for data in sets) - len(chosen)
    if left:
        notes.append(f"{path.name}: {left} functions of other nodes or types left out")
    for number in {response, reference}:
        check_node_frame(sets, number)
    frequency = _frequency(chosen[0])
    pairs: dict[str, NDArray] = {}
    origin: dict[str, DataSet] = {}
    for data in chosen:
        own = _frequency(data)
        if len(own) != len(frequency) or not np.allclose(own, frequency, rtol=1e-6, atol=0.0):
            raise DataFileError(
                f"{data.where}: {len(own)} frequencies up to {own[-1]:g} Hz, but {chosen[0].where} has "
                f"{len(frequency)} up to {frequency[-1]:g} Hz; all functions need the same"
            )
        name, sign = _pair(data, rotation)
        values = _receptance(data, frequency, quantity)
        if name in pairs:
            raise DataFileError(
                f"{data.where}: a second function for the pair {name}; the first is {origin[name].where}"
            )
        pairs[name], origin[name] = sign * values, data
    if frequency[0] == 0.0 and not all(np.isfinite(values[0]) for values in pairs.values()):
        notes.append(f"{path.name}: line at 0 Hz left out: a velocity or acceleration says nothing about it")
        frequency, pairs = frequency[1:], {name: values[1:] for name, values in pairs.items()}
    return frequency, pairs


def _frequency(data: DataSet) -> NDArray:
    content, where = data.content, data.where
    if content["abscissa_spec_data_type"] not in (0, _FREQUENCY):
        raise DataFileError(
            f"{where}: the abscissa is of type {content['abscissa_spec_data_type']}; allowed is {_FREQUENCY}, frequency"
        )
    frequency = np.asarray(content["x"], dtype=float)
    if len(content["data"]) != content["num_pts"] or len(frequency) != content["num_pts"]:
        raise DataFileError(f"{where}: {len(content['data'])} values, but its header says {content['num_pts']}")
    if len(frequency) == 0 or frequency[0] < 0.0 or np.any(np.diff(frequency) <= 0.0):
        raise DataFileError(f"{where}: frequencies that don't increase from 0 Hz on")
    return frequency


def _pair(data: DataSet, rotation: NDArray) -> tuple[str, float]:
    """Name of the pair in the frame of the package and the sign that its directions give."""
    name, sign = "", 1.0
    for key, what in (("rsp_dir", "response"), ("ref_dir", "force")):
        direction = int(data.content[key])
        if abs(direction) not in (1, 2, 3):
            raise DataFileError(
                f"{data.where}: {what} direction {direction}; allowed are +-1, +-2 and +-3, translations along the axes"
            )
        column = np.sign(direction) * rotation[:, abs(direction) - 1]
        name += DIRECTIONS[int(np.argmax(np.abs(column)))]
        sign *= float(column.sum())
    return name, sign


def _receptance(data: DataSet, frequency: NDArray, quantity: str | None) -> NDArray:
    """Bring a function to m/N."""
    content, where = data.content, data.where
    order = _ORDERS.get(content["ordinate_spec_data_type"])
    if order is None and content["ordinate_spec_data_type"] not in (0, 1):
        raise DataFileError(
            f"{where}: the ordinate is of type {content['ordinate_spec_data_type']}; allowed are 8, 11 and 12, "
            "displacement, velocity and acceleration"
        )
    if content["orddenom_spec_data_type"] not in (0, 1, _FORCE):
        raise DataFileError(
            f"{where}: the denominator is of type {content['orddenom_spec_data_type']}; allowed is {_FORCE}, force"
        )
    stated = None if quantity is None else QUANTITIES[quantity]
    if order is None and stated is None:
        raise DataFileError(f"{where}: doesn't say what was measured; say it: quantity = {', '.join(QUANTITIES)}")
    if order is not None and stated is not None and order != stated:
        name = next(name for name, value in QUANTITIES.items() if value == order)
        raise DataFileError(f'{where}: holds the {name}, but quantity = "{quantity}"; leave quantity out')
    label = str(content.get("ordinate_axis_units_lab", "")).strip().lower()
    if label == "g" or label.startswith("g/"):
        raise DataFileError(f"{where}: the unit \"{label}\" of its ordinate isn't one of the file's units; export m/s2")
    known = data.known_units()
    if label.startswith("mm") and known.length == 1.0:
        raise DataFileError(
            f'{where}: the unit "{label}" of its ordinate contradicts the units of the file, m and N; give units'
        )
    power = stated if order is None else order
    values = np.asarray(content["data"], dtype=complex) * known.receptance
    with np.errstate(divide="ignore", invalid="ignore"):
        return values / (2j * np.pi * frequency) ** (power or 0)
