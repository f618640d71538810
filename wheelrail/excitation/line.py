"""Heights at consecutive nodes: measured or realised lines (numpy only: shipped in the FMU)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from ..errors import ExcitationRangeError
from .sampled_heights import add_periodic, check_spacing, padded, read_only, require

__all__ = ["Line"]


@dataclass(frozen=True, eq=False)
class Line:
    """Heights at consecutive nodes, once or repeating.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Heights, m.
    first_index : int
        Node of ``values[0]``.
    dx : float
        Grid spacing, m.
    periodic : bool
        True: repeats every n nodes in both directions.
    name : str
        What a message calls the line.
    """

    values: np.ndarray
    first_index: int
    dx: float
    periodic: bool
    name: str
    kind: str = field(default="line", init=False)
    across: ClassVar[bool] = False
    _window: np.ndarray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        values = read_only(self.values)
        require(values.ndim == 1 and values.shape[0] > 0, "values must be a non-empty 1-D array")
        require(bool(np.all(np.isfinite(values))), "values must be finite")
        require(bool(np.isfinite(self.dx)) and self.dx > 0.0, "dx must be positive")
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "first_index", int(self.first_index))
        object.__setattr__(self, "dx", float(self.dx))
        object.__setattr__(self, "periodic", bool(self.periodic))
        object.__setattr__(self, "name", str(self.name))
        object.__setattr__(self, "_window", padded(values) if self.periodic else values)

    def add_window(self, first: int, out: np.ndarray) -> None:
        """Add the heights of nodes first, first + 1, ... to ``out`` (shape (n,), m).

        Raises
        ------
        ExcitationRangeError
            The window leaves a line that does not repeat; ``out`` is untouched.
        """
        start = int(first) - self.first_index
        count = self.values.shape[0]
        if self.periodic:
            add_periodic(self._window, count, start, out)
            return
        stop = start + out.shape[0]
        if start < 0 or stop > count:
            self._refuse(start if start < 0 else stop - 1)
        out += self._window[start:stop]

    def _refuse(self, sample: int) -> None:
        lowest, highest = (self.first_index * self.dx, (self.first_index + self.values.shape[0] - 1) * self.dx)
        raise ExcitationRangeError(
            f"{self.name}: the contact needs the roughness at x = {(self.first_index + sample) * self.dx:.6g} m, but "
            f"the line covers {lowest:.6g} m to {highest:.6g} m. Make the run shorter, choose another start_position "
            '(the potential contact area must fit too), or repeat the line with beyond_end = "repeat".'
        )

    def realise(self, *, dx: float, seed_override: int | None) -> Line:  # noqa: ARG002
        """Return itself: nothing is random any more."""
        check_spacing(self.dx, dx)
        return self

    def covered(self) -> tuple[float, float] | None:
        """First and last position covered, m; None if the line repeats."""
        if self.periodic:
            return None
        return self.first_index * self.dx, (self.first_index + self.values.shape[0] - 1) * self.dx

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description and arrays, for :func:`source_from_parts`."""
        meta = {
            "kind": self.kind,
            "first_index": self.first_index,
            "dx": self.dx,
            "periodic": self.periodic,
            "name": self.name,
        }
        return meta, {"values": self.values}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> Line:
        """Inverse of :meth:`to_parts`."""
        return cls(
            values=arrays["values"],
            first_index=meta["first_index"],
            dx=meta["dx"],
            periodic=meta["periodic"],
            name=meta["name"],
        )
