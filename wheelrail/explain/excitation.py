"""The roughness of a case: its sources, and whether grid and run suit them."""

from __future__ import annotations

import math
from collections.abc import Iterator

from wheelrail.case import Case
from wheelrail.case.excitations import Measured, Spectrum
from wheelrail.contact.hertz import HertzContact
from wheelrail.excitation.prepare import prepare_source
from wheelrail.excitation.sources import CoherentSpectrum, Irregularity, SurfaceLines
from wheelrail.interaction.contacts import geometry_of, view_of

__all__ = ["explain_excitation"]

# Grid steps per wavelength; below, a piecewise linear wave has lost more than 5 % of its amplitude.
_FEWEST_PER_WAVE = 8


def explain_excitation(case: Case, hertz: HertzContact, warnings: list[str]) -> list[str]:
    """Return the lines on roughness; add to ``warnings`` what the grid or the run does not suit."""
    dx, speed = case.simulation.dx, case.simulation.speed
    lines = []
    for number, entry in enumerate(case.excitation, 1):
        keys = entry.model_dump(exclude_none=True)
        if "file" in keys:
            keys["file"] = case.data_path(keys["file"])
        source, notes = prepare_source(dx=dx, wheel_radius=case.wheel.radius, view=view_of(case), **keys)
        if entry.type == "sinusoid":
            steps = entry.wavelength / dx
            lines.append(
                f"{number}. sinusoid: {entry.amplitude * 1e6:g} um, wavelength {entry.wavelength * 1e3:g} mm, "
                f"{speed / entry.wavelength:.4g} Hz, {steps:.3g} dx"
            )
            if steps < _FEWEST_PER_WAVE:
                warnings.append(
                    f"excitation #{number}: only {steps:.3g} dx per wavelength; at least {_FEWEST_PER_WAVE} are advised"
                )
        elif isinstance(entry, Measured | Spectrum):
            name = getattr(entry, "name", None) or getattr(entry, "file", None)
            lines.append(f"{number}. {entry.type}: {name}, on the {entry.on}")
        else:
            lines.append(f"{number}. {entry.type}")
        if source.across and case.contact.normal != "half-space":
            warnings.append(
                f'excitation #{number}: it differs across the contact, but contact.normal = "{case.contact.normal}" '
                'looks at the line at the contact point alone; "half-space" sees its width'
            )
        elif isinstance(source, SurfaceLines | CoherentSpectrum):
            warnings += [f"excitation #{number}: {line}" for line in _beyond_the_lines(case, source, hertz)]
        if isinstance(source, Irregularity):
            warnings += [f"excitation #{number}: {line}" for line in _out_of_reach(case, source)]
        covered = source.covered()
        if covered is not None:
            first, last = covered
            begin = case.simulation.start_position
            end = begin + case.simulation.duration * speed
            lines.append(f"  known from x = {first:g} m to {last:g} m")
            half = 0.0 if case.contact.length is None else 0.5 * case.contact.length
            if first > begin - half + dx or last < end + half - dx:
                warnings.append(
                    f"excitation #{number}: covers {first:g} m to {last:g} m, the run needs {begin - half:g} m to "
                    f"{end + half:g} m; it will stop there"
                )
        for note in notes:
            lines.append(f"  {note}")
            # Shorter waves than the contact is long are filtered anyway, unless the contact is a point.
            filtered = case.contact.normal == "winkler" or case.contact.prefilter != "none"
            if "2 dx" in note and not (filtered and 2.0 * dx < hertz.semi_axis_x):
                warnings.append(f"excitation #{number}: {note}")
    bays = "; only the track's bays excite" if case.track.model != "rigid" else ""
    return lines or [f"none: smooth wheel and rail{bays}"]


def _out_of_reach(case: Case, source: Irregularity) -> Iterator[str]:
    """Say that a flat, joint or dent does not come under the wheel in the run."""
    begin = case.simulation.start_position
    end = begin + case.simulation.duration * case.simulation.speed
    origin = source.origin
    if source.period is not None:  # the first one after the beginning
        origin += math.ceil((begin - source.origin - source.positions[-1]) / source.period) * source.period
    if origin + source.positions[-1] < begin or origin + source.positions[0] > end:
        yield f"the {source.name} does not come under the wheel, which rolls from {begin:g} m to {end:g} m"


def _beyond_the_lines(case: Case, source: SurfaceLines | CoherentSpectrum, hertz: HertzContact) -> Iterator[str]:
    """Say that the contact is wider than what is known of the roughness."""
    place = geometry_of(case).place(case.contact.lateral_shift)
    middle = place.y_wheel if source.on == "wheel" else place.y_rail
    first, last = source.lateral_range
    low, high = middle - hertz.semi_axis_y, middle + hertz.semi_axis_y
    if low < first or high > last:
        yield (
            f"its lines reach from {1e3 * first:+.3g} to {1e3 * last:+.3g} mm, the contact under the preload from "
            f"{1e3 * low:+.3g} to {1e3 * high:+.3g} mm; beyond the outermost lines their heights continue"
        )
