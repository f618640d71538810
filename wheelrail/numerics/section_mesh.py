"""Quadrilateral meshes of plane sections.

A polygon is filled with triangles, whose points are moved until they are regular (Chen and Holst 2011, their centroidal
patch), and each triangle is split into three quadrilaterals. Edges along smooth stretches of the outline follow it as
parabolas, so that a fillet needs few elements.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import Delaunay, KDTree
from skfem import MeshQuad2

from .mesh_file import read_mesh
from .polygon import Outline, clean_polygon, is_inside
from .quad_mesh import mesh_quality, split_triangles

__all__ = ["mesh_outline", "mesh_quality", "read_mesh"]

CORNER = np.radians(30.0)  # where an outline turns more than this at one point, it has a corner
TURN = np.radians(60.0)  # of the outline along one triangle
THINNEST = 0.2  # least local size in thin places, relative to the size asked for
GRADING = 0.4  # growth of the size with the distance from a finer place
SWEEPS = 40  # of smoothing
REFINEMENTS = 20  # times that sides may be halved which the triangles miss
LARGEST = 200_000  # triangles
ATTEMPTS = 6  # at a mesh without poor elements
REFINED = 0.8  # size at poor elements in the next attempt, relative to the last
POOR = 0.35  # scaled Jacobian below which an element is poor
WORST = 0.05  # scaled Jacobian below which a mesh is refused


def mesh_outline(points: ArrayLike, *, size: float, keep: ArrayLike = ()) -> MeshQuad2:
    """Fill a polygon with quadrilaterals.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Corners of a simple polygon in turn, either way round; the first may be repeated at the end. Points where it
        turns by less than 30 degrees are taken as points of a smooth curve.
    size : float
        Side of the quadrilaterals, in the unit of the points; they get smaller where the outline is curved.
    keep : array_like, shape (k, 2), optional
        Points of the outline at which a vertex must lie, beside the corners.

    Returns
    -------
    MeshQuad2
        Nine-node elements; those along smooth stretches have curved edges.

    Raises
    ------
    ValueError
        If the polygon crosses itself, is too thin to be meshed, or if ``size`` isn't positive or far too small.
    """
    polygon = clean_polygon(points)
    if not size > 0.0:
        raise ValueError(f"the element size must be positive; it is {size:g}")
    triangle_size = 2.0 * size
    if np.prod(np.ptp(polygon, axis=0)) > 0.5 * LARGEST * triangle_size**2:
        raise ValueError(f"the element size {size:g} would give more than {3 * LARGEST} elements")
    polygon, kept = _insert(polygon, np.asarray(keep, dtype=float).reshape(-1, 2))
    outline = Outline(polygon)
    sizes = _SizeField(outline, triangle_size)
    best, best_quality, worst = None, -np.inf, np.zeros(2)
    for _ in range(ATTEMPTS):
        mesh = _mesh(polygon, outline, sizes, kept)
        quality = mesh_quality(mesh)
        if quality.min() > best_quality:
            best, best_quality, worst = mesh, quality.min(), mesh.p[:, mesh.t[:, quality.argmin()]].mean(axis=1)
        poor = mesh.p[:, mesh.t[:, quality < POOR]].mean(axis=1).T
        if len(poor) == 0:
            break
        sizes.refine(poor)
    if best is None or best_quality < WORST:
        raise ValueError(
            f"no sound mesh with elements of {size:g} near ({worst[0]:g}, {worst[1]:g}); "
            "choose smaller elements or an outline without such sharp corners"
        )
    return best


def _mesh(polygon: NDArray, outline: Outline, sizes: _SizeField, kept: NDArray) -> MeshQuad2:
    position = _along(outline, sizes, kept)
    inner = _fill(polygon, outline.at(position), sizes)
    position, inner, triangles = _triangulate(outline, position, inner, sizes)
    count = len(position)
    gap = np.diff(np.append(position, position[0] + outline.length))
    curves = np.stack([outline.at(position + share * gap) for share in (0.25, 0.5, 0.75)], axis=1)
    edges = np.column_stack([np.arange(count), np.roll(np.arange(count), -1)])
    return split_triangles(np.concatenate([outline.at(position), inner]), triangles, edges, curves)


def _insert(polygon: NDArray, keep: NDArray) -> tuple[NDArray, NDArray]:
    """Make points of the outline corners of the polygon; return it and the numbers of the points kept."""
    extent = np.ptp(polygon, axis=0).max()
    for point in keep:
        start, along = polygon, np.roll(polygon, -1, axis=0) - polygon
        share = np.clip(np.sum((point - start) * along, axis=1) / np.sum(along**2, axis=1), 0.0, 1.0)
        distance = np.hypot(*(start + share[:, None] * along - point).T)
        side = int(np.argmin(distance))
        if distance[side] > 1e-6 * extent:
            raise ValueError(f"the point ({point[0]:g}, {point[1]:g}) isn't on the outline")
        if np.hypot(*(polygon - point).T).min() > 1e-6 * extent:
            polygon = np.insert(polygon, side + 1, point, axis=0)
    kept = [int(np.argmin(np.hypot(*(polygon - point).T))) for point in keep]
    return polygon, np.array(kept, dtype=int)


class _SizeField:
    """Side of the triangles at any place."""

    def __init__(self, outline: Outline, largest: float) -> None:
        self.largest = largest
        turning = np.where(np.abs(outline.turning) > CORNER, 0.0, np.abs(outline.turning))
        length = np.diff(outline.position)
        # Curvature at a point of a polygon: its turn over half of the two sides that meet there.
        curvature = turning / (0.5 * (length + np.roll(length, 1)))
        local = TURN / np.maximum(curvature, TURN / largest)
        places, thickness = _thickness(outline, largest)
        points = np.concatenate([outline.points, places])
        local = np.concatenate([local, np.maximum(thickness, THINNEST * largest)])
        fine = local < largest
        self._points, self._local = points[fine], local[fine]

    def refine(self, places: NDArray) -> None:
        """Ask for smaller triangles at some places."""
        local = REFINED * self(places)
        self._points = np.concatenate([self._points, places])
        self._local = np.concatenate([self._local, local])

    def __call__(self, places: NDArray) -> NDArray:
        sizes = np.full(len(places), self.largest)
        for first in range(0, len(places) if len(self._points) else 0, 1024):
            part = places[first : first + 1024]
            distance = np.hypot(*(part[:, None] - self._points).T).T
            sizes[first : first + 1024] = np.minimum(self.largest, (self._local + GRADING * distance).min(axis=1))
        return sizes


def _thickness(outline: Outline, largest: float) -> tuple[NDArray, NDArray]:
    """Places along the outline and the way from each, straight inwards, to the other side."""
    number = max(64, int(outline.length / (0.5 * largest)))
    position = (np.arange(number) + 0.5) * outline.length / number
    places = outline.at(position)
    start = outline.points
    along = np.roll(start, -1, axis=0) - start
    own = np.searchsorted(outline.position, position, side="right") - 1
    inward = np.column_stack([-along[own, 1], along[own, 0]]) / np.hypot(*along[own].T)[:, None]
    thickness = np.full(number, np.inf)
    for i, (place, normal) in enumerate(zip(places, inward, strict=True)):
        to = start - place
        cross = normal[0] * along[:, 1] - normal[1] * along[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            way = (to[:, 0] * along[:, 1] - to[:, 1] * along[:, 0]) / cross
            share = (to[:, 0] * normal[1] - to[:, 1] * normal[0]) / cross
        hit = (way > 0.0) & (share >= 0.0) & (share <= 1.0)
        hit[own[i]] = False
        thickness[i] = way[hit].min(initial=np.inf)
    return places, thickness


def _along(outline: Outline, sizes: _SizeField, kept: NDArray) -> NDArray:
    """Lengths along the outline at which the triangles' vertices lie; all corners are among them."""
    corner = np.abs(outline.turning) > CORNER
    corner[kept] = True
    stops = outline.position[:-1][corner]
    if len(stops) == 0:
        stops = outline.position[:1]
    stops = np.append(stops, stops[0] + outline.length)
    found = []
    for begin, end in pairwise(stops):
        fine = np.linspace(begin, end, max(9, int(8.0 * (end - begin) / sizes.largest) + 1))
        fine = np.unique(np.concatenate([fine, np.linspace(begin, end, 65)]))
        density = 1.0 / sizes(outline.at(0.5 * (fine[1:] + fine[:-1])))
        total = np.concatenate([[0.0], np.cumsum(density * np.diff(fine))])
        number = max(1, int(np.ceil(total[-1] - 0.25)))
        if len(stops) <= 3:
            number = max(number, 2 if len(stops) == 3 else 3)
        found.append(np.interp(np.arange(number) * total[-1] / number, total, fine))
    position = np.concatenate(found)
    return np.sort(np.mod(position, outline.length))


