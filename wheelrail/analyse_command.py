"""The command ``wheelrail analyse``: spectra, impacts, stick and slip of a result."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from wheelrail.analysis.contact_velocity import DISPLACEMENTS, contact_velocities
from wheelrail.analysis.impact_statistics import ImpactStatistics, Turn, impact_statistics, turns
from wheelrail.analysis.stick_slip import STATES, stick_slip
from wheelrail.analysis.third_octave import third_octave
from wheelrail.analysis_report import (
    AnalysisReport,
    check_folder,
    nominal_hertz,
    number_text,
    write_figure,
    write_table,
)
from wheelrail.errors import ParameterError
from wheelrail.plotting.impacts import impacts_figure
from wheelrail.plotting.velocity_spectra import velocity_figure
from wheelrail.results import ResultFileError, case_of_result, open_result

__all__ = ["analyse_result"]

_FEWEST = 64  # rows after the transient
_TRANSIENT = 0.2  # of the run, unless it is given
_MOST_IMPACTS = 8  # in the text; all are in the table
_VELOCITY, _FORCE = "_velocity_dB_re_1_nm_per_s", "_dB_re_1_N"


def analyse_result(
    path: str | os.PathLike[str],
    folder: str | os.PathLike[str],
    *,
    transient: float | None = None,
    factor: float = 1.5,
) -> AnalysisReport:
    """Evaluate a result: third-octave spectra of force and velocities, impacts, stick and slip.

    Written are, named after the result: ``_bands.csv`` (levels of force and velocities), ``_impacts.csv``,
    ``_turns.csv`` (if a whole turn of the wheel is left), ``_impacts.png`` and ``_velocity.png``.

    Parameters
    ----------
    path : path-like
        A result file.
    folder : path-like
        Where files go.
    transient : float, optional
        s; this much of the beginning is left out. Left out itself: a fifth of the run.
    factor : float
        An impact exceeds this multiple of the preload.

    Returns
    -------
    AnalysisReport

    Raises
    ------
    ResultFileError
        If the result can't be read, or lacks the vertical force.
    ParameterError
        If too little is left after the transient, or the factor is out of its range.
    WheelrailError
        If a file can't be written.
    """
    path, folder = Path(path), Path(folder)
    check_folder(folder)
    with open_result(path) as dataset:
        case = case_of_result(dataset, source=str(path), structures=False)
        force = _recorded(dataset, "force_z")
        if force is None:
            raise ResultFileError(f'{path}: holds no "force_z"; add it to output.record of the case and run it again')
        simulation = case.simulation
        dt = simulation.dx / simulation.speed
        time = dataset["time"].values
        if transient is None:
            transient = _TRANSIENT * float(time[-1])
        if not (np.isfinite(transient) and transient >= 0.0):
            raise ParameterError("transient", transient, "must be a number >= 0 s")
        first = round(transient / dt)
        if len(force) - first < _FEWEST:
            raise ParameterError("transient", transient, f"leaves next to nothing of a run of {time[-1]:.4g} s")
        displacements = {name: dataset[name].values for name in DISPLACEMENTS if name in dataset}
        lateral, slip = _recorded(dataset, "force_y"), _recorded(dataset, "slip_fraction")
    notes = []
    force, title = force[first:], case.title or path.stem
    statistics = impact_statistics(
        force, dt=dt, speed=simulation.speed, static_load=case.load.preload, factor=factor, start_time=first * dt
    )
    found = turns(force, dt=dt, speed=simulation.speed, radius=case.wheel.radius, start_time=first * dt)
    spectrum = third_octave(force, spacing=dt)
    rows = [f"{title}: from {first * dt:.4g} s to {time[-1]:.4g} s", "", *_impact_text(statistics, found)]
    if case.contact.tangential != "none":
        if lateral is None or slip is None:
            notes.append('stick and slip: the result lacks "force_y" or "slip_fraction"; add both to output.record')
        else:
            rows += ["", *_stick_slip_text(slip[first:], force, lateral[first:], dt)]
    levels: dict[str, NDArray] = {f"force{_FORCE}": spectrum.level(reference=1.0)}
    figures = {"impacts": impacts_figure(force=force, statistics=statistics, turns=found, title=title)}
    # A rigid structure does not move; its displacement has no spectrum.
    displacements = {name: values for name, values in displacements.items() if np.ptp(values[first:]) > 0.0}
    if displacements and len(spectrum.centres):
        velocities = contact_velocities(displacements, dt=dt, transient=first * dt)
        # One sample less makes the bands no narrower: both begin with the same one, or the velocities one later.
        for name in velocities.mean_squares:
            known = dict(zip(np.rint(10.0 * np.log10(velocities.centres)), velocities.levels(name), strict=True))
            bands = np.rint(10.0 * np.log10(spectrum.centres))
            levels[f"{name}{_VELOCITY}"] = np.array([known.get(band, np.nan) for band in bands])
        figures["velocity"] = velocity_figure(velocities, title=title)
    else:
        notes.append('velocities: the result lacks displacements that move, such as "wheel_disp_z" and "rail_disp_z"')
    rows += ["", *_band_text(spectrum.centres, levels)]
    files = [
        write_table(
            folder / f"{path.stem}_bands.csv",
            ["frequency_Hz", "wavelength_mm", *levels],
            (
                [
                    nominal_hertz(f),
                    f"{1e3 * simulation.speed / f:.4g}",
                    *(number_text(values[i]) for values in levels.values()),
                ]
                for i, f in enumerate(spectrum.centres)
            ),
        ),
        write_table(
            folder / f"{path.stem}_impacts.csv",
            ["time_s", "distance_m", "peak_N", "duration_s", "impulse_N_s"],
            ([f"{x:.7g}" for x in (i.time, i.position, i.peak, i.duration, i.impulse)] for i in statistics.impacts),
        ),
    ]
    if found:
        files.append(
            write_table(
                folder / f"{path.stem}_turns.csv",
                ["turn", "time_s", "angle_rad", "largest_N", "smallest_N", "lost_share"],
                (
                    [t.number + 1, *(f"{x:.7g}" for x in (t.time, t.angle, t.largest, t.smallest, t.lost))]
                    for t in found
                ),
            )
        )
    files += [write_figure(folder / f"{path.stem}_{name}.png", figure) for name, figure in figures.items()]
    return AnalysisReport("\n".join(rows), tuple(notes), tuple(files))


def _recorded(dataset: xr.Dataset, name: str) -> NDArray | None:
    """Values of an output, or its mean over the step, which a stand-alone run does not tell from it."""
    return next((dataset[key].values for key in (name, f"{name}_mean") if key in dataset), None)


def _impact_text(statistics: ImpactStatistics, found: Sequence[Turn]) -> list[str]:
    kilo = 1e-3
    share = ", ".join(f"{percent:g} %: {kilo * value:.1f}" for percent, value in statistics.percentiles.items())
    losses = statistics.losses
    rows = [
        f"contact force    min {kilo * statistics.smallest:.2f} kN, mean {kilo * statistics.mean:.2f} kN, "
        f"max {kilo * statistics.largest:.2f} kN, standard deviation {kilo * statistics.standard_deviation:.2f} kN",
        f"dynamic factor   {statistics.dynamic_load_factor:.3f} (largest force over preload)",
        f"percentiles      {share} kN",
        f"loss of contact  {len(losses)} times, {100.0 * statistics.lost_share:.3g} % of the time"
        + (
            f"; longest {1e3 * max(loss.duration for loss in losses):.3g} ms, "
            f"{1e3 * max(loss.distance for loss in losses):.3g} mm"
            if losses
            else ""
        ),
        f"impacts          {len(statistics.impacts)} above {kilo * statistics.threshold:.1f} kN",
    ]
    strongest = sorted(statistics.impacts, key=lambda impact: -impact.peak)[:_MOST_IMPACTS]
    for impact in sorted(strongest, key=lambda impact: impact.time):
        rows.append(
            f"    t = {impact.time:.4f} s  {kilo * impact.peak:8.1f} kN  {1e3 * impact.duration:6.2f} ms  "
            f"{impact.impulse:8.1f} N s above the preload"
        )
    if found:
        largest = np.array([turn.largest for turn in found])
        rows.append(
            f"wheel turns      {len(found)}; largest force of a turn {kilo * largest.min():.2f} to "
            f"{kilo * largest.max():.2f} kN, mean {kilo * largest.mean():.2f} kN"
        )
    return rows


def _stick_slip_text(slip: NDArray, force: NDArray, lateral: NDArray, dt: float) -> list[str]:
    found = stick_slip(slip_fraction=slip, in_contact=force, force=lateral, dt=dt)
    rows = ["contact state    " + ", ".join(f"{name} {100.0 * found.shares[name]:.3g} %" for name in STATES)]
    if not found.occurs:
        return [*rows, "stick/slip       no whole cycle"]
    kind = "regular" if found.regular() else "not regular"
    rows.append(
        f"stick/slip       {found.cycles} cycles, {found.frequency:.4g} Hz, {kind}"
        + ("" if found.cycles < 2 else f" (spread {found.spread:.2g}, periodicity {found.periodicity:.2f})")
    )
    return rows


def _band_text(centres: NDArray, levels: dict[str, NDArray]) -> list[str]:
    if not len(centres):
        return ["third-octave levels: the run is too short for a band"]
    titles = [name.removesuffix(_VELOCITY).removesuffix(_FORCE) for name in levels]
    rows = [
        "third-octave levels: force in dB re 1 N, velocities of displacements in dB re 1 nm/s",
        f"{'Hz':>8}" + "".join(f"{title:>14}" for title in titles),
    ]
    for i, centre in enumerate(centres):
        rows.append(
            f"{nominal_hertz(centre):>8}"
            + "".join(f"{number_text(values[i], 1) or '-':>14}" for values in levels.values())
        )
    return rows
