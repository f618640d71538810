"""The table ``[track]`` of a case file: keys, units and ranges."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from wheelrail.case.fields import Section, quantity

__all__ = ["RAIL_SECTIONS", "DiscreteTrack", "RigidTrack", "Track", "WaveguideTrack"]

RAIL_SECTIONS = ("60e1", "bv50-like")
"""Sections that come with the program."""


class RigidTrack(Section):
    """``[track]`` without dynamics of its own."""

    model: Literal["rigid"] = Field(description="Track model: no dynamics")


class DiscreteTrack(Section):
    """``[track]`` as a Rayleigh-Timoshenko rail on discrete supports (Pieringer 2011, section 3.3.1)."""

    model: Literal["discrete"] = Field(description="Track model: Timoshenko rail on pads, sleepers and ballast")
    bending_stiffness: float = quantity("Bending stiffness EI of the rail", "N m2", gt=0)
    shear_stiffness: float = quantity("Shear stiffness kappa G A of the rail", "N", gt=0)
    mass_per_length: float = quantity("Mass per length of the rail", "kg/m", gt=0)
    rotary_inertia: float = quantity("Rotary inertia per length rho I of the rail", "kg m", gt=0)
    sleeper_spacing: float = quantity("Sleeper spacing; a multiple of dx", "m", gt=0)
    bays: int = quantity("Number of sleeper bays of the modelled track", "1", ge=20, multiple_of=2)
    elements_per_bay: int = quantity("Beam elements per sleeper bay", "1", ge=1)
    pad_stiffness: float = quantity("Stiffness of one rail pad", "N/m", gt=0)
    pad_damping: float = quantity("Damping of one rail pad", "N s/m", ge=0)
    sleeper_mass: float = quantity("Sleeper mass per rail (half a sleeper)", "kg", gt=0)
    ballast_stiffness: float = quantity("Ballast stiffness under half a sleeper", "N/m", gt=0)
    ballast_damping: float = quantity("Ballast damping under half a sleeper", "N s/m", ge=0)
    memory: float | None = quantity(
        "Length of the moving Green's functions; left out: until they have decayed to a stated energy", "s", None, gt=0
    )


class WaveguideTrack(Section):
    """``[track]`` as a rail with a deforming cross-section, in three directions (Pieringer 2011, section 3.3.2).

    It lies on a continuous elastic layer as in the thesis, or on discrete supports: pads, sleepers and ballast.
    """

    model: Literal["waveguide"] = Field(
        description="Track model: waveguide finite elements of the rail's cross-section"
    )
    section: str = Field(
        description='Cross-section: "60e1", "bv50-like", or a file (outline or mesh, lateral position and height in '
        "m), relative to the folder of the case file",
        min_length=1,
    )
    youngs_modulus: float = quantity("Young's modulus of the rail", "Pa", gt=0)
    poisson_ratio: float = quantity("Poisson's ratio of the rail", "1", ge=0, lt=0.5)
    density: float = quantity("Density of the rail", "kg/m3", gt=0)
    loss_factor: float = quantity("Damping loss factor of the rail", "1", ge=0, lt=1)
    contact_position: float = quantity(
        "Lateral position of the contact on the head, from the rail's centre, positive to the field side of the wheel",
        "m",
        ge=-0.1,
        le=0.1,
    )
    max_frequency: float = quantity("Highest frequency of the waves that are included", "Hz", gt=0, le=20e3)
    support: Literal["continuous", "discrete"] = Field(
        description="continuous: an elastic layer under the foot; discrete: pads on sleepers on ballast"
    )
    pad_youngs_modulus: float | None = quantity("continuous only: Young's modulus of the layer", "Pa", None, gt=0)
    pad_poisson_ratio: float | None = quantity("continuous only: Poisson's ratio of the layer", "1", None, ge=0, lt=0.5)
    pad_density: float | None = quantity("continuous only: density of the layer", "kg/m3", None, gt=0)
    pad_loss_factor: float | None = quantity("continuous only: damping loss factor of the layer", "1", None, ge=0, lt=1)
    pad_thickness: float | None = quantity("continuous only: thickness of the layer", "m", None, gt=0)
    pad_width: float | None = quantity(
        "Width of the layer or the pads; left out with continuous support: the rail's foot", "m", None, gt=0
    )
    sleeper_spacing: float | None = quantity("discrete only: sleeper spacing, a multiple of dx", "m", None, gt=0)
    pad_stiffness: float | None = quantity("discrete only: vertical stiffness of one rail pad", "N/m", None, gt=0)
    pad_lateral_stiffness: float | None = quantity("discrete only: lateral stiffness of one pad", "N/m", None, gt=0)
    pad_longitudinal_stiffness: float | None = quantity("discrete only: its longitudinal stiffness", "N/m", None, gt=0)
    pad_damping: float | None = quantity("discrete only: vertical damping of one rail pad", "N s/m", None, ge=0)
    pad_lateral_damping: float | None = quantity("discrete only: lateral damping of one pad", "N s/m", None, ge=0)
    pad_longitudinal_damping: float | None = quantity("discrete only: its longitudinal damping", "N s/m", None, ge=0)
    sleeper_mass: float | None = quantity("discrete only: sleeper mass per rail (half a sleeper)", "kg", None, gt=0)
    ballast_stiffness: float | None = quantity(
        "discrete only: vertical ballast stiffness under half a sleeper", "N/m", None, gt=0
    )
    ballast_lateral_stiffness: float | None = quantity("discrete only: its lateral stiffness", "N/m", None, gt=0)
    ballast_longitudinal_stiffness: float | None = quantity(
        "discrete only: its longitudinal stiffness", "N/m", None, gt=0
    )
    ballast_damping: float | None = quantity(
        "discrete only: vertical ballast damping under half a sleeper", "N s/m", None, ge=0
    )
    ballast_lateral_damping: float | None = quantity("discrete only: its lateral damping", "N s/m", None, ge=0)
    ballast_longitudinal_damping: float | None = quantity(
        "discrete only: its longitudinal damping", "N s/m", None, ge=0
    )
    memory: float | None = quantity(
        "Length of the moving Green's functions; left out: until they have decayed to a stated energy", "s", None, gt=0
    )


Track = Annotated[RigidTrack | DiscreteTrack | WaveguideTrack, Field(discriminator="model")]
