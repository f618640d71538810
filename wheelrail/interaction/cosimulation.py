"""A run in communication steps of any length, as a co-simulation master drives it.

The clock is the run's own: it adds up the communication steps with compensated summation, so that it does not drift,
and an instant within 1e-6 dt of a communication point counts as reached. Internal steps depend on nothing but their
number and the inputs, so the result for constant inputs does not depend on how the time was cut.
"""

from __future__ import annotations

import hashlib
import json
import math
import struct
from collections.abc import Callable
from dataclasses import astuple, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError, StateError
from ..numerics.blas_threads import one_thread
from .inputs import INPUT_NAMES, Inputs
from .model import Model
from .parameters import is_finite_number
from .place_watch import PlaceWatch
from .start import start
from .state import (
    ANGLE,
    FORCE,
    FORCE_X,
    FORCE_Y,
    ITERATIONS,
    METHOD,
    MISSED,
    POINTS,
    RESIDUAL,
    RESULTS,
    SOLUTIONS,
    SPREAD,
    State,
)
from .step import step

__all__ = ["OUTPUT_NAMES", "RESIDUAL_LIMIT", "CoSimulation"]

REACHED = 1e-6  # share of dt by which a communication point may miss an internal step
RESIDUAL_LIMIT = 1e-9  # a larger relative residual of the contact solution is reported
LONGEST_STEP = 1e6  # s; a longer communication step is a mistake

_STEP_RESULTS = (
    "force_x_mean",
    "force_y_mean",
    "force_z_mean",
    "force_z_max",
    "force_z_min",
)
LARGEST = {
    "solver_iterations": ITERATIONS,
    "solver_residual": RESIDUAL,
    "friction_method": METHOD,
    "friction_solutions": SOLUTIONS,
    "friction_force_spread": SPREAD,
    "contact_points": POINTS,
    "missed_overlap": MISSED,
}
"""Outputs that are the largest value within the communication step, and their place in the state."""
COUNTS = ("solver_iterations", "friction_method", "friction_solutions", "contact_points")
"""Those that are whole numbers."""
OUTPUT_NAMES = (*RESULTS, *_STEP_RESULTS, *LARGEST, "in_contact", "distance")

_MEANS = {"force_x_mean": 0, "force_y_mean": 1, "force_z_mean": 2}

_MAGIC = b"WRSTATE5"
_CHECKSUM_BYTES, _FINGERPRINT_BYTES = 16, 16


