"""The start of a run: wheel, rail and contact in steady equilibrium under a constant force.

The force has rolled over the track for ever, so that a smooth rail gives no transient other than the parametric one.
In coupling by load it is the load, and displacements of the wheel count from this equilibrium (only F - P moves it,
Pieringer 2011, section 3.2). In coupling by displacement it follows from the wheel's height above first touch.

The tangential forces are those of steady rolling under the start's creepages, without creepage none: where nothing
changes, wheel and rail don't move against each other beyond the creepages. They too have rolled there for ever. With
``balance`` they are the vehicle's guiding forces at the start, and the wheel is not moved by them; without, the wheel
begins where the difference to the given guiding forces holds it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..contact.solution import NormalSolution
from ..contact.tangential_models import TangentialSolution
from ..errors import WheelrailError
from ..greens.protocol import FreeBodyError, WheelResponse, compliance_matrix, first_sample
from .inputs import Inputs
from .model import Model
from .state import GUIDE_X, GUIDE_Y, HEAD, OFFSET, RAIL, RAIL_X, RAIL_Y, STEP, WHEEL, WHEEL_X, WHEEL_Y, State
from .step import creepages_of, heights_at, store_solution, store_tangential
from .surfaces import Surfaces, total_shift

__all__ = ["height_for_load", "start"]

_TOLERANCE = 1e-13  # of the approach, between tangential forces and the height that they change
_MOST_ROUNDS = 60


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
        If the excitation does not cover the start, the contact does not fit its grid, or there is no equilibrium.
    """
    state = State(model)
    block = state.block
    block[STEP] = block[HEAD] = 0.0
    heights = heights_at(model, state, inputs, model.start_index)
    rail_compliance = _rail_compliance(model)
    if model.parameters.coupling == "load":
        solution = model.contact.solve(heights, weight=0.0, compliance=1.0, rhs=inputs.wheel_force_z, guess=1e-4)
        tangential = _steady_rolling(model, solution, inputs)
    else:
        solution, tangential = _under_height(model, inputs, heights, rail_compliance)
    _check(model, inputs, solution)
    force, drive = state.force, state.drive
    force[:] = _forces(solution, tangential)
    drive[:] = 0.0
    if model.parameters.coupling == "displacement":
        drive[:] = -force
    elif model.parameters.balance:
        block[GUIDE_X], block[GUIDE_Y] = force[0] - inputs.wheel_force_x, force[1] - inputs.wheel_force_y
    else:
        drive[0], drive[1] = inputs.wheel_force_x - force[0], inputs.wheel_force_y - force[1]
    rail = rail_compliance @ force
    wheel = np.zeros(3)
    if model.active_wheel is not None:
        wheel[3 - len(state.on_wheel) :] = _settle(model.active_wheel, state)
    block[OFFSET] = solution.approach + rail[2] - wheel[2] if model.parameters.coupling == "load" else 0.0
    block[RAIL], block[WHEEL] = rail[2], wheel[2]
    if tangential is not None:
        block[RAIL_X], block[RAIL_Y], block[WHEEL_X], block[WHEEL_Y] = rail[0], rail[1], wheel[0], wheel[1]
    store_solution(model, state, solution)
    store_tangential(model, state, tangential)
    if model.track is not None:
        history = model.track.history(model.start_index)
        state.future[:, : model.track.samples] = np.einsum("i,ijk->jk", state.on_rail, history)
        state.push(model.track, model.start_index)
    return state


def height_for_load(model: Model, inputs: Inputs) -> float:
    """Find the height ``wheel_z`` (m) at which a wheel would put its load on smooth surfaces at the start.

    Parameters
    ----------
    model : Model
    inputs : Inputs
        ``wheel_force_z``, and the creepages.
    """
    surfaces = Surfaces(model)
    surfaces.move(model, total_shift(model, inputs))
    solution = model.contact.solve(surfaces.smooth(), weight=0.0, compliance=1.0, rhs=inputs.wheel_force_z, guess=1e-4)
    compliance = _rail_compliance(model) + _wheel_compliance(model)
    return solution.approach + float(compliance[2] @ _forces(solution, _steady_rolling(model, solution, inputs)))


def _rail_compliance(model: Model) -> NDArray:
    """Return the moving static compliance at the start, shape (3, 3); 0 where the rail does not move."""
    return _embedded(None if model.track is None else model.track.compliance(model.start_index))


def _wheel_compliance(model: Model) -> NDArray:
    """Return the static compliance of the active wheel, shape (3, 3)."""
    return _embedded(None if model.active_wheel is None else compliance_matrix(model.active_wheel))


def _embedded(compliance: NDArray | None) -> NDArray:
    result = np.zeros((3, 3))
    if compliance is not None:
        first = 3 - len(compliance)
        result[first:, first:] = compliance
    return result


def _forces(solution: NormalSolution, tangential: TangentialSolution | None) -> NDArray:
    """Contact force on the rail, N, shape (3,)."""
    if tangential is None:
        return np.array([0.0, 0.0, solution.force])
    return np.array([tangential.force_x, tangential.force_y, solution.force])


def _steady_rolling(model: Model, solution: NormalSolution, inputs: Inputs) -> TangentialSolution | None:
    if model.tangential is None:
        return None
    friction = model.parameters.friction_coefficient
    return model.tangential.begin(solution, creepages_of(inputs), friction=friction, dx=model.dx, dt=model.dt)


def _under_height(
    model: Model, inputs: Inputs, heights: NDArray, rail_compliance: NDArray
) -> tuple[NormalSolution, TangentialSolution | None]:
    """Find normal and tangential contact that are in equilibrium under a held wheel."""
    compliance = rail_compliance + _wheel_compliance(model)
    given = 0.0  # how far the tangential forces lower the approach
    for _ in range(_MOST_ROUNDS):
        solution = model.contact.solve(
            heights, weight=1.0, compliance=float(compliance[2, 2]), rhs=inputs.wheel_z - given, guess=1e-4
        )
        tangential = _steady_rolling(model, solution, inputs)
        lowered = float(compliance[2, :2] @ _forces(solution, tangential)[:2])
        if abs(lowered - given) <= _TOLERANCE * (abs(inputs.wheel_z) + abs(lowered)):
            return solution, tangential
        given = lowered
    raise WheelrailError(
        f"there is no steady rolling at the start: under wheel_z = {inputs.wheel_z!r} m the tangential forces of the "
        "creepages change the vertical force without end; begin with smaller creepages"
    )


def _settle(wheel: WheelResponse, state: State) -> NDArray:
    """Put the wheel at rest under its drive; return its displacement, m."""
    try:
        state.wheel[:] = wheel.steady(state.on_wheel)
    except FreeBodyError:
        x, y, _ = state.drive.tolist()
        raise WheelrailError(
            f"there is no equilibrium at the start: the guiding forces exceed the contact's tangential forces by "
            f"{x:.6g} N along and {y:.6g} N across the rail, and nothing holds the wheel there; set balance = true, or "
            "give the wheel a suspension in that direction"
        ) from None
    return np.asarray(wheel.known(state.wheel)) + first_sample(wheel) @ state.on_wheel


def _check(model: Model, inputs: Inputs, solution: NormalSolution) -> None:
    if not (math.isfinite(solution.force) and math.isfinite(solution.approach)):
        raise WheelrailError(
            f"there is no finite equilibrium at the start (load {inputs.wheel_force_z!r} N, "
            f"wheel_z {inputs.wheel_z!r} m, roughness_scale {model.parameters.roughness_scale!r})"
        )
