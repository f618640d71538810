"""Opening result files, and the case inside."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path

import xarray as xr

from wheelrail.case import Case, case_from_dict
from wheelrail.errors import CaseError, WheelrailError
from wheelrail.results.layout import FORMAT

__all__ = ["ResultFileError", "case_of_result", "is_interrupted", "open_result"]


class ResultFileError(WheelrailError):
    """A result file can't be read, written or continued."""


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


def case_of_result(dataset: xr.Dataset, *, source: str, structures: bool = True) -> Case:
    """Return the case of a result without its excitation, whose data files may be elsewhere by now.

    Data files of wheel and track are looked for where they lay beside the result when it was written.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `open_result`.
    source : str
        Name of the file, for messages and for the data files.
    structures : bool
        False: wheel and track are rigid instead, and need no data files.

    Raises
    ------
    ResultFileError
        If the case in the file is not one that this version reads, or data files of wheel and track are missing.
    """
    try:
        data = tomllib.loads(dataset.attrs["case"])
        data.pop("excitation", None)
        if not structures:
            data["wheel"] = {"model": "rigid", "radius": data["wheel"]["radius"]}
            data["track"] = {"model": "rigid"}
        folder = os.path.normpath(Path(source).parent / dataset.attrs.get("data_folder", ""))
        return case_from_dict(data, source=source, folder=folder)
    except (KeyError, tomllib.TOMLDecodeError, CaseError) as error:
        raise ResultFileError(f"{source}: the case in the file can't be read: {error}") from error
