"""The slave: what PythonFMU's binary calls, turned into calls of the co-simulation.

The entry script of the FMU derives a class from :class:`Fmi2Slave` and gives it the co-simulation class, so that this
module does not depend on where the model's package is.
"""

from __future__ import annotations

import json
import os
import struct
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from .errors import PortError, SlaveError
from .guard import Journal, forget_path, guarded, guarded_step, release_at_exit
from .model_cache import shared_model
from .record import Recorder
from .variables import ENUMERATIONS, VARIABLES, Variable

__all__ = ["IDENTITY_FILE", "MODEL_FILE", "Fmi2Slave"]

MODEL_FILE = "model.wrm"
IDENTITY_FILE = "identity.json"

# State of the slave in front of the state of the co-simulation: mark, layout, time at the start, last communication
# point (NaN: none yet), length of the record (-1: none), whether initialisation mode is over.
_HEADER = struct.Struct("<4sBddq?")
_MARK, _LAYOUT = b"WRFS", 1

# A host's clock may differ from the sum of its steps by rounding, not by more than this share of an internal step or
# of the time itself.
_CLOCK_STEPS = 1e-3
_CLOCK_RELATIVE = 1e-9

_started_folders: set[str] = set()


class Fmi2Slave:
    """One FMU instance.

    The name is what the binary looks for among the bases of the entry script's class; PythonFMU's own Python package
    is not needed and not in the FMU.

    Parameters
    ----------
    instance_name : str
        Name the host gave to the instance.
    resources : str
        The FMU's resource folder.
    **others : object
        What else the binary passes (logger, visible); not used.
    """

    cosimulation: ClassVar[Callable[[Any], Any]]
    """Makes a co-simulation from a model."""
    load_model: ClassVar[Callable[[str], Any]]
    """Reads the model's file."""
    user_error: ClassVar[tuple[type[Exception], ...]] = (SlaveError,)
    """Errors whose message is complete without a traceback."""

    def __init__(self, instance_name: str, resources: str, **others: object) -> None:
        del others
        forget_path(resources)
        release_at_exit(resources)
        self.journal = Journal(instance_name)
        self._fault: str | None = None
        self._recorder: Recorder | None = None
        self._start_time = 0.0
        self._point: float | None = None  # last communication point, by the host's clock
        self._started = False  # left initialisation mode
        try:
            with open(os.path.join(resources, IDENTITY_FILE), encoding="utf-8") as file:
                identity = json.load(file)
            load = type(self).load_model
            self._constants: Mapping[str, Any] = identity["constants"]
            model = shared_model(identity["model_sha256"], os.path.join(resources, MODEL_FILE), load)
            self._sim = type(self).cosimulation(model)
        except Exception as error:
            text = f"the FMU can't be started from {resources!r}: {error}"
            if resources not in _started_folders:
                self.journal.failed(text)
                raise
            self.journal.lasting_error(text)
            self._fault = f"fmi2Reset failed: {error}"  # D8 in guard.py: no exception may leave a reset
            return
        _started_folders.add(resources)

    # Life cycle ------------------------------------------------------------------------------------------------------

    def _get_log_queue(self) -> list[Any]:
        return self.journal.queue

    @guarded
    def setup_experiment(
        self, start_time: float, stop_time: float | None = None, tolerance: float | None = None
    ) -> None:
        """Take the start time; a stop time or tolerance changes nothing in an explicit model with its own grid."""
        del stop_time, tolerance
        self._check_fault()
        self._start_time = start_time

    @guarded
    def enter_initialization_mode(self) -> None:
        """Do nothing: the equilibrium is computed when it is asked for."""
        self._check_fault()

    @guarded
    def exit_initialization_mode(self) -> None:
        """Compute the equilibrium for the present inputs, so that what is wrong with it shows here."""
        self._check_fault()
        self._sim.initialise()
        self._pass_warnings()
        self._start()

    @guarded_step
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance by one communication step; False leaves everything as it was."""
        self._check_fault()
        self._check_clock(current_time)
        if not self._started:  # a host that skips initialisation mode
            self._start()
        recorder = self._recorder
        mark = recorder.position() if recorder else 0
        try:
            self._sim.advance(step_size)
        except BaseException:
            if recorder:
                recorder.rewind(mark)
            raise
        finally:
            self._pass_warnings()
        self._point = current_time + step_size
        return True

    @guarded
    def terminate(self) -> None:
        """Close the record."""
        self._check_fault()
        self._drop_recorder()

    # Variables -------------------------------------------------------------------------------------------------------

    @guarded
    def get_real(self, references: list[int]) -> list[float]:
        """Return values of Real variables."""
        return [float(self._get(reference, "Real")) for reference in references]

    @guarded
    def get_integer(self, references: list[int]) -> list[int]:
        """Return values of Integer and Enumeration variables."""
        return [int(self._get(reference, "Integer")) for reference in references]

    @guarded
    def get_boolean(self, references: list[int]) -> list[bool]:
        """Return values of Boolean variables."""
        return [bool(self._get(reference, "Boolean")) for reference in references]

    @guarded
    def get_string(self, references: list[int]) -> list[str]:
        """Return values of String variables."""
        return [str(self._get(reference, "String")) for reference in references]

    @guarded
    def set_real(self, references: list[int], values: list[float]) -> None:
        """Set Real variables, all or none."""
        self._set(references, values, "Real")

    @guarded
    def set_integer(self, references: list[int], values: list[int]) -> None:
        """Set Integer and Enumeration variables, all or none."""
        self._set(references, values, "Integer")

    @guarded
    def set_boolean(self, references: list[int], values: list[bool]) -> None:
        """Set Boolean variables, all or none."""
        self._set(references, values, "Boolean")

    @guarded
    def set_string(self, references: list[int], values: list[str]) -> None:
        """Refuse: no String variable can be set."""
        self._set(references, values, "String")

    def _get(self, reference: int, access: str) -> Any:
        self._check_fault()
        variable = _variable(reference, access)
        if variable.role == "output":
            # Computed when asked for: before the first step from the equilibrium for the present inputs, so that a
            # value is there in initialisation mode and after a roll-back, too.
            value = self._sim.output(variable.name)
            self._pass_warnings()
            return value
        if variable.role == "input":
            return self._sim.inputs[variable.name]
        if variable.role == "constant":
            return self._constants[variable.name]
        if variable.role == "calculated":
            return self._time_step
        value = self._sim.parameters[variable.name]
        if variable.enumeration:
            return ENUMERATIONS[variable.enumeration].value(value)
        return value

    def _set(self, references: list[int], values: list[Any], access: str) -> None:
        self._check_fault()
        inputs: dict[str, Any] = {}
        parameters: dict[str, Any] = {}
        for reference, value in zip(references, values, strict=True):
            variable = _variable(reference, access)
            if variable.role == "input":
                inputs[variable.name] = value
            elif variable.role == "parameter":
                parameters[variable.name] = _model_value(variable, value)
            else:
                raise PortError(f"{variable.name} = {value!r} is refused: it can not be set ({variable.role}).")
        if parameters and self._started:
            # Hosts set all start values again after a reset only; a change in the middle of a run would be lost.
            name, value = next(iter(parameters.items()))
            raise PortError(
                f"{name} = {value!r} is refused: parameters are fixed once the FMU has left initialisation mode; reset "
                "the instance to change one."
            )
        saved = self._sim.save() if inputs and parameters else None
        self._sim.set_inputs(**inputs)
        if not parameters:
            return
        try:
            self._sim.configure(**parameters)
        except BaseException:
            if saved is not None:
                self._sim.load(saved)
            raise

    # State -----------------------------------------------------------------------------------------------------------

    @guarded
    def _get_fmu_state(self) -> bytes:
        self._check_fault()
        point = float("nan") if self._point is None else self._point
        mark = self._recorder.position() if self._recorder else -1
        return _HEADER.pack(_MARK, _LAYOUT, self._start_time, point, mark, self._started) + self._sim.save()

    @guarded
    def _set_fmu_state(self, state: bytes) -> None:
        self._check_fault()
        if len(state) < _HEADER.size or state[:4] != _MARK or state[4] != _LAYOUT:
            raise PortError(f"the state of {len(state)} bytes is refused: it was not saved by this version of the FMU.")
        _, _, start_time, point, mark, started = _HEADER.unpack_from(state)
        self._sim.load(state[_HEADER.size :])
        self._start_time = start_time
        self._point = None if point != point else point
        self._started = started
        if mark < 0:
            self._drop_recorder()
        else:
            self._open_recorder()
            if self._recorder:
                self._recorder.rewind(mark)

    # The binary calls the next two on the class, without an instance to report to: they have nothing that can fail
    # (D9 in guard.py). A state is checked when it is set.

    @staticmethod
    def _fmu_state_to_bytes(state: bytes) -> bytes:
        return state

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> bytes:
        return state

    # ------------------------------------------------------------------------------------------------------------------

    def _check_fault(self) -> None:
        if self._fault is not None:
            raise PortError(self._fault)

    def _check_clock(self, current_time: float) -> None:
        if self._point is None:  # the first step says where the host's clock starts
            return
        if not abs(current_time - self._point) <= max(
            _CLOCK_STEPS * self._time_step, _CLOCK_RELATIVE * abs(self._point)
        ):
            raise PortError(
                f"currentCommunicationPoint = {current_time!r} s is refused: the instance stands at {self._point!r} s. "
                "Steps follow one another; to go back, set a saved FMU state."
            )

    @property
    def _time_step(self) -> float:
        return self._constants["dx"] / self._sim.parameters["speed"]

    def _start(self) -> None:
        self._open_recorder()
        self._started = True

    def _open_recorder(self) -> None:
        if self._sim.parameters["record"] and self._recorder is None:
            self._recorder = Recorder(self.journal.instance, self._start_time)
            self._sim.recorder = self._recorder

    def _drop_recorder(self) -> None:
        if self._recorder:
            self._sim.recorder = None
            self._recorder.close()
            self._recorder = None

    def _pass_warnings(self) -> None:
        if self._sim.warnings:
            for text in self._sim.warnings:
                self.journal.warning(text)
            self._sim.warnings.clear()


def _variable(reference: int, access: str) -> Variable:
    if not 0 <= reference < len(VARIABLES):
        raise PortError(f"value reference {reference} is refused: the FMU has 0 to {len(VARIABLES) - 1}.")
    variable = VARIABLES[reference]
    if variable.access != access:
        raise PortError(f"value reference {reference} is refused as {access}: {variable.name} is {variable.kind}.")
    return variable


def _model_value(variable: Variable, value: Any) -> Any:
    if variable.enumeration:
        enumeration = ENUMERATIONS[variable.enumeration]
        item = enumeration.item(value)
        if item is None:
            allowed = ", ".join(f"{number} ({name})" for number, (name, _) in enumerate(enumeration.items, 1))
            raise PortError(f"{variable.name} = {value!r} is refused: it is one of {allowed}.")
        return item
    return value
