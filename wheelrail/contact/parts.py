"""Contact models from the parts that a model file holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from ..errors import ModelFileError
from .bedding import WinklerBedding
from .solution import NormalContact
from .spring import HertzSpring

__all__ = ["contact_from_parts"]

_KINDS = {"winkler": WinklerBedding, "hertz": HertzSpring}


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
