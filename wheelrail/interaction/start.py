"""The start of a run: wheel, rail and contact in steady equilibrium under a constant force.

The force has rolled over the track for ever, so that a smooth rail gives no transient other than the parametric one.
In coupling by load it is the load, and displacements of the wheel count from this equilibrium (only F - P moves it,
Pieringer 2011, section 3.2). In coupling by displacement it follows from the wheel's height above first touch.
"""

from __future__ import annotations

import math

import numpy as np

from ..errors import WheelrailError
from .inputs import Inputs
from .model import Model
from .state import HEAD, OFFSET, RAIL, STEP, WHEEL, State
from .step import creepages_of, roughness_window, store_solution, store_tangential, track_functions

__all__ = ["start"]


def start(model: Model, inputs: Inputs) -> State:
    """Build the state at step 0.

    Parameters
    ----------
    model : Model
    inputs : Inputs
        ``wheel_force_z`` or ``wheel_z`` decide, according to the coupling.

    Returns
    -------
    State

    Raises
    ------
    WheelrailError
        If the excitation does not cover the start or the contact does not fit its grid.
    """
    state = State(model)
    block = state.block
    block[STEP] = block[HEAD] = 0.0
    roughness = roughness_window(model, state, model.start_index)
    functions = track_functions(model, 0)
    unit = model.unit_history
    rail_compliance = float(unit[0]) + (0.0 if functions is None else float(functions[0]))
    if model.parameters.coupling == "load":
        solution = model.contact.solve(roughness, weight=0.0, compliance=1.0, rhs=inputs.wheel_force_z, guess=1e-4)
        block[OFFSET] = solution.approach + rail_compliance * solution.force
    else:
        wheel = model.active_wheel
        wheel_compliance = 0.0 if wheel is None else wheel.static_compliance()
        solution = model.contact.solve(
            roughness,
            weight=1.0,
            compliance=rail_compliance + wheel_compliance,
            rhs=inputs.wheel_z,
            guess=1e-4,
        )
        if wheel is not None:
            steady = np.linalg.solve(np.eye(len(wheel.beta)) - wheel.phi, wheel.beta)
            state.wheel[:] = -solution.force * steady
        block[WHEEL] = -wheel_compliance * solution.force
    if not (math.isfinite(solution.force) and math.isfinite(solution.approach)):
        raise WheelrailError(
            f"there is no finite equilibrium at the start (load {inputs.wheel_force_z!r} N, "
            f"wheel_z {inputs.wheel_z!r} m, roughness_scale {model.parameters.roughness_scale!r})"
        )
    store_solution(state, solution)
    if model.tangential is not None:
        friction = model.parameters.friction_coefficient
        begun = model.tangential.begin(solution, creepages_of(inputs), friction=friction, dx=model.dx)
        store_tangential(model, state, begun)
    block[RAIL] = rail_compliance * solution.force
    if functions is not None:
        state.future[: state.samples] = solution.force * unit
        state.push(functions, solution.force)
    return state
