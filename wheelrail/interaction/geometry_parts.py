"""Contact geometry from the parts that a model file holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from ..contact.geometry import ConstantGeometry, ContactGeometry
from ..errors import ModelFileError
from ..profile.profile_geometry import ProfileGeometry

__all__ = ["geometry_from_parts"]

_KINDS = {"constant": ConstantGeometry, "profiles": ProfileGeometry}


def geometry_from_parts(meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> ContactGeometry:
    """Rebuild the geometry that ``to_parts`` described.

    Raises
    ------
    ModelFileError
        If the kind is unknown or parts are missing.
    """
    kind = meta.get("kind")
    if not isinstance(kind, str) or kind not in _KINDS:
        raise ModelFileError(f"the model holds a geometry of unknown kind {kind!r}; known: {', '.join(_KINDS)}")
    try:
        return _KINDS[kind].from_parts(meta, arrays)
    except (KeyError, TypeError, ValueError) as error:
        raise ModelFileError(f"the model holds a damaged geometry ({kind}): {error}") from error
