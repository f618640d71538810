"""Rigid wheels and beam tracks: their models, degrees of freedom, stiffness and Green's functions."""

from __future__ import annotations

from typing import Any

import numpy as np

from wheelrail.case import Case
from wheelrail.explain.flexible import explain_flexible_wheel, explain_waveguide
from wheelrail.greens.moving import ENERGY_TOLERANCE, MovingGreens, horizon_of
from wheelrail.interaction.build import memory_of
from wheelrail.interaction.tracks import TrackModel
from wheelrail.interaction.wheels import WheelModel
from wheelrail.track.discrete import DiscreteTrack
from wheelrail.wheel.rigid import RigidWheel

__all__ = ["explain_track", "explain_wheel"]

_DECAYED = 0.01  # of the peak; Green's functions that end above have been cut too early


def explain_wheel(case: Case, wheel: WheelModel | None, warnings: list[str]) -> list[str]:
    """Return the lines on the wheel; add to ``warnings`` what doesn't suit it."""
    if wheel is not None and not isinstance(wheel, RigidWheel):
        return explain_flexible_wheel(case, wheel, warnings)
    given: Any = case.wheel
    lines = [f"rolling radius            {given.radius:g} m"]
    if given.model == "rigid" or wheel is None:
        return ["rigid: no dynamics of its own (quasi-static)", *lines]
    freedom = len(wheel.mass_matrix)
    sprung = (
        f"on the primary suspension {given.suspension_stiffness * 1e-6:g} MN/m, "
        f"{given.suspension_damping * 1e-3:g} kN s/m"
        if given.suspension_stiffness or given.suspension_damping
        else "without suspension"
    )
    count = "1 degree" if freedom == 1 else f"{freedom} degrees"
    lines = [
        f"{given.model}: {count} of freedom; Green's function as a recursion of {2 * freedom} states, never cut off",
        *lines,
        f"mass                      {given.mass:g} kg {sprung}",
    ]
    if given.model == "rigid-2dof":
        lines.append(
            f"contact mass              {given.contact_mass:g} kg on {given.contact_stiffness * 1e-9:g} GN/m, "
            f"{given.contact_damping * 1e-3:g} kN s/m"
        )
    if case.load.coupling == "displacement":
        rest = "only the contact mass remains here" if freedom > 1 else "none of it remains here"
        lines.append(f"coupling by displacement: the vehicle model owns the wheel's mass and suspension; {rest}")
    return lines


def explain_track(case: Case, track: TrackModel | None, greens: MovingGreens | None, warnings: list[str]) -> list[str]:
    """Return the lines on the track; add to ``warnings`` if its Green's functions end too early."""
    if track is None:
        return ["rigid: no dynamics of its own (quasi-static)"]
    if not isinstance(track, DiscreteTrack):
        return explain_waveguide(case, track, greens)
    speed, dx = case.simulation.speed, case.simulation.dx
    dt, spacing = dx / speed, track.sleeper_spacing
    over, midspan = (1e-6 / track.static_compliance(x, [x])[0] for x in (0.0, 0.5 * spacing))
    positions = round(spacing / dx)
    lines = [
        f"discrete: Rayleigh-Timoshenko rail on {track.bays - 1} supports, {track.bays} bays of {spacing:g} m = "
        f"{track.bays * spacing:g} m between clamped ends",
        f"degrees of freedom        {track.degrees_of_freedom} ({track.elements_per_bay} elements per bay)",
        f"static stiffness          {over:.1f} MN/m over a sleeper, {midspan:.1f} MN/m at midspan",
    ]
    set_memory = memory_of(case)
    if greens is not None:
        samples = greens.values.shape[1]
        energy = float(greens.neglected_energy.max())
        lines += [
            f"moving Green's functions  {positions} of {samples} samples = {samples * dt:.4g} s "
            f"= {samples * dx / spacing:.3g} bays, {_megabytes(positions, samples)} (in the cache)",
        ]
        if set_memory is None:
            lines.append(
                f"neglected by their end    {100.0 * energy:.2g} % of the energy up to {greens.horizon:.3g} s, "
                f"{100.0 * float(np.abs(greens.neglected_compliance).max()):.2g} % of the compliance"
            )
        last, peak = _late_and_peak(greens)
        if last > _DECAYED * peak:
            warnings.append(
                f"the track's memory of {samples * dt:.3g} s is shorter than its decay: its Green's functions end at "
                f"{100.0 * last / peak:.2g} % of their peak; raise or leave out track.memory"
            )
    else:
        samples = max(int((set_memory or horizon_of(track, speed)) / dt), 2)
        upper = "" if set_memory else "at most "
        lines.append(
            f"moving Green's functions  {positions} of {upper}{samples} samples = {samples * dt:.4g} s, "
            f"{upper}{_megabytes(positions, samples)}: an estimate, they are not in the cache"
        )
        if set_memory is None:
            lines.append(f"they will end where at most {100 * ENERGY_TOLERANCE:g} % of the energy is left")
    if set_memory is not None:
        lines.append("their length is set by track.memory; what lies beyond it is neglected")
    elif horizon_of(track, speed) < 0.1:
        warnings.append(
            f"the moving contact reaches the end of the modelled track after {horizon_of(track, speed):.2g} s; the "
            "track's response may be longer: raise track.bays"
        )
    return lines


def _megabytes(positions: int, samples: int) -> str:
    return f"{8e-6 * positions * samples:.3g} MB"


def _late_and_peak(greens: MovingGreens) -> tuple[float, float]:
    """Largest value in the last tenth of the functions, and of all; m/N."""
    tail = max(greens.values.shape[1] // 10, 1)
    return float(np.abs(greens.values[:, -tail:]).max()), float(np.abs(greens.values).max())
