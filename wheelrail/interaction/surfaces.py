"""What the contact sees of wheel and rail at a step: their shape where they meet, and all roughness on it.

Heights are combined, r = r_W - r_R with both positive along z' (Pieringer 2011, section 3.5), so that they add to the
indentation. A contact model with radii of its own gets the roughness; one for profiles gets the profiles with it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..contact.geometry import ContactPlace
from .inputs import Inputs
from .model import Model

__all__ = ["Surfaces", "total_shift"]


def total_shift(model: Model, inputs: Inputs) -> float:
    """Return the lateral shift of the wheel on the rail, m; a wheel that the vehicle moves adds its displacement."""
    if model.parameters.coupling == "displacement":
        return inputs.lateral_shift + inputs.wheel_y
    return inputs.lateral_shift


class Surfaces:
    """Work space of one run: the heights of the present step, and the geometry of the last lateral shift.

    Parameters
    ----------
    model : Model

    Attributes
    ----------
    place : ContactPlace
        Where the bodies touch first at the last shift.
    """

    __slots__ = ("_distance", "_index", "_level", "_line", "_offsets", "_rows", "_shift", "_surface", "place")

    place: ContactPlace

    def __init__(self, model: Model) -> None:
        contact = model.contact
        self._line = np.zeros(contact.nodes)
        self._rows = contact.rows
        self._offsets = contact.lateral_offsets
        several = contact.rows > 1 and (model.geometry.shaped or any(line.across for line in model.lines))
        self._surface = np.zeros((contact.rows if several else 1, contact.nodes))
        self._shift: float | None = None
        self._distance: NDArray | None = None
        self._index, self._level = 0, 0.0

    def move(self, model: Model, shift: float) -> None:
        """Find the place of contact for a lateral shift; nothing is done if it is the last one.

        Parameters
        ----------
        model : Model
        shift : float
            m.

        Raises
        ------
        ParameterError
            If wheel and rail don't touch there.
        """
        if shift == self._shift:
            return
        geometry = model.active_geometry
        place, distance = geometry.place(shift), None
        if geometry.shaped and self._rows > 1:
            x = (np.arange(len(self._line)) - len(self._line) // 2) * model.dx
            distance = geometry.distance(shift, x, self._offsets)
        self._shift = None  # whatever interrupts the next lines, they will be done again
        self.place, self._distance = place, distance
        self._shift = shift

    def smooth(self) -> NDArray:
        """Heights without roughness at the last shift, m."""
        return np.full(len(self._line), self.place.lift) if self._distance is None else -self._distance

    def contacts(self, model: Model, approach: float, force: float) -> tuple[int, float]:
        """Count the places where the bodies overlap in the present step.

        Parameters
        ----------
        model : Model
        approach : float
            m.
        force : float
            N; at the first place.

        Returns
        -------
        points : int
        missed : float
            Largest overlap of the undeformed bodies at places outside of the contact model's grid, m.
        """
        points, missed = int(force > 0.0), 0.0
        reach = float(self._offsets[-1])
        height = np.zeros((1, 1))
        for other in self.place.others:
            height.fill(0.0)
            for source in model.lines:
                if source.across:
                    source.add_surface(self._index, np.array([other.y_wheel]), np.array([other.y_rail]), height)
            rough = self._level + model.parameters.roughness_scale * float(height[0, 0])
            overlap = approach + self.place.lift + rough - other.gap
            if overlap > 0.0:
                points += 1
                if abs(other.y_rail - self.place.y_rail) > reach:
                    missed = max(missed, overlap)
        return points, missed

    def heights(self, model: Model, index: int) -> NDArray:
        """Evaluate the combined heights around grid index ``index`` at the last shift, m.

        Parameters
        ----------
        model : Model
        index : int

        Returns
        -------
        ndarray, shape (nodes,) or (rows, nodes)
            One row if all rows are the same. Work space: overwritten by the next call.
        """
        line, surface = self._line, self._surface
        line.fill(0.0)
        first = index - len(line) // 2
        across = False
        for source in model.lines:
            if source.across:
                across = True
            else:
                source.add_window(first, line)
        scale = model.parameters.roughness_scale
        if scale != 1.0:
            line *= scale
        self._index, self._level = index, float(line[len(line) // 2])
        if self._distance is None and self.place.lift:
            line += self.place.lift
        if not across and self._distance is None:
            return line
        surface.fill(0.0)
        if across:
            offsets = self._offsets if len(surface) > 1 else np.zeros(1)
            y_wheel, y_rail = self.place.y_wheel + offsets, self.place.y_rail + offsets
            for source in model.lines:
                if source.across:
                    source.add_surface(first, y_wheel, y_rail, surface)
            if scale != 1.0:
                surface *= scale
        surface += line
        if self._distance is not None:
            surface -= self._distance
        return surface[0] if len(surface) == 1 else surface
