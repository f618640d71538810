"""The state of a run: every number that the next step reads, in one flat block."""

from __future__ import annotations

import hashlib
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..errors import StateError
from ..greens.track_response import TrackResponse
from .model import Model
from .surfaces import Surfaces

__all__ = ["RESULTS", "State"]

# Scalars at the head of the block.
STEP, HEAD, OFFSET = 0, 1, 2
# Results of the last step, which are the next step's warm start and the outputs.
FORCE, APPROACH, STIFFNESS, LENGTH, WIDTH, AREA, PRESSURE, ITERATIONS, RESIDUAL, WHEEL, RAIL = range(3, 14)
FORCE_X, FORCE_Y, MOMENT, SLIP, POWER = range(14, 19)
WHEEL_X, WHEEL_Y, RAIL_X, RAIL_Y = range(19, 23)
# What the vehicle's guiding forces are beyond the inputs: the balance of the tangential forces at the start.
GUIDE_X, GUIDE_Y = 23, 24
# What found the friction coefficients, how many solutions there are, and how far their forces differ.
METHOD, SOLUTIONS, SPREAD = 25, 26, 27
# Where wheel and rail touch, and what of it the contact model does not see.
Y_WHEEL, Y_RAIL, ANGLE, ROLLING_RADIUS, POINTS, MISSED = range(28, 34)
SCALARS = 34

RESULTS = {
    "force_z": FORCE,
    "approach": APPROACH,
    "contact_stiffness_z": STIFFNESS,
    "contact_length": LENGTH,
    "contact_width": WIDTH,
    "contact_area": AREA,
    "pressure_max": PRESSURE,
    "wheel_disp_x": WHEEL_X,
    "wheel_disp_y": WHEEL_Y,
    "wheel_disp_z": WHEEL,
    "rail_disp_x": RAIL_X,
    "rail_disp_y": RAIL_Y,
    "rail_disp_z": RAIL,
    "force_x": FORCE_X,
    "force_y": FORCE_Y,
    "moment_spin": MOMENT,
    "slip_fraction": SLIP,
    "friction_power": POWER,
    "contact_y_wheel": Y_WHEEL,
    "contact_y_rail": Y_RAIL,
    "contact_angle": ANGLE,
    "rolling_radius": ROLLING_RADIUS,
}


class State:
    """State of one run of a model.

    Attributes
    ----------
    block : ndarray, shape (size,)
        All of it: scalars, the wheel's state, what the contact models keep, the rail's future displacements. The
        latter lie in a buffer of twice their length through which a window slides, so that a step adds to one
        contiguous stretch.
    wheel : ndarray
        View of the wheel's state.
    normal, tangential : ndarray
        Views of what the contact models keep: pressures and tractions of the last step, if they have any.
    future : ndarray, shape (d, 2 samples)
        View of the buffer; the present step's entries are ``future[:, block[HEAD]]``.
    force, drive : ndarray, shape (3,)
        Work space: contact force F on the rail and what drives the wheel, P - F; N.
    on_rail, on_wheel : ndarray, shape (d,)
        Views of them in the directions that track and wheel have.
    surfaces : Surfaces
        Work space: what the contact sees of wheel and rail.
    """

    __slots__ = (
        "_pushed",
        "block",
        "drive",
        "force",
        "future",
        "normal",
        "on_rail",
        "on_wheel",
        "surfaces",
        "tangential",
        "wheel",
    )

    def __init__(self, model: Model, block: NDArray | None = None) -> None:
        active, track = model.active_wheel, model.track
        wheel, wheel_directions = (0, 0) if active is None else (active.size, active.directions)
        samples, directions = (0, 0) if track is None else (track.samples, track.directions)
        normal = model.contact.memory
        tangential = 0 if model.tangential is None else model.tangential.memory
        ends = np.cumsum([SCALARS, wheel, normal, tangential, 2 * directions * samples])
        size = int(ends[-1])
        if block is None:
            block = np.zeros(size)
        elif block.shape != (size,):
            raise StateError(f"the state has {block.size} numbers, not the {size} of this model: it is another model's")
        self.block = block
        self.wheel, self.normal, self.tangential, future = (block[first:last] for first, last in pairwise(ends))
        self.future = future.reshape(directions, 2 * samples)
        # Work space, not part of the state: it is overwritten before it is read.
        self.surfaces = Surfaces(model)
        self.force, self.drive = np.zeros(3), np.zeros(3)
        self.on_rail, self.on_wheel = self.force[3 - directions :], self.drive[3 - wheel_directions :]
        self._pushed = np.empty(directions * samples)

    @property
    def step(self) -> int:
        """Number of steps since the start."""
        return int(self.block[STEP])

    def copy_from(self, other: State) -> None:
        """Take over another state of the same model."""
        self.block[:] = other.block

    def copy(self, model: Model) -> State:
        """Return an independent copy."""
        return State(model, self.block.copy())

    def to_bytes(self) -> bytes:
        """Return the block as bytes, little-endian."""
        return self.block.astype("<f8").tobytes()

    @classmethod
    def from_bytes(cls, model: Model, data: bytes) -> State:
        """Rebuild a state from `to_bytes`.

        Raises
        ------
        StateError
            If its size is not that of the model's state.
        """
        if len(data) % 8:
            raise StateError(f"{len(data)} bytes are no whole number of values: the state is damaged")
        return cls(model, np.frombuffer(data, "<f8").astype(float))

    def digest(self) -> str:
        """Return a hash of the block; equal states have equal digests."""
        return hashlib.blake2b(self.to_bytes(), digest_size=16).hexdigest()

    def push(self, track: TrackResponse, index: int) -> None:
        """Let the present force act on the rail's future displacements and go on to the next step.

        Parameters
        ----------
        track : TrackResponse
        index : int
            Grid index of the force's position.
        """
        block = self.block
        block[HEAD] = track.push(self.future, int(block[HEAD]), index, self.on_rail, self._pushed)
