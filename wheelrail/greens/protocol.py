"""What the time step asks of the wheel.

Directions are ordered (x', y', z'). A response has either all three of them, or one, the vertical; so the last one is
always vertical. Forces are P - F, what drives the wheel.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

__all__ = ["FreeBodyError", "WheelResponse", "compliance_matrix", "first_sample"]


class FreeBodyError(ValueError):
    """A constant force on a body without suspension: there is no steady state."""


class WheelResponse(Protocol):
    """Convolution with the Green's functions of a wheel; immutable, its state lies with the run.

    With u the force and q the state at a step,

        displacement = known(q) + first u,    advance: q <- q of the next step.
    """

    @property
    def directions(self) -> int:
        """Number of directions d: 3, or 1 for the vertical alone."""
        ...

    @property
    def size(self) -> int:
        """Numbers in its state."""
        ...

    @property
    def first(self) -> NDArray | float:
        """First sample of the Green's functions, shape (d, d) or a number if d = 1; m/N."""
        ...

    def known(self, state: NDArray, /) -> Sequence[float] | NDArray:
        """Return the displacement from all past forces, d values in m."""
        ...

    def advance(self, state: NDArray, force: NDArray, /) -> None:
        """Go on to the next step under the present force (N), shape (d,); ``state`` is changed in place."""
        ...

    def static_compliance(self) -> NDArray | float:
        """Sum of all samples, shape (d, d) or a number if d = 1; m/N, infinite for a free body."""
        ...

    def steady(self, force: NDArray, /) -> NDArray:
        """Return the state after a force (N), shape (d,), that has acted for ever.

        Raises
        ------
        FreeBodyError
            If that moves a body which nothing holds.
        """
        ...


def first_sample(response: WheelResponse) -> NDArray:
    """Return the first sample as an array of shape (d, d)."""
    return np.reshape(np.asarray(response.first, dtype=float), (response.directions, response.directions))


def compliance_matrix(response: WheelResponse) -> NDArray:
    """Return the static compliance as an array of shape (d, d)."""
    return np.reshape(np.asarray(response.static_compliance(), dtype=float), (response.directions, response.directions))
