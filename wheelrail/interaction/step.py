"""One time step of the coupled system (Pieringer 2011, eqs. 3.5 to 3.8, 3.15 to 3.17, 3.28 to 3.32).

    approach = offset + xi_W - xi_R,     xi_W = known + g_W(1) (P - F),     xi_R = known + g_R(1) F

with the known parts from all past forces; the contact law closes the equation for the present force. The vertical first
samples are kept, so it is implicit and solved by Newton's method in the contact model.

With a tangential contact model the displacements have three directions. What the tangential ones change within the step
adds to the shift of rail against wheel (eqs. 3.50 and 3.51),

    D = [xi_R - xi_W](a) - [xi_R - xi_W](a - 1).

Their first samples, if they are kept, make D depend on the tangential force: rail and wheel give way as the contact's
elements do, and the contact solves for both. First samples that couple the vertical with another direction are zero, so
that the normal contact is solved first. The rigid lateral motion of a wheel that the vehicle moves is not in D: the
vehicle's creepage has it.

`step` is the only writer of the state after the start, and writes only once nothing can fail any more.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from numpy.typing import NDArray

from ..contact.solution import NormalSolution
from ..contact.tangential_models import Creepages, Motion, TangentialSolution
from ..errors import WheelrailError
from .inputs import Inputs
from .model import Model
from .state import (
    ANGLE,
    APPROACH,
    AREA,
    FORCE,
    FORCE_X,
    FORCE_Y,
    GUIDE_X,
    GUIDE_Y,
    HEAD,
    ITERATIONS,
    LENGTH,
    METHOD,
    MISSED,
    MOMENT,
    OFFSET,
    POINTS,
    POWER,
    PRESSURE,
    RAIL,
    RAIL_X,
    RAIL_Y,
    RESIDUAL,
    ROLLING_RADIUS,
    SLIP,
    SOLUTIONS,
    SPREAD,
    STEP,
    STIFFNESS,
    WHEEL,
    WHEEL_X,
    WHEEL_Y,
    WIDTH,
    Y_RAIL,
    Y_WHEEL,
    State,
)
from .surfaces import total_shift

__all__ = ["step"]


def heights_at(model: Model, state: State, inputs: Inputs, index: int) -> NDArray:
    """Evaluate what the contact sees around grid index ``index``, m; see `wheelrail.interaction.surfaces`."""
    state.surfaces.move(model, total_shift(model, inputs))
    return state.surfaces.heights(model, index)


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
    block[METHOD] = solution.friction_method
    block[SOLUTIONS] = solution.friction_solutions
    block[SPREAD] = solution.friction_force_spread
    if solution.memory is not None:
        state.tangential[:] = solution.memory


def store_solution(model: Model, state: State, solution: NormalSolution) -> None:
    """Put the results of the normal contact at their place in the state."""
    block = state.block
    place = state.surfaces.place
    block[Y_WHEEL], block[Y_RAIL] = place.y_wheel, place.y_rail
    block[ANGLE], block[ROLLING_RADIUS] = place.angle, place.rolling_radius
    block[POINTS], block[MISSED] = float(solution.force > 0.0), 0.0
    if place.others:
        block[POINTS], block[MISSED] = state.surfaces.contacts(model, solution.approach, solution.force)
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
        If the excitation ends, wheel and rail don't touch at the lateral shift, the contact leaves its grid or the
        force is not finite.
    """
    block = state.block
    number = int(block[STEP]) + 1
    index = model.start_index + number
    heights = heights_at(model, state, inputs, index)
    wheel, track = model.active_wheel, model.track
    rail_x = rail_y = rail_known = rail_first = 0.0
    if track is not None:
        rail_x, rail_y, rail_known = _three(state.future[:, int(block[HEAD])])
        rail_first = track.first(index)
    wheel_x = wheel_y = wheel_known = 0.0
    wheel_first = model.wheel_first
    if wheel is not None:
        wheel_x, wheel_y, wheel_known = _three(wheel.known(state.wheel))
    by_load = model.parameters.coupling == "load"
    load = inputs.wheel_force_z if by_load else 0.0
    offset = float(block[OFFSET]) if by_load else inputs.wheel_z
    guess = float(block[APPROACH])
    if by_load and wheel is None:  # a wheel without dynamics: the contact force is the load
        solution = model.contact.solve(heights, weight=0.0, compliance=1.0, rhs=load, guess=guess, memory=state.normal)
    else:
        solution = model.contact.solve(
            heights,
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
    # Wheel and rail are of one material: within a step the tangential contact does not act back on the normal one.
    tangential = None
    force_x = force_y = 0.0
    if model.tangential is not None:
        guide_x = guide_y = 0.0
        if by_load:
            guide_x = inputs.wheel_force_x + float(block[GUIDE_X])
            guide_y = inputs.wheel_force_y + float(block[GUIDE_Y])
        wheel_tangential, compliances = model.wheel_first_tangential, model.tangential_compliances
        if wheel_tangential is not None:
            wheel_x, wheel_y = _yield(wheel_tangential, wheel_x, wheel_y, guide_x, guide_y)
        tangential = model.tangential.step(
            solution,
            creepages_of(inputs),
            friction=model.parameters.friction_coefficient,
            dx=model.dx,
            dt=model.dt,
            memory=state.tangential,
            motion=Motion(
                rail_x - wheel_x - float(block[RAIL_X] - block[WHEEL_X]),
                rail_y - wheel_y - float(block[RAIL_Y] - block[WHEEL_Y]),
                None if compliances is None else compliances[index % len(compliances)],
            ),
        )
        force_x, force_y = tangential.force_x, tangential.force_y
        if not (math.isfinite(force_x) and math.isfinite(force_y)):
            raise WheelrailError(f"the tangential force is not finite at step {number} ({creepages_of(inputs)})")
        if wheel_tangential is not None:
            wheel_x, wheel_y = _yield(wheel_tangential, wheel_x, wheel_y, -force_x, -force_y)
        if compliances is not None and track is not None and track.directions > 1:
            rail_x, rail_y = _yield(track.tangential_first(index), rail_x, rail_y, force_x, force_y)
        state.drive[0], state.drive[1] = guide_x - force_x, guide_y - force_y
    # Nothing fails from here on.
    rail = rail_known + rail_first * force
    if wheel is not None:
        block[WHEEL] = wheel_known + wheel_first * (load - force)
        state.drive[2] = load - force
        wheel.advance(state.wheel, state.on_wheel)
    elif by_load:
        block[WHEEL] = solution.approach + rail - offset
    else:
        block[WHEEL] = 0.0  # the vehicle moves it, it has no dynamics of its own
    block[RAIL] = rail
    if tangential is not None:
        block[WHEEL_X], block[WHEEL_Y], block[RAIL_X], block[RAIL_Y] = wheel_x, wheel_y, rail_x, rail_y
    store_solution(model, state, solution)
    store_tangential(model, state, tangential)
    if track is not None:
        contact_force = state.force
        contact_force[0], contact_force[1], contact_force[2] = force_x, force_y, force
        state.push(track, index)
    block[STEP] = number


def _three(known: Sequence[float] | NDArray) -> tuple[float, float, float]:
    """Displacements in all directions of a body that moves in one or three; m."""
    if len(known) == 1:
        return 0.0, 0.0, float(known[0])
    return float(known[0]), float(known[1]), float(known[2])


def _yield(first: NDArray, x: float, y: float, force_x: float, force_y: float) -> tuple[float, float]:
    """Add what a force (N) displaces a body within its own step; ``first`` of shape (2, 2), m/N."""
    (xx, xy), (yx, yy) = first.tolist()
    return x + xx * force_x + xy * force_y, y + yx * force_x + yy * force_y
