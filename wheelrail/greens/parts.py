"""Wheel responses as plain descriptions and arrays, for a model file and for a fingerprint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ModelFileError
from .combined import CombinedResponse
from .modal import ModalRecursion
from .protocol import WheelResponse
from .recursion import Recursion
from .sampled import SampledGreens

__all__ = ["response_from_parts", "response_to_parts"]

_KINDS: dict[str, Any] = {"dense": Recursion, "modal": ModalRecursion, "sampled": SampledGreens}


def response_to_parts(response: WheelResponse) -> tuple[dict[str, Any], dict[str, NDArray]]:
    """Return a JSON-able description with its ``kind``, and the arrays."""
    if isinstance(response, CombinedResponse):
        described = [response_to_parts(part) for part in response.parts]
        arrays = {f"{i}.{name}": array for i, (_, parts) in enumerate(described) for name, array in parts.items()}
        return {"kind": "combined", "parts": [meta for meta, _ in described]}, arrays
    kind = next(name for name, made in _KINDS.items() if type(response) is made)
    values = {f.name: getattr(response, f.name) for f in fields(response) if f.init}  # type: ignore[arg-type]
    arrays = {name: value for name, value in values.items() if isinstance(value, np.ndarray)}
    return {"kind": kind, **{name: value for name, value in values.items() if name not in arrays}}, arrays


def response_from_parts(meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> WheelResponse:
    """Rebuild a response from `response_to_parts`.

    Raises
    ------
    ModelFileError
        If the kind is unknown or parts are missing.
    """
    kind = meta.get("kind")
    if kind == "combined":
        parts = []
        for i, part in enumerate(meta["parts"]):
            prefix = f"{i}."
            own = {name.removeprefix(prefix): array for name, array in arrays.items() if name.startswith(prefix)}
            parts.append(response_from_parts(part, own))
        return CombinedResponse(tuple(parts))
    if kind not in _KINDS:
        raise ModelFileError(f"the model holds a wheel of unknown kind {kind!r}; known: {', '.join(_KINDS)}, combined")
    try:
        return _KINDS[kind](**arrays, **{name: value for name, value in meta.items() if name != "kind"})
    except TypeError as error:
        raise ModelFileError(f"the model holds a damaged wheel ({kind}): {error}") from error
