"""Result of a rolling contact law."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["CreepForce", "require_positive"]


@dataclass(frozen=True)
class CreepForce:
    """Tangential load on the rail.

    Attributes
    ----------
    force_x, force_y : float
        Longitudinal (rolling direction) and lateral force, N.
    moment_spin : float
        Moment about the contact normal, integral of x p_y - y p_x, N m.
    """

    force_x: float
    force_y: float
    moment_spin: float


def require_positive(**values: float) -> None:
    """Raise `ValueError` that names the first value which is not positive and finite."""
    for name, value in values.items():
        if not 0.0 < value < float("inf"):
            raise ValueError(f"{name} must be positive and finite, it is {value:g}")
