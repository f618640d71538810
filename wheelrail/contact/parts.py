"""Contact models from the parts that a model file holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from ..errors import ModelFileError
from .bedding import WinklerBedding
from .friction.laws import ConstantLaw
from .friction.settings import SlipFriction
from .half_space_contact import HalfSpaceContact
from .point_contact import PointContact
from .slip_dependent_model import SlipDependentRolling
from .solution import NormalContact
from .spring import HertzSpring
from .tangential_models import CreepForceLaw, TangentialModel, TransientRolling

__all__ = ["contact_from_parts", "tangential_model"]

_KINDS = {"winkler": WinklerBedding, "hertz": HertzSpring, "half-space": HalfSpaceContact}


def contact_from_parts(meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> NormalContact:
    """Rebuild the contact model that ``to_parts`` described.

    Raises
    ------
    ModelFileError
        If the kind is unknown or parts are missing.
    """
    kind = meta.get("kind")
    if kind not in _KINDS:
        raise ModelFileError(f"the model holds a contact of unknown kind {kind!r}; known: {', '.join(_KINDS)}")
    try:
        return _KINDS[kind].from_parts(meta, arrays)
    except (KeyError, TypeError, ValueError) as error:
        raise ModelFileError(f"the model holds a damaged contact ({kind}): {error}") from error


def tangential_model(meta: Mapping[str, Any], normal: NormalContact) -> TangentialModel | None:
    """Make the tangential model of that ``kind``; None for "none".

    Parameters
    ----------
    meta : mapping
        ``kind``; for the laws ``shear_modulus`` in Pa and ``poisson_ratio``; ``friction``, as `SlipFriction` describes
        itself, where it depends on the slip velocity.
    normal : NormalContact
        Gives the grid for "transient".

    Raises
    ------
    ModelFileError
        If the kind is unknown, or transient rolling has no half-space to go with.
    """
    kind = meta.get("kind")
    if kind == "none":
        return None
    try:
        friction = SlipFriction.from_parts(meta["friction"]) if meta.get("friction") else None
    except (KeyError, TypeError, ValueError) as error:
        raise ModelFileError(f"the model holds a damaged friction law: {error}") from error
    if kind == "transient" and isinstance(normal, HalfSpaceContact):
        grid = normal.half_space
        return TransientRolling(grid) if friction is None else SlipDependentRolling(grid, friction)
    if kind == "friction-curve":
        law, memory = (ConstantLaw(), None) if friction is None else (friction.law, friction.memory)
        return PointContact(meta["shear_modulus"], meta["poisson_ratio"], law, memory)
    if kind in ("fastsim", "linear"):
        return CreepForceLaw(kind, meta["shear_modulus"], meta["poisson_ratio"])
    raise ModelFileError(f"the model holds a tangential contact {kind!r} that does not go with its normal contact")
