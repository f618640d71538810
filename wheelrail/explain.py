"""The model of a case in words and numbers, without computing its Green's functions."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable

import numpy as np

from wheelrail.analysis.resonances import interaction_peaks, pinned_pinned_frequency
from wheelrail.case import Case
from wheelrail.contact.hertz import HertzContact
from wheelrail.excitation.prepare import prepare_source
from wheelrail.greens.cache import find_cached
from wheelrail.greens.moving import ENERGY_TOLERANCE, MovingGreens, horizon_of
from wheelrail.interaction.build import hertz_of, memory_of, track_of, wheel_of
from wheelrail.interaction.simulate import step_count
from wheelrail.track.discrete import DiscreteTrack
from wheelrail.wheel.rigid import RigidWheel

__all__ = ["explain"]

_WIDTH = 110
_LABEL = 26  # width of the names of numbers
_FEWEST_NODES = 8  # across the nominal contact; below, its edges move by a large share of it from node to node
_FEWEST_PER_WAVE = (
    8  # grid steps per wavelength; below, a piecewise linear wave has lost more than 5 % of its amplitude
)
_DECAYED = 0.01  # of the peak; Green's functions that end above have been cut too early
_SMALLEST_RESERVE = 2.0  # of the preload, in the potential contact area
_LOWEST, _HIGHEST = 20.0, 5000.0  # Hz
_ITERATIONS = 4  # evaluations of the contact law that a step usually takes


def explain(case: Case) -> str:
    """Describe what a case computes.

    The moving Green's functions are not computed; what depends on them is taken from the cache, or estimated and then
    said to be an estimate.

    Parameters
    ----------
    case : Case

    Returns
    -------
    str
        Several paragraphs of plain text.

    Raises
    ------
    WheelrailError
        If a data file of the excitation can't be used.
    """
    wheel, track, hertz = wheel_of(case), track_of(case), hertz_of(case)
    # What of the wheel is left here where the vehicle model moves it.
    moving = wheel.held() if wheel is not None and case.load.coupling == "displacement" else wheel
    greens = None
    if track is not None:
        speed, dx = case.simulation.speed, case.simulation.dx
        greens = find_cached(track, speed=speed, dx=dx, memory=memory_of(case))
    warnings: list[str] = []
    sections = [
        ("Equations", _equations(case, moving, track)),
        ("Grid and time", _grid(case, hertz, warnings)),
        ("Wheel", _wheel(case, wheel)),
        ("Track", _track(case, track, greens, warnings)),
        ("Contact", _contact(case, hertz, warnings)),
        ("Frequencies", _frequencies(case, moving, track, hertz)),
        ("Excitation", _excitation(case, hertz, warnings)),
        ("Cost", _cost(case, moving, track, greens)),
        ("Without effect", _without_effect(case)),
        ("Warnings", [f"! {line}" for line in warnings] or ["none"]),
        ("Sources", _sources(case, track)),
    ]
    title = case.title or "untitled case"
    lines = [title, "=" * len(title)]
    for heading, items in sections:
        if items:
            lines += ["", heading, "-" * len(heading), *_wrapped(items)]
    return "\n".join(lines)


def _wrapped(items: Iterable[str]) -> list[str]:
    lines: list[str] = []
    for item in items:
        if item.startswith("    "):  # an equation, to be left alone
            lines.append(item)
        else:
            lines += textwrap.wrap(
                item, _WIDTH, subsequent_indent=" " * (_LABEL if "  " in item.strip() else 2), break_on_hyphens=False
            )
    return lines


def _equations(case: Case, wheel: RigidWheel | None, track: DiscreteTrack | None) -> list[str]:
    coupled = case.load.coupling == "load"
    lines = [
        "In each step a, with F the contact force on the rail (compression > 0), P the load on the wheel, d the "
        "approach, r the combined roughness (asperities on wheel or rail > 0):"
    ]
    if coupled and wheel is None:
        lines += [_equation("F(a) = P", "the wheel has no dynamics")]
    elif coupled:
        lines += [_equation("d(a) = d0 + xi_W(a) - xi_R(a)", "d0 from equilibrium at the start")]
    else:
        own = " + xi_W(a)" if wheel is not None else ""
        lines += [_equation(f"d(a) = wheel_z(a){own} - xi_R(a)", "the vehicle moves the wheel")]
    if wheel is not None:
        pushed = "[F - P]" if coupled else "F"
        lines += [_equation(f"xi_W(a) = - sum_n g_W(n) {pushed}(a - n + 1)", "Pieringer 2011, eqs. 3.5 to 3.8")]
    if track is not None:
        lines += [_equation("xi_R(a) = sum_n g_R^{v,(a-n)dx}(n) F(a - n + 1)", "Pieringer 2011, eqs. 3.11 to 3.17")]
    else:
        lines += [_equation("xi_R(a) = 0", "rigid track")]
    if case.contact.normal == "winkler":
        lines += [_equation("F = k' integral max(0, d + r(x) - x^2 / (2 R')) dx", "Pieringer 2011, eqs. 3.23 to 3.30")]
    else:
        filters = {
            "none": "r at the nominal contact point",
            "average": "r averaged over the nominal contact length",
            "winkler": "r as a Winkler bedding under the preload feels it",
        }
        lines += [
            _equation("F = C_H max(0, d + r)^1.5", "Pieringer 2011, eq. 2.19"),
            f"    with {filters[case.contact.prefilter]}",
        ]
    return [*lines, "Vertical direction only. The equation for d(a) is solved by Newton's method with a safeguard."]


def _equation(text: str, remark: str) -> str:
    return f"    {text:<56}  {remark}"


def _grid(case: Case, hertz: HertzContact, warnings: list[str]) -> list[str]:
    simulation = case.simulation
    dx, speed = simulation.dx, simulation.speed
    dt = dx / speed
    steps = step_count(duration=simulation.duration, dt=dt)
    nodes = 2.0 * hertz.semi_axis_x / dx
    if nodes < _FEWEST_NODES:
        allowed = 2.0 * hertz.semi_axis_x / _FEWEST_NODES
        warnings.append(
            f"the nominal contact is only {nodes:.1f} dx long; at least {_FEWEST_NODES} are advised "
            f"(dx <= {allowed * 1e3:.2g} mm)"
        )
    return [
        f"speed                     {speed:g} m/s ({speed * 3.6:.4g} km/h)",
        f"grid spacing dx           {dx * 1e3:g} mm",
        f"time step dt = dx / v     {dt * 1e6:.5g} us",
        f"sampling frequency        {1.0 / dt:.6g} Hz, Nyquist {0.5 / dt:.6g} Hz",
        f"shortest wavelength       {2e3 * dx:g} mm (2 dx), at this speed {0.5 / dt:.6g} Hz",
        f"duration                  {simulation.duration:g} s = {steps} steps, "
        f"{simulation.duration * speed:.4g} m from x = {simulation.start_position:g} m (a sleeper is at 0)",
    ]


def _wheel(case: Case, wheel: RigidWheel | None) -> list[str]:
    given = case.wheel
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


def _track(case: Case, track: DiscreteTrack | None, greens: MovingGreens | None, warnings: list[str]) -> list[str]:
    if track is None:
        return ["rigid: no dynamics of its own (quasi-static)"]
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


def _contact(case: Case, hertz: HertzContact, warnings: list[str]) -> list[str]:
    contact = case.contact
    lines = [
        f"{contact.normal}; preload {hertz.load * 1e-3:g} kN, coupling by {case.load.coupling}",
        f"Hertz ellipse             {hertz.semi_axis_x * 1e3:.2f} x {hertz.semi_axis_y * 1e3:.2f} mm (semi-axes along "
        f"and across the rail), {2.0 * hertz.semi_axis_x / case.simulation.dx:.1f} dx long",
        f"approach                  {hertz.approach * 1e6:.1f} um",
        f"largest pressure          {hertz.pressure_max * 1e-9:.3f} GPa",
        f"stiffness at the preload  {hertz.stiffness * 1e-9:.3f} GN/m",
        f"C_H                       {hertz.constant * 1e-9:.4g} GN/m^1.5",
    ]
    if contact.normal == "winkler":
        bedding = 0.75 * hertz.load / (hertz.semi_axis_x * hertz.approach)
        radius = hertz.semi_axis_x**2 / (2.0 * hertz.approach)
        lines.append(
            f"bedding                   k' = {bedding * 1e-9:.4g} GN/m2, R' = {radius:.4g} m: load, length and "
            "approach of Hertz for every load"
        )
    if contact.length is not None and (contact.normal == "winkler" or contact.prefilter != "none"):
        half = 0.5 * (contact.length - case.simulation.dx)
        grows = (half / hertz.semi_axis_x) ** 3
        lines.append(
            f"potential contact area    {contact.length * 1e3:g} mm long; a smooth contact fits in up to "
            f"{grows:.2g} times the preload"
        )
        if contact.normal == "winkler" and grows < _SMALLEST_RESERVE:
            warnings.append(
                f"the potential contact area holds only {grows:.2g} times the preload; the run stops beyond that "
                "(contact.length)"
            )
    if contact.normal == "hertz" and contact.prefilter == "none" and case.excitation:
        warnings.append(
            "the Hertz spring feels the roughness at one point: wavelengths below about "
            f'{4e3 * hertz.semi_axis_x:.2g} mm act too strongly; contact.prefilter or normal = "winkler" filters them'
        )
    return lines


def _frequencies(case: Case, wheel: RigidWheel | None, track: DiscreteTrack | None, hertz: HertzContact) -> list[str]:
    speed, highest = case.simulation.speed, min(_HIGHEST, 0.5 * case.simulation.speed / case.simulation.dx)
    lines = [f"wheel turning             {speed / (2.0 * math.pi * case.wheel.radius):.4g} Hz"]
    if track is not None:
        lines.append(f"sleeper passing v / L_s   {speed / track.sleeper_spacing:.4g} Hz")
        pinned = pinned_pinned_frequency(track)
        if pinned is not None:
            lines.append(f"pinned-pinned             {pinned:.4g} Hz (peak of the rail's receptance at midspan)")
    if wheel is not None and case.load.coupling == "load":
        mass = float(np.trace(wheel.mass_matrix))
        alone = math.sqrt(hertz.stiffness / mass) / (2.0 * math.pi)
        lines.append(f"mass on the contact       {alone:.4g} Hz ({mass:g} kg on the contact stiffness, rail held)")
    if highest > 2.0 * _LOWEST and (wheel is not None or track is not None):
        places = (
            [("", 0.0)] if track is None else [(" over a sleeper", 0.0), (" at midspan", 0.5 * track.sleeper_spacing)]
        )
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


def _excitation(case: Case, hertz: HertzContact, warnings: list[str]) -> list[str]:
    dx, speed = case.simulation.dx, case.simulation.speed
    lines = []
    for number, entry in enumerate(case.excitation, 1):
        keys = entry.model_dump(exclude_none=True)
        if "file" in keys:
            keys["file"] = case.data_path(keys["file"])
        source, notes = prepare_source(dx=dx, wheel_radius=case.wheel.radius, **keys)
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
        else:
            name = getattr(entry, "name", None) or getattr(entry, "file", None)
            lines.append(f"{number}. {entry.type}: {name}, on the {entry.on}")
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
    return lines or ["none: smooth wheel and rail; only the track's bays excite"]


def _cost(case: Case, wheel: RigidWheel | None, track: DiscreteTrack | None, greens: MovingGreens | None) -> list[str]:
    simulation = case.simulation
    dt = simulation.dx / simulation.speed
    operations, moved = 0.0, 0.0
    estimated = ""
    if track is not None:
        if greens is not None:
            samples = greens.values.shape[1]
        else:
            samples = max(int((memory_of(case) or horizon_of(track, simulation.speed)) / dt), 2)
            estimated = "" if memory_of(case) else "at most "
        # One Green's function times the force, added to the future: reads both, writes a product and the sum.
        operations += 2.0 * samples
        moved += 8.0 * 5.0 * samples
    if wheel is not None:
        states = 2 * len(wheel.mass_matrix)
        operations += 2.0 * states * (states + 2)
    nodes = 1 if case.contact.length is None else round(case.contact.length / simulation.dx)
    operations += (20.0 * nodes * _ITERATIONS) if case.contact.normal == "winkler" else 2.0 * nodes + 10.0 * _ITERATIONS
    moved += 8.0 * nodes * (len(case.excitation) + 1)
    per_second = 1.0 / dt
    return [
        f"per step                  {estimated}{operations:.3g} floating-point operations, {estimated}"
        f"{moved / 1e3:.3g} kB of memory traffic",
        f"per simulated second      {per_second:.4g} steps, {estimated}{operations * per_second / 1e9:.2g} Gflop; the "
        "interpreter's own time comes on top",
    ]


def _without_effect(case: Case) -> list[str]:
    lines = []
    if case.contact.tangential == "none":
        parts = [name for name in ("friction", "creepage") if getattr(case, name) is not None]
        if parts:
            lines.append(f"[{'], ['.join(parts)}]: there is no tangential contact model")
    lines += [
        f"contact.{key}: only used by a three-dimensional contact model"
        for key in ("dy", "width")
        if getattr(case.contact, key) is not None
    ]
    if case.contact.lateral_shift:
        lines.append("contact.lateral_shift: the contact geometry does not depend on it yet")
    if case.contact.normal == "hertz" and case.contact.prefilter == "none" and case.contact.length is not None:
        lines.append("contact.length: the Hertz spring without prefilter is a point")
    return lines


def _sources(case: Case, track: DiscreteTrack | None) -> list[str]:
    lines = [
        "Pieringer 2011, Time-domain modelling of high-frequency wheel/rail interaction, PhD thesis, Chalmers "
        "(equation numbers above)",
        "Johnson 1985, Contact mechanics, section 4.2 (Hertz contact)",
    ]
    if track is not None:
        lines.append(
            "Nordborg 2002, Wheel/rail noise generation due to nonlinear effects and parametric excitation, "
            "J. Acoust. Soc. Am. 111 (moving Green's functions)"
        )
    if case.contact.prefilter == "winkler":
        lines.append(
            "Ford and Thompson 2006, Simplified contact filters in wheel/rail noise prediction, J. Sound Vib. 293 "
            "(equivalent roughness)"
        )
    return lines