class CoSimulation:
    """One run of a model.

    Parameters
    ----------
    model : Model
        Shared, never changed.

    Attributes
    ----------
    warnings : list of str
        Messages since the list was last cleared by its reader.
    recorder : callable or None
        Called as recorder(time, force_x, force_y, force_z) at the start and at every internal step.
    """

    def __init__(self, model: Model) -> None:
        self._base = model
        self.recorder: Callable[[float, float, float, float], None] | None = None
        self.warnings: list[str] = []
        self.reset()

    def reset(self) -> None:
        """Go back to the state after construction."""
        self.model = self._base
        self._inputs = self.model.start_inputs
        self._state: State | None = None
        self._stale = True
        self._remarked = False
        self._watch = PlaceWatch()
        self._backup = np.empty(0)
        self._clear_clock()

    def _clear_clock(self) -> None:
        self._elapsed = self._lost = 0.0  # Kahan's sum of the communication steps and what it lost
        self._previous: Inputs | None = None
        self._previous_time = 0.0
        self._advanced = False

    @property
    def parameters(self) -> dict[str, Any]:
        """Present values of the parameters."""
        return self.model.parameters.to_dict()

    @property
    def inputs(self) -> dict[str, float]:
        """Present values of the inputs."""
        return dict(zip(INPUT_NAMES, astuple(self._inputs), strict=True))

    @property
    def time(self) -> float:
        """Time since the start at the present communication point, s."""
        return self._elapsed

    @property
    def steps(self) -> int:
        """Internal steps done."""
        return 0 if self._state is None else self._state.step

    @property
    def state(self) -> State:
        """State of the interaction; computed if the run has not been initialised."""
        return self._current()

    def configure(self, **values: Any) -> None:
        """Change parameters before the first step.

        Raises
        ------
        ParameterError
            If a value is not allowed, or the run has begun; nothing is changed then.
        """
        if self._advanced:
            name, value = next(iter(values.items()))
            raise ParameterError(name, value, "parameters are fixed once the run has begun; reset it first")
        self.model = self.model.configured(**values)
        self._stale = True

    def set_inputs(self, **values: float) -> None:
        """Set inputs; they act from the next communication step on.

        Raises
        ------
        ParameterError
            If a name is unknown or a value not finite; nothing is changed then.
        """
        for name, value in values.items():
            if name not in INPUT_NAMES:
                raise ParameterError(name, value, f"no such input; there are: {', '.join(INPUT_NAMES)}")
            if not is_finite_number(value):
                raise ParameterError(name, value, "a finite number is needed")
        # A new object: the one that is replaced may be the previous input of linear extrapolation.
        self._inputs = replace(self._inputs, **{name: float(value) for name, value in values.items()})
        if not self._advanced:
            self._stale = True

    def initialise(self) -> None:
        """Bring wheel, rail and contact into equilibrium for the present inputs.

        Raises
        ------
        WheelrailError
            If there is none, for example where the excitation does not cover the start.
        """
        with one_thread():
            state = start(self.model, self._inputs)
        self._state = state
        self._stale = False
        self._clear_clock()
        self._means = _forces(state.block)
        self._largest = self._smallest = float(state.block[FORCE])
        self._worst = [float(state.block[place]) for place in LARGEST.values()]
        self._check_residual(float(state.block[RESIDUAL]))
        self._check_place(float(state.block[MISSED]), abs(float(state.block[ANGLE])))
        if self.model.tangential is not None and not self._remarked:
            self.warnings += self.model.tangential.remarks
            self._remarked = True  # not again for every input that is set before the first step

    def _current(self) -> State:
        if self._stale or self._state is None:
            self.initialise()
        assert self._state is not None
        return self._state

    def advance(self, step_size: float) -> int:
        """Do one communication step.

        Parameters
        ----------
        step_size : float
            s, >= 0.

        Returns
        -------
        int
            Number of internal steps done.

        Raises
        ------
        WheelrailError
            If the step can't be done; the run is then as it was before.
        """
        if not is_finite_number(step_size) or not 0.0 <= step_size <= LONGEST_STEP:
            raise ParameterError("communication step size", step_size, f"must be 0 ... {LONGEST_STEP:g} s")
        state, model = self._current(), self.model
        elapsed, lost = _add(self._elapsed, self._lost, step_size)
        target = math.floor((elapsed - lost) / model.dt + REACHED)
        done = max(target - state.step, 0)
        rows = [] if self._advanced else [(0.0, *_forces(state.block))]
        if done or (rows and self.recorder is not None):
            self._run(state, done, rows)
        if elapsed > self._elapsed:
            self._previous, self._previous_time = self._inputs, self._elapsed
        self._elapsed, self._lost = elapsed, lost
        self._advanced = True
        return done

    def _run(self, state: State, count: int, rows: list[tuple[float, float, float, float]]) -> None:
        """Do ``count`` internal steps, or none; they are recorded after ``rows`` once all are done."""
        block, model, recorder = state.block, self.model, self.recorder
        if self._backup.shape != block.shape:
            self._backup = np.empty_like(block)
        np.copyto(self._backup, block)
        inputs, extrapolate = self._inputs, self._slopes()
        totals, places = [0.0, 0.0, 0.0], list(LARGEST.values())
        largest, smallest = -math.inf, math.inf
        worst = [0.0] * len(LARGEST)
        steepest = 0.0
        try:
            with one_thread():
                for _ in range(count):
                    if extrapolate is not None:
                        ahead = (state.step + 1) * model.dt - self._elapsed
                        inputs = Inputs(
                            *(v + s * ahead for v, s in zip(astuple(self._inputs), extrapolate, strict=True))
                        )
                    step(model, state, inputs)
                    forces = _forces(block)
                    totals = [total + force for total, force in zip(totals, forces, strict=True)]
                    largest, smallest = max(largest, forces[2]), min(smallest, forces[2])
                    worst = [max(before, float(block[place])) for before, place in zip(worst, places, strict=True)]
                    steepest = max(steepest, abs(float(block[ANGLE])))
                    if recorder is not None:
                        rows.append((state.step * model.dt, *forces))
            if recorder is not None:
                for row in rows:
                    recorder(*row)
        except BaseException:
            np.copyto(block, self._backup)
            raise
        if count == 0:
            return
        self._means = tuple(total / count for total in totals)
        self._largest, self._smallest = largest, smallest
        self._worst = worst
        self._check_residual(worst[places.index(RESIDUAL)])
        self._check_place(worst[places.index(MISSED)], steepest)

    def _slopes(self) -> tuple[float, ...] | None:
        """Slopes of the inputs over the last communication step, for linear extrapolation."""
        if self.model.parameters.input_extrapolation == "hold" or self._previous is None:
            return None
        span = self._elapsed - self._previous_time
        pairs = zip(astuple(self._inputs), astuple(self._previous), strict=True)
        return tuple((now - before) / span for now, before in pairs)

    def _check_residual(self, residual: float) -> None:
        if not residual <= RESIDUAL_LIMIT:
            self.warnings.append(
                f"the contact solution at step {self.steps} has a relative residual of {residual:.2g}, "
                f"above {RESIDUAL_LIMIT:g}; the force of this communication step is not reliable"
                + (" (a pulling load has no equilibrium)" if self._inputs.wheel_force_z < 0.0 else "")
            )

    def _check_place(self, overlap: float, angle: float) -> None:
        self.warnings += self._watch.look(self.model, self._inputs, overlap=overlap, angle=angle, step=self.steps)

    def output(self, name: str) -> float | int | bool:
        """Value of an output port at the present communication point.

        Raises
        ------
        ParameterError
            If there is no such output.
        """
        state = self._current()
        if name in RESULTS:
            return float(state.block[RESULTS[name]])
        if name in _MEANS:
            return self._means[_MEANS[name]]
        if name == "force_z_max":
            return self._largest
        if name == "force_z_min":
            return self._smallest
        if name in LARGEST:
            value = self._worst[list(LARGEST).index(name)]
            return int(value) if name in COUNTS else value
        if name == "in_contact":
            return bool(state.block[FORCE] > 0.0)
        if name == "distance":
            return self.model.parameters.speed * self._elapsed
        raise ParameterError(name, "?", f"no such output; there are: {', '.join(OUTPUT_NAMES)}")

    def save(self) -> bytes:
        """Everything that the run's future depends on."""
        state = self._current()
        header = {
            "parameters": self.parameters,
            "inputs": astuple(self._inputs),
            "previous": None if self._previous is None else astuple(self._previous),
            "previous_time": self._previous_time,
            "elapsed": self._elapsed,
            "lost": self._lost,
            "advanced": self._advanced,
            "results": [self._means, self._largest, self._smallest, self._worst],
        }
        text = json.dumps(header, sort_keys=True).encode()
        content = self._base.fingerprint + struct.pack("<Q", len(text)) + text + state.to_bytes()
        return _MAGIC + content + _checksum(content)

    def load(self, data: bytes) -> None:
        """Continue from `save`, bit for bit.

        Raises
        ------
        StateError
            If the data is damaged or of another model; the run is then as it was.
        """
        start_of_text = len(_MAGIC) + _FINGERPRINT_BYTES + 8
        if len(data) < start_of_text + _CHECKSUM_BYTES or data[: len(_MAGIC)] != _MAGIC:
            raise StateError("the saved state is damaged: it does not begin as one")
        data, checksum = data[:-_CHECKSUM_BYTES], data[-_CHECKSUM_BYTES:]
        if _checksum(data[len(_MAGIC) :]) != checksum:
            raise StateError("the saved state is damaged: its checksum differs")
        if data[len(_MAGIC) : start_of_text - 8] != self._base.fingerprint:
            raise StateError("the saved state belongs to another model")
        (length,) = struct.unpack("<Q", data[start_of_text - 8 : start_of_text])
        try:
            header = json.loads(data[start_of_text : start_of_text + length])
            parameters = header["parameters"]
            model = self.model if parameters == self.parameters else self._base.configured(**parameters)
            state = State.from_bytes(model, data[start_of_text + length :])
            inputs = Inputs(*header["inputs"])
            previous = None if header["previous"] is None else Inputs(*header["previous"])
            means, largest, smallest, worst = header["results"]
            previous_time, elapsed, lost = header["previous_time"], header["elapsed"], header["lost"]
            advanced = header["advanced"]
        except (ValueError, KeyError, TypeError, ParameterError) as error:
            raise StateError(f"the saved state is damaged: {error}") from error
        self.model, self._state, self._stale = model, state, False
        self._inputs, self._previous, self._previous_time = inputs, previous, previous_time
        self._elapsed, self._lost, self._advanced = elapsed, lost, advanced
        self._means, self._largest, self._smallest, self._worst = tuple(means), largest, smallest, worst

    def digest(self) -> str:
        """Hash of `save`: equal runs have equal digests."""
        return hashlib.blake2b(self.save(), digest_size=16).hexdigest()


def _forces(block: NDArray) -> tuple[float, float, float]:
    """Contact forces of the last step on the rail, N."""
    return float(block[FORCE_X]), float(block[FORCE_Y]), float(block[FORCE])


def _checksum(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=_CHECKSUM_BYTES).digest()


def _add(total: float, lost: float, value: float) -> tuple[float, float]:
    """One step of Kahan's summation: the new sum, and what it is too large by."""
    corrected = value - lost
    new = total + corrected
    return new, (new - total) - corrected
