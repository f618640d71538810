"""Modes from a universal file, as `wheelrail.wheel.modal_file` describes it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError
from .modal_table import FileMode
from .universal_file import DataSet, axes_matrix, check_node_frame, node_number, read_sets

__all__ = ["LEAST_COLLINEARITY", "universal_modes"]

LEAST_COLLINEARITY = 0.95
_NORMAL, _COMPLEX = 2, 3  # analysis types of data set 55
_LARGEST_PHASE = 0.2  # rad, of the modal mass


def universal_modes(
    path: Path, node: int | None, axes: Sequence[str] | None, units: str | None, normalised: bool, notes: list[str]
) -> list[FileMode]:
    """Read the modes of a universal file, in its order; for the arguments see `wheelrail.wheel.modal_file.read_modes`.

    Raises
    ------
    DataFileError
        The file can't be read or used.
    ParameterError
        Without axes, or for axes and units that aren't allowed.
    """
    rotation = axes_matrix(path, axes, notes)
    sets = list(read_sets(path, kinds=(15, 55, 2411, 2414, 2420), units=units))
    # A program may list the conjugate of each complex mode as well.
    shapes = [data for data in sets if data.kind == 55 and _is_mode(data) and data.content.get("eig", 1j).imag >= 0.0]
    if not shapes:
        other = sorted({data.kind for data in sets if data.kind in (55, 2414)})
        hint = "; export the modes as data set 55, normal modes" if other else ""
        raise DataFileError(
            f"{path}: no mode shapes (data set 55 with normal or first-order complex modes){hint}"
            + (f"; found data sets of type {', '.join(map(str, other))} with other results" if other else "")
        )
    contact = node_number(node, [n for data in shapes for n in data.content["node_nums"]], path, "mode shapes")
    check_node_frame(sets, contact)
    numbers = [int(data.content["mode_n"]) for data in shapes]
    if len(set(numbers)) < len(numbers):
        numbers = list(range(1, len(numbers) + 1))
    found, least = [], 1.0
    for number, data in zip(numbers, shapes, strict=True):
        mode, collinearity = _universal_mode(data, number, contact, rotation, normalised)
        least = min(least, collinearity)
        found.append(mode)
    if any(data.content["analysis_type"] == _COMPLEX for data in shapes):
        notes.append(f"{path.name}: complex modes turned to real ones; smallest phase collinearity {least:.4f}")
    hysteretic = sum(bool(data.content.get("modal_damp_his")) for data in shapes)
    if hysteretic:
        notes.append(
            f"{path.name}: hysteretic damping of {hysteretic} modes not used: programs define it differently; the "
            "viscous damping ratio counts"
        )
    if any(mode.shape == (0.0, 0.0, 0.0) for mode in found):
        still = sum(mode.shape == (0.0, 0.0, 0.0) for mode in found)
        notes.append(f"{path.name}: {still} of {len(found)} modes don't move at node {contact}")
        found = [mode for mode in found if mode.shape != (0.0, 0.0, 0.0)]
    return found


def _is_mode(data: DataSet) -> bool:
    return data.content.get("analysis_type") in (_NORMAL, _COMPLEX) and data.content.get("spec_data_type") in (0, 1, 8)


def _universal_mode(
    data: DataSet, number: int, node: int, rotation: NDArray, normalised: bool
) -> tuple[FileMode, float]:
    """Make a mode of a data set 55, and measure its collinearity."""
    content, where = data.content, data.where
    shape = np.stack([np.asarray(content[f"r{i}"], dtype=complex) for i in (1, 2, 3)])
    if not np.all(np.isfinite(shape)):
        raise DataFileError(f"{where}: a displacement isn't a finite number")
    if content["analysis_type"] == _NORMAL:
        if np.any(np.imag(shape)):
            raise DataFileError(f"{where}: a normal mode with complex displacements; export complex modes as such")
        frequency, ratio, mass, collinearity = (
            float(content["freq"]),
            content["modal_damp_vis"],
            content["modal_m"],
            1.0,
        )
    else:
        frequency, ratio, mass, collinearity, shape = _turned(content, where, shape)
    if not 0.0 <= ratio <= 1.0:
        raise DataFileError(f"{where}: damping ratio {ratio:g}; allowed is 0 to 1")
    if not frequency >= 0.0:
        raise DataFileError(f"{where}: frequency {frequency:g} Hz; allowed is at least 0 Hz")
    if mass < 0.0 or (mass == 0.0 and not normalised):
        raise DataFileError(
            f"{where}: modal mass {mass:g}; allowed is above 0. If the file leaves it out because its shapes are "
            "mass-normalised, say so: mass_normalised"
        )
    at = np.flatnonzero(np.asarray(content["node_nums"]) == node)
    # The format leaves out nodes that don't move.
    x, y, z = (rotation @ np.real(shape[:, at[0]])).tolist() if len(at) else (0.0, 0.0, 0.0)
    mass = float(mass or 1.0) * data.known_units().mass
    # The format has no other way to say that nothing is known about the damping.
    return FileMode(f"mode-{number}", frequency, float(ratio) or None, mass, (x, y, z)), collinearity


def _turned(content: dict[str, Any], where: str, shape: NDArray) -> tuple[float, float, float, float, NDArray]:
    """Turn a complex mode into a real one: frequency, damping ratio, modal mass, collinearity, shape."""
    pole, modal_a = complex(content["eig"]), complex(content["modal_a"])
    if pole.imag == 0.0:
        raise DataFileError(f"{where}: eigenvalue {pole.real:g} without an imaginary part: this is no vibration")
    frequency = abs(pole) / (2.0 * np.pi)
    norm = float(np.sum(np.abs(shape) ** 2))
    square = complex(np.sum(shape**2))
    collinearity = abs(square) ** 2 / norm**2 if norm else 1.0
    if collinearity < LEAST_COLLINEARITY:
        raise DataFileError(
            f"{where}: complex mode at {frequency:.6g} Hz with phase collinearity {collinearity:.3f}; at least "
            f"{LEAST_COLLINEARITY:g} is allowed, because real modes can't show its phases (receptances can)"
        )
    turn = np.exp(-0.5j * np.angle(square))
    # Of a mode with real shape, modal A is 2 i omega_d times the modal mass.
    mass = modal_a * turn**2 / (2j * pole.imag)
    if modal_a and (mass.real <= 0.0 or abs(mass.imag) > _LARGEST_PHASE * mass.real):
        raise DataFileError(
            f"{where}: modal A of the mode at {frequency:.6g} Hz doesn't belong to its shape: the modal mass would be "
            f"{mass.real:.4g}{mass.imag:+.4g}i; it has to be real and positive"
        )
    return frequency, -pole.real / abs(pole), float(mass.real), collinearity, shape * turn
