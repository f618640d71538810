"""Cross-sections of rails: outline, area and second moments, head, foot and symmetry plane, and a mesh.

Coordinates: x lateral, towards the field side of the wheel, from the symmetry plane; y up from the foot's underside;
metres.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from skfem import MeshQuad2

from ..numerics.polygon import clean_polygon, polygon_area
from ..numerics.quad_mesh import curved_quads, mesh_edges
from ..numerics.section_mesh import mesh_outline

__all__ = ["RailSection", "section_from_mesh"]

_SYMMETRY = 1e-4  # largest deviation of a mirrored outline, relative to the height
_FLAT = 1e-6  # largest height of points of the underside, relative to the height of the section
_STEEPEST = 0.5  # least vertical part of the outline's normal where a wheel may stand
_HEAD = 0.7  # the head's running surface lies above this share of the height


@dataclass(frozen=True, eq=False)
class RailSection:
    """Cross-section of a rail.

    Parameters
    ----------
    outline : array_like, shape (n, 2)
        Simple polygon, x lateral and y up, m. It is moved so that its lowest points have y = 0 and, if it has a
        vertical symmetry plane, that this is x = 0.
    name : str
    given_mesh : MeshQuad2, optional
        Mesh of the section in the coordinates of ``outline``; else one is made.

    Raises
    ------
    ValueError
        If the outline crosses itself or has no flat underside.
    """

    outline: NDArray
    name: str = "rail"
    given_mesh: MeshQuad2 | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        points = clean_polygon(self.outline)
        centre, height = _centroid(points)[0], float(np.ptp(points[:, 1]))
        mirrored = np.column_stack([2.0 * centre - points[:, 0], points[:, 1]])
        symmetric = _distance(points, mirrored).max() <= _SYMMETRY * height
        shift = np.array([centre if symmetric else 0.0, points[:, 1].min()])
        object.__setattr__(self, "outline", points - shift)
        object.__setattr__(self, "_symmetric", bool(symmetric))
        if self.given_mesh is not None:
            object.__setattr__(self, "given_mesh", self.given_mesh.translated(tuple(-shift)))
        left, right = self.foot
        if not right - left > 1e-3 * height:
            raise ValueError("the section has no flat underside on which it could rest")

    @property
    def symmetric(self) -> bool:
        """Whether x = 0 is a symmetry plane."""
        return self._symmetric  # type: ignore[attr-defined]

    @property
    def height(self) -> float:
        """Height in m."""
        return float(self.outline[:, 1].max())

    @cached_property
    def foot(self) -> tuple[float, float]:
        """Lateral ends of the flat underside in m."""
        low = self.outline[:, 1] <= _FLAT * self.height
        sides = low & np.roll(low, -1)
        if not sides.any():
            return 0.0, 0.0
        x = np.concatenate([self.outline[sides, 0], np.roll(self.outline, -1, axis=0)[sides, 0]])
        return float(x.min()), float(x.max())

    @cached_property
    def area(self) -> float:
        """Area in m2."""
        return polygon_area(self.outline)

    @cached_property
    def centroid(self) -> tuple[float, float]:
        """Centroid (x, y) in m."""
        x, y = _centroid(self.outline)
        return float(x), float(y)

    @cached_property
    def second_moments(self) -> tuple[float, float, float]:
        """Second moments of area about the centroid in m4.

        About the lateral axis (for vertical bending), about the vertical axis (for lateral bending), and the product.
        """
        x, y = (self.outline - self.centroid).T
        xn, yn = np.roll(x, -1), np.roll(y, -1)
        cross = x * yn - xn * y
        lateral = float(np.sum(cross * (y**2 + y * yn + yn**2)) / 12.0)
        vertical = float(np.sum(cross * (x**2 + x * xn + xn**2)) / 12.0)
        product = float(np.sum(cross * (x * yn + 2.0 * (x * y + xn * yn) + xn * y)) / 24.0)
        return lateral, vertical, product

    def mass_per_length(self, density: float) -> float:
        """Mass per length in kg/m for a density in kg/m3."""
        return density * self.area

    @cached_property
    def head(self) -> tuple[float, float]:
        """Lateral ends of the part of the head's top on which a wheel may stand, in m."""
        along = np.roll(self.outline, -1, axis=0) - self.outline
        middle = self.outline + 0.5 * along
        # The outline runs anticlockwise, so its outward normal is (dy, -dx).
        running = (-along[:, 0] >= _STEEPEST * np.hypot(*along.T)) & (middle[:, 1] >= _HEAD * self.height)
        ends = np.concatenate([self.outline[running, 0], (self.outline + along)[running, 0]])
        return float(ends.min()), float(ends.max())

    def check_contact_position(self, position: float) -> None:
        """Check that a wheel may stand at a lateral position in m.

        Raises
        ------
        ValueError
            With the range that is allowed.
        """
        left, right = self.head
        if not left <= position <= right:
            raise ValueError(
                f"a contact {position:g} m beside the rail's centre isn't on the head's top; "
                f"allowed: {left:.4f} to {right:.4f} m"
            )

    def mesh(self, size: float, keep: ArrayLike = ()) -> MeshQuad2:
        """Return a mesh of nine-node quadrilaterals; symmetric if the section is, the given one if there is one.

        Parameters
        ----------
        size : float
            Side of the quadrilaterals in m.
        keep : array_like, shape (k,), optional
            Lateral positions on the underside at which a vertex must lie.
        """
        if self.given_mesh is not None:
            return self.given_mesh
        points = np.array([(x, 0.0) for x in np.atleast_1d(np.asarray(keep, dtype=float))]).reshape(-1, 2)
        half = _right_half(self.outline) if self.symmetric else None
        if half is None:
            return mesh_outline(self.outline, size=size, keep=points)
        return _mirror(mesh_outline(half, size=size, keep=points[points[:, 0] > 0.0]))


