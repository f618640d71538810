"""Cross-sections of rails."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import Basis, ElementQuad2

from wheelrail.track.section import RailSection, section_from_mesh
from wheelrail.track.section_sources import PRESETS, preset_section


def test_a_rectangle(bar):
    b, h = 0.03, 0.06
    assert bar.area == pytest.approx(b * h, rel=1e-14)
    assert bar.centroid == pytest.approx((0.0, h / 2), abs=1e-16)
    assert bar.second_moments == pytest.approx((b * h**3 / 12, h * b**3 / 12, 0.0), rel=1e-13, abs=1e-20)
    assert bar.symmetric
    assert bar.foot == (-b / 2, b / 2)
    assert bar.head == (-b / 2, b / 2)
    assert bar.height == h
    assert bar.mass_per_length(7850.0) == pytest.approx(7850 * b * h)


def test_a_section_without_symmetry_stays_where_it_is():
    angle = RailSection(np.array([(0.0, 1.0), (0.1, 1.0), (0.1, 1.02), (0.02, 1.02), (0.02, 1.1), (0.0, 1.1)]))
    assert not angle.symmetric
    assert angle.foot == pytest.approx((0.0, 0.1))  # but its underside is moved to y = 0
    assert angle.outline[:, 1].min() == 0.0
    # Two rectangles, 0.1 x 0.02 and 0.02 x 0.08.
    area = 0.002 + 0.0016
    x, y = (0.002 * 0.05 + 0.0016 * 0.01) / area, (0.002 * 0.01 + 0.0016 * 0.06) / area
    assert angle.centroid == pytest.approx((x, y))
    product = 0.002 * (0.05 - x) * (0.01 - y) + 0.0016 * (0.01 - x) * (0.06 - y)
    assert angle.second_moments[2] == pytest.approx(product)
    assert angle.head == pytest.approx((0.0, 0.02))
    assert Basis(angle.mesh(0.01), ElementQuad2()).dx.sum() == pytest.approx(area)


def test_the_symmetry_plane_is_found():
    rail = preset_section("60e1")
    moved = RailSection(rail.outline + np.array([0.7, -0.3]))
    assert moved.symmetric
    np.testing.assert_allclose(moved.outline, rail.outline, atol=1e-12)


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_meshes_of_symmetric_sections_are_symmetric(name):
    rail = preset_section(name)
    assert rail.symmetric
    mesh = rail.mesh(0.008)
    left, right = (np.round(np.column_stack([sign * mesh.p[0], mesh.p[1]]), 12) + 0.0 for sign in (-1.0, 1.0))
    assert {tuple(p) for p in left} == {tuple(p) for p in right}
    assert Basis(mesh, ElementQuad2(), intorder=6).dx.sum() == pytest.approx(rail.area, rel=1e-4)  # achieved: 3e-5


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_presets_can_be_meshed_in_any_size(name):
    from wheelrail.numerics.section_mesh import mesh_quality

    for size in (0.02, 0.012, 0.007, 0.005):
        assert mesh_quality(preset_section(name).mesh(size)).min() > 0.3


def test_the_contact_must_be_on_the_head():
    rail = preset_section("60e1")
    left, right = rail.head
    assert right == -left == pytest.approx(0.0342, abs=2e-4)
    rail.check_contact_position(0.02)
    with pytest.raises(ValueError, match=r"isn't on the head's top; allowed: -0.034. to 0.034. m"):
        rail.check_contact_position(0.036)


def test_a_rail_must_have_an_underside_to_rest_on():
    with pytest.raises(ValueError, match="flat underside"):
        RailSection(np.array([(0.0, 0.0), (0.1, 0.1), (-0.1, 0.1)]))


def test_a_section_from_a_mesh_is_that_of_its_outline():
    rail = preset_section("60e1")
    again = section_from_mesh(rail.mesh(0.006))
    assert again.area == pytest.approx(rail.area, rel=1e-4)
    assert again.second_moments[:2] == pytest.approx(rail.second_moments[:2], rel=1e-4)
    assert again.symmetric
    assert again.foot == pytest.approx(rail.foot, abs=3e-4)  # the parabola of the rounded corner isn't an arc
    assert again.mesh(0.1) is again.given_mesh


def test_a_mesh_with_a_hole_is_refused():
    from skfem import MeshQuad, MeshQuad2

    mesh = MeshQuad.init_tensor(np.linspace(0, 0.3, 4), np.linspace(0, 0.3, 4))
    hollow = mesh.remove_elements(np.array([4]))
    with pytest.raises(ValueError, match="has a hole"):
        section_from_mesh(MeshQuad2.from_mesh(hollow))
