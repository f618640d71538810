"""Result files: netCDF-4, written block by block, replaced atomically, and able to continue an interrupted run."""

from __future__ import annotations

import json
import os
import shutil
import tomllib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any

import netCDF4
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from wheelrail.case import Case, case_from_dict
from wheelrail.errors import CaseError, WheelrailError
from wheelrail.interaction.simulate import BLOCK, Statistics
from wheelrail.version import __version__

__all__ = [
    "OUTPUTS",
    "Checkpoint",
    "ResultFileError",
    "ResultWriter",
    "case_differences",
    "case_of_result",
    "check_target",
    "is_interrupted",
    "open_result",
    "read_checkpoint",
]

FORMAT = 1
STATE = "final_state"
"""Variable that holds the state after the last step, from which a run continues."""

OUTPUTS: dict[str, tuple[str, str]] = {
    "force_x": ("N", "longitudinal contact force on the rail"),
    "force_y": ("N", "lateral contact force on the rail"),
    "force_z": ("N", "vertical contact force on the rail, positive in compression"),
    "force_x_mean": ("N", "longitudinal contact force on the rail, mean over the step"),
    "force_y_mean": ("N", "lateral contact force on the rail, mean over the step"),
    "force_z_mean": ("N", "vertical contact force on the rail, mean over the step"),
    "force_z_max": ("N", "vertical contact force on the rail, largest within the step"),
    "force_z_min": ("N", "vertical contact force on the rail, smallest within the step"),
    "moment_spin": ("N m", "spin moment on the rail"),
    "wheel_disp_x": ("m", "longitudinal displacement of the wheel at the contact"),
    "wheel_disp_y": ("m", "lateral displacement of the wheel at the contact"),
    "wheel_disp_z": ("m", "vertical displacement of the wheel at the contact, positive into the rail"),
    "rail_disp_x": ("m", "longitudinal displacement of the rail at the contact"),
    "rail_disp_y": ("m", "lateral displacement of the rail at the contact"),
    "rail_disp_z": ("m", "vertical displacement of the rail at the contact, positive downwards"),
    "contact_stiffness_z": ("N m-1", "tangent stiffness of the contact, vertical force over approach"),
    "contact_area": ("m2", "area in contact"),
    "contact_length": ("m", "length of the contact in rolling direction"),
    "contact_width": ("m", "width of the contact across the rail"),
    "pressure_max": ("Pa", "largest contact pressure"),
    "slip_fraction": ("1", "slipping share of the contact area"),
    "friction_power": ("W", "frictional power"),
    "approach": ("m", "rigid approach of wheel and rail at the nominal contact point"),
    "in_contact": ("1", "1 while wheel and rail touch, 0 else"),
    "distance": ("m", "rolled distance since the start"),
    "solver_iterations": ("1", "evaluations of the contact law"),
    "solver_residual": ("1", "relative residual of the contact solution"),
}
"""Unit (as UDUNITS writes it) and long name of every output that can be recorded."""

_TYPES = {"in_contact": "i1", "solver_iterations": "i4"}


class ResultFileError(WheelrailError):
    """A result file can't be read, written or continued."""


@dataclass(frozen=True)
class Checkpoint:
    """Where a run ended.

    Attributes
    ----------
    path : Path
    case : dict
        The case in the layout of its file.
    samples : int
        Rows in the file: one more than the steps.
    complete : bool
        The run got as far as its case says.
    state : bytes
        As `wheelrail.interaction.state.State.to_bytes` gives it.
    statistics : Statistics
    fingerprint : str
        Of the model, see `wheelrail.interaction.model.Model.fingerprint`.
    version : str
        Of the program that wrote it.
    """

    path: Path
    case: dict[str, Any]
    samples: int
    complete: bool
    state: bytes
    statistics: Statistics
    fingerprint: str
    version: str


def part_path(path: Path) -> Path:
    """Where a result is written until it is finished."""
    return path.with_name(path.name + ".part")


def check_target(path: Path) -> None:
    """Refuse a place where a result can't be written, before anything is computed.

    Raises
    ------
    ResultFileError
        If the folder is missing or not writable, or something else than a result would be overwritten.
    """
    folder = path.parent
    if not folder.is_dir():
        raise ResultFileError(f"{path}: the folder {folder} does not exist; make it first or choose another --output")
    if not os.access(folder, os.W_OK):
        raise ResultFileError(f"{path}: the folder {folder} is not writable; choose another --output")
    if path.is_dir():
        raise ResultFileError(f"{path}: is a folder; give the name of a file in it")
    if path.exists():
        try:
            open_result(path).close()
        except ResultFileError as error:
            raise ResultFileError(f"{error}; it is not overwritten, choose another --output") from None


