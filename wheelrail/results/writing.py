"""Writing result files block by block; an older file is replaced at the end, at once."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any

import netCDF4
import numpy as np
from numpy.typing import NDArray

from wheelrail.interaction.simulate import BLOCK, Statistics
from wheelrail.results.layout import FORMAT, OUTPUTS, STATE, TYPES
from wheelrail.results.reading import ResultFileError, open_result
from wheelrail.version import __version__

__all__ = ["ResultWriter", "check_target", "part_path"]


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
            kind = TYPES.get(name, "f8")
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
            # A full disk can't be flushed to; the error that matters is on its way already.
            with suppress(RuntimeError):
                self._file.close()
            self._file = None
        self._part.unlink(missing_ok=True)


def _now() -> str:
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
