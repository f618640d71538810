"""From a case to its model."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from threadpoolctl import threadpool_limits

from ..case import Case
from ..contact.geometry import ConstantGeometry
from ..contact.parts import tangential_model
from ..contact.solution import NormalContact
from ..contact.tangential_models import TangentialModel
from ..excitation.prepare import prepare_source
from .contacts import contact_of, curvatures_of, geometry_of, hertz_of, view_of
from .friction import slip_friction_of, static_friction_of
from .inputs import Inputs
from .model import Model
from .parameters import OWN_SEEDS, Parameters
from .profiles import profile_geometry_of
from .tracks import memory_of, track_of, track_response
from .wheels import wheel_of, wheel_responses

__all__ = ["build_model", "curvatures_of", "hertz_of", "memory_of", "track_of", "wheel_of"]


def build_model(case: Case, progress: Callable[[float], None] | None = None) -> Model:
    """Precompute everything that a run of the case needs.

    Parameters
    ----------
    case : Case
    progress : callable, optional
        Called with the share of the Green's functions done; not called if they come from the cache.

    Returns
    -------
    Model

    Raises
    ------
    WheelrailError
        If the case asks for what its parts can't give together.
    """
    with threadpool_limits(1):  # the numbers must not depend on the machine's cores
        return _build(case, progress)


def _build(case: Case, progress: Callable[[float], None] | None) -> Model:
    simulation = case.simulation
    dt = simulation.dx / simulation.speed
    # Tangential contact takes wheel and rail to three directions, as far as their models have them.
    directions = 1 if case.contact.tangential == "none" else 3
    wheel, held_wheel, report = wheel_responses(case, wheel_of(case), dt=dt, directions=directions)
    track, facts = track_response(case, directions=directions, progress=progress)
    if track is not None:
        report["track"] = facts
    sources, notes, view = [], [], view_of(case)
    for entry in case.excitation:
        keys = entry.model_dump(exclude_none=True)
        if "file" in keys:
            keys["file"] = case.data_path(keys["file"])
        source, remarks = prepare_source(dx=simulation.dx, wheel_radius=case.wheel.radius, view=view, **keys)
        sources.append(source)
        notes += remarks
    report["excitation"] = notes
    if case.contact.wheel_profile is not None:
        report["profiles"] = profile_geometry_of(case)[1]
    geometry = geometry_of(case)
    parameters = Parameters(
        speed=simulation.speed,
        friction_coefficient=static_friction_of(case),
        start_position=simulation.start_position,
        lateral_position=geometry.y_wheel if isinstance(geometry, ConstantGeometry) else 0.0,
        coupling=case.load.coupling,
        balance=True,
        input_extrapolation="hold",
        roughness_scale=1.0,
        random_seed=OWN_SEEDS,
        record=False,
    )
    contact = contact_of(case)
    return Model(
        title=case.title or "",
        case=case.to_toml(),
        dx=simulation.dx,
        parameters=parameters,
        start_inputs=_start_inputs(case),
        wheel=wheel,
        held_wheel=held_wheel,
        track=track,
        geometry=geometry,
        contact=contact,
        tangential=_tangential_of(case, contact),
        sources=tuple(sources),
        report=report,
    ).configured()


def _start_inputs(case: Case) -> Inputs:
    creepage = case.creepage
    return Inputs(
        creepage_x=0.0 if creepage is None else creepage.x,
        creepage_y=0.0 if creepage is None else creepage.y,
        creepage_spin=0.0 if creepage is None else creepage.spin,
        wheel_force_z=case.load.preload,
        lateral_shift=case.contact.lateral_shift,
    )


def _tangential_of(case: Case, normal: NormalContact) -> TangentialModel | None:
    contact = case.contact
    shear_modulus = contact.youngs_modulus / (2.0 * (1.0 + contact.poisson_ratio))
    meta: dict[str, Any] = {
        "kind": contact.tangential,
        "shear_modulus": shear_modulus,
        "poisson_ratio": contact.poisson_ratio,
    }
    friction = slip_friction_of(case)
    if friction is not None:
        meta["friction"] = friction.to_parts()
    return tangential_model(meta, normal)
