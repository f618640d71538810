"""The roughness of a case: its sources, and whether grid and run suit them."""

from __future__ import annotations

from wheelrail.case import Case
from wheelrail.case.excitations import Measured, Spectrum
from wheelrail.contact.hertz import HertzContact
from wheelrail.excitation.prepare import prepare_source
from wheelrail.interaction.contacts import view_of

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
