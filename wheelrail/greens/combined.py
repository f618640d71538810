"""A wheel whose response is the sum of two, such as its flexibility and its motion as a rigid body."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .protocol import WheelResponse, compliance_matrix, first_sample

__all__ = ["CombinedResponse"]


@dataclass(frozen=True)
class CombinedResponse:
    """Sum of responses in the same directions; its state is theirs, one after the other.

    Parameters
    ----------
    parts : tuple of WheelResponse
    """

    parts: tuple[WheelResponse, ...]

    @property
    def directions(self) -> int:
        """Number of directions."""
        return self.parts[0].directions

    @cached_property
    def _places(self) -> list[slice]:
        ends = np.cumsum([0, *(part.size for part in self.parts)])
        return [slice(int(first), int(last)) for first, last in pairwise(ends)]

    @property
    def size(self) -> int:
        """Numbers in its state."""
        return sum(part.size for part in self.parts)

    @property
    def first(self) -> NDArray:
        """First sample, shape (d, d), m/N."""
        return np.sum([first_sample(part) for part in self.parts], axis=0)

    def known(self, state: NDArray) -> NDArray:
        """Return the displacement from all past forces, shape (d,), m."""
        return np.sum(
            [np.asarray(part.known(state[at])) for part, at in zip(self.parts, self._places, strict=True)], axis=0
        )

    def advance(self, state: NDArray, force: NDArray) -> None:
        """Go on to the next step under a force (N), shape (d,)."""
        for part, at in zip(self.parts, self._places, strict=True):
            part.advance(state[at], force)

    def static_compliance(self) -> NDArray:
        """Sum of all samples, shape (d, d), m/N; infinite for a free body."""
        return np.sum([compliance_matrix(part) for part in self.parts], axis=0)

    def steady(self, force: NDArray) -> NDArray:
        """Return the state after a force (N), shape (d,), that has acted for ever."""
        return np.concatenate([part.steady(force) for part in self.parts])
