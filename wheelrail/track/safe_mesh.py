"""Mesh of a rail with its pad, and how points of the head and the foot move with its nodes."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from skfem import MeshQuad2

from ..numerics.quad_mesh import curved_quads, mesh_edges
from .section import RailSection

__all__ = ["add_pad", "foot_weights", "head_weights", "pad_ends"]


def pad_ends(section: RailSection, width: float | None) -> tuple[float, float]:
    """Return the lateral ends of a pad under the middle of the foot, m; those of the flat underside without a width.

    Raises
    ------
    ValueError
        If the pad is wider than the underside.
    """
    left, right = section.foot
    if width is None:
        return left, right
    centre = 0.5 * (left + right)
    if not 0.0 < width <= (right - left) * (1.0 + 1e-9):
        raise ValueError(f"a pad {width:g} m wide doesn't fit the foot's flat underside of {right - left:g} m")
    return centre - 0.5 * width, centre + 0.5 * width


def _underside(mesh: MeshQuad2, ends: Sequence[float]) -> tuple[NDArray, NDArray]:
    """Edges of the underside between two lateral positions: vertices (2, m) and middle nodes (m,)."""
    vertices, middle = mesh_edges(mesh)
    height = np.ptp(mesh.p[1])
    flat = np.all(np.abs(mesh.p[1, vertices]) <= 1e-6 * height, axis=0)
    between = (mesh.doflocs[0, middle] > ends[0]) & (mesh.doflocs[0, middle] < ends[1])
    return vertices[:, flat & between], middle[flat & between]


def add_pad(rail: MeshQuad2, ends: Sequence[float], thickness: float, size: float) -> MeshQuad2:
    """Add layers of quadrilaterals under the foot between two lateral positions, after the rail's elements.

    Raises
    ------
    ValueError
        If no edge of the underside lies between them.
    """
    sides, _ = _underside(rail, ends)
    if sides.size == 0:
        raise ValueError("no edge of the mesh's underside rests on the pad; give a wider pad or a finer mesh")
    layers = max(2, round(thickness / size))
    top = np.unique(sides)
    count = rail.nvertices
    number = np.full(count, -1)
    number[top] = np.arange(len(top))
    vertices = [rail.p[:, :count].T]
    rows = [top]
    for layer in range(1, layers + 1):
        below = rail.p[:, top].T.copy()
        below[:, 1] = -thickness * layer / layers
        vertices.append(below)
        rows.append(count + (layer - 1) * len(top) + np.arange(len(top)))
    left, right = number[sides]
    quads = [np.column_stack([a[left], a[right], b[right], b[left]]) for a, b in pairwise(rows)]
    ends_of, middles = mesh_edges(rail)
    facets = rail.boundary_facets()
    return curved_quads(
        np.concatenate(vertices),
        np.concatenate([rail.t.T, *quads]),
        ends_of[:, facets].T,
        rail.doflocs[:, middles[facets]].T,
    )


def head_weights(mesh: MeshQuad2, position: float) -> NDArray:
    """Return the weights of the nodes by which the highest point at a lateral position moves."""
    facets = mesh.boundary_facets()
    (a, b), m = (nodes[..., facets] for nodes in mesh_edges(mesh))
    xa, xm, xb = (mesh.doflocs[0, nodes] for nodes in (a, m, b))
    weights = np.zeros(mesh.doflocs.shape[1])
    highest = -np.inf
    tiny = 1e-9 * np.ptp(mesh.p[0])
    for edge in np.flatnonzero((np.minimum(xa, xb) <= position + tiny) & (np.maximum(xa, xb) >= position - tiny)):
        if abs(xa[edge] - xb[edge]) <= tiny:
            continue
        # x(s) along the edge is a parabola through its three nodes.
        square, slope = 2.0 * (xa[edge] + xb[edge]) - 4.0 * xm[edge], 4.0 * xm[edge] - 3.0 * xa[edge] - xb[edge]
        roots = np.roots([square, slope, xa[edge] - position]) if abs(square) > tiny else []
        s = next((r.real for r in roots if abs(r.imag) < 1e-9 and -1e-9 <= r.real <= 1.0 + 1e-9), None)
        if s is None:
            s = (position - xa[edge]) / (xb[edge] - xa[edge])
        shape = np.array([(1.0 - s) * (1.0 - 2.0 * s), 4.0 * s * (1.0 - s), s * (2.0 * s - 1.0)])
        nodes = np.array([a[edge], m[edge], b[edge]])
        height = mesh.doflocs[1, nodes] @ shape
        if height > highest:
            highest = height
            weights[:] = 0.0
            weights[nodes] = shape
    return weights


def foot_weights(mesh: MeshQuad2, ends: Sequence[float]) -> tuple[NDArray, NDArray]:
    """Return the weights of the nodes for the mean over the underside and for its slope, the roll about x'."""
    (a, b), m = _underside(mesh, ends)
    length = np.abs(mesh.p[0, b] - mesh.p[0, a])
    area = np.zeros(mesh.doflocs.shape[1])
    # Simpson's rule, exact for a parabola times a line.
    np.add.at(area, a, length / 6.0)
    np.add.at(area, b, length / 6.0)
    np.add.at(area, m, 4.0 * length / 6.0)
    mean = area / area.sum()
    arm = mesh.doflocs[0] - mean @ mesh.doflocs[0]
    return mean, area * arm / (area @ arm**2)
