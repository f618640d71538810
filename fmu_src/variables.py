"""The variable table: every port, parameter and constant of the FMU, once, for every flavour.

The order of :data:`VARIABLES` is part of the interface: the FMI value reference of a variable is its place in the
table. Append; never move, rename or delete.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

__all__ = [
    "CONSTANTS",
    "ENUMERATIONS",
    "INPUTS",
    "OUTPUTS",
    "PARAMETERS",
    "UNITS",
    "VARIABLES",
    "Enumeration",
    "Variable",
    "structured_name",
]

FmiType = Literal["Real", "Integer", "Boolean", "String", "Enumeration"]
Role = Literal["input", "output", "parameter", "calculated", "constant"]

UNITS: dict[str, dict[str, int]] = {
    "1": {},
    "m": {"m": 1},
    "m2": {"m": 2},
    "1/m": {"m": -1},
    "m/s": {"m": 1, "s": -1},
    "s": {"s": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "rad": {"rad": 1},
}
"""Exponents of the SI base units for each unit in use."""


@dataclass(frozen=True)
class Enumeration:
    """An FMI enumeration whose values count from 1.

    Attributes
    ----------
    name : str
        Type name in the model description.
    items : tuple of (str, str)
        Item name (the value the model works with) and what it means.
    """

    name: str
    items: tuple[tuple[str, str], ...]

    def value(self, item: str) -> int:
        """Return the FMI value of an item name."""
        return [name for name, _ in self.items].index(item) + 1

    def item(self, value: int) -> str | None:
        """Return the item name of an FMI value, or None where there is none."""
        return self.items[value - 1][0] if 1 <= value <= len(self.items) else None


ENUMERATIONS: dict[str, Enumeration] = {
    "Coupling": Enumeration(
        "Coupling",
        (
            ("load", "the vehicle gives forces on the wheel; wheel inertia and suspension are in the FMU"),
            ("displacement", "the vehicle gives the motion of the rigid wheel, which it owns"),
        ),
    ),
    "InputExtrapolation": Enumeration(
        "InputExtrapolation",
        (
            ("hold", "inputs keep their value over the whole communication step"),
            ("linear", "inputs are extrapolated from the last two communication points"),
        ),
    ),
}


@dataclass(frozen=True)
class Variable:
    """One scalar variable.

    Attributes
    ----------
    name : str
        Final name, as in the interface.
    role : {"input", "output", "parameter", "calculated", "constant"}
        What the variable is for; "calculated" follows from the parameters.
    kind : {"Real", "Integer", "Boolean", "String", "Enumeration"}
        FMI type.
    description : str
        Meaning, one line.
    unit, quantity : str or None
        Key of :data:`UNITS`, and the physical quantity.
    minimum, maximum, nominal : float or None
        Range and size.
    enumeration : str or None
        Key of :data:`ENUMERATIONS` for the type "Enumeration".
    """

    name: str
    role: Role
    kind: FmiType
    description: str
    unit: str | None = None
    quantity: str | None = None
    minimum: float | None = None
    maximum: float | None = None
    nominal: float | None = None
    enumeration: str | None = None

    @property
    def causality(self) -> str:
        """FMI causality."""
        return {"constant": "local", "calculated": "calculatedParameter"}.get(self.role, self.role)

    @property
    def variability(self) -> str:
        """FMI variability: only Real variables can be continuous."""
        if self.role == "constant":
            return "constant"
        if self.role in ("parameter", "calculated"):
            return "fixed"
        return "continuous" if self.kind == "Real" else "discrete"

    @property
    def initial(self) -> str | None:
        """FMI 2.0 ``initial``; None where the standard forbids the attribute (inputs)."""
        if self.role == "input":
            return None
        return "calculated" if self.role in ("output", "calculated") else "exact"

    @property
    def access(self) -> str:
        """The FMI type whose get and set functions serve the variable: enumerations go through Integer."""
        return "Integer" if self.kind == "Enumeration" else self.kind


def _force(name: str, description: str, nominal: float = 1e4) -> Variable:
    return Variable(name, "output", "Real", description, "N", "Force", nominal=nominal)


def _displacement(body: str, axis: str, direction: str) -> Variable:
    text = f"displacement of the {body} at the contact from its own dynamics, {direction}"
    return Variable(f"{body}_disp_{axis}", "output", "Real", text, "m", "Length", nominal=1e-4)


_INPUTS = (
    Variable(
        "creepage_x",
        "input",
        "Real",
        "longitudinal creepage, velocity of the rail relative to the wheel over the speed, along the rolling direction",
        "1",
        nominal=1e-3,
    ),
    Variable(
        "creepage_y",
        "input",
        "Real",
        "lateral creepage, velocity of the rail relative to the wheel over the speed, positive to the field side",
        "1",
        nominal=1e-3,
    ),
    Variable("creepage_spin", "input", "Real", "spin creepage, rail relative to wheel", "1/m", nominal=0.1),
    Variable(
        "wheel_force_z",
        "input",
        "Real",
        "vertical load the vehicle puts on the wheel (preload), positive downwards; acts with coupling = load",
        "N",
        "Force",
        nominal=1e5,
    ),
    Variable(
        "wheel_force_x",
        "input",
        "Real",
        "longitudinal guiding force of the vehicle on a flexible wheel; acts with coupling = load, see balance",
        "N",
        "Force",
        nominal=1e4,
    ),
    Variable(
        "wheel_force_y",
        "input",
        "Real",
        "lateral guiding force of the vehicle on a flexible wheel; acts with coupling = load, see balance",
        "N",
        "Force",
        nominal=1e4,
    ),
    Variable(
        "wheel_z",
        "input",
        "Real",
        "vertical rigid-body displacement of the wheel from first touch, positive into the rail; acts with coupling = "
        "displacement",
        "m",
        "Length",
        nominal=1e-4,
    ),
    Variable(
        "wheel_y",
        "input",
        "Real",
        "lateral rigid-body displacement of the wheel, positive to the field side; with coupling = displacement it "
        "adds to lateral_shift; the slip takes its velocity from creepage_y",
        "m",
        "Length",
        nominal=1e-4,
    ),
    Variable(
        "lateral_shift",
        "input",
        "Real",
        "lateral displacement of the wheelset on the rail, positive to the field side",
        "m",
        "Length",
        nominal=1e-3,
    ),
)

_OUTPUTS = (
    _force("force_x", "longitudinal contact force on the rail at the communication point"),
    _force("force_y", "lateral contact force on the rail at the communication point, positive to the field side"),
    _force("force_z", "vertical contact force on the rail at the communication point, positive in compression", 1e5),
    _force("force_x_mean", "longitudinal contact force on the rail, mean over the communication step"),
    _force("force_y_mean", "lateral contact force on the rail, mean over the communication step"),
    _force("force_z_mean", "vertical contact force on the rail, mean over the communication step", 1e5),
    _force("force_z_max", "vertical contact force on the rail, largest value within the communication step", 1e5),
    _force("force_z_min", "vertical contact force on the rail, smallest value within the communication step", 1e5),
    Variable(
        "moment_spin", "output", "Real", "spin moment on the rail about the normal", "N.m", "Torque", nominal=10.0
    ),
    _displacement("wheel", "x", "along the rolling direction"),
    _displacement("wheel", "y", "positive to the field side"),
    _displacement("wheel", "z", "positive into the rail"),
    _displacement("rail", "x", "along the rolling direction"),
    _displacement("rail", "y", "positive to the field side"),
    _displacement("rail", "z", "positive downwards"),
    Variable(
        "contact_stiffness_z",
        "output",
        "Real",
        "tangent stiffness of the contact, change of the vertical force with the approach",
        "N/m",
        "TranslationalStiffness",
        nominal=1e9,
    ),
    Variable("contact_area", "output", "Real", "area in contact", "m2", "Area", minimum=0.0, nominal=1e-4),
    Variable(
        "contact_length",
        "output",
        "Real",
        "length of the contact in the rolling direction",
        "m",
        "Length",
        minimum=0.0,
        nominal=1e-2,
    ),
    Variable(
        "contact_width",
        "output",
        "Real",
        "width of the contact across the rail",
        "m",
        "Length",
        minimum=0.0,
        nominal=1e-2,
    ),
    Variable("pressure_max", "output", "Real", "largest contact pressure", "Pa", "Pressure", minimum=0.0, nominal=1e9),
    Variable(
        "slip_fraction",
        "output",
        "Real",
        "slipping share of the contact area",
        "1",
        minimum=0.0,
        maximum=1.0,
        nominal=1.0,
    ),
    Variable(
        "friction_power",
        "output",
        "Real",
        "frictional power, sum of traction times slip velocity over the contact, balanced with energy over a step",
        "W",
        "Power",
        nominal=1e3,
    ),
    Variable(
        "approach",
        "output",
        "Real",
        "rigid approach of the bodies at the nominal point, from first touch at the lateral shift of the case",
        "m",
        "Length",
        nominal=1e-4,
    ),
    Variable("in_contact", "output", "Boolean", "true while wheel and rail touch"),
    Variable("distance", "output", "Real", "rolled distance since the start", "m", "Length", nominal=1.0),
    Variable(
        "solver_iterations",
        "output",
        "Integer",
        "largest number of contact iterations within the communication step",
        minimum=0.0,
    ),
    Variable(
        "solver_residual",
        "output",
        "Real",
        "largest relative residual of the contact within the communication step",
        "1",
        minimum=0.0,
        nominal=1e-6,
    ),
)

_PARAMETERS = (
    Variable(
        "speed",
        "parameter",
        "Real",
        "rolling speed; shapes the precomputed model, so that only values the FMU was built for are taken",
        "m/s",
        "Velocity",
        minimum=0.0,
        nominal=10.0,
    ),
    Variable(
        "friction_coefficient",
        "parameter",
        "Real",
        "coefficient of friction; static one mu_s of a law that depends on the slip velocity",
        "1",
        minimum=0.0,
        nominal=0.1,
    ),
    Variable(
        "start_position",
        "parameter",
        "Real",
        "position along the rail at the start, from a sleeper; a multiple of dx",
        "m",
        "Length",
        nominal=1.0,
    ),
    Variable(
        "lateral_position",
        "parameter",
        "Real",
        "lateral position of the contact on a straight tread without lateral shift, from the tape circle; profiles "
        "decide for themselves",
        "m",
        "Length",
        nominal=1e-2,
    ),
    Variable(
        "coupling",
        "parameter",
        "Enumeration",
        "what the vehicle model gives: load or displacement",
        enumeration="Coupling",
    ),
    Variable(
        "balance",
        "parameter",
        "Boolean",
        "true: the steady tangential force at the start is taken as the guiding force of the vehicle, to which changes "
        "of wheel_force_x and wheel_force_y add; false: these are the guiding force",
    ),
    Variable(
        "input_extrapolation",
        "parameter",
        "Enumeration",
        "inputs within a communication step: hold or linear",
        enumeration="InputExtrapolation",
    ),
    Variable(
        "roughness_scale",
        "parameter",
        "Real",
        "factor on the combined roughness; of flats and joints under a Hertz contact on the path of a rigid wheel",
        "1",
        nominal=1.0,
    ),
    Variable(
        "random_seed", "parameter", "Integer", "seed of random roughness; -1: the seeds of the case", minimum=-1.0
    ),
    Variable(
        "record",
        "parameter",
        "Boolean",
        "true: write every internal step to <instance>_record.csv in the working directory",
    ),
)

_CALCULATED = (Variable("time_step", "calculated", "Real", "internal time step, dx over the speed", "s", "Time"),)

_CONSTANTS = (
    Variable("dx", "constant", "Real", "grid spacing along the rail", "m", "Length"),
    Variable("wheel_radius", "constant", "Real", "rolling radius of the wheel", "m", "Length"),
    Variable("wheel_model", "constant", "String", "model of the wheel"),
    Variable("track_model", "constant", "String", "model of the track"),
    Variable("normal_contact_model", "constant", "String", "model of the normal contact"),
    Variable("tangential_contact_model", "constant", "String", "model of the tangential contact"),
    Variable("case_title", "constant", "String", "title of the case the FMU was built from"),
)

# Added later than the table above.
_FRICTION = (
    Variable(
        "friction_method",
        "output",
        "Integer",
        "what found slip-velocity dependent friction, largest within the communication step: 0 nothing to find "
        "(constant friction, a point contact, no contact), 1 Newton's method, 2 Broyden's method, 3 direct iteration",
        minimum=0.0,
        maximum=3.0,
    ),
    Variable(
        "friction_solutions",
        "output",
        "Integer",
        "largest number of solutions of a step found within the communication step; 0 unless the case has "
        "friction.find_solutions",
        minimum=0.0,
    ),
    Variable(
        "friction_force_spread",
        "output",
        "Real",
        "largest difference between the tangential forces of these solutions",
        "N",
        "Force",
        minimum=0.0,
        nominal=1e3,
    ),
    Variable("friction_law", "constant", "String", "how friction depends on the slip velocity"),
)
_GEOMETRY = (
    Variable(
        "contact_y_wheel",
        "output",
        "Real",
        "lateral position of the contact on the wheel from the tape circle, positive to the field side",
        "m",
        "Length",
        nominal=1e-2,
    ),
    Variable(
        "contact_y_rail",
        "output",
        "Real",
        "lateral position of the contact on the rail from its axis, positive to the field side",
        "m",
        "Length",
        nominal=1e-2,
    ),
    Variable(
        "contact_angle",
        "output",
        "Real",
        "contact angle, positive where the flange climbs",
        "rad",
        "Angle",
        nominal=1e-2,
    ),
    Variable("rolling_radius", "output", "Real", "radius of the wheel at the contact", "m", "Length", nominal=0.1),
    Variable(
        "contact_points",
        "output",
        "Integer",
        "largest number of places within the communication step where the undeformed bodies overlap",
        minimum=0.0,
    ),
    Variable(
        "missed_overlap",
        "output",
        "Real",
        "largest overlap of the undeformed bodies at a place outside of the potential contact area, where no force "
        "is computed; should be 0",
        "m",
        "Length",
        minimum=0.0,
        nominal=1e-5,
    ),
    Variable("contact_geometry", "constant", "String", "shape of wheel and rail where they touch"),
)

VARIABLES: tuple[Variable, ...] = _INPUTS + _OUTPUTS + _PARAMETERS + _CALCULATED + _CONSTANTS + _FRICTION + _GEOMETRY
"""Every variable; the place in the tuple is the FMI value reference."""

INPUTS: tuple[str, ...] = tuple(variable.name for variable in VARIABLES if variable.role == "input")
OUTPUTS: tuple[str, ...] = tuple(variable.name for variable in VARIABLES if variable.role == "output")
PARAMETERS: tuple[str, ...] = tuple(variable.name for variable in VARIABLES if variable.role == "parameter")
CONSTANTS: tuple[str, ...] = tuple(variable.name for variable in VARIABLES if variable.role == "constant")


def structured_name(name: str) -> bool:
    """Return whether a name is a plain identifier, legal in FMI's structured naming and in every host."""
    return re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name) is not None
