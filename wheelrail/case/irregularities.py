"""The ``[[excitation]]`` tables of wheel flats, rail joints, dents, corrugation and out-of-round wheels."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from wheelrail.case.fields import LateralPosition, Section, as_tuple, quantity

__all__ = ["Corrugation", "Dent", "OutOfRound", "RailJoint", "WheelFlat"]

_ANGLE = "Angle by which the wheel has to turn from x = 0 until the middle is at the contact point"


class WheelFlat(Section):
    """A flat on the rotating wheel; comes once a turn."""

    type: Literal["wheel-flat"] = Field(description="Excitation: wheel flat")
    shape: Literal["new", "rounded", "measured"] = Field(
        description="new: a chord with sharp edges, its depth length^2 / (8 radius); rounded: a raised cosine; "
        "measured: from a file"
    )
    depth: float | None = quantity("Largest depth; of a new flat this or length is enough", "m", None, gt=0, le=0.02)
    length: float | None = quantity("Length along the tread", "m", None, gt=0, le=1)
    file: str | None = Field(
        default=None,
        description="measured: CSV file with positions along the tread from the middle and heights of one or several "
        "lines (negative: missing material), relative to the folder of the case file",
        min_length=1,
    )
    lateral: Annotated[tuple[LateralPosition, ...], BeforeValidator(as_tuple)] | None = Field(
        default=None,
        description="measured: positions of the file's lines across, m, from the tape circle, + to the field side, if "
        "its header does not name them (as y=-4mm_um)",
        min_length=2,
    )
    angle: float = quantity(_ANGLE, "rad")


class RailJoint(Section):
    """A joint of the rail: gap, step and dip."""

    type: Literal["rail-joint"] = Field(description="Excitation: rail joint")
    position: float = quantity("Middle of the joint along the rail, from the sleeper at 0", "m")
    gap: float = quantity("Width of the gap; 0: none", "m", 0.0, ge=0, le=0.1)
    step: float = quantity(
        "Height of the rail ahead above the rail behind; negative: lower", "m", 0.0, ge=-0.02, le=0.02
    )
    dip: float = quantity("Depth to which both rails dip towards the joint", "m", 0.0, ge=0, le=0.05)
    dip_length: float | None = quantity("With dip: its length on each side of the joint", "m", None, gt=0, le=5)
    step_length: float | None = quantity(
        "Length over which the rail ahead of a step comes back to level; left out: it does not", "m", None, gt=0, le=50
    )
    spacing: float | None = quantity(
        "Distance of joints, before and after this one; left out: one joint", "m", None, gt=0
    )


class Dent(Section):
    """A dent, squat or bump on rail or wheel."""

    type: Literal["dent"] = Field(description="Excitation: dent or squat, a raised cosine along and across")
    on: Literal["wheel", "rail"] = Field(description="Surface that has it; on the wheel it comes once a turn")
    depth: float = quantity("Depth in the middle; negative: a bump", "m", ge=-0.02, le=0.02)
    length: float = quantity("Length along the rail", "m", gt=0, le=2)
    width: float | None = quantity("Width across; left out: the same all across", "m", None, gt=0, le=0.2)
    position: float | None = quantity("rail only: its middle along the rail, from the sleeper at 0", "m", None)
    angle: float | None = quantity(f"wheel only: {_ANGLE[0].lower()}{_ANGLE[1:]}", "rad", None)
    lateral_position: float = quantity(
        "Its middle across, from the tape circle or the rail's axis", "m", 0.0, ge=-0.1, le=0.1
    )


class Corrugation(Section):
    """Corrugation over a stretch of rail."""

    type: Literal["corrugation"] = Field(description="Excitation: sinusoidal corrugation over a stretch of rail")
    amplitude: float = quantity("Amplitude", "m", ge=0, le=1e-2)
    wavelength: float = quantity("Wavelength, longer than 2 dx", "m", gt=0)
    start: float = quantity("Where it begins, from the sleeper at 0", "m")
    length: float = quantity("Its length, with the ramps of two waves at each end", "m", gt=0)


class OutOfRound(Section):
    """A wheel that is not round."""

    type: Literal["out-of-round"] = Field(description="Excitation: out-of-round wheel, harmonics of a turn")
    orders: Annotated[tuple[Annotated[int, Field(ge=1, le=2000)], ...], BeforeValidator(as_tuple)] = Field(
        description="Numbers of waves on the circumference", min_length=1
    )
    amplitudes: Annotated[tuple[Annotated[float, Field(ge=0, le=1e-2)], ...], BeforeValidator(as_tuple)] = Field(
        description="Amplitude of each, m", min_length=1
    )
    phases: Annotated[tuple[float, ...], BeforeValidator(as_tuple)] | None = Field(
        default=None, description="Phase of each at x = 0, rad; left out: 0", min_length=1
    )
