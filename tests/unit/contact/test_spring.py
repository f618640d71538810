import math

import numpy as np
import pytest

from wheelrail.contact.bedding import WinklerBedding
from wheelrail.contact.hertz import hertz_contact
from wheelrail.contact.spring import HertzSpring, averaging_weights

HERTZ = hertz_contact(
    curvature_x=1.0 / 0.46, curvature_y=1.0 / 0.30, youngs_modulus=207e9, poisson_ratio=0.3, load=65e3
)


def spring(prefilter: str, *, nodes: int = 21, dx: float = 1e-3) -> HertzSpring:
    weights, bedding = np.zeros(nodes), None
    weights[nodes // 2] = 1.0
    if prefilter == "average":
        weights = averaging_weights(half_length=HERTZ.semi_axis_x, dx=dx, nodes=nodes)
    if prefilter == "winkler":
        bedding = WinklerBedding.from_hertz(
            load=HERTZ.load,
            semi_axis_x=HERTZ.semi_axis_x,
            semi_axis_y=HERTZ.semi_axis_y,
            approach=HERTZ.approach,
            dx=dx,
            nodes=nodes,
        )
    cube_root = HERTZ.load ** (1 / 3)
    return HertzSpring(
        constant=HERTZ.constant,
        axis_constants=(HERTZ.semi_axis_x / cube_root, HERTZ.semi_axis_y / cube_root),
        nodes=nodes,
        weights=weights,
        bedding=bedding,
        preload=HERTZ.load,
    )


@pytest.mark.parametrize("half_length", [0.2e-3, 0.5e-3, 1e-3, 6.2e-3, 9.9999e-3, 10e-3])
def test_weights_average_a_broken_line_exactly(half_length):
    dx, nodes = 1e-3, 21
    weights = averaging_weights(half_length=half_length, dx=dx, nodes=nodes)
    x = (np.arange(nodes) - 10) * dx
    line = np.random.default_rng(2).normal(size=nodes)
    kinks = np.concatenate([[-half_length], x[np.abs(x) < half_length], [half_length]])
    mean = np.trapezoid(np.interp(kinks, x, line), kinks) / (2.0 * half_length)
    assert weights @ line == pytest.approx(mean, abs=1e-13)
    assert weights.sum() == pytest.approx(1.0, abs=1e-14)
    assert np.all(weights >= -1e-16)
    np.testing.assert_allclose(weights, weights[::-1], atol=1e-16)


@pytest.mark.parametrize("prefilter", ["none", "average", "winkler"])
def test_smooth_surfaces_give_hertz(prefilter):
    model = spring(prefilter)
    solution = model.solve(np.zeros(21), weight=0.0, compliance=1.0, rhs=65e3, guess=1e-4)
    assert solution.force == pytest.approx(65e3, abs=0, rel=1e-12)
    assert solution.approach == pytest.approx(HERTZ.approach, abs=0, rel=1e-12)
    assert solution.stiffness == pytest.approx(HERTZ.stiffness, abs=0, rel=1e-12)
    assert solution.length == pytest.approx(2 * HERTZ.semi_axis_x, abs=0, rel=1e-12)
    assert solution.width == pytest.approx(2 * HERTZ.semi_axis_y, abs=0, rel=1e-12)
    assert solution.area == pytest.approx(math.pi * HERTZ.semi_axis_x * HERTZ.semi_axis_y, abs=0, rel=1e-12)
    assert solution.pressure_max == pytest.approx(HERTZ.pressure_max, abs=0, rel=1e-12)
    # Under another load too: Hertz' load-deflection curve, prefiltered for the nominal load or not.
    solution = model.solve(np.zeros(21), weight=1.0, compliance=0.0, rhs=2 * HERTZ.approach, guess=1e-4)
    assert solution.force == pytest.approx(65e3 * 2**1.5, abs=0, rel=1e-12)


@pytest.mark.parametrize("prefilter", ["none", "average", "winkler"])
def test_a_raised_surface_is_a_deeper_contact(prefilter):
    """Heights count outward: a rail that is 7 um higher everywhere is felt as 7 um."""
    model = spring(prefilter)
    roughness = np.full(21, 7e-6)
    assert model.equivalent_roughness(roughness) == pytest.approx(7e-6, abs=0, rel=1e-10)
    solution = model.solve(roughness, weight=1.0, compliance=0.0, rhs=HERTZ.approach - 7e-6, guess=1e-4)
    assert solution.force == pytest.approx(65e3, abs=0, rel=1e-11)


def test_without_prefilter_only_the_centre_counts():
    roughness = np.arange(21) ** 2 * 1e-7
    assert spring("none").equivalent_roughness(roughness) == roughness[10]


def test_winkler_prefilter_feels_the_highest_points_only():
    """A wheel does not reach the bottom of a narrow pit, but rides on a narrow ridge."""
    model = spring("winkler")
    pit, ridge = np.zeros(21), np.zeros(21)
    pit[10], ridge[10] = -300e-6, 300e-6
    assert model.equivalent_roughness(pit) == pytest.approx(-12e-6, abs=1e-6)
    assert model.equivalent_roughness(ridge) == pytest.approx(26e-6, abs=1e-6)
    # A deeper pit is no different, a higher ridge is.
    assert model.equivalent_roughness(10 * pit) == pytest.approx(model.equivalent_roughness(pit), abs=0, rel=0.2)
    assert model.equivalent_roughness(10 * ridge) > 5 * model.equivalent_roughness(ridge)
    mean = spring("average")
    assert mean.equivalent_roughness(pit) == pytest.approx(-mean.equivalent_roughness(ridge))


def test_loss_of_contact():
    solution = spring("winkler").solve(np.zeros(21), weight=1.0, compliance=1e-9, rhs=-1e-6, guess=1e-4)
    assert solution[:3] == (0.0, -1e-6, 0.0)
    assert solution.area == solution.length == solution.width == solution.pressure_max == 0.0
