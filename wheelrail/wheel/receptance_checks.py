"""Whether measured receptances can be those of a wheel: reciprocity, passivity, missing pairs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError
from .universal_file import DIRECTIONS

__all__ = ["checked_receptance"]

_FEWEST_LINES = 16
_LARGEST_DEVIATION = 0.5  # from reciprocity
_PHASE_TOLERANCE = 0.02  # about one degree


def checked_receptance(
    path: Path, frequency: NDArray, pairs: Mapping[str, NDArray], notes: list[str]
) -> tuple[NDArray, NDArray]:
    """Make the matrix of receptances from its pairs and check it.

    Parameters
    ----------
    path : Path
        For messages.
    frequency : ndarray, shape (nf,)
        Hz.
    pairs : mapping of str to ndarray of complex, shape (nf,)
        By displacement and force, "yz" for instance; m/N.
    notes : list of str
        What is found is added to it.

    Returns
    -------
    values : ndarray of complex, shape (nf, 3, 3)
        Symmetric.
    given : ndarray of bool, shape (3, 3)

    Raises
    ------
    DataFileError
        Too few lines, no vertical point receptance, values that aren't finite, a pair that contradicts its mirror
        image, or receptances that feed in energy.
    """
    if len(frequency) < _FEWEST_LINES:
        raise DataFileError(f"{path}: {len(frequency)} frequencies; at least {_FEWEST_LINES} are needed")
    if "zz" not in pairs:
        raise DataFileError(f"{path}: no vertical point receptance zz (there are {', '.join(pairs)})")
    for pair, values in pairs.items():
        if not np.all(np.isfinite(values)):
            line = int(np.argmin(np.isfinite(values)))
            raise DataFileError(f"{path}: receptance {pair} at {frequency[line]:g} Hz isn't a finite number")
    result = np.zeros((len(frequency), 3, 3), dtype=complex)
    given = np.zeros((3, 3), dtype=bool)
    for i, first in enumerate(DIRECTIONS):
        for j, second in enumerate(DIRECTIONS[: i + 1]):
            names = [name for name in dict.fromkeys((first + second, second + first)) if name in pairs]
            if not names:
                continue
            mean = np.mean([pairs[name] for name in names], axis=0)
            if len(names) == 2:
                _check_reciprocity(path, names, pairs, notes)
            result[:, i, j] = result[:, j, i] = mean
            given[i, j] = given[j, i] = True
    _note_missing(path, given, notes)
    _check_passivity(path, frequency, result, notes)
    return result, given


def _check_reciprocity(path: Path, names: list[str], pairs: Mapping[str, NDArray], notes: list[str]) -> None:
    one, other = (pairs[name] for name in names)
    size = 0.5 * float(np.linalg.norm(one) + np.linalg.norm(other))
    deviation = float(np.linalg.norm(one - other)) / size if size else 0.0
    if deviation > _LARGEST_DEVIATION:
        raise DataFileError(
            f"{path}: the receptances {names[0]} and {names[1]} differ by {100.0 * deviation:.0f} % (rms); by "
            f"reciprocity they are equal, and at most {100.0 * _LARGEST_DEVIATION:.0f} % is allowed. Is the sign of a "
            "direction right?"
        )
    if deviation > 1e-6:
        notes.append(
            f"{path.name}: {names[0]} and {names[1]} differ by {100.0 * deviation:.2g} % (rms); their mean is used"
        )


def _note_missing(path: Path, given: NDArray, notes: list[str]) -> None:
    missing = [
        first + second
        for i, first in enumerate(DIRECTIONS)
        for j, second in enumerate(DIRECTIONS[: i + 1])
        if not given[i, j]
    ]
    symmetric = [pair for pair in missing if pair in ("yx", "zx")]
    points = [pair for pair in missing if pair[0] == pair[1]]
    if symmetric:
        notes.append(f"{path.name}: {', '.join(symmetric)} taken as zero, as the wheel's symmetry has it")
    if points:
        notes.append(f"{path.name}: {', '.join(points)} not given: the wheel is taken as rigid in that direction")
    if "zy" in missing and given[1, 1]:
        notes.append(
            f"{path.name}: yz not given and taken as zero: lateral and vertical motion aren't coupled in the wheel, "
            "and no squeal can come from that coupling"
        )


def _check_passivity(path: Path, frequency: NDArray, values: NDArray, notes: list[str]) -> None:
    """Make sure that forces put energy in: minus the imaginary part has no negative eigenvalue."""
    out_of_phase = np.imag(values)
    if np.sum(np.trace(out_of_phase, axis1=1, axis2=2) * frequency) > 0.0:
        raise DataFileError(
            f"{path}: the imaginary parts of the point receptances are positive: the wheel would feed in energy. Is "
            "the time factor exp(+i omega t), and does the displacement point the same way as the force?"
        )
    smallest = np.linalg.eigvalsh(-out_of_phase)[:, 0]
    size = np.linalg.norm(values, ord=2, axis=(1, 2))
    active = -smallest / np.where(size > 0.0, size, 1.0)
    count = int(np.count_nonzero(active > _PHASE_TOLERANCE))
    if count:
        worst = int(np.argmax(active))
        notes.append(
            f"{path.name}: {count} of {len(frequency)} lines aren't passive; the worst at {frequency[worst]:g} Hz by "
            f"{100.0 * active[worst]:.2g} % of the receptance"
        )