class ResultWriter:
    """Writes one result: make it, `append` blocks, `finish`. As a context it cleans up if it is never finished.

    Parameters
    ----------
    path : path-like
        The result; appears under its name when it is finished.
    attributes : mapping
        Global attributes (str, int, float) that are known from the beginning.
    record : sequence of str
        Outputs, keys of `OUTPUTS`.
    continued : bool
        Start from the rows that the file at ``path`` has.

    Raises
    ------
    ResultFileError
        If the file can't be written.
    """

    def __init__(
        self, path: str | os.PathLike[str], *, attributes: Mapping[str, Any], record: tuple[str, ...], continued: bool
    ) -> None:
        self.path = Path(path)
        self._part = part_path(self.path)
        self._names = ("time", "distance", *(name for name in record if name != "distance"))
        try:
            if continued:
                shutil.copyfile(self.path, self._part)
                self._file: netCDF4.Dataset | None = netCDF4.Dataset(self._part, "r+")
            else:
                self._file = netCDF4.Dataset(self._part, "w", format="NETCDF4")
                self._define()
            history = getattr(self._file, "history", "")
            verb = "continued" if continued else "created"
            self._file.setncatts(
                {
                    **attributes,
                    "history": f"{history}{_now()}: {verb} by wheelrail {__version__}\n",
                    "complete": np.int32(0),
                }
            )
        except (OSError, RuntimeError) as error:
            raise self._failed(error) from error
        self.samples = len(self._file.dimensions["time"])

    def _define(self) -> None:
        assert self._file is not None
        file = self._file
        file.createDimension("time", None)
        file.setncatts(
            {
                "Conventions": "CF-1.11",
                "source": f"wheelrail {__version__}",
                "wheelrail_version": __version__,
                "wheelrail_result_format": np.int32(FORMAT),
                "created": _now(),
            }
        )
        for name in self._names:
            unit, long_name = ("s", "time since the start") if name == "time" else OUTPUTS[name]
            kind = _TYPES.get(name, "f8")
            variable = file.createVariable(name, kind, ("time",), chunksizes=(BLOCK,), fill_value=False)
            variable.setncatts({"units": unit, "long_name": long_name})
            if name == "in_contact":
                variable.setncatts(
                    {"flag_values": np.array([0, 1], "i1"), "flag_meanings": "out_of_contact in_contact"}
                )
            if name not in ("time", "distance"):
                variable.setncattr("coordinates", "distance")

    def _failed(self, error: Exception) -> ResultFileError:
        reason = getattr(error, "strerror", None) or str(error)
        return ResultFileError(f"{self.path}: the result can't be written: {reason}")

    def append(self, block: Mapping[str, NDArray]) -> None:
        """Write some rows.

        Raises
        ------
        ResultFileError
            If there is no room, for example.
        """
        assert self._file is not None
        stop = self.samples + len(block["time"])
        try:
            for name in self._names:
                self._file.variables[name][self.samples : stop] = block[name]
        except (OSError, RuntimeError) as error:
            raise self._failed(error) from error
        self.samples = stop

    def finish(self, *, state: bytes, digest: str, statistics: Statistics, complete: bool) -> None:
        """Add what is known at the end and put the file in its place.

        Raises
        ------
        ResultFileError
            If that fails; an older result is then as it was.
        """
        assert self._file is not None
        try:
            if STATE not in self._file.variables:
                self._file.createDimension("state_bytes", len(state))
                variable = self._file.createVariable(STATE, "u1", ("state_bytes",), fill_value=False)
                variable.setncattr("long_name", "state after the last step, for wheelrail run --resume")
            self._file.variables[STATE][:] = np.frombuffer(state, np.uint8)
            self._file.setncatts(
                {
                    "state_digest": digest,
                    "statistics": json.dumps(statistics.to_dict()),
                    "complete": np.int32(complete),
                }
            )
            self._file.close()
            self._file = None
            os.replace(self._part, self.path)
        except (OSError, RuntimeError) as error:
            raise self._failed(error) from error

    def __enter__(self) -> ResultWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._file is not None:
            with suppress(
                RuntimeError
            ):  # a full disk can't be flushed to; the error that matters is on its way already
                self._file.close()
            self._file = None
        self._part.unlink(missing_ok=True)