def _fill(polygon: NDArray, boundary: NDArray, sizes: _SizeField) -> NDArray:
    """Points inside, from coarse to ever finer triangular lattices, each where the size asks for it."""
    lowest, highest = polygon.min(axis=0), polygon.max(axis=0)
    accepted = boundary
    spacing = sizes.largest
    finest = sizes(boundary).min()
    inner = np.empty((0, 2))
    while True:
        rows = np.arange(lowest[1], highest[1] + spacing, spacing * np.sqrt(0.75))
        columns = np.arange(lowest[0], highest[0] + spacing, spacing)
        x, y = np.meshgrid(columns, rows)
        x = x + 0.5 * spacing * (np.arange(len(rows)) % 2)[:, None]
        candidates = np.column_stack([x.ravel(), y.ravel()])
        wanted = sizes(candidates)
        candidates, wanted = candidates[wanted < 1.5 * spacing], wanted[wanted < 1.5 * spacing]
        free = KDTree(accepted).query(candidates)[0] > 0.75 * wanted if len(candidates) else np.zeros(0, bool)
        candidates, wanted = candidates[free], wanted[free]
        inside = is_inside(polygon, candidates)
        candidates, wanted = candidates[inside], wanted[inside]
        if len(candidates):
            tree = KDTree(candidates)
            taken = np.zeros(len(candidates), dtype=bool)
            for i, near in enumerate(tree.query_ball_point(candidates, 0.9 * wanted)):
                taken[i] = not taken[near].any()
            inner = np.concatenate([inner, candidates[taken]])
            accepted = np.concatenate([accepted, candidates[taken]])
        if spacing <= finest:
            return inner
        spacing *= 0.7


