"""Evaluation of a measurement of roughness: what a wheel feels of its lines, their levels, and their mean."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.excitation.measured import line_on_grid
from wheelrail.excitation.measured_lines import HeightLines
from wheelrail.excitation.resampling import is_equidistant

from .roughness_levels import SEGMENT_LENGTH, SHORTEST_SEGMENT, BandLevels, line_levels, mean_levels
from .roughness_processing import WHEEL_RADIUS, remove_spikes, rolling_envelope

__all__ = ["RoughnessEvaluation", "evaluate_roughness"]

_LARGEST_SPACING = 1e-3  # m (EN 15610:2009, 5.5)


@dataclass(frozen=True, eq=False)
class RoughnessEvaluation:
    """Levels of all lines of a measurement.

    Attributes
    ----------
    spacing : float
        m.
    heights : ndarray, shape (lines, n)
        As evaluated, m: on an equidistant grid, processed.
    periodic : bool
        The heights are one turn of a wheel.
    lines : tuple of BandLevels
        Of each line.
    mean : BandLevels
        Mean over lines.
    spikes : tuple of int
        Removed from each line.
    raised : tuple of float
        Largest rise of each line where the wheel bridges a pit, m.
    notes : tuple of str
        What was done, and where the measurement is short of the standard.
    """

    spacing: float
    heights: np.ndarray
    periodic: bool
    lines: tuple[BandLevels, ...]
    mean: BandLevels
    spikes: tuple[int, ...]
    raised: tuple[float, ...]
    notes: tuple[str, ...]


def evaluate_roughness(
    lines: HeightLines,
    *,
    path: Path,
    on: str,
    wheel_radius: float | None = None,
    process: bool = True,
    segment_length: float = SEGMENT_LENGTH,
) -> RoughnessEvaluation:
    """Levels of all lines of a file, and their mean.

    Parameters
    ----------
    lines : HeightLines
        From `wheelrail.excitation.measured_lines.read_height_lines`.
    path : Path
        Their file, for messages.
    on : {"wheel", "rail"}
        Wheel: the lines are one turn each.
    wheel_radius : float or None
        Rolling radius, m; needed on the wheel, which rolls with it. On the rail a wheel of 0.375 m rolls.
    process : bool
        Remove spikes, and roll a wheel over the lines (`wheelrail.analysis.roughness_processing`). EN 15610:2009 is
        about rails; a wheel's lines are treated in the same way.
    segment_length : float
        m.

    Returns
    -------
    RoughnessEvaluation

    Raises
    ------
    DataFileError
        Lines too short, or of another length than the wheel's turn.
    ParameterError
        Unknown surface, no radius of the wheel, or segments too short.
    """
    if on not in ("wheel", "rail"):
        raise ParameterError("on", on, 'allowed: "wheel" or "rail"')
    if not (np.isfinite(segment_length) and segment_length >= SHORTEST_SEGMENT):
        raise ParameterError("segment_length", segment_length, f"at least {SHORTEST_SEGMENT:g} m (EN 15610, 7.4.2)")
    heights, spacing, notes = _equidistant(lines, path, on, wheel_radius)
    length = heights.shape[1] * spacing
    if length < SHORTEST_SEGMENT:
        raise DataFileError(f"{path}: {length:.4g} m; levels need {SHORTEST_SEGMENT:g} m at least (EN 15610, 5.6)")
    if spacing > _LARGEST_SPACING * (1.0 + 1e-6):
        notes.append(
            f"{path.name}: points are {1e3 * spacing:.4g} mm apart; EN 15610 (5.5) asks for 1 mm at most, so short "
            "waves, spikes and pits are not seen in full"
        )
    spikes, raised, processed = [], [], []
    for line in heights:
        count, rise = 0, 0.0
        if process:
            line, count = remove_spikes(line, spacing=spacing)
            radius = WHEEL_RADIUS if on == "rail" else float(wheel_radius or WHEEL_RADIUS)
            rolled = rolling_envelope(line, spacing=spacing, radius=radius, periodic=on == "wheel")
            line, rise = rolled, float(np.max(rolled - line))
        processed.append(line)
        spikes.append(count)
        raised.append(rise)
    levels = tuple(
        line_levels(line, spacing=spacing, periodic=on == "wheel", segment_length=segment_length) for line in processed
    )
    if on == "rail" and length < segment_length:
        notes.append(f"{path.name}: {length:.4g} m are taken as one segment, so levels of long waves are uncertain")
    return RoughnessEvaluation(
        spacing=spacing,
        heights=np.array(processed),
        periodic=on == "wheel",
        lines=levels,
        mean=mean_levels(levels),
        spikes=tuple(spikes),
        raised=tuple(raised),
        notes=tuple(notes),
    )


def _equidistant(
    lines: HeightLines, path: Path, on: str, wheel_radius: float | None
) -> tuple[np.ndarray, float, list[str]]:
    """Heights on an equidistant grid, its spacing, and notes."""
    if on == "rail" and is_equidistant(lines.x):
        return lines.heights, float((lines.x[-1] - lines.x[0]) / (len(lines.x) - 1)), []
    spacing = float(np.median(np.diff(lines.x)))
    values, notes = [], []
    for heights in lines.heights:
        line, line_notes = line_on_grid(
            path, lines.x, heights, dx=spacing, on=on, wheel_radius=wheel_radius, beyond_end="stop"
        )
        values.append(line.values)
        notes += [note for note in line_notes if note not in notes]
    return np.array(values), spacing, notes
