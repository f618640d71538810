"""Parameters of a run that may be changed after the model is built."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from numbers import Real
from typing import Any

from ..errors import ParameterError

__all__ = ["COUPLINGS", "EXTRAPOLATIONS", "OWN_SEEDS", "Parameters", "is_finite_number"]

COUPLINGS = ("load", "displacement")
EXTRAPOLATIONS = ("hold", "linear")
OWN_SEEDS = -1  # random_seed that leaves every random line its seed of the case file


@dataclass(frozen=True)
class Parameters:
    """What is fixed during a run but not when the model is built.

    Attributes
    ----------
    speed : float
        m/s.
    friction_coefficient : float
        Without effect until a tangential contact model uses it.
    start_position : float
        m along the rail from a sleeper; a multiple of dx.
    lateral_position : float
        m; without effect until the contact geometry uses it.
    coupling : {"load", "displacement"}
        What the vehicle model gives: the load on the wheel, or the wheel's displacement.
    balance : bool
        Take the steady tangential force at the start as the vehicle's guiding force.
    input_extrapolation : {"hold", "linear"}
        Inputs within a communication step.
    roughness_scale : float
        Factor on all excitation; of flats and joints under a Hertz contact on the path of a rigid wheel.
    random_seed : int
        Seed of all random lines; -1 leaves each its own of the case file.
    record : bool
        Write the internal time history.
    """

    speed: float
    friction_coefficient: float
    start_position: float
    lateral_position: float
    coupling: str
    balance: bool
    input_extrapolation: str
    roughness_scale: float
    random_seed: int
    record: bool

    def changed(self, **values: Any) -> Parameters:
        """Return a copy with some values changed.

        Raises
        ------
        ParameterError
            If a name is unknown or a value not allowed.
        """
        known = asdict(self)
        checked = {}
        for name, value in values.items():
            if name not in known:
                raise ParameterError(name, value, f"no such parameter; there are: {', '.join(known)}")
            checked[name] = _checked(name, value)
        return replace(self, **checked)

    def to_dict(self) -> dict[str, Any]:
        """Plain values by name."""
        return asdict(self)


def is_finite_number(value: object) -> bool:
    """Tell whether a value can be used as a finite float; a truth value can't."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number beyond the range of floats
        return False


def _checked(name: str, value: Any) -> Any:
    if name in ("coupling", "input_extrapolation"):
        allowed = COUPLINGS if name == "coupling" else EXTRAPOLATIONS
        if value not in allowed:
            raise ParameterError(name, value, f"allowed: {', '.join(allowed)}")
        return value
    if name in ("balance", "record"):
        if not isinstance(value, bool | int) or value not in (0, 1):
            raise ParameterError(name, value, "allowed: true, false")
        return bool(value)
    if name == "random_seed":
        if not isinstance(value, int) or isinstance(value, bool) or value < OWN_SEEDS:
            raise ParameterError(name, value, f"allowed: whole numbers >= 0, or {OWN_SEEDS} for the case's own seeds")
        return value
    if not is_finite_number(value):
        raise ParameterError(name, value, "a finite number is needed")
    if name == "speed" and value <= 0.0:
        raise ParameterError(name, value, "must be > 0 m/s")
    if name == "friction_coefficient" and value < 0.0:
        raise ParameterError(name, value, "must be >= 0")
    return float(value)