def _triangulate(
    outline: Outline, position: NDArray, inner: NDArray, sizes: _SizeField
) -> tuple[NDArray, NDArray, NDArray]:
    """Triangles whose sides cover the outline; returns the places along it, the points inside and the triangles."""
    for _ in range(REFINEMENTS):
        boundary = outline.at(position)
        inner = _smooth(boundary, inner, sizes)
        count = len(boundary)
        nodes = np.concatenate([boundary, inner])
        triangles = _inside_triangles(boundary, nodes)
        sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
        keys, uses = np.unique(sides[:, 0] * len(nodes) + sides[:, 1], return_counts=True)
        following = np.roll(np.arange(count), -1)
        low, high = np.minimum(np.arange(count), following), np.maximum(np.arange(count), following)
        at = np.minimum(np.searchsorted(keys, low * len(nodes) + high), len(keys) - 1)
        there = (keys[at] == low * len(nodes) + high) & (uses[at] == 1)
        if there.all() and np.count_nonzero(uses == 1) == count:
            return position, inner, triangles
        lost = ~there if not there.all() else np.ones(count, dtype=bool)
        position, inner = _halve(outline, position, inner, np.flatnonzero(lost))
    raise ValueError("the outline is too thin somewhere to be filled with triangles")


def _halve(outline: Outline, position: NDArray, inner: NDArray, sides: NDArray) -> tuple[NDArray, NDArray]:
    """Halve sides on the outline, given by their first vertex."""
    gap = np.diff(np.append(position, position[0] + outline.length))[sides]
    new = np.mod(position[sides] + 0.5 * gap, outline.length)
    # A point close to a new one would only make flat triangles.
    if len(inner):
        distance, nearest = KDTree(outline.at(new)).query(inner)
        inner = inner[distance > 0.3 * gap[nearest]]
    return np.sort(np.concatenate([position, new])), inner


def _inside_triangles(boundary: NDArray, nodes: NDArray) -> NDArray:
    triangles = Delaunay(nodes).simplices
    a, b, c = nodes[triangles].transpose(1, 0, 2)
    area = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    longest = np.max([np.sum((p - q) ** 2, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    # Three points of a straight side may come as a triangle without area.
    sound = np.abs(area) > 1e-6 * longest
    triangles = triangles[sound]
    triangles = triangles[is_inside(boundary, nodes[triangles].mean(axis=1))]
    return triangles if len(triangles) else np.zeros((0, 3), dtype=int)


def _smooth(boundary: NDArray, inner: NDArray, sizes: _SizeField) -> NDArray:
    """Move each point to the weighted mean of the centroids of the triangles around it, some times over."""
    if len(inner) == 0:
        return inner
    count = len(boundary)
    for _ in range(SWEEPS):
        nodes = np.concatenate([boundary, inner])
        triangles = _inside_triangles(boundary, nodes)
        centres = nodes[triangles].mean(axis=1)
        a, b, c = nodes[triangles].transpose(1, 0, 2)
        weight = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / sizes(centres) ** 4
        total, sums = np.zeros(len(nodes)), np.zeros_like(nodes)
        for corner in triangles.T:
            np.add.at(total, corner, weight)
            np.add.at(sums, corner, weight[:, None] * centres)
        moved = total[count:] > 0.0
        inner = inner[moved]
        inner = sums[count:][moved] / total[count:][moved, None]
    return inner[is_inside(boundary, inner)]
