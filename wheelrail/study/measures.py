"""What a study keeps of each point: statistics, third-octave spectra, squeal measures, histories, own numbers."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wheelrail.analysis.squeal import squeal_measures
from wheelrail.analysis.third_octave import third_octave
from wheelrail.case import Case
from wheelrail.errors import ParameterError
from wheelrail.interaction.simulate import Statistics
from wheelrail.numerics.third_octave_bands import centres_between
from wheelrail.results.layout import OUTPUTS

__all__ = [
    "RUN_FACTS",
    "SQUEAL",
    "STATISTICS",
    "Measure",
    "PointRun",
    "ResultSettings",
    "ThirdOctaveSettings",
    "is_statistic",
    "measured",
]

STATISTICS = ("mean", "std", "rms", "min", "max")
"""Statistics by name; beside them p0 to p100 are percentiles."""

RUN_FACTS: dict[str, tuple[str, str]] = {
    "dt": ("s", "time step"),
    "samples": ("1", "steps of the run, with the start"),
    "out_of_contact": ("1", "share of the steps without contact, over the whole run"),
    "residual_max": ("1", "largest relative residual of the contact solution, over the whole run"),
    "unreliable": ("1", "steps whose residual is above the limit, over the whole run"),
}
"""Unit and long name of what every point has."""

SQUEAL: dict[str, tuple[str, str]] = {
    "squeal_stick_share": ("1", "share of the steps in which a part of the contact sticks"),
    "squeal_main_frequency": ("Hz", "strongest line of the lateral contact force"),
    "squeal_main_amplitude": ("N", "amplitude of that line"),
    "squeal_force_rms": ("N", "lateral contact force without its mean, root mean square"),
}
"""Unit and long name of the squeal measures."""

_RESERVED = frozenset({"status", "reason", "remarks", "point", "statistic", "band", "step", "time", "distance"})
# Names in the data set beside those of measures.

_NARROWEST_BAND = 1.5  # FFT lines: what a Hann window resolves


@dataclass(frozen=True)
class ThirdOctaveSettings:
    """Third-octave spectra; the same bands for all points.

    Attributes
    ----------
    outputs : tuple of str
    lowest, highest : float
        Bands that lie wholly between them, Hz.
    """

    outputs: tuple[str, ...]
    lowest: float
    highest: float

    @property
    def centres(self) -> NDArray:
        """Exact centre frequencies in Hz, shape (bands,)."""
        return centres_between(self.lowest, self.highest)


@dataclass(frozen=True)
class ResultSettings:
    """What is kept of each point.

    Attributes
    ----------
    settle : float
        Time at which statistics and spectra begin, s from the start of the run.
    outputs : tuple of str
        Outputs whose statistics are kept.
    statistics : tuple of str
        Of `STATISTICS`, and percentiles such as ``p95``.
    histories : tuple of str
        Outputs that are kept at every step, from the start.
    third_octave : ThirdOctaveSettings or None
    squeal : bool
        Keep the measures of `wheelrail.analysis.squeal.squeal_measures`.
    """

    settle: float
    outputs: tuple[str, ...]
    statistics: tuple[str, ...]
    histories: tuple[str, ...]
    third_octave: ThirdOctaveSettings | None
    squeal: bool

    @property
    def record(self) -> tuple[str, ...]:
        """Outputs that a run has to record for this, each once."""
        spectra = () if self.third_octave is None else self.third_octave.outputs
        squeal = ("force_y", "slip_fraction") if self.squeal else ()
        return tuple(dict.fromkeys((*self.outputs, *self.histories, *spectra, *squeal)))

    def to_dict(self) -> dict[str, Any]:
        """Plain values by name."""
        return asdict(self)


@dataclass(frozen=True)
class PointRun:
    """The run of a point, as a measure of one's own gets it.

    Attributes
    ----------
    case : Case
    dt : float
        Time step, s.
    outputs : dict of str to ndarray
        ``step``, ``time`` (s), ``distance`` (m) and the recorded outputs, each of shape (n,), from the start of the
        run. Recorded is what ``output.record`` of the case and the settings of the study name.
    settled : slice
        The steps after the settling time.
    """

    case: Case
    dt: float
    outputs: dict[str, NDArray]
    settled: slice


Measure = Callable[[PointRun], Mapping[str, ArrayLike]]
"""A measure of one's own: numbers or arrays by name. Worker processes have to be able to import (or unpickle) it."""


