"""One time step of the coupled system (Pieringer 2011, eqs. 3.5 to 3.8, 3.15 to 3.17, 3.28 to 3.32).

    approach = offset + xi_W - xi_R,     xi_W = known + g_W(1) (P - F),     xi_R = known + g_R(1) F

with the known parts from all past forces; the contact law closes the equation for the present force. The first samples
are kept, so it is implicit and solved by Newton's method in the contact model.

`step` is the only writer of the state after the start, and writes only once nothing can fail any more.
"""

from __future__ import annotations

import math

from numpy.typing import NDArray

from ..contact.solution import NormalSolution
from ..contact.tangential_models import Creepages, TangentialSolution
from ..errors import WheelrailError
from .inputs import Inputs
from .model import Model
from .state import (
    APPROACH,
    AREA,
    FORCE,
    FORCE_X,
    FORCE_Y,
    HEAD,
    ITERATIONS,
    LENGTH,
    MOMENT,
    OFFSET,
    POWER,
    PRESSURE,
    RAIL,
    RESIDUAL,
    SLIP,
    STEP,
    STIFFNESS,
    WHEEL,
    WIDTH,
    State,
)

__all__ = ["step"]


def roughness_window(model: Model, state: State, index: int) -> NDArray:
    """Evaluate the combined roughness at the contact's nodes around ``index``, in m; shape (nodes,)."""
    window = state.window
    window.fill(0.0)
    first = index - len(window) // 2
    for line in model.lines:
        line.add_window(first, window)
    if model.parameters.roughness_scale != 1.0:
        window *= model.parameters.roughness_scale
    return window


def track_functions(model: Model, step: int) -> NDArray | None:
    """Return the moving Green's function of the force in step ``step``, shape (samples,); None for a rigid track."""
    track = model.track
    return None if track is None else track[(model.start_index + step) % len(track)]


def creepages_of(inputs: Inputs) -> Creepages:
    """Return the creepages among the inputs."""
    return Creepages(inputs.creepage_x, inputs.creepage_y, inputs.creepage_spin)


def store_tangential(model: Model, state: State, solution: TangentialSolution | None) -> None:
    """Put the results of the tangential contact at their place in the state."""
    if solution is None:
        return
    block = state.block
    block[FORCE_X] = solution.force_x
    block[FORCE_Y] = solution.force_y
    block[MOMENT] = solution.moment_spin
    block[SLIP] = solution.slip_fraction
    block[POWER] = solution.friction_work / model.dt
    block[ITERATIONS] = max(block[ITERATIONS], solution.iterations)
    block[RESIDUAL] = max(block[RESIDUAL], solution.residual)
    if solution.memory is not None:
        state.tangential[:] = solution.memory


def store_solution(state: State, solution: NormalSolution) -> None:
    """Put the results of the normal contact at their place in the state."""
    block = state.block
    if solution.field is not None:
        state.normal[:] = solution.field.pressure
    block[FORCE] = solution.force
    block[APPROACH] = solution.approach
    block[STIFFNESS] = solution.stiffness
    block[LENGTH] = solution.length
    block[WIDTH] = solution.width
    block[AREA] = solution.area
    block[PRESSURE] = solution.pressure_max
    block[ITERATIONS] = solution.iterations
    block[RESIDUAL] = solution.residual


def step(model: Model, state: State, inputs: Inputs) -> None:
    """Advance the state by one time step.

    Parameters
    ----------
    model : Model
    state : State
        Changed in place; as it was if an error is raised.
    inputs : Inputs
        Valid at the end of the step.

    Raises
    ------
    WheelrailError
        If the excitation ends, the contact leaves its grid or the force is not finite.
    """
    block = state.block
    number = int(block[STEP]) + 1
    roughness = roughness_window(model, state, model.start_index + number)
    functions = track_functions(model, number)
    rail_known = rail_first = 0.0
    if functions is not None:
        rail_known, rail_first = float(state.future[int(block[HEAD])]), float(functions[0])
    wheel = model.active_wheel
    wheel_known = wheel_first = 0.0
    if wheel is not None:
        wheel_known, wheel_first = float(wheel.c @ state.wheel), wheel.first
    by_load = model.parameters.coupling == "load"
    load = inputs.wheel_force_z if by_load else 0.0
    offset = float(block[OFFSET]) if by_load else inputs.wheel_z
    guess = float(block[APPROACH])
    if by_load and wheel is None:  # a wheel without dynamics: the contact force is the load
        solution = model.contact.solve(
            roughness, weight=0.0, compliance=1.0, rhs=load, guess=guess, memory=state.normal
        )
    else:
        solution = model.contact.solve(
            roughness,
            weight=1.0,
            compliance=wheel_first + rail_first,
            rhs=offset + wheel_known + wheel_first * load - rail_known,
            guess=guess,
            memory=state.normal,
        )
    force = solution.force
    if not (math.isfinite(force) and math.isfinite(solution.approach)):
        raise WheelrailError(
            f"the contact force is not finite at step {number} (load {load!r} N, wheel_z {inputs.wheel_z!r} m, "
            f"roughness_scale {model.parameters.roughness_scale!r})"
        )
    # Wheel and rail are of one material: the tangential contact does not act back on the normal one.
    tangential = None
    if model.tangential is not None:
        tangential = model.tangential.step(
            solution,
            creepages_of(inputs),
            friction=model.parameters.friction_coefficient,
            dx=model.dx,
            memory=state.tangential,
        )
        if not (math.isfinite(tangential.force_x) and math.isfinite(tangential.force_y)):
            raise WheelrailError(f"the tangential force is not finite at step {number} ({creepages_of(inputs)})")
    # Nothing fails from here on.
    rail = rail_known + rail_first * force
    if wheel is not None:
        block[WHEEL] = wheel_known + wheel_first * (load - force)
        state.wheel[:] = wheel.phi @ state.wheel + wheel.beta * (load - force)
    elif by_load:
        block[WHEEL] = solution.approach + rail - offset
    else:
        block[WHEEL] = 0.0  # the vehicle moves it, it has no dynamics of its own
    block[RAIL] = rail
    store_solution(state, solution)
    store_tangential(model, state, tangential)
    if functions is not None:
        state.push(functions, force)
    block[STEP] = number
