"""Universal files: data sets with their units, directions and faults, read by pyuff.

A universal file says its units in data set 164; the data sets after it are in these. Directions are those of the file's
global frame, and the user says how they lie in the frame of the package.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError, ParameterError

__all__ = ["UNITS", "DataSet", "Units", "axes_matrix", "check_node_frame", "is_universal", "node_number", "read_sets"]

DIRECTIONS = ("x", "y", "z")
LINE_END = b"\n"
_MARK = re.compile(rb"^    -1 *\r?$", re.MULTILINE)


@dataclass(frozen=True)
class Units:
    """Units of a file.

    Attributes
    ----------
    length, force : float
        Units of the file per m and per N; 1000 for mm.
    """

    length: float
    force: float

    @property
    def mass(self) -> float:
        """Kilograms in the file's unit of mass, which follows from force, length and seconds."""
        return self.length / self.force

    @property
    def receptance(self) -> float:
        """m/N in the file's unit of length over force."""
        return self.force / self.length


UNITS = {"m-kg-s": Units(1.0, 1.0), "mm-t-s": Units(1e3, 1.0), "mm-kg-s": Units(1e3, 1e3)}
"""Unit systems that a user can name for a file that doesn't say its own (rightly)."""

# Factors of data set 164 for the codes that fix them; 9 is the user's own.
_CODES = {1: Units(1.0, 1.0), 5: Units(1e3, 1e3)}


@dataclass(frozen=True, eq=False)
class DataSet:
    """A data set of a file.

    Attributes
    ----------
    kind : int
        Its number, 55 or 58 for instance.
    where : str
        How messages name it: file, place and line.
    units : Units or None
        None: the file hasn't said.
    content : dict
        As pyuff gives it; empty if pyuff doesn't know the kind.
    """

    kind: int
    where: str
    units: Units | None
    content: dict[str, Any]

    def known_units(self) -> Units:
        """Units of the data set.

        Raises
        ------
        DataFileError
            If the file doesn't say them.
        """
        if self.units is None:
            raise DataFileError(
                f"{self.where}: the file doesn't say its units (no data set 164 before this one); "
                f"give units = {' or '.join(UNITS)}"
            )
        return self.units


def is_universal(path: Path | str) -> bool:
    """Whether a file begins as universal files do; False if it can't be read."""
    try:
        with open(path, "rb") as file:
            head = file.read(4096).lstrip(b"\xef\xbb\xbf\r\n")
    except OSError:
        return False
    return re.match(rb"    -1 *[\r\n]", head) is not None


def read_sets(path: Path | str, *, kinds: Sequence[int], units: str | None) -> Iterator[DataSet]:
    """Read the data sets of some kinds, in the order of the file.

    Parameters
    ----------
    path : Path or str
    kinds : sequence of int
        Wanted kinds; those that pyuff can't read come without content.
    units : {"m-kg-s", "mm-t-s", "mm-kg-s"} or None
        Units of the file; None: as its data set 164 says.

    Yields
    ------
    DataSet

    Raises
    ------
    DataFileError
        A file or data set that can't be read, or units that contradict themselves.
    ParameterError
        Unknown ``units``.
    """
    import pyuff  # only needed for such files

    if units is not None and units not in UNITS:
        raise ParameterError("units", units, f"allowed: {', '.join(UNITS)}")
    path = Path(path)
    try:
        raw = path.read_bytes()
        file = pyuff.UFF(str(path))
        found = [int(kind) for kind in file.get_set_types()]
    except OSError as error:
        raise DataFileError(f"{path}: can't be read: {error.strerror or error}") from None
    except Exception as error:  # pyuff raises plain exceptions
        raise DataFileError(f"{path}: can't be read as a universal file ({error})") from None
    starts = [match.start() for match in _MARK.finditer(raw)][::2]
    current = None if units is None else UNITS[units]
    for i, kind in enumerate(found):
        where = f"{path}, data set {i + 1} (type {kind})"
        if len(starts) == len(found):
            where += f", line {raw.count(LINE_END, 0, starts[i]) + 1}"
        if kind not in (*kinds, 164):
            continue
        try:
            content = dict(file.read_sets(i))
        except Exception:
            raise DataFileError(f"{where}: can't be read; its records aren't laid out as the format says") from None
        if kind == 164 and units is None:
            current = _units(where, content)
        if kind in kinds:
            yield DataSet(kind, where, current, {} if set(content) <= {"type"} else content)


