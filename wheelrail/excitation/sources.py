"""All sources of roughness on the grid x = i dx along the rail (numpy only: shipped in the FMU).

Heights count positive outward from the material, on wheel and rail alike: they add to the indentation.
Node i = 0 lies above a sleeper. All sources are immutable, and share ``add_window``, ``covered``, ``realise``,
``to_parts`` and ``from_parts``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import ModelFileError
from .line import Line
from .sinusoid import Sinusoid
from .spectrum_line import SpectrumLine

__all__ = ["Line", "Sinusoid", "Source", "SpectrumLine", "source_from_parts"]

Source = Sinusoid | Line | SpectrumLine
"""Any source of roughness."""

_KINDS: dict[str, type[Sinusoid] | type[Line] | type[SpectrumLine]] = {
    "sinusoid": Sinusoid,
    "line": Line,
    "spectrum": SpectrumLine,
}


def source_from_parts(meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> Source:
    """Source that ``to_parts`` described.

    Raises
    ------
    ModelFileError
        Unknown kind, or missing or unusable parts.
    """
    kind = meta.get("kind")
    if not isinstance(kind, str) or kind not in _KINDS:
        raise ModelFileError(f"the model holds a roughness source of unknown kind {kind!r}; known: {', '.join(_KINDS)}")
    try:
        return _KINDS[kind].from_parts(meta, arrays)
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise ModelFileError(f"the model holds a damaged roughness source ({kind}): {error}") from error
