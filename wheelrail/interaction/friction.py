"""Friction of a case: the static coefficient, and what depends on the slip velocity."""

from __future__ import annotations

import numpy as np

from ..case import Case
from ..case.friction_sections import (
    ConstantFriction,
    ExponentialFriction,
    KraftFriction,
    PolachFriction,
    RationalFriction,
    TableFriction,
)
from ..contact.friction.laws import (
    ConstantLaw,
    ExponentialLaw,
    FrictionLaw,
    KraftLaw,
    PolachLaw,
    RationalLaw,
    TableLaw,
)
from ..contact.friction.memory import FrictionMemory
from ..contact.friction.settings import SlipFriction

__all__ = ["largest_friction_of", "law_of", "slip_friction_of", "static_friction_of"]


def static_friction_of(case: Case) -> float:
    """Return the static coefficient mu_s of a case; 0 without friction."""
    match case.friction:
        case None:
            return 0.0
        case TableFriction(coefficients=coefficients):
            return coefficients[0]
        case friction:
            return friction.coefficient


def law_of(case: Case) -> FrictionLaw:
    """Return the friction law of a case; constant if it has none."""
    match case.friction:
        case KraftFriction(normalise=normalise):
            return KraftLaw(normalise)
        case PolachFriction(ratio=ratio, decay=decay):
            return PolachLaw(ratio, decay)
        case ExponentialFriction(ratio=ratio, half_speed=half_speed):
            return ExponentialLaw(ratio, half_speed)
        case RationalFriction() as law:
            return RationalLaw(law.ratio, law.half_speed, law.square_share, law.square_half_speed or law.half_speed)
        case TableFriction(speeds=speeds, coefficients=coefficients):
            return TableLaw(speeds, tuple(value / coefficients[0] for value in coefficients))
    return ConstantLaw()


def largest_friction_of(case: Case) -> float:
    """Return the largest coefficient that the law of a case gives up to 100 m/s."""
    ratio, _ = law_of(case).evaluate(np.concatenate([[0.0], np.geomspace(1e-4, 100.0, 2000)]))
    return static_friction_of(case) * float(ratio.max())


def slip_friction_of(case: Case) -> SlipFriction | None:
    """Return how a case treats slip-velocity dependent friction; None if its friction is constant."""
    friction = case.friction
    if friction is None or isinstance(friction, ConstantFriction):
        return None
    memory = None
    if friction.memory_distance > 0.0 and friction.memory_speed is not None:
        memory = FrictionMemory(friction.memory_distance, friction.memory_speed)
    return SlipFriction(law_of(case), memory, friction.solver, friction.branch, friction.find_solutions)
