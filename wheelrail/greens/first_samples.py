"""Which first samples of the Green's functions a run keeps (Pieringer 2011, eqs. 3.8 and 3.17).

A first sample that is kept has force and displacement solved together; one that is zero delays the displacement. The
normal contact is solved before the tangential one, so that the first samples that couple the two are zero in any case.
Those of the tangential directions alone may stay like the vertical one. The thesis has all of them zero in runs with
three directions; a contact that sticks all over is then a stiffness k that answers a displacement one step late, and
runs away from step to step, up to full sliding, once k times the second sample exceeds about 1.6. At 50 km/h and 1 mm a
rail in the lateral direction does that.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .combined import CombinedResponse
from .modal import ModalRecursion
from .protocol import WheelResponse
from .recursion import Recursion
from .sampled import SampledGreens

__all__ = ["wheel_with_first", "with_first"]


def with_first(samples: NDArray, *, kept: bool) -> NDArray:
    """Return first samples as a run uses them.

    Parameters
    ----------
    samples : ndarray, shape (..., d, d)
        m/N.
    kept : bool
        Whether those stay that don't couple the vertical with another direction.

    Returns
    -------
    ndarray, shape (..., d, d)
    """
    result = np.zeros_like(samples)
    if kept:
        result[..., -1, -1] = samples[..., -1, -1]
        result[..., :-1, :-1] = samples[..., :-1, :-1]
    return result


def wheel_with_first(wheel: WheelResponse, *, kept: bool) -> WheelResponse:
    """Return a wheel whose first samples are as a run uses them.

    Parameters
    ----------
    wheel : WheelResponse
    kept : bool
        As `with_first` takes it.
    """
    if isinstance(wheel, CombinedResponse):
        return CombinedResponse(tuple(wheel_with_first(part, kept=kept) for part in wheel.parts))
    if isinstance(wheel, Recursion):
        return wheel if kept else replace(wheel, first=0.0)
    if isinstance(wheel, ModalRecursion):
        return replace(wheel, first=with_first(wheel.first, kept=kept))
    if isinstance(wheel, SampledGreens):
        first = with_first(wheel.values[:1], kept=kept)
        return SampledGreens(np.concatenate([first, wheel.values[1:]]))  # type: ignore[return-value]
    raise TypeError(f"no wheel response: {type(wheel).__name__}")
