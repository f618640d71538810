"""Quadrilateral meshes of plane sections."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import Basis, ElementQuad2

from wheelrail.numerics.section_mesh import mesh_outline, mesh_quality


def circle(radius: float, points: int) -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(points) / points
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def area(mesh) -> float:
    return float(Basis(mesh, ElementQuad2(), intorder=6).dx.sum())


SHAPES = {
    "square": [(0, 0), (1, 0), (1, 1), (0, 1)],
    "angle": [(0, 0), (2, 0), (2, 0.1), (0.1, 0.1), (0.1, 2), (0, 2)],
    "wedge": [(0, 0), (2, 0), (0, 0.5)],
    "star": [(0, 0), (1, 0.7), (2, 0), (1.4, 1), (2, 2), (1, 1.4), (0, 2), (0.6, 1)],
}


@pytest.mark.parametrize("size", [0.2, 0.05])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_mesh_fills_its_polygon(shape, size):
    points = np.array(SHAPES[shape], dtype=float)
    mesh = mesh_outline(points[::-1], size=size)
    x, y = points.T
    exact = 0.5 * abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    assert area(mesh) == pytest.approx(exact, rel=1e-12)
    assert mesh_quality(mesh).min() > 0.3 if shape != "wedge" else mesh_quality(mesh).min() > 0.1
    # Every corner is a vertex of the mesh.
    vertices = mesh.p[:, : mesh.nvertices].T
    assert np.hypot(*(vertices[:, None] - points).T).min(axis=1).max() < 1e-12


def test_elements_have_the_size_asked_for():
    for size in (0.1, 0.05, 0.025):
        mesh = mesh_outline(SHAPES["square"], size=size)
        mean = np.sqrt(1.0 / mesh.nelements)
        assert 0.6 * size < mean < 1.2 * size  # achieved: 0.77 to 0.83


def test_smooth_outlines_are_followed_by_curved_edges():
    points = circle(1.0, 720)
    mesh = mesh_outline(points, size=0.5)
    sides = len(mesh.boundary_facets())
    assert sides == 16
    straight = 0.5 * sides * np.sin(2.0 * np.pi / sides)
    assert straight / np.pi - 1.0 < -0.02
    assert area(mesh) == pytest.approx(np.pi, rel=1e-4)  # achieved: 7e-5, of which 1e-5 the 720 points


def test_curved_edges_converge():
    """The area of a disc: the parabolas' error goes down with the fourth power of their length."""
    points = circle(1.0, 2000)
    exact = 0.5 * 2000 * np.sin(2.0 * np.pi / 2000)
    errors, sides = [], []
    for size in (0.5, 0.06):
        mesh = mesh_outline(points, size=size)
        errors.append(abs(area(mesh) / exact - 1.0))
        sides.append(len(mesh.boundary_facets()))
    assert errors[1] < 1e-7  # achieved: 2.5e-8 with 106 edges
    assert np.log(errors[0] / errors[1]) / np.log(sides[1] / sides[0]) == pytest.approx(4.0, abs=0.3)  # achieved: 4.1


def test_points_to_be_kept_are_vertices():
    keep = [(0.3, 0.0), (0.77, 1.0)]
    vertices = mesh_outline(SHAPES["square"], size=0.2, keep=keep).p.T
    assert np.hypot(*(vertices[:, None] - np.array(keep)).T).min(axis=1).max() < 1e-12
    with pytest.raises(ValueError, match="isn't on the outline"):
        mesh_outline(SHAPES["square"], size=0.2, keep=[(0.5, 0.5)])


def test_the_same_outline_gives_the_same_mesh():
    first, second = (mesh_outline(SHAPES["star"], size=0.1) for _ in range(2))
    np.testing.assert_array_equal(first.p, second.p)
    np.testing.assert_array_equal(first.t, second.t)


def test_sizes_that_make_no_sense_are_refused():
    for size in (0.0, -1.0, np.nan):
        with pytest.raises(ValueError, match="must be positive"):
            mesh_outline(SHAPES["square"], size=size)
    with pytest.raises(ValueError, match="more than"):
        mesh_outline(SHAPES["square"], size=1e-5)


def test_an_outline_that_crosses_itself_is_refused():
    with pytest.raises(ValueError, match="crosses or touches itself"):
        mesh_outline([(0, 0), (1, 1), (1, 0), (0, 1)], size=0.1)


def test_quality_of_known_elements():
    from wheelrail.numerics.quad_mesh import curved_quads, split_triangles

    rectangle = curved_quads([(0, 0), (5, 0), (5, 1), (0, 1)], [(0, 3, 2, 1)], [], [])
    assert mesh_quality(rectangle) == pytest.approx([1.0])
    pieces = split_triangles([(0, 0), (1, 0), (0.5, np.sqrt(0.75))], [(0, 1, 2)], [], [])
    assert mesh_quality(pieces) == pytest.approx([np.sin(np.pi / 3)] * 3)
    folded = curved_quads([(0, 0), (1, 0), (0.2, 0.2), (0, 1)], [(0, 1, 2, 3)], [], [])
    assert mesh_quality(folded)[0] < 0.0
