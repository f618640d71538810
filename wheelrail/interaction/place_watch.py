"""What a user should know about the place of contact during a run, said once while it lasts."""

from __future__ import annotations

from .inputs import Inputs
from .model import Model

__all__ = ["STEEP", "PlaceWatch"]

STEEP = 0.15
"""Contact angle in rad from which normal and vertical forces differ by more than a percent."""


class PlaceWatch:
    """Watches the place of contact of one run; not part of its state."""

    __slots__ = ("_away", "_missed", "_steep")

    def __init__(self) -> None:
        self._missed = self._steep = self._away = False

    def look(self, model: Model, inputs: Inputs, *, overlap: float, angle: float, step: int) -> list[str]:
        """Look at some steps.

        Parameters
        ----------
        model : Model
        inputs : Inputs
        overlap : float
            Largest overlap at places outside of the contact model's grid, m.
        angle : float
            Largest contact angle to either side, rad.
        step : int
            Number of the last of the steps.

        Returns
        -------
        list of str
            What is new.
        """
        said = []
        if overlap > 0.0 and not self._missed:
            said.append(
                f"wheel and rail also touch outside of the potential contact area (up to step {step}, overlap "
                f"{1e6 * overlap:.3g} um without deformation): what this second contact bears is left out; a "
                "half-space with a wider contact.width may take it in"
            )
        if angle > STEEP and not self._steep:
            said.append(
                f"the contact angle is {angle:.3g} rad (up to step {step}): the force normal to the contact is taken "
                "for the vertical one, and its lateral part is left out"
            )
        self._missed, self._steep = overlap > 0.0, angle > STEEP
        away = inputs.lateral_shift != model.start_inputs.lateral_shift
        if away and not self._away and model.geometry.shaped and model.contact.rows == 1:
            said.append(
                "the contact keeps the radii of the case's lateral_shift: a Hertz spring and a Winkler bedding follow "
                "a live lateral_shift in height alone; a half-space follows it in shape"
            )
            self._away = True
        return said
