"""From ``[wheel]`` of a case to a wheel, and to its response in the time step."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..case import Case
from ..errors import CaseError
from ..greens.combined import CombinedResponse
from ..greens.first_samples import wheel_with_first
from ..greens.from_receptance import greens_from_receptance
from ..greens.modal_discretisation import discretise_modes
from ..greens.ordinary import discretise, sample
from ..greens.protocol import WheelResponse, compliance_matrix, first_sample
from ..greens.recursion import Recursion
from ..greens.sampled import SampledGreens
from ..wheel.modes import FlexibleWheel, Mode
from ..wheel.rigid import RigidWheel
from .wheel_sources import MeasuredWheel, flexible_wheel_of

__all__ = ["MeasuredWheel", "WheelModel", "vertical_receptance", "wheel_of", "wheel_responses"]

_DECAYED = 1e-4  # amplitude over the initial one, as energy 1e-8


WheelModel = RigidWheel | FlexibleWheel | MeasuredWheel


def vertical_receptance(wheel: WheelModel, frequency: ArrayLike) -> NDArray:
    """Vertical point receptance at the contact (m/N) at frequencies in Hz; both of shape (nf,)."""
    values = wheel.receptance(frequency)
    return values if values.ndim == 1 else values[:, 2, 2]


def wheel_of(case: Case) -> WheelModel | None:
    """Make the wheel model of a case; None for a wheel without dynamics.

    Raises
    ------
    CaseError, DataFileError, ParameterError
        If the keys of a flexible wheel do not go with its section or file.
    """
    wheel = case.wheel
    if wheel.model == "rigid":
        return None
    if wheel.model == "flexible":
        try:
            return flexible_wheel_of(case)
        except ValueError as error:
            raise CaseError("wheel", [str(error)]) from error
    suspension = {
        "mass": wheel.mass,
        "suspension_stiffness": wheel.suspension_stiffness,
        "suspension_damping": wheel.suspension_damping,
    }
    if wheel.model == "rigid-1dof":
        return RigidWheel.one_dof(**suspension)
    return RigidWheel.two_dof(
        **suspension,
        contact_mass=wheel.contact_mass,
        contact_stiffness=wheel.contact_stiffness,
        contact_damping=wheel.contact_damping,
    )


def wheel_responses(
    case: Case, wheel: WheelModel | None, *, dt: float, directions: int
) -> tuple[WheelResponse | None, WheelResponse | None, dict[str, Any]]:
    """Discretise a wheel.

    Parameters
    ----------
    case : Case
    wheel : RigidWheel, FlexibleWheel, MeasuredWheel or None
        From `wheel_of`.
    dt : float
        Time step in s.
    directions : int
        3, or 1 for the vertical alone; a rigid wheel has the vertical one in any case.

    Returns
    -------
    wheel, held : WheelResponse or None
        On its suspension, and what remains when the vehicle owns and moves the rigid wheel.
    report : dict
        Facts about both, for people.
    """
    report: dict[str, Any] = {}
    if wheel is None:
        return None, None, report
    kept = case.simulation.first_sample == "kept"
    if isinstance(wheel, RigidWheel):
        parts: list[WheelResponse | None] = [
            None if part is None else discretise(*part.state_space(), dt=dt) for part in (wheel, wheel.held())
        ]
        described = [{}, {}]
    else:
        try:
            parts, facts = _flexible_responses(case, wheel, dt, directions)
        except ValueError as error:
            raise CaseError("wheel", [str(error)]) from error
        if parts[1] is not None and not kept:
            facts["lost_compliance"] = _lost_compliance(parts[1])
        described = [facts, {}]
    for name, part, facts in zip(("wheel", "held_wheel"), parts, described, strict=True):
        if part is not None:
            report[name] = {
                "states": part.size,
                "first_sample": float(first_sample(part)[-1, -1]),
                "decay_time": _decay_time(part, wheel, dt),
                **facts,
            }
    active = [None if part is None else wheel_with_first(part, kept=kept) for part in parts]
    return active[0], active[1], report


def _decay_time(response: WheelResponse, wheel: WheelModel, dt: float) -> float | None:
    """When the Green's functions have decayed (s), which a free wheel's never do; recursions are never cut."""
    if not np.all(np.isfinite(compliance_matrix(response))):
        return None
    if isinstance(response, Recursion):
        return len(sample(response, dt=dt).values) * dt
    if isinstance(wheel, FlexibleWheel):
        rates = [0.5 * mode.damping / mode.mass for mode in wheel.modes if mode.damping_ratio < 1.0]
        return math.log(1.0 / _DECAYED) / min(rates) if rates and min(rates) > 0.0 else None
    return None


def _lost_compliance(held: WheelResponse) -> list[float]:
    """Share of the static compliance that lies in the first sample, for each direction."""
    whole, first = np.diag(compliance_matrix(held)), np.diag(first_sample(held))
    return [float(part / total) if total else 0.0 for part, total in zip(first, whole, strict=True)]


def _flexible_responses(
    case: Case, wheel: FlexibleWheel | MeasuredWheel, dt: float, directions: int
) -> tuple[list[WheelResponse | None], dict[str, Any]]:
    """Response with and without rigid-body motions, and facts."""
    memory = case.wheel.memory  # type: ignore[union-attr]
    facts: dict[str, Any] = {"directions": directions, "notes": list(wheel.notes)}
    held: Any
    if isinstance(wheel, MeasuredWheel):
        greens = greens_from_receptance(
            frequency=wheel.measured.frequency,
            values=wheel.measured.values,
            dt=dt,
            low_frequency=wheel.low_frequency,  # type: ignore[arg-type]
            memory=memory,
        )
        held = SampledGreens(np.ascontiguousarray(greens.values[:, 3 - directions :, 3 - directions :]))
        facts["samples"] = len(greens.values)
        facts["notes"] += greens.notes
    else:
        facts["modes"] = [[mode.name, mode.frequency, mode.damping_ratio] for mode in wheel.modes]
        held = _recursions(wheel.modes, dt, directions)
        if held is not None and memory is not None:
            values = held.values(max(int(memory / dt * (1.0 + 1e-9)), 2))
            values[-1] *= 0.5  # eq. 3.6: the last sample is halved
            held = SampledGreens(values)
            facts["samples"] = len(values)
    if not wheel.rigid:
        return [held, held], facts
    facts["rigid_modes"] = [mode.name for mode in wheel.rigid]
    if isinstance(wheel, FlexibleWheel) and memory is None:
        return [_recursions(wheel.all_modes, dt, directions), held], facts
    body = _recursions(wheel.rigid, dt, directions)
    both = held if body is None else body if held is None else CombinedResponse((held, body))
    return [both, held], facts


def _recursions(modes: tuple[Mode, ...], dt: float, directions: int) -> Any:
    """Recursions of modes; None if none of them moves in the directions."""
    shapes = np.array([mode.shape[3 - directions :] for mode in modes]).reshape(-1, directions)
    if not np.any(shapes):
        return None
    return discretise_modes(
        mass=[mode.mass for mode in modes],
        stiffness=[mode.stiffness for mode in modes],
        damping=[mode.damping for mode in modes],
        shapes=shapes,
        dt=dt,
    )
