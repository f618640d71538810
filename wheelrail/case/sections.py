"""The tables of a case file except wheel, track and ``[[excitation]]``: keys, units and ranges."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from wheelrail.case.fields import Section, as_tuple, quantity

__all__ = [
    "OUTPUT_NAMES",
    "Contact",
    "Creepage",
    "HertzContact",
    "Load",
    "Output",
    "Simulation",
    "WinklerContact",
]


class Simulation(Section):
    """``[simulation]``: speed, grid and length of the run."""

    speed: float = quantity("Rolling speed", "m/s", gt=0, le=200)
    dx: float = quantity("Grid spacing in the rolling direction; the time step is dx / speed", "m", gt=0)
    duration: float = quantity("Simulated time of a stand-alone run", "s", ge=0)
    start_position: float = quantity("First contact position, measured from a sleeper; a multiple of dx", "m")
    first_sample: Literal["kept", "zero"] = Field(
        default="kept",
        description="First sample of the Green's functions: kept, the displacement in the step of the force itself, "
        "with which force and displacement are solved together (with a tangential contact model not that which couples "
        "the vertical with another direction); zero, so that displacements follow from past forces only, as the thesis "
        "has it in combined vertical and tangential runs: a contact that sticks can then run away from step to step, "
        "and the compliance within the first sample is lost (of a wheel from receptances: that of all above them)",
    )


class _ContactBase(Section):
    rail_radius: float | None = quantity(
        "Transverse radius of the rail head; or give wheel_profile and rail_profile", "m", None, gt=0
    )
    wheel_transverse_radius: float | None = quantity(
        "With rail_radius: transverse radius of the wheel tread, convex; left out: straight (a cone)", "m", None, gt=0
    )
    wheel_profile: str | None = Field(
        default=None,
        description='Profile of the wheel: "s1002", "cone", "cylinder", or a file (MiniProf .whl, Simpack .prw, text '
        "or CSV with lateral position and height), relative to the folder of the case file",
        min_length=1,
    )
    rail_profile: str | None = Field(
        default=None,
        description='Profile of the rail head: "60e1", "bv50-like", "circular" (with rail_radius), or a file (MiniProf '
        ".ban, Simpack .prr, text or CSV), relative to the folder of the case file",
        min_length=1,
    )
    wheel_profile_mirrored: bool | None = Field(
        default=None,
        description="With a wheel_profile from a file: whether its y counts to the flange; left out: its flange tells",
    )
    rail_profile_mirrored: bool | None = Field(
        default=None,
        description="With a rail_profile from a file: whether its y counts to the gauge side, which its shape does not "
        "tell; left out: it does not, and a note says so",
    )
    profile_smoothing: float = quantity(
        "With profiles from files: wavelength at which smoothing halves an unevenness", "m", 5e-3, ge=1e-3, le=50e-3
    )
    conicity: float | None = quantity(
        "With the wheel profile cone: slope of the tread, radius falling to the field side", "1", None, ge=0, le=0.5
    )
    inclination: float | None = quantity(
        "With profiles: angle by which the rail leans towards the track's centre, 1:40 = 0.025; a rail profile that "
        "was measured in the track leans already: 0",
        "rad",
        None,
        ge=-0.2,
        le=0.2,
    )
    yaw: float = quantity("With profiles: yaw angle of the wheelset on the track", "rad", 0.0, ge=-0.1, le=0.1)
    youngs_modulus: float = quantity("Young's modulus of wheel and rail", "Pa", gt=0)
    poisson_ratio: float = quantity("Poisson's ratio of wheel and rail", "1", ge=0, lt=0.5)
    dy: float | None = quantity("Lateral element size; no effect with hertz and winkler", "m", None, gt=0)
    width: float | None = quantity(
        "Width of the potential contact area, an odd number of dy; no effect with hertz and winkler", "m", None, gt=0
    )
    prefilter: Literal["none", "average", "winkler"] = Field(
        default="none",
        description="Filter of the roughness before a hertz contact: none, the average over the nominal contact "
        "length, or the equivalent roughness of the Winkler bedding; winkler contact filters itself and takes none",
    )
    tangential: Literal["none", "transient", "friction-curve", "fastsim", "linear"] = Field(
        default="none",
        description="Tangential contact model: none (vertical only); transient rolling after Kalker (with half-space); "
        "a point contact that follows a friction curve, with contact compliance; FASTSIM; Kalker's linear theory",
    )
    lateral_shift: float = quantity(
        "Lateral displacement of the wheelset on the rail, positive to the field side; with profiles the position of "
        "the wheel's tape circle from the middle of the rail's running surface (see wheelrail profiles)",
        "m",
        0.0,
    )


class HertzContact(_ContactBase):
    """``[contact]`` by the Hertz spring."""

    normal: Literal["hertz"] = Field(description="Normal contact model: Hertz spring")
    length: float | None = quantity(
        "Length of the potential contact area, an odd number of dx; needed by the prefilters", "m", None, gt=0
    )


class WinklerContact(_ContactBase):
    """``[contact]`` by the two-dimensional Winkler bedding."""

    normal: Literal["winkler"] = Field(description="Normal contact model: Winkler bedding along the rail")
    length: float = quantity("Length of the potential contact area, an odd number of dx", "m", gt=0)


class HalfSpaceContact(_ContactBase):
    """``[contact]`` by the three-dimensional half-space."""

    normal: Literal["half-space"] = Field(description="Normal contact model: elastic half-space after Kalker")
    dy: float = quantity("Lateral element size", "m", gt=0)
    length: float = quantity("Length of the potential contact area, an odd number of dx", "m", gt=0)
    width: float = quantity("Width of the potential contact area, an odd number of dy", "m", gt=0)


class Load(Section):
    """``[load]``: what the vehicle puts on the wheel."""

    preload: float = quantity("Quasi-static vertical load on the wheel", "N", gt=0)
    coupling: Literal["load", "displacement"] = Field(
        description="load: the vehicle gives the load; displacement: it gives the wheel's rigid displacement"
    )


class Creepage(Section):
    """``[creepage]``: rail relative to wheel over the speed; no effect without a tangential contact model."""

    x: float = quantity("Longitudinal creepage", "1")
    y: float = quantity("Lateral creepage", "1")
    spin: float = quantity("Spin creepage", "1/m")


OutputName = Literal[
    "force_x",
    "force_y",
    "force_z",
    "force_x_mean",
    "force_y_mean",
    "force_z_mean",
    "force_z_max",
    "force_z_min",
    "moment_spin",
    "wheel_disp_x",
    "wheel_disp_y",
    "wheel_disp_z",
    "rail_disp_x",
    "rail_disp_y",
    "rail_disp_z",
    "contact_stiffness_z",
    "contact_area",
    "contact_length",
    "contact_width",
    "pressure_max",
    "slip_fraction",
    "friction_power",
    "approach",
    "in_contact",
    "distance",
    "solver_iterations",
    "solver_residual",
    "friction_method",
    "friction_solutions",
    "friction_force_spread",
    "contact_y_wheel",
    "contact_y_rail",
    "contact_angle",
    "rolling_radius",
    "contact_points",
    "missed_overlap",
]
OUTPUT_NAMES: tuple[str, ...] = OutputName.__args__
"""Output ports that can be recorded."""


class Output(Section):
    """``[output]``: what a stand-alone run writes."""

    record: Annotated[tuple[OutputName, ...], BeforeValidator(as_tuple)] = Field(
        default=("force_z",), description="Output ports to record, each once", min_length=1
    )
    file: str = Field(
        default="run.nc",
        description="Result file (netCDF), relative to the working folder; left out: named after the case file",
        min_length=1,
    )


Contact = Annotated[HertzContact | WinklerContact | HalfSpaceContact, Field(discriminator="normal")]
