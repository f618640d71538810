"""Flexible wheels and waveguide rails: modes and waves, stiffness, memory, and how they are held."""

from __future__ import annotations

from typing import Any

import numpy as np

from wheelrail.case import Case
from wheelrail.greens.moving import MovingGreens
from wheelrail.greens.ordinary import HIGHEST
from wheelrail.greens.waveguide import ENERGY_TOLERANCE, HORIZON
from wheelrail.interaction.wheels import MeasuredWheel, wheel_responses
from wheelrail.track.waveguide import WaveguideTrack
from wheelrail.wheel.modes import FlexibleWheel

__all__ = ["explain_flexible_wheel", "explain_waveguide"]

_MUCH_LOST = 0.05  # of the wheel's static compliance
_LONG_MEMORY = 5000  # samples of a wheel, beyond which its sum costs more than the rest of the step


def explain_flexible_wheel(case: Case, wheel: FlexibleWheel | MeasuredWheel, warnings: list[str]) -> list[str]:
    """Return the lines on a flexible wheel; add to ``warnings`` what doesn't suit it."""
    given: Any = case.wheel
    dt = case.simulation.dx / case.simulation.speed
    lines = _measured(wheel, given) if isinstance(wheel, MeasuredWheel) else _modal(wheel, given, dt)
    lines += wheel.notes
    lines.insert(1, f"rolling radius            {given.radius:g} m")
    lines += _discretised(case, wheel, dt, warnings)
    if given.memory is not None:
        samples = int(given.memory / dt * (1.0 + 1e-9))
        lines.append(f"memory                    {given.memory:g} s = {samples} samples, summed anew in every step")
        if samples > _LONG_MEMORY:
            warnings.append(
                f"the wheel's memory of {given.memory:g} s is a sum over {samples} samples in every step; without "
                "wheel.memory the modes are recursions, exact and far cheaper"
            )
    rigid = ", ".join(f"{mode.name} {mode.mass:g} {_unit(mode.name)}, {mode.frequency:.3g} Hz" for mode in wheel.rigid)
    lines.append(f"rigid-body motions        {rigid or 'none'}; none along the rail")
    if case.contact.tangential == "none":
        lines.append("vertical direction only: motion along and across the rail is left out (contact.tangential)")
    if case.load.coupling == "displacement":
        lines.append(
            "coupling by displacement: the vehicle model owns the rigid wheel and its suspension; the wheel is held "
            "where its modes are"
        )
    elif not wheel.rigid and not isinstance(wheel, MeasuredWheel):
        warnings.append("the wheel has no rigid-body motion (wheel.mass): it stands as if held at its hub")
    return lines


def _unit(name: str) -> str:
    return "kg m2" if name == "roll" else "kg"


def _modal(wheel: FlexibleWheel, given: Any, dt: float) -> list[str]:
    if given.receptances:
        source = f"fitted to {given.receptances}"
    else:
        source = f"of the section {given.section}" if given.section else f"from {given.modes}"
    kind = "exact recursions of two states each, never cut off" if given.memory is None else "as samples"
    modes = [mode for mode in wheel.modes if not mode.residual]
    lines = [f"flexible: {len(modes)} modes {source}, {kind}"]
    if given.contact_position is not None:
        lines.append(
            f"contact                   {1e3 * given.contact_position:+g} mm from the tread centre (+ field side)"
        )
    if not modes:
        return lines
    frequency = np.array([mode.frequency for mode in modes])
    ratio = np.array([mode.damping_ratio for mode in modes])
    single = [mode for mode in modes if not mode.name.endswith("*")]
    lines += [
        f"modes                     {frequency.min():.4g} Hz to {frequency.max():.4g} Hz, damping ratios "
        f"{ratio.min():.2g} to {ratio.max():.2g}",
        "by name (Hz)              " + ", ".join(f"({mode.name}) {mode.frequency:.0f}" for mode in single),
    ]
    if given.remove_modes:
        lines.append(f"removed                   {', '.join(f'({name})' for name in given.remove_modes)}")
    static = np.diag(wheel.held().static_compliance())
    shown = ", ".join(
        f"{1e-6 / value:.4g} MN/m {name}"
        for value, name in zip(static, ("along", "across", "vertical"), strict=True)
        if value > 0.0
    )
    beyond = "with" if len(modes) < len(wheel.modes) else "without"
    lines.append(f"static stiffness, held    {shown} ({beyond} what lies above {frequency.max():.4g} Hz)")
    highest = HIGHEST * 0.5 / dt
    above = int(np.count_nonzero(frequency > highest))
    if above:
        lines.append(
            f"{above} of the modes lie above {highest:.0f} Hz, {HIGHEST:g} of half the sampling frequency: they yield, "
            "but don't ring"
        )
    return lines


