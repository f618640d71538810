"""Heights on several parallel lines: what differs across the contact (numpy only: shipped in the FMU)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from ..errors import ExcitationRangeError
from .lateral_interpolation import lateral_weights
from .sampled_heights import check_spacing, read_only, require

__all__ = ["SurfaceLines"]


@dataclass(frozen=True, eq=False)
class SurfaceLines:
    """Heights at consecutive nodes of parallel lines, once or repeating.

    Across, heights are linear between neighbouring lines; beyond the outermost lines their heights continue. Halfway
    between two lines of equal level and complex coherence gamma, the mean square is (1 + gamma) / 2 of theirs: lines
    must lie closer than the roughness loses its coherence, or it is too smooth in between.

    Parameters
    ----------
    values : ndarray, shape (lines, n)
        Heights, positive outward from the material, m.
    lateral : ndarray, shape (lines,)
        Positions across, increasing, m: on the wheel from the tape circle, on the rail from its axis, to the field
        side.
    first_index : int
        Node of ``values[:, 0]``.
    dx : float
        Grid spacing, m.
    periodic : bool
        True: repeats every n nodes in both directions.
    on : {"wheel", "rail"}
        Surface that carries the lines.
    name : str
        What a message calls them.
    """

    values: np.ndarray
    lateral: np.ndarray
    first_index: int
    dx: float
    periodic: bool
    on: str
    name: str
    kind: str = field(default="surface-lines", init=False)
    across: ClassVar[bool] = True

    _SCALARS: ClassVar = ("first_index", "dx", "periodic", "on", "name")

    def __post_init__(self) -> None:
        values, lateral = read_only(self.values), read_only(self.lateral)
        require(lateral.ndim == 1 and len(lateral) >= 1, "lateral must be a non-empty 1-D array")
        require(bool(np.all(np.isfinite(lateral)) and np.all(np.diff(lateral) > 0.0)), "lateral must increase")
        require(values.ndim == 2 and values.shape[0] == len(lateral), "values must be of shape (lines, n)")
        require(values.shape[1] > 0 and bool(np.all(np.isfinite(values))), "values must be finite, n at least 1")
        require(bool(np.isfinite(self.dx)) and self.dx > 0.0, "dx must be positive")
        require(self.on in ("wheel", "rail"), "on must be 'wheel' or 'rail'")
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "lateral", lateral)
        object.__setattr__(self, "first_index", int(self.first_index))
        object.__setattr__(self, "dx", float(self.dx))
        object.__setattr__(self, "periodic", bool(self.periodic))

    @property
    def lateral_range(self) -> tuple[float, float]:
        """Positions of the outermost lines, m; beyond them heights are continued, not known."""
        return float(self.lateral[0]), float(self.lateral[-1])

    def add_surface(self, first: int, y_wheel: np.ndarray, y_rail: np.ndarray, out: np.ndarray) -> None:
        """Add the heights at nodes first, first + 1, ... along and at given positions across.

        Parameters
        ----------
        first : int
            Node of the first column.
        y_wheel, y_rail : ndarray, shape (rows,)
            Positions on wheel and rail, m.
        out : ndarray, shape (rows, nodes)
            Changed in place; m.

        Raises
        ------
        ExcitationRangeError
            The window leaves lines that do not repeat; ``out`` is untouched.
        """
        count = self.values.shape[1]
        start = int(first) - self.first_index
        stop = start + out.shape[1]
        if self.periodic:
            start %= count
            stop = start + out.shape[1]
        elif start < 0 or stop > count:
            self._refuse(start if start < 0 else stop - 1)
        if stop <= count:
            heights = self.values[:, start:stop]
        else:
            heights = np.take(self.values, np.arange(start, stop) % count, axis=1)
        out += lateral_weights(self.lateral, y_wheel if self.on == "wheel" else y_rail) @ heights

    def _refuse(self, sample: int) -> None:
        lowest, highest = (self.first_index * self.dx, (self.first_index + self.values.shape[1] - 1) * self.dx)
        raise ExcitationRangeError(
            f"{self.name}: the contact needs the roughness at x = {(self.first_index + sample) * self.dx:.6g} m, but "
            f"the lines cover {lowest:.6g} m to {highest:.6g} m. Make the run shorter, choose another start_position "
            '(the potential contact area must fit too), or repeat the lines with beyond_end = "repeat".'
        )

    def realise(self, *, dx: float, seed_override: int | None) -> SurfaceLines:  # noqa: ARG002
        """Return itself: nothing is random any more."""
        check_spacing(self.dx, dx)
        return self

    def covered(self) -> tuple[float, float] | None:
        """First and last position covered along the rail, m; None if the lines repeat."""
        if self.periodic:
            return None
        return self.first_index * self.dx, (self.first_index + self.values.shape[1] - 1) * self.dx

    def to_parts(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """JSON-able description and arrays, for `wheelrail.excitation.sources.source_from_parts`."""
        meta = {"kind": self.kind, **{name: getattr(self, name) for name in self._SCALARS}}
        return meta, {"values": self.values, "lateral": self.lateral}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> SurfaceLines:
        """Inverse of :meth:`to_parts`."""
        scalars = {name: meta[name] for name in cls._SCALARS}
        return cls(values=arrays["values"], lateral=arrays["lateral"], **scalars)
