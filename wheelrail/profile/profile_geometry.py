"""Wheel and rail with profiles as a run uses them: place of contact, undeformed distance (numpy only: in the FMU)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

from numpy.typing import NDArray

from .contact_search import ContactSearch, FirstTouch
from .curve import ProfileCurve
from .undeformed_distance import undeformed_distance

__all__ = ["OtherPoint", "Place", "ProfileGeometry"]


_FARTHEST = 1e-3  # m, gap of a further point: a heavy load, or a flat, brings it into contact


class OtherPoint(NamedTuple):
    """A further point where the bodies come close.

    Attributes
    ----------
    y_wheel, y_rail : float
        Lateral positions on wheel and rail, m.
    gap : float
        Vertical distance there when they touch at the first point, m.
    """

    y_wheel: float
    y_rail: float
    gap: float


class Place(NamedTuple):
    """The place of first touch.

    Attributes
    ----------
    y_wheel : float
        Lateral position on the wheel from the tape circle, m, + to the field side.
    y_rail : float
        Lateral position on the rail from its axis, in the frame inclined with the rail, m.
    angle : float
        Contact angle, rad: positive where the flange climbs.
    rolling_radius : float
        m.
    curvature_x, curvature_y : float
        Relative principal curvatures along and across the rail, 1/m.
    ride_height : float
        Height of the wheel's axis over the middle of the rail's running surface, less the nominal radius, m.
    lift : float
        How much higher the wheel rides than at the reference shift, m.
    others : tuple of OtherPoint
        In the order of their gaps.
    """

    y_wheel: float
    y_rail: float
    angle: float
    rolling_radius: float
    curvature_x: float
    curvature_y: float
    ride_height: float
    lift: float
    others: tuple[OtherPoint, ...] = ()


@dataclass(frozen=True, eq=False)
class ProfileGeometry:
    """A wheel and a rail that touch where their profiles do.

    Parameters
    ----------
    wheel, rail : ProfileCurve
    nominal_radius : float
        Of the wheel at its tape circle, m.
    inclination : float
        Angle by which the rail leans to the track's centre, rad.
    yaw : float
        Turn of the wheel about the vertical, from the rolling direction to the field side, rad.
    reference_shift : float
        Lateral shift from whose ride height the wheel's vertical displacement counts, m.

    Raises
    ------
    ParameterError
        If a number is out of range, or wheel and rail don't touch at the reference shift.
    """

    wheel: ProfileCurve
    rail: ProfileCurve
    nominal_radius: float
    inclination: float
    yaw: float
    reference_shift: float

    _NUMBERS: ClassVar = ("nominal_radius", "inclination", "yaw", "reference_shift")

    def __post_init__(self) -> None:
        _ = self._reference_height

    @property
    def description(self) -> str:
        """The geometry in a few words."""
        return f"wheel {self.wheel.name} on rail {self.rail.name}, inclined by {self.inclination:g} rad"

    @property
    def shaped(self) -> bool:
        """`distance` gives the undeformed distance."""
        return True

    @cached_property
    def search(self) -> ContactSearch:
        """The search for contact points."""
        return ContactSearch(
            wheel=self.wheel,
            rail=self.rail,
            nominal_radius=self.nominal_radius,
            inclination=self.inclination,
            yaw=self.yaw,
        )

    @cached_property
    def _reference_height(self) -> float:
        return self.search.find(self.reference_shift).ride_height

    @cached_property
    def _last(self) -> dict[float, FirstTouch]:
        return {}

    def _find(self, shift: float) -> FirstTouch:
        """Find the place unless it is the last one: a run asks for the place and then for the distance."""
        found = self._last.get(shift)
        if found is None:
            found = self.search.find(shift, tolerance=_FARTHEST)
            self._last.clear()
            self._last[shift] = found
        return found

    def place(self, shift: float) -> Place:
        """Find the place of first touch.

        Parameters
        ----------
        shift : float
            Lateral position of the wheel's tape circle from the middle of the rail's running surface, m, + to the
            field side.

        Returns
        -------
        Place

        Raises
        ------
        ParameterError
            If they touch at the end of a profile.
        """
        touch = self._find(float(shift))
        point = touch.points[0]
        return Place(
            y_wheel=point.y_wheel,
            y_rail=point.y_rail,
            angle=point.angle,
            rolling_radius=point.rolling_radius,
            curvature_x=point.curvature_x,
            curvature_y=point.curvature_y,
            ride_height=touch.ride_height,
            lift=touch.ride_height - self._reference_height,
            others=tuple(OtherPoint(other.y_wheel, other.y_rail, other.gap) for other in touch.points[1:]),
        )

    def distance(self, shift: float, x: NDArray, y: NDArray) -> NDArray:
        """Undeformed distance around the place of first touch, with the wheel as high as at the reference shift.

        It is negative where a wheel that has moved up a flank would have to be lifted. The lift counts in full, not
        its part along the normal, since a run takes the wheel's vertical displacement for its approach.

        Parameters
        ----------
        shift : float
            As for `place`, m.
        x : ndarray, shape (mx,)
            Positions along the rail from the place, m.
        y : ndarray, shape (my,)
            Positions across, in the tangent plane, m.

        Returns
        -------
        ndarray, shape (my, mx)
            m.
        """
        touch = self._find(float(shift))
        lift = touch.ride_height - self._reference_height
        return undeformed_distance(self.search, touch.points[0], x, y) - lift

    def to_parts(self) -> tuple[dict[str, Any], dict[str, NDArray]]:
        """Return a JSON-able description with its ``kind``, and the arrays, for a file."""
        meta: dict[str, Any] = {"kind": "profiles", **{name: float(getattr(self, name)) for name in self._NUMBERS}}
        arrays: dict[str, NDArray] = {}
        for body in ("wheel", "rail"):
            meta[body], own = getattr(self, body).to_parts()
            arrays.update({f"{body}_{name}": values for name, values in own.items()})
        return meta, arrays

    @classmethod
    def from_parts(cls, meta: Mapping[str, Any], arrays: Mapping[str, NDArray]) -> ProfileGeometry:
        """Rebuild it from `to_parts`."""
        curves = {}
        for body in ("wheel", "rail"):
            own = {
                name.removeprefix(f"{body}_"): values for name, values in arrays.items() if name.startswith(f"{body}_")
            }
            curves[body] = ProfileCurve.from_parts(meta[body], own)
        return cls(**curves, **{name: meta[name] for name in cls._NUMBERS})
