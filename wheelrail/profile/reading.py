"""Measured profiles from files: MiniProf, SIMPACK, or columns of text."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import DataFileError
from .column_points import read_column_points
from .file_points import FilePoints
from .measured_curve import checked_curve
from .miniprof import read_miniprof
from .orientation import check_kind, directions, is_plausible_width, orient, unit_by_size
from .simpack import read_simpack

__all__ = ["MeasuredProfile", "read_profile"]

_MINIPROF = (".ban", ".whl")
_SIMPACK = (".prr", ".prw")
_FARTHEST = 10.0  # m from the origin


@dataclass(frozen=True, eq=False)
class MeasuredProfile:
    """A profile as measured, in the frame of the package; not smoothed, origin as in the file.

    Attributes
    ----------
    path : Path
        The file.
    kind : {"wheel", "rail"}
    y : ndarray, shape (n,)
        Lateral coordinate, m, positive to the field side. It may run back on the face of the flange or under the head.
    z : ndarray, shape (n,)
        Vertical coordinate, m, positive down: into the rail; for a wheel towards a larger radius, the flange.
    notes : tuple of str
        What was assumed, detected or changed: unit, directions, order, repeated points.
    """

    path: Path
    kind: str
    y: NDArray
    z: NDArray
    notes: tuple[str, ...]


def read_profile(path: Path | str, *, kind: str, mirrored: bool | None = None) -> MeasuredProfile:
    """Read a measured profile, check it and turn it into the frame of the package.

    Parameters
    ----------
    path : Path or str
        MiniProf (``.ban``, ``.whl``), SIMPACK (``.prr``, ``.prw``), or else columns of text; see the modules
        `miniprof`, `simpack` and `column_points`. A MiniProf or SIMPACK file under another name is recognised by its
        first lines.
    kind : {"wheel", "rail"}
    mirrored : bool or None
        Whether y of the file, after the steps that the file prescribes, counts to the gauge side (for a wheel: has the
        flange at positive y). None: a wheel tells by its flange; of a rail the gauge side is taken at negative y, as
        SIMPACK has it. MiniProf doesn't fix the side: public files have it at either.

    Returns
    -------
    MeasuredProfile
        From the gauge side (flange) to the field side.

    Raises
    ------
    DataFileError
        The file can't be read or holds no usable profile; the message gives line, value and what is allowed.
    ParameterError
        Another kind.
    """
    check_kind(kind)
    path = Path(path)
    given = _read(path)
    if given.kind not in (None, kind):
        raise DataFileError(f"{path}: the file holds the profile of a {given.kind}; a {kind} is asked for")
    notes = list(given.notes)
    points = _in_metres(path, given, notes)
    points, told = checked_curve(path, points, given.lines)
    notes += told
    y, z = points.T
    if mirrored is None and kind == "rail":
        notes.append("gauge side taken at negative y, field side at positive y; if not, read it as mirrored")
    if mirrored:
        y = -y
    try:
        if mirrored is not None and directions(y, z, kind=kind)[0] < 0.0:
            raise DataFileError(f"the flange lies on the other side; mirrored = {mirrored} doesn't fit this wheel")
        y, z, turned = orient(y, z, kind=kind)
    except DataFileError as error:
        raise DataFileError(f"{path}: {error}") from None
    return MeasuredProfile(path, kind, y, z, (*notes, *turned))


def _read(path: Path) -> FilePoints:
    suffix = path.suffix.lower()
    if suffix in _SIMPACK:
        return read_simpack(path)
    if suffix in _MINIPROF:
        return read_miniprof(path)
    beginning = _beginning(path)
    if "header.begin" in beginning or "spline.begin" in beginning:
        return read_simpack(path)
    if any(word in beginning for word in ("xypoints=", "columndef=", "mptypeno=", "#miniwheelprof", "#minirailprof")):
        return read_miniprof(path)
    return read_column_points(path)


def _beginning(path: Path) -> str:
    """First few thousand characters in lower case; empty if there are none, which the readers report."""
    try:
        with path.open("rb") as stream:
            return stream.read(4096).decode("latin-1").lower()
    except (OSError, ValueError):
        return ""


def _in_metres(path: Path, given: FilePoints, notes: list[str]) -> NDArray:
    """Points, m, shape (n, 2); of a plausible size."""
    values, unit = given.values, given.unit
    if not len(values):
        raise DataFileError(f"{path}: no points; a profile has one a line")
    largest = np.max(np.abs(values), axis=1)
    far = largest > _FARTHEST / (unit if unit else 1e-3)
    if np.any(far):
        row = int(np.argmax(far))
        raise DataFileError(
            f"{path}, line {given.lines[row]}: {largest[row]:g} is implausible; a profile lies within {_FARTHEST:g} m "
            "of its origin. Is the unit right?"
        )
    if unit is None:
        try:
            unit, name = unit_by_size(values[:, 0])
        except DataFileError as error:
            raise DataFileError(f"{path}: {error}") from None
        notes.append(f"no unit in the file; taken as {name}, by the width")
    width = float(np.ptp(values[:, 0])) * unit
    if not is_plausible_width(width):
        raise DataFileError(
            f"{path}: the profile is {width * 1e3:.4g} mm wide; 20 mm to 200 mm are plausible. Is the unit right?"
        )
    return unit * values