def _measured(wheel: MeasuredWheel, given: Any) -> list[str]:
    lines = wheel.measured
    pairs = [a + b for i, a in enumerate("xyz") for j, b in enumerate("xyz") if lines.given[i, j] and i <= j]
    return [
        f"flexible: receptances from {given.receptances}, as Green's functions of finite length",
        f"receptances               {len(lines.frequency)} lines, {lines.frequency[0]:g} Hz to "
        f"{lines.frequency[-1]:g} Hz; pairs {', '.join(pairs)}, the others are 0",
        f"below the first line      {wheel.low_frequency}",
    ]


def _discretised(case: Case, wheel: FlexibleWheel | MeasuredWheel, dt: float, warnings: list[str]) -> list[str]:
    """Return the lines on the Green's functions; add to ``warnings`` what was found on the way to them."""
    combined = case.contact.tangential != "none"
    _, held, report = wheel_responses(case, wheel, dt=dt, directions=3 if combined else 1)
    if held is None:
        return []
    facts = next(iter(report.values()))  # of the wheel on its suspension
    # What the file says itself is told already.
    warnings += [f"wheel.receptances: {note}" for note in facts["notes"][len(wheel.notes) :]]
    shares = dict(
        zip(
            ("along", "across", "vertical") if combined else ("vertical",),
            facts.get("lost_compliance", ()),
            strict=False,
        )
    )
    if max(shares.values(), default=0.0) > _MUCH_LOST:
        shown = ", ".join(f"{100.0 * share:.2g} % {name}" for name, share in shares.items())
        warnings.append(
            f'simulation.first_sample = "zero" leaves out {shown} of the static compliance of the wheel without its '
            "rigid-body motions: that of its first samples"
        )
    if "samples" not in facts or case.wheel.memory is not None:  # type: ignore[union-attr]
        return []
    return [f"Green's functions         {facts['samples']} samples = {facts['samples'] * dt:.4g} s"]


def explain_waveguide(case: Case, track: WaveguideTrack, greens: MovingGreens | None) -> list[str]:
    """Return the lines on a waveguide track."""
    given: Any = case.track
    speed, dx = case.simulation.speed, case.simulation.dx
    dt = dx / speed
    # Waves that begin at a frequency, by that frequency.
    found = track.reduced.waves(0.0, track.max_frequency).omega / (2.0 * np.pi)
    cut_on = [f"{value:.0f}" for value in found if value > 1.0]
    elements = track.matrices.rail_elements
    spacing = track.sleeper_spacing
    held = "a continuous elastic layer" if spacing is None else f"pads, sleepers and ballast every {spacing:g} m"
    lines = [
        f"waveguide: rail {given.section} on {held}",
        f"contact                   {1e3 * given.contact_position:+g} mm from the rail's centre (+ field side)",
        f"section                   {elements} quadratic elements, {track.matrices.size} degrees of freedom",
        f"waves                     {len(found)} up to {track.max_frequency:g} Hz, cut on at {', '.join(cut_on)} Hz"
        + ("" if spacing is None else " (of the free rail)"),
    ]
    for name, x in [("", 0.0)] if spacing is None else [(" over a sleeper", 0.0), (" at midspan", 0.5 * spacing)]:
        lateral, vertical = 1e-6 / np.diag(track.static_compliance(x))[1:]
        lines.append(f"static stiffness          {vertical:.1f} MN/m vertical, {lateral:.1f} MN/m lateral{name}")
    positions = 1 if spacing is None else round(spacing / dx)
    count = positions * (1 if case.contact.tangential == "none" else 9)
    if greens is None:
        samples, upper = int((given.memory or HORIZON) / dt), "" if given.memory else "at most "
        lines.append(
            f"moving Green's functions  {count} of {upper}{samples} samples = {samples * dt:.4g} s, {upper}"
            f"{8e-6 * count * samples:.3g} MB: an estimate, they are not in the cache"
        )
        if given.memory is None:
            lines.append(f"they will end where at most {100 * ENERGY_TOLERANCE:g} % of the energy is left")
    else:
        samples = greens.values.shape[-1]
        lines.append(
            f"moving Green's functions  {count} of {samples} samples = {samples * dt:.4g} s, "
            f"{8e-6 * count * samples:.3g} MB (in the cache)"
        )
        if given.memory is None:
            lines.append(
                f"neglected by their end    {100.0 * float(greens.neglected_energy.max()):.2g} % of the energy up to "
                f"{greens.horizon:.3g} s"
            )
    if given.memory is not None:
        lines.append("their length is set by track.memory; what lies beyond it is neglected")
    return lines
