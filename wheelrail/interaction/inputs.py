"""What a vehicle model gives at each communication point."""

from __future__ import annotations

from dataclasses import dataclass, fields

__all__ = ["INPUT_NAMES", "Inputs"]


@dataclass(slots=True)
class Inputs:
    """Inputs of a step; names, units and signs as the FMU's ports.

    Attributes
    ----------
    creepage_x, creepage_y : float
        Rail relative to wheel over v.
    creepage_spin : float
        1/m.
    wheel_force_x, wheel_force_y, wheel_force_z : float
        Quasi-static forces that the vehicle puts on the wheel, N; used with coupling by load.
    wheel_z, wheel_y : float
        Displacement of the wheel from first touch, m; used with coupling by displacement.
    lateral_shift : float
        m.
    """

    creepage_x: float = 0.0
    creepage_y: float = 0.0
    creepage_spin: float = 0.0
    wheel_force_x: float = 0.0
    wheel_force_y: float = 0.0
    wheel_force_z: float = 0.0
    wheel_y: float = 0.0
    wheel_z: float = 0.0
    lateral_shift: float = 0.0


INPUT_NAMES = tuple(field.name for field in fields(Inputs))
