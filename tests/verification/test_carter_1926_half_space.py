"""Carter (1926) by the three-dimensional half-space: a contact 21 times wider than long, its middle strip."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from wheelrail.contact.creep.carter import carter
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.hertz import hertz_contact
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.rolling import steady_rolling

SHEAR_MODULUS, POISSON_RATIO, FRICTION = 207e9 / 2.6, 0.3, 0.3
CURVATURES = {"curvature_x": 2.5, "curvature_y": 0.0192}
STRIPS = 11
HERTZ = hertz_contact(**CURVATURES, youngs_modulus=207e9, poisson_ratio=POISSON_RATIO, load=400e3)


@functools.cache
def pressed(elements: int):
    """``elements`` over the length of the middle strip, whose ends are element edges."""
    dx, dy = 2.0 * HERTZ.semi_axis_x / elements, 2.0 * HERTZ.semi_axis_y / STRIPS
    half_space = HalfSpace(elements + 4, STRIPS + 4, dx, dy, SHEAR_MODULUS, POISSON_RATIO)
    distance = 0.5 * (CURVATURES["curvature_x"] * half_space.x**2 + CURVATURES["curvature_y"] * half_space.y**2)
    return half_space, solve_normal(NormalProblem(half_space, distance, 0.0, 1.0, HERTZ.load))


def middle_strip(elements: int, used: float) -> dict[str, float]:
    """Deviations for a share of the creepage that makes the contact slide."""
    half_space, normal = pressed(elements)
    middle = (half_space.my - 1) // 2 * half_space.mx + np.arange(half_space.mx)
    creepage = used * 2.0 * (1.0 - POISSON_RATIO) * FRICTION * HERTZ.pressure_max / SHEAR_MODULUS
    state = steady_rolling(
        half_space, normal, friction=FRICTION, creepage_x=creepage, creepage_y=0.0, creepage_spin=0.0
    )
    line = carter(
        creepage_x=creepage,
        half_length=HERTZ.semi_axis_x,
        pressure_max=HERTZ.pressure_max,
        friction_coefficient=FRICTION,
        shear_modulus=SHEAR_MODULUS,
        poisson_ratio=POISSON_RATIO,
    )
    error = (state.tractions[0, middle] - line.traction(half_space.x[middle])) / line.traction_bound
    touching = normal.pressure[middle] > 0.0
    stick = touching & ~state.slipping[middle]
    assert not (np.diff(np.flatnonzero(stick)) > 1).any()
    assert not stick.any() or stick[np.flatnonzero(touching)[-1]]  # it touches the leading edge
    load = np.pi * HERTZ.semi_axis_x * HERTZ.pressure_max / 2.0
    return {
        "load": normal.pressure[middle].sum() * half_space.dx / load - 1.0,
        "force": state.tractions[0, middle].sum() * half_space.dx / line.force_x - 1.0,
        "tractions": float(np.sqrt((error**2).sum() / elements)),
        "stick": np.count_nonzero(stick) / elements - line.stick_fraction,
    }


def test_the_contact_is_long():
    assert HERTZ.semi_axis_y > 20.0 * HERTZ.semi_axis_x
    _, normal = pressed(17)
    assert normal.pressure.max() == pytest.approx(HERTZ.pressure_max, rel=2e-2)


@pytest.mark.parametrize("used", [0.25, 0.5, 0.75])
def test_middle_strip_converges_to_the_closed_form(used):
    error = {n: middle_strip(n, used) for n in (9, 17, 33)}
    for n in error:
        assert abs(error[n]["load"]) < 1e-3
        assert abs(error[n]["stick"]) < 0.6 / n  # half an element
    # First order in dx: force 3.8e-2, 2.0e-2, 1.1e-2; tractions (rms over mu p0) 4.2e-2, 2.6e-2, 1.5e-2 at most.
    assert 0.0 < error[33]["force"] < 1.3e-2
    for quantity, low, high in (("force", 1.7, 2.1), ("tractions", 1.4, 2.0)):
        assert low < error[9][quantity] / error[17][quantity] < high
        assert low < error[17][quantity] / error[33][quantity] < high
    # what remains of the force for dx to 0 (dx = length / n)
    limit = (33.0 * error[33]["force"] - 17.0 * error[17]["force"]) / 16.0
    assert abs(limit) < 2e-3


def test_slides_beyond_saturation():
    for used in (1.2, 3.0):
        error = middle_strip(9, used)
        assert error["stick"] == 0.0
        assert abs(error["force"]) < 1e-3
