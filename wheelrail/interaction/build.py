"""From a case to its model."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from ..case import Case
from ..contact.bedding import WinklerBedding
from ..contact.half_space import HalfSpace
from ..contact.half_space_contact import HalfSpaceContact
from ..contact.hertz import HertzContact, hertz_contact
from ..contact.parts import tangential_model
from ..contact.solution import NormalContact
from ..contact.spring import HertzSpring, averaging_weights
from ..contact.tangential_models import TangentialModel
from ..errors import CaseError
from ..excitation.prepare import prepare_source
from .friction import slip_friction_of, static_friction_of
from .inputs import Inputs
from .model import Model
from .parameters import OWN_SEEDS, Parameters
from .tracks import memory_of, track_of, track_response
from .wheels import wheel_of, wheel_responses

__all__ = ["build_model", "curvatures_of", "hertz_of", "memory_of", "track_of", "wheel_of"]


def curvatures_of(case: Case) -> tuple[float, float]:
    """Return the sums of wheel's and rail's curvatures in rolling and in lateral direction, 1/m."""
    transverse = case.contact.wheel_transverse_radius
    lateral = 1.0 / case.contact.rail_radius + (0.0 if transverse is None else 1.0 / transverse)
    return 1.0 / case.wheel.radius, lateral


def hertz_of(case: Case) -> HertzContact:
    """Solve Hertz contact of a case's geometry under its preload."""
    contact = case.contact
    curvature_x, curvature_y = curvatures_of(case)
    return hertz_contact(
        curvature_x=curvature_x,
        curvature_y=curvature_y,
        youngs_modulus=contact.youngs_modulus,
        poisson_ratio=contact.poisson_ratio,
        load=case.load.preload,
    )


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
    sources, notes = [], []
    for entry in case.excitation:
        keys = entry.model_dump(exclude_none=True)
        if "file" in keys:
            keys["file"] = case.data_path(keys["file"])
        source, remarks = prepare_source(dx=simulation.dx, wheel_radius=case.wheel.radius, **keys)
        sources.append(source)
        notes += remarks
    report["excitation"] = notes
    parameters = Parameters(
        speed=simulation.speed,
        friction_coefficient=static_friction_of(case),
        start_position=simulation.start_position,
        lateral_position=0.0,
        coupling=case.load.coupling,
        balance=True,
        input_extrapolation="hold",
        roughness_scale=1.0,
        random_seed=OWN_SEEDS,
        record=False,
    )
    contact = _contact_of(case)
    return Model(
        title=case.title or "",
        case=case.to_toml(),
        dx=simulation.dx,
        parameters=parameters,
        start_inputs=_start_inputs(case),
        wheel=wheel,
        held_wheel=held_wheel,
        track=track,
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


def _contact_of(case: Case) -> NormalContact:
    contact, dx = case.contact, case.simulation.dx
    hertz = hertz_of(case)
    if contact.normal == "half-space":
        grid = HalfSpace(
            mx=round(contact.length / dx),
            my=round(contact.width / contact.dy),
            dx=dx,
            dy=contact.dy,
            shear_modulus=contact.youngs_modulus / (2.0 * (1.0 + contact.poisson_ratio)),
            poisson_ratio=contact.poisson_ratio,
        )
        curvature_x, curvature_y = curvatures_of(case)
        return HalfSpaceContact(grid, 1.0 / curvature_x, 1.0 / curvature_y)
    nodes = 1 if contact.length is None else round(contact.length / dx)
    calibration = {
        "load": hertz.load,
        "semi_axis_x": hertz.semi_axis_x,
        "semi_axis_y": hertz.semi_axis_y,
        "approach": hertz.approach,
        "dx": dx,
        "nodes": nodes,
    }
    if contact.normal == "winkler":
        return WinklerBedding.from_hertz(**calibration)
    cube_root = hertz.load ** (1.0 / 3.0)
    weights, bedding = np.zeros(nodes), None
    weights[nodes // 2] = 1.0
    if contact.prefilter != "none" and 0.5 * (nodes - 1) * dx < hertz.semi_axis_x:
        raise CaseError(
            "contact.length",
            [f"the prefilter needs at least the nominal contact length {2e3 * hertz.semi_axis_x:.3g} mm and one dx"],
        )
    if contact.prefilter == "average":
        weights = averaging_weights(half_length=hertz.semi_axis_x, dx=dx, nodes=nodes)
    elif contact.prefilter == "winkler":
        bedding = WinklerBedding.from_hertz(**calibration)
    return HertzSpring(
        constant=hertz.constant,
        axis_constants=(hertz.semi_axis_x / cube_root, hertz.semi_axis_y / cube_root),
        nodes=nodes,
        weights=weights,
        bedding=bedding,
        preload=hertz.load,
    )
