"""The table ``[wheel]`` of a case file: keys, units and ranges."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from wheelrail.case.fields import Section, as_tuple, quantity

__all__ = ["WHEEL_SECTIONS", "FlexibleWheel", "Rigid1DofWheel", "Rigid2DofWheel", "RigidWheel", "Wheel"]

WHEEL_SECTIONS = ("synthetic-c20",)
"""Sections that come with the program."""

Axis = Literal["x", "y", "z", "-x", "-y", "-z"]
_Ratio = Annotated[float, Field(ge=0)] | Literal["thesis"]


class RigidWheel(Section):
    """``[wheel]`` without dynamics of its own: the quasi-static case."""

    model: Literal["rigid"] = Field(description="Wheel model: no dynamics")
    radius: float = quantity("Rolling radius", "m", gt=0)


class Rigid1DofWheel(Section):
    """``[wheel]`` as a mass on the primary suspension (Pieringer 2011, section 3.2.1)."""

    model: Literal["rigid-1dof"] = Field(description="Wheel model: one mass on the primary suspension")
    radius: float = quantity("Rolling radius", "m", gt=0)
    mass: float = quantity("Wheel mass (half the wheelset)", "kg", gt=0)
    suspension_stiffness: float = quantity("Stiffness of the primary suspension; 0 = unsprung mass", "N/m", ge=0)
    suspension_damping: float = quantity("Damping of the primary suspension", "N s/m", ge=0)


class Rigid2DofWheel(Section):
    """``[wheel]`` as two masses; the small one at the contact stands for the wheel's flexibility."""

    model: Literal["rigid-2dof"] = Field(description="Wheel model: wheel mass and a small mass at the contact")
    radius: float = quantity("Rolling radius", "m", gt=0)
    mass: float = quantity("Wheel mass (half the wheelset)", "kg", gt=0)
    suspension_stiffness: float = quantity("Stiffness of the primary suspension; 0 = unsprung mass", "N/m", ge=0)
    suspension_damping: float = quantity("Damping of the primary suspension", "N s/m", ge=0)
    contact_mass: float = quantity("Mass at the contact", "kg", gt=0)
    contact_stiffness: float = quantity("Stiffness between the contact mass and the wheel mass", "N/m", gt=0)
    contact_damping: float = quantity("Damping between the contact mass and the wheel mass", "N s/m", gt=0)


