"""Cross-sections of wheels: presets, and a user's outline or mesh.

Coordinates (r, z) in m: radius, and axial position towards the flange with 0 at the tread centre, where the wheel
stands on the rail nominally. The points at the smallest radius are the hub's inner edge, where the wheel is held.

Presets
-------
synthetic-c20
    A wheel of 780 mm made up for this purpose (233 kg of steel), since the section of the C20 metro wheel of Pieringer
    (2011) isn't public. Its modes (7,0,a) and (2,c) are near 5.2 kHz as in the thesis; other figures differ.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from skfem import MeshQuad

from ..errors import DataFileError
from ..numerics.outline_file import OUTLINE_SUFFIXES, parse_outline, read_outline
from ..numerics.polygon import clean_polygon, polygon_area
from ..numerics.section_mesh import mesh_outline, read_mesh

__all__ = ["PRESETS", "WheelSection", "load_section"]

PRESETS = {"synthetic-c20": "synthetic_c20_section.csv"}
_COLUMNS = "r, z in m"
_ELEMENTS_ACROSS = 22.0  # square root of the section's area over the side of an element
_RADIUS_RANGE = (0.1, 1.0)  # m; of wheels
_HIGHEST_FLANGE = 0.1  # m above the tread centre
_FLANGE = 0.01  # m above the tread centre from which on a point belongs to a flange


@dataclass(frozen=True, eq=False)
class WheelSection:
    """Half section of a wheel.

    Parameters
    ----------
    name : str
        Preset or file.
    mesh : MeshQuad
        Quadrilaterals, coordinates (r, z) in m.

    Raises
    ------
    ValueError
        If this can't be the section of a wheel: wrong unit, no inner edge to hold it, no tread at z = 0, flange on the
        wrong side.
    """

    name: str
    mesh: MeshQuad

    def __post_init__(self) -> None:
        ends = _boundary(self.mesh)
        radii = ends[..., 0]
        inner, outer = float(radii.min()), float(radii.max())
        low, high = _RADIUS_RANGE
        if inner < 0.0:
            raise ValueError(f"the section reaches r = {inner:g} m; radii can't be negative")
        if not low <= outer <= high:
            unit = "; in millimetres? Coordinates must be in metres" if outer > high else ""
            raise ValueError(f"the largest radius is {outer:g} m; allowed: {low:g} to {high:g} m{unit}")
        on_hub = np.all(radii <= inner + 1e-6 * (outer - inner), axis=1)
        if not on_hub.any() or inner == 0.0:
            raise ValueError(
                f"no inner edge of the hub: the smallest radius, {inner:g} m, has to be a straight side along z, "
                "where the wheel is held"
            )
        tread = self.tread_radius
        if not outer - tread <= _HIGHEST_FLANGE:  # NaN where the section misses z = 0
            reach = f"{ends[..., 1].min():g} to {ends[..., 1].max():g} m"
            raise ValueError(
                f"no tread at z = 0, which has to be the tread centre; the section reaches from z = {reach}"
            )
        place = ends[..., 1].ravel()[np.argmax(radii)]
        if outer - tread > _FLANGE and place < 0.0:
            raise ValueError(f"the flange lies at z = {place:g} m; z has to be positive towards the flange")

    @property
    def tread_radius(self) -> float:
        """Radius at the tread centre in m; NaN where the section has none."""
        (r0, r1), (z0, z1) = np.moveaxis(_boundary(self.mesh), 0, 2).swapaxes(0, 1)
        crossing = (np.minimum(z0, z1) <= 0.0) & (np.maximum(z0, z1) >= 0.0) & (z0 != z1)
        if not crossing.any():
            return float("nan")
        share = z0[crossing] / (z0 - z1)[crossing]
        return float(np.max(r0[crossing] + share * (r1 - r0)[crossing]))


def load_section(source: str, folder: Path | None = None, *, element_size: float | None = None) -> WheelSection:
    """Find a section by the name of a preset or read it from a file.

    Parameters
    ----------
    source : str
        A name of `PRESETS`; or a file with the outline's points in turn (``.csv``, ``.txt`` or ``.json``, see
        `read_outline`); or any mesh file that meshio reads. Coordinates (r, z) in m.
    folder : Path, optional
        What a file's name is relative to.
    element_size : float, optional
        Side of the elements in an outline, m; by default the root of its area over 22, which keeps the frequencies of
        `PRESETS` within 0.2 %. A mesh file is taken as it is.

    Returns
    -------
    WheelSection

    Raises
    ------
    DataFileError
        If there is no such preset or file, or it holds no section of a wheel.
    """
    if source.lower() in PRESETS:
        text = files("wheelrail.wheel").joinpath(PRESETS[source.lower()]).read_text(encoding="utf-8")
        return WheelSection(source.lower(), _mesh(parse_outline(text, columns=_COLUMNS), element_size))
    path = Path(source) if folder is None else folder / source
    if not path.is_file():
        raise DataFileError(f"{source}: neither a preset section ({', '.join(PRESETS)}) nor a file")
    try:
        if path.suffix.lower() in OUTLINE_SUFFIXES:
            mesh: MeshQuad = _mesh(read_outline(path, columns=_COLUMNS), element_size)
        else:
            mesh = read_mesh(path)
        return WheelSection(path.name, mesh)
    except ValueError as error:
        message = str(error)
        raise DataFileError(message if message.startswith(str(path)) else f"{path}: {message}") from error


def _mesh(points: NDArray, element_size: float | None) -> MeshQuad:
    outline = clean_polygon(points)
    return mesh_outline(outline, size=element_size or np.sqrt(polygon_area(outline)) / _ELEMENTS_ACROSS)


def _boundary(mesh: MeshQuad) -> NDArray:
    """Return the ends of the boundary's sides, shape (sides, 2, 2): side, end, coordinate."""
    return mesh.p.T[np.asarray(mesh.facets)[:, mesh.boundary_facets()].T]
