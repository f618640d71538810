"""Figures of what a result holds: the vertical force, and the lateral force of a run with friction."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.signal import find_peaks

from wheelrail.analysis.squeal import amplitude_spectrum, squeal_measures
from wheelrail.case import Case
from wheelrail.interaction.friction import largest_friction_of

from .force import force_figure, spectrum_figure
from .squeal import squeal_figure, squeal_spectrum_figure

__all__ = ["modes_that_show", "run_figures"]

_FEWEST = 64  # samples of the second half of a run
_STRONG, _PROMINENCE = 30.0, 10.0  # dB, of a peak: below the highest one, and over what is around it
_NEAR = 2e-3  # of a mode's frequency
_STEADY = 1e-6  # change of the lateral force over the preload


def run_figures(
    dataset: xr.Dataset, case: Case, title: str, left_out: list[str], *, modes: Mapping[str, float]
) -> dict[str, Figure]:
    """Draw the forces of a run.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `wheelrail.results.open_result`.
    case : Case
        Of the result.
    title : str
    left_out : list of str
        Gets a line for each figure that can't be made.
    modes : mapping of str to float
        Frequencies of the wheel's modes in Hz, by name.

    Returns
    -------
    dict of str to Figure
        By the ends of their files' names.
    """
    figures = _vertical(dataset, case, title, left_out)
    if case.contact.tangential != "none" and case.friction is not None:
        figures |= _lateral(dataset, case, title, left_out, modes)
    return figures


def _vertical(dataset: xr.Dataset, case: Case, title: str, left_out: list[str]) -> dict[str, Figure]:
    names = [name for name in ("force_z", "force_z_mean") if name in dataset]  # equal within single steps
    if not names:
        left_out.append('force and its spectrum: the result does not hold "force_z"; add it to output.record')
        return {}
    force = dataset[names[0]].values
    spacing = getattr(case.track, "sleeper_spacing", None)
    figures = {
        "force": force_figure(
            time=dataset["time"].values,
            position=case.simulation.start_position + dataset["distance"].values,
            force=force,
            load=case.load.preload if case.load.coupling == "load" else None,
            sleeper_spacing=spacing,
            title=title,
        )
    }
    marks = {} if spacing is None else {"sleeper passing": case.simulation.speed / spacing}
    try:
        figures["force_spectrum"] = spectrum_figure(
            force=force, dt=case.simulation.dx / case.simulation.speed, title=title, marks=marks
        )
    except ValueError:
        left_out.append(f"spectrum of the force: {len(force)} samples are too few")
    return figures


def _lateral(
    dataset: xr.Dataset, case: Case, title: str, left_out: list[str], modes: Mapping[str, float]
) -> dict[str, Figure]:
    assert case.friction is not None
    found = {name: next((n for n in (name, f"{name}_mean") if n in dataset), None) for name in ("force_y", "force_z")}
    found["slip_fraction"] = "slip_fraction" if "slip_fraction" in dataset else None
    missing = [f'"{name}"' for name, present in found.items() if present is None]
    if missing:
        left_out.append(
            f"lateral force, stick and slip: the result does not hold {', '.join(missing)}; add to output.record"
        )
        return {}
    lateral, vertical, slip = (dataset[name].values for name in found.values() if name is not None)
    dt, half = case.simulation.dx / case.simulation.speed, len(lateral) // 2
    if half < _FEWEST:
        left_out.append(f"lateral force, stick and slip: {len(lateral)} samples are too few")
        return {}
    if np.ptp(lateral[half:]) < _STEADY * case.load.preload:
        left_out.append("lateral force, stick and slip: the lateral force doesn't vibrate")
        return {}
    # What the start has set off is over, as far as the run is long enough.
    measures = squeal_measures(force_y=lateral[half:], slip_fraction=slip[half:], dt=dt)
    frequency = max(measures.main_frequency, 8.0 / (len(lateral) * dt))
    return {
        "lateral_force": squeal_figure(
            time=dataset["time"].values,
            force=lateral,
            bound=largest_friction_of(case) * vertical,
            slip_fraction=slip,
            frequency=frequency,
            title=title,
        ),
        "lateral_spectrum": squeal_spectrum_figure(
            force=lateral[half:],
            dt=dt,
            modes=modes_that_show(modes, lateral[half:], dt),
            title=f"{title}: second half of the run",
        ),
    }


def modes_that_show(modes: Mapping[str, float], force: NDArray, dt: float) -> dict[str, float]:
    """Those modes that are next to a strong peak in the spectrum of a force."""
    frequency, amplitude = amplitude_spectrum(force, dt=dt)
    level = 20.0 * np.log10(np.maximum(amplitude, 1e-300))
    peaks = frequency[find_peaks(level, height=level.max() - _STRONG, prominence=_PROMINENCE)[0]]
    found = {}
    for peak in peaks if modes else ():
        name, f = min(modes.items(), key=lambda mode: abs(mode[1] - peak))
        if abs(f - peak) < max(_NEAR * f, 1.5 * frequency[1]):
            found[name] = f
    return found