def _now() -> str:
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def open_result(path: str | os.PathLike[str]) -> xr.Dataset:
    """Open a result file; variables are read when they are used.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    xarray.Dataset
        Coordinates ``time`` (s) and ``distance`` (m); close it, or use it in a ``with`` statement.

    Raises
    ------
    ResultFileError
        If the file is missing or no result of this program.
    """
    path = Path(path)
    if not path.exists():
        raise ResultFileError(f"{path}: no such file")
    if path.is_dir():
        raise ResultFileError(f"{path}: is a folder, not a result file")
    try:
        dataset = xr.open_dataset(path, engine="netcdf4", decode_times=False)
    except PermissionError:
        raise ResultFileError(f"{path}: may not be read (permissions)") from None
    except (OSError, RuntimeError, ValueError):
        raise ResultFileError(f"{path}: is not a netCDF file, or is damaged") from None
    found = dataset.attrs.get("wheelrail_result_format")
    if found is None:
        dataset.close()
        raise ResultFileError(f"{path}: is a netCDF file, but not one that wheelrail run has written")
    if int(found) != FORMAT:
        dataset.close()
        raise ResultFileError(f"{path}: format {int(found)}, this version reads format {FORMAT}")
    return dataset


def is_interrupted(path: str | os.PathLike[str]) -> bool:
    """Return whether there is a result of a run that did not get to its end."""
    if not Path(path).exists():
        return False
    with open_result(path) as dataset:
        return not dataset.attrs.get("complete")


def case_of_result(dataset: xr.Dataset, *, source: str) -> Case:
    """Return the case of a result without its excitation, whose data files may be elsewhere by now.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `open_result`.
    source : str
        Name of the file for messages.

    Raises
    ------
    ResultFileError
        If the case in the file is not one that this version reads.
    """
    try:
        data = tomllib.loads(dataset.attrs["case"])
        data.pop("excitation", None)
        return case_from_dict(data, source=source)
    except (KeyError, tomllib.TOMLDecodeError, CaseError) as error:
        raise ResultFileError(f"{source}: the case in the file can't be read: {error}") from error


def read_checkpoint(path: str | os.PathLike[str]) -> Checkpoint:
    """Read what is needed to continue a run.

    Raises
    ------
    ResultFileError
        If the file is missing, foreign or damaged.
    """
    path = Path(path)
    if not path.exists():
        raise ResultFileError(f"{path}: there is no such file to continue; run without --resume")
    with open_result(path) as dataset:
        try:
            return Checkpoint(
                path=path,
                case=tomllib.loads(dataset.attrs["case"]),
                samples=dataset.sizes["time"],
                complete=bool(dataset.attrs["complete"]),
                state=dataset[STATE].values.tobytes(),
                statistics=Statistics(**json.loads(dataset.attrs["statistics"])),
                fingerprint=dataset.attrs["model_fingerprint"],
                version=dataset.attrs["wheelrail_version"],
            )
        except (KeyError, TypeError, ValueError) as error:
            raise ResultFileError(f"{path}: can't be continued, {error} is missing or damaged") from error


def case_differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """List the keys in which two cases differ, one line each.

    How long the run is and where it is written does not matter: a run may be made longer when it is continued.
    """
    flat_before, flat_now = _flat(before), _flat(now)
    lines = []
    for key in dict.fromkeys((*flat_before, *flat_now)):
        if key in ("simulation.duration", "output.file"):
            continue
        old, new = flat_before.get(key, "left out"), flat_now.get(key, "left out")
        if old != new:
            lines.append(f"{key}: {old} in the file, {new} in the case")
    return lines


def _flat(value: Any, prefix: str = "") -> dict[str, Any]:
    if isinstance(value, Mapping):
        pairs = [(f"{prefix}.{key}" if prefix else str(key), item) for key, item in value.items()]
    elif isinstance(value, list | tuple) and any(isinstance(item, Mapping) for item in value):
        pairs = [(f"{prefix} #{number}", item) for number, item in enumerate(value, 1)]
    else:
        return {prefix: value}
    return {key: leaf for name, item in pairs for key, leaf in _flat(item, name).items()}
