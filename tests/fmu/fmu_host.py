"""A small FMI 2.0 host over FMPy: instances with access by variable name, and a log that can be read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    fmi2StepFinishedTYPE,
)


class UnpackedFmu:
    """An unpacked FMU and its variables."""

    def __init__(self, path: Path, folder: Path) -> None:
        self.folder = extract(str(path), unzipdir=str(folder))
        self.description = read_model_description(self.folder)
        self.variables = {variable.name: variable for variable in self.description.modelVariables}

    def instance(self, name: str = "wheel", **start: Any) -> Instance:
        return Instance(self, name, start)


class Instance:
    """One instance; ``log`` holds (status, category, message)."""

    def __init__(self, fmu: UnpackedFmu, name: str, start: dict[str, Any], initialise: bool = True) -> None:
        self.fmu = fmu
        self.log: list[tuple[int, str, str]] = []
        self.slave = FMU2Slave(
            guid=fmu.description.guid,
            unzipDirectory=fmu.folder,
            modelIdentifier=fmu.description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(self._logger)
        callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE()
        callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE()
        callbacks.stepFinished = fmi2StepFinishedTYPE()
        callbacks.componentEnvironment = None
        self._callbacks = callbacks
        self.slave.instantiate(callbacks=callbacks, loggingOn=True)
        self.time = 0.0
        if initialise:
            self.begin(**start)

    def begin(self, **start: Any) -> None:
        self.slave.setupExperiment(startTime=self.time)
        self.slave.enterInitializationMode()
        self.set(**start)
        self.slave.exitInitializationMode()

    def set(self, **values: Any) -> None:
        for name, value in values.items():
            variable = self.fmu.variables[name]
            getattr(self.slave, f"set{_access(variable)}")([variable.valueReference], [value])

    def get(self, name: str) -> Any:
        variable = self.fmu.variables[name]
        value = getattr(self.slave, f"get{_access(variable)}")([variable.valueReference])[0]
        return value.decode() if isinstance(value, bytes) else value

    def step(self, size: float) -> None:
        self.slave.doStep(self.time, size)
        self.time += size

    def close(self) -> None:
        self.slave.terminate()
        self.slave.freeInstance()

    def _logger(self, _environment: Any, _name: Any, status: int, category: bytes, message: bytes) -> None:
        self.log.append((status, (category or b"").decode(), message.decode()))


def _access(variable: Any) -> str:
    return "Integer" if variable.type == "Enumeration" else variable.type
