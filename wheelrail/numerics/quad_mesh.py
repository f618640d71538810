"""Meshes of quadratic quadrilaterals: from triangles, with edges that follow curves, and the quality of elements."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from skfem import MeshQuad, MeshQuad2

__all__ = ["curved_quads", "mesh_edges", "mesh_quality", "split_triangles"]


def curved_quads(vertices: ArrayLike, quads: ArrayLike, edges: ArrayLike, middles: ArrayLike) -> MeshQuad2:
    """Join quadrilaterals to a mesh of nine-node elements.

    Parameters
    ----------
    vertices : array_like, shape (n, 2)
    quads : array_like of int, shape (m, 4)
        Corners of each element, in turn; clockwise ones are turned round.
    edges : array_like of int, shape (k, 2)
        Edges that are curved; the others are straight.
    middles : array_like, shape (k, 2)
        Where the middle of each curved edge lies.

    Returns
    -------
    MeshQuad2
        Vertices that no element uses are left out.
    """
    vertices, quads = np.asarray(vertices, dtype=float), np.asarray(quads, dtype=int)
    used, quads = np.unique(quads, return_inverse=True)
    quads = quads.reshape(-1, 4)
    number = np.full(len(vertices), -1)
    number[used] = np.arange(len(used))
    vertices = vertices[used]
    diagonals = vertices[quads[:, 2:]] - vertices[quads[:, :2]]
    clockwise = diagonals[:, 0, 0] * diagonals[:, 1, 1] < diagonals[:, 0, 1] * diagonals[:, 1, 0]
    quads[clockwise] = quads[clockwise][:, ::-1]
    mesh = MeshQuad2.from_mesh(MeshQuad(np.ascontiguousarray(vertices.T), np.ascontiguousarray(quads.T)))
    places = mesh.doflocs.copy()
    edges = number[np.asarray(edges, dtype=int).reshape(-1, 2)]
    ends, middle = mesh_edges(mesh)
    if len(edges):
        facets, size = np.sort(ends, axis=0), len(vertices)
        keys = facets[0] * size + facets[1]
        order = np.argsort(keys)
        wanted = np.sort(edges, axis=1)
        found = order[np.searchsorted(keys[order], wanted[:, 0] * size + wanted[:, 1])]
        places[:, middle[found]] = np.asarray(middles, dtype=float).T
    # The centre goes with the edges, as in an eight-node element.
    around = places[:, middle[mesh.t2f]]
    places[:, np.asarray(mesh.dofs.interior_dofs)[0]] = 0.5 * around.sum(axis=1) - 0.25 * places[:, mesh.t].sum(axis=1)
    return MeshQuad2(places, mesh.t)


def mesh_edges(mesh: MeshQuad2) -> tuple[NDArray, NDArray]:
    """Return the nodes of all edges in the order of ``mesh.facets``: ends, shape (2, m), and middles, shape (m,)."""
    return np.asarray(mesh.facets), np.asarray(mesh.dofs.facet_dofs)[0]


def split_triangles(
    points: ArrayLike, triangles: ArrayLike, edges: ArrayLike, curves: ArrayLike, quads: ArrayLike = ()
) -> MeshQuad2:
    """Split each triangle into three quadrilaterals, and each quadrilateral that comes with them into four.

    Parameters
    ----------
    points : array_like, shape (n, 2)
    triangles : array_like of int, shape (m, 3)
    edges : array_like of int, shape (k, 2)
        Edges that are curved.
    curves : array_like, shape (k, 3, 2)
        Points at a quarter, a half and three quarters of each curved edge, from its first end to its second.
    quads : array_like of int, shape (q, 4), optional

    Returns
    -------
    MeshQuad2
    """
    points = np.asarray(points, dtype=float)
    triangles = np.asarray(triangles, dtype=int).reshape(-1, 3)
    quads = np.asarray(quads, dtype=int).reshape(-1, 4)
    edges = np.asarray(edges, dtype=int).reshape(-1, 2)
    curves = np.asarray(curves, dtype=float).reshape(-1, 3, 2)
    sides = np.concatenate([triangles, np.roll(triangles, -1, axis=1)]).reshape(2, -1).T
    sides = np.concatenate([sides, np.concatenate([quads, np.roll(quads, -1, axis=1)]).reshape(2, -1).T])
    unique, side = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    side = side.ravel()
    halves = 0.5 * (points[unique[:, 0]] + points[unique[:, 1]])
    size = len(points)
    keys = unique[:, 0] * size + unique[:, 1]
    ends = np.sort(edges, axis=1)
    curved = np.searchsorted(keys, ends[:, 0] * size + ends[:, 1])
    halves[curved] = curves[:, 1]
    half = size + side
    of_triangles, of_quads = half[: triangles.size].reshape(-1, 3), half[triangles.size :].reshape(-1, 4)
    centre = size + len(unique) + np.arange(len(triangles) + len(quads))
    parts = []
    for corners, middles, centres in (
        (triangles, of_triangles, centre[: len(triangles)]),
        (quads, of_quads, centre[len(triangles) :]),
    ):
        for i in range(corners.shape[1]):
            parts.append(np.column_stack([corners[:, i], middles[:, i], centres, middles[:, i - 1]]))
    vertices = np.concatenate([points, halves, points[triangles].mean(axis=1), points[quads].mean(axis=1)])
    bent = np.concatenate(
        [np.column_stack([edges[:, 0], size + curved]), np.column_stack([size + curved, edges[:, 1]])]
    )
    return curved_quads(vertices, np.concatenate(parts), bent, np.concatenate([curves[:, 0], curves[:, 2]]))


def mesh_quality(mesh: MeshQuad) -> NDArray:
    """Return the scaled Jacobian of every element, its least value over nine points; shape (m,).

    It is 1 for a rectangle, 0.87 for the pieces of an equilateral triangle and not positive for a folded element.
    """
    grid = np.array([(a, b) for a in (0.0, 0.5, 1.0) for b in (0.0, 0.5, 1.0)]).T
    jacobian = mesh.mapping().DF(grid)
    determinant = jacobian[0, 0] * jacobian[1, 1] - jacobian[0, 1] * jacobian[1, 0]
    return (determinant / np.prod(np.hypot(jacobian[0], jacobian[1]), axis=0)).min(axis=1)