def _units(where: str, content: Mapping[str, Any]) -> Units:
    found = Units(float(content["length"]), float(content["force"]))
    if not (np.isfinite([found.length, found.force]).all() and found.length > 0.0 and found.force > 0.0):
        raise DataFileError(
            f"{where}: factors for length {found.length:g} and force {found.force:g}; they have to be above 0"
        )
    expected = _CODES.get(content["units_code"])
    if expected and not np.allclose([found.length, found.force], [expected.length, expected.force], rtol=1e-4):
        raise DataFileError(
            f"{where}: units code {content['units_code']} means {expected.length:g} and {expected.force:g} units per m "
            f"and N, but the factors are {found.length:g} and {found.force:g}; give units = {' or '.join(UNITS)}"
        )
    return found


def axes_matrix(path: Path, axes: Sequence[str] | None, notes: list[str]) -> NDArray:
    """Rotation from a file's frame into that of the package.

    Parameters
    ----------
    path : Path
        For messages.
    axes : sequence of 3 str
        Axes of the file along x' (rolling), y' (to the field side) and z' (down), as in ("x", "-z", "y").
    notes : list of str
        A frame of the other hand is noted here.

    Returns
    -------
    ndarray, shape (3, 3)
        Its product with a vector in the file's frame has the components x', y', z'.

    Raises
    ------
    ParameterError
        If these aren't three different axes.
    """
    wanted = (
        "it names the axes of the file that point in rolling direction, to the field side and down, "
        'for instance ["x", "-z", "y"]'
    )
    if axes is None:
        raise ParameterError("axes", axes, f"{path} is a universal file; {wanted}")
    given = [str(axis).strip().lower() for axis in axes]
    if len(given) != 3 or sorted(axis.lstrip("+-") for axis in given) != list(DIRECTIONS):
        raise ParameterError("axes", list(axes), wanted)
    matrix = np.zeros((3, 3))
    for row, axis in enumerate(given):
        matrix[row, DIRECTIONS.index(axis[-1])] = -1.0 if axis.startswith("-") else 1.0
    if np.linalg.det(matrix) < 0.0:
        notes.append(f"{path.name}: the axes {', '.join(given)} make a mirror image: right for a left-hand wheel only")
    return matrix


def node_number(node: int | None, found: Sequence[int], path: Path | str, what: str) -> int:
    """Choose the contact node: the user's, or the only one there is.

    Raises
    ------
    DataFileError
        If there are several and the user has named none, or one that isn't among them.
    """
    nodes = sorted({int(number) for number in found})
    if node is None and len(nodes) == 1:
        return nodes[0]
    if node is not None and int(node) in nodes:
        return int(node)
    listed = ", ".join(str(number) for number in nodes[:10]) + (", ..." if len(nodes) > 10 else "")
    if node is None:
        raise DataFileError(f"{path}: {what} at {len(nodes)} nodes ({listed}); say which one is the contact: node")
    raise DataFileError(f"{path}: no {what} at node {node}; there are {listed or 'none at all'}")


def check_node_frame(sets: Sequence[DataSet], node: int) -> None:
    """Refuse a node whose displacements are in a frame of its own.

    Parameters
    ----------
    sets : sequence of DataSet
        Those of types 15 and 2411 (nodes) and 2420 (coordinate systems); any others are skipped.
    node : int

    Raises
    ------
    DataFileError
        If its displacement coordinate system isn't the global one.
    """
    frames: dict[int, tuple[int, NDArray]] = {}
    for data in sets:
        if data.kind == 2420 and data.content:
            keys = ("CS_sys_labels", "CS_types", "CS_matrices")
            for label, kind, matrix in zip(*(data.content[key] for key in keys), strict=True):
                frames[int(label)] = int(kind), np.asarray(matrix)[:3]
    for data in sets:
        if data.kind not in (15, 2411) or not data.content:
            continue
        for number, label in zip(data.content["node_nums"], data.content["disp_cs"], strict=True):
            label = int(label)
            # By custom, 0 and an undefined 1 are the global system.
            kind, matrix = frames.get(label, (0, np.eye(3)) if label in (0, 1) else (-1, np.eye(3)))
            if int(number) == node and (kind != 0 or not np.allclose(matrix, np.eye(3), atol=1e-6)):
                raise DataFileError(
                    f"{data.where}: the displacements of node {node} are in coordinate system {label}, which is not "
                    "the global one; export them in the global frame"
                )
