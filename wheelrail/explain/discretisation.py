"""The grid along the rail, the time step, and what a step costs."""

from __future__ import annotations

import numpy as np

from wheelrail.case import Case
from wheelrail.contact.hertz import HertzContact
from wheelrail.greens.moving import MovingGreens, horizon_of
from wheelrail.greens.waveguide import HORIZON
from wheelrail.interaction.build import memory_of
from wheelrail.interaction.simulate import step_count
from wheelrail.interaction.tracks import TrackModel
from wheelrail.interaction.wheels import MeasuredWheel, WheelModel
from wheelrail.track.discrete import DiscreteTrack
from wheelrail.wheel.rigid import RigidWheel

__all__ = ["explain_cost", "explain_grid"]

_FEWEST_NODES = 8  # across the nominal contact; below, its edges move by a large share of it from node to node
_ITERATIONS = 4  # evaluations of the contact law that a step usually takes


def explain_grid(case: Case, hertz: HertzContact, warnings: list[str]) -> list[str]:
    """Return the lines on grid and time; add to ``warnings`` if the grid is coarse for the contact."""
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
        f"{simulation.duration * speed:.4g} m from x = {simulation.start_position:g} m"
        + ("" if getattr(case.track, "sleeper_spacing", None) is None else " (a sleeper is at 0)"),
    ]


def explain_cost(
    case: Case, hertz: HertzContact, wheel: WheelModel | None, track: TrackModel | None, greens: MovingGreens | None
) -> list[str]:
    """Return the lines on arithmetic and memory traffic per step."""
    simulation = case.simulation
    dt = simulation.dx / simulation.speed
    operations, moved = 0.0, 0.0
    estimated = ""
    combined = case.contact.tangential != "none"
    if track is not None:
        pairs = 9 if combined and not isinstance(track, DiscreteTrack) else 1
        if greens is not None:
            samples = greens.values.shape[-1]
        else:
            longest = horizon_of(track, simulation.speed) if isinstance(track, DiscreteTrack) else HORIZON
            samples = max(int((memory_of(case) or longest) / dt), 2)
            estimated = "" if memory_of(case) else "at most "
        # Green's functions times the force, added to the future: reads both, writes a product and the sum.
        operations += 2.0 * pairs * samples
        moved += 8.0 * (pairs + 4.0 * pairs**0.5) * samples
    if isinstance(wheel, RigidWheel):
        states = 2 * len(wheel.mass_matrix)
        operations += 2.0 * states * (states + 2)
    elif wheel is not None:
        directions = 3 if combined else 1
        modes = len(wheel.rigid) if isinstance(wheel, MeasuredWheel) else len(wheel.all_modes)
        memory = case.wheel.memory  # type: ignore[union-attr]
        if memory is None and isinstance(wheel, MeasuredWheel):
            memory, estimated = 0.5 / np.diff(wheel.measured.frequency).min(), "at most "
        samples = int((memory or 0.0) / dt)
        operations += 2.0 * modes * (4 + 4 * directions) + 2.0 * directions**2 * samples
        moved += 8.0 * (2.0 * modes * (4 + 2 * directions) + directions**2 * samples)
    nodes = 1 if case.contact.length is None else round(case.contact.length / simulation.dx)
    if case.contact.normal == "half-space":
        # Two dense solves of k and two of up to 2 k unknowns, k the elements in contact.
        k = hertz.area / (simulation.dx * case.contact.dy)
        sizes = [k, k] if case.contact.tangential != "transient" else [k, k, 2.0 * k, 2.0 * k]
        operations += sum(2.0 / 3.0 * size**3 for size in sizes)
        moved += sum(24.0 * size**2 for size in sizes)
    operations += (20.0 * nodes * _ITERATIONS) if case.contact.normal == "winkler" else 2.0 * nodes + 10.0 * _ITERATIONS
    moved += 8.0 * nodes * (len(case.excitation) + 1)
    per_second = 1.0 / dt
    return [
        f"per step                  {estimated}{operations:.3g} floating-point operations, {estimated}"
        f"{moved / 1e3:.3g} kB of memory traffic",
        f"per simulated second      {per_second:.4g} steps, {estimated}{operations * per_second / 1e9:.2g} Gflop; the "
        "interpreter's own time comes on top",
    ]
