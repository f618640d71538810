"""From the entries of a case for flats, joints, dents, corrugation and out-of-round wheels to sources."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from wheelrail.errors import ParameterError
from wheelrail.excitation.corrugation import Corrugation
from wheelrail.excitation.dent import dent
from wheelrail.excitation.irregularity import Irregularity
from wheelrail.excitation.measured_flat import measured_flat
from wheelrail.excitation.out_of_round import OutOfRound
from wheelrail.excitation.rail_joint import rail_joint
from wheelrail.excitation.view import ContactView, rigid_path
from wheelrail.excitation.wheel_flat import chord_flat, rounded_flat

__all__ = [
    "prepare_corrugation",
    "prepare_dent",
    "prepare_out_of_round",
    "prepare_rail_joint",
    "prepare_wheel_flat",
]

_FLAT_SHARE = 0.25  # of the circumference: a longer flat is a mistake
_RAMP_WAVES = 2.0


def _surface(
    positions: np.ndarray,
    heights: np.ndarray,
    *,
    lateral: np.ndarray,
    on: str,
    origin: float,
    period: float | None,
    name: str,
    key: str,
    dx: float,
    view: ContactView,
) -> Irregularity:
    """Source of a shape, as the contact model looks at it; ``heights`` of shape (lines, n)."""
    if period is not None and positions[-1] - positions[0] > period:
        reach = float(positions[-1] - positions[0])
        raise ParameterError(
            key, reach, f"the {name} takes {reach:.4g} m, more than the {period:.4g} m until it comes again"
        )
    if view.trajectory:
        paths = [rigid_path(positions, line, radius=view.radius) for line in heights]
        if period is not None and any(at[-1] - at[0] > period for at, _ in paths):
            paths = [_one_period(positions, line, period, view.radius) for line in heights]
        # Each line has a path of its own length; beyond its ends a path is level.
        positions = np.unique(np.concatenate([at for at, _ in paths]))
        heights = np.array([np.interp(positions, at, path) for at, path in paths])
        name = f"{name}, path of a rigid wheel"
    return Irregularity(
        positions=positions,
        heights=heights,
        lateral=lateral,
        on=on,
        origin=origin,
        period=period,
        stretch=view.stretch,
        dx=dx,
        name=name,
    )


def _one_period(
    positions: np.ndarray, heights: np.ndarray, period: float, radius: float
) -> tuple[np.ndarray, np.ndarray]:
    """Path over one of many shapes that are so close to each other that their paths overlap."""
    inside = slice(0, -1) if positions[-1] - positions[0] >= period else slice(None)
    copies = [positions[inside] + shift * period for shift in (-1, 0, 1)]
    at, path = rigid_path(np.concatenate(copies), np.tile(heights[inside], 3), radius=radius)
    half = 0.5 * period
    kept = np.concatenate([[-half], at[np.abs(at) < half], [half]])
    cut = np.interp(kept, at, path)
    cut[-1] = cut[0]
    return kept, cut


def _turn(wheel_radius: float | None, what: str) -> float:
    if wheel_radius is None or not wheel_radius > 0.0:
        raise ParameterError("wheel_radius", wheel_radius, f"{what} needs the rolling radius, above 0 m")
    return 2.0 * math.pi * wheel_radius


def _passing(origin: float, what: str, period: float | None) -> str:
    again = "" if period is None else f", and every {period:.6g} m before and after"
    return f"{what}: its middle passes the contact point at x = {origin:.6g} m{again}"


def prepare_wheel_flat(
    *,
    dx: float,
    wheel_radius: float | None,
    view: ContactView,
    shape: str,
    angle: float,
    depth: float | None = None,
    length: float | None = None,
    file: str | Path | None = None,
    lateral: Sequence[float] | None = None,
) -> tuple[Irregularity, list[str]]:
    """Flat on the wheel; ``angle`` in rad, by which the wheel has to turn from x = 0 until its middle is below."""
    turn = _turn(wheel_radius, "a wheel flat")
    radius = view.radius
    across = np.zeros(1)
    if shape == "new":
        positions, heights, notes = chord_flat(depth=depth, length=length, radius=radius)
    elif shape == "rounded":
        if depth is None or length is None:
            missing = "depth" if depth is None else "length"
            raise ParameterError(missing, None, "a rounded flat needs its depth and its length")
        positions, heights, notes = rounded_flat(depth=depth, length=length, radius=radius)
    elif shape == "measured":
        if file is None:
            raise ParameterError("file", None, "a measured flat needs its file")
        positions, heights, across, notes = measured_flat(file, lateral=lateral)
    else:
        raise ParameterError("shape", shape, 'allowed: "new", "rounded", "measured"')
    if positions[-1] - positions[0] > _FLAT_SHARE * turn:
        raise ParameterError(
            "length",
            float(positions[-1] - positions[0]),
            f"a wheel flat takes at most a quarter of the turn of {turn:.4g} m",
        )
    origin = math.fmod(angle, 2.0 * math.pi) * turn / (2.0 * math.pi)
    source = _surface(
        positions,
        np.atleast_2d(heights),
        lateral=across,
        on="wheel",
        origin=origin,
        period=turn,
        name=f"{shape} wheel flat",
        key="length",
        dx=dx,
        view=view,
    )
    return source, [*notes, _passing(origin, f"{shape} wheel flat", turn), *_view_notes(view)]


def prepare_rail_joint(
    *,
    dx: float,
    wheel_radius: float | None,  # noqa: ARG001
    view: ContactView,
    position: float,
    gap: float = 0.0,
    step: float = 0.0,
    dip: float = 0.0,
    dip_length: float | None = None,
    step_length: float | None = None,
    spacing: float | None = None,
) -> tuple[Irregularity, list[str]]:
    """Joint of the rail, its middle at ``position``, and again after every ``spacing``."""
    if dip > 0.0 and dip_length is None:
        raise ParameterError("dip_length", dip_length, "a dip needs its length on each side of the joint")
    if spacing is not None and step != 0.0 and step_length is None:
        raise ParameterError("step_length", step_length, "a step that repeats has to run back to level")
    positions, heights = rail_joint(
        gap=gap,
        step=step,
        dip=dip,
        dip_length=dip_length or 1.0,
        step_length=step_length,
        reach=0.1 if spacing is None else min(0.1, 0.5 * spacing),
    )
    source = _surface(
        positions,
        heights[None, :],
        lateral=np.zeros(1),
        on="rail",
        origin=position,
        period=spacing,
        name="rail joint",
        key="spacing",
        dx=dx,
        view=view,
    )
    words = [f"gap {1e3 * gap:.4g} mm", f"step {1e3 * step:+.4g} mm", f"dip {1e3 * dip:.4g} mm"]
    notes = [f"rail joint: {', '.join(words)}", _passing(position, "rail joint", spacing), *_view_notes(view)]
    return source, notes


def prepare_dent(
    *,
    dx: float,
    wheel_radius: float | None,
    view: ContactView,
    on: str,
    depth: float,
    length: float,
    width: float | None = None,
    position: float | None = None,
    angle: float | None = None,
    lateral_position: float = 0.0,
) -> tuple[Irregularity, list[str]]:
    """Dent or squat on the rail at ``position``, or on the wheel at ``angle``."""
    if on == "wheel":
        period = _turn(wheel_radius, "a dent on the wheel")
        if angle is None:
            raise ParameterError("angle", angle, "a dent on the wheel needs its angle")
        origin = math.fmod(angle, 2.0 * math.pi) * period / (2.0 * math.pi)
    else:
        period = None
        if position is None:
            raise ParameterError("position", position, "a dent on the rail needs its position")
        origin = position
    positions, heights, offsets = dent(depth=depth, length=length, width=width)
    source = _surface(
        positions,
        heights,
        lateral=lateral_position + offsets,
        on=on,
        origin=origin,
        period=period,
        name=f"dent on the {on}",
        key="length",
        dx=dx,
        view=view,
    )
    return source, [_passing(origin, f"dent on the {on}", period), *_view_notes(view)]


def prepare_corrugation(
    *,
    dx: float,
    wheel_radius: float | None,  # noqa: ARG001
    view: ContactView,  # noqa: ARG001
    amplitude: float,
    wavelength: float,
    start: float,
    length: float,
) -> tuple[Corrugation, list[str]]:
    """Corrugation on a stretch of rail."""
    if not wavelength > 2.0 * dx:
        raise ParameterError("wavelength", wavelength, f"it must be longer than 2 dx = {2.0 * dx:g} m")
    ramp = min(_RAMP_WAVES * wavelength, 0.5 * length)
    source = Corrugation(amplitude=amplitude, wavelength=wavelength, start=start, length=length, ramp=ramp, dx=dx)
    return source, [
        f"corrugation: from {start:.6g} m to {start + length:.6g} m, fading in and out over {ramp:.4g} m at each end"
    ]


def prepare_out_of_round(
    *,
    dx: float,
    wheel_radius: float | None,
    view: ContactView,  # noqa: ARG001
    orders: Sequence[int],
    amplitudes: Sequence[float],
    phases: Sequence[float] | None = None,
) -> tuple[OutOfRound, list[str]]:
    """Wheel that is not round."""
    turn = _turn(wheel_radius, "an out-of-round wheel")
    counts = (len(orders), len(amplitudes), len(orders) if phases is None else len(phases))
    if len(set(counts)) > 1:
        raise ParameterError("amplitudes", list(amplitudes), f"one for each of the {len(orders)} orders is needed")
    highest = max(orders)
    if not turn / highest > 2.0 * dx:
        raise ParameterError("orders", highest, f"a wave must be longer than 2 dx = {2.0 * dx:g} m")
    source = OutOfRound(
        orders=np.asarray(orders, dtype=float),
        amplitudes=np.asarray(amplitudes, dtype=float),
        phases=np.zeros(len(orders)) if phases is None else np.asarray(phases, dtype=float),
        radius=turn / (2.0 * math.pi),
        dx=dx,
    )
    return source, [f"out-of-round wheel: orders {', '.join(str(order) for order in orders)}"]


def _view_notes(view: ContactView) -> list[str]:
    if view.trajectory:
        return ["contact at a point: it follows the path of a rigid wheel of the real radius over the shape"]
    if view.stretch != 1.0:
        return [
            f"bedding: distances within the contact are stretched by {view.stretch:.4g}, so that its wheel of reduced "
            "radius meets the shape with its real depth and length"
        ]
    return []
