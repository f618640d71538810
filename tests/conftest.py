"""Models that several tests share."""

from __future__ import annotations

import os

# Before numpy is loaded: threads of BLAS that wait for each other would make small solves slow.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from collections.abc import Callable
from typing import Any

import pytest

from wheelrail.case import parse_case
from wheelrail.interaction.build import build_model
from wheelrail.interaction.model import Model
from wheelrail.track.discrete import DiscreteTrack

# Pieringer 2011, section 3.3.1; the rotary inertia is not printed there.
THESIS_TRACK: dict[str, Any] = {
    "bending_stiffness": 6.4e6,
    "shear_stiffness": 250e6,
    "mass_per_length": 60.0,
    "rotary_inertia": 0.24,
    "sleeper_spacing": 0.65,
    "bays": 70,
    "elements_per_bay": 8,
    "pad_stiffness": 120e6,
    "pad_damping": 16e3,
    "sleeper_mass": 125.0,
    "ballast_stiffness": 140e6,
    "ballast_damping": 165e3,
}

CASE = """
[simulation]
speed = 30.0
dx = 5e-3
duration = 0.1
start_position = 0.0
[wheel]
{wheel}
[track]
{track}
[contact]
rail_radius = 0.30
youngs_modulus = 207e9
poisson_ratio = 0.3
{contact}
[load]
preload = 65e3
coupling = "{coupling}"
{excitation}
"""

WHEELS = {
    "rigid": 'model = "rigid"\nradius = 0.46',
    "1dof": 'preset = "thesis-1dof"',
    "2dof": 'preset = "thesis-2dof"',
}
TRACKS = {
    "rigid": 'model = "rigid"',
    "short": 'preset = "thesis-discrete"\nbays = 20\nmemory = 0.02',
}
CONTACTS = {
    "hertz": 'normal = "hertz"',
    "winkler": 'normal = "winkler"\nlength = 35e-3',
    "average": 'normal = "hertz"\nlength = 35e-3\nprefilter = "average"',
    "prefilter": 'normal = "hertz"\nlength = 35e-3\nprefilter = "winkler"',
}
SINE = '[[excitation]]\ntype = "sinusoid"\namplitude = 10e-6\nwavelength = 0.13'


@pytest.fixture(scope="session")
def thesis_track() -> Callable[..., DiscreteTrack]:
    """Track of the thesis, with changes."""
    return lambda **changes: DiscreteTrack(**{**THESIS_TRACK, **changes})


@pytest.fixture(scope="session")
def small_model(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Model]:
    """Models that build in no time: 20 bays, dx = 5 mm, functions of 20 ms; a folder of their own as cache."""
    before = os.environ.get("WHEELRAIL_CACHE")
    folder = str(tmp_path_factory.mktemp("greens"))
    built: dict[tuple[str, ...], Model] = {}

    def make(
        *,
        wheel: str = "2dof",
        track: str = "short",
        contact: str = "winkler",
        coupling: str = "load",
        excitation: str = SINE,
    ) -> Model:
        key = (wheel, track, contact, coupling, excitation)
        if key not in built:
            text = CASE.format(
                wheel=WHEELS[wheel],
                track=TRACKS[track],
                contact=CONTACTS[contact],
                coupling=coupling,
                excitation=excitation,
            )
            os.environ["WHEELRAIL_CACHE"] = folder
            try:
                built[key] = build_model(parse_case(text))
            finally:
                if before is None:
                    del os.environ["WHEELRAIL_CACHE"]
                else:
                    os.environ["WHEELRAIL_CACHE"] = before
        return built[key]

    return make
