"""Where wheel and rail touch, as the interaction uses it: the contact's place for a lateral shift of the wheel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple, Protocol

from numpy.typing import NDArray

__all__ = ["ConstantGeometry", "ContactGeometry", "ContactPlace", "NearPoint", "Place"]


class NearPoint(Protocol):
    """A further point where the bodies come close."""

    @property
    def y_wheel(self) -> float:
        """Lateral position on the wheel, m."""
        ...

    @property
    def y_rail(self) -> float:
        """Lateral position on the rail, m."""
        ...

    @property
    def gap(self) -> float:
        """Distance of the bodies there when they touch at the first point, m."""
        ...


class ContactPlace(Protocol):
    """The place of first touch."""

    @property
    def y_wheel(self) -> float:
        """Lateral position on the wheel from the tape circle, m, positive to the field side."""
        ...

    @property
    def y_rail(self) -> float:
        """Lateral position on the rail from its axis, m."""
        ...

    @property
    def angle(self) -> float:
        """Contact angle, rad: positive where the flange climbs."""
        ...

    @property
    def rolling_radius(self) -> float:
        """Radius of the wheel there, m."""
        ...

    @property
    def lift(self) -> float:
        """How much higher the wheel rides than at the reference shift, m."""
        ...

    @property
    def others(self) -> Sequence[NearPoint]:
        """Further points."""
        ...


class Place(NamedTuple):
    """A place of first touch without others, see `ContactPlace`."""

    y_wheel: float
    y_rail: float
    angle: float
    rolling_radius: float
    lift: float = 0.0
    others: tuple[()] = ()


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

    def place(self, shift: float) -> ContactPlace:
        """Find the place of first touch for a lateral shift of the wheel on the rail, m."""
        ...

    def distance(self, shift: float, x: NDArray, y: NDArray) -> NDArray | None:
        """Undeformed distance in m around the place of first touch, shape (len(y), len(x)); None if not `shaped`."""
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

    def distance(self, shift: float, x: NDArray, y: NDArray) -> None:
        """Return None: the contact model has the radii."""

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """Return a JSON-able description, and no arrays."""
        return {"kind": "constant", **asdict(self)}, {}

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> ConstantGeometry:
        """Rebuild it from `to_parts`."""
        del arrays
        return cls(meta["y_wheel"], meta["y_rail"], meta["rolling_radius"])
