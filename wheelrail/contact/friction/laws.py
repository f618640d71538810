"""Friction laws: the coefficient over the slip velocity, and its slope.

Every law is a shape, mu(s) / mu_s, with s = |S| / dt >= 0 the slip velocity in m/s; the static coefficient mu_s is the
parameter of a run. Shapes need not be 1 at s = 0 (Kraft's as printed is 0.7).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "ConstantLaw",
    "ExponentialLaw",
    "FrictionLaw",
    "KraftLaw",
    "PolachLaw",
    "RationalLaw",
    "TableLaw",
    "falls",
    "law_from_parts",
    "steepest_fall",
]

_LN2 = math.log(2.0)


class FrictionLaw(Protocol):
    """Shape of a friction law."""

    @property
    def kind(self) -> str:
        """Name in the case file."""
        ...

    def evaluate(self, speed: NDArray) -> tuple[NDArray, NDArray]:
        """Return mu / mu_s and its slope in s/m at slip velocities in m/s, >= 0; all of one shape."""
        ...

    def to_parts(self) -> dict[str, Any]:
        """Return a JSON-able description with its ``kind``."""
        ...


@dataclass(frozen=True)
class ConstantLaw:
    """Coulomb friction: mu = mu_s."""

    kind = "constant"

    def evaluate(self, speed: NDArray) -> tuple[NDArray, NDArray]:
        """Return 1 and 0."""
        return np.ones_like(speed), np.zeros_like(speed)

    def to_parts(self) -> dict[str, Any]:
        """Return the kind."""
        return {"kind": self.kind}


@dataclass(frozen=True)
class KraftLaw:
    """Kraft's law in the form of Pieringer (2011), eq. 3.57: mu / mu_s = 20 / (100 + s^2) + 0.1 / (0.2 + s).

    Parameters
    ----------
    normalise : bool
        Divide by 0.7, the printed formula's value at s = 0.
    """

    normalise: bool
    kind = "kraft"

    def evaluate(self, speed: NDArray) -> tuple[NDArray, NDArray]:
        """Return mu / mu_s and its slope."""
        scale = 1.0 / 0.7 if self.normalise else 1.0
        wide, narrow = 1.0 / (100.0 + speed * speed), 1.0 / (0.2 + speed)
        value = scale * (20.0 * wide + 0.1 * narrow)
        return value, -scale * (40.0 * speed * wide * wide + 0.1 * narrow * narrow)

    def to_parts(self) -> dict[str, Any]:
        """Return kind and parameters."""
        return {"kind": self.kind, **asdict(self)}


@dataclass(frozen=True)
class PolachLaw:
    """Polach (2005): mu / mu_s = (1 - A) exp(-B s) + A.

    Parameters
    ----------
    ratio : float
        A, limit of mu / mu_s at high slip velocity.
    decay : float
        B in s/m.
    """

    ratio: float
    decay: float
    kind = "polach"

    def evaluate(self, speed: NDArray) -> tuple[NDArray, NDArray]:
        """Return mu / mu_s and its slope."""
        falling = (1.0 - self.ratio) * np.exp(-self.decay * speed)
        return falling + self.ratio, -self.decay * falling

    def to_parts(self) -> dict[str, Any]:
        """Return kind and parameters."""
        return {"kind": self.kind, **asdict(self)}


@dataclass(frozen=True)
class ExponentialLaw:
    """Exponential fall: mu / mu_s = A + (1 - A) 2^(-s / s_h) (Vollebregt and Schuttelaars 2012).

    Parameters
    ----------
    ratio : float
        A, limit of mu / mu_s at high slip velocity.
    half_speed : float
        s_h in m/s, at which half of the fall is done.
    """

    ratio: float
    half_speed: float
    kind = "exponential"

    def evaluate(self, speed: NDArray) -> tuple[NDArray, NDArray]:
        """Return mu / mu_s and its slope."""
        return PolachLaw(self.ratio, _LN2 / self.half_speed).evaluate(speed)

    def to_parts(self) -> dict[str, Any]:
        """Return kind and parameters."""
        return {"kind": self.kind, **asdict(self)}


@dataclass(frozen=True)
class RationalLaw:
    """Rational fall: mu / mu_s = A + (1 - A) [(1 - q) / (1 + s / s_h) + q / (1 + (s / s_q)^2)].

    The form of Vollebregt and Schuttelaars (2012). Kraft's normalised law is A = 0, q = 2/7, s_h = 0.2 m/s and
    s_q = 10 m/s.

    Parameters
    ----------
    ratio : float
        A, limit of mu / mu_s at high slip velocity.
    half_speed : float
        s_h in m/s.
    square_share : float
        q, share of the fall that goes with the square of the slip velocity.
    square_half_speed : float
        s_q in m/s; without effect if ``square_share`` is 0.
    """

    ratio: float
    half_speed: float
    square_share: float
    square_half_speed: float
    kind = "rational"

    def evaluate(self, speed: NDArray) -> tuple[NDArray, NDArray]:
        """Return mu / mu_s and its slope."""
        first, square = (1.0 - self.ratio) * (1.0 - self.square_share), (1.0 - self.ratio) * self.square_share
        u, w = speed / self.half_speed, speed / self.square_half_speed
        narrow, wide = 1.0 / (1.0 + u), 1.0 / (1.0 + w * w)
        slope = -first * narrow * narrow / self.half_speed - 2.0 * square * w * wide * wide / self.square_half_speed
        return self.ratio + first * narrow + square * wide, slope

    def to_parts(self) -> dict[str, Any]:
        """Return kind and parameters."""
        return {"kind": self.kind, **asdict(self)}


@dataclass(frozen=True)
class TableLaw:
    """Points, joined by straight lines; constant beyond the last.

    Parameters
    ----------
    speeds : sequence of float
        m/s, rising from 0.
    ratios : sequence of float
        mu / mu_s at the speeds.
    """

    speeds: tuple[float, ...]
    ratios: tuple[float, ...]
    kind = "table"

    @cached_property
    def _points(self) -> tuple[NDArray, NDArray, NDArray]:
        speeds, ratios = np.array(self.speeds), np.array(self.ratios)
        return speeds, ratios, np.append(np.diff(ratios) / np.diff(speeds), 0.0)

    def evaluate(self, speed: NDArray) -> tuple[NDArray, NDArray]:
        """Return mu / mu_s and its slope, at a point that to its right."""
        speeds, ratios, slopes = self._points
        at = np.searchsorted(speeds, speed, side="right") - 1
        slope = slopes[at]
        return ratios[at] + slope * (speed - speeds[at]), slope

    def to_parts(self) -> dict[str, Any]:
        """Return kind and parameters."""
        return {"kind": self.kind, "speeds": list(self.speeds), "ratios": list(self.ratios)}


_KINDS: dict[str, Any] = {
    law.kind: law for law in (ConstantLaw, KraftLaw, PolachLaw, ExponentialLaw, RationalLaw, TableLaw)
}


def law_from_parts(meta: Mapping[str, Any]) -> FrictionLaw:
    """Rebuild a law that ``to_parts`` described.

    Raises
    ------
    KeyError, TypeError
        If the kind is unknown or parameters are missing.
    """
    values = {name: _tuple(value) for name, value in meta.items() if name != "kind"}
    return _KINDS[meta["kind"]](**values)


def _tuple(value: Any) -> Any:
    return tuple(value) if isinstance(value, Sequence) and not isinstance(value, str) else value


def falls(law: FrictionLaw) -> bool:
    """Tell whether friction falls with the slip velocity anywhere between 0 and 100 m/s."""
    return steepest_fall(law, highest_speed=100.0) > 0.0


def steepest_fall(law: FrictionLaw, *, highest_speed: float) -> float:
    """Return the largest -s d(mu/mu_s)/ds for slip velocities up to ``highest_speed`` in m/s.

    Sliding with a friction memory d_c on a contact of tangential stiffness k_t under the normal force N is stable for
    small disturbances if k_t > mu_s N (-s d(mu/mu_s)/ds) / d_c (Rice and Ruina 1983, J. Appl. Mech. 50, 343-349).
    """
    speed = np.geomspace(1e-9 * highest_speed, highest_speed, 4000)
    if isinstance(law, TableLaw):  # steepest at the end of a line
        ends = np.array([end for end in law.speeds[1:] if end <= highest_speed])
        speed = np.concatenate([speed, np.nextafter(ends, 0.0)])
    return max(float(np.max(-speed * law.evaluate(speed)[1])), 0.0)
