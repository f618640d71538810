"""Frequencies to expect in the contact force: passing, resonances, contact filter."""

from __future__ import annotations

import math

import numpy as np

from wheelrail.analysis.resonances import interaction_peaks, pinned_pinned_frequency
from wheelrail.case import Case
from wheelrail.contact.hertz import HertzContact
from wheelrail.interaction.tracks import TrackModel
from wheelrail.interaction.wheels import WheelModel
from wheelrail.track.discrete import DiscreteTrack
from wheelrail.wheel.rigid import RigidWheel

__all__ = ["explain_frequencies"]

_LOWEST, _HIGHEST = 20.0, 5000.0  # Hz


def explain_frequencies(
    case: Case, wheel: WheelModel | None, track: TrackModel | None, hertz: HertzContact
) -> list[str]:
    """Return the frequencies to expect in the contact force, Hz."""
    speed, highest = case.simulation.speed, min(_HIGHEST, 0.5 * case.simulation.speed / case.simulation.dx)
    lines = [f"wheel turning             {speed / (2.0 * math.pi * case.wheel.radius):.4g} Hz"]
    spacing = None if track is None else track.sleeper_spacing
    if spacing is not None:
        lines.append(f"sleeper passing v / L_s   {speed / spacing:.4g} Hz")
    if isinstance(track, DiscreteTrack):
        pinned = pinned_pinned_frequency(track)
        if pinned is not None:
            lines.append(f"pinned-pinned             {pinned:.4g} Hz (peak of the rail's receptance at midspan)")
    if wheel is not None and case.load.coupling == "load":
        mass = _vertical_mass(wheel)
        if mass > 0.0:
            alone = math.sqrt(hertz.stiffness / mass) / (2.0 * math.pi)
            lines.append(f"mass on the contact       {alone:.4g} Hz ({mass:g} kg on the contact stiffness, rail held)")
    if highest > 2.0 * _LOWEST and (wheel is not None or track is not None):
        places = [("", 0.0)] if spacing is None else [(" over a sleeper", 0.0), (" at midspan", 0.5 * spacing)]
        for name, x in places:
            peaks = interaction_peaks(wheel, track, contact_stiffness=hertz.stiffness, x=x, highest=highest)
            shown = ", ".join(f"{f:.0f}" for f in peaks) or "none"
            lines.append(
                f"wheel-track resonances    {shown} Hz{name} (linearised; peaks of contact force per roughness up to "
                f"{highest:.4g} Hz)"
            )
    filtered = speed / (2.0 * hertz.semi_axis_x)
    lines.append(f"contact filter            from about {filtered:.4g} Hz (wavelength = contact length)")
    return lines


def _vertical_mass(wheel: WheelModel) -> float:
    """Mass that moves vertically as a rigid body, kg; 0 if there is none."""
    if isinstance(wheel, RigidWheel):
        return float(np.trace(wheel.mass_matrix))
    return sum(mode.mass for mode in wheel.rigid if mode.name == "vertical")
