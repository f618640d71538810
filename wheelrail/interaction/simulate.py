"""The stand-alone run: the time step in a loop, in blocks, so that a run of any length takes the same memory."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError, WheelrailError
from .cosimulation import COUNTS, LARGEST, OUTPUT_NAMES, REACHED, RESIDUAL_LIMIT
from .inputs import Inputs
from .model import Model
from .place_watch import PlaceWatch
from .start import height_for_load, start
from .state import ANGLE, FORCE, FORCE_X, FORCE_Y, MISSED, RESIDUAL, RESULTS, SCALARS, State
from .step import step

__all__ = ["BLOCK", "Simulation", "Statistics", "simulate", "stand_alone_inputs", "step_count"]

BLOCK = 4096
"""Steps that are computed between two looks at anything else, at most."""

LONGEST_BLOCK = 1.0
"""Seconds of computing after which a block ends in any case."""

_log = logging.getLogger(__name__)

# Over one step, mean and extremes are the force itself, and the largest count and residual those of the step.
_PER_STEP = {
    **RESULTS,
    "force_x_mean": FORCE_X,
    "force_y_mean": FORCE_Y,
    "force_z_mean": FORCE,
    "force_z_max": FORCE,
    "force_z_min": FORCE,
    **LARGEST,
}


@dataclass
class Statistics:
    """What a summary says about a run, over all its steps and the start.

    Attributes
    ----------
    samples : int
        Number of steps and the start.
    force_sum, force_min, force_max : float
        Of the vertical contact force, N.
    out_of_contact : int
        Samples without contact.
    residual_max : float
        Largest relative residual of the contact solution.
    unreliable : int
        Samples whose residual is above the limit.
    """

    samples: int = 0
    force_sum: float = 0.0
    force_min: float = math.inf
    force_max: float = -math.inf
    out_of_contact: int = 0
    residual_max: float = 0.0
    unreliable: int = 0

    @property
    def force_mean(self) -> float:
        """Mean vertical contact force, N; nan before the start."""
        return self.force_sum / self.samples if self.samples else math.nan

    def add(self, force: NDArray, residual: NDArray) -> None:
        """Count in the force in N and the residual of some steps, each of shape (n,)."""
        self.samples += len(force)
        self.force_sum += float(force.sum())
        self.force_min = min(self.force_min, float(force.min()))
        self.force_max = max(self.force_max, float(force.max()))
        self.out_of_contact += int(np.count_nonzero(force == 0.0))
        self.residual_max = max(self.residual_max, float(residual.max()))
        # Written so that a residual that is no number counts.
        self.unreliable += int(np.count_nonzero(~(residual <= RESIDUAL_LIMIT)))

    def to_dict(self) -> dict[str, Any]:
        """Plain values by name."""
        return asdict(self)


def step_count(*, duration: float, dt: float) -> int:
    """Return the number of internal steps within a duration (s); an instant missed by 1e-6 dt counts as reached."""
    return math.floor(duration / dt + REACHED)


def stand_alone_inputs(model: Model) -> Inputs:
    """Return the inputs of a run that no vehicle model drives.

    Parameters
    ----------
    model : Model

    Returns
    -------
    Inputs
        What the case gives; in coupling by displacement with the height at which the wheel would put the preload on
        smooth surfaces at the start.
    """
    inputs = model.start_inputs
    if model.parameters.coupling == "load":
        return inputs
    return replace(inputs, wheel_z=height_for_load(model, inputs))


class Simulation:
    """A run under constant inputs; iterate over it to get its blocks.

    Each block is a dict of arrays of shape (n,), n <= ``block`` and less where steps are slow: ``time`` (s) and
    ``distance`` (m) since the start, ``step`` (the number of each), and the recorded outputs. The first row of a new
    run is the start, step 0. If a step can't be done, what was computed before it comes as a last block, then the
    error.

    Parameters
    ----------
    model : Model
    duration : float
        s, from the start of the run, also when it is continued.
    record : sequence of str
        Names of outputs.
    inputs : Inputs, optional
        Left out: `stand_alone_inputs`.
    state : State, optional
        Where to continue; advanced in place. Left out: equilibrium at the start.
    block : int
        Rows per block.
    statistics : Statistics, optional
        Of the part before ``state``.

    Attributes
    ----------
    state : State
        Belongs to the last row of the block that came last.
    steps : int
        Number of internal steps of the whole run.
    statistics : Statistics

    Raises
    ------
    ParameterError
        If an output is unknown or the duration is negative.
    WheelrailError
        If there is no equilibrium at the start.
    """

    def __init__(
        self,
        model: Model,
        *,
        duration: float,
        record: Sequence[str],
        inputs: Inputs | None = None,
        state: State | None = None,
        block: int = BLOCK,
        statistics: Statistics | None = None,
    ) -> None:
        for name in record:
            if name not in OUTPUT_NAMES:
                raise ParameterError("record", name, f"no such output; there are: {', '.join(OUTPUT_NAMES)}")
        if not (math.isfinite(duration) and duration >= 0.0):
            raise ParameterError("duration", duration, "must be a number >= 0 s")
        if block < 1:
            raise ParameterError("block", block, "must be >= 1")
        self.model = model
        self.record = tuple(record)
        self.inputs = stand_alone_inputs(model) if inputs is None else inputs
        self.steps = step_count(duration=duration, dt=model.dt)
        self.statistics = Statistics() if statistics is None else statistics
        self._at_start = state is None
        self._watch = PlaceWatch()
        self.state = start(model, self.inputs) if state is None else state
        if self._at_start and model.tangential is not None:
            for remark in model.tangential.remarks:
                _log.warning("%s", remark)
        self._rows = np.empty((block, SCALARS))

    def __iter__(self) -> Iterator[dict[str, NDArray]]:
        model, state, inputs, rows = self.model, self.state, self.inputs, self._rows
        scalars = state.block[:SCALARS]
        count = 0
        if self._at_start:
            self._at_start = False
            rows[0], count = scalars, 1
        remaining = self.steps - state.step
        while remaining > 0 or count:
            most = min(len(rows) - count, remaining)
            done, trouble, deadline = 0, None, perf_counter() + LONGEST_BLOCK
            while done < most:
                try:
                    step(model, state, inputs)
                except WheelrailError as error:
                    trouble = error
                    break
                rows[count] = scalars
                count += 1
                done += 1
                if perf_counter() > deadline:  # slow steps: whoever iterates wants to look at something else as well
                    break
            remaining -= done
            if count:
                yield self._block(rows[:count])
            if trouble is not None:
                raise trouble
            count = 0

    def _block(self, rows: NDArray) -> dict[str, NDArray]:
        numbers = rows[:, 0].astype(np.int64)
        self._judge(numbers, rows[:, FORCE], rows[:, RESIDUAL])
        overlap, angle = float(rows[:, MISSED].max()), float(np.abs(rows[:, ANGLE]).max())
        for line in self._watch.look(self.model, self.inputs, overlap=overlap, angle=angle, step=int(numbers[-1])):
            _log.warning("%s", line)
        block: dict[str, NDArray] = {
            "step": numbers,
            "time": numbers * self.model.dt,
            "distance": numbers * self.model.dx,
        }
        for name in self.record:
            if name == "in_contact":
                block[name] = rows[:, FORCE] > 0.0
            elif name in COUNTS:
                block[name] = rows[:, LARGEST[name]].astype(np.int64)
            elif name != "distance":
                block[name] = rows[:, _PER_STEP[name]].copy()
        return block

    def _judge(self, numbers: NDArray, force: NDArray, residual: NDArray) -> None:
        before = self.statistics.unreliable
        self.statistics.add(force, residual)
        count = self.statistics.unreliable - before
        if count:
            first = int(np.argmax(~(residual <= RESIDUAL_LIMIT)))
            _log.warning(
                "the contact solution has a relative residual above %g in %d of the steps %d to %d, first %.2g at "
                "step %d (t = %.6g s); the force there is not reliable",
                RESIDUAL_LIMIT,
                count,
                numbers[0],
                numbers[-1],
                residual[first],
                numbers[first],
                numbers[first] * self.model.dt,
            )

    def collect(self) -> dict[str, NDArray]:
        """Run to the end and return the blocks joined; for runs that fit into memory."""
        blocks = list(self)
        if not blocks:
            return {name: np.empty(0) for name in ("step", "time", "distance", *self.record)}
        return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def simulate(
    model: Model,
    *,
    duration: float,
    record: Sequence[str],
    inputs: Inputs | None = None,
    state: State | None = None,
    block: int = BLOCK,
) -> Simulation:
    """Run a model on its own; see `Simulation` for the parameters.

    Returns
    -------
    Simulation
        Nothing beyond the start is computed before it is iterated over.
    """
    return Simulation(model, duration=duration, record=record, inputs=inputs, state=state, block=block)
