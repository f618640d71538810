"""Mindlin's tangential compliance of a contact ellipse."""

import math

import numpy as np
import pytest

from wheelrail.contact.creep.contact_spring import tangential_compliance
from wheelrail.contact.half_space import HalfSpace
from wheelrail.contact.hertz import hertz_contact
from wheelrail.contact.normal import NormalProblem, solve_normal
from wheelrail.contact.rolling import rigid_shift, roll

G, NU, LOAD = 80e9, 0.3, 65e3


def test_compliance_of_a_circle():
    for nu in (0.0, 0.3, 0.5):
        both = tangential_compliance(semi_axis_x=5e-3, semi_axis_y=5e-3, shear_modulus=G, poisson_ratio=nu)
        assert both == pytest.approx([(2.0 - nu) / (4.0 * G * 5e-3)] * 2, rel=1e-15)


@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.999, 2.0, 10.0])
def test_compliance_is_mindlin_s_integral(ratio):
    a, b = 4e-3 * ratio, 4e-3
    t = (np.arange(4000) + 0.5) * math.pi / 8000.0  # of a periodic integrand: exact to rounding
    root = np.sqrt((b * np.cos(t)) ** 2 + (a * np.sin(t)) ** 2)
    expected = [float(np.mean((1.0 - NU * w**2) / root)) / (2.0 * G) for w in (np.sin(t), np.cos(t))]
    both = tangential_compliance(semi_axis_x=a, semi_axis_y=b, shear_modulus=G, poisson_ratio=NU)
    assert both == pytest.approx(expected, rel=1e-14)  # 2e-15


@pytest.mark.parametrize(("curvature_x", "curvature_y"), [(2.5, 2.5), (1 / 0.46, 1 / 0.3), (2.0, 10.0)])
def test_compliance_against_the_half_space(curvature_x, curvature_y):
    """A shift of 1 nm of the elements in contact, all of which stick."""
    hertz = hertz_contact(
        curvature_x=curvature_x,
        curvature_y=curvature_y,
        youngs_modulus=2.0 * (1.0 + NU) * G,
        poisson_ratio=NU,
        load=LOAD,
    )
    a, b = hertz.semi_axis_x, hertz.semi_axis_y
    grid = HalfSpace(29, 29, 2.0 * a / 25, 2.0 * b / 25, G, NU)
    gap = 0.5 * (curvature_x * grid.x**2 + curvature_y * grid.y**2)
    state = solve_normal(NormalProblem(grid, gap, 0.0, 1.0, LOAD))
    both = tangential_compliance(semi_axis_x=a, semi_axis_y=b, shear_modulus=G, poisson_ratio=NU)
    for direction in (0, 1):
        shift = rigid_shift(
            grid,
            creepage_x=1e-9 * (direction == 0),
            creepage_y=1e-9 * (direction == 1),
            creepage_spin=0.0,
            distance=1.0,
        )
        # friction so large that the edge sticks too
        rolled = roll(grid, state, friction=100.0, shift=shift, previous=np.zeros((2, grid.elements)))
        force = (rolled.force_x, rolled.force_y)
        assert rolled.slip_fraction == 0.0
        assert -both[direction] * force[direction] == pytest.approx(1e-9, rel=5e-3)  # 2.4e-3 to 3.3e-3
        assert abs(force[1 - direction]) < 1e-12 * abs(force[direction])
