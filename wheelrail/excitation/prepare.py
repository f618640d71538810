"""From one entry ``[[excitation]]`` of a case to a source of roughness."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.excitation.measured import read_measured_line
from wheelrail.excitation.measured_lines import names_positions, read_measured_lines
from wheelrail.excitation.named_spectra import SpectrumTable, named_spectrum, read_spectrum
from wheelrail.excitation.prepare_irregularities import (
    prepare_corrugation,
    prepare_dent,
    prepare_out_of_round,
    prepare_rail_joint,
    prepare_wheel_flat,
)
from wheelrail.excitation.sources import CoherentSpectrum, Sinusoid, Source, SpectrumLine
from wheelrail.excitation.synthesis import plan_harmonics, rail_repeat_length
from wheelrail.excitation.view import ContactView

__all__ = ["prepare_source"]

_MOST_SAMPLES = 20_000_000


def prepare_source(
    *, type: str, dx: float, wheel_radius: float | None, view: ContactView, **keys: object
) -> tuple[Source, list[str]]:
    """Make the source that an entry of a case describes.

    Parameters
    ----------
    type : {"sinusoid", "measured", "spectrum", "wheel-flat", "rail-joint", "dent", "corrugation", "out-of-round"}
        Kind of source, and with it the other keys: those of the case file, a file as its resolved path.
    dx : float
        Grid spacing, m.
    wheel_radius : float or None
        Rolling radius, m; needed by sources on the wheel.
    view : ContactView
        How the contact model looks at large shapes.
    **keys
        Keys of the entry; a key that is None counts as left out.

    Returns
    -------
    source : Source
        Not yet realised if it is random.
    notes : list of str
        What was done and left out, for the user.

    Raises
    ------
    ParameterError
        Unknown type or key, missing key, or a value that is not allowed.
    DataFileError
        A file can't be read or used.
    """
    makers: dict[str, Callable[..., tuple[Source, list[str]]]] = {
        "sinusoid": _sinusoid,
        "measured": _measured,
        "spectrum": _spectrum,
        "wheel-flat": prepare_wheel_flat,
        "rail-joint": prepare_rail_joint,
        "dent": prepare_dent,
        "corrugation": prepare_corrugation,
        "out-of-round": prepare_out_of_round,
    }
    if type not in makers:
        raise ParameterError("type", type, f"allowed: {', '.join(makers)}")
    given = {key: value for key, value in keys.items() if value is not None}
    maker = makers[type]
    try:
        inspect.signature(maker).bind(dx=dx, wheel_radius=wheel_radius, view=view, **given)
    except TypeError as error:
        raise ParameterError("excitation", sorted(given), f"keys of type {type!r}: {error}") from None
    return maker(dx=dx, wheel_radius=wheel_radius, view=view, **given)


def _sinusoid(
    *,
    dx: float,
    wheel_radius: float | None,  # noqa: ARG001
    view: ContactView,  # noqa: ARG001
    amplitude: float,
    wavelength: float,
) -> tuple[Source, list[str]]:
    if not np.isfinite(amplitude):
        raise ParameterError("amplitude", amplitude, "it must be finite")
    if not (np.isfinite(wavelength) and wavelength > 2.0 * dx):
        raise ParameterError("wavelength", wavelength, f"it must be longer than 2 dx = {2.0 * dx:g} m")
    return Sinusoid(amplitude=amplitude, wavelength=wavelength, dx=dx), []


def _measured(
    *,
    dx: float,
    wheel_radius: float | None,
    view: ContactView,  # noqa: ARG001
    file: str | Path,
    on: str,
    beyond_end: str = "stop",
    column: str | int | None = None,
    lateral: Sequence[float] | None = None,
) -> tuple[Source, list[str]]:
    if column is not None and lateral is not None:
        raise ParameterError(
            "lateral", list(lateral), f"column = {column!r} takes one line of the file; give one of them"
        )
    if lateral is not None or (column is None and names_positions(file)):
        return read_measured_lines(
            file, dx=dx, on=on, wheel_radius=wheel_radius, beyond_end=beyond_end, lateral=lateral
        )
    return read_measured_line(file, dx=dx, on=on, wheel_radius=wheel_radius, beyond_end=beyond_end, column=column)


def _spectrum(
    *,
    dx: float,
    wheel_radius: float | None,
    view: ContactView,  # noqa: ARG001
    on: str,
    seed: int,
    name: str | None = None,
    file: str | Path | None = None,
    length: float | None = None,
    lines: Sequence[float] | None = None,
    coherence: float | str | None = None,
) -> tuple[Source, list[str]]:
    if (name is None) == (file is None):
        raise ParameterError("name", name, "a spectrum needs either a name or a file, not both")
    if on not in ("wheel", "rail"):
        raise ParameterError("on", on, 'allowed: "wheel" or "rail"')
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
        raise ParameterError("seed", seed, "it must be a whole number, not negative")
    table = named_spectrum(name) if name is not None else read_spectrum(file)  # type: ignore[arg-type]
    notes = [] if name is None else [f"{table.name}: {table.source}"]
    if table.surface not in (None, on):
        notes.append(f"{table.name}: a spectrum of the {table.surface} is used on the {on}")
    length = _repeat_length(table, dx=dx, wheel_radius=wheel_radius, on=on, length=length, notes=notes)
    label = f"spectrum {table.name} on the {on}"
    recipe: SpectrumLine | CoherentSpectrum = SpectrumLine(
        wavelengths=table.wavelengths, levels=table.levels, length=length, seed=int(seed), dx=dx, on=on, name=label
    )
    try:
        plan = plan_harmonics(wavelengths=recipe.wavelengths, levels=recipe.levels, count=recipe.count, dx=dx)
    except ValueError:
        raise DataFileError(
            f"{label}: no band fits between 2 dx = {2.0 * dx:g} m and the repeat length of {length:g} m "
            f"(wavelengths {table.wavelengths.min():.4g} m to {table.wavelengths.max():.4g} m)"
        ) from None
    for mask, reason in (
        (plan.too_short, f"they reach below the wavelength 2 dx = {2.0 * dx:g} m"),
        (plan.without_harmonic, f"no whole fraction of the repeat length of {recipe.count * dx:.6g} m falls into them"),
    ):
        if np.any(mask):
            bands = ", ".join(f"{wavelength * 1e3:.4g}" for wavelength in table.wavelengths[mask])
            notes.append(f"{label}: bands left out (centre wavelength, mm): {bands}; {reason}")
    if lines is not None:
        recipe = _several_lines(recipe, lines, coherence, notes)
    elif coherence is not None:
        raise ParameterError("coherence", coherence, "it is that of several lines; give lines, their positions across")
    return recipe, notes


def _several_lines(
    recipe: SpectrumLine, lines: Sequence[float], coherence: float | str | None, notes: list[str]
) -> CoherentSpectrum:
    lateral = np.sort(np.asarray(lines, dtype=float))
    if len(lateral) < 2 or not np.all(np.diff(lateral) > 0.0):
        raise ParameterError("lines", list(lines), "at least two different positions across, m")
    if coherence is None or (isinstance(coherence, str) and coherence != "none"):
        raise ParameterError("coherence", coherence, 'a number c >= 0 of exp(-c k |dy|), or "none"')
    decay = math.inf if isinstance(coherence, str) else float(coherence)
    shown = ", ".join(f"{1e3 * y:g}" for y in lateral)
    notes.append(f"{recipe.name}: {len(lateral)} lines at y = {shown} mm, coherence gamma = exp(-{decay:g} k |dy|)")
    parts = {name: getattr(recipe, name) for name in ("wavelengths", "levels", "length", "seed", "dx", "on", "name")}
    return CoherentSpectrum(lateral=lateral, decay=decay, **parts)


def _repeat_length(
    table: SpectrumTable, *, dx: float, wheel_radius: float | None, on: str, length: float | None, notes: list[str]
) -> float:
    if on == "wheel":
        if length is not None:
            raise ParameterError("length", length, "on the wheel the roughness repeats every turn; leave length out")
        if wheel_radius is None or not wheel_radius > 0.0:
            raise ParameterError(
                "wheel_radius", wheel_radius, "a spectrum on the wheel needs the rolling radius, above 0 m"
            )
        turn = 2.0 * np.pi * wheel_radius
        count = round(turn / dx)
        notes.append(
            f"{table.name}: one turn of {turn:.6g} m is taken as {count} steps, "
            f"{(count * dx - turn) * 1e3:+.3g} mm a turn"
        )
        length = turn
    elif length is None:
        length = rail_repeat_length(table.wavelengths)
        notes.append(f"{table.name}: the line repeats every {length:.6g} m (no length given)")
    if not (np.isfinite(length) and 16.0 * dx <= length <= _MOST_SAMPLES * dx):
        raise ParameterError(
            "length", length, f"the repeat length must lie between {16.0 * dx:g} m and {_MOST_SAMPLES * dx:g} m"
        )
    return float(length)
