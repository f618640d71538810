"""The command ``wheelrail contact-filter``: how much contact models filter the roughness of a case."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wheelrail.analysis.contact_filter import contact_filter_of
from wheelrail.analysis.contact_filter_models import enclosing_filters, patch_filter
from wheelrail.analysis_report import (
    AnalysisReport,
    check_folder,
    nominal_hertz,
    number_text,
    write_figure,
    write_table,
)
from wheelrail.case import Case
from wheelrail.interaction.build import hertz_of
from wheelrail.plotting.contact_filter import contact_filter_figure

__all__ = ["contact_filter_report"]

_TRANSIENT = 0.2  # of the run, unless it is given


def contact_filter_report(
    case: Case,
    folder: str | os.PathLike[str],
    *,
    stem: str,
    contacts: Sequence[str] = ("winkler",),
    transient: float | None = None,
    lateral: Sequence[float] = (0.0,),
    progress: Callable[[str], None] | None = None,
) -> AnalysisReport:
    """Contact filters of a case, beside the closed form of a patch and the tables of CNOSSOS.

    Written are ``_contact_filter.csv`` and ``_contact_filter.png``.

    Parameters
    ----------
    case : Case
    folder : path-like
        Where files go.
    stem : str
        Their names' beginning.
    contacts, lateral, progress
        As `wheelrail.analysis.contact_filter.contact_filter_of` takes them.
    transient : float, optional
        s; left out: a fifth of the run.

    Returns
    -------
    AnalysisReport

    Raises
    ------
    WheelrailError
        As `contact_filter_of`, or if a file can't be written.
    """
    folder = Path(folder)
    check_folder(folder)
    speed = case.simulation.speed
    if transient is None:
        transient = _TRANSIENT * case.simulation.duration
    filters = contact_filter_of(case, contacts=contacts, transient=transient, lateral=lateral, progress=progress)
    bands = next(iter(filters.values()))
    radius = hertz_of(case).semi_axis_x
    enclosing = enclosing_filters(load=case.load.preload, wheel_diameter=2.0 * case.wheel.radius)
    columns: dict[str, NDArray] = {name: one.levels for name, one in filters.items()}
    columns["patch"] = patch_filter(bands.wavelengths, radius=radius)
    for table in dict.fromkeys(enclosing):
        columns[f"CNOSSOS {1e-3 * table.load:g} kN"] = table.at(bands.wavelengths)
    rows = [f"contact filter in dB; contact {2e3 * radius:.3g} mm long", ""]
    rows.append(f"{'Hz':>8}{'mm':>9}" + "".join(f"{name:>16}" for name in columns))
    names = [(nominal_hertz(f), f"{1e3 * w:.4g}") for f, w in zip(bands.centres, bands.wavelengths, strict=True)]
    for i, (frequency, wavelength) in enumerate(names):
        shown = "".join(f"{number_text(values[i], 1) or '-':>16}" for values in columns.values())
        rows.append(f"{frequency:>8}{wavelength:>9}{shown}")
    figure = contact_filter_figure(
        filters=filters,
        speed=speed,
        theory={"patch, 1 / (1 + π/4 (ka)³)": (bands.wavelengths, columns["patch"])},
        enclosing=enclosing,
        title=case.title or stem,
    )
    files = (
        write_table(
            folder / f"{stem}_contact_filter.csv",
            ["frequency_Hz", "wavelength_mm", *(f"{name} [dB]" for name in columns)],
            ([*name, *(number_text(values[i]) for values in columns.values())] for i, name in enumerate(names)),
        ),
        write_figure(folder / f"{stem}_contact_filter.png", figure),
    )
    empty = [frequency for (frequency, _), level in zip(names, bands.levels, strict=True) if np.isnan(level)]
    notes = (f"no roughness at {', '.join(empty)} Hz, so no level",) if empty else ()
    return AnalysisReport("\n".join(rows), notes, files)
