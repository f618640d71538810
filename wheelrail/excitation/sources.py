"""All sources of roughness on the grid x = i dx along the rail (numpy only: shipped in the FMU).

Heights count positive outward from the material, on wheel and rail alike: they add to the indentation.
Node i = 0 lies above a sleeper. All sources are immutable, and share ``across``, ``covered``, ``realise``, ``to_parts``
and ``from_parts``. Those that are the same all across the surface have ``add_window``, the others (``across``)
``add_surface``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import ModelFileError
from .coherent_spectrum import CoherentSpectrum
from .corrugation import Corrugation
from .irregularity import Irregularity
from .line import Line
from .out_of_round import OutOfRound
from .sinusoid import Sinusoid
from .spectrum_line import SpectrumLine
from .surface_lines import SurfaceLines

__all__ = [
    "CoherentSpectrum",
    "Corrugation",
    "Irregularity",
    "Line",
    "OutOfRound",
    "Sinusoid",
    "Source",
    "SpectrumLine",
    "SurfaceLines",
    "source_from_parts",
]

Source = Sinusoid | Line | SpectrumLine | SurfaceLines | CoherentSpectrum | Irregularity | Corrugation | OutOfRound
"""Any source of roughness."""

_KINDS: dict[str, Any] = {
    "sinusoid": Sinusoid,
    "line": Line,
    "spectrum": SpectrumLine,
    "surface-lines": SurfaceLines,
    "coherent-spectrum": CoherentSpectrum,
    "irregularity": Irregularity,
    "corrugation": Corrugation,
    "out-of-round": OutOfRound,
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
