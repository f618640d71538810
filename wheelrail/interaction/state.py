"""The state of a run: every number that the next step reads, in one flat block."""

from __future__ import annotations

import hashlib
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..errors import StateError
from .model import Model

__all__ = ["RESULTS", "State"]

# Scalars at the head of the block.
STEP, HEAD, OFFSET = 0, 1, 2
# Results of the last step, which are the next step's warm start and the outputs.
FORCE, APPROACH, STIFFNESS, LENGTH, WIDTH, AREA, PRESSURE, ITERATIONS, RESIDUAL, WHEEL, RAIL = range(3, 14)
FORCE_X, FORCE_Y, MOMENT, SLIP, POWER = range(14, 19)
SCALARS = 19

RESULTS = {
    "force_z": FORCE,
    "approach": APPROACH,
    "contact_stiffness_z": STIFFNESS,
    "contact_length": LENGTH,
    "contact_width": WIDTH,
    "contact_area": AREA,
    "pressure_max": PRESSURE,
    "wheel_disp_z": WHEEL,
    "rail_disp_z": RAIL,
    "force_x": FORCE_X,
    "force_y": FORCE_Y,
    "moment_spin": MOMENT,
    "slip_fraction": SLIP,
    "friction_power": POWER,
}


class State:
    """State of one run of a model.

    Attributes
    ----------
    block : ndarray, shape (size,)
        All of it: scalars, the wheel's recursion, what the contact models keep, the rail's future displacements. The
        latter lie in a buffer of twice their length through which a window slides, so that a step adds to one
        contiguous stretch.
    wheel : ndarray
        View of the recursion's state.
    normal, tangential : ndarray
        Views of what the contact models keep: pressures and tractions of the last step, if they have any.
    future : ndarray
        View of the buffer; the present step's entry is ``future[block[HEAD]]``.
    """

    __slots__ = ("_pushed", "block", "future", "normal", "samples", "tangential", "wheel", "window")

    def __init__(self, model: Model, block: NDArray | None = None) -> None:
        wheel = 0 if model.active_wheel is None else len(model.active_wheel.beta)
        self.samples = 1 if model.track is None else model.track.shape[1]
        normal = model.contact.memory
        tangential = 0 if model.tangential is None else model.tangential.memory
        ends = np.cumsum([SCALARS, wheel, normal, tangential, 2 * self.samples])
        size = int(ends[-1])
        if block is None:
            block = np.zeros(size)
        elif block.shape != (size,):
            raise StateError(f"the state has {block.size} numbers, not the {size} of this model: it is another model's")
        self.block = block
        self.wheel, self.normal, self.tangential, self.future = (block[first:last] for first, last in pairwise(ends))
        # Work space, not part of the state: it is overwritten before it is read.
        self.window = np.zeros(model.contact.nodes)
        self._pushed = np.empty(self.samples)

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

    def push(self, functions: NDArray, force: float) -> None:
        """Let a force act on the rail's future displacements and go on to the next step.

        Parameters
        ----------
        functions : ndarray, shape (samples,)
            The moving Green's function of the force's position; its first sample belongs to the present step.
        force : float
            N.
        """
        head, samples = int(self.block[HEAD]), self.samples
        pushed = np.multiply(functions, force, out=self._pushed)
        stretch = self.future[head : head + samples]
        np.add(stretch, pushed, out=stretch)
        head += 1
        if head == samples:
            self.future[:samples] = self.future[samples:]
            self.future[samples:] = 0.0
            head = 0
        self.block[HEAD] = head
