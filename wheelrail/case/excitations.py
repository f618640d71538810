"""The ``[[excitation]]`` tables of a case file: keys, units and ranges."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from wheelrail.case.fields import LateralPosition, Section, as_tuple, quantity
from wheelrail.case.irregularities import Corrugation, Dent, OutOfRound, RailJoint, WheelFlat

__all__ = ["SPECTRUM_NAMES", "Excitation", "Measured", "Sinusoid", "Spectrum"]


class Sinusoid(Section):
    """A sinusoidal combined roughness."""

    type: Literal["sinusoid"] = Field(description="Excitation: sinusoidal roughness")
    amplitude: float = quantity("Amplitude", "m", ge=0)
    wavelength: float = quantity("Wavelength, longer than 2 dx", "m", gt=0)


class Measured(Section):
    """A measured roughness line of wheel or rail."""

    type: Literal["measured"] = Field(description="Excitation: measured roughness line")
    file: str = Field(description="Data file, relative to the folder of the case file", min_length=1)
    on: Literal["wheel", "rail"] = Field(description="Surface that was measured; a wheel's line repeats every turn")
    column: Annotated[int, Field(ge=1)] | Annotated[str, Field(min_length=1)] | None = Field(
        default=None, description="Height column of the file, by name or by number from 1; left out: the first"
    )
    lateral: Annotated[tuple[LateralPosition, ...], BeforeValidator(as_tuple)] | None = Field(
        default=None,
        description="Positions of the file's lines across, m, one for each height column, if its header does not name "
        "them (as y=-4mm_um): from the tape circle or the rail's axis, + to the field side. With positions all lines "
        "are used, without only the first",
        min_length=2,
    )
    beyond_end: Literal["stop", "repeat"] | None = Field(
        default=None, description="rail only: what happens past the end of the line; left out: stop"
    )

    @model_validator(mode="before")
    @classmethod
    def _rail_stops(cls, data: Any) -> Any:
        # A wheel's line has no end, so the default depends on the surface.
        if isinstance(data, dict) and data.get("on") == "rail" and data.get("beyond_end") is None:
            return {**data, "beyond_end": "stop"}
        return data


SpectrumName = Literal[
    "iso3095-2013-limit",
    "cnossos-rail-iso3095-2013",
    "cnossos-rail-average-network",
    "cnossos-wheel-cast-iron-tread",
    "cnossos-wheel-composite-block",
    "cnossos-wheel-disc-brake",
]
SPECTRUM_NAMES: tuple[str, ...] = SpectrumName.__args__
"""Third-octave roughness spectra that come with the program."""


class Spectrum(Section):
    """A random roughness line with a given third-octave spectrum."""

    type: Literal["spectrum"] = Field(description="Excitation: roughness synthesised from a third-octave spectrum")
    name: SpectrumName | None = Field(default=None, description="Spectrum that comes with the program; or give file")
    file: str | None = Field(
        default=None,
        description="CSV file with wavelengths and levels, relative to the folder of the case file; or give name",
        min_length=1,
    )
    on: Literal["wheel", "rail"] = Field(description="Surface that is rough; a wheel's line repeats every turn")
    seed: int = quantity("Seed of the random phases", "1", ge=0, le=2**31 - 1)
    length: float | None = quantity(
        "rail only: length after which the line repeats, a multiple of dx; left out: chosen by the program",
        "m",
        None,
        gt=0,
    )
    lines: Annotated[tuple[LateralPosition, ...], BeforeValidator(as_tuple)] | None = Field(
        default=None,
        description="Positions of several parallel lines across, m, each with the given spectrum: from the tape circle "
        "or the rail's axis, + to the field side; left out: one line, the same all across",
        min_length=2,
    )
    coherence: Annotated[float, Field(ge=0)] | Literal["none"] | None = Field(
        default=None,
        description="With lines: decay c of their coherence gamma = exp(-c k |dy|) with the wavenumber k and the "
        'distance dy; 0: all lines the same; "none": none',
        json_schema_extra={"allowed": 'a number >= 0, or "none"'},
    )


Excitation = Annotated[
    Sinusoid | Measured | Spectrum | WheelFlat | RailJoint | Dent | Corrugation | OutOfRound,
    Field(discriminator="type"),
]
