"""Contact filter effect of a run: how much lower its contact force is than that of a Hertz spring on the raw roughness.

Both runs roll over the same roughness; the difference of their third-octave levels is the filter effect (Pieringer
2011, section 5.1 and fig. 5.1b). Over several parallel lines, the reference and the contacts that know one line only
roll over each line in turn, and the curves in dB are averaged. Bands without
roughness are left out, since the force there is only what is not linear.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wheelrail.case import Case, case_from_dict
from wheelrail.errors import ParameterError
from wheelrail.interaction.build import build_model
from wheelrail.interaction.model import Model
from wheelrail.interaction.simulate import simulate, stand_alone_inputs
from wheelrail.interaction.surfaces import Surfaces, total_shift

from .third_octave import ThirdOctaveSpectrum, third_octave

__all__ = ["CONTACTS", "ContactFilter", "contact_filter", "contact_filter_of", "mean_filter"]

CONTACTS: dict[str, dict[str, str]] = {
    "winkler": {"normal": "winkler", "prefilter": "none"},
    "half-space": {"normal": "half-space", "prefilter": "none"},
    "hertz-average": {"normal": "hertz", "prefilter": "average"},
    "hertz-winkler": {"normal": "hertz", "prefilter": "winkler"},
}
"""Contacts that filter, and how a case asks for them."""

_REFERENCE = {"normal": "hertz", "prefilter": "none"}
_LEAKAGE = 1e-2  # of the mean square of the strongest band nearby, at most
_SHAPES = ("wheel-flat", "rail-joint", "dent")
_FEWEST_LINES = 3.0  # of the Fourier transform in a band, or its level is chance


@dataclass(frozen=True, eq=False)
class ContactFilter:
    """Level of the contact force over that of the reference.

    Attributes
    ----------
    centres : ndarray, shape (bands,)
        Exact centre frequencies, Hz, ascending.
    wavelengths : ndarray, shape (bands,)
        Of the roughness at these frequencies, speed over frequency, m.
    levels : ndarray, shape (bands,)
        dB; NaN where the reference has no force, or a case no roughness.
    runs : int
        Number of lines that the levels are the mean of.
    """

    centres: NDArray
    wavelengths: NDArray
    levels: NDArray
    runs: int = 1


def contact_filter(
    force: ArrayLike,
    reference: ArrayLike,
    *,
    dt: float,
    speed: float,
    transient: float,
    segment: float | None = None,
) -> ContactFilter:
    """Compare the force of a run with that of the reference run, band by band.

    Parameters
    ----------
    force, reference : array_like, shape (n,)
        Vertical contact force over the same roughness, N.
    dt : float
        s.
    speed : float
        m/s.
    transient : float
        s; this much of the beginning is left out.
    segment : float or None
        s, of the segments that spectra are averaged over; None: the whole rest at once.

    Returns
    -------
    ContactFilter

    Raises
    ------
    ValueError
        Forces of different length or not finite.
    ParameterError
        If too little is left after the transient.
    """
    forces = [np.asarray(values, dtype=float) for values in (force, reference)]
    if forces[0].shape != forces[1].shape:
        raise ValueError("force and reference must have the same shape")
    if not (np.isfinite(speed) and speed > 0.0):
        raise ParameterError("speed", speed, "must be a number > 0 m/s")
    first = _first_row(transient, dt=dt, count=len(forces[0]))
    length = None if segment is None else min(round(segment / dt), len(forces[0]) - first)
    own, other = (third_octave(values[first:], spacing=dt, segment=length) for values in forces)
    return _difference(own, other, speed=speed)


def _first_row(transient: float, *, dt: float, count: int) -> int:
    if not (np.isfinite(transient) and transient >= 0.0):
        raise ParameterError("transient", transient, "must be a number >= 0 s")
    first = round(transient / dt)
    if count - first < 64:
        raise ParameterError(
            "transient", transient, f"nothing is left to analyse of a run of {(count - 1) * dt:.4g} s; make it longer"
        )
    return first


def _difference(own: ThirdOctaveSpectrum, other: ThirdOctaveSpectrum, *, speed: float) -> ContactFilter:
    kept = own.lines_per_band >= _FEWEST_LINES
    with np.errstate(divide="ignore", invalid="ignore"):
        levels = 10.0 * np.log10(own.mean_square / other.mean_square)[kept]
    levels[~np.isfinite(levels)] = np.nan
    return ContactFilter(own.centres[kept], speed / own.centres[kept], levels)


def mean_filter(filters: Sequence[ContactFilter]) -> ContactFilter:
    """Mean of the levels in dB, as Pieringer (2011, fig. 5.1b) averages over lines.

    Raises
    ------
    ValueError
        No filter, or filters of different bands.
    """
    if not filters:
        raise ValueError("a mean needs a filter at least")
    first = filters[0]
    if any(not np.array_equal(one.centres, first.centres) for one in filters):
        raise ValueError("the filters must have the same bands")
    levels = np.mean([one.levels for one in filters], axis=0)
    return replace(first, levels=levels, runs=sum(one.runs for one in filters))


def contact_filter_of(
    case: Case,
    *,
    contacts: Sequence[str] = ("winkler", "half-space"),
    transient: float,
    lateral: Sequence[float] = (0.0,),
    segment: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> dict[str, ContactFilter]:
    """Run a case with several contacts and with the reference, and compare.

    Parameters
    ----------
    case : Case
        Its normal contact and prefilter do not matter, and friction is left out; its roughness does.
    contacts : sequence of str
        Keys of `CONTACTS`.
    transient : float
        s; this much of the beginning of each run is left out.
    lateral : sequence of float
        Lines that the reference and the contacts along one line roll over, m beside the nominal contact point. Where
        the roughness is the same all across, one is enough.
    segment : float or None
        As `contact_filter` takes it.
    progress : callable, optional
        Called with what is run next.

    Returns
    -------
    dict of str to ContactFilter
        By the names of ``contacts``.

    Raises
    ------
    ParameterError
        Unknown contact, no line, or too short a run.
    CaseError
        If the case lacks what a contact needs, such as ``contact.width``.
    WheelrailError
        If a run fails.
    """
    for name in contacts:
        if name not in CONTACTS:
            raise ParameterError("contacts", name, f"allowed: {', '.join(CONTACTS)}")
    if not lateral:
        raise ParameterError("lateral", list(lateral), "at least one line")
    simulation = case.simulation
    dt = simulation.dx / simulation.speed
    _first_row(transient, dt=dt, count=int(simulation.duration / dt) + 1)
    if not case.excitation:
        raise ParameterError("case", case.title, "it has no [[excitation]]; there is nothing to filter")
    shapes = [entry.type for entry in case.excitation if entry.type in _SHAPES]
    if shapes:
        raise ParameterError(
            "excitation", shapes[0], "a contact filters roughness; leave flats, joints and dents out of the case"
        )
    cases = {name: _with_contact(case, CONTACTS[name]) for name in contacts}

    def say(text: str) -> None:
        if progress is not None:
            progress(text)

    say("reference")
    model = build_model(_with_contact(case, _REFERENCE))
    references = [_force(_beside(model, y), case) for y in lateral]
    rough = [_has_roughness(_beside(model, y), len(references[0]), transient=transient) for y in lateral]
    result = {}
    for name, changed in cases.items():
        say(name)
        model = build_model(changed)
        # The half-space sees all lines at once.
        wide = model.contact.rows > 1
        forces = [_force(model, case)] * len(lateral) if wide else [_force(_beside(model, y), case) for y in lateral]
        filters = []
        for force, reference, seen in zip(forces, references, rough, strict=True):
            one = contact_filter(force, reference, dt=dt, speed=simulation.speed, transient=transient, segment=segment)
            filters.append(replace(one, levels=np.where(seen(one.centres), one.levels, np.nan)))
        if all(np.all(np.isnan(one.levels)) for one in filters):
            raise ParameterError(
                "case", case.title, "its roughness moves nothing in the run; there is nothing to filter"
            )
        result[name] = mean_filter(filters)
    return result


def _with_contact(case: Case, contact: dict[str, str]) -> Case:
    data = case.to_dict()
    data["contact"] |= {"tangential": "none", **contact}
    if contact["normal"] == "half-space":
        del data["contact"]["prefilter"]
    return case_from_dict(data, source=f"contact filter, {contact['normal']}", folder=case.folder)


def _beside(model: Model, y: float) -> Model:
    """Let the contact roll over the line at y (m)."""
    if y == 0.0:
        return model
    sources: tuple[Any, ...] = model.sources
    return replace(
        model, sources=tuple(replace(one, lateral=one.lateral - y) if one.across else one for one in sources)
    )


def _force(model: Model, case: Case) -> NDArray:
    """Vertical contact force of a run, N."""
    return simulate(model, duration=case.simulation.duration, record=["force_z"]).collect()["force_z"]


def _has_roughness(model: Model, count: int, *, transient: float) -> Callable[[NDArray], NDArray]:
    """Tell which bands hold roughness under the contact's centre; elsewhere a window's leakage is all there is."""
    surfaces = Surfaces(model)
    surfaces.move(model, total_shift(model, stand_alone_inputs(model)))
    heights = np.empty(count)
    for i in range(count):
        row = surfaces.heights(model, model.start_index + i)
        heights[i] = row[len(row) // 2]
    spectrum = third_octave(heights[round(transient / model.dt) :], spacing=model.dt)
    # The strongest of the band and two on either side; what leaks does not reach further.
    padded = np.pad(spectrum.mean_square, 2)
    strongest = np.lib.stride_tricks.sliding_window_view(padded, 5).max(axis=1)
    held = spectrum.centres[spectrum.mean_square > _LEAKAGE * strongest]
    return lambda centres: np.isin(np.rint(10.0 * np.log10(centres)), np.rint(10.0 * np.log10(held)))
