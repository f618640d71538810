"""The table ``[friction]`` of a case file: keys, units and ranges."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from wheelrail.case.fields import Section, as_tuple, quantity

__all__ = [
    "ConstantFriction",
    "ExponentialFriction",
    "Friction",
    "KraftFriction",
    "PolachFriction",
    "RationalFriction",
    "TableFriction",
]


class _SlipDependent(Section):
    memory_distance: float = quantity(
        "Sliding distance over which the friction coefficient of a particle follows the law; 0: none, the coefficient "
        "jumps with the slip and results depend on the grid",
        "m",
        0.0,
        ge=0,
    )
    memory_speed: float | None = quantity(
        "With memory_distance: speed with which the coefficient recovers where nothing slips; 1e-3 is usual",
        "m/s",
        None,
        gt=0,
    )
    solver: Literal["newton", "broyden"] = Field(
        default="newton",
        description="transient only: newton, for tractions and coefficients at once; broyden, the thesis' way: contact "
        "and law in turn by Broyden's method, with relaxed direct iteration as fall-back",
    )
    branch: Literal["previous", "low-slip", "high-slip"] = Field(
        default="previous",
        description="transient only: which solution of a step where there are several: the one reached from the slip "
        "of the step before, from full stick, or from full slip",
    )
    find_solutions: bool = Field(
        default=False,
        description="transient only: at every step look for the solutions with the least and the most slip and that "
        "near the step before, and report how many differ and how far their forces do; takes several times as long",
    )


class ConstantFriction(_SlipDependent):
    """``[friction]`` after Coulomb; without effect while there is no tangential contact model.

    It takes the keys that the other laws share, without effect, so that laws can be swapped.
    """

    law: Literal["constant"] = Field(description="Friction law: constant coefficient")
    coefficient: float = quantity("Friction coefficient", "1", ge=0)


class KraftFriction(_SlipDependent):
    """``[friction]`` after Kraft (Pieringer 2011, eq. 3.57)."""

    law: Literal["kraft"] = Field(
        description="Friction law: Kraft's, mu = coefficient (20 / (100 + s^2) + 0.1 / (0.2 + s)), s in m/s"
    )
    coefficient: float = quantity("Static friction coefficient mu_s", "1", ge=0)
    normalise: bool = Field(
        description="true: divided by 0.7, so that mu without slip is the coefficient; false: as printed, 0.7 of it"
    )


class PolachFriction(_SlipDependent):
    """``[friction]`` after Polach (2005)."""

    law: Literal["polach"] = Field(
        description="Friction law: Polach's, mu = coefficient ((1 - ratio) exp(-decay s) + ratio)"
    )
    coefficient: float = quantity("Static friction coefficient", "1", ge=0)
    ratio: float = quantity("Coefficient at high slip velocity over the static one (A)", "1", ge=0, le=1)
    decay: float = quantity("Decay over the slip velocity (B)", "s/m", ge=0)


class ExponentialFriction(_SlipDependent):
    """``[friction]`` that falls exponentially, by the speed of half the fall."""

    law: Literal["exponential"] = Field(
        description="Friction law: mu = coefficient (ratio + (1 - ratio) 2^(-s / half_speed))"
    )
    coefficient: float = quantity("Static friction coefficient", "1", ge=0)
    ratio: float = quantity("Coefficient at high slip velocity over the static one", "1", ge=0, le=1)
    half_speed: float = quantity("Slip velocity at which half of the fall is done", "m/s", gt=0)


class RationalFriction(_SlipDependent):
    """``[friction]`` that falls as a rational function."""

    law: Literal["rational"] = Field(
        description="Friction law: mu = coefficient (ratio + (1 - ratio) ((1 - square_share) / (1 + s / half_speed) + "
        "square_share / (1 + (s / square_half_speed)^2)))"
    )
    coefficient: float = quantity("Static friction coefficient", "1", ge=0)
    ratio: float = quantity("Coefficient at high slip velocity over the static one", "1", ge=0, le=1)
    half_speed: float = quantity("Slip velocity at which half of the first part's fall is done", "m/s", gt=0)
    square_share: float = quantity("Share of the fall that goes with the square of the slip", "1", 0.0, ge=0, le=1)
    square_half_speed: float | None = quantity(
        "With square_share: slip velocity at which half of that part's fall is done", "m/s", None, gt=0
    )


class TableFriction(_SlipDependent):
    """``[friction]`` from points."""

    law: Literal["table"] = Field(
        description="Friction law: points joined by straight lines, constant beyond the last speed"
    )
    speeds: Annotated[tuple[Annotated[float, Field(ge=0)], ...], BeforeValidator(as_tuple)] = Field(
        description="Slip velocities, rising from 0 (m/s)",
        min_length=2,
        json_schema_extra={
            "unit": "m/s",
            "allowed": "a list of two or more finite numbers >= 0 (m/s), rising from 0",
            "allowed_entry": "a finite number >= 0 (m/s)",
        },
    )
    coefficients: Annotated[tuple[Annotated[float, Field(gt=0)], ...], BeforeValidator(as_tuple)] = Field(
        description="Friction coefficients at these speeds; the first is the static one",
        min_length=2,
        json_schema_extra={
            "unit": "1",
            "allowed": "a list of two or more finite numbers > 0",
            "allowed_entry": "a finite number > 0",
        },
    )


Friction = Annotated[
    ConstantFriction | KraftFriction | PolachFriction | ExponentialFriction | RationalFriction | TableFriction,
    Field(discriminator="law"),
]
