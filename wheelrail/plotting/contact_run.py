"""Pictures of the contact at steps of a run.

A run is the same every time, so its contact need not be stored: the case is run again up to the steps asked for.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wheelrail.contact.half_space_contact import HalfSpaceContact
from wheelrail.contact.point_contact import PointContact
from wheelrail.contact.slip_dependent_model import SlipDependentRolling
from wheelrail.contact.tangential_models import TransientRolling
from wheelrail.interaction.model import Model
from wheelrail.interaction.simulate import stand_alone_inputs
from wheelrail.interaction.start import start
from wheelrail.interaction.state import FORCE, FORCE_X, FORCE_Y, State
from wheelrail.interaction.step import step
from wheelrail.numerics.blas_threads import one_thread

from .animation import animate_contact
from .contact import contact_figure
from .contact_map import ContactMap
from .files import PlotError

__all__ = ["contact_of", "draw_contact"]


def contact_of(model: Model, state: State) -> ContactMap:
    """Return the contact that a state holds.

    Raises
    ------
    PlotError
        If the model has no half-space contact, or a point for the tangential contact.
    """
    if not isinstance(model.contact, HalfSpaceContact):
        raise PlotError('there is no contact area to draw: it takes contact.normal = "half-space"')
    grid = model.contact.half_space
    shape = (grid.my, grid.mx)
    tractions, slipping = np.zeros((2, *shape)), np.zeros(shape, dtype=bool)
    friction: float | NDArray = model.parameters.friction_coefficient
    if isinstance(model.tangential, PointContact):
        raise PlotError(
            'there are no tractions to draw: contact.tangential = "friction-curve" is a point; "transient" has them'
        )
    if isinstance(model.tangential, TransientRolling | SlipDependentRolling):
        n = grid.elements
        tractions = state.tangential[: 2 * n].reshape(2, *shape).copy()
        slipping = state.tangential[2 * n : 3 * n].reshape(shape) > 0.5
    if isinstance(model.tangential, SlipDependentRolling):
        friction = model.tangential.coefficients(state.tangential).reshape(shape).copy()
    pressure = state.normal.reshape(shape).copy()
    return ContactMap(
        x=grid.x[: grid.mx],
        y=grid.y[:: grid.mx],
        pressure=pressure,
        tractions=tractions,
        contact=pressure > 0.0,
        slipping=slipping,
        friction=friction,
    )


def draw_contact(
    model: Model,
    folder: str | os.PathLike[str],
    *,
    steps: Sequence[int],
    animate: bool = False,
    format: str = "png",
    stem: str = "contact",
    progress: Callable[[float], None] | None = None,
) -> list[Path]:
    """Run a model and draw its contact at some steps.

    Parameters
    ----------
    model : Model
    folder : path-like
        Existing folder for the files.
    steps : sequence of int
        Numbers of the steps, 0 the start.
    animate : bool
        Also write an animation (GIF) from the first of the steps to the last.
    format : {"png", "pdf", "svg"}
    stem : str
        Beginning of the file names.
    progress : callable, optional
        Called with the share done.

    Returns
    -------
    list of Path

    Raises
    ------
    PlotError
        If there is nothing to draw or a file can't be written.
    """
    wanted = sorted(set(steps))
    if not wanted or wanted[0] < 0:
        raise PlotError(f"steps {list(steps)}: at least one is needed, all >= 0")
    folder, files = Path(folder), []
    frames, forces, distance, limit = [], [], [], 0.0
    with one_thread():
        inputs = stand_alone_inputs(model)
        state = start(model, inputs)
        for number in range(wanted[-1] + 1):
            if number:
                step(model, state, inputs)
            if number in wanted:
                title = f"{model.title}: contact" if model.title else "contact"
                figure = contact_figure(contact_of(model, state), title=title, step=number, time=number * model.dt)
                files.append(folder / f"{stem}_{number}.{format}")
                try:
                    figure.savefig(files[-1], dpi=150)
                except OSError as error:
                    raise PlotError(f"{files[-1]}: can't be written: {error.strerror}") from error
            if animate and number >= wanted[0]:
                frames.append(contact_of(model, state))
                forces.append([state.block[FORCE_X], state.block[FORCE_Y]])
                distance.append(number * model.dx)
                limit = max(limit, model.parameters.friction_coefficient * float(state.block[FORCE]))
            if progress:
                progress((number + 1) / (wanted[-1] + 1))
    if animate:
        path = folder / f"{stem}.gif"
        files.append(
            animate_contact(
                path, frames, np.array(forces), distance=np.array(distance), force_limit=limit, title=model.title
            )
        )
    return files
