"""Wheel flats: the path of a rigid wheel, and impact forces (Pieringer 2011, section 5.2).

The flat of the thesis, 0.9 mm deep and 100 mm long, rounded; load 117.7 kN.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wheelrail.case import Case, parse_case
from wheelrail.contact.bedding import WinklerBedding
from wheelrail.contact.hertz import hertz_contact
from wheelrail.excitation.view import rigid_path
from wheelrail.excitation.wheel_flat import rounded_flat
from wheelrail.interaction.build import build_model, track_of, wheel_of
from wheelrail.interaction.simulate import simulate
from wheelrail.reference.direct_integration import integrate_interaction
from wheelrail.track.discrete import DiscreteTrack
from wheelrail.wheel.rigid import RigidWheel

R, DEPTH, LENGTH, LOAD = 0.45, 0.9e-3, 0.1, 117.7e3
DX, SPACING = 1e-3, 0.65
TABLE = Path(__file__).parents[1] / "data" / "wheel_flat_trajectory.csv"

CASE = """
[simulation]
speed = {speed}
dx = 1e-3
duration = {duration}
start_position = 0.0
[wheel]
preset = "thesis-1dof"
radius = 0.45
mass = 592.5
[track]
preset = "thesis-discrete"
bays = 140
[contact]
normal = "winkler"
rail_radius = 0.3
youngs_modulus = 207e9
poisson_ratio = 0.3
length = 81e-3
[load]
preload = 117.7e3
coupling = "load"
[[excitation]]
type = "wheel-flat"
shape = "{shape}"
depth = 0.9e-3
{length}
angle = {angle}
"""


def test_path_of_a_rigid_wheel():
    """Against an independent contact code with the flat in its wheel profile."""
    angle, height = np.loadtxt(TABLE, delimiter=",", skiprows=4, unpack=True)
    s, heights, _ = rounded_flat(depth=DEPTH, length=LENGTH, radius=R)
    at, path = rigid_path(s, heights, radius=R)
    # Achieved 2.2 um, where the code smooths the profile; its wheel sinks 0.9 mm and 3.7 um.
    assert np.abs(-1e3 * np.interp(R * angle, at, path) - height).max() < 3e-3  # mm


def impact(kmh: float, shape: str) -> tuple[Case, float]:
    """A run to half a metre after the impact, which is 0.2 m behind the fifth sleeper."""
    x = 4 * SPACING + 0.2
    speed = kmh / 3.6
    length = "length = 0.1" if shape == "rounded" else ""
    return parse_case(CASE.format(speed=speed, duration=(x + 0.5) / speed, angle=x / R, shape=shape, length=length)), x


def depth(s: NDArray, shape: str) -> NDArray:
    """Depth of the flat at s m from its middle."""
    if shape == "new":
        return np.maximum(DEPTH - s**2 / (2.0 * R), 0.0)
    return np.where(np.abs(s) < 0.5 * LENGTH, 0.5 * DEPTH * (1.0 + np.cos(2.0 * np.pi * s / LENGTH)), 0.0)


def springs(bedding: WinklerBedding, x_flat: float, shape: str) -> Callable[[float, float], tuple[float, float]]:
    """Contact law of the bedding, by a sum over springs 0.1 mm apart under the formula of the flat."""
    offset = np.arange(-400, 401) * 1e-4
    stretch = np.sqrt(R / bedding.radius)

    def law(x: float, approach: float) -> tuple[float, float]:
        flat = depth(x - x_flat + offset * stretch, shape)
        deflection = approach - offset**2 / (2.0 * bedding.radius) - flat
        pressed = deflection > 0.0
        return bedding.stiffness * deflection[pressed].sum() * 1e-4, bedding.stiffness * pressed.sum() * 1e-4

    return law


def run(case: Case) -> NDArray:
    model = build_model(case)
    return simulate(model, duration=case.simulation.duration, record=["force_z"]).collect()["force_z"]


@pytest.mark.slow
@pytest.mark.parametrize(("kmh", "shape"), [(40.0, "rounded"), (75.0, "rounded"), (100.0, "rounded"), (100.0, "new")])
def test_impact_against_direct_integration(kmh, shape):
    case, x = impact(kmh, shape)
    force = run(case)
    model, track, wheel = build_model(case), track_of(case), wheel_of(case)
    assert isinstance(model.contact, WinklerBedding)
    assert isinstance(track, DiscreteTrack)
    assert isinstance(wheel, RigidWheel)
    refinement = 4
    direct = integrate_interaction(
        track,
        wheel,
        law=springs(model.contact, x, shape),
        preload=LOAD,
        speed=case.simulation.speed,
        start=0.0,
        dt=model.dt / refinement,
        steps=refinement * (len(force) - 1),
    ).force[::refinement]
    passing = slice(round((x - 0.2) / DX), None)
    assert force[passing].max() == pytest.approx(direct[passing].max(), rel=0.01)  # achieved 0.15, 0.17, 0.25, 0.22 %
    # The smallest force is a difference of large ones: of the load, achieved 0.3 %.
    assert force[passing].min() == pytest.approx(direct[passing].min(), abs=0.01 * LOAD)
    assert np.std((force - direct)[passing]) < 0.01 * np.std(direct[passing])  # achieved 0.07, 0.31, 0.38, 0.61 %
    # In rolling over a chord the wheel has to fall with v^2 / R, and P / M and the rail's rebound are all it gets.
    lost = np.mean(force[passing] == 0.0), np.mean(direct[passing] == 0.0)
    if shape == "new":
        assert (kmh / 3.6) ** 2 / R > LOAD / 592.5
        assert lost[0] * 0.7 == pytest.approx(lost[1] * 0.7, abs=2 * DX)  # m of the way; achieved equal, 8 mm
        assert lost[0] * 0.7 > 5e-3
    else:
        assert lost == (0.0, 0.0)


RIGID = """
[simulation]
speed = 10.0
dx = 0.5e-3
duration = 0.0
start_position = {x}
[wheel]
model = "rigid"
radius = 0.45
[track]
model = "rigid"
[contact]
normal = "half-space"
rail_radius = 0.3
youngs_modulus = 207e9
poisson_ratio = 0.3
dy = 0.5e-3
length = 30.5e-3
width = 12.5e-3
[load]
preload = 10e3
coupling = "load"
[[excitation]]
type = "wheel-flat"
shape = "rounded"
depth = 0.9e-3
length = 0.1
angle = 0.0
"""


@pytest.mark.parametrize(("x", "sunk", "rtol"), [(0.0, DEPTH, 0.02), (-0.12, 0.0, 0.002)])
def test_the_half_space_meets_the_flat_as_it_is(x, sunk, rtol):
    """In the middle of the flat as Hertz with the curvature there, beside it as on a round wheel."""
    model = build_model(parse_case(RIGID.format(x=x)))
    approach = float(simulate(model, duration=0.0, record=["approach"]).collect()["approach"][0])
    curvature = 1.0 / R - (2.0 * np.pi**2 * DEPTH / LENGTH**2 if sunk else 0.0)
    hertz = hertz_contact(
        curvature_x=curvature, curvature_y=1.0 / 0.3, youngs_modulus=207e9, poisson_ratio=0.3, load=10e3
    )
    # Achieved 0.7 and 0.11 %; the contact of 14 mm in the flat feels that it is no parabola.
    assert approach - sunk == pytest.approx(hertz.approach, rel=rtol)