def is_statistic(name: object) -> bool:
    """Tell whether there is a statistic of that name."""
    if not isinstance(name, str):
        return False
    percentile = re.fullmatch(r"p(\d+(?:\.\d+)?)", name)
    return name in STATISTICS or (percentile is not None and float(percentile[1]) <= 100.0)


def _statistic(name: str, values: NDArray) -> float:
    match name:
        case "mean":
            return float(values.mean())
        case "std":
            return float(values.std())
        case "rms":
            return float(np.sqrt(np.mean(values**2)))
        case "min":
            return float(values.min())
        case "max":
            return float(values.max())
    return float(np.percentile(values, float(name[1:])))


def measured(
    run: PointRun, settings: ResultSettings, statistics: Statistics, measure: Measure | None
) -> dict[str, NDArray]:
    """Measure a run.

    Parameters
    ----------
    run : PointRun
    settings : ResultSettings
    statistics : Statistics
        Of the whole run.
    measure : callable, optional
        A measure of one's own.

    Returns
    -------
    dict of str to ndarray
        Facts of `RUN_FACTS`; for each output ``NAME`` of shape (statistics,), ``NAME_third_octave`` (rms) of shape
        (bands,) and ``NAME_history`` of shape (n,), as far as asked for; `SQUEAL`; own numbers. Bands that the run
        can't resolve are nan.

    Raises
    ------
    ParameterError
        If the own measure gives what the data set can't take.
    """
    found: dict[str, Any] = {
        "dt": run.dt,
        "samples": statistics.samples,
        "out_of_contact": statistics.out_of_contact / statistics.samples,
        "residual_max": statistics.residual_max,
        "unreliable": statistics.unreliable,
    }
    part = {name: np.asarray(values[run.settled], dtype=float) for name, values in run.outputs.items()}
    for name in settings.outputs:
        found[name] = [_statistic(kind, part[name]) for kind in settings.statistics]
    if settings.third_octave is not None:
        for name in settings.third_octave.outputs:
            found[f"{name}_third_octave"] = _bands(part[name], run.dt, settings.third_octave)
    for name in settings.histories:
        found[f"{name}_history"] = run.outputs[name]
    if settings.squeal:
        squeal = squeal_measures(force_y=part["force_y"], slip_fraction=part["slip_fraction"], dt=run.dt)
        found |= {f"squeal_{name}": value for name, value in asdict(squeal).items()}
    arrays = {name: np.asarray(value, dtype=float) for name, value in found.items()}
    return arrays if measure is None else arrays | _own(measure, run, arrays)


def _bands(values: NDArray, dt: float, settings: ThirdOctaveSettings) -> NDArray:
    spectrum = third_octave(values, spacing=dt, lowest=settings.lowest, highest=settings.highest)
    rms = np.full(len(settings.centres), np.nan)  # bands above the Nyquist frequency remain
    rms[: len(spectrum.rms)] = np.where(spectrum.lines_per_band >= _NARROWEST_BAND, spectrum.rms, np.nan)
    return rms


def _own(measure: Measure, run: PointRun, taken: Mapping[str, NDArray]) -> dict[str, NDArray]:
    own = {}
    for name, value in measure(run).items():
        if (
            not isinstance(name, str)
            or not name.isidentifier()
            or name in taken
            or name in OUTPUTS
            or name in _RESERVED
        ):
            raise ParameterError("measure", name, "names must be identifiers that the data set does not use already")
        own[name] = np.asarray(value, dtype=float)
    return own
