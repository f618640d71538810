"""Contact geometry and normal contact of a case."""

from __future__ import annotations

import math

import numpy as np

from ..case import Case
from ..contact.bedding import WinklerBedding
from ..contact.geometry import ConstantGeometry, ContactGeometry
from ..contact.half_space import HalfSpace
from ..contact.half_space_contact import HalfSpaceContact
from ..contact.hertz import HertzContact, hertz_contact
from ..contact.solution import NormalContact
from ..contact.spring import HertzSpring, averaging_weights
from ..errors import CaseError
from ..excitation.view import ContactView
from .profiles import profile_geometry_of

__all__ = ["contact_of", "curvatures_of", "geometry_of", "hertz_of", "view_of"]

_FLATTEST = 0.1  # 1/m; flatter contacts across the rail are no ellipses


def geometry_of(case: Case) -> ContactGeometry:
    """Where wheel and rail of a case touch.

    Raises
    ------
    DataFileError
        If a profile can't be read.
    ParameterError
        If the profiles don't touch at the lateral shift.
    """
    if case.contact.wheel_profile is not None:
        return profile_geometry_of(case)[0]
    on_wheel = getattr(case.wheel, "contact_position", None)
    on_rail = getattr(case.track, "contact_position", None)
    return ConstantGeometry(
        y_wheel=0.0 if on_wheel is None else on_wheel,
        y_rail=0.0 if on_rail is None else on_rail,
        rolling_radius=case.wheel.radius,
    )


def curvatures_of(case: Case) -> tuple[float, float]:
    """Return the sums of wheel's and rail's curvatures in rolling and in lateral direction, 1/m.

    Of profiles those at the place of first touch. Where they fit each other so closely that no ellipse is like the
    contact, the half-space needs none, and gets a radius of 10 m for what only estimates.

    Raises
    ------
    CaseError
        If a Hertz contact or a bedding is to be made of such profiles.
    """
    if case.contact.wheel_profile is not None:
        place = profile_geometry_of(case)[0].place(case.contact.lateral_shift)
        if place.curvature_y < _FLATTEST and case.contact.normal != "half-space":
            raise CaseError(
                "contact.normal",
                [
                    f'"{case.contact.normal}" needs a contact like an ellipse; at lateral_shift = '
                    f"{case.contact.lateral_shift:g} m the profiles have a relative curvature of "
                    f'{place.curvature_y:.3g} 1/m across the rail (at least {_FLATTEST:g}); use "half-space"'
                ],
            )
        return place.curvature_x, max(place.curvature_y, _FLATTEST)
    transverse = case.contact.wheel_transverse_radius
    assert case.contact.rail_radius is not None
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


def view_of(case: Case) -> ContactView:
    """How the contact model of a case looks at wheel flats, rail joints and dents."""
    radius = 1.0 / curvatures_of(case)[0]
    contact = case.contact
    bedded = contact.normal == "winkler" or (contact.normal == "hertz" and contact.prefilter == "winkler")
    if bedded:
        hertz = hertz_of(case)
        reduced = hertz.semi_axis_x**2 / (2.0 * hertz.approach)
        return ContactView(radius=radius, stretch=math.sqrt(radius / reduced), trajectory=False)
    return ContactView(radius=radius, stretch=1.0, trajectory=contact.normal == "hertz")


def contact_of(case: Case) -> NormalContact:
    """Make the normal contact model of a case.

    Raises
    ------
    CaseError
        If a prefilter does not fit into the potential contact area.
    """
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
        profiles = case.contact.wheel_profile is not None
        return HalfSpaceContact(grid, 1.0 / curvature_x, 1.0 / curvature_y, profiles)
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
