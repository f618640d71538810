"""The command ``wheelrail decay-rate``: track decay rates of a case, beside the limits of a reference track."""

from __future__ import annotations

import os
from pathlib import Path

from wheelrail.analysis.track_decay_rate import decay_rate_limit, track_decay_rate
from wheelrail.analysis_report import AnalysisReport, check_folder, nominal_hertz, write_figure, write_table
from wheelrail.case import Case
from wheelrail.errors import ParameterError
from wheelrail.interaction.build import track_of
from wheelrail.plotting.decay_rate import decay_rate_figure

__all__ = ["decay_rate_report"]


def decay_rate_report(case: Case, folder: str | os.PathLike[str], *, stem: str) -> AnalysisReport:
    """Track decay rates of a case's track after EN 15461, beside the limits of EN ISO 3095.

    Written are ``_decay_rate.csv`` and ``_decay_rate.png``.

    Parameters
    ----------
    case : Case
    folder : path-like
        Where files go.
    stem : str
        Their names' beginning.

    Returns
    -------
    AnalysisReport

    Raises
    ------
    WheelrailError
        If the track is rigid, or a file can't be written.
    """
    folder = Path(folder)
    check_folder(folder)
    track = track_of(case)
    if track is None:
        raise ParameterError("track.model", "rigid", "a rigid track has no decay rate; choose discrete or waveguide")
    rates = track_decay_rate(track)
    centres = next(iter(rates.values())).centres
    columns: dict[str, list[str]] = {}
    verdicts, notes = [], []
    for name, rate in rates.items():
        limits = {nominal_hertz(f): limit for f, limit in zip(*decay_rate_limit(name), strict=True)}
        known = [limits.get(nominal_hertz(f)) for f in centres]
        columns[f"{name}_dB_per_m"] = [f"{value:.3f}" for value in rate.rates]
        columns[f"{name}_limit_dB_per_m"] = ["" if limit is None else f"{limit:g}" for limit in known]
        below = [
            nominal_hertz(f) for f, value, low in zip(centres, rate.rates, known, strict=True) if low and value < low
        ]
        verdicts.append(
            f"{name}: " + (f"below the limit at {', '.join(below)} Hz" if below else "nowhere below the limit")
        )
        unsure = [nominal_hertz(f) for f, sure in zip(centres, rate.measurable, strict=True) if not sure]
        if unsure:
            notes.append(f"{name}, {', '.join(unsure)} Hz: upper bounds; the grid of EN 15461 is too short for them")
    if "lateral" not in rates:
        notes.append("lateral: a beam has no lateral receptance; a waveguide track does")
    titles = [name.removesuffix("_dB_per_m").replace("_", " ") for name in columns]
    rows = ["track decay rate (EN 15461) in dB/m, force at midspan", ""]
    rows.append(f"{'Hz':>8}" + "".join(f"{title:>16}" for title in titles))
    for i, centre in enumerate(centres):
        rows.append(f"{nominal_hertz(centre):>8}" + "".join(f"{values[i] or '-':>16}" for values in columns.values()))
    rows += ["", *verdicts, "limits: EN ISO 3095:2013, figure 3"]
    table = ([nominal_hertz(f), *(values[i] for values in columns.values())] for i, f in enumerate(centres))
    files = (
        write_table(folder / f"{stem}_decay_rate.csv", ["frequency_Hz", *columns], table),
        write_figure(folder / f"{stem}_decay_rate.png", decay_rate_figure(rates, title=case.title or stem)),
    )
    return AnalysisReport("\n".join(rows), tuple(notes), files)
