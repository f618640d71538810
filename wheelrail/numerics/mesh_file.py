"""Plane meshes from files of other programs, as far as meshio reads them."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from skfem import MeshQuad2

from .quad_mesh import curved_quads, mesh_quality, split_triangles

__all__ = ["read_mesh"]

CORNERS = {"triangle": 3, "triangle6": 3, "quad": 4, "quad8": 4, "quad9": 4}
IGNORED = {"vertex", "line", "line3"}


def read_mesh(path: str | Path) -> MeshQuad2:
    """Read a plane mesh and turn it into quadrilaterals.

    Quadrilaterals alone stay as they are. A triangle becomes three of them; in a mesh of both, a quadrilateral becomes
    four. Curved edges of quadratic elements are kept.

    Parameters
    ----------
    path : str or Path
        Any format that meshio knows, with triangles and quadrilaterals of first or second order in one plane
        z = constant.

    Returns
    -------
    MeshQuad2
        Nine-node elements, in the file's unit of length.

    Raises
    ------
    ValueError
        If the file can't be read or doesn't hold a sound plane mesh in one piece.
    """
    path = Path(path)
    if not path.is_file():
        raise ValueError(f"{path}: no such file")
    try:
        content = meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio ends the program when no reader fits
        raise ValueError(f"{path}: can't be read as a mesh ({str(error).strip() or 'unknown format'})") from error
    try:
        return _convert(content)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error


def _convert(content: meshio.Mesh) -> MeshQuad2:
    blocks = [(block.type, np.asarray(block.data)) for block in content.cells if block.type not in IGNORED]
    foreign = sorted({kind for kind, _ in blocks} - set(CORNERS))
    if foreign:
        raise ValueError(
            f"holds elements of type {', '.join(foreign)}; a section needs plane elements ({', '.join(CORNERS)})"
        )
    if sum(len(cells) for _, cells in blocks) == 0:
        raise ValueError(f"holds no plane elements ({', '.join(CORNERS)})")
    points = np.asarray(content.points, dtype=float)
    if points.shape[1] == 3:
        if np.ptp(points[:, 2]) > 1e-9 * np.ptp(points[:, :2], axis=0).max():
            raise ValueError("isn't plane: its third coordinate varies; a section lies in the plane of the first two")
        points = points[:, :2]
    if not np.all(np.isfinite(points)):
        raise ValueError("has coordinates that aren't finite numbers")
    triangles = np.concatenate([np.zeros((0, 3), int), *(c[:, :3] for kind, c in blocks if CORNERS[kind] == 3)])
    quads = np.concatenate([np.zeros((0, 4), int), *(c[:, :4] for kind, c in blocks if CORNERS[kind] == 4)])
    edges, middles = _middles(blocks)
    _check_connected(points, triangles, quads)
    if len(triangles) == 0:
        mesh = curved_quads(points, quads, edges, points[middles])
    else:
        a, b, m = points[edges[:, 0]], points[edges[:, 1]], points[middles]
        # The parabola through the three points, at a quarter and three quarters.
        quarter = 0.375 * a + 0.75 * m - 0.125 * b
        last = 0.375 * b + 0.75 * m - 0.125 * a
        mesh = split_triangles(points, triangles, edges, np.stack([quarter, m, last], axis=1), quads)
    worst = mesh_quality(mesh)
    if worst.min() <= 0.0:
        place = mesh.p[:, mesh.t[:, np.argmin(worst)]].mean(axis=1)
        raise ValueError(f"has a folded or empty element near ({place[0]:g}, {place[1]:g})")
    return mesh


def _middles(blocks: list[tuple[str, NDArray]]) -> tuple[NDArray, NDArray]:
    """Edges of quadratic elements, shape (k, 2), and the numbers of their middle nodes, shape (k,)."""
    edges, middles = [np.zeros((0, 2), int)], [np.zeros(0, int)]
    for kind, cells in blocks:
        if kind in ("triangle6", "quad8", "quad9"):
            corners = CORNERS[kind]
            for i in range(corners):
                edges.append(cells[:, [i, (i + 1) % corners]])
                middles.append(cells[:, corners + i])
    ends = np.concatenate(edges)
    _, first = np.unique(np.sort(ends, axis=1), axis=0, return_index=True)
    return ends[first], np.concatenate(middles)[first]


def _check_connected(points: NDArray, triangles: NDArray, quads: NDArray) -> None:
    pairs = np.concatenate([cells[:, [i, i - 1]] for cells in (triangles, quads) for i in range(cells.shape[1])])
    size = len(points)
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(size, size))
    _, label = connected_components(graph, directed=False)
    pieces = len(np.unique(label[np.unique(pairs)]))
    if pieces > 1:
        raise ValueError(f"falls into {pieces} pieces that share no nodes; merge the nodes of neighbouring elements")
