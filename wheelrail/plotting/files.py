"""All figures of one result as files."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from wheelrail.case import Case
from wheelrail.errors import CaseError, WheelrailError
from wheelrail.interaction.build import wheel_of
from wheelrail.results import ResultFileError, case_of_result, open_result

from .model_figures import model_figures, names_of_modes
from .run_figures import run_figures

__all__ = ["FORMATS", "PlotError", "Plots", "plot_result"]

FORMATS = ("png", "pdf", "svg")


class PlotError(WheelrailError):
    """Figures can't be made or written."""


@dataclass(frozen=True)
class Plots:
    """What was drawn.

    Attributes
    ----------
    files : tuple of Path
    left_out : tuple of str
        Why a figure is missing, one line each.
    """

    files: tuple[Path, ...]
    left_out: tuple[str, ...]


def plot_result(
    path: str | os.PathLike[str],
    folder: str | os.PathLike[str],
    *,
    format: str = "png",
    progress: Callable[[float], None] | None = None,
) -> Plots:
    """Draw a result and the model behind it.

    Parameters
    ----------
    path : path-like
        A result file.
    folder : path-like
        Where the figures go, each named after the result.
    format : {"png", "pdf", "svg"}
    progress : callable, optional
        Called with the share of the Green's functions done, if they have to be computed again.

    Returns
    -------
    Plots

    Raises
    ------
    ResultFileError
        If the result can't be read.
    PlotError
        If a figure can't be written.
    """
    path, folder = Path(path), Path(folder)
    if format not in FORMATS:
        raise PlotError(f"format {format!r} is refused: allowed are {', '.join(FORMATS)}")
    if not folder.is_dir():
        raise PlotError(f"{folder}: there is no such folder; make it first or choose another --output")
    left_out: list[str] = []
    with open_result(path) as dataset:
        case, missing = _case_of(dataset, path)
        title = case.title or path.stem
        modes = {} if missing else names_of_modes(wheel_of(case))
        figures = run_figures(dataset, case, title, left_out, modes=modes)
    if missing:
        left_out.append(f"receptances and Green's functions: {missing}")
    else:
        figures |= model_figures(case, title, progress, left_out)
    files = []
    for name, figure in figures.items():
        target = folder / f"{path.stem}_{name}.{format}"
        _write(figure, target, format)
        files.append(target)
    return Plots(tuple(files), tuple(left_out))


def _write(figure: Figure, target: Path, format: str) -> None:
    part = target.with_name(target.name + ".part")
    try:
        figure.savefig(part, format=format)
        os.replace(part, target)
    except OSError as error:
        raise PlotError(f"{target}: can't be written: {error.strerror or error}") from error
    finally:
        part.unlink(missing_ok=True)


def _case_of(dataset: xr.Dataset, path: Path) -> tuple[Case, str]:
    """Case of a result, and what is missing of its wheel and track, which then count as rigid."""
    try:
        return case_of_result(dataset, source=str(path)), ""
    except ResultFileError as error:
        try:
            case = case_of_result(dataset, source=str(path), structures=False)
        except ResultFileError:
            raise error from None
        faults = error.__cause__.faults if isinstance(error.__cause__, CaseError) else [str(error)]
        return case, "; ".join(faults)
