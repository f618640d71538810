"""Where wheel and rail touch, as the interaction uses it: the contact's place for a lateral shift of the wheel."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple, Protocol

from numpy.typing import NDArray

__all__ = ["ConstantGeometry", "ContactGeometry", "OtherPoint", "Place"]


class OtherPoint(NamedTuple):
    """A further point where the bodies come close.

    Attributes
    ----------
    y_wheel, y_rail : float
        Lateral positions on wheel and rail, m.
    gap : float
        Distance of the bodies there when they touch at the first point, m.
    """

    y_wheel: float
    y_rail: float
    gap: float


class Place(NamedTuple):
    """The place of first touch.

    Attributes
    ----------
    y_wheel : float
        Lateral position on the wheel from the tape circle, m, positive to the field side.
    y_rail : float
        Lateral position on the rail from its axis, m.
    angle : float
        Contact angle, rad: positive where the flange climbs.
    rolling_radius : float
        Radius of the wheel there, m.
    others : tuple of OtherPoint
    """

    y_wheel: float
    y_rail: float
    angle: float
    rolling_radius: float
    others: tuple[OtherPoint, ...] = ()


class ContactGeometry(Protocol):
    """Geometry of wheel and rail without roughness."""

    @property
    def description(self) -> str:
        """The geometry in a few words."""
        ...

    @property
    def shaped(self) -> bool:
        """Whether `distance` gives the undeformed distance; else the contact model has its radii."""
        ...

    def place(self, shift: float) -> Place:
        """Find the place of first touch for a lateral shift of the wheel on the rail, m."""
        ...

    def distance(self, shift: float, x: NDArray, y: NDArray) -> NDArray:
        """Undeformed distance in m around the place of first touch, shape (len(y), len(x))."""
        ...

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """Return a JSON-able description with its ``kind``, and the arrays, for a file."""
        ...


@dataclass(frozen=True)
class ConstantGeometry:
    """A straight tread on a round rail: the contact stays on the rail's crown.

    Parameters
    ----------
    y_wheel : float
        Contact position on the wheel without shift, m from the tread's centre.
    y_rail : float
        Contact position on the rail, m from its axis.
    rolling_radius : float
        m.
    """

    y_wheel: float
    y_rail: float
    rolling_radius: float

    @property
    def description(self) -> str:
        """The geometry in a few words."""
        return "straight tread on a round rail"

    @property
    def shaped(self) -> bool:
        """The contact model has the radii."""
        return False

    def place(self, shift: float) -> Place:
        """Return the crown of the rail and what of the wheel is above it."""
        return Place(self.y_wheel - shift, self.y_rail, 0.0, self.rolling_radius)

    def distance(self, shift: float, x: NDArray, y: NDArray) -> NDArray:
        """Not available: the contact model has the radii (``NotImplementedError``)."""
        raise NotImplementedError

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """Return a JSON-able description, and no arrays."""
        return {"kind": "constant", **asdict(self)}, {}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> ConstantGeometry:
        """Rebuild it from `to_parts`."""
        del arrays
        return cls(meta["y_wheel"], meta["y_rail"], meta["rolling_radius"])
