"""Wheel flats as they were measured: depth along the tread, on one line or several parallel ones."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from wheelrail.errors import DataFileError
from wheelrail.excitation.measured_lines import read_height_lines

__all__ = ["measured_flat"]

_EDGE_SHARE = 0.08  # of the points, at each end: the sound tread
_FEWEST_EDGE_POINTS = 3
_LARGEST_EDGE = 0.04  # of the depth: beyond, the file does not reach the sound tread


def measured_flat(
    path: Path | str, *, lateral: Sequence[float] | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[str]]:
    """Read a flat.

    The tread beside the flat is level: on each line the straight line through its ends is taken out.

    Parameters
    ----------
    path : Path or str
        File of one or several lines, see `wheelrail.excitation.measured_lines.read_height_lines`: positions along the
        tread from the middle of the flat, heights of the tread above its round shape (negative in the flat).
    lateral : sequence of float, optional
        Positions of the lines across, m, if the header does not name them.

    Returns
    -------
    positions : ndarray, shape (n,)
        m.
    heights : ndarray, shape (lines, n)
        m.
    lateral : ndarray, shape (lines,)
        m; one line holds for the whole width.
    notes : list of str

    Raises
    ------
    DataFileError
        The file can't be read, or holds no flat with level tread on both sides.
    """
    path = Path(path)
    lines = read_height_lines(path, lateral=lateral)
    heights, across = lines.heights, lines.lateral
    notes = []
    if across is None:
        if len(heights) > 1:
            notes.append(
                f"{path.name}: no positions across are given, so only the first of {len(heights)} lines is used"
            )
        heights, across = heights[:1], np.zeros(1)
    x = lines.x
    edge_points = max(_FEWEST_EDGE_POINTS, round(_EDGE_SHARE * len(x)))
    ends = np.r_[0:edge_points, len(x) - edge_points : len(x)]
    level = np.array([np.polyval(np.polyfit(x[ends], line[ends], 1), x) for line in heights])
    shape = heights - level
    depth = -float(shape.min())
    edge = float(np.abs(shape[:, ends]).max())
    if not depth > 0.0:
        raise DataFileError(
            f"{path}: no flat: nothing lies below the line through the ends; missing material is negative"
        )
    if edge > _LARGEST_EDGE * depth:
        raise DataFileError(
            f"{path}: the ends differ from a straight line by {1e6 * edge:.3g} um, {100.0 * edge / depth:.0f} % of the "
            f"depth, and at most {100.0 * _LARGEST_EDGE:.0f} % is allowed: the file must reach the sound tread on both "
            "sides"
        )
    shape[:, [0, -1]] = 0.0
    notes.append(
        f"{path.name}: flat {1e3 * depth:.4g} mm deep on {len(shape)} line{'s' if len(shape) > 1 else ''} of "
        f"{1e3 * (x[-1] - x[0]):.4g} mm; the straight line through the ends is taken out"
    )
    return x, shape, across, notes
