"""Cattaneo (1938), Mindlin (1949): a sphere pressed on a plane and shifted without rolling (Johnson 1985, section 7.2).

    c = a (1 - T / (mu N))^(1/3),    |q| = (mu p0 / a) [sqrt(a^2 - r^2) - sqrt(c^2 - r^2)],
    shift = 3 mu N (2 - nu) / (8 a G) [1 - (1 - T / (mu N))^(2/3)]     (two bodies of one material)

Exact for nu = 0; otherwise the tractions across are neglected. Elements' edges meet the circle's at all grids.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.hertz import hertz_contact
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.rolling import rigid_shift, roll

LOAD, FRICTION, YOUNG, RADIUS = 65e3, 0.3, 207e9, 0.4


def shifted(nu: float, fraction: float, elements: int, direction: float = 0.0) -> dict[str, float]:
    """Deviations from the closed form, ``elements`` over the contact's diameter; tractions over mu p0."""
    G = YOUNG / (2.0 * (1.0 + nu))
    hertz = hertz_contact(
        curvature_x=1 / RADIUS, curvature_y=1 / RADIUS, youngs_modulus=YOUNG, poisson_ratio=nu, load=LOAD
    )
    a, bound = hertz.semi_axis_x, FRICTION * hertz.pressure_max
    dx = 2.0 * a / elements
    half_space = HalfSpace(elements + 4, elements + 4, dx, dx, G, nu)
    r = np.hypot(half_space.x, half_space.y)
    normal = solve_normal(NormalProblem(half_space, r**2 / (2.0 * RADIUS), 0.0, 1.0, LOAD))
    size = 3.0 * FRICTION * LOAD * (2.0 - nu) / (8.0 * a * G) * (1.0 - (1.0 - fraction) ** (2.0 / 3.0))
    cosine, sine = math.cos(direction), math.sin(direction)
    shift = rigid_shift(half_space, creepage_x=size * cosine, creepage_y=size * sine, creepage_spin=0.0, distance=1.0)
    state = roll(half_space, normal, friction=FRICTION, shift=shift, previous=np.zeros((2, half_space.elements)))
    c = a * (1.0 - fraction) ** (1.0 / 3.0)
    expected = bound / a * (np.sqrt(np.maximum(a**2 - r**2, 0.0)) - np.sqrt(np.maximum(c**2 - r**2, 0.0)))
    error = (-cosine * state.tractions[0] - sine * state.tractions[1] - expected) / bound
    stick = normal.contact[~state.slipping[normal.contact]]
    return {
        "force": (-cosine * state.force_x - sine * state.force_y) / (fraction * FRICTION * LOAD) - 1.0,
        "tractions": math.sqrt(float((error**2).sum()) * dx**2 / (math.pi * a**2)),
        "stick radius": math.sqrt(len(stick) * dx**2 / math.pi) / c - 1.0,
        "stick beyond the radius": r[stick].max() / c - 1.0,
        "slip within the radius": 1.0 - r[state.slipping].min() / c,
        "across": float(np.abs(-sine * state.tractions[0] + cosine * state.tractions[1]).max()) / bound,
    }


@pytest.mark.parametrize("fraction", [0.25, 0.5, 0.75, 0.9])
def test_converges_to_the_closed_form(fraction):
    error = {n: shifted(0.0, fraction, n) for n in (9, 17, 33)}
    # force 1.5e-2, 8e-4, 6e-4 at worst; tractions (rms) 4.3e-2, 1.7e-2, 1.1e-2: about the first order
    for n, force, tractions, radius in ((9, 2e-2, 5e-2, 7e-2), (17, 1.5e-3, 2e-2, 4e-2), (33, 1e-3, 1.2e-2, 2e-2)):
        assert abs(error[n]["force"]) < force
        assert error[n]["tractions"] < tractions
        assert abs(error[n]["stick radius"]) < radius  # 6e-2, 3.8e-2, 1.4e-2
        # the division follows the circle element by element: half an element's diagonal at most
        assert error[n]["stick beyond the radius"] < 1.5 / n
        assert error[n]["slip within the radius"] < 1.5 / n
        assert error[n]["across"] < 1e-9  # nu = 0: no coupling
    assert error[33]["tractions"] < 0.6 * error[9]["tractions"]


def test_any_direction_of_the_shift():
    for direction in (0.5 * math.pi, 0.7, -2.5):
        error = shifted(0.0, 0.5, 17, direction)
        assert abs(error["force"]) < 1e-3
        assert error["tractions"] < 2e-2
        assert error["across"] < 1e-9


def test_poisson_ratio_turns_the_tractions_little():
    """What the closed form neglects: 4 % of mu p0 across the shift, 5e-4 in the force."""
    error = shifted(0.3, 0.75, 33)
    assert abs(error["force"]) < 1e-3
    assert error["tractions"] < 1.2e-2
    assert 0.02 < error["across"] < 0.05
