"""Named profiles of rails and of wheels without a standard."""

from __future__ import annotations

import numpy as np
import pytest

from wheelrail.errors import ParameterError
from wheelrail.profile.named_profiles import named_rail_profile, named_wheel_profile
from wheelrail.track.section_sources import preset_section


def head_of(name: str) -> np.ndarray:
    """Points of the right half of a section's head, lateral position and depth, m."""
    section = preset_section(name)
    x, y = section.outline.T
    keep = (x >= 0.0) & (y > section.outline[:, 1].max() - 13e-3)
    return np.column_stack([x[keep], section.outline[:, 1].max() - y[keep]])


def test_60e1_is_the_outline_of_the_section():
    head = head_of("60e1")
    assert len(head) > 15
    for sign in (1.0, -1.0):
        difference = named_rail_profile("60e1").height(sign * head[:, 0]) - head[:, 1]
        assert np.abs(difference).max() < 1e-6  # achieved: 1.4e-7 m, at the steepest points


def test_60e1_arcs_are_tangent_and_symmetric():
    rail = named_rail_profile("60e1")
    for y in rail.breaks[1:-1]:
        before, after = rail.evaluate(y - 1e-13), rail.evaluate(y)
        assert abs(after[0] - before[0]) < 1e-10
        assert abs(after[1] - before[1]) < 2e-9
    y = np.linspace(0.0, rail.end, 200)
    np.testing.assert_array_equal(rail.height(y[:-1]), rail.height(-y[:-1]))
    assert rail.at(0.0)[:2] == (0.0, 0.0)
    np.testing.assert_allclose(1.0 / rail.curvature([0.0, 0.02, 0.03]), [0.3, 0.08, 0.013], rtol=1e-12)
    assert rail.at(0.036)[1] == pytest.approx(20.0, rel=1e-6)


def test_the_rule_of_the_stand_in_gives_60e1():
    """Arcs of 300, 80 and 13 mm that touch, on a crown of 20.456 mm and to the sides: EN 13674-1 prints the rest."""
    from wheelrail.profile.named_profiles import _60E1, _crowned_head

    made = _crowned_head(10.2280204, 36.0162196, (300.0, 80.0, 13.0))
    np.testing.assert_allclose(made, _60E1, atol=2e-6)  # achieved: 1.2e-6 mm


def test_bv50_like_is_a_crowned_head_of_70_mm():
    rail = named_rail_profile("bv50-like")
    for y in rail.breaks[1:-1]:
        before, after = rail.evaluate(y - 1e-13), rail.evaluate(y)
        assert abs(after[0] - before[0]) < 1e-12
        assert abs(after[1] - before[1]) < 1e-11
    assert rail.curvature(0.0) == pytest.approx(1.0 / 0.3, rel=1e-12)
    assert rail.end == pytest.approx(35e-3, abs=2e-5)
    assert -rail.start == rail.end


@pytest.mark.parametrize(("radius", "half"), [(0.3, 36e-3), (0.02, 0.02 * np.sin(np.radians(80.0)))])
def test_circular(radius, half):
    rail = named_rail_profile("Circular", radius=radius)
    y = np.linspace(-half, half, 21)
    np.testing.assert_allclose(rail.height(y), radius - np.sqrt(radius**2 - y**2), atol=1e-15)
    assert rail.end == pytest.approx(half)


def test_wheels_without_a_flange():
    y = np.linspace(-0.07, 0.07, 15)
    np.testing.assert_allclose(named_wheel_profile("cone", conicity=0.05).height(y), -0.05 * y, atol=1e-18)
    np.testing.assert_array_equal(named_wheel_profile("cylinder").height(y), 0.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: named_wheel_profile("p8"), "allowed: s1002, cone, cylinder"),
        (lambda: named_wheel_profile("cone"), "needs one"),
        (lambda: named_wheel_profile("cone", conicity=np.nan), "needs one"),
        (lambda: named_wheel_profile("s1002", conicity=0.05), "only"),
        (lambda: named_rail_profile("54e1"), "allowed: 60e1, bv50-like, circular"),
        (lambda: named_rail_profile("circular"), "above 0"),
        (lambda: named_rail_profile("circular", radius=-0.3), "above 0"),
        (lambda: named_rail_profile("60e1", radius=0.3), "only"),
    ],
)
def test_refused(make, message):
    with pytest.raises(ParameterError, match=message):
        make()
