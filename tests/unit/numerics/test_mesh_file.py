"""Plane meshes from files of other programs."""

from __future__ import annotations

import meshio
import numpy as np
import pytest
from skfem import Basis, ElementQuad2

from wheelrail.numerics.section_mesh import mesh_quality, read_mesh


def area(mesh) -> float:
    return float(Basis(mesh, ElementQuad2(), intorder=6).dx.sum())


def write(path, points, cells):
    meshio.write(path, meshio.Mesh(np.asarray(points, dtype=float), cells))
    return path


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
# A half disc of radius 1: two curved triangles.
C = np.sqrt(0.5)
HALF_DISC = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0.5, 0, 0), (C, C, 0), (0, 0.5, 0), (-C, C, 0), (-0.5, 0, 0)]


@pytest.mark.parametrize("name", ["section.vtk", "section.msh", "section.inp"])
def test_quadrilaterals_stay_as_they_are(tmp_path, name):
    mesh = read_mesh(write(tmp_path / name, SQUARE, [("quad", [[0, 1, 2, 3]])]))
    assert mesh.nelements == 1
    assert area(mesh) == pytest.approx(1.0, rel=1e-12)


def test_triangles_become_three_quadrilaterals(tmp_path):
    mesh = read_mesh(write(tmp_path / "section.vtk", SQUARE, [("triangle", [[0, 1, 2], [0, 2, 3]])]))
    assert mesh.nelements == 6
    assert area(mesh) == pytest.approx(1.0, rel=1e-12)
    assert mesh_quality(mesh).min() > 0.3


def test_triangles_and_quadrilaterals_together(tmp_path):
    points = [*SQUARE, (2, 0, 0), (5, 5, 0)]  # the last one belongs to no element
    cells = [("line", [[0, 1]]), ("quad", [[0, 1, 2, 3]]), ("triangle", [[1, 4, 2]])]
    mesh = read_mesh(write(tmp_path / "section.vtk", points, cells))
    assert mesh.nelements == 7
    assert area(mesh) == pytest.approx(1.5, rel=1e-12)
    assert mesh.p.max() == 2.0
    # One body: quadrilaterals of both kinds share the vertices of their common side.
    assert len(mesh.boundary_facets()) == 2 * 5


def test_curved_edges_are_kept(tmp_path):
    cells = [("triangle6", [[0, 1, 2, 4, 5, 6], [0, 2, 3, 6, 7, 8]])]
    mesh = read_mesh(write(tmp_path / "section.vtk", HALF_DISC, cells))
    # Each arc is a parabola with 2/3 of its sagitta times its chord beside the triangle.
    exact = 2 * (0.5 + 2.0 / 3.0 * (1.0 - C) * np.sqrt(2.0))
    assert area(mesh) == pytest.approx(exact, rel=1e-12)
    eight = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, -1.2, 0), (1.2, 0, 0), (0, 1.2, 0), (-1.2, 0, 0)]
    mesh = read_mesh(write(tmp_path / "eight.vtk", eight, [("quad8", [list(range(8))])]))
    assert area(mesh) == pytest.approx(4.0 + 4.0 * 2.0 / 3.0 * 2.0 * 0.2, rel=1e-12)
    nine = read_mesh(write(tmp_path / "nine.vtk", [*eight, (0, 0, 0)], [("quad9", [list(range(9))])]))
    assert area(nine) == pytest.approx(area(mesh), rel=1e-12)


@pytest.mark.parametrize(
    ("points", "cells", "message"),
    [
        ([*SQUARE[:3], (0, 0, 1)], [("tetra", [[0, 1, 2, 3]])], "elements of type tetra; a section needs plane"),
        ([*SQUARE[:3], (0, 1, 0.1)], [("quad", [[0, 1, 2, 3]])], "isn't plane"),
        (SQUARE, [("line", [[0, 1], [1, 2]])], "no plane elements"),
        ([*SQUARE, (2, 0, 0), (3, 0, 0), (2, 1, 0)], [("triangle", [[0, 1, 2], [4, 5, 6]])], "2 pieces"),
        ([(0, 0, 0), (1, 0, 0), (0.2, 0.2, 0), (0, 1, 0)], [("quad", [[0, 1, 2, 3]])], "folded or empty"),
    ],
)
def test_what_is_no_section_is_refused(tmp_path, points, cells, message):
    path = write(tmp_path / "section.vtk", points, cells)
    with pytest.raises(ValueError, match=message) as caught:
        read_mesh(path)
    assert "section.vtk" in str(caught.value)


def test_files_that_are_no_meshes(tmp_path):
    with pytest.raises(ValueError, match="no such file"):
        read_mesh(tmp_path / "nothing.msh")
    for name in ("notes.txt", "broken.vtk", "broken.msh"):
        (tmp_path / name).write_text("this is no mesh\n", encoding="utf-8")
        with pytest.raises(ValueError, match=name):
            read_mesh(tmp_path / name)