class FlexibleWheel(Section):
    """``[wheel]`` as the sum of its modes, or by its receptances (Pieringer 2011, section 3.2.2).

    Where they come from is one of ``section``, ``modes`` and ``receptances``. The rigid-body motions on the suspension,
    each with all its keys or none, come on top of them.
    """

    model: Literal["flexible"] = Field(description="Wheel model: flexible, in three directions")
    radius: float = quantity("Rolling radius", "m", gt=0)
    section: str | None = Field(
        default=None,
        description='Cross-section whose modes are computed: "synthetic-c20", or a file (outline or mesh, r and axial '
        "position towards the flange in m, 0 at the tread centre), relative to the folder of the case file",
        min_length=1,
    )
    modes: str | None = Field(
        default=None,
        description="Or file with modes from another program: a table or a universal file, relative to the folder of "
        "the case file",
        min_length=1,
    )
    receptances: str | None = Field(
        default=None,
        description="Or file with measured or computed receptances at the contact: a table or a universal file, "
        "relative to the folder of the case file",
        min_length=1,
    )
    youngs_modulus: float | None = quantity("section only: Young's modulus", "Pa", None, gt=0)
    poisson_ratio: float | None = quantity("section only: Poisson's ratio", "1", None, ge=0, lt=0.5)
    density: float | None = quantity("section only: density", "kg/m3", None, gt=0)
    contact_position: float | None = quantity(
        "section only: lateral position of the contact on the tread, from its centre, positive to the field side",
        "m",
        None,
        ge=-0.1,
        le=0.1,
    )
    max_frequency: float | None = quantity(
        "section and modes: highest natural frequency of the modes; may be left out with modes",
        "Hz",
        None,
        gt=0,
        le=20e3,
    )
    damping: Literal["thesis"] | Annotated[float, Field(ge=0)] | dict[str, _Ratio] | None = Field(
        default=None,
        description="section, and modes whose file has none: damping ratios of the modes; one number for all, "
        '"thesis" (Pieringer 2011, eq. 3.9), or a table of these by name of the mode, "others" for the rest',
        json_schema_extra={
            "unit": "1",
            "allowed": 'a finite number >= 0, "thesis", or a table of these by name of the mode',
        },
    )
    element_size: float | None = quantity(
        "section only: side of the finite elements; left out: chosen by the program", "m", None, gt=0
    )
    node: int | None = quantity(
        "universal file only: node of the contact; needed if there are several", "1", None, ge=0
    )
    reference_node: int | None = quantity(
        "receptances in a universal file only: node of the force; left out: the node of the contact", "1", None, ge=0
    )
    axes: Annotated[tuple[Axis, Axis, Axis], BeforeValidator(as_tuple)] | None = Field(
        default=None,
        description="universal file only: its axes in rolling direction, to the field side and down",
        json_schema_extra={"allowed": 'a list of three of: x, y, z, -x, -y, -z, such as ["x", "-z", "y"]'},
    )
    units: Literal["m-kg-s", "mm-t-s", "mm-kg-s"] | None = Field(
        default=None, description="universal file only: its units, instead of those that it says itself"
    )
    mass_normalised: bool | None = Field(
        default=None,
        description="modes in a universal file only: shapes without a modal mass are mass-normalised",
    )
    remove_modes: Annotated[tuple[str, ...], BeforeValidator(as_tuple)] = Field(
        default=(),
        description='modes to leave out, by name, unless receptances become functions; "7,0,a" stands for both '
        "partners",
        json_schema_extra={"allowed": 'a list of names of modes, such as ["7,0,a"]'},
    )
    memory: float | None = quantity(
        "Length of the Green's functions of the flexible wheel; left out: modes without any cut, functions from "
        "receptances until they have decayed",
        "s",
        None,
        gt=0,
    )
    mass: float | None = quantity("Mass that moves vertically (half the wheelset)", "kg", None, gt=0)
    suspension_stiffness: float | None = quantity("Vertical stiffness of the primary suspension", "N/m", None, ge=0)
    suspension_damping: float | None = quantity("Vertical damping of the primary suspension", "N s/m", None, ge=0)
    lateral_mass: float | None = quantity(
        "Mass that moves laterally; the lateral keys left out: the rigid wheel does not", "kg", None, gt=0
    )
    lateral_stiffness: float | None = quantity("Lateral stiffness of the primary suspension", "N/m", None, ge=0)
    lateral_damping: float | None = quantity("Lateral damping of the primary suspension", "N s/m", None, ge=0)
    roll_inertia: float | None = quantity(
        "Moment of inertia about the rolling direction; the roll keys left out: the rigid wheel does not roll",
        "kg m2",
        None,
        gt=0,
    )
    roll_stiffness: float | None = quantity("Stiffness of the suspension against roll", "N m/rad", None, ge=0)
    roll_damping: float | None = quantity("Damping of the suspension against roll", "N m s/rad", None, ge=0)
    roll_arm_y: float | None = quantity("Contact from the wheelset's centre, to the field side", "m", None)
    roll_arm_z: float | None = quantity("Contact from the wheelset's centre, down", "m", None)
    low_frequency: Literal["static", "free"] | None = Field(
        default=None,
        description="receptances only: what goes on below their first line; static: the constant compliance of a wheel "
        "that is held; free: the motion of a free body, which the keys from mass on then describe on its suspension",
    )
    receptances_as: Literal["modes", "functions"] | None = Field(
        default=None,
        description="receptances only: what becomes of them; modes (as if left out): modes are fitted to them, fit-1, "
        "fit-2, ... by frequency, the way for a lightly damped wheel; functions: Green's functions of finite length, "
        "which need several lines within each resonance's half-power bandwidth",
    )
    # Last, since the name hides the function.
    quantity: Literal["receptance", "mobility", "accelerance"] | None = Field(
        default=None,
        description="receptances in a universal file only: what the functions are, if they don't say it",
    )


Wheel = Annotated[RigidWheel | Rigid1DofWheel | Rigid2DofWheel | FlexibleWheel, Field(discriminator="model")]
