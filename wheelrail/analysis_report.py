"""Report of a command that analyses something: its text, and the tables and figures that it writes."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from wheelrail.errors import WheelrailError
from wheelrail.plotting.force import nominal_frequency

__all__ = ["AnalysisReport", "check_folder", "nominal_hertz", "number_text", "write_figure", "write_table"]


@dataclass(frozen=True)
class AnalysisReport:
    """What a command found.

    Attributes
    ----------
    text : str
        To be printed.
    notes : tuple of str
        What is missing, and why.
    files : tuple of Path
        Written files.
    """

    text: str
    notes: tuple[str, ...]
    files: tuple[Path, ...]


def nominal_hertz(centre: float) -> str:
    """Nominal frequency of a band in Hz, without a letter for thousands."""
    name = nominal_frequency(float(centre))
    return f"{1e3 * float(name[:-1]):g}" if name.endswith("k") else name


def number_text(value: float, digits: int = 2) -> str:
    """Write a number; nothing if it is not known or infinite."""
    return f"{value:.{digits}f}" if np.isfinite(value) else ""


def check_folder(folder: Path) -> None:
    """Refuse a folder that is not there (`WheelrailError`)."""
    if not folder.is_dir():
        raise WheelrailError(f"{folder}: no such folder; make it first or choose another --output")


def write_table(target: Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> Path:
    """Write a CSV file and return its path; `WheelrailError` if that fails."""
    try:
        with open(target, "w", encoding="utf-8", newline="") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow(header)
            writer.writerows(rows)
    except OSError as error:
        raise WheelrailError(f"{target}: can't be written: {error.strerror or error}") from error
    return target


def write_figure(target: Path, figure: Figure) -> Path:
    """Write a PNG file and return its path; `WheelrailError` if that fails."""
    try:
        figure.savefig(target, format="png")
    except OSError as error:
        raise WheelrailError(f"{target}: can't be written: {error.strerror or error}") from error
    return target