def section_from_mesh(mesh: MeshQuad2, name: str = "rail") -> RailSection:
    """Make a section from a mesh, whose boundary becomes the outline.

    Raises
    ------
    ValueError
        If the mesh has holes.
    """
    facets = mesh.boundary_facets()
    ends, middles = mesh_edges(mesh)
    ends, middles = ends[:, facets], mesh.doflocs[:, middles[facets]].T
    neighbours: dict[int, list[tuple[int, int]]] = {}
    for number, (a, b) in enumerate(ends.T):
        neighbours.setdefault(int(a), []).append((int(b), number))
        neighbours.setdefault(int(b), []).append((int(a), number))
    if any(len(others) != 2 for others in neighbours.values()):
        raise ValueError("the mesh's boundary meets itself in a point")
    start = vertex = int(ends[0, 0])
    used, points = set(), []
    while True:
        following = next(((v, e) for v, e in neighbours[vertex] if e not in used), None)
        if following is None:
            break
        a, b, m = mesh.p[:, vertex], mesh.p[:, following[0]], middles[following[1]]
        for s in np.arange(8) / 8.0:  # the edge is a parabola
            points.append((1 - s) * (1 - 2 * s) * a + 4 * s * (1 - s) * m + s * (2 * s - 1) * b)
        used.add(following[1])
        vertex = following[0]
    if vertex != start or len(used) != len(facets):
        raise ValueError("the mesh has a hole; a rail's section has none")
    outline = np.array(points)
    # Beside a flat underside the parabola of a rounded corner may reach below it.
    outline[:, 1] = np.maximum(outline[:, 1], mesh.p[1, : mesh.nvertices].min())
    return RailSection(outline, name, mesh)


def _centroid(points: NDArray) -> NDArray:
    following = np.roll(points, -1, axis=0)
    cross = points[:, 0] * following[:, 1] - following[:, 0] * points[:, 1]
    return np.sum((points + following) * cross[:, None], axis=0) / (6.0 * polygon_area(points))


def _distance(polygon: NDArray, points: NDArray) -> NDArray:
    """Distances of points from a polygon's outline."""
    along = np.roll(polygon, -1, axis=0) - polygon
    result = np.empty(len(points))
    for i, point in enumerate(points):
        share = np.clip(np.sum((point - polygon) * along, axis=1) / np.sum(along**2, axis=1), 0.0, 1.0)
        result[i] = np.hypot(*(polygon + share[:, None] * along - point).T).min()
    return result


def _right_half(outline: NDArray) -> NDArray | None:
    """Cut an outline at x = 0; None if that gives more than one piece."""
    following = np.roll(outline, -1, axis=0)
    tiny = 1e-9 * outline[:, 1].max()
    points, crossings = [], 0
    for (xa, ya), (xb, yb) in zip(outline, following, strict=True):
        if xa >= -tiny:
            points.append((0.0 if abs(xa) <= tiny else xa, ya))
            crossings += abs(xa) <= tiny
        if (xa < -tiny and xb > tiny) or (xa > tiny and xb < -tiny):
            points.append((0.0, ya - xa * (yb - ya) / (xb - xa)))
            crossings += 1
    return np.array(points) if crossings == 2 else None


def _mirror(half: MeshQuad2) -> MeshQuad2:
    """Join a mesh of the right half and its mirror image."""
    vertices = half.p[:, : half.nvertices].T
    size = len(vertices)
    on_axis = np.abs(vertices[:, 0]) <= 1e-9 * np.ptp(vertices[:, 1])
    image = np.where(on_axis, np.arange(size), size + np.arange(size))
    both = np.concatenate([vertices, vertices * [-1.0, 1.0]])
    facets = half.boundary_facets()
    edges, middles = mesh_edges(half)
    edges, middles = edges[:, facets].T, half.doflocs[:, middles[facets]].T
    inner = on_axis[edges].all(axis=1)
    edges, middles = edges[~inner], middles[~inner]
    return curved_quads(
        both,
        np.concatenate([half.t.T, image[half.t.T[:, ::-1]]]),
        np.concatenate([edges, image[edges]]),
        np.concatenate([middles, middles * [-1.0, 1.0]]),
    )
