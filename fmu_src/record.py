"""The internal time history of one instance, written to a CSV file while it runs."""

from __future__ import annotations

import os
import re
import threading
from typing import Any

from .errors import RecordError

__all__ = ["COLUMNS", "Recorder"]

COLUMNS = ("time", "force_x", "force_y", "force_z")
_BUFFERED_ROWS = 1000
_in_use: set[str] = set()
_lock = threading.Lock()


class Recorder:
    """Rows of the internal steps, in ``<instance>_record.csv`` in the working directory.

    A second living instance of the same name gets ``<instance>_2_record.csv``. Memory does not grow with the run.

    Parameters
    ----------
    instance : str
        Instance name; characters that are unsafe in a file name become ``_``.
    start_time : float
        Time of the host at the start of the run (s), added to the times.

    Raises
    ------
    RecordError
        If the file can't be opened.
    """

    def __init__(self, instance: str, start_time: float) -> None:
        self._start_time = start_time
        self._rows: list[str] = []
        stem = re.sub(r"[^A-Za-z0-9_.-]", "_", instance) or "WheelRail"
        with _lock:
            number = 1
            while True:
                name = f"{stem}_record.csv" if number == 1 else f"{stem}_{number}_record.csv"
                self.path = os.path.join(os.getcwd(), name)
                if self.path not in _in_use:
                    break
                number += 1
            try:
                self._file = open(self.path, "w+b")  # noqa: SIM115 - open as long as the instance lives
            except OSError as error:
                raise RecordError(
                    f"record = true, but {self.path!r} can't be written: {error.strerror}. Start the host in a folder "
                    "where it may write, or set record to false."
                ) from error
            _in_use.add(self.path)
        self._file.write((",".join(COLUMNS) + "\n").encode())

    def __call__(self, time: float, *forces: float) -> None:
        """Take the start or an internal step: time since the start (s) and the forces on the rail (N)."""
        self._rows.append(",".join(repr(float(value)) for value in (self._start_time + time, *forces)))
        if len(self._rows) >= _BUFFERED_ROWS:
            self._write()

    def position(self) -> int:
        """Return the length of the history so far (bytes), to come back to."""
        self._write()
        return self._file.tell()

    def rewind(self, position: int) -> None:
        """Drop all that was recorded after a position."""
        self._rows.clear()
        self._file.flush()
        self._file.seek(0, os.SEEK_END)
        if position < self._file.tell():
            self._file.truncate(position)
            self._file.seek(0, os.SEEK_END)

    def close(self) -> None:
        """Write what is left and close the file."""
        if self._file.closed:
            return
        try:
            self._write()
            self._file.close()
        except OSError as error:
            raise RecordError(f"{self.path!r} can't be written: {error.strerror}") from error
        finally:
            with _lock:
                _in_use.discard(self.path)

    def _write(self) -> None:
        if self._rows:
            try:
                self._file.write(("\n".join(self._rows) + "\n").encode())
            except OSError as error:
                raise RecordError(f"{self.path!r} can't be written: {error.strerror}") from error
            self._rows.clear()

    def __del__(self, *_: Any) -> None:
        if hasattr(self, "_file"):
            try:
                self.close()
            except RecordError:
                return
